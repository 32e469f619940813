#include "config.h"

#include "accel/bundle.h"

static void make_ready(const struct ray *rays, uint32_t n, struct ray_frame *frames,
                       struct hit *hits)
{
    for (uint32_t i = 0; i < n; i++) {
        frames[i] = ray_frame_of(&rays[i]);
        /* Nothing comes before a hit at 0. */
        hits[i] = hit_none(ray_has_direction(&rays[i]) ? rays[i].t_max : 0);
    }
}

void bundle_closest(const struct accel *a, const struct target_list *list, const struct ray *rays,
                    uint32_t n, struct hit *hits)
{
    struct ray_frame frames[BUNDLE_LIMIT];
    if (!list->usable) {
        for (uint32_t i = 0; i < n; i++)
            accel_closest(a, &rays[i], &hits[i]);
        return;
    }
    make_ready(rays, n, frames, hits);
    for (uint32_t k = 0; k < list->n; k++) {
        struct target target = list->at[k];
        double nearest = list->nearest[k];
        for (uint32_t i = 0; i < n; i++)
            if (nearest <= hits[i].t)
                target_intersect(a->geometry, target, &rays[i], &frames[i], &hits[i]);
    }
}

void bundle_any(const struct accel *a, const struct target_list *list, const struct ray *rays,
                uint32_t n, bool *blocked)
{
    struct ray_frame frames[BUNDLE_LIMIT];
    struct hit hits[BUNDLE_LIMIT];
    if (!list->usable) {
        for (uint32_t i = 0; i < n; i++)
            blocked[i] = accel_any(a, &rays[i]);
        return;
    }
    make_ready(rays, n, frames, hits);
    for (uint32_t k = 0; k < list->n; k++) {
        struct target target = list->at[k];
        for (uint32_t i = 0; i < n; i++)
            if (hits[i].prim == PRIM_NONE)
                target_intersect(a->geometry, target, &rays[i], &frames[i], &hits[i]);
    }
    for (uint32_t i = 0; i < n; i++)
        blocked[i] = hits[i].prim != PRIM_NONE;
}
