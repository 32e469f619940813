#include "config.h"

#include "accel/store.h"
#include "accel/wide.h"

#include "base/hash.h"
#include "base/thread.h"
#include "scene/fingerprint.h"

#include <stdatomic.h>
#include <string.h>

/* Binned surface area heuristic (Wald, On fast construction of SAH-based bounding volume
 * hierarchies, 2007), all three axes at once. */
enum {
    BINS = 16,
    LEAF_LIMIT = 4, /* larger runs are always split */
    SAH_DEPTH = 60, /* deeper down runs are halved: at most 30 levels more */
    TREE_LEAST = 5, /* fewer primitives are tried one after another */
};

/* Cost of visiting a node over that of testing a primitive. */
#define NODE_COST 1.0

/* A run of primitives that is to become the child of a node. */
struct branch {
    uint32_t parent, begin, end;
    int child, depth;
};

struct builder {
    const struct geometry *geometry;
    struct box *boxes;    /* by primitive */
    struct vec3 *centers; /* of the boxes */
    uint32_t *order;      /* primitives; runs of it become nodes */
    struct bvh_node *nodes;
    atomic_uint node_count;
    bool wide;               /* a leaf of a wide tree is to come: so many triangles stay together */
    uint32_t small;          /* branches of fewer are left for threads to share */
    VEC(struct branch) left; /* those left */
};

struct bin {
    struct box box;
    uint32_t n;
};

/* How a run is split: before bin `bin` of the axis. */
struct split {
    double cost; /* of both sides: area times primitives */
    int axis, bin;
};

struct binning {
    struct vec3 lo, scale; /* bin = (center - lo) scale */
};

/* A run whose centers differ too little to be told apart gets a scale of 0 on that axis. */
static struct binning binning_of(struct box centers)
{
    struct binning b = {centers.lo, {0, 0, 0}};
    struct vec3 d = vec3_sub(centers.hi, centers.lo);
    double most = BINS * (1 - 0x1p-40);
    b.scale.x = d.x > 0 && most / d.x <= DBL_MAX ? most / d.x : 0;
    b.scale.y = d.y > 0 && most / d.y <= DBL_MAX ? most / d.y : 0;
    b.scale.z = d.z > 0 && most / d.z <= DBL_MAX ? most / d.z : 0;
    return b;
}

static int bin_of(const struct binning *b, struct vec3 center, int axis)
{
    double x = (vec3_at(center, axis) - vec3_at(b->lo, axis)) * vec3_at(b->scale, axis);
    return x >= BINS - 1 ? BINS - 1 : x > 0 ? (int)x : 0;
}

static void fill_bins(const struct builder *w, const struct binning *b, uint32_t begin,
                      uint32_t end, struct bin bins[3][BINS])
{
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < BINS; i++)
            bins[axis][i] = (struct bin){box_empty(), 0};
    for (uint32_t i = begin; i < end; i++) {
        uint32_t prim = w->order[i];
        for (int axis = 0; axis < 3; axis++) {
            struct bin *bin = &bins[axis][bin_of(b, w->centers[prim], axis)];
            bin->box = box_join(bin->box, w->boxes[prim]);
            bin->n++;
        }
    }
}

/* Sweeps one axis from both ends. */
static void best_of_axis(const struct bin bins[BINS], int axis, struct split *best)
{
    double above[BINS];
    struct box box = box_empty();
    uint32_t n = 0;
    for (int i = BINS - 1; i > 0; i--) {
        box = box_join(box, bins[i].box);
        n += bins[i].n;
        above[i] = n ? box_half_area(box) * n : INFINITY;
    }
    box = box_empty();
    n = 0;
    for (int i = 1; i < BINS; i++) {
        box = box_join(box, bins[i - 1].box);
        n += bins[i - 1].n;
        double cost = n ? box_half_area(box) * n + above[i] : INFINITY;
        if (cost < best->cost)
            *best = (struct split){cost, axis, i};
    }
}

static uint32_t partition(struct builder *w, const struct binning *b, const struct split *s,
                          uint32_t begin, uint32_t end)
{
    while (begin < end) {
        uint32_t prim = w->order[begin];
        if (bin_of(b, w->centers[prim], s->axis) < s->bin) {
            begin++;
        } else {
            w->order[begin] = w->order[--end];
            w->order[end] = prim;
        }
    }
    return begin;
}

static bool all_triangles(const struct builder *w, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin; i < end; i++)
        if (w->geometry->prims.at[w->order[i]].kind != PRIM_TRIANGLE)
            return false;
    return true;
}

/* Where to split [begin, end), or `end` to leave it a leaf. */
static uint32_t choose_split(struct builder *w, struct box box, uint32_t begin, uint32_t end,
                             int depth)
{
    uint32_t n = end - begin, middle = begin + n / 2;
    if (n == 1 || (w->wide && n <= WIDE && all_triangles(w, begin, end)))
        return end;
    if (depth >= SAH_DEPTH)
        return n <= LEAF_LIMIT ? end : middle;
    struct box centers = box_empty();
    for (uint32_t i = begin; i < end; i++)
        centers = box_add(centers, w->centers[w->order[i]]);
    struct binning binning = binning_of(centers);
    struct bin bins[3][BINS];
    fill_bins(w, &binning, begin, end, bins);
    struct split best = {INFINITY, 0, 0};
    for (int axis = 0; axis < 3; axis++)
        best_of_axis(bins[axis], axis, &best);
    if (n <= LEAF_LIMIT && !(best.cost + NODE_COST * box_half_area(box) < n * box_half_area(box)))
        return end;
    return best.cost < INFINITY ? partition(w, &binning, &best, begin, end) : middle;
}

static struct box run_box(const struct builder *w, uint32_t begin, uint32_t end)
{
    struct box box = box_empty();
    for (uint32_t i = begin; i < end; i++)
        box = box_join(box, w->boxes[w->order[i]]);
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

/* Fills in one child of a node; recursion is at most BVH_DEPTH_LIMIT deep. */
static void build_branch(struct builder *w, struct branch b)
{
    if (b.end - b.begin < w->small) {
        vec_push(&w->left, b);
        return;
    }
    struct box box = run_box(w, b.begin, b.end);
    uint32_t middle = b.begin < b.end ? choose_split(w, box, b.begin, b.end, b.depth) : b.end;
    if (middle == b.end) {
        set_child(&w->nodes[b.parent], b.child, box, b.begin, b.end - b.begin);
        return;
    }
    uint32_t node = atomic_fetch_add_explicit(&w->node_count, 1, memory_order_relaxed);
    set_child(&w->nodes[b.parent], b.child, box, node, 0);
    build_branch(w, (struct branch){node, b.begin, middle, 0, b.depth + 1});
    build_branch(w, (struct branch){node, middle, b.end, 1, b.depth + 1});
}

static void build_left(void *context, size_t item, unsigned worker)
{
    struct builder *w = context;
    (void)worker;
    build_branch(w, w->left.at[item]);
}

/* Above this many primitives threads pay. */
enum { SHARED_LEAST = 10000, SHARES = 8 /* a thread */ };

static void build_nodes(struct builder *w, uint32_t n, unsigned threads)
{
    struct box all = run_box(w, 0, n);
    w->nodes = mem_alloc_aligned(n + 1, sizeof *w->nodes);
    w->node_count = 1;
    w->small = threads > 1 && n >= SHARED_LEAST ? n / (SHARES * threads) : 0;
    uint32_t middle = n > 1 ? choose_split(w, all, 0, n, 0) : n;
    set_child(&w->nodes[0], 1, box_empty(), 0, 0);
    build_branch(w, (struct branch){0, 0, middle, 0, 1});
    if (middle < n)
        build_branch(w, (struct branch){0, middle, n, 1, 1});
    w->small = 0;
    thread_share(w->left.n, threads, build_left, w);
    vec_free(&w->left);
}

static void find_boxes(void *context, size_t item, unsigned worker)
{
    struct builder *w = context;
    uint32_t n = (uint32_t)w->geometry->prims.n;
    (void)worker;
    for (size_t i = item * SHARED_LEAST; i < n && i < (item + 1) * SHARED_LEAST; i++) {
        w->order[i] = (uint32_t)i;
        w->boxes[i] = geometry_prim_bounds(w->geometry, (uint32_t)i);
        w->centers[i] = box_center(w->boxes[i]);
    }
}

/* How many are left. */
static uint32_t leave_out(uint32_t *order, uint32_t n, const bool *spare)
{
    uint32_t left = 0;
    for (uint32_t i = 0; i < n; i++)
        if (!spare[order[i]])
            order[left++] = order[i];
    return left;
}

/* Only those are ever walked that some instance takes whole. */
static struct accel *build_prototypes(const struct geometry *g, const struct accel_options *options)
{
    struct accel *a = g->prototypes.n ? mem_zalloc(g->prototypes.n, sizeof *a) : NULL;
    struct accel_options own = *options;
    own.spare = NULL;
    for (size_t i = 0; i < g->instances.n; i++) {
        const struct instance *instance = &g->instances.at[i];
        struct accel *prototype = &a[instance->prototype];
        if (instance->only == PRIM_NONE && !prototype->geometry)
            accel_build_with(prototype, &g->prototypes.at[instance->prototype]->shapes, &own);
    }
    return a;
}

static void build_tree(struct accel *a, const struct geometry *geometry,
                       const struct accel_options *options)
{
    uint32_t n = (uint32_t)geometry->prims.n;
    struct builder w = {.geometry = geometry,
                        .boxes = mem_alloc(n, sizeof *w.boxes),
                        .centers = mem_alloc(n, sizeof *w.centers),
                        .order = mem_alloc(n, sizeof *w.order),
                        .wide = options->isa != ISA_PLAIN};
    thread_share((n + SHARED_LEAST - 1) / SHARED_LEAST, options->threads, find_boxes, &w);
    if (options->spare)
        n = leave_out(w.order, n, options->spare);
    struct box all = run_box(&w, 0, n);
    if (!options->brute_force && n >= TREE_LEAST)
        build_nodes(&w, n, options->threads);
    *a = (struct accel){.geometry = geometry,
                        .targets = mem_alloc(n, sizeof *a->targets),
                        .target_count = n,
                        .nodes = w.nodes,
                        .node_count = w.node_count,
                        .reach = n ? fmax(vec3_largest(all.lo), vec3_largest(all.hi)) : 0,
                        .padding = BOX_PADDING * (1 + geometry->worst_growth)};
    for (uint32_t i = 0; i < n; i++)
        a->targets[i] = target_of(geometry, w.order[i]);
    a->wide = wide_build(a, options->isa, options->threads);
    free(w.boxes);
    free(w.centers);
    free(w.order);
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
        build_tree(a, geometry, options);
    a->geometry = geometry;
    a->fingerprint = fingerprint;
    a->prototypes = build_prototypes(geometry, options);
}

void accel_build(struct accel *a, const struct geometry *geometry, bool brute_force)
{
    struct accel_options plain = {.brute_force = brute_force, .isa = ISA_PLAIN, .threads = 1};
    accel_build_with(a, geometry, &plain);
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
