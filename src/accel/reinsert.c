#include "config.h"

#include "accel/reinsert.h"

#include "base/mem.h"
#include "base/thread.h"

#include <stdlib.h>
#include <string.h>

enum {
    ROOT = 0,
    AT_ONCE = 256, /* nodes a thread takes */
    STEPS = 500,   /* places that are looked at for one node: more gained nothing */
};

/* Where a node had better be, and by how much smaller all boxes then are together. */
struct move {
    float gain; /* 0: it stays */
    uint32_t node, place;
};

/* ---- places -----------------------------------------------------------------------------------
 */

struct search {
    const struct reinsert_tree *tree;
    struct move *moves; /* for each node to be moved */
    uint32_t n;
};

static inline struct sah_box joined(struct sah_box a, struct sah_box b)
{
    return (struct sah_box){four_min(a.lo, b.lo), four_max(a.hi, b.hi)};
}

static inline uint32_t sibling_of(const struct reinsert_tree *t, uint32_t node)
{
    const uint32_t *child = t->nodes[t->nodes[node].parent].child;
    return child[child[0] == node];
}

/* A subtree to look through, and what is gained so far: by what the node leaves, less what boxes
 * above grow by. */
struct pending {
    uint32_t node;
    float gain;
};

/* A pair with the node takes at least the node's own area: that bounds the search. */
static void seek_below(const struct reinsert_tree *t, struct pending from, int *steps,
                       struct move *best)
{
    const struct sah_box box = t->nodes[best->node].box;
    const float least = sah_area(&box);
    struct pending stack[REINSERT_HEIGHT + 2], *top = stack;
    *top++ = from;
    while (top > stack && *steps > 0) {
        struct pending at = *--top;
        const struct reinsert_node *n = &t->nodes[at.node];
        if (!(at.gain - least > best->gain))
            continue;
        struct sah_box both = joined(n->box, box);
        float pair = sah_area(&both);
        if (at.gain - pair > best->gain)
            *best = (struct move){at.gain - pair, best->node, at.node};
        at.gain -= pair - sah_area(&n->box);
        for (int k = 0; k < 2 && n->height > 0; k++)
            *top++ = (struct pending){n->child[k], at.gain};
        --*steps;
    }
}

/* Upwards from the node, and from each node above down its other side. */
static struct move best_move(const struct reinsert_tree *t, uint32_t node)
{
    struct move best = {0, node, 0};
    uint32_t at = t->nodes[node].parent, other = sibling_of(t, node);
    float gain = sah_area(&t->nodes[at].box); /* the parent's box is no longer there */
    struct sah_box rest = t->nodes[other].box;
    int steps = STEPS;
    seek_below(t, (struct pending){other, gain}, &steps, &best);
    while (at != ROOT && steps > 0) {
        other = sibling_of(t, at);
        at = t->nodes[at].parent;
        seek_below(t, (struct pending){other, gain}, &steps, &best);
        rest = joined(rest, t->nodes[other].box);
        gain += sah_area(&t->nodes[at].box) - sah_area(&rest);
    }
    return best;
}

static void seek_places(void *context, size_t item, unsigned worker)
{
    struct search *s = context;
    (void)worker;
    for (size_t i = item * AT_ONCE; i < s->n && i < (item + 1) * AT_ONCE; i++)
        s->moves[i] = best_move(s->tree, s->moves[i].node);
}

/* ---- moves ------------------------------------------------------------------------------------
 */

static double area_of(const struct sah_box *b)
{
    double x = (double)b->hi[0] - (double)b->lo[0], y = (double)b->hi[1] - (double)b->lo[1];
    double z = (double)b->hi[2] - (double)b->lo[2];
    return x * y + y * z + z * x;
}

/* Makes the boxes from the node upwards fit; returns what all of them grow by. */
static double refit(struct reinsert_tree *t, uint32_t at)
{
    double growth = 0;
    for (;; at = t->nodes[at].parent) {
        struct reinsert_node *n = &t->nodes[at], old = *n;
        const struct reinsert_node *a = &t->nodes[n->child[0]], *b = &t->nodes[n->child[1]];
        n->height = 1 + (a->height > b->height ? a->height : b->height);
        n->box = joined(a->box, b->box);
        growth += area_of(&n->box) - area_of(&old.box);
        if (at == ROOT || memcmp(n, &old, sizeof old) == 0)
            return growth;
    }
}

/* Puts a node in the place of another. */
static void replace(struct reinsert_tree *t, uint32_t old, uint32_t new)
{
    uint32_t parent = t->nodes[old].parent, *child = t->nodes[parent].child;
    child[child[1] == old] = new;
    t->nodes[new].parent = parent;
}

/* The node's parent goes with it; returns what all boxes grow by. */
static double take_out(struct reinsert_tree *t, uint32_t node)
{
    uint32_t pair = t->nodes[node].parent, other = sibling_of(t, node);
    replace(t, pair, other);
    return refit(t, t->nodes[other].parent) - area_of(&t->nodes[pair].box);
}

static double put_in(struct reinsert_tree *t, uint32_t node, uint32_t place)
{
    uint32_t pair = t->nodes[node].parent, *child = t->nodes[pair].child;
    replace(t, place, pair);
    child[child[0] == node] = place;
    t->nodes[place].parent = pair;
    t->nodes[pair].box = (struct sah_box){four_all(0), four_all(0)};
    return refit(t, pair);
}

static bool is_below(const struct reinsert_tree *t, uint32_t node, uint32_t top)
{
    while (node != top && node != ROOT)
        node = t->nodes[node].parent;
    return node == top;
}

/* Moves before may have changed what it gains, or that it can be made: it is taken back then. */
static bool make_move(struct reinsert_tree *t, const struct move *m)
{
    uint32_t pair = t->nodes[m->node].parent;
    if (pair == ROOT || m->place == pair || is_below(t, m->place, m->node))
        return false;
    uint32_t other = sibling_of(t, m->node);
    double growth = take_out(t, m->node);
    growth += put_in(t, m->node, m->place);
    if (growth < 0 && t->nodes[ROOT].height <= t->height_limit)
        return true;
    take_out(t, m->node);
    put_in(t, m->node, other);
    return false;
}

/* ---- all of it --------------------------------------------------------------------------------
 */

static int by_gain(const void *a, const void *b)
{
    const struct move *x = a, *y = b;
    if (x->gain != y->gain)
        return x->gain > y->gain ? -1 : 1;
    return x->node < y->node ? -1 : x->node > y->node;
}

/* Nodes larger than this, of those that have a grandparent. */
static uint32_t list_nodes(const struct reinsert_tree *t, float area, struct move *moves)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < t->n; i++)
        if (i != ROOT && t->nodes[i].parent != ROOT && sah_area(&t->nodes[i].box) >= area)
            moves[n++].node = i;
    return n;
}

static float mean_area(const struct reinsert_tree *t)
{
    double sum = 0;
    for (uint32_t i = 0; i < t->n; i++)
        sum += (double)sah_area(&t->nodes[i].box);
    return (float)(sum / t->n);
}

/* Returns the number of moves made. */
static uint32_t move_nodes(struct reinsert_tree *t, float area, struct move *moves,
                           unsigned threads)
{
    struct search s = {t, moves, list_nodes(t, area, moves)};
    uint32_t n = 0, made = 0;
    thread_share((s.n + AT_ONCE - 1) / AT_ONCE, threads, seek_places, &s);
    for (uint32_t i = 0; i < s.n; i++)
        if (moves[i].gain > 0)
            moves[n++] = moves[i];
    qsort(moves, n, sizeof *moves, by_gain);
    for (uint32_t i = 0; i < n; i++)
        made += make_move(t, &moves[i]);
    return made;
}

/* Nodes at least this many times as large as the mean are moved, round by round.  Such as the mean
 * are a tenth of all or fewer, take 1 ms where all take 20, and gain most of what there is to gain.
 */
static const float rounds[] = {1, 1, 1, 0.25f, 0};
enum { FEW_ROUNDS = 3, ALL_ROUNDS = sizeof rounds / sizeof *rounds };

/* Rays a primitive.  A few rounds take 60 to 250 ns a primitive; of the 100 to 500 ns of a ray they
 * save up to 7 % in uneven meshes, and nothing in even ones: so they cost no more than 2 or 3 % of
 * the time of the rays.  All rounds take 300 to 500 ns and save another 1 to 3 %. */
enum { RAYS_FOR_FEW = 50, RAYS_FOR_ALL = 500 };

unsigned reinsert_rounds(uint32_t n, double rays)
{
    return rays < RAYS_FOR_FEW * (double)n   ? 0
           : rays < RAYS_FOR_ALL * (double)n ? FEW_ROUNDS
                                             : ALL_ROUNDS;
}

uint32_t reinsert(struct reinsert_tree *t, unsigned count, unsigned threads)
{
    struct move *moves = mem_alloc(t->n, sizeof *moves);
    uint32_t made = 0;
    for (unsigned i = 0; i < count && i < ALL_ROUNDS; i++)
        made += move_nodes(t, rounds[i] * mean_area(t), moves, threads);
    free(moves);
    return made;
}
