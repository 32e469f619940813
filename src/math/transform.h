/* Affine maps and the angles that make them.  Angles are degrees: whole quarter turns are exact. */
#ifndef WRT_MATH_TRANSFORM_H
#define WRT_MATH_TRANSFORM_H

#include "math/vec3.h"

double sin_degrees(double angle);
double cos_degrees(double angle);

/* point' = m (point, 1), row by row. */
struct affine {
    double m[3][4];
};

struct affine affine_translation(struct vec3 by);
struct affine affine_scaling(struct vec3 factors);
/* About x, then about y, then about z, right-handed. */
struct affine affine_rotation(struct vec3 degrees);

/* First b, then a. */
struct affine affine_times(const struct affine *a, const struct affine *b);

/* Volume of the unit cube's image, negative for a mirror. */
double affine_determinant(const struct affine *a);

static inline struct vec3 affine_vector(const struct affine *a, struct vec3 v)
{
    const double(*m)[4] = a->m;
    return vec3(m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
                m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z);
}

static inline struct vec3 affine_point(const struct affine *a, struct vec3 p)
{
    return vec3_add(affine_vector(a, p), vec3(a->m[0][3], a->m[1][3], a->m[2][3]));
}

/* v turned about the axis (of any length but 0) by degrees, right-handed. */
struct vec3 vec3_rotate(struct vec3 v, struct vec3 axis, double degrees);

#endif
