#include "config.h"

#include "accel/bundle.h"

static bool has_triangles(const struct target_list *list)
{
    for (uint32_t i = 0; i < list->n; i++)
        if (list->at[i].kind == PRIM_TRIANGLE)
            return true;
    return false;
}

static void make_frames(const struct target_list *list, const struct ray *rays, uint32_t n,
                        struct ray_frame *frames)
{
    bool round = !has_triangles(list);
    for (uint32_t i = 0; i < n; i++)
        frames[i] = round ? ray_frame_for_round(&rays[i]) : ray_frame_of(&rays[i]);
}

void bundle_closest(const struct accel *a, const struct target_list *list, const struct ray *rays,
                    uint32_t n, struct hit *hits)
{
    struct ray_frame frames[BUNDLE_LIMIT];
    double farthest = INFINITY;
    if (!list->usable) {
        for (uint32_t i = 0; i < n; i++)
            accel_closest(a, &rays[i], &hits[i]);
        return;
    }
    for (uint32_t i = 0; i < n; i++)
        hits[i].t = rays[i].t_max, hits[i].prim = PRIM_NONE;
    make_frames(list, rays, n, frames);
    for (uint32_t k = 0; k < list->n && list->nearest[k] <= farthest; k++) {
        struct target target = list->at[k];
        farthest = 0;
        for (uint32_t i = 0; i < n; i++) {
            target_intersect(a->geometry, target, &rays[i], &frames[i], &hits[i]);
            farthest = hits[i].t > farthest ? hits[i].t : farthest;
        }
    }
}

void bundle_any(const struct accel *a, const struct target_list *list, const struct ray *rays,
                uint32_t n, bool *blocked)
{
    struct ray_frame frames[BUNDLE_LIMIT];
    if (!list->usable) {
        for (uint32_t i = 0; i < n; i++)
            blocked[i] = accel_any(a, &rays[i]);
        return;
    }
    for (uint32_t i = 0; i < n; i++)
        blocked[i] = false;
    make_frames(list, rays, n, frames);
    for (uint32_t k = 0; k < list->n; k++) {
        struct target target = list->at[k];
        for (uint32_t i = 0; i < n; i++) {
            struct hit hit = { .t = rays[i].t_max, .prim = PRIM_NONE };
            if (!blocked[i])
                blocked[i] = target_intersect(a->geometry, target, &rays[i], &frames[i], &hit);
        }
    }
}
