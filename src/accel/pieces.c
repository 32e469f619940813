#include "config.h"

#include "accel/pieces.h"

#include "base/vec.h"

/* A cut saves rays the tests of what is no longer in their way: in expectation, as many as the
 * surface areas of the boxes become less, over the area of the box around all.
 *
 * RAYS_A_CUT: a piece takes about 1 us to make and to build into the tree, and a test that is saved
 * about 10 ns; measured by 2400 planks in a room, on a mesh with some large triangles, and on one
 * without.
 * LEAST_SHARE: pieces that save less than that gained nothing any more, or lost to what the larger
 * tree takes in caches.
 * CROWD: triangles that are no larger than their neighbours, all of them in such leaves as no cut
 * makes smaller, stay whole: meshes became 4 % slower where the bound was 1 / n. */
#define RAYS_A_CUT 800.0
#define LEAST_SHARE 3e-4
#define CROWD 3.0

enum {
    CORNERS = 16,     /* of a polygon; three and one for each cut, unless roundings add some */
    CUTS_DEEP = 8,    /* a triangle becomes at most 2^8 pieces */
    MOST_TIMES = 4,   /* so many pieces for each primitive, */
    MOST_MORE = 65536 /* and these beside them */
};

struct polygon {
    int n;
    struct vec3 at[CORNERS];
};

/* In the tree's frame. */
struct piece {
    uint32_t ref;
    struct box box;
};

struct cutting {
    double least; /* area that a cut saves */
    size_t most;  /* pieces */
    VEC(struct piece) pieces;
};

static struct box polygon_box(const struct polygon *p)
{
    struct box box = box_empty();
    for (int i = 0; i < p->n; i++)
        box = box_add(box, p->at[i]);
    return box;
}

/* Sum of the areas of its shadows along the axes: no box around it, or boxes around its parts, have
 * less. */
static double polygon_shadows(const struct polygon *p)
{
    struct vec3 sum = vec3_all(0);
    for (int i = 1; i + 1 < p->n; i++)
        sum = vec3_add(sum,
                       vec3_cross(vec3_sub(p->at[i], p->at[0]), vec3_sub(p->at[i + 1], p->at[0])));
    return 0.5 * (fabs(sum.x) + fabs(sum.y) + fabs(sum.z));
}

/* The part of the polygon on one side of a plane across the axis; false when it has too many
 * corners. */
static bool clip(const struct polygon *p, int axis, double plane, double side, struct polygon *out)
{
    out->n = 0;
    for (int i = 0; i < p->n; i++) {
        struct vec3 a = p->at[i], b = p->at[i + 1 < p->n ? i + 1 : 0];
        double from = (vec3_at(a, axis) - plane) * side, to = (vec3_at(b, axis) - plane) * side;
        if (out->n + 2 > CORNERS)
            return false;
        if (from >= 0)
            out->at[out->n++] = a;
        if ((from < 0 && to > 0) || (from > 0 && to < 0))
            out->at[out->n++] = vec3_mad(a, from / (from - to), vec3_sub(b, a));
    }
    return out->n > 0;
}

/* The coarsest of all planes at a whole multiple of a power of two: so cuts of neighbours meet. */
static double plane_between(double lo, double hi)
{
    for (double step = 1; step > 0x1p-20; step *= 0.5) {
        double plane = (floor(lo / step) + 1) * step;
        if (plane < hi)
            return plane;
    }
    return hi;
}

/* The cut that leaves the least area; returns that, or infinity where none can be made. */
static double best_cut(const struct polygon *p, struct box box, struct polygon halves[2])
{
    double best = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double plane = plane_between(vec3_at(box.lo, axis), vec3_at(box.hi, axis));
        struct polygon h[2];
        if (!(plane > vec3_at(box.lo, axis) && plane < vec3_at(box.hi, axis)) ||
            !clip(p, axis, plane, -1, &h[0]) || !clip(p, axis, plane, 1, &h[1]))
            continue;
        double area = box_half_area(polygon_box(&h[0])) + box_half_area(polygon_box(&h[1]));
        if (!(area < best))
            continue;
        best = area;
        halves[0] = h[0];
        halves[1] = h[1];
    }
    return best;
}

/* Two triangles of a quad fill their common box and are in one leaf: what fills half of its box had
 * better stay whole.  Recursion is at most CUTS_DEEP deep. */
static void cut(struct cutting *c, uint32_t ref, const struct polygon *p, int depth)
{
    struct box box = polygon_box(p);
    struct polygon halves[2];
    double area = box_half_area(box);
    if (c->pieces.n > c->most)
        return;
    if (depth < CUTS_DEEP && area - 2 * polygon_shadows(p) > c->least &&
        area - best_cut(p, box, halves) > c->least) {
        cut(c, ref, &halves[0], depth + 1);
        cut(c, ref, &halves[1], depth + 1);
    } else {
        vec_push(&c->pieces, (struct piece){ref, box});
    }
}

/* Hits of a triangle are computed from it as a whole, and are no farther off it than roundings,
 * for which boxes are padded; so they are in the box of some piece. */
static struct polygon triangle_in_frame(const struct sah *s, const struct geometry *g,
                                        uint32_t prim)
{
    const struct triangle *t = &g->triangles.at[target_of(g, prim).index];
    struct polygon p = {.n = 3};
    for (int i = 0; i < 3; i++)
        p.at[i] = tree_frame_point(&s->frame, g->vertices.at[t->vertex[i]]);
    return p;
}

static void cut_all(struct cutting *c, const struct sah *s, const struct geometry *g)
{
    c->pieces.n = 0;
    for (uint32_t i = 0; i < s->n; i++) {
        struct sah_box box = {s->refs[i].lo.planes, s->refs[i].hi.planes};
        if (sah_is_triangle(&s->refs[i]) && (double)sah_area(&box) > c->least) {
            struct polygon p = triangle_in_frame(s, g, sah_prim(&s->refs[i]));
            cut(c, i, &p, 0);
        }
    }
}

/* The first piece in the place of the triangle, the others behind all. */
static void put_pieces(struct sah *s, struct sah_run *all, const struct cutting *c)
{
    s->refs = mem_realloc(s->refs, s->n + c->pieces.n, sizeof *s->refs);
    for (size_t i = 0; i < c->pieces.n; i++) {
        const struct piece *piece = &c->pieces.at[i];
        bool first = i == 0 || piece[-1].ref != piece->ref;
        struct sah_ref *r = &s->refs[first ? piece->ref : s->n++];
        *r = s->refs[piece->ref];
        sah_set_box(r, piece->box);
        sah_take(all, r);
    }
    all->end = s->n;
}

uint32_t pieces_cut(struct sah *s, struct sah_run *all, const struct geometry *g, double rays)
{
    double share = fmax(fmax(LEAST_SHARE, CROWD / s->n), RAYS_A_CUT / rays);
    struct cutting c = {.most = MOST_TIMES * (size_t)s->n + MOST_MORE};
    uint32_t before = s->n;
    if (!(share < 1) || s->n > UINT32_MAX / (2 * MOST_TIMES) - MOST_MORE)
        return 0;
    do {
        c.least = share * (double)sah_area(&all->box);
        cut_all(&c, s, g);
        share *= 2;
    } while (c.pieces.n > c.most && share < 1);
    if (c.pieces.n <= c.most)
        put_pieces(s, all, &c);
    vec_free(&c.pieces);
    return s->n - before;
}
