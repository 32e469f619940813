/* What makes a tree better, where rays repay it: nothing is lost, boxes still enclose all there is,
 * and the measure that it is for falls. */
#include "config.h"

#include "unit.h"

#define TRIES_SEED 4
#include "tries.h"

#include "accel/pieces.h"
#include "accel/reinsert.h"
#include "accel/wide.h"

#include <string.h>

#define MANY_RAYS 1e12

static void add_triangle(struct geometry *g, struct vec3 a, struct vec3 b, struct vec3 c)
{
    uint32_t v = geometry_add_vertex(g, a);
    geometry_add_vertex(g, b);
    geometry_add_vertex(g, c);
    geometry_add_triangle(g, 0, v, v + 1, v + 2);
}

/* Thin and aslant, among small ones and spheres. */
static void add_planks(struct geometry *g, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        struct vec3 a = random_vector(10), small = vec3_add(a, random_vector(0.1));
        add_triangle(g, a, random_vector(10), small);
        add_triangle(g, a, vec3_add(a, random_vector(0.3)), small);
        if (below(8) == 0)
            geometry_add_sphere(g, 0, random_vector(10), 0.2);
    }
}

/* A flat floor of as many quads. */
static void add_floor(struct geometry *g, int side)
{
    for (int i = 0; i < side * side; i++) {
        struct vec3 at = vec3(i % side, 0, i / side);
        struct vec3 x = vec3(at.x + 1, 0, at.z), z = vec3(at.x, 0, at.z + 1);
        add_triangle(g, at, x, vec3(x.x, 0, z.z));
        add_triangle(g, at, vec3(x.x, 0, z.z), z);
    }
}

/* ---- pieces -----------------------------------------------------------------------------------
 */

struct cut_up {
    struct geometry g;
    struct target *targets;
    struct sah sah;
    struct sah_run all;
    double area; /* of all boxes */
    uint32_t added;
};

static double boxes_area(const struct sah *s)
{
    double sum = 0;
    for (uint32_t i = 0; i < s->n; i++) {
        struct sah_box box = {s->refs[i].lo.planes, s->refs[i].hi.planes};
        sum += (double)sah_area(&box);
    }
    return sum;
}

/* Of c->g. */
static void cut_up(struct cut_up *c, double rays)
{
    uint32_t n = (uint32_t)c->g.prims.n;
    c->targets = mem_alloc(n, sizeof *c->targets);
    for (uint32_t i = 0; i < n; i++)
        c->targets[i] = target_of(&c->g, i);
    c->all = sah_init(&c->sah, &c->g, c->targets, n, WIDE, 1);
    c->area = boxes_area(&c->sah);
    c->added = pieces_cut(&c->sah, &c->all, &c->g, rays);
    ck_assert_uint_eq(c->sah.n, n + c->added);
    ck_assert_uint_eq(c->all.end, c->sah.n);
}

static void cut_up_free(struct cut_up *c)
{
    sah_free(&c->sah);
    free(c->targets);
    geometry_free(&c->g);
}

static bool encloses(const struct sah_box *box, struct vec3 p)
{
    for (int axis = 0; axis < 3; axis++)
        if (vec3_at(p, axis) < (double)box->lo[axis] || vec3_at(p, axis) > (double)box->hi[axis])
            return false;
    return true;
}

static struct vec3 point_of(const struct geometry *g, uint32_t prim)
{
    const uint32_t *v = g->triangles.at[target_of(g, prim).index].vertex;
    double a = uniform(0, 1), b = uniform(0, 1 - a);
    struct vec3 p = vec3_scale(g->vertices.at[v[0]], 1 - a - b);
    return vec3_mad(vec3_mad(p, a, g->vertices.at[v[1]]), b, g->vertices.at[v[2]]);
}

static bool piece_holds(const struct sah *s, uint32_t prim, struct vec3 p)
{
    for (uint32_t i = 0; i < s->n; i++) {
        struct sah_box box = {s->refs[i].lo.planes, s->refs[i].hi.planes};
        if (sah_prim(&s->refs[i]) == prim && encloses(&box, p))
            return true;
    }
    return false;
}

START_TEST(pieces_cover_what_was_cut)
{
    struct cut_up c = {.added = 0};
    counter = (uint64_t)_i << 40;
    add_planks(&c.g, 100);
    cut_up(&c, MANY_RAYS);
    ck_assert_uint_gt(c.added, 100);
    ck_assert(boxes_area(&c.sah) < 0.5 * c.area);
    for (uint32_t i = 0; i < c.sah.n; i++) {
        struct sah_box box = {c.sah.refs[i].lo.planes, c.sah.refs[i].hi.planes};
        for (int axis = 0; axis < 3; axis++) {
            float center = box.lo[axis] + box.hi[axis];
            ck_assert(box.lo[axis] >= c.all.box.lo[axis] && box.hi[axis] <= c.all.box.hi[axis]);
            ck_assert(center >= c.all.centers.lo[axis] && center <= c.all.centers.hi[axis]);
        }
    }
    for (uint32_t prim = 0; prim < c.g.prims.n; prim++)
        for (int k = 0; k < 20 && c.g.prims.at[prim].kind == PRIM_TRIANGLE; k++)
            ck_assert(
                piece_holds(&c.sah, prim, tree_frame_point(&c.sah.frame, point_of(&c.g, prim))));
    cut_up_free(&c);
}
END_TEST

static struct vec3 whole_numbers(void)
{
    return vec3(below(17) - 8.0, below(17) - 8.0, below(17) - 8.0);
}

/* Corners, and ends of edges, lie on the planes of cuts. */
START_TEST(corners_may_lie_on_cuts)
{
    struct cut_up c = {.added = 0};
    counter = (uint64_t)_i << 40;
    for (int i = 0; i < 100; i++) { /* in pairs, so that the frame's middle is the origin */
        struct vec3 p = whole_numbers(), q = whole_numbers(), r = whole_numbers();
        add_triangle(&c.g, p, q, r);
        add_triangle(&c.g, vec3_neg(p), vec3_neg(q), vec3_neg(r));
    }
    cut_up(&c, MANY_RAYS);
    ck_assert_uint_gt(c.added, 100);
    for (uint32_t prim = 0; prim < c.g.prims.n; prim++)
        for (int k = 0; k < 20; k++)
            ck_assert(
                piece_holds(&c.sah, prim, tree_frame_point(&c.sah.frame, point_of(&c.g, prim))));
    cut_up_free(&c);
}
END_TEST

START_TEST(rays_decide_how_much_is_cut)
{
    static const double rays[] = {0, 1e3, 1e5, 1e6, MANY_RAYS};
    uint32_t added[5];
    for (int i = 0; i < 5; i++) {
        struct cut_up c = {.added = 0};
        counter = 0;
        add_planks(&c.g, 2000);
        cut_up(&c, rays[i]);
        added[i] = c.added;
        cut_up_free(&c);
    }
    ck_assert_uint_eq(added[0], 0);
    ck_assert_uint_eq(added[1], 0);
    ck_assert_uint_gt(added[2], 0);
    ck_assert_uint_gt(added[3], added[2]);
    ck_assert_uint_gt(added[4], added[3]);
}
END_TEST

START_TEST(what_fills_its_box_stays_whole)
{
    struct cut_up c = {.added = 0};
    add_floor(&c.g, 20);
    add_triangle(&c.g, vec3(0, -1, 0), vec3(20, -1, 0), vec3(20, -1, 20));
    geometry_add_cylinder(&c.g, 0, vec3_all(0), vec3_all(20), 0.1);
    cut_up(&c, MANY_RAYS);
    ck_assert_uint_eq(c.added, 0);
    cut_up_free(&c);
}
END_TEST

/* Each would be hundreds. */
START_TEST(pieces_are_limited)
{
    struct cut_up c = {.added = 0};
    for (int i = 0; i < 20000; i++)
        add_triangle(&c.g, random_vector(10), random_vector(10), random_vector(10));
    cut_up(&c, MANY_RAYS);
    ck_assert_uint_gt(c.added, 0);
    ck_assert_uint_le(c.sah.n, 5 * 20000 + 65536);
    cut_up_free(&c);
}
END_TEST

/* ---- subtrees in better places ----------------------------------------------------------------
 */

static struct sah_box joined(struct sah_box a, struct sah_box b)
{
    return (struct sah_box){four_min(a.lo, b.lo), four_max(a.hi, b.hi)};
}

static struct sah_box some_box(double size)
{
    struct vec3 at = random_vector(1), more = vec3_add(at, vec3_all(uniform(0, size)));
    return (struct sah_box){{(float)at.x, (float)at.y, (float)at.z, 0},
                            {(float)more.x, (float)more.y, (float)more.z, 0}};
}

/* Of leaves as they come: low, or one chain.  A leaf's first child is its number. */
static struct reinsert_tree some_tree(uint32_t leaves, bool chain, double size)
{
    struct reinsert_tree t = {.n = 2 * leaves - 1, .height_limit = 80};
    t.nodes = mem_alloc_aligned(t.n, sizeof *t.nodes);
    memset(t.nodes, 0, t.n * sizeof *t.nodes);
    for (uint32_t i = 0, next = 1; i < t.n; i++) {
        struct reinsert_node *n = &t.nodes[i];
        if (next == t.n || (chain && i > 0 && i % 2 == 1)) {
            n->box = some_box(size);
            n->child[0] = i;
            continue;
        }
        n->height = 1;
        for (int k = 0; k < 2; k++) {
            n->child[k] = next++;
            t.nodes[n->child[k]].parent = i;
        }
    }
    for (uint32_t i = t.n; i-- > 0;) {
        struct reinsert_node *n = &t.nodes[i], *a = &t.nodes[n->child[0]];
        const struct reinsert_node *b = &t.nodes[n->child[1]];
        if (n->height == 0)
            continue;
        n->box = joined(a->box, b->box);
        n->height = 1 + (a->height > b->height ? a->height : b->height);
    }
    return t;
}

/* Sum of the areas from a node on; marks the leaves. */
static double check_below(const struct reinsert_tree *t, uint32_t at, bool *seen)
{
    const struct reinsert_node *n = &t->nodes[at];
    if (n->height == 0) {
        ck_assert_uint_eq(n->child[0], at);
        ck_assert(!seen[at]);
        seen[at] = true;
        return 0;
    }
    const struct reinsert_node *a = &t->nodes[n->child[0]], *b = &t->nodes[n->child[1]];
    struct sah_box box = joined(a->box, b->box);
    ck_assert(memcmp(&box, &n->box, sizeof box) == 0);
    ck_assert_uint_eq(n->height, 1 + (a->height > b->height ? a->height : b->height));
    double sum = (double)sah_area(&box);
    for (int k = 0; k < 2; k++) {
        ck_assert_uint_eq(t->nodes[n->child[k]].parent, at);
        sum += check_below(t, n->child[k], seen);
    }
    return sum;
}

static double checked_area(const struct reinsert_tree *t)
{
    bool *seen = mem_zalloc(t->n, sizeof *seen);
    double area = check_below(t, 0, seen);
    uint32_t leaves = 0;
    for (uint32_t i = 0; i < t->n; i++)
        leaves += seen[i];
    ck_assert_uint_eq(2 * leaves, t->n + 1);
    free(seen);
    return area;
}

START_TEST(moves_lose_nothing_and_gain)
{
    counter = (uint64_t)_i << 40;
    bool chain = _i % 2;
    struct reinsert_tree t = some_tree(chain ? 70 : 1000 + below(1000), chain, 0.2), other = t;
    other.nodes = mem_alloc_aligned(t.n, sizeof *t.nodes);
    memcpy(other.nodes, t.nodes, t.n * sizeof *t.nodes);
    double area = checked_area(&t);
    t.height_limit = other.height_limit = t.nodes[0].height + (chain ? 0 : 2);
    for (unsigned rounds = 1; rounds < 6; rounds++) {
        uint32_t moves = reinsert(&t, rounds, 1);
        double less = checked_area(&t);
        ck_assert(less <= area * (1 + 1e-6));
        ck_assert(moves == 0 || less < area);
        ck_assert(rounds > 1 || (moves > 0 && less < 0.9 * area));
        ck_assert_uint_le(t.nodes[0].height, t.height_limit);
        ck_assert_uint_eq(reinsert(&other, rounds, 3), moves);
        ck_assert(memcmp(t.nodes, other.nodes, t.n * sizeof *t.nodes) == 0);
        area = less;
    }
    free(t.nodes);
    free(other.nodes);
}
END_TEST

/* Where nothing can be gained, and in the least of trees. */
START_TEST(moves_end)
{
    for (uint32_t leaves = 1; leaves < 600; leaves += leaves < 5 ? 1 : 200) {
        struct reinsert_tree t = some_tree(leaves, false, 0);
        for (uint32_t i = 0; i < t.n; i++)
            t.nodes[i].box = t.nodes[0].box;
        ck_assert_uint_eq(reinsert(&t, 5, 2), 0);
        checked_area(&t);
        free(t.nodes);
    }
}
END_TEST

START_TEST(rays_decide_how_much_is_moved)
{
    ck_assert_uint_eq(reinsert_rounds(1000, 0), 0);
    ck_assert_uint_eq(reinsert_rounds(1000, 40e3), 0);
    ck_assert_uint_eq(reinsert_rounds(1000, 60e3), 3);
    ck_assert_uint_eq(reinsert_rounds(1000, 1e6), 5);
}
END_TEST

/* ---- trees ------------------------------------------------------------------------------------
 */

/* The leaves below a node that may hold the point, and have the primitive; the root is 0. */
static int leaves_with(const struct accel *a, uint32_t at, uint32_t prim, struct vec3 p)
{
    const struct wide_node *node = &a->wide->nodes[at];
    int found = 0;
    for (int i = 0; i < WIDE; i++) {
        const struct wide_child *child = &node->child[i];
        struct sah_box box;
        for (int axis = 0; axis < 3; axis++) {
            box.lo[axis] = node->plane[0][axis][i];
            box.hi[axis] = node->plane[1][axis][i];
        }
        if (!encloses(&box, p))
            continue;
        if (child->kind == WIDE_NODE)
            found += leaves_with(a, child->first, prim, p);
        for (uint32_t k = 0; k < child->count; k++)
            found +=
                prim == (child->kind == WIDE_RUN ? a->targets[child->first + k].prim
                                                 : a->wide->blocks[child->first].target[k].prim);
    }
    return found;
}

/* No leaf has a primitive twice, and boxes on the way to it enclose it. */
START_TEST(better_trees_hold_everything)
{
    struct geometry g = {0};
    struct accel a;
    counter = (uint64_t)_i << 40;
    add_planks(&g, 300);
    struct accel_options options = {
        .isa = ISA_GENERIC, .threads = 1 + (unsigned)_i % 2, .rays = MANY_RAYS};
    accel_build_with(&a, &g, &options);
    ck_assert_uint_gt(accel_efforts(&a).pieces, 0);
    ck_assert_uint_gt(accel_efforts(&a).moves, 0);
    ck_assert_uint_eq(a.target_count, g.prims.n + a.pieces);
    for (uint32_t prim = 0; prim < g.prims.n; prim++)
        for (int k = 0; k < 5 && g.prims.at[prim].kind == PRIM_TRIANGLE; k++)
            ck_assert_int_ge(
                leaves_with(&a, 0, prim, tree_frame_point(&a.wide->frame, point_of(&g, prim))), 1);
    for (uint32_t i = 0; i < a.wide->node_count; i++) {
        for (int c = 0; c < WIDE; c++) {
            const struct wide_child *child = &a.wide->nodes[i].child[c];
            const struct target *run = a.wide->blocks[child->first].target;
            for (uint32_t k = 1; child->kind == WIDE_TRIANGLES && k < child->count; k++)
                for (uint32_t j = 0; j < k; j++)
                    ck_assert_uint_ne(run[k].prim, run[j].prim);
        }
    }
    accel_free(&a);
    geometry_free(&g);
}
END_TEST

/* So many primitives that threads share them. */
START_TEST(better_trees_do_not_depend_on_threads)
{
    struct geometry g = {0};
    struct accel trees[2];
    counter = 0;
    add_planks(&g, 6000);
    for (int i = 0; i < 2; i++) {
        struct accel_options options = {
            .isa = ISA_GENERIC, .threads = i ? 3 : 1, .rays = MANY_RAYS};
        accel_build_with(&trees[i], &g, &options);
    }
    const struct wide *a = trees[0].wide, *b = trees[1].wide;
    ck_assert_uint_gt(a->moves, 0);
    ck_assert_uint_eq(a->moves, b->moves);
    ck_assert_uint_eq(a->node_count, b->node_count);
    ck_assert_uint_eq(a->block_count, b->block_count);
    ck_assert(memcmp(a->nodes, b->nodes, a->node_count * sizeof *a->nodes) == 0);
    ck_assert(memcmp(a->blocks, b->blocks, a->block_count * sizeof *a->blocks) == 0);
    accel_free(&trees[0]);
    accel_free(&trees[1]);
    geometry_free(&g);
}
END_TEST

Suite *tree_suite(void)
{
    Suite *s = suite_create("tree");
    TCase *c = tcase_create("pieces");
    tcase_add_loop_test(c, pieces_cover_what_was_cut, 0, 5);
    tcase_add_loop_test(c, corners_may_lie_on_cuts, 0, 5);
    tcase_add_test(c, rays_decide_how_much_is_cut);
    tcase_add_test(c, what_fills_its_box_stays_whole);
    tcase_add_test(c, pieces_are_limited);
    suite_add_tcase(s, c);
    c = tcase_create("moves");
    tcase_add_loop_test(c, moves_lose_nothing_and_gain, 0, 8);
    tcase_add_test(c, moves_end);
    tcase_add_test(c, rays_decide_how_much_is_moved);
    suite_add_tcase(s, c);
    c = tcase_create("trees");
    tcase_add_loop_test(c, better_trees_hold_everything, 0, 4);
    tcase_add_test(c, better_trees_do_not_depend_on_threads);
    suite_add_tcase(s, c);
    return s;
}
