/* Points, directions, normals and colours: three doubles. */
#ifndef WRT_MATH_VEC3_H
#define WRT_MATH_VEC3_H

#include <math.h>
#include <stdbool.h>

#define PI 3.14159265358979323846

struct vec2 {
    double x, y;
};

struct vec3 {
    double x, y, z;
};

static inline struct vec3 vec3(double x, double y, double z)
{
    return (struct vec3){x, y, z};
}

static inline struct vec3 vec3_all(double a)
{
    return (struct vec3){a, a, a};
}

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* Component by component. */
static inline struct vec3 vec3_mul(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline struct vec3 vec3_scale(struct vec3 a, double s)
{
    return (struct vec3){a.x * s, a.y * s, a.z * s};
}

static inline struct vec3 vec3_neg(struct vec3 a)
{
    return (struct vec3){-a.x, -a.y, -a.z};
}

/* a + s b */
static inline struct vec3 vec3_mad(struct vec3 a, double s, struct vec3 b)
{
    return (struct vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline double vec3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline double vec3_length(struct vec3 a)
{
    return sqrt(vec3_dot(a, a));
}

static inline struct vec3 vec3_normalize(struct vec3 a)
{
    return vec3_scale(a, 1 / vec3_length(a));
}

/* a b - c d with the rounding error of c d given back: Kahan's difference of products, within 1.5
 * ulp (Jeannerod, Louvet, Muller, Further analysis of Kahan's algorithm, 2013). */
static inline double difference_of_products(double a, double b, double c, double d)
{
    double cd = c * d;
    return fma(a, b, -cd) + fma(-c, d, cd);
}

static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){difference_of_products(a.y, b.z, a.z, b.y),
                         difference_of_products(a.z, b.x, a.x, b.z),
                         difference_of_products(a.x, b.y, a.y, b.x)};
}

/* By plain products: for what their rounding, relative to the lengths, does not harm. */
static inline struct vec3 vec3_cross_plain(struct vec3 a, struct vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/* Unit vectors across the unit vector n, and each other: Duff et al., Building an orthonormal basis,
 * revisited, JCGT 2017. */
static inline void vec3_basis(struct vec3 n, struct vec3 *x, struct vec3 *y)
{
    double sign = copysign(1, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    *x = vec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *y = vec3(b, sign + n.y * n.y * a, -n.y);
}

static inline bool vec3_is_zero(struct vec3 a)
{
    return a.x == 0 && a.y == 0 && a.z == 0;
}

static inline double vec3_at(struct vec3 a, int axis)
{
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

static inline double vec3_largest(struct vec3 a)
{
    double x = fabs(a.x), y = fabs(a.y), z = fabs(a.z);
    double m = x > y ? x : y;
    return m > z ? m : z;
}

#endif
