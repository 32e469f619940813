#include "config.h"

#include "accel/pieces.h"
#include "accel/store.h"
#include "accel/wide.h"

#include "base/hash.h"
#include "scene/fingerprint.h"

#include <string.h>

enum { TREE_LEAST = 5 }; /* fewer primitives are tried one after another */

struct builder {
    const struct geometry *geometry;
    struct sah *sah;
    VEC(struct bvh_node) nodes;
};

static struct box run_box(const struct builder *b, const struct sah_run *run)
{
    struct box box = box_empty();
    for (uint32_t i = run->begin; i < run->end; i++)
        box = box_join(box, geometry_prim_bounds(b->geometry, sah_prim(&b->sah->refs[i])));
    return box;
}

static void set_child(struct bvh_node *node, int child, struct box box, uint32_t first,
                      uint32_t count)
{
    double planes[2][3] = {{box.lo.x, box.lo.y, box.lo.z}, {box.hi.x, box.hi.y, box.hi.z}};
    memcpy(node->plane[child], planes, sizeof planes);
    node->first[child] = first;
    node->count[child] = count;
}

static struct box build_child(struct builder *b, uint32_t parent, int child,
                              const struct sah_run *run);

/* Returns the box around the node; recursion is at most BVH_DEPTH_LIMIT deep. */
static struct box build_node(struct builder *b, const struct sah_run halves[2])
{
    uint32_t number = (uint32_t)b->nodes.n;
    vec_push(&b->nodes, (struct bvh_node){.count = {0}});
    struct box box = build_child(b, number, 0, &halves[0]);
    return box_join(box, build_child(b, number, 1, &halves[1]));
}

static struct box build_child(struct builder *b, uint32_t parent, int child,
                              const struct sah_run *run)
{
    struct sah_run halves[2];
    bool cut = sah_split(b->sah, run, halves);
    uint32_t first = cut ? (uint32_t)b->nodes.n : run->begin;
    struct box box = cut ? build_node(b, halves) : run_box(b, run);
    set_child(&b->nodes.at[parent], child, box, first, cut ? 0 : run->end - run->begin);
    return box;
}

/* So many primitives as make a tree are always cut. */
static void build_nodes(struct accel *a, struct sah *sah, const struct sah_run *all)
{
    struct builder b = {.geometry = a->geometry, .sah = sah};
    struct sah_run halves[2];
    if (sah_split(sah, all, halves))
        build_node(&b, halves);
    for (uint32_t i = 0; i < a->target_count; i++)
        a->targets[i] = target_of(a->geometry, sah_prim(&sah->refs[i]));
    a->nodes = b.nodes.at;
    a->node_count = (uint32_t)b.nodes.n;
}

/* Only those are ever walked that some instance takes whole. */
static struct accel *build_prototypes(const struct geometry *g, const struct accel_options *options)
{
    struct accel *a = g->prototypes.n ? mem_zalloc(g->prototypes.n, sizeof *a) : NULL;
    struct accel_options own = *options; /* rays: each its part */
    own.spare = NULL;
    own.rays = options->rays / (double)g->prototypes.n;
    for (size_t i = 0; i < g->instances.n; i++) {
        const struct instance *instance = &g->instances.at[i];
        struct accel *prototype = &a[instance->prototype];
        if (instance->only == PRIM_NONE && !prototype->geometry)
            accel_build_with(prototype, &g->prototypes.at[instance->prototype]->shapes, &own);
    }
    return a;
}

static void build_tree(struct accel *a, const struct accel_options *options)
{
    bool vectors = wide_kernels_of(options->isa) != NULL;
    struct sah sah;
    struct sah_run all = sah_init(&sah, a->geometry, a->targets, a->target_count,
                                  vectors ? WIDE : 1, options->threads);
    if (vectors && options->rays > 0)
        a->pieces = pieces_cut(&sah, &all, a->geometry, options->rays);
    if (a->pieces > 0)
        a->targets = mem_realloc(a->targets, sah.n, sizeof *a->targets);
    a->target_count = sah.n;
    a->reach = fmax(vec3_largest(sah.bounds.lo), vec3_largest(sah.bounds.hi));
    if (vectors)
        a->wide = wide_build(a, &sah, &all, options->isa, options->threads, options->rays);
    else
        build_nodes(a, &sah, &all);
    sah_free(&sah);
}

/* All primitives but those that can be spared, in the order of the file. */
static void list_targets(struct accel *a, const bool *spare)
{
    uint32_t n = (uint32_t)a->geometry->prims.n;
    a->targets = mem_alloc(n, sizeof *a->targets);
    for (uint32_t i = 0; i < n; i++) {
        if (spare && spare[i])
            continue;
        a->targets[a->target_count++] = target_of(a->geometry, i);
        a->has[a->geometry->prims.at[i].kind] = true;
    }
}

static double reach_of_targets(const struct accel *a)
{
    double reach = 0;
    for (uint32_t i = 0; i < a->target_count; i++) {
        struct box b = geometry_prim_bounds(a->geometry, a->targets[i].prim);
        reach = fmax(reach, fmax(vec3_largest(b.lo), vec3_largest(b.hi)));
    }
    return reach;
}

struct accel accel_outline(const struct geometry *geometry, double reach)
{
    return (struct accel){.geometry = geometry,
                          .reach = reach,
                          .padding = BOX_PADDING * (1 + geometry->worst_growth)};
}

static void build(struct accel *a, const struct geometry *geometry,
                  const struct accel_options *options)
{
    *a = accel_outline(geometry, 0);
    list_targets(a, options->spare);
    if (!options->brute_force && a->target_count >= TREE_LEAST)
        build_tree(a, options);
    else
        a->reach = reach_of_targets(a);
}

static uint64_t fingerprint_of(const struct geometry *g, const bool *spare)
{
    uint64_t shapes = geometry_fingerprint(g);
    return spare ? hash_of(spare, g->prims.n * sizeof *spare, shapes) : shapes;
}

void accel_build_with(struct accel *a, const struct geometry *geometry,
                      const struct accel_options *options)
{
    struct accel_store *store = options->store;
    uint64_t fingerprint = store ? fingerprint_of(geometry, options->spare) : 0;
    if (!store || !accel_store_take(store, fingerprint, a))
        build(a, geometry, options);
    a->geometry = geometry;
    a->fingerprint = fingerprint;
    a->prototypes = build_prototypes(geometry, options);
}

void accel_build(struct accel *a, const struct geometry *geometry, bool brute_force)
{
    struct accel_options plain = {.brute_force = brute_force, .isa = ISA_PLAIN, .threads = 1};
    accel_build_with(a, geometry, &plain);
}

struct accel_efforts accel_efforts(const struct accel *a)
{
    struct accel_efforts sum = {a->pieces, a->wide ? a->wide->moves : 0};
    for (size_t i = 0; a->prototypes && i < a->geometry->prototypes.n; i++) {
        struct accel_efforts more = accel_efforts(&a->prototypes[i]);
        sum.pieces += more.pieces;
        sum.moves += more.moves;
    }
    return sum;
}

void accel_free(struct accel *a)
{
    for (size_t i = 0; a->prototypes && i < a->geometry->prototypes.n; i++)
        accel_free(&a->prototypes[i]);
    free(a->prototypes);
    wide_free(a->wide);
    free(a->nodes);
    free(a->targets);
    *a = (struct accel){0};
}
