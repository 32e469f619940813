/* Single rays through a wide tree.
 *
 * Boxes are only to leave out what cannot be hit: they are tested eight at a time with the padding
 * of traverse.c.  A triangle is left out by the very operations of triangle_meets_axis; for the few
 * that remain target_intersect decides. */
#include "accel/bundle_lanes.h"
#include "accel/wide.h"
#include "math/floats.h"

/* A ray in the tree's frame, its direction made as long as 1 along its longest axis. */
struct wide_walk {
    /* A box's near planes are met at (p - near_origin) near_inverse. */
    vfloat near_origin[3], near_inverse[3], far_origin[3], far_inverse[3];
    size_t near_plane[3], far_plane[3]; /* where the node has them, in floats */
    double start, rate;                 /* distance in the frame = (t - start) rate */
    double slack;                       /* errors of distances along the ray */
};

/* More than four roundings to floats. */
#define FLOAT_SLACK 0x1p-21f

/* The nearest float above x, or the second. */
static inline float float_above(double x)
{
    float f = (float)x;
    return f + (fabsf(f) * 0x1p-23f + FLT_MIN);
}

/* A float at least as far from 0 along the direction as x. */
static inline float float_towards(double x, double direction)
{
    return signbit(direction) ? -float_above(-x) : float_above(x);
}

/* A float where the ray still is before t. */
static inline float wide_distance(const struct wide_walk *w, double t)
{
    return float_above(((t - w->start) * w->rate + w->slack) * (1 + FLOAT_SLACK));
}

/* Rays from far away start anew where they enter the root's box, so that floats can tell where they
 * are; false when they miss it. */
static bool start_near(const struct accel *a, const double origin[3], const double inverse[3],
                       double slack, double *start)
{
    const struct wide_node *root = &a->wide->nodes[0];
    double near = 0, far = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        const float *lo = root->plane[0][axis], *hi = root->plane[1][axis];
        double least = lo[0], most = hi[0];
        for (int i = 1; i < WIDE; i++) {
            least = lo[i] < least ? lo[i] : least;
            most = hi[i] > most ? hi[i] : most;
        }
        double below = (least - slack - origin[axis]) * inverse[axis];
        double above = (most + slack - origin[axis]) * inverse[axis];
        double enter = below < above ? below : above, leave = below < above ? above : below;
        near = enter > near ? enter : near;
        far = leave < far ? leave : far;
    }
    *start = near;
    return near <= far;
}

/* A ray is farther than this from where the geometry is, in units of its size. */
#define FAR_AWAY 4.0

/* Boxes are taken larger by the padding, see walk_along; what making ready rounds is a thousandth
 * of it.  False when the ray misses all. */
static inline bool wide_walk_along(const struct accel *a, const struct ray *ray,
                                   struct wide_walk *w)
{
    const struct tree_frame *f = &a->wide->frame;
    double largest = vec3_largest(ray->direction), to_unit = 1 / largest, origin[3], inverse[3];
    double padding = a->padding * (a->reach + vec3_largest(ray->origin)) * f->scale, away = 0;
    for (int axis = 0; axis < 3; axis++) {
        origin[axis] = (vec3_at(ray->origin, axis) - f->center[axis]) * f->scale;
        inverse[axis] = ray_inverse(vec3_at(ray->direction, axis) * to_unit, 1);
        away = fabs(origin[axis]) > away ? fabs(origin[axis]) : away;
    }
    double start = 0;
    if (away > FAR_AWAY && !start_near(a, origin, inverse, padding, &start))
        return false;
    w->rate = largest * f->scale;
    w->start = start / w->rate;
    if (!(w->rate > 0x1p-900 && w->rate < 0x1p900))
        w->rate = INFINITY, w->start = -1; /* no box is too far away */
    w->slack = 4 * padding;
    for (int axis = 0; axis < 3; axis++) {
        double d = vec3_at(ray->direction, axis), o = origin[axis];
        o += start > 0 ? start * d * to_unit : 0;
        double pad = copysign(padding, d);
        w->near_origin[axis] = f_all(float_towards(o + pad, d));
        w->far_origin[axis] = f_all(float_towards(o - pad, -d));
        w->near_inverse[axis] = f_all((float)(inverse[axis] * (1 - FLOAT_SLACK)));
        w->far_inverse[axis] = f_all((float)(inverse[axis] * (1 + FLOAT_SLACK)));
        size_t lower = (size_t)axis * WIDE, upper = lower + 3 * WIDE;
        w->near_plane[axis] = signbit(d) ? upper : lower;
        w->far_plane[axis] = signbit(d) ? lower : upper;
    }
    return true;
}

/* Where the ray enters the children's boxes; returns those (bit i: child i) that it enters before
 * `end`.  A distance that is no number leaves nothing out. */
static inline unsigned enter_children(const struct wide_walk *w, const struct wide_node *node,
                                      float end, float *enter)
{
    unsigned entered = 0;
    const float *plane = node->plane[0][0];
    const size_t *to = w->near_plane, *from = w->far_plane;
    for (int i = 0; i < WIDE; i += FLOATS) {
        vfloat x0 = (f_load(plane + to[0] + i) - w->near_origin[0]) * w->near_inverse[0];
        vfloat y0 = (f_load(plane + to[1] + i) - w->near_origin[1]) * w->near_inverse[1];
        vfloat z0 = (f_load(plane + to[2] + i) - w->near_origin[2]) * w->near_inverse[2];
        vfloat x1 = (f_load(plane + from[0] + i) - w->far_origin[0]) * w->far_inverse[0];
        vfloat y1 = (f_load(plane + from[1] + i) - w->far_origin[1]) * w->far_inverse[1];
        vfloat z1 = (f_load(plane + from[2] + i) - w->far_origin[2]) * w->far_inverse[2];
        vfloat near = f_max(x0, f_max(y0, f_max(z0, f_all(0))));
        vfloat far = f_min(x1, f_min(y1, f_min(z1, f_all(end))));
        f_store(enter + i, near);
        entered |= f_at_most(near, far) << i;
    }
    return entered;
}

/* p[i] - from in lane i, rounded to floats. */
static inline vfloat f_difference(const double *p, double from)
{
#if defined __AVX512F__ && defined __AVX512DQ__
    return _mm512_cvtpd_ps(v_load(p) - from);
#elif defined __AVX2__
    return _mm256_set_m128(_mm256_cvtpd_ps(v_load(p + 4) - from),
                           _mm256_cvtpd_ps(v_load(p) - from));
#else
    return (vfloat){(float)(p[0] - from), (float)(p[1] - from), (float)(p[2] - from),
                    (float)(p[3] - from)};
#endif
}

/* ---- triangles ------------------------------------------------------------------------------- */

static inline struct vpoint2 corner_sheared(const struct triangle_block *block, int corner, int i,
                                            const struct ray *ray, const struct ray_frame *f,
                                            int axis)
{
    struct vvec3 p = {v_load(block->corner[corner][0] + i) - ray->origin.x,
                      v_load(block->corner[corner][1] + i) - ray->origin.y,
                      v_load(block->corner[corner][2] + i) - ray->origin.z};
    if (axis == 0)
        return (struct vpoint2){p.y - f->shear_x * p.x, p.z - f->shear_y * p.x};
    if (axis == 1)
        return (struct vpoint2){p.z - f->shear_x * p.y, p.x - f->shear_y * p.y};
    return (struct vpoint2){p.x - f->shear_x * p.z, p.y - f->shear_y * p.z};
}

/* The triangles (bit i: triangle i) that triangle_meets_axis does not surely refuse. */
static inline unsigned may_meet_along(const struct triangle_block *block, const struct ray *ray,
                                      const struct ray_frame *f, int axis)
{
    unsigned may = 0;
    for (int i = 0; i < WIDE; i += LANES) {
        struct vpoint2 a = corner_sheared(block, 0, i, ray, f, axis);
        struct vpoint2 b = corner_sheared(block, 1, i, ray, f, axis);
        struct vpoint2 c = corner_sheared(block, 2, i, ray, f, axis);
        may |= v_bits(v_not(edges_surely_pass(edges_of(a, b, c)))) << i;
    }
    return may;
}

static inline unsigned may_meet(const struct triangle_block *block, const struct ray *ray,
                                const struct ray_frame *f)
{
    if (f->axis == 0)
        return may_meet_along(block, ray, f, 0);
    if (f->axis == 1)
        return may_meet_along(block, ray, f, 1);
    return may_meet_along(block, ray, f, 2);
}

static inline bool meet_leaf(const struct accel *a, struct wide_child leaf, const struct ray *ray,
                             const struct ray_frame *frame, bool any_hit, struct hit *hit)
{
    if (leaf.kind == WIDE_RUN)
        return accel_try_run(a, leaf.first, leaf.count, ray, frame, any_hit, hit);
    const struct triangle_block *block = &a->wide->blocks[leaf.first];
    unsigned may = may_meet(block, ray, frame) & ((1u << leaf.count) - 1);
    bool met = false;
    for (; may && !(met && any_hit); may &= may - 1) {
        struct target target = block->target[__builtin_ctz(may)];
        if (!accel_skips(a, target, ray))
            met |= target_intersect(a->geometry, target, ray, frame, hit);
    }
    return met;
}

/* ---- the tree -------------------------------------------------------------------------------- */

struct wide_pending {
    struct wide_child child;
    float enter;
};

/* Pushes the children that are entered, the nearest last. */
static inline struct wide_pending *push_sorted(struct wide_pending *top,
                                               const struct wide_node *node, unsigned entered,
                                               const float *enter)
{
    struct wide_pending *bottom = top;
    for (; entered; entered &= entered - 1, top++) {
        int i = __builtin_ctz(entered);
        struct wide_pending *p = top;
        for (; p > bottom && p[-1].enter < enter[i]; p--)
            *p = p[-1];
        *p = (struct wide_pending){node->child[i], enter[i]};
    }
    return top;
}

/* The nearer of the only two children that are entered; the other is pushed. */
static inline struct wide_child nearer_of_two(struct wide_pending **top,
                                              const struct wide_node *node, unsigned entered,
                                              const float *enter)
{
    int i = __builtin_ctz(entered), k = __builtin_ctz(entered & (entered - 1));
    int nearer = enter[i] <= enter[k] ? i : k, farther = i ^ k ^ nearer;
    *(*top)++ = (struct wide_pending){node->child[farther], enter[farther]};
    return node->child[nearer];
}

/* A box is left out only when it starts behind the best hit, not when it starts at it: an equal hit
 * of a lower number may be inside. */
static void closest_in_wide(const struct accel *a, const struct ray *ray,
                            const struct ray_frame *frame, struct hit *hit)
{
    struct wide_walk walk;
    if (!wide_walk_along(a, ray, &walk))
        return;
    struct wide_pending stack[WIDE_STACK], *top = stack;
    struct wide_child at = {0, WIDE_NODE, 0};
    alignas(32) float enter[WIDE];
    float end = wide_distance(&walk, hit->t);
    for (;;) {
        while (at.kind == WIDE_NODE) {
            const struct wide_node *node = &a->wide->nodes[at.first];
            unsigned entered = enter_children(&walk, node, end, enter);
            unsigned others = entered & (entered - 1);
            if (!entered)
                goto next;
            if (!others) {
                at = node->child[__builtin_ctz(entered)];
            } else if (!(others & (others - 1))) {
                at = nearer_of_two(&top, node, entered, enter);
            } else {
                top = push_sorted(top, node, entered, enter);
                at = (--top)->child;
            }
        }
        double t = hit->t;
        meet_leaf(a, at, ray, frame, false, hit);
        if (hit->t != t)
            end = wide_distance(&walk, hit->t);
    next:
        do {
            if (top == stack)
                return;
            top--;
        } while (top->enter > end);
        at = top->child;
    }
}

static bool any_in_wide(const struct accel *a, const struct ray *ray, const struct ray_frame *frame,
                        struct hit *hit)
{
    struct wide_walk walk;
    if (!wide_walk_along(a, ray, &walk))
        return false;
    struct wide_child stack[WIDE_STACK];
    alignas(32) float enter[WIDE];
    float end = wide_distance(&walk, ray->t_max);
    stack[0] = (struct wide_child){0, WIDE_NODE, 0};
    for (int depth = 1; depth > 0;) {
        struct wide_child at = stack[--depth];
        if (at.kind != WIDE_NODE) {
            if (meet_leaf(a, at, ray, frame, true, hit))
                return true;
            continue;
        }
        const struct wide_node *node = &a->wide->nodes[at.first];
        unsigned entered = enter_children(&walk, node, end, enter);
        for (; entered; entered &= entered - 1)
            stack[depth++] = node->child[__builtin_ctz(entered)];
    }
    return false;
}
