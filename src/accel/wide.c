#include "config.h"

#include "accel/wide.h"

#include "accel/reinsert.h"
#include "base/thread.h"

#include <string.h>

/* Triangles of a leaf: targets first to first + count. */
struct leaf {
    uint32_t first, count;
};

/* A binary tree first, of which forests become the children of nodes. */
enum twig_kind {
    TWIG_LEAF,
    TWIG_FORK, /* of two twigs */
    TWIG_LEFT, /* for threads to share */
};

struct twig {
    struct sah_run run;
    enum twig_kind kind;
    uint32_t fork[2]; /* numbers in the part; TWIG_LEFT: of the branch */
    /* The least that it and all below can cost as so many children of a node and one, or fewer. */
    float cost[WIDE];
};

/* A run that becomes a child of one of the first part's nodes. */
struct branch {
    struct sah_run run;
    uint32_t node;
    int child;
};

/* What one thread builds in one go: numbers are those within the part, but for targets. */
struct part {
    VEC(struct twig) twigs;
    VEC(struct wide_node) nodes; /* root first */
    VEC(struct leaf) leaves;
    uint32_t first_node, first_leaf; /* of the part among all */
};

struct builder {
    struct sah *sah;
    uint32_t small;          /* branches of fewer primitives are left for threads to share */
    VEC(struct branch) left; /* those left */
    struct part *parts;      /* the first, and one for each branch left */
    const struct accel *accel;
    struct wide *wide;
};

/* ---- a binary tree ----------------------------------------------------------------------------
 */

/* Cost of a leaf over that of a node, for rays that meet its box. */
#define LEAF_COST 1.5f

/* How many of n > 1 children a fork's first twig had better become, and what all of them cost. */
static int best_share(const struct part *p, const struct twig *t, int n, float *cost)
{
    const struct twig *a = &p->twigs.at[t->fork[0]], *b = &p->twigs.at[t->fork[1]];
    int best = 1;
    *cost = INFINITY;
    for (int k = 1; k < n; k++) {
        float sum = a->cost[k - 1] + b->cost[n - k - 1];
        best = sum < *cost ? k : best;
        *cost = sum < *cost ? sum : *cost;
    }
    return best;
}

/* Wald, Benthin, Boulos, Getting rid of packets, 2008, have the idea; the recurrence is that of
 * Ylitie, Karras, Laine, Efficient incoherent ray traversal on GPUs, 2017. */
static void find_costs(const struct part *p, struct twig *t)
{
    float area = sah_area(&t->run.box), cost = area * LEAF_COST;
    if (t->kind == TWIG_FORK) {
        best_share(p, t, WIDE, &cost);
        cost += area;
    }
    t->cost[0] = cost;
    for (int n = 2; n <= WIDE; n++) {
        if (t->kind == TWIG_FORK)
            best_share(p, t, n, &cost);
        t->cost[n - 1] = cost < t->cost[0] ? cost : t->cost[0];
    }
}

/* Returns the twig's number in the part; recursion is at most BVH_DEPTH_LIMIT deep. */
static uint32_t grow(struct builder *b, struct part *p, const struct sah_run *run)
{
    struct twig t = {.run = *run, .kind = TWIG_LEAF};
    struct sah_run halves[2];
    if (run->end - run->begin < b->small) {
        t.kind = TWIG_LEFT;
        t.fork[0] = (uint32_t)b->left.n;
        vec_push(&b->left, (struct branch){.run = *run});
    } else if (sah_split(b->sah, run, halves)) {
        t.kind = TWIG_FORK;
        t.fork[0] = grow(b, p, &halves[0]);
        t.fork[1] = grow(b, p, &halves[1]);
    }
    find_costs(p, &t);
    vec_push(&p->twigs, t);
    return (uint32_t)p->twigs.n - 1;
}

/* ---- nodes of eight children ------------------------------------------------------------------
 */

struct children {
    int n;
    uint32_t twig[WIDE];
};

/* Adds the twig, or the cheapest forest of up to n of its parts. */
static void add_forest(const struct part *p, uint32_t number, int n, bool open, struct children *c)
{
    const struct twig *t = &p->twigs.at[number];
    float cost;
    if (t->kind == TWIG_FORK && n > 1) {
        int k = best_share(p, t, n, &cost);
        if (open || cost < t->cost[0]) {
            add_forest(p, t->fork[0], k, false, c);
            add_forest(p, t->fork[1], n - k, false, c);
            return;
        }
    }
    c->twig[c->n++] = number;
}

static void set_planes(struct wide_node *node, int child, const struct sah_box *box)
{
    for (int axis = 0; axis < 3; axis++) {
        node->plane[0][axis][child] = box->lo[axis];
        node->plane[1][axis][child] = box->hi[axis];
    }
}

/* Pieces of one triangle need be there but once: how many are left of the leaf. */
static uint32_t drop_repeats(struct sah_ref *refs, uint32_t n)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t k = 0;
        while (k < kept && sah_prim(&refs[k]) != sah_prim(&refs[i]))
            k++;
        if (k == kept)
            refs[kept++] = refs[i];
    }
    return kept;
}

static struct wide_child leaf_of(struct builder *b, struct part *p, const struct sah_run *run)
{
    struct leaf leaf = {run->begin, run->end - run->begin};
    if (leaf.count > WIDE || !sah_all_triangles(b->sah, run))
        return (struct wide_child){leaf.first, WIDE_RUN, leaf.count};
    if (b->accel->pieces > 0)
        leaf.count = drop_repeats(b->sah->refs + leaf.first, leaf.count);
    vec_push(&p->leaves, leaf);
    return (struct wide_child){(uint32_t)p->leaves.n - 1, WIDE_TRIANGLES, leaf.count};
}

static uint32_t build_node(struct builder *b, struct part *p, uint32_t twig);

static struct wide_child build_child(struct builder *b, struct part *p, uint32_t twig,
                                     uint32_t node, int child)
{
    const struct twig *t = &p->twigs.at[twig];
    if (t->kind == TWIG_LEAF)
        return leaf_of(b, p, &t->run);
    if (t->kind == TWIG_FORK)
        return (struct wide_child){build_node(b, p, twig), WIDE_NODE, 0};
    b->left.at[t->fork[0]].node = node;
    b->left.at[t->fork[0]].child = child;
    return (struct wide_child){0, WIDE_NODE, 0};
}

/* Returns its number in the part; recursion is at most BVH_DEPTH_LIMIT deep. */
static uint32_t build_node(struct builder *b, struct part *p, uint32_t twig)
{
    static const struct wide_node empty = {0};
    static const struct sah_box nowhere = {{INFINITY, INFINITY, INFINITY},
                                           {-INFINITY, -INFINITY, -INFINITY}};
    uint32_t number = (uint32_t)p->nodes.n;
    struct children c = {0};
    add_forest(p, twig, WIDE, true, &c);
    vec_push(&p->nodes, empty);
    for (int i = 0; i < WIDE; i++)
        set_planes(&p->nodes.at[number], i, i < c.n ? &p->twigs.at[c.twig[i]].run.box : &nowhere);
    for (int i = 0; i < c.n; i++) {
        struct wide_child child = build_child(b, p, c.twig[i], number, i);
        p->nodes.at[number].child[i] = child;
    }
    return number;
}

static void build_part(struct builder *b, struct part *p, const struct sah_run *run)
{
    build_node(b, p, grow(b, p, run));
    vec_free(&p->twigs);
}

static void build_left(void *context, size_t item, unsigned worker)
{
    struct builder *b = context;
    (void)worker;
    build_part(b, &b->parts[item + 1], &b->left.at[item].run);
}

/* ---- a better binary tree ---------------------------------------------------------------------
 */

/* Adds a twig of one of the parts and all below, in an order that does not depend on where the
 * parts begin.  Returns the node's number; recursion is at most BVH_DEPTH_LIMIT deep. */
static uint32_t add_node(struct reinsert_tree *t, const struct builder *b, const struct part *p,
                         uint32_t number)
{
    const struct twig *twig = &p->twigs.at[number];
    if (twig->kind == TWIG_LEFT) {
        const struct part *branch = &b->parts[twig->fork[0] + 1];
        return add_node(t, b, branch, (uint32_t)branch->twigs.n - 1);
    }
    uint32_t at = t->n++;
    struct reinsert_node *n = &t->nodes[at];
    *n = (struct reinsert_node){.box = twig->run.box, .child = {twig->run.begin, twig->run.end}};
    for (int k = 0; k < 2 && twig->kind == TWIG_FORK; k++) {
        n->child[k] = add_node(t, b, p, twig->fork[k]);
        struct reinsert_node *child = &t->nodes[n->child[k]];
        child->parent = at;
        n->height = n->height > child->height ? n->height : child->height + 1;
    }
    return at;
}

/* The node and all below as twigs; returns its twig's number. */
static uint32_t add_twig(struct part *p, const struct reinsert_tree *tree, uint32_t number)
{
    const struct reinsert_node *n = &tree->nodes[number];
    struct twig t = {.run = {.box = n->box}, .kind = n->height > 0 ? TWIG_FORK : TWIG_LEAF};
    if (t.kind == TWIG_LEAF) {
        t.run.begin = n->child[0];
        t.run.end = n->child[1];
    } else {
        t.fork[0] = add_twig(p, tree, n->child[0]);
        t.fork[1] = add_twig(p, tree, n->child[1]);
    }
    find_costs(p, &t);
    vec_push(&p->twigs, t);
    return (uint32_t)p->twigs.n - 1;
}

/* Of all parts' twigs one tree, which is made better, and one part. */
static void join_parts(struct builder *b, unsigned threads, unsigned rounds)
{
    struct part *p = &b->parts[0];
    struct reinsert_tree tree = {.height_limit = BVH_DEPTH_LIMIT - 1};
    size_t n = p->twigs.n;
    for (size_t i = 0; i < b->left.n; i++)
        n += b->parts[i + 1].twigs.n;
    tree.nodes = mem_alloc_aligned(n, sizeof *tree.nodes);
    add_node(&tree, b, p, (uint32_t)p->twigs.n - 1);
    for (size_t i = 0; i <= b->left.n; i++)
        vec_free(&b->parts[i].twigs);
    b->left.n = 0;
    b->wide->moves = reinsert(&tree, rounds, threads);
    build_node(b, p, add_twig(p, &tree, 0));
    vec_free(&p->twigs);
    free(tree.nodes);
}

static void grow_left(void *context, size_t item, unsigned worker)
{
    struct builder *b = context;
    (void)worker;
    grow(b, &b->parts[item + 1], &b->left.at[item].run);
}

/* Above this many primitives threads pay. */
enum { SHARED_LEAST = 10000, SHARES = 8 /* a thread */ };

static void build_parts(struct builder *b, const struct sah_run *all, unsigned threads,
                        unsigned rounds)
{
    struct part first = {0};
    b->small = threads > 1 && b->sah->n >= SHARED_LEAST ? b->sah->n / (SHARES * threads) : 0;
    if (rounds > 0)
        grow(b, &first, all);
    else
        build_part(b, &first, all);
    b->small = 0;
    b->parts = mem_zalloc(b->left.n + 1, sizeof *b->parts);
    b->parts[0] = first;
    thread_share(b->left.n, threads, rounds > 0 ? grow_left : build_left, b);
    if (rounds > 0)
        join_parts(b, threads, rounds);
}

/* Where the parts lie among all nodes and leaves. */
static void place_parts(struct builder *b)
{
    struct wide *w = b->wide;
    for (size_t i = 0; i <= b->left.n; i++) {
        struct part *p = &b->parts[i];
        p->first_node = w->node_count;
        p->first_leaf = w->block_count;
        w->node_count += (uint32_t)p->nodes.n;
        w->block_count += (uint32_t)p->leaves.n;
    }
    for (size_t i = 0; i < b->left.n; i++) {
        const struct branch *branch = &b->left.at[i];
        /* the first part begins at node 0 */
        b->parts[0].nodes.at[branch->node].child[branch->child].first = b->parts[i + 1].first_node;
    }
}

/* ---- what is in them ------------------------------------------------------------------------- */

static void fill_block(const struct accel *a, struct leaf leaf, struct triangle_block *block)
{
    const struct geometry *g = a->geometry;
    for (uint32_t i = 0; i < WIDE; i++) {
        /* what lies behind the last is never looked at */
        struct target target = a->targets[leaf.first + (i < leaf.count ? i : 0)];
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

static void fill_part(void *context, size_t item, unsigned worker)
{
    const struct builder *b = context;
    const struct part *p = &b->parts[item];
    (void)worker;
    for (size_t i = 0; i < p->nodes.n; i++) {
        struct wide_node *node = &b->wide->nodes[p->first_node + i];
        *node = p->nodes.at[i];
        for (int k = 0; k < WIDE; k++) {
            struct wide_child *child = &node->child[k];
            if (child->kind == WIDE_TRIANGLES)
                child->first += p->first_leaf;
            else if (child->kind == WIDE_NODE)
                child->first += p->first_node;
        }
    }
    for (size_t i = 0; i < p->leaves.n; i++)
        fill_block(b->accel, p->leaves.at[i], &b->wide->blocks[p->first_leaf + i]);
}

const struct wide_kernels *wide_kernels_of(enum isa isa)
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

struct wide *wide_build(const struct accel *a, struct sah *sah, const struct sah_run *all,
                        enum isa isa, unsigned threads, double rays)
{
    struct wide *w = mem_zalloc(1, sizeof *w);
    struct builder b = {.sah = sah, .accel = a, .wide = w};
    w->kernels = wide_kernels_of(isa);
    w->frame = sah->frame;
    build_parts(&b, all, threads, reinsert_rounds(sah->n, rays));
    for (uint32_t i = 0; i < sah->n; i++)
        a->targets[i] = target_of(a->geometry, sah_prim(&sah->refs[i]));
    place_parts(&b);
    w->nodes = mem_alloc_aligned(w->node_count, sizeof *w->nodes);
    w->blocks = mem_alloc_aligned(w->block_count, sizeof *w->blocks);
    thread_share(b.left.n + 1, threads, fill_part, &b);
    for (size_t i = 0; i <= b.left.n; i++) {
        vec_free(&b.parts[i].nodes);
        vec_free(&b.parts[i].leaves);
    }
    free(b.parts);
    vec_free(&b.left);
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
