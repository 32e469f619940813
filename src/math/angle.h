/* Angles of points of the plane: the same bits from the C here and from the vectors of lanes.h,
 * whatever the C library. */
#ifndef WRT_MATH_ANGLE_H
#define WRT_MATH_ANGLE_H

#include "math/vec3.h"

/* tan(pi / 8) */
#define ANGLE_HALF_OCTANT 0x1.a827999fcef32p-2

/* (atan(t) / t - 1) / t^2 as a polynomial in t^2 for |t| <= tan(pi / 8): what takes its values at
 * eleven Chebyshev points.  t times that is off by at most 0.06 of the last bit. */
enum { ANGLE_TERMS = 11 };
static const double angle_term[ANGLE_TERMS] = {
    -0x1.5555555555555p-2, 0x1.999999999934cp-3, -0x1.24924924361fep-3, 0x1.c71c71853d607p-4,
    -0x1.745d0b28a2eeep-4, 0x1.3b126305dc4dep-4, -0x1.10fa77ab514f0p-4, 0x1.dfe6491089bd5p-5,
    -0x1.a0999a234950fp-5, 0x1.4162b9ab69c5ap-5, -0x1.3a31a1d5ffddfp-6,
};

/* From the x axis over the y axis, 0 to 2 pi, off by less than 2^-49; of (0, 0) no number.
 *
 * t is the tangent of the angle to the nearest multiple of pi / 4, of which there are `eighths`. */
static inline double angle_of(double x, double y)
{
    double ax = fabs(x), ay = fabs(y), lo = ax < ay ? ax : ay, hi = ax < ay ? ay : ax;
    bool far = lo > ANGLE_HALF_OCTANT * hi;
    double t = (far ? lo - hi : lo) / (far ? lo + hi : hi), square = t * t,
           fourth = square * square;
    double even = angle_term[ANGLE_TERMS - 1], odd = angle_term[ANGLE_TERMS - 2];
    for (int k = ANGLE_TERMS - 3; k >= 2; k -= 2) {
        even = even * fourth + angle_term[k];
        odd = odd * fourth + angle_term[k - 1];
    }
    even = even * fourth + angle_term[0];
    double rest = t + t * square * (even + square * odd), eighths = far ? 1 : 0;
    if (ax < ay) {
        eighths = 2 - eighths;
        rest = -rest;
    }
    if (x < 0) {
        eighths = 4 - eighths;
        rest = -rest;
    }
    if (y < 0) {
        eighths = 8 - eighths;
        rest = -rest;
    }
    return eighths * (PI / 4) + rest;
}

#endif
