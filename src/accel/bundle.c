#include "config.h"

#include "accel/bundle.h"

#include <assert.h>

/* The rays made ready, and their best hits so far. */
struct meeting {
    const struct geometry *geometry;
    const struct bundle *bundle;
    int axis; /* of all rays, or -1; see struct ray_frame */
    struct ray_frame frames[BUNDLE_LIMIT];
    struct hit *hits;
};

/* Leaves out of the frames what the list's kinds do not need. */
static void meeting_init(struct meeting *m, const struct accel *a, const struct bundle *b,
                         struct hit *hits)
{
    bool spheres = false, triangles = false;
    assert(b->n > 0);
    m->geometry = a->geometry;
    m->bundle = b;
    m->hits = hits;
    m->axis = -1;
    for (uint32_t i = 0; i < b->list->n; i++) {
        spheres |= b->list->at[i].kind == PRIM_SPHERE;
        triangles |= b->list->at[i].kind == PRIM_TRIANGLE;
    }
    for (uint32_t i = 0; i < b->n; i++) {
        hits[i].t = b->rays[i].t_max;
        hits[i].prim = PRIM_NONE;
        ray_frame_init(&m->frames[i], &b->rays[i], spheres, triangles);
    }
    if (!triangles)
        return;
    m->axis = m->frames[0].axis;
    for (uint32_t i = 1; i < b->n; i++)
        m->axis = m->axis == m->frames[i].axis ? m->axis : -1;
}

static void meet_sphere(struct meeting *m, struct target target)
{
    const struct sphere *sphere = &m->geometry->spheres.at[target.index];
    for (uint32_t i = 0; i < m->bundle->n; i++) {
        double t = sphere_distance(sphere, &m->bundle->rays[i], &m->frames[i]);
        target_offer(t, target.prim, 0, &m->hits[i]);
    }
}

static void meet_cylinder(struct meeting *m, struct target target)
{
    const struct cylinder *cylinder = &m->geometry->cylinders.at[target.index];
    const struct ray *rays = m->bundle->rays;
    struct seen_cylinder seen = cylinder_seen(cylinder, rays[0].origin);
    for (uint32_t i = 0; i < m->bundle->n; i++) {
        uint32_t part = 0;
        if (!m->bundle->common_origin)
            seen = cylinder_seen(cylinder, rays[i].origin);
        if (!cylinder_is_near(cylinder, &seen, &rays[i], &m->frames[i]))
            continue;
        double t = cylinder_distance(cylinder, &seen, &rays[i], &m->frames[i], &part);
        target_offer(t, target.prim, part, &m->hits[i]);
    }
}

/* axis: of all rays, or -1. */
static inline void meet_triangle_along(struct meeting *m, struct target target, int axis)
{
    const struct geometry *g = m->geometry;
    const struct triangle *triangle = &g->triangles.at[target.index];
    const struct ray *rays = m->bundle->rays;
    struct seen_triangle seen = triangle_seen(g, triangle, rays[0].origin);
    for (uint32_t i = 0; i < m->bundle->n; i++) {
        const struct ray_frame *frame = &m->frames[i];
        if (!m->bundle->common_origin)
            seen = triangle_seen(g, triangle, rays[i].origin);
        if (rays[i].from == target.prim || !(axis < 0 ? triangle_meets_line(&seen, frame)
                                                      : triangle_meets_axis(&seen, frame, axis)))
            continue;
        double t = triangle_distance(g, triangle, &rays[i], frame);
        target_offer(t, target.prim, 0, &m->hits[i]);
    }
}

static void meet_triangle(struct meeting *m, struct target target)
{
    switch (m->axis) {
    case 0:
        meet_triangle_along(m, target, 0);
        break;
    case 1:
        meet_triangle_along(m, target, 1);
        break;
    case 2:
        meet_triangle_along(m, target, 2);
        break;
    default:
        meet_triangle_along(m, target, -1);
    }
}

static void meet(struct meeting *m, struct target target)
{
    if (target.kind == PRIM_SPHERE)
        meet_sphere(m, target);
    else if (target.kind == PRIM_CYLINDER)
        meet_cylinder(m, target);
    else
        meet_triangle(m, target);
}

static double farthest_hit(const struct meeting *m)
{
    double t = 0;
    for (uint32_t i = 0; i < m->bundle->n; i++)
        t = m->hits[i].t > t ? m->hits[i].t : t;
    return t;
}

void bundle_closest(const struct accel *a, const struct bundle *b, struct hit *hits)
{
    const struct target_list *list = b->list;
    struct meeting m;
    if (!list->usable) {
        for (uint32_t i = 0; i < b->n; i++)
            accel_closest(a, &b->rays[i], &hits[i]);
        return;
    }
    meeting_init(&m, a, b, hits);
    for (uint32_t k = 0; k < list->n; k++) {
        if (list->nearest[k] > 0 && list->nearest[k] > farthest_hit(&m))
            break;
        meet(&m, list->at[k]);
    }
}

void bundle_any(const struct accel *a, const struct bundle *b, bool *blocked)
{
    struct hit hits[BUNDLE_LIMIT];
    struct meeting m;
    if (!b->list->usable) {
        for (uint32_t i = 0; i < b->n; i++)
            blocked[i] = accel_any(a, &b->rays[i]);
        return;
    }
    meeting_init(&m, a, b, hits);
    for (uint32_t k = 0; k < b->list->n; k++)
        meet(&m, b->list->at[k]);
    for (uint32_t i = 0; i < b->n; i++)
        blocked[i] = hits[i].prim != PRIM_NONE;
}
