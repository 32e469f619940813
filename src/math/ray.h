/* Rays and what they hit. */
#ifndef WRT_MATH_RAY_H
#define WRT_MATH_RAY_H

#include "math/vec3.h"

#include <float.h>
#include <stdbool.h>
#include <stdint.h>

#define PRIM_NONE UINT32_MAX
#define SURFACE_NONE UINT32_MAX

/* t_max of a ray without an end; an infinite t is never a hit. */
#define RAY_UNBOUNDED DBL_MAX

/* A point lies on what is nearer to it than this times the coordinates involved: some 450 times
 * the rounding error of one operation, an order more than what a hit point is off by. */
#define SPAWN_TOLERANCE 1e-13

/* Boxes are taken larger by this times the coordinates involved (their own and the ray's origin):
 * more than the rounding errors of the box test and of any primitive's hit, so that no box is
 * missed which holds a hit. */
#define BOX_PADDING 0x1p-42

/* Hits count at 0 < t <= t_max, t in units of the length of `direction` (which need not be 1).
 *
 * A spawned ray starts on a surface: every root whose surface its origin lies on within rounding
 * is taken to be exactly 0 and so left out (neighbouring and coplanar faces too); `from` is the
 * primitive it starts on, which for a flat triangle is left out by name. */
struct ray {
    struct vec3 origin, direction;
    double t_max;
    uint32_t from;    /* primitive it starts on, or PRIM_NONE */
    uint32_t surface; /* only this surface can be hit, or SURFACE_NONE: any */
    bool spawned;
};

enum cylinder_part { CYLINDER_BASE, CYLINDER_TOP, CYLINDER_SIDE };

/* Hits are ordered by t, then by primitive number: equal distances go to the first in the file. */
struct hit {
    double t;
    uint32_t prim; /* number in the geometry, PRIM_NONE: nothing hit */
    uint32_t part; /* enum cylinder_part; of an instance of a mesh: the triangle within */
    /* triangle: weights of the second and third vertex; geometry_weights works them out */
    double b1, b2;
};

static inline struct hit hit_none(double t_max)
{
    return (struct hit){.t = t_max, .prim = PRIM_NONE};
}

/* *hit = hit_none(t_max), part by part: a copy of all would wait for the parts to be stored. */
static inline void hit_clear(struct hit *hit, double t_max)
{
    hit->t = t_max;
    hit->prim = PRIM_NONE;
    hit->part = 0;
    hit->b1 = hit->b2 = 0;
}

/* Whether a hit at t comes before *best; a t of zero, below, or not a number never does. */
static inline bool hit_before(double t, uint32_t prim, const struct hit *best)
{
    return t > 0 && (t < best->t || (t == best->t && prim < best->prim));
}

/* Squares of unit vectors are no farther from 1, and the square of this is nothing beside 1. */
#define UNIT_ROUNDING 0x1p-40

/* What the tests of one ray against many primitives share. */
struct ray_frame {
    double square;           /* of the direction's length */
    double tolerance, reach; /* SPAWN_TOLERANCE and the origin's largest coordinate, or 0 */
    double inverse_square;   /* for spheres */
    /* For triangles: */
    double shear_x, shear_y; /* the direction's other two components over the largest */
    int axis;                /* of the direction's largest component */
};

/* 1 / square, without a division for unit vectors, whose square is 1 but for rounding errors. */
static inline double ray_inverse_square(double square)
{
    return fabs(square - 1) <= UNIT_ROUNDING ? 2 - square : 1 / square;
}

/* With the parts for spheres, for triangles, or both. */
static inline void ray_frame_init(struct ray_frame *f, const struct ray *ray, bool spheres,
                                  bool triangles)
{
    struct vec3 d = ray->direction;
    f->square = vec3_dot(d, d);
    f->tolerance = ray->spawned ? SPAWN_TOLERANCE : 0;
    f->reach = ray->spawned ? vec3_largest(ray->origin) : 0;
    f->inverse_square = spheres ? ray_inverse_square(f->square) : 0;
    f->shear_x = f->shear_y = 0;
    f->axis = -1;
    if (!triangles)
        return;
    double x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
    const double part[5] = {d.x, d.y, d.z, d.x, d.y};
    f->axis = x > y && x > z ? 0 : y > z ? 1 : 2;
    double inverse = 1 / part[f->axis];
    f->shear_x = part[f->axis + 1] * inverse;
    f->shear_y = part[f->axis + 2] * inverse;
}

static inline struct ray_frame ray_frame_of(const struct ray *ray)
{
    struct ray_frame f;
    ray_frame_init(&f, ray, true, true);
    return f;
}

/* 1/d for box tests.  A component below 2^-60 of the largest moves the ray by less than a box's
 * padding on any way; it is replaced by that, so that every product stays a number. */
static inline double ray_inverse(double d, double largest)
{
    double least = largest * 0x1p-60;
    return 1 / (fabs(d) < least ? copysign(least, d) : d);
}

/* False for a direction of length zero or with a part that is no finite number.  Such a ray hits
 * nothing, but would walk a whole tree to find out. */
static inline bool ray_has_direction(const struct ray *r)
{
    struct vec3 d = r->direction;
    return fabs(d.x + d.y + d.z) <= DBL_MAX && vec3_largest(d) > 0;
}

#endif
