/* Flat surfaces that lie in one plane and cover each other in part.
 *
 * Triangles are sorted by their planes: by one number of it after the other, and parted wherever
 * two neighbours differ by more than rounding.  What stays together is laid into a tree of boxes in
 * the plane, in which each triangle looks for earlier ones. */
#include "config.h"

#include "lint/checks.h"
#include "lint/flats.h"

#include <math.h>
#include <stdlib.h>

struct flat {
    struct vec3 v[3];
    double plane[4]; /* a direction of length 1, always on one side; how far along it */
    uint32_t surface;
};

struct ranked {
    double key;
    uint32_t flat;
};

/* A box in a plane, over a part of the ranks. */
struct node {
    double low[2], high[2];
    uint32_t first_surface; /* the least inside */
    uint32_t begin, end,
        other; /* leaves: other is 0; else the second child, the first is the next */
};

struct overlaps {
    const struct lint *l;
    VEC(struct flat) flats;
    struct ranked *ranks;
    VEC(struct node) nodes;
    double extent;  /* the largest coordinate */
    int axes[2];    /* that the plane at hand keeps */
    bool *reported; /* for each surface */
    unsigned looks; /* at other triangles, so far, for the one at hand */
};

/* Beyond so many looks for one triangle the rest is passed over: thin ones across each other. */
enum { LOOKS = 1000 };

/* ---- triangles and their planes ---- */

/* Which of the two directions: seldom across those that scenes have. */
static const struct vec3 SIDE = {0.3091, 0.8147, 0.4907};

static void add_flat(struct overlaps *o, const struct vec3 v[3], uint32_t surface)
{
    if (!(flat_relative_height(v) >= LINT(LEAST_HEIGHT)))
        return; /* no area, or beyond what doubles hold */
    struct vec3 n = flat_normal(v);
    n = vec3_dot(n, SIDE) < 0 ? vec3_neg(n) : n;
    for (int i = 0; i < 3; i++)
        o->extent = fmax(o->extent, vec3_largest(v[i]));
    vec_push(&o->flats,
             (struct flat){{v[0], v[1], v[2]}, {n.x, n.y, n.z, vec3_dot(n, v[0])}, surface});
}

static int compare_ranks(const void *pa, const void *pb)
{
    const struct ranked *a = pa, *b = pb;
    if (a->key != b->key)
        return a->key < b->key ? -1 : 1;
    return a->flat < b->flat ? -1 : a->flat > b->flat;
}

static void sort(struct ranked *ranks, size_t n)
{
    if (n)
        qsort(ranks, n, sizeof *ranks, compare_ranks);
}

/* ---- in one plane ---- */

static double flat_at(const struct overlaps *o, uint32_t flat, int corner, int axis)
{
    return vec3_at(o->flats.at[flat].v[corner], o->axes[axis]);
}

static void widen(struct node *box, double u, double v)
{
    box->low[0] = fmin(box->low[0], u);
    box->low[1] = fmin(box->low[1], v);
    box->high[0] = fmax(box->high[0], u);
    box->high[1] = fmax(box->high[1], v);
}

static struct node box_of(const struct overlaps *o, uint32_t begin, uint32_t end)
{
    struct node box = {.low = {INFINITY, INFINITY},
                       .high = {-INFINITY, -INFINITY},
                       .first_surface = UINT32_MAX,
                       .begin = begin,
                       .end = end};
    for (uint32_t i = begin; i < end; i++) {
        uint32_t flat = o->ranks[i].flat;
        for (int c = 0; c < 3; c++)
            widen(&box, flat_at(o, flat, c, 0), flat_at(o, flat, c, 1));
        if (o->flats.at[flat].surface < box.first_surface)
            box.first_surface = o->flats.at[flat].surface;
    }
    return box;
}

/* Halves along the longer side; as deep as the logarithm of their number. */
static void build(struct overlaps *o, uint32_t begin, uint32_t end)
{
    enum { LEAF = 4 };
    struct node box = box_of(o, begin, end);
    size_t number = o->nodes.n;
    vec_push(&o->nodes, box);
    if (end - begin <= LEAF)
        return;
    int axis = box.high[1] - box.low[1] > box.high[0] - box.low[0];
    for (uint32_t i = begin; i < end; i++) {
        uint32_t flat = o->ranks[i].flat;
        o->ranks[i].key =
            flat_at(o, flat, 0, axis) + flat_at(o, flat, 1, axis) + flat_at(o, flat, 2, axis);
    }
    sort(o->ranks + begin, end - begin);
    uint32_t middle = begin + (end - begin) / 2;
    build(o, begin, middle);
    o->nodes.at[number].other = (uint32_t)o->nodes.n;
    build(o, middle, end);
}

/* ---- two triangles ---- */

struct polygon {
    struct vec2 at[9]; /* three sides cut a triangle to six corners at most */
    int n;
};

static struct polygon project(const struct overlaps *o, uint32_t flat)
{
    struct polygon p = {.n = 3};
    for (int i = 0; i < 3; i++)
        p.at[i] = (struct vec2){flat_at(o, flat, i, 0), flat_at(o, flat, i, 1)};
    return p;
}

static double side_of(struct vec2 a, struct vec2 b, struct vec2 p)
{
    return difference_of_products(b.x - a.x, p.y - a.y, b.y - a.y, p.x - a.x);
}

static double area(const struct polygon *p)
{
    double sum = 0;
    for (int i = 2; i < p->n; i++)
        sum += side_of(p->at[0], p->at[i - 1], p->at[i]);
    return sum / 2;
}

/* What of the polygon lies on one side of the line from a to b (Sutherland, Hodgman). */
static struct polygon cut(const struct polygon *p, struct vec2 a, struct vec2 b, double sign)
{
    struct polygon out = {.n = 0};
    for (int i = 0; i < p->n; i++) {
        struct vec2 from = p->at[i], to = p->at[(i + 1) % p->n];
        double x = sign * side_of(a, b, from), y = sign * side_of(a, b, to);
        if (x >= 0)
            out.at[out.n++] = from;
        if ((x < 0) != (y < 0)) {
            double s = x / (x - y);
            out.at[out.n++] =
                (struct vec2){from.x + s * (to.x - from.x), from.y + s * (to.y - from.y)};
        }
    }
    return out;
}

static bool cover_each_other(const struct overlaps *o, uint32_t a, uint32_t b)
{
    struct polygon p = project(o, a), q = project(o, b);
    double of_p = fabs(area(&p)), of_q = area(&q), sign = of_q < 0 ? -1 : 1;
    for (int i = 0; i < 3 && p.n; i++)
        p = cut(&p, q.at[i], q.at[(i + 1) % 3], sign);
    return p.n > 2 && fabs(area(&p)) > LINT(LEAST_OVERLAP) * fmin(of_p, fabs(of_q));
}

static double distance(const struct flat *f, struct vec3 p)
{
    struct vec3 n = {f->plane[0], f->plane[1], f->plane[2]};
    return fabs(vec3_dot(n, vec3_sub(p, f->v[0])));
}

static bool share_plane(const struct flat *a, const struct flat *b)
{
    double size = 0, off = 0;
    for (int i = 0; i < 3; i++) {
        size = fmax(size, fmax(vec3_largest(a->v[i]), vec3_largest(b->v[i])));
        off = fmax(off, fmax(distance(a, b->v[i]), distance(b, a->v[i])));
    }
    return off <= LINT(ONE_PLANE) * size;
}

/* What has the same corners is told of already (twins.c). */
static bool are_twins(const struct overlaps *o, uint32_t a, uint32_t b)
{
    const struct desc_object *x = o->l->desc->surfaces.at[a], *y = o->l->desc->surfaces.at[b];
    struct vec3 p[2][3], q[2][3];
    if (x->kind != y->kind)
        return false;
    int n = flat_triangles(x, p);
    flat_triangles(y, q);
    for (int i = 0; i < 3 * n; i++)
        if (!vec3_is_zero(vec3_sub(p[i / 3][i % 3], q[i / 3][i % 3])))
            return false;
    return true;
}

static bool is_plain(const struct desc_object *o)
{
    const struct desc_object *m = desc_get(o, PROP_MATERIAL)->object;
    return !desc_get(m, PROP_TEXTURE) && !desc_get(m, PROP_REFRACTION) &&
           !desc_get(o, PROP_NORMAL_MAP);
}

/* Of one colour all over, whichever of the two shows.  Classic does not turn normals to the eye. */
static bool look_alike(const struct overlaps *o, uint32_t a, uint32_t b)
{
    const struct flat *p = &o->flats.at[a], *q = &o->flats.at[b];
    const struct desc_object *x = o->l->desc->surfaces.at[p->surface];
    const struct desc_object *y = o->l->desc->surfaces.at[q->surface];
    bool one_side = vec3_dot(flat_normal(p->v), flat_normal(q->v)) > 0;
    return (one_side || x->model == SCHEMA_MODERN) && is_plain(x) && is_plain(y) &&
           lint_same_material(desc_get(x, PROP_MATERIAL)->object,
                              desc_get(y, PROP_MATERIAL)->object);
}

/* ---- looking for an earlier one ---- */

static bool boxes_meet(const struct node *a, const struct node *b)
{
    return a->low[0] < b->high[0] && b->low[0] < a->high[0] && a->low[1] < b->high[1] &&
           b->low[1] < a->high[1];
}

static bool overlap(struct overlaps *o, uint32_t a, uint32_t b)
{
    o->looks++;
    return share_plane(&o->flats.at[a], &o->flats.at[b]) && cover_each_other(o, a, b) &&
           !are_twins(o, o->flats.at[a].surface, o->flats.at[b].surface) && !look_alike(o, a, b);
}

/* The first surface below `best` that the triangle overlaps; else `best`. */
static uint32_t look(struct overlaps *o, uint32_t node, uint32_t flat, const struct node *box,
                     uint32_t best)
{
    const struct node *n = &o->nodes.at[node];
    if (n->first_surface >= best || !boxes_meet(n, box) || o->looks > LOOKS)
        return best;
    if (n->other) {
        best = look(o, node + 1, flat, box, best);
        return look(o, n->other, flat, box, best);
    }
    for (uint32_t i = n->begin; i < n->end; i++) {
        uint32_t other = o->ranks[i].flat, surface = o->flats.at[other].surface;
        struct node small = box_of(o, i, i + 1);
        if (surface < best && boxes_meet(&small, box) && overlap(o, other, flat))
            best = surface;
    }
    return best;
}

static void report(struct overlaps *o, uint32_t surface, uint32_t earlier)
{
    const struct desc_object *s = o->l->desc->surfaces.at[surface];
    if (o->reported[surface])
        return;
    o->reported[surface] = true;
    o->l->diag->frame = s->frame;
    struct diag_entry *e =
        diag_report(o->l->diag, DIAG_OVERLAPPING_COPLANAR, s->span,
                    "this %s lies in the plane of another and covers part of it: which one shows "
                    "there is chance",
                    schema_kind_name(s->kind, s->xml));
    const struct desc_object *other = o->l->desc->surfaces.at[earlier];
    diag_label_made(e, other->span, other->frame, "the other is here");
    o->l->diag->frame = NULL;
}

/* The ranks hold triangles of about one plane. */
static void check_plane(struct overlaps *o, uint32_t begin, uint32_t end)
{
    const double *n = o->flats.at[o->ranks[begin].flat].plane;
    double x = fabs(n[0]), y = fabs(n[1]), z = fabs(n[2]);
    int across = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    o->axes[0] = across == 0;
    o->axes[1] = across == 2 ? 1 : 2;
    o->nodes.n = 0;
    build(o, begin, end);
    for (uint32_t i = begin; i < end; i++) {
        uint32_t flat = o->ranks[i].flat, own = o->flats.at[flat].surface;
        struct node box = box_of(o, i, i + 1);
        o->looks = 0;
        uint32_t earlier = look(o, 0, flat, &box, own);
        if (earlier < own)
            report(o, own, earlier);
    }
}

/* ---- which are in one plane ---- */

static void part(struct overlaps *o, uint32_t begin, uint32_t end, int number)
{
    if (end - begin < 2)
        return;
    if (number == 4) {
        check_plane(o, begin, end);
        return;
    }
    for (uint32_t i = begin; i < end; i++)
        o->ranks[i].key = o->flats.at[o->ranks[i].flat].plane[number];
    sort(o->ranks + begin, end - begin);
    double gap = LINT(ONE_PLANE) * (number == 3 ? o->extent : 1);
    for (uint32_t i = begin, first; i < end;) {
        for (first = i++; i < end && o->ranks[i].key - o->ranks[i - 1].key <= gap;)
            i++;
        part(o, first, i, number + 1);
    }
}

void lint_overlaps(const struct lint *l)
{
    const struct desc *d = l->desc;
    struct overlaps o = {.l = l, .reported = mem_zalloc(d->surfaces.n, sizeof(bool))};
    for (size_t i = 0; i < d->surfaces.n; i++) {
        struct vec3 t[2][3];
        for (int k = flat_triangles(d->surfaces.at[i], t); k-- > 0;)
            add_flat(&o, t[k], (uint32_t)i);
    }
    o.ranks = mem_zalloc(o.flats.n, sizeof *o.ranks);
    for (size_t i = 0; i < o.flats.n; i++)
        o.ranks[i].flat = (uint32_t)i;
    part(&o, 0, (uint32_t)o.flats.n, 0);
    free(o.ranks);
    free(o.reported);
    vec_free(&o.flats);
    vec_free(&o.nodes);
}
