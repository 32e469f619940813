/* Which primitive of a geometry a ray meets: by a tree of boxes, or by trying all of them, with the
 * same outcome to the last bit.  Built once, then read only. */
#ifndef WRT_ACCEL_BVH_H
#define WRT_ACCEL_BVH_H

#include "base/isa.h"
#include "scene/intersect.h"

#include <stdbool.h>
#include <stdint.h>

/* An inner node holds the boxes of its two children, so that children are tested before they are
 * fetched.  A child is a node, or a leaf: a run of `targets`. */
struct bvh_node {
    double plane[2][2][3]; /* of child, lower or upper, axis */
    uint32_t first[2];     /* node number, or start of the run */
    uint32_t count[2];     /* 0: a node; else the length of the run */
};

/* Without nodes of either kind every primitive is tried. */
struct accel {
    const struct geometry *geometry; /* borrowed */
    struct target *targets;          /* all primitives, leaf by leaf */
    uint32_t target_count;           /* pieces of one triangle count by themselves */
    bool has[PRIM_KINDS];            /* which kinds are among them */
    uint32_t pieces;                 /* more of them than there are primitives */
    struct bvh_node *nodes;          /* root first, or NULL */
    uint32_t node_count;
    double reach;             /* largest |coordinate| of the geometry's bounds */
    double padding;           /* BOX_PADDING, times what instances add to rounding errors */
    struct accel *prototypes; /* one for each of the geometry's; NULL: there are none */
    struct wide *wide;        /* in place of the nodes for vector code, or NULL */
    uint64_t fingerprint;     /* of what it was built of; with a store only */
};

struct accel_store;

/* How an accel is built; all find the same hits. */
struct accel_options {
    bool brute_force; /* no tree: every primitive is tried */
    enum isa isa;
    unsigned threads;          /* >= 1 */
    const bool *spare;         /* primitives that are left out, or NULL: none */
    struct accel_store *store; /* trees of before that are taken where they fit; or NULL */
    double rays;               /* that may come: they repay a better tree */
};

/* Deepest leaf below the root; bounds the stacks of tree walks. */
enum { BVH_DEPTH_LIMIT = 96 };

/* The geometry must not change while the accel is used. */
void accel_build_with(struct accel *a, const struct geometry *geometry,
                      const struct accel_options *options);
/* By plain code and one thread. */
void accel_build(struct accel *a, const struct geometry *geometry, bool brute_force);
void accel_free(struct accel *a);

/* What shafts need of one that is not built yet; reach: the largest |coordinate| of its boxes. */
struct accel accel_outline(const struct geometry *geometry, double reach);

/* What made all its trees better. */
struct accel_efforts {
    uint64_t pieces; /* cut off large triangles */
    uint64_t moves;  /* of subtrees */
};

struct accel_efforts accel_efforts(const struct accel *a);

/* The nearest hit of the ray; *hit is filled in either case (hit_none when false). */
bool accel_closest(const struct accel *a, const struct ray *ray, struct hit *hit);

/* Whether anything is hit within the ray's t_max. */
bool accel_any(const struct accel *a, const struct ray *ray);

#endif
