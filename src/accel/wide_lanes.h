/* Single rays through a wide tree.
 *
 * Boxes are only to leave out what cannot be hit: they are tested eight at a time with the padding
 * of traverse.c.  A triangle is left out by the very operations of triangle_meets_axis; for the few
 * that remain target_intersect decides. */
#include "accel/bundle_lanes.h"
#include "accel/wide.h"

struct wide_walk {
    vreal inverse[3], near[3], far[3]; /* a plane is met at inverse p - near (or far) */
    int negative[3];
};

/* See walk_along.  The planes' distances by one fused operation are off by less than a plane moved
 * by 2^-52 of the coordinates involved, a thousandth of the padding. */
static inline struct wide_walk wide_walk_along(const struct accel *a, const struct ray *ray)
{
    struct wide_walk w;
    double padding = a->padding * (a->reach + vec3_largest(ray->origin));
    double largest = vec3_largest(ray->direction);
    for (int axis = 0; axis < 3; axis++) {
        double o = vec3_at(ray->origin, axis), d = vec3_at(ray->direction, axis);
        double inverse = ray_inverse(d, largest), pad = copysign(padding, d);
        w.inverse[axis] = v_all(inverse);
        w.near[axis] = v_all((o + pad) * inverse);
        w.far[axis] = v_all((o - pad) * inverse);
        w.negative[axis] = signbit(d) != 0;
    }
    return w;
}

/* Where the ray enters the children's boxes; returns those (bit i: child i) that it enters before
 * t_max.  A distance that is no number leaves nothing out. */
static inline unsigned enter_children(const struct wide_walk *w, const struct wide_node *node,
                                      double t_max, double *enter)
{
    unsigned entered = 0;
    for (int i = 0; i < WIDE; i += LANES) {
        vreal near = v_all(0), far = v_all(t_max);
        for (int axis = 0; axis < 3; axis++) {
            int negative = w->negative[axis];
            vreal to = v_load(node->plane[negative][axis] + i);
            vreal from = v_load(node->plane[!negative][axis] + i);
            near = v_max(v_bound(to, w->inverse[axis], -w->near[axis]), near);
            far = v_min(v_bound(from, w->inverse[axis], -w->far[axis]), far);
        }
        v_store(enter + i, near);
        entered |= v_bits(v_at_most(near, far)) << i;
    }
    return entered;
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
    double enter;
    struct wide_child child;
};

/* Pushes the children that are entered, the nearest last. */
static inline struct wide_pending *push_sorted(struct wide_pending *top,
                                               const struct wide_node *node, unsigned entered,
                                               const double *enter)
{
    struct wide_pending *bottom = top;
    for (; entered; entered &= entered - 1, top++) {
        int i = __builtin_ctz(entered);
        struct wide_pending *p = top;
        for (; p > bottom && p[-1].enter < enter[i]; p--)
            *p = p[-1];
        *p = (struct wide_pending){enter[i], node->child[i]};
    }
    return top;
}

/* A box is left out only when it starts behind the best hit, not when it starts at it: an equal hit
 * of a lower number may be inside. */
static void closest_in_wide(const struct accel *a, const struct ray *ray,
                            const struct ray_frame *frame, struct hit *hit)
{
    struct wide_walk walk = wide_walk_along(a, ray);
    struct wide_pending stack[WIDE_STACK], *top = stack;
    struct wide_child at = {0, WIDE_NODE, 0};
    alignas(64) double enter[WIDE];
    for (;;) {
        if (at.kind == WIDE_NODE) {
            const struct wide_node *node = &a->wide->nodes[at.first];
            unsigned entered = enter_children(&walk, node, hit->t, enter);
            if (entered && !(entered & (entered - 1))) {
                at = node->child[__builtin_ctz(entered)];
                continue;
            }
            top = push_sorted(top, node, entered, enter);
        } else {
            meet_leaf(a, at, ray, frame, false, hit);
        }
        do {
            if (top == stack)
                return;
            top--;
        } while (top->enter > hit->t);
        at = top->child;
    }
}

static bool any_in_wide(const struct accel *a, const struct ray *ray, const struct ray_frame *frame,
                        struct hit *hit)
{
    struct wide_walk walk = wide_walk_along(a, ray);
    struct wide_child stack[WIDE_STACK];
    alignas(64) double enter[WIDE];
    stack[0] = (struct wide_child){0, WIDE_NODE, 0};
    for (int depth = 1; depth > 0;) {
        struct wide_child at = stack[--depth];
        if (at.kind != WIDE_NODE) {
            if (meet_leaf(a, at, ray, frame, true, hit))
                return true;
            continue;
        }
        const struct wide_node *node = &a->wide->nodes[at.first];
        unsigned entered = enter_children(&walk, node, ray->t_max, enter);
        for (; entered; entered &= entered - 1)
            stack[depth++] = node->child[__builtin_ctz(entered)];
    }
    return false;
}
