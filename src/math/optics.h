/* Mirrored and refracted directions. */
#ifndef WRT_MATH_OPTICS_H
#define WRT_MATH_OPTICS_H

#include "math/vec3.h"

/* Back to length 1 from near it: a step of Newton's iteration. */
static inline struct vec3 vec3_renormalized(struct vec3 d)
{
    return vec3_scale(d, 1.5 - 0.5 * vec3_dot(d, d));
}

/* The unit direction d mirrored at a plane of unit normal n; not of length 1 by some rounding. */
static inline struct vec3 vec3_mirrored(struct vec3 d, struct vec3 n)
{
    return vec3_mad(d, -2 * vec3_dot(n, d), n);
}

/* Snell's law, by the sine, which near the critical angle keeps the digits that 1 - c^2 loses.  The
 * unit direction d meets the side that the unit normal n is on, coming from an index of refraction
 * eta times the one behind; false for total reflection. */
static inline bool vec3_refracted(struct vec3 d, struct vec3 n, double eta, struct vec3 *out)
{
    double c = -vec3_dot(n, d);
    double s = vec3_length(vec3_cross(n, d)), k = (1 - eta * s) * (1 + eta * s);
    if (!(k >= 0 && c > 0))
        return false;
    *out = vec3_renormalized(vec3_mad(vec3_scale(d, eta), eta * c - sqrt(k), n));
    return true;
}

#endif
