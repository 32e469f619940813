/* Up to 64 points, rays and hits side by side: an array for each component, so that vectors of
 * neighbours can be worked on at once.
 *
 * Kernels work on whole vectors.  What lies behind the last element is read and written, but never
 * matters; it must have been set to something once. */
#ifndef WRT_MATH_BATCH_H
#define WRT_MATH_BATCH_H

#include "math/ray.h"

#include <stdalign.h>
#include <string.h>

enum {
    BATCH = 64,
    BATCH_ROOM = BATCH + 8, /* a vector that starts at the last element */
};

struct vec3_batch {
    alignas(64) double x[BATCH_ROOM];
    alignas(64) double y[BATCH_ROOM];
    alignas(64) double z[BATCH_ROOM];
};

static inline struct vec3 vec3_get(const struct vec3_batch *b, uint32_t i)
{
    return vec3(b->x[i], b->y[i], b->z[i]);
}

static inline void vec3_put(struct vec3_batch *b, uint32_t i, struct vec3 p)
{
    b->x[i] = p.x;
    b->y[i] = p.y;
    b->z[i] = p.z;
}

/* Elements first to end. */
static inline void fill(double *to, uint32_t first, uint32_t end, double value)
{
    for (uint32_t i = first; i < end; i++)
        to[i] = value;
}

/* What a vector that starts within the first n reaches behind them. */
static inline void fill_rest(double *to, uint32_t n, double value)
{
    fill(to + n, 0, BATCH_ROOM - BATCH, value);
}

static inline void vec3_fill(struct vec3_batch *to, uint32_t first, uint32_t end, struct vec3 value)
{
    fill(to->x, first, end, value.x);
    fill(to->y, first, end, value.y);
    fill(to->z, first, end, value.z);
}

static inline void vec3_copy(struct vec3_batch *to, uint32_t n, const struct vec3_batch *from)
{
    memcpy(to->x, from->x, n * sizeof *to->x);
    memcpy(to->y, from->y, n * sizeof *to->y);
    memcpy(to->z, from->z, n * sizeof *to->z);
}

/* Rays to trace together; see struct ray.  Any surface can be hit. */
struct ray_batch {
    uint32_t n;
    bool common_origin; /* all have the same */
    bool common_from;   /* likewise; false where that is not known */
    bool spawned;       /* all are */
    struct vec3_batch origin, direction;
    alignas(64) double t_max[BATCH_ROOM];
    alignas(64) double from[BATCH_ROOM]; /* a primitive's number, or PRIM_NONE */
};

static inline struct ray ray_get(const struct ray_batch *b, uint32_t i)
{
    return (struct ray){.origin = vec3_get(&b->origin, i),
                        .direction = vec3_get(&b->direction, i),
                        .t_max = b->t_max[i],
                        .from = (uint32_t)b->from[i],
                        .surface = SURFACE_NONE,
                        .spawned = b->spawned};
}

/* Their hits; see struct hit.  Numbers are kept as doubles, which hold them exactly. */
struct hit_batch {
    alignas(64) double t[BATCH_ROOM];
    alignas(64) double prim[BATCH_ROOM];
    alignas(64) double part[BATCH_ROOM];
};

static inline struct hit hit_get(const struct hit_batch *b, uint32_t i)
{
    return (struct hit){.t = b->t[i], .prim = (uint32_t)b->prim[i], .part = (uint32_t)b->part[i]};
}

static inline void hit_put(struct hit_batch *b, uint32_t i, const struct hit *hit)
{
    b->t[i] = hit->t;
    b->prim[i] = hit->prim;
    b->part[i] = hit->part;
}

#endif
