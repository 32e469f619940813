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
    /* A box's near planes are met at p near_inverse + near_start. */
    vfloat near_inverse[3], near_start[3], far_inverse[3], far_start[3];
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

static inline float float_below(double x)
{
    return -float_above(-x);
}

/* Floats above x, and by what f_bound of planes and factors rounds. */
static inline vfour four_above(vquad x, vfour factors)
{
    vfour f = quad_floats(x);
    return f + (four_abs(f) * 0x1p-23f + FLT_MIN + four_abs(factors) * F_BOUND_ERROR);
}

/* A float where the ray still is before t. */
static inline float wide_distance(const struct wide_walk *w, double t)
{
    return float_above(((t - w->start) * w->rate + w->slack) * (1 + FLOAT_SLACK));
}

/* Rays from far away start anew where they enter the root's box, so that floats can tell where they
 * are; false when they miss it. */
static bool start_near(const struct accel *a, const vquad *origin, const vquad *inverse,
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
        double below = (least - slack - (*origin)[axis]) * (*inverse)[axis];
        double above = (most + slack - (*origin)[axis]) * (*inverse)[axis];
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
    double largest = vec3_largest(ray->direction), start = 0;
    double padding = a->padding * (a->reach + vec3_largest(ray->origin)) * f->scale;
    vquad direction = quad_of(ray->direction), shortest = quad_all(largest * 0x1p-60);
    /* see ray_inverse */
    vquad inverse = quad_select(quad_abs(direction) < shortest,
                                quad_copysign(quad_all(0x1p60), direction), largest / direction);
    vquad center = {f->center[0], f->center[1], f->center[2], 0};
    vquad origin = (quad_of(ray->origin) - center) * f->scale;
    if (quad_any(quad_all(FAR_AWAY) < quad_abs(origin))) {
        if (!start_near(a, &origin, &inverse, padding, &start))
            return false;
        origin += start > 0 ? start * direction / largest : quad_all(0);
    }
    w->rate = largest * f->scale;
    w->start = start / w->rate;
    if (!(w->rate > 0x1p-900 && w->rate < 0x1p900))
        w->rate = INFINITY, w->start = -1; /* no box is too far away */
    w->slack = 4 * padding;
    vquad pad = quad_copysign(quad_all(padding), direction);
    vfour near = quad_floats(inverse * (1 - FLOAT_SLACK));
    vfour far = quad_floats(inverse * (1 + FLOAT_SLACK));
    vfour near_start = -four_above((origin + pad) * quad_wide(near), near);
    vfour far_start = four_above((pad - origin) * quad_wide(far), far);
    for (int axis = 0; axis < 3; axis++) {
        w->near_inverse[axis] = f_all(near[axis]);
        w->near_start[axis] = f_all(near_start[axis]);
        w->far_inverse[axis] = f_all(far[axis]);
        w->far_start[axis] = f_all(far_start[axis]);
        size_t lower = (size_t)axis * WIDE, upper = lower + 3 * WIDE;
        bool down = signbit(direction[axis]);
        w->near_plane[axis] = down ? upper : lower;
        w->far_plane[axis] = down ? lower : upper;
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
        vfloat x0 = f_bound(f_load(plane + to[0] + i), w->near_inverse[0], w->near_start[0]);
        vfloat y0 = f_bound(f_load(plane + to[1] + i), w->near_inverse[1], w->near_start[1]);
        vfloat z0 = f_bound(f_load(plane + to[2] + i), w->near_inverse[2], w->near_start[2]);
        vfloat x1 = f_bound(f_load(plane + from[0] + i), w->far_inverse[0], w->far_start[0]);
        vfloat y1 = f_bound(f_load(plane + from[1] + i), w->far_inverse[1], w->far_start[1]);
        vfloat z1 = f_bound(f_load(plane + from[2] + i), w->far_inverse[2], w->far_start[2]);
        vfloat near = f_max(f_max(x0, y0), f_max(z0, f_all(0)));
        vfloat far = f_min(f_min(x1, y1), f_min(z1, f_all(end)));
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

/* The triangles of a block that a ray may meet (bit i: triangle i), by the operations of
 * triangle_meets_axis, and those of them for which exact signs have to decide. */
struct meetings {
    unsigned may, unsure;
};

static inline struct meetings meetings_in(const struct triangle_block *block, const struct ray *ray,
                                          const struct ray_frame *f)
{
    struct meetings m = {0, 0};
    const double from[5] = {ray->origin.x, ray->origin.y, ray->origin.z, ray->origin.x,
                            ray->origin.y};
    int along = f->axis, x = along == 2 ? 0 : along + 1, y = x == 2 ? 0 : x + 1;
    for (int i = 0; i < WIDE; i += LANES) {
        struct vpoint2 p[3];
        for (int k = 0; k < 3; k++) {
            vreal way = v_load(block->corner[k][along] + i) - from[along];
            p[k].x = (v_load(block->corner[k][x] + i) - from[along + 1]) - f->shear_x * way;
            p[k].y = (v_load(block->corner[k][y] + i) - from[along + 2]) - f->shear_y * way;
        }
        struct edges e = edges_of(p[0], p[1], p[2]);
        vmask passes = edges_surely_pass(e);
        vmask meets = v_less(v_all(0), e.least) | v_less(e.most, v_all(0));
        m.may |= v_bits(v_not(passes)) << i;
        m.unsure |= v_bits(v_not(passes) & v_not(meets)) << i;
    }
    return m;
}

static inline bool meet_leaf(const struct accel *a, const struct wide_child *leaf,
                             const struct ray *ray, const struct ray_frame *frame, bool any_hit,
                             struct hit *hit)
{
    if (leaf->kind == WIDE_RUN)
        return accel_try_run(a, leaf->first, leaf->count, ray, frame, any_hit, hit);
    const struct triangle_block *block = &a->wide->blocks[leaf->first];
    struct meetings m = meetings_in(block, ray, frame);
    bool met = false;
    m.may &= (1u << leaf->count) - 1;
    for (; m.may && !(met && any_hit); m.may &= m.may - 1) {
        int i = __builtin_ctz(m.may);
        struct target target = block->target[i];
        if (target.prim == ray->from || accel_skips(a, target, ray))
            continue;
        if (m.unsure >> i & 1) {
            met |= target_intersect(a->geometry, target, ray, frame, hit);
            continue;
        }
        struct vec3 corner =
            vec3(block->corner[0][0][i], block->corner[0][1][i], block->corner[0][2][i]);
        double t = triangle_distance(a->geometry, &a->geometry->triangles.at[target.index],
                                     vec3_sub(corner, ray->origin), ray, frame);
        met |= target_offer(t, target.prim, 0, hit);
    }
    return met;
}

/* ---- the tree -------------------------------------------------------------------------------- */

struct wide_pending {
    const struct wide_child *child;
    float enter;
};

static const struct wide_child WIDE_ROOT = {0, WIDE_NODE, 0};

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
        *p = (struct wide_pending){&node->child[i], enter[i]};
    }
    return top;
}

/* The nearer of the only two children that are entered; the other is pushed. */
static inline const struct wide_child *nearer_of_two(struct wide_pending **top,
                                                     const struct wide_node *node, unsigned entered,
                                                     const float *enter)
{
    int i = __builtin_ctz(entered), k = __builtin_ctz(entered & (entered - 1));
    int nearer = enter[i] <= enter[k] ? i : k, farther = i ^ k ^ nearer;
    *(*top)++ = (struct wide_pending){&node->child[farther], enter[farther]};
    return &node->child[nearer];
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
    const struct wide_child *at = &WIDE_ROOT;
    alignas(32) float enter[WIDE];
    float end = wide_distance(&walk, hit->t);
    for (;;) {
        while (at->kind == WIDE_NODE) {
            const struct wide_node *node = &a->wide->nodes[at->first];
            unsigned entered = enter_children(&walk, node, end, enter);
            unsigned others = entered & (entered - 1);
            if (!entered)
                goto next;
            if (!others) {
                at = &node->child[__builtin_ctz(entered)];
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
    const struct wide_child *stack[WIDE_STACK], **top = stack, *at = &WIDE_ROOT;
    float end = wide_distance(&walk, ray->t_max);
    for (;;) {
        if (at->kind == WIDE_NODE) {
            const struct wide_node *node = &a->wide->nodes[at->first];
            alignas(32) float enter[WIDE];
            unsigned entered = enter_children(&walk, node, end, enter);
            if (entered) {
                at = &node->child[__builtin_ctz(entered)];
                for (entered &= entered - 1; entered; entered &= entered - 1)
                    *top++ = &node->child[__builtin_ctz(entered)];
                continue;
            }
        } else if (meet_leaf(a, at, ray, frame, true, hit)) {
            return true;
        }
        if (top == stack)
            return false;
        at = *--top;
    }
}
