/* Affine maps and the angles that make them.  Angles are degrees: whole quarter turns are exact. */
#ifndef WRT_MATH_TRANSFORM_H
#define WRT_MATH_TRANSFORM_H

#include "math/vec3.h"

#include <stdbool.h>

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

/* False when the map flattens space as far as can be told: its volume is lost in rounding. */
bool affine_invert(const struct affine *a, struct affine *out);

/* Whether the map is one number times a turn, or times a turn and a mirror, but for rounding
 * errors; *factor, at least 0, is the number. */
bool affine_is_similarity(const struct affine *a, double *factor);

/* Whether it only moves, and scales all axes by one factor above 0. */
bool affine_keeps_directions(const struct affine *a);

/* Where it takes normals: by the transposed inverse, which is given.  Any length. */
static inline struct vec3 affine_normal(const struct affine *inverse, struct vec3 n)
{
    const double(*m)[4] = inverse->m;
    return vec3(m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z,
                m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z,
                m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z);
}

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
