#include "config.h"

#include "accel/wide.h"

#include "base/thread.h"

/* One wide node to be: its children, and whose boxes they have: child source % 2 of the accel's
 * node source / 2. */
struct plan {
    uint32_t n;
    uint32_t source[WIDE];
    struct wide_child child[WIDE];
};

struct run {
    uint32_t first, count;
};

struct planner {
    const struct accel *accel;
    VEC(struct plan) plans; /* root first */
    VEC(struct run) blocks;
};

struct filling {
    const struct planner *planner;
    struct wide *wide;
};

/* ---- which nodes ----------------------------------------------------------------------------- */

static uint32_t first_of(const struct accel *a, uint32_t source)
{
    return a->nodes[source / 2].first[source % 2];
}

/* 0: it is a node. */
static uint32_t count_of(const struct accel *a, uint32_t source)
{
    return a->nodes[source / 2].count[source % 2];
}

static double area_of(const struct accel *a, uint32_t source)
{
    const double(*b)[3] = a->nodes[source / 2].plane[source % 2];
    return box_half_area(
        (struct box){vec3(b[0][0], b[0][1], b[0][2]), vec3(b[1][0], b[1][1], b[1][2])});
}

static bool all_triangles(const struct accel *a, uint32_t first, uint32_t count)
{
    for (uint32_t i = first; i < first + count; i++)
        if (a->targets[i].kind != PRIM_TRIANGLE)
            return false;
    return true;
}

/* How many primitives there are; more than `room` when they are more, or not all triangles. */
static uint32_t triangles_in(const struct accel *a, uint32_t source, uint32_t room)
{
    uint32_t first = first_of(a, source), count = count_of(a, source);
    if (count > 0)
        return all_triangles(a, first, count) ? count : room + 1;
    uint32_t n = triangles_in(a, 2 * first, room);
    return n > room ? n : n + triangles_in(a, 2 * first + 1, room - n);
}

/* The first of the targets of a child and all below. */
static uint32_t first_target(const struct accel *a, uint32_t source)
{
    while (count_of(a, source) == 0)
        source = 2 * first_of(a, source);
    return first_of(a, source);
}

/* The second child of a root whose first holds everything: no node is a child of itself. */
static bool is_nothing(const struct accel *a, uint32_t source)
{
    return count_of(a, source) == 0 && first_of(a, source) == 0;
}

/* Children still to be opened, the others negative. */
static double worth_opening(const struct accel *a, uint32_t source)
{
    if (count_of(a, source) > 0 || triangles_in(a, source, WIDE) <= WIDE)
        return -1;
    return area_of(a, source);
}

/* The descendants that take the place of a node's two children: the largest are replaced by theirs
 * until there are enough. */
static uint32_t open_children(const struct accel *a, uint32_t node, uint32_t source[WIDE])
{
    double worth[WIDE];
    uint32_t n = 0, open = node;
    for (uint32_t place = 0;;) {
        for (uint32_t child = 0; child < 2 && !is_nothing(a, 2 * open + child); child++) {
            uint32_t at = child == 0 ? place : n;
            source[at] = 2 * open + child;
            worth[at] = worth_opening(a, source[at]);
            n += at == n;
        }
        for (uint32_t i = place = 0; i < n; i++)
            place = worth[i] > worth[place] ? i : place;
        if (n == 0 || n == WIDE || !(worth[place] >= 0))
            return n;
        open = first_of(a, source[place]);
    }
}

static uint32_t plan_node(struct planner *p, uint32_t node);

static struct wide_child plan_child(struct planner *p, uint32_t source)
{
    const struct accel *a = p->accel;
    uint32_t triangles = triangles_in(a, source, WIDE), count = count_of(a, source);
    if (triangles <= WIDE) {
        vec_push(&p->blocks, (struct run){first_target(a, source), triangles});
        return (struct wide_child){(uint32_t)p->blocks.n - 1, WIDE_TRIANGLES, triangles};
    }
    if (count > 0)
        return (struct wide_child){first_of(a, source), WIDE_RUN, count};
    return (struct wide_child){plan_node(p, first_of(a, source)), WIDE_NODE, 0};
}

/* Returns its number; recursion is at most BVH_DEPTH_LIMIT deep. */
static uint32_t plan_node(struct planner *p, uint32_t node)
{
    uint32_t number = (uint32_t)p->plans.n;
    struct plan plan = {0};
    plan.n = open_children(p->accel, node, plan.source);
    vec_push(&p->plans, plan);
    for (uint32_t i = 0; i < plan.n; i++) {
        struct wide_child child = plan_child(p, plan.source[i]);
        p->plans.at[number].child[i] = child;
    }
    return number;
}

/* ---- what is in them ------------------------------------------------------------------------- */

static void fill_node(const struct accel *a, const struct plan *plan, struct wide_node *node)
{
    for (int axis = 0; axis < 3; axis++) {
        for (uint32_t i = 0; i < WIDE; i++) {
            uint32_t source = plan->source[i];
            const double(*b)[3] = a->nodes[source / 2].plane[source % 2];
            node->plane[0][axis][i] = i < plan->n ? b[0][axis] : INFINITY;
            node->plane[1][axis][i] = i < plan->n ? b[1][axis] : -INFINITY;
        }
    }
    for (uint32_t i = 0; i < WIDE; i++)
        node->child[i] = plan->child[i];
}

static void fill_block(const struct accel *a, struct run run, struct triangle_block *block)
{
    const struct geometry *g = a->geometry;
    for (uint32_t i = 0; i < WIDE; i++) {
        /* what lies behind the last is never looked at */
        struct target target = a->targets[run.first + (i < run.count ? i : 0)];
        const uint32_t *vertex = g->triangles.at[target.index].vertex;
        block->target[i] = target;
        for (int k = 0; k < 3; k++) {
            struct vec3 v = g->vertices.at[vertex[k]];
            block->corner[k][0][i] = v.x;
            block->corner[k][1][i] = v.y;
            block->corner[k][2][i] = v.z;
        }
    }
}

enum { FILL_AT_ONCE = 1024 }; /* nodes and blocks */

static void fill_some(void *context, size_t item, unsigned worker)
{
    const struct filling *f = context;
    (void)worker;
    for (size_t i = item * FILL_AT_ONCE, end = i + FILL_AT_ONCE; i < end; i++) {
        if (i < f->wide->node_count)
            fill_node(f->planner->accel, &f->planner->plans.at[i], &f->wide->nodes[i]);
        if (i < f->wide->block_count)
            fill_block(f->planner->accel, f->planner->blocks.at[i], &f->wide->blocks[i]);
    }
}

static const struct wide_kernels *kernels_of(enum isa isa)
{
    static const struct wide_kernels *const kernels[ISA_COUNT] = {
        [ISA_GENERIC] = &wide_generic,
#ifdef HAVE_X86_KERNELS
        [ISA_AVX2] = &wide_avx2,
        [ISA_AVX512] = &wide_avx512,
#endif
    };
    return kernels[isa];
}

struct wide *wide_build(const struct accel *a, enum isa isa, unsigned threads)
{
    struct planner planner = {.accel = a};
    if (!a->nodes || !kernels_of(isa))
        return NULL;
    plan_node(&planner, 0);
    struct wide *w = mem_alloc(1, sizeof *w);
    *w = (struct wide){kernels_of(isa), mem_alloc_aligned(planner.plans.n, sizeof *w->nodes),
                       mem_alloc_aligned(planner.blocks.n, sizeof *w->blocks),
                       (uint32_t)planner.plans.n, (uint32_t)planner.blocks.n};
    uint32_t most = w->node_count > w->block_count ? w->node_count : w->block_count;
    struct filling filling = {&planner, w};
    thread_share((most + FILL_AT_ONCE - 1) / FILL_AT_ONCE, threads, fill_some, &filling);
    vec_free(&planner.plans);
    vec_free(&planner.blocks);
    return w;
}

void wide_free(struct wide *w)
{
    if (!w)
        return;
    free(w->nodes);
    free(w->blocks);
    free(w);
}
