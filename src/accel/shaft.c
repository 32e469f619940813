#include "config.h"

#include "accel/shaft.h"
#include "accel/wide.h"

/* Far more than the rounding errors of the shaft's own arithmetic and a box's padding together:
 * this many times the latter. */
#define SHAFT_PADDING 16

static double box_reach(struct box b)
{
    double lo = vec3_largest(b.lo), hi = vec3_largest(b.hi);
    return lo > hi ? lo : hi;
}

static double inverse_growth(double growth, double largest)
{
    double least = largest * 0x1p-60;
    return 1 / (fabs(growth) < least ? copysign(least, growth) : growth);
}

/* lo_growth and hi_growth: by how much the bounds move while t grows by 1. */
static void make_ready(struct shaft *s, struct vec3 lo_growth, struct vec3 hi_growth)
{
    double l = vec3_largest(lo_growth), h = vec3_largest(hi_growth), largest = l > h ? l : h;
    for (int axis = 0; axis < 3; axis++) {
        s->lo[axis] = vec3_at(s->start.lo, axis) - s->padding;
        s->hi[axis] = vec3_at(s->start.hi, axis) + s->padding;
        s->lo_inverse[axis] = inverse_growth(vec3_at(lo_growth, axis), largest);
        s->hi_inverse[axis] = inverse_growth(vec3_at(hi_growth, axis), largest);
    }
}

struct shaft shaft_of_rays(const struct accel *a, struct box origins, struct box directions)
{
    struct shaft s;
    s.start = s.end = origins;
    s.t_max = INFINITY;
    s.endless = true;
    s.spawned = false;
    s.from = PRIM_NONE;
    s.padding = SHAFT_PADDING * a->padding * (a->reach + box_reach(origins));
    make_ready(&s, directions.lo, directions.hi);
    return s;
}

/* Beyond q the rays spread again: the shaft ends in the box of all p + t_max (q - p). */
struct shaft shaft_between(const struct accel *a, struct box p, struct box q, double t_max)
{
    double on = t_max - 1;
    struct box end = {vec3_mad(vec3_scale(q.lo, t_max), -on, p.hi),
                      vec3_mad(vec3_scale(q.hi, t_max), -on, p.lo)};
    struct shaft s;
    s.start = p;
    s.end = box_join(end, q);
    s.t_max = 1;
    s.endless = false;
    s.spawned = true;
    s.from = PRIM_NONE;
    s.padding = SHAFT_PADDING * a->padding * (a->reach + box_reach(p) + box_reach(s.end));
    make_ready(&s, vec3_sub(s.end.lo, p.lo), vec3_sub(s.end.hi, p.hi));
    return s;
}

/* Whether at some t the shaft's bounds overlap the box on every axis. */
static bool touches_box(const struct shaft *s, const double lo[3], const double hi[3])
{
    double from = 0, to = s->t_max;
    for (int axis = 0; axis < 3; axis++) {
        double below = (hi[axis] - s->lo[axis]) * s->lo_inverse[axis];
        double above = (lo[axis] - s->hi[axis]) * s->hi_inverse[axis];
        if (s->lo_inverse[axis] > 0)
            to = below < to ? below : to;
        else
            from = below > from ? below : from;
        if (s->hi_inverse[axis] > 0)
            from = above > from ? above : from;
        else
            to = above < to ? above : to;
    }
    return from <= to;
}

/* The range of n . x over a box. */
static void range_along(struct vec3 n, struct box b, double *least, double *most)
{
    struct vec3 lo = vec3_mul(n, b.lo), hi = vec3_mul(n, b.hi);
    struct vec3 low = vec3_min(lo, hi), high = vec3_max(lo, hi);
    *least = low.x + low.y + low.z;
    *most = high.x + high.y + high.z;
}

/* Whether rays from start to end can hit the triangle's plane: not when all of them stay on one
 * side, nor when they are spawned on the plane itself. */
static bool crosses_plane(const struct accel *a, const struct shaft *s, uint32_t index)
{
    const struct triangle *t = &a->geometry->triangles.at[index];
    struct vec3 v0 = a->geometry->vertices.at[t->vertex[0]];
    double at = vec3_dot(t->normal, v0), start[2], end[2];
    range_along(t->normal, s->start, &start[0], &start[1]);
    range_along(t->normal, s->end, &end[0], &end[1]);
    if (start[0] - at > s->padding && end[0] - at > s->padding)
        return false;
    if (start[1] - at < -s->padding && end[1] - at < -s->padding)
        return false;
    double rounding = 0.25 * SPAWN_TOLERANCE * vec3_largest(v0);
    return !(s->spawned && start[1] - at <= rounding && start[0] - at >= -rounding);
}

bool shaft_touches_box(const struct shaft *s, struct box b)
{
    double lo[3] = {b.lo.x, b.lo.y, b.lo.z}, hi[3] = {b.hi.x, b.hi.y, b.hi.z};
    return touches_box(s, lo, hi);
}

/* The boxes of a slanting cylinder's slices are closer to it than its own box. */
static bool touches_cylinder(const struct shaft *s, const struct cylinder *c)
{
    enum { SLICES = 4 };
    struct vec3 e = c->axis, slice = vec3_scale(e, c->height / SLICES), from = c->base;
    struct vec3 disc =
        vec3(sqrt(e.y * e.y + e.z * e.z), sqrt(e.z * e.z + e.x * e.x), sqrt(e.x * e.x + e.y * e.y));
    disc = vec3_scale(disc, c->radius);
    for (int i = 0; i < SLICES; i++) {
        struct vec3 to = vec3_add(from, slice);
        if (shaft_touches_box(s, (struct box){vec3_sub(vec3_min(from, to), disc),
                                              vec3_add(vec3_max(from, to), disc)}))
            return true;
        from = to;
    }
    return false;
}

bool shaft_touches(const struct accel *a, const struct shaft *s, struct target target)
{
    if (target.kind == PRIM_TRIANGLE && target.prim == s->from)
        return false;
    if (!shaft_touches_box(s, target_bounds(a->geometry, target)))
        return false;
    if (target.kind == PRIM_CYLINDER)
        return touches_cylinder(s, &a->geometry->cylinders.at[target.index]);
    return target.kind != PRIM_TRIANGLE || s->endless || crosses_plane(a, s, target.index);
}

/* Pieces of a triangle are in several leaves. */
static bool is_listed(const struct accel *a, const struct target_list *list, uint32_t prim)
{
    for (uint32_t i = 0; a->pieces > 0 && i < list->n; i++)
        if (list->at[i].prim == prim)
            return true;
    return false;
}

static bool add_run(const struct accel *a, const struct shaft *s, const struct target *run,
                    uint32_t count, struct target_list *list)
{
    for (uint32_t i = 0; i < count; i++) {
        if (!shaft_touches(a, s, run[i]) || is_listed(a, list, run[i].prim))
            continue;
        if (list->n == TARGET_LIST_LIMIT || run[i].kind == PRIM_INSTANCE)
            return false;
        list->nearest[list->n] = 0;
        list->at[list->n++] = run[i];
    }
    return true;
}

static bool add_tree(const struct accel *a, const struct shaft *s, struct target_list *list)
{
    uint32_t stack[BVH_DEPTH_LIMIT + 1] = {0};
    int depth = 1;
    while (depth > 0) {
        const struct bvh_node *node = &a->nodes[stack[--depth]];
        for (int child = 0; child < 2; child++) {
            if (!touches_box(s, node->plane[child][0], node->plane[child][1]))
                continue;
            if (node->count[child] == 0)
                stack[depth++] = node->first[child];
            else if (!add_run(a, s, a->targets + node->first[child], node->count[child], list))
                return false;
        }
    }
    return true;
}

/* The shaft in the frame of a wide tree. */
static struct shaft shaft_in_frame(const struct shaft *s, const struct tree_frame *f)
{
    struct shaft inner = *s;
    for (int axis = 0; axis < 3; axis++) {
        inner.lo[axis] = (s->lo[axis] - f->center[axis]) * f->scale;
        inner.hi[axis] = (s->hi[axis] - f->center[axis]) * f->scale;
    }
    inner.t_max = s->t_max * f->scale;
    return inner;
}

/* When the shaft's bound, which starts at `from`, passes each of the planes: from then on it
 * touches their boxes, or no longer. */
static void clip_to_planes(const float planes[WIDE], double from, double inverse, bool ends,
                           double start[WIDE], double end[WIDE])
{
    double at[WIDE];
    for (int i = 0; i < WIDE; i++)
        at[i] = (planes[i] - from) * inverse;
    if (ends)
        for (int i = 0; i < WIDE; i++)
            end[i] = at[i] < end[i] ? at[i] : end[i];
    else
        for (int i = 0; i < WIDE; i++)
            start[i] = at[i] > start[i] ? at[i] : start[i];
}

/* As touches_box for all children.  Bit i: child i. */
static unsigned touched_children(const struct shaft *s, const struct wide_node *node)
{
    double start[WIDE], end[WIDE];
    unsigned touched = 0;
    for (int i = 0; i < WIDE; i++) {
        start[i] = 0;
        end[i] = s->t_max;
    }
    for (int axis = 0; axis < 3; axis++) {
        const double lo = s->lo_inverse[axis], hi = s->hi_inverse[axis];
        clip_to_planes(node->plane[1][axis], s->lo[axis], lo, lo > 0, start, end);
        clip_to_planes(node->plane[0][axis], s->hi[axis], hi, !(hi > 0), start, end);
    }
    for (int i = 0; i < WIDE; i++)
        touched |= (unsigned)(start[i] <= end[i]) << i;
    return touched;
}

static bool add_leaf(const struct accel *a, const struct shaft *s, struct wide_child leaf,
                     struct target_list *list)
{
    if (leaf.kind == WIDE_RUN)
        return add_run(a, s, a->targets + leaf.first, leaf.count, list);
    return add_run(a, s, a->wide->blocks[leaf.first].target, leaf.count, list);
}

static bool add_wide(const struct accel *a, const struct shaft *s, struct target_list *list)
{
    struct shaft inner = shaft_in_frame(s, &a->wide->frame);
    uint32_t stack[WIDE_STACK];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const struct wide_node *node = &a->wide->nodes[stack[--depth]];
        for (unsigned left = touched_children(&inner, node); left; left &= left - 1) {
            struct wide_child child = node->child[__builtin_ctz(left)];
            if (child.kind == WIDE_NODE)
                stack[depth++] = child.first;
            else if (!add_leaf(a, s, child, list))
                return false;
        }
    }
    return true;
}

/* So few targets are tried without a tree. */
enum { FEW_TARGETS = 8 };

void shaft_list(const struct accel *a, const struct shaft *s, struct target_list *list)
{
    list->n = 0;
    if (a->target_count <= FEW_TARGETS)
        list->usable = add_run(a, s, a->targets, a->target_count, list);
    else if (a->wide)
        list->usable = add_wide(a, s, list);
    else if (a->nodes)
        list->usable = add_tree(a, s, list);
    else
        list->usable = add_run(a, s, a->targets, a->target_count, list);
}

void shaft_narrow(const struct accel *a, const struct shaft *s, const struct target_list *from,
                  struct target_list *list)
{
    list->n = 0;
    list->usable = from->usable;
    for (uint32_t i = 0; i < from->n; i++) {
        if (!shaft_touches(a, s, from->at[i]))
            continue;
        list->nearest[list->n] = from->nearest[i];
        list->at[list->n++] = from->at[i];
    }
}

/* Distance between two boxes. */
static double gap(struct box a, struct box b)
{
    struct vec3 d = vec3_max(vec3_sub(a.lo, b.hi), vec3_sub(b.lo, a.hi));
    return vec3_length(vec3_max(d, vec3_all(0)));
}

static double distance_to(const struct accel *a, const struct shaft *s, struct target target)
{
    double d;
    if (target.kind == PRIM_SPHERE) {
        const struct sphere *sphere = &a->geometry->spheres.at[target.index];
        d = gap(s->start, (struct box){sphere->center, sphere->center}) - sphere->radius;
    } else {
        d = gap(s->start, geometry_prim_bounds(a->geometry, target.prim));
    }
    d = d * (1 - 0x1p-30) - s->padding;
    return d > 0 ? d : 0;
}

void shaft_sort(const struct accel *a, const struct shaft *s, struct target_list *list)
{
    for (uint32_t i = 0; i < list->n; i++) {
        struct target target = list->at[i];
        double d = distance_to(a, s, target);
        uint32_t k = i;
        for (; k > 0 && list->nearest[k - 1] > d; k--) {
            list->nearest[k] = list->nearest[k - 1];
            list->at[k] = list->at[k - 1];
        }
        list->nearest[k] = d;
        list->at[k] = target;
    }
}
