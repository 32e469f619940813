/* The stress suite: rows of random cases, each with a measured value and its bound. */
#ifndef WRT_TESTS_STRESS_H
#define WRT_TESTS_STRESS_H

#include "math/rng.h"
#include "scene/geometry.h"

/* Rounding error of one operation, relative. */
#define EPS 0x1p-53

/* Random numbers of one part of a row: the same in every run, though compilers that take arguments
 * in another order use them for other things. */
struct dice {
    uint64_t seed, count;
};

/* Uniform in [lo, hi). */
static inline double uniform(struct dice *d, double lo, double hi)
{
    return lo + (hi - lo) * rng_uniform(d->seed, d->count++, 0, 0);
}

static inline uint32_t below(struct dice *d, uint32_t n)
{
    return (uint32_t)uniform(d, 0, n);
}

/* 10^x for a uniform x: from `lo` to `hi`. */
static inline double magnitude(struct dice *d, double lo, double hi)
{
    return pow(10, uniform(d, log10(lo), log10(hi)));
}

/* Every component less than `size` from 0. */
static inline struct vec3 random_vector(struct dice *d, double size)
{
    double x = uniform(d, -size, size), y = uniform(d, -size, size); /* in this order */
    return vec3(x, y, uniform(d, -size, size));
}

static inline struct vec3 random_direction(struct dice *d)
{
    struct vec3 v;
    do
        v = random_vector(d, 1);
    while (vec3_dot(v, v) > 1 || vec3_dot(v, v) < 0.01);
    return vec3_normalize(v);
}

/* Unit, across the unit vector n. */
static inline struct vec3 random_across(struct dice *d, struct vec3 n)
{
    struct vec3 x, y;
    double turn = uniform(d, 0, 2 * PI);
    vec3_basis(n, &x, &y);
    return vec3_mad(vec3_scale(x, cos(turn)), sin(turn), y);
}

/* Turned, scaled by up to `uneven` more along one axis than along another, turned again, and moved
 * by up to `far` times its size; every other one is a mirror. */
struct affine random_map(struct dice *d, double size, double uneven, double far);

static inline struct ray ray_between(struct vec3 origin, struct vec3 target)
{
    return (struct ray){.origin = origin,
                        .direction = vec3_sub(target, origin),
                        .t_max = RAY_UNBOUNDED,
                        .from = PRIM_NONE,
                        .surface = SURFACE_NONE};
}

/* What came of some cases. */
struct tally {
    uint64_t cases;
    double worst;   /* the largest value measured */
    uint64_t wrong; /* cases that are wrong whatever was measured; must be none */
};

static inline void tally_measure(struct tally *t, double value)
{
    if (!(value <= t->worst)) /* also when it is no number */
        t->worst = value;
}

struct row {
    const char *what, *unit;
    double bound;         /* of `worst`; 0: only `wrong` counts */
    uint64_t quick, full; /* cases in `make check` and `make check-stress` */
    /* Adds at least `cases` cases to the tally.  Rows run on many threads at once. */
    void (*run)(struct dice *dice, uint64_t cases, struct tally *tally);
    bool exact; /* needs the wide numbers of wide.h */
};

/* Ends with a row without a name. */
extern const struct row rows_exact[], rows_tight[], rows_spawn[], rows_tree[];

/* ---- stress_shapes.c: what is shot at
 * ---------------------------------------------------------------- */

/* The hit of the ray with any of the primitives, tried one by one. */
bool shoot(const struct geometry *g, const struct ray *ray, struct hit *hit);

/* A cube of this half width, each side a quad: two triangles with the quad's own diagonal. */
void add_box(struct geometry *g, struct vec3 at, double half);

/* A closed sphere of quads cut in two, `rings` by `rings`; the poles are fans. */
void add_globe(struct geometry *g, struct vec3 at, double radius, uint32_t rings);

#endif
