/* 113-bit numbers by the compiler: what the suite compares doubles with.  No library is needed; the
 * square root is the only function. */
#ifndef WRT_TESTS_WIDE_H
#define WRT_TESTS_WIDE_H

#include "math/ray.h"

typedef __float128 wide; /* the one typedef: a type that not every compiler has */

struct wide3 {
    wide x, y, z;
};

static inline struct wide3 widen(struct vec3 v)
{
    return (struct wide3){v.x, v.y, v.z};
}

static inline struct wide3 wide_sub(struct wide3 a, struct wide3 b)
{
    return (struct wide3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline wide wide_dot(struct wide3 a, struct wide3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* a + s b */
static inline struct wide3 wide_mad(struct wide3 a, wide s, struct wide3 b)
{
    return (struct wide3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline struct wide3 wide_cross(struct wide3 a, struct wide3 b)
{
    return (struct wide3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline wide wide_abs(wide a)
{
    return a < 0 ? -a : a;
}

/* By Newton's method from the double's root. */
static inline wide wide_sqrt(wide a)
{
    if (!(a > 0))
        return 0;
    wide x = sqrt((double)a);
    for (int i = 0; i < 2; i++)
        x = (x + a / x) / 2;
    return x;
}

/* Seen from a point: the ray's origin is taken as the origin. */
static inline struct wide3 wide_seen(struct vec3 p, struct vec3 from)
{
    return wide_sub(widen(p), widen(from));
}

#endif
