#include "config.h"

#include "accel/wide.h"
#include "scene/instance.h"

/* A ray made ready for box tests.  A box's near planes are met from an origin moved forwards by
 * the padding, its far planes from one moved back, which is the box made larger by the padding. */
struct walk {
    double near_origin[3], far_origin[3], inverse[3];
    int negative[3]; /* 1 where the ray runs down the axis: its near plane is the upper one */
};

static struct walk walk_along(const struct accel *a, const struct ray *ray)
{
    struct vec3 o = ray->origin, d = ray->direction;
    double padding = a->padding * (a->reach + vec3_largest(o)), largest = vec3_largest(d);
    double x = copysign(padding, d.x), y = copysign(padding, d.y), z = copysign(padding, d.z);
    return (struct walk){
        {o.x + x, o.y + y, o.z + z},
        {o.x - x, o.y - y, o.z - z},
        {ray_inverse(d.x, largest), ray_inverse(d.y, largest), ray_inverse(d.z, largest)},
        {signbit(d.x) != 0, signbit(d.y) != 0, signbit(d.z) != 0}};
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

static bool find(const struct accel *a, const struct ray *ray, const struct ray_frame *frame,
                 bool any_hit, struct hit *hit);

/* The best hit of an instance, in its prototype's own tree.  Prototypes hold no instances, so this
 * is as deep as trees lie in each other. */
static bool try_instance(const struct accel *a, struct target target, const struct ray *ray,
                         bool any_hit, struct hit *hit)
{
    const struct instance *i = &a->geometry->instances.at[target.index];
    if (i->only != PRIM_NONE)
        return geometry_intersect(a->geometry, target.prim, ray, NULL, hit);
    struct inner_ray inner = instance_ray(i, ray, hit->t);
    struct hit found = hit_none(hit->t);
    find(&a->prototypes[i->prototype], &inner.ray, &inner.frame, any_hit, &found);
    return instance_offer(i, target.prim, &found, hit);
}

static inline bool try_run(const struct accel *a, uint32_t first, uint32_t count,
                           const struct ray *ray, const struct ray_frame *frame, bool any_hit,
                           struct hit *hit)
{
    for (uint32_t i = first; i < first + count; i++) {
        struct target target = a->targets[i];
        if (accel_skips(a, target, ray))
            continue;
        bool met = target.kind == PRIM_INSTANCE
                       ? try_instance(a, target, ray, any_hit, hit)
                       : target_intersect(a->geometry, target, ray, frame, hit);
        if (met && any_hit)
            return true;
    }
    return false;
}

bool accel_try_run(const struct accel *a, uint32_t first, uint32_t count, const struct ray *ray,
                   const struct ray_frame *frame, bool any_hit, struct hit *hit)
{
    return try_run(a, first, count, ray, frame, any_hit, hit);
}

struct pending {
    double enter;
    uint32_t node;
};

/* Nearer child first; a box is left out only when it starts behind the best hit, not when it starts
 * at it: an equal hit of a lower number may be inside. */
static void closest_in_tree(const struct accel *a, const struct ray *ray,
                            const struct ray_frame *frame, struct hit *hit)
{
    struct walk walk = walk_along(a, ray);
    struct pending stack[BVH_DEPTH_LIMIT];
    int depth = 0;
    uint32_t at = 0;
    for (;;) {
        const struct bvh_node *node = &a->nodes[at];
        double enter[2] = {enter_box(&walk, node->plane[0], hit->t),
                           enter_box(&walk, node->plane[1], hit->t)};
        int nearer = enter[1] < enter[0];
        bool descended = false;
        for (int k = 0; k < 2; k++) {
            int child = nearer ^ k;
            if (!(enter[child] <= hit->t))
                continue;
            if (node->count[child] > 0) {
                try_run(a, node->first[child], node->count[child], ray, frame, false, hit);
            } else if (!descended) {
                at = node->first[child];
                descended = true;
            } else {
                stack[depth++] = (struct pending){enter[child], node->first[child]};
            }
        }
        if (descended)
            continue;
        do {
            if (depth == 0)
                return;
            depth--;
        } while (stack[depth].enter > hit->t);
        at = stack[depth].node;
    }
}

static bool any_in_tree(const struct accel *a, const struct ray *ray, const struct ray_frame *frame,
                        struct hit *hit)
{
    struct walk walk = walk_along(a, ray);
    uint32_t stack[BVH_DEPTH_LIMIT + 1] = {0};
    int depth = 1;
    while (depth > 0) {
        const struct bvh_node *node = &a->nodes[stack[--depth]];
        for (int child = 0; child < 2; child++) {
            if (enter_box(&walk, node->plane[child], ray->t_max) == INFINITY)
                continue;
            if (node->count[child] == 0)
                stack[depth++] = node->first[child];
            else if (try_run(a, node->first[child], node->count[child], ray, frame, true, hit))
                return true;
        }
    }
    return false;
}

/* Whether there is a hit; with any_hit, it is just some one. */
static bool find(const struct accel *a, const struct ray *ray, const struct ray_frame *frame,
                 bool any_hit, struct hit *hit)
{
    if (!a->nodes && !a->wide)
        return try_run(a, 0, a->target_count, ray, frame, any_hit, hit) || hit->prim != PRIM_NONE;
    if (any_hit)
        return a->wide ? a->wide->kernels->any(a, ray, frame, hit)
                       : any_in_tree(a, ray, frame, hit);
    if (a->wide)
        a->wide->kernels->closest(a, ray, frame, hit);
    else
        closest_in_tree(a, ray, frame, hit);
    return hit->prim != PRIM_NONE;
}

bool accel_closest(const struct accel *a, const struct ray *ray, struct hit *hit)
{
    hit_clear(hit, ray->t_max);
    if (!ray_has_direction(ray))
        return false;
    struct ray_frame frame;
    ray_frame_init(&frame, ray, a->has[PRIM_SPHERE], a->has[PRIM_TRIANGLE]);
    return find(a, ray, &frame, false, hit);
}

bool accel_any(const struct accel *a, const struct ray *ray)
{
    if (!ray_has_direction(ray))
        return false;
    struct hit hit;
    struct ray_frame frame;
    hit_clear(&hit, ray->t_max);
    ray_frame_init(&frame, ray, a->has[PRIM_SPHERE], a->has[PRIM_TRIANGLE]);
    return find(a, ray, &frame, true, &hit);
}
