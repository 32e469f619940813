/* Random tries, the same in every run.  A file that includes it defines TRIES_SEED before. */
#ifndef WRT_TESTS_TRIES_H
#define WRT_TESTS_TRIES_H

#include "math/rng.h"
#include "scene/geometry.h"
#include "unit.h"

/* How many of the tries are made: the stress suite makes the rest, and more. */
#define TRIES(n) ((n) / SANITIZED(20, 2))

/* Of the numbers taken; a test that is run in a loop begins each round at a place of its own. */
static uint64_t counter;

/* Uniform in [lo, hi). */
static inline double uniform(double lo, double hi)
{
    return lo + (hi - lo) * rng_uniform(TRIES_SEED, counter++, 0, 0);
}

static inline uint32_t below(uint32_t n)
{
    return (uint32_t)uniform(0, n);
}

/* Every component less than `size` from 0. */
static inline struct vec3 random_vector(double size)
{
    return vec3(uniform(-size, size), uniform(-size, size), uniform(-size, size));
}

static inline struct vec3 random_direction(void)
{
    struct vec3 v;
    do
        v = random_vector(1);
    while (vec3_dot(v, v) > 1 || vec3_dot(v, v) < 0.01);
    return vec3_normalize(v);
}

/* Every primitive against the ray. */
static inline bool shoot(const struct geometry *g, const struct ray *ray, struct hit *hit)
{
    struct ray_frame frame = ray_frame_of(ray);
    *hit = hit_none(ray->t_max);
    for (uint32_t i = 0; i < g->prims.n; i++)
        geometry_intersect(g, i, ray, &frame, hit);
    return hit->prim != PRIM_NONE;
}

#endif
