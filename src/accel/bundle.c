#include "config.h"

#include "accel/bundle.h"

/* The rays made ready, and their best hits so far. */
struct bundle {
    const struct geometry *geometry;
    const struct ray *rays;
    uint32_t n;
    bool common_origin;
    int axis; /* of all rays, or -1 */
    struct ray_frame frames[BUNDLE_LIMIT];
    struct hit *hits;
};

static bool equal_points(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static void bundle_init(struct bundle *b, const struct accel *a, const struct target_list *list,
                        const struct ray *rays, uint32_t n, struct hit *hits)
{
    bool spheres = false, triangles = false;
    for (uint32_t i = 0; i < list->n; i++) {
        spheres |= list->at[i].kind == PRIM_SPHERE;
        triangles |= list->at[i].kind == PRIM_TRIANGLE;
    }
    b->geometry = a->geometry;
    b->rays = rays;
    b->n = n;
    b->hits = hits;
    b->common_origin = n > 1 && equal_points(rays[0].origin, rays[1].origin) &&
                       equal_points(rays[0].origin, rays[n - 1].origin);
    for (uint32_t i = 0; i < n; i++) {
        hits[i].t = rays[i].t_max;
        hits[i].prim = PRIM_NONE;
        ray_frame_init(&b->frames[i], &rays[i], spheres, triangles);
        b->common_origin &= equal_points(rays[i].origin, rays[0].origin);
        b->axis = i == 0 || b->axis == b->frames[i].axis ? b->frames[i].axis : -1;
    }
}

static void meet_sphere(struct bundle *b, struct target target)
{
    const struct sphere *sphere = &b->geometry->spheres.at[target.index];
    for (uint32_t i = 0; i < b->n; i++) {
        double t = sphere_distance(sphere, &b->rays[i], &b->frames[i]);
        target_offer(t, target.prim, 0, &b->hits[i]);
    }
}

static void meet_cylinder(struct bundle *b, struct target target)
{
    const struct cylinder *cylinder = &b->geometry->cylinders.at[target.index];
    for (uint32_t i = 0; i < b->n; i++) {
        uint32_t part = 0;
        double t = cylinder_distance(cylinder, &b->rays[i], &b->frames[i], &part);
        target_offer(t, target.prim, part, &b->hits[i]);
    }
}

/* axis: of all rays, or -1. */
static inline void meet_triangle_along(struct bundle *b, struct target target, int axis)
{
    const struct geometry *g = b->geometry;
    const struct triangle *triangle = &g->triangles.at[target.index];
    struct seen_triangle seen = triangle_seen(g, triangle, b->rays[0].origin);
    for (uint32_t i = 0; i < b->n; i++) {
        const struct ray *ray = &b->rays[i];
        const struct ray_frame *frame = &b->frames[i];
        if (!b->common_origin)
            seen = triangle_seen(g, triangle, ray->origin);
        if (ray->from == target.prim || !(axis < 0 ? triangle_meets_line(&seen, frame)
                                                   : triangle_meets_axis(&seen, frame, axis)))
            continue;
        double t = triangle_distance(g, triangle, ray, frame);
        target_offer(t, target.prim, 0, &b->hits[i]);
    }
}

static void meet_triangle(struct bundle *b, struct target target)
{
    switch (b->axis) {
    case 0:
        meet_triangle_along(b, target, 0);
        break;
    case 1:
        meet_triangle_along(b, target, 1);
        break;
    case 2:
        meet_triangle_along(b, target, 2);
        break;
    default:
        meet_triangle_along(b, target, -1);
    }
}

static void meet(struct bundle *b, struct target target)
{
    if (target.kind == PRIM_SPHERE)
        meet_sphere(b, target);
    else if (target.kind == PRIM_CYLINDER)
        meet_cylinder(b, target);
    else
        meet_triangle(b, target);
}

static double farthest_hit(const struct bundle *b)
{
    double t = 0;
    for (uint32_t i = 0; i < b->n; i++)
        t = b->hits[i].t > t ? b->hits[i].t : t;
    return t;
}

void bundle_closest(const struct accel *a, const struct target_list *list, const struct ray *rays,
                    uint32_t n, struct hit *hits)
{
    struct bundle b;
    if (!list->usable) {
        for (uint32_t i = 0; i < n; i++)
            accel_closest(a, &rays[i], &hits[i]);
        return;
    }
    bundle_init(&b, a, list, rays, n, hits);
    for (uint32_t k = 0; k < list->n; k++) {
        if (list->nearest[k] > 0 && list->nearest[k] > farthest_hit(&b))
            break;
        meet(&b, list->at[k]);
    }
}

void bundle_any(const struct accel *a, const struct target_list *list, const struct ray *rays,
                uint32_t n, bool *blocked)
{
    struct hit hits[BUNDLE_LIMIT];
    struct bundle b;
    if (!list->usable) {
        for (uint32_t i = 0; i < n; i++)
            blocked[i] = accel_any(a, &rays[i]);
        return;
    }
    bundle_init(&b, a, list, rays, n, hits);
    for (uint32_t k = 0; k < list->n; k++)
        meet(&b, list->at[k]);
    for (uint32_t i = 0; i < n; i++)
        blocked[i] = hits[i].prim != PRIM_NONE;
}
