#include "config.h"

#include "accel/bvh.h"

/* A ray made ready for box tests.  A box's near planes are met from an origin moved forwards by
 * the padding, its far planes from one moved back, which is the box made larger by the padding. */
struct walk {
    double near_origin[3], far_origin[3], inverse[3];
    int negative[3]; /* 1 where the ray runs down the axis: its near plane is the upper one */
};

static struct walk walk_along(const struct accel *a, const struct ray *ray,
                              const struct ray_frame *frame)
{
    double padding = BOX_PADDING * (a->reach + vec3_largest(ray->origin));
    struct walk w;
    for (int axis = 0; axis < 3; axis++) {
        double origin = vec3_at(ray->origin, axis), inverse = vec3_at(frame->inverse, axis);
        double forwards = copysign(padding, inverse);
        w.near_origin[axis] = origin + forwards;
        w.far_origin[axis] = origin - forwards;
        w.inverse[axis] = inverse;
        w.negative[axis] = inverse < 0;
    }
    return w;
}

/* Where the ray enters the box, or infinity when it misses it before t_max. */
static inline double enter_box(const struct walk *w, const double plane[2][3], double t_max)
{
    double near = 0, far = t_max;
    for (int axis = 0; axis < 3; axis++) {
        int negative = w->negative[axis];
        double enter = (plane[negative][axis] - w->near_origin[axis]) * w->inverse[axis];
        double leave = (plane[!negative][axis] - w->far_origin[axis]) * w->inverse[axis];
        near = enter > near ? enter : near;
        far = leave < far ? leave : far;
    }
    return near <= far ? near : INFINITY;
}

static inline bool skipped(const struct geometry *g, uint32_t prim, const struct ray *ray)
{
    return ray->surface != SURFACE_NONE && g->prims.at[prim].surface != ray->surface;
}

struct pending {
    double enter;
    uint32_t node;
};

static bool closest_in_tree(const struct accel *a, const struct ray *ray, struct hit *hit)
{
    struct ray_frame frame = ray_frame_of(ray->direction);
    struct walk walk = walk_along(a, ray, &frame);
    struct pending stack[BVH_DEPTH_LIMIT];
    int depth = 0;
    uint32_t at = 0;
    for (;;) {
        const struct bvh_node *node = &a->nodes[at];
        double enter[2] = { enter_box(&walk, node->plane[0], hit->t),
                            enter_box(&walk, node->plane[1], hit->t) };
        int first = enter[1] < enter[0];
        struct pending next[2];
        int nexts = 0;
        for (int k = 0; k < 2; k++) {
            int child = first ^ k;
            if (!(enter[child] <= hit->t))
                continue;
            uint32_t begin = node->first[child], count = node->count[child];
            if (count == 0) {
                next[nexts++] = (struct pending){ enter[child], begin };
                continue;
            }
            for (uint32_t i = begin; i < begin + count; i++)
                if (!skipped(a->geometry, a->order[i], ray))
                    geometry_intersect(a->geometry, a->order[i], ray, &frame, hit);
        }
        if (nexts == 2)
            stack[depth++] = next[1];
        if (nexts > 0) {
            at = next[0].node;
            continue;
        }
        do {
            if (depth == 0)
                return hit->prim != PRIM_NONE;
            depth--;
        } while (stack[depth].enter > hit->t);
        at = stack[depth].node;
    }
}

static bool any_in_tree(const struct accel *a, const struct ray *ray, struct hit *hit)
{
    struct ray_frame frame = ray_frame_of(ray->direction);
    struct walk walk = walk_along(a, ray, &frame);
    uint32_t stack[BVH_DEPTH_LIMIT + 1];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const struct bvh_node *node = &a->nodes[stack[--depth]];
        for (int child = 0; child < 2; child++) {
            if (enter_box(&walk, node->plane[child], ray->t_max) == INFINITY)
                continue;
            uint32_t begin = node->first[child], count = node->count[child];
            if (count == 0)
                stack[depth++] = begin;
            for (uint32_t i = begin; i < begin + count; i++)
                if (!skipped(a->geometry, a->order[i], ray) &&
                    geometry_intersect(a->geometry, a->order[i], ray, &frame, hit))
                    return true;
        }
    }
    return false;
}

static bool closest_of_all(const struct accel *a, const struct ray *ray, struct hit *hit)
{
    struct ray_frame frame = ray_frame_of(ray->direction);
    for (uint32_t i = 0; i < a->geometry->prims.n; i++)
        if (!skipped(a->geometry, i, ray))
            geometry_intersect(a->geometry, i, ray, &frame, hit);
    return hit->prim != PRIM_NONE;
}

bool accel_closest(const struct accel *a, const struct ray *ray, struct hit *hit)
{
    *hit = hit_none(ray->t_max);
    if (!ray_has_direction(ray))
        return false;
    return a->nodes ? closest_in_tree(a, ray, hit) : closest_of_all(a, ray, hit);
}

bool accel_any(const struct accel *a, const struct ray *ray, uint32_t *occluder)
{
    struct hit hit = hit_none(ray->t_max);
    if (!ray_has_direction(ray))
        return false;
    bool blocked = a->nodes ? any_in_tree(a, ray, &hit) : closest_of_all(a, ray, &hit);
    *occluder = hit.prim;
    return blocked;
}
