/* The tree for vector code: eight children a node, boxes of floats, eight triangles a leaf. */
#ifndef WRT_ACCEL_WIDE_H
#define WRT_ACCEL_WIDE_H

#include "accel/bvh.h"
#include "accel/sah.h"
#include "math/batch.h"

#include <stdalign.h>

enum { WIDE = 8 };

enum wide_kind {
    WIDE_RUN,       /* a leaf of any primitives: `count` of the accel's targets from `first` on */
    WIDE_TRIANGLES, /* a leaf of `count` triangles: block `first` */
    WIDE_NODE,      /* node `first` */
};

/* Zero: nothing at all. */
struct wide_child {
    uint32_t first;
    uint32_t kind : 2, count : 30;
};

struct wide_node {
    alignas(64) float plane[2][3][WIDE]; /* lower or upper, axis, child; in the tree's frame */
    struct wide_child child[WIDE];
};

/* The triangles of a leaf side by side. */
struct triangle_block {
    alignas(64) double corner[3][3][WIDE]; /* corner, axis, triangle */
    struct target target[WIDE];
};

/* What an instruction set has its own code for: rays against the whole tree. */
struct wide_kernels {
    /* Puts the nearest hit that beats *hit into it. */
    void (*closest)(const struct accel *a, const struct ray *ray, const struct ray_frame *frame,
                    struct hit *hit);
    /* Puts some hit into it that beats it; whether there is one. */
    bool (*any)(const struct accel *a, const struct ray *ray, const struct ray_frame *frame,
                struct hit *hit);
    /* The nearest hits of all rays, or some; false when they have too little in common to be traced
     * together, and then nothing is found out, whatever *hits holds. */
    bool (*packet)(const struct accel *a, const struct ray_batch *rays, bool any,
                   struct hit_batch *hits);
};

extern const struct wide_kernels wide_generic, wide_avx2, wide_avx512;

struct wide {
    const struct wide_kernels *kernels;
    struct tree_frame frame;
    struct wide_node *nodes; /* root first */
    struct triangle_block *blocks;
    uint32_t node_count, block_count;
    uint32_t moves; /* of subtrees, that made it better */
};

/* Each level takes up to WIDE - 1 children to come back to. */
enum { WIDE_STACK = BVH_DEPTH_LIMIT * (WIDE - 1) + 1 };

/* NULL when the instruction set has no vectors. */
const struct wide_kernels *wide_kernels_of(enum isa isa);

/* Of an accel whose geometry is set and whose targets have room; puts them in order. */
struct wide *wide_build(const struct accel *a, struct sah *sah, const struct sah_run *all,
                        enum isa isa, unsigned threads, double rays);
void wide_free(struct wide *w);

/* traverse.c: the best hit of a run of targets; with any_hit, the first found ends the search, and
 * only then it is true. */
bool accel_try_run(const struct accel *a, uint32_t first, uint32_t count, const struct ray *ray,
                   const struct ray_frame *frame, bool any_hit, struct hit *hit);

/* Whether so many rays may be better off together: among many small primitives of other kinds than
 * triangles they have little in common. */
static inline bool wide_takes_packets(const struct accel *a, uint32_t rays)
{
    enum { PACKET_LEAST = 4, FEW_OTHERS = 64, TRIANGLES_FOR_EACH = 8 };
    const struct geometry *g = a->geometry;
    size_t triangles = g->triangles.n, others = g->prims.n - triangles - g->instances.n;
    return a->wide && rays >= PACKET_LEAST &&
           (others <= FEW_OTHERS || others <= triangles / TRIANGLES_FOR_EACH);
}

static inline bool accel_skips(const struct accel *a, struct target target, const struct ray *ray)
{
    return ray->surface != SURFACE_NONE &&
           a->geometry->prims.at[target.prim].surface != ray->surface;
}

#endif
