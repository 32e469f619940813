#include "config.h"

#include "render/tracer.h"

static bool is_emissive(const struct tracer *t, uint32_t prim)
{
    return t->emissive[t->scene->geometry.prims.at[prim].surface];
}

/* Whether light may get past some target to a ray. */
static bool lets_light(const struct tracer *t, const struct target_list *list)
{
    if (!t->any_emissive || !list->usable)
        return t->any_emissive;
    for (uint32_t i = 0; i < list->n; i++)
        if (is_emissive(t, list->at[i].prim))
            return true;
    return false;
}

/* Modern: the first of what is in the ray's way, from `hit` on, that is not emissive.  What is
 * emissive is passed by a ray that starts on it; enough such stretches for any scene end a walk
 * that rounding errors keep on the spot. */
static uint32_t first_opaque(const struct tracer *t, struct ray ray, struct hit hit)
{
    enum { STRETCHES = 1000 };
    for (int i = 0; i < STRETCHES && hit.prim != PRIM_NONE; i++) {
        if (!is_emissive(t, hit.prim))
            return hit.prim;
        ray.origin = vec3_mad(ray.origin, hit.t, ray.direction);
        ray.t_max -= hit.t;
        ray.from = hit.prim;
        ray.spawned = true;
        accel_closest(&t->accel, &ray, &hit);
    }
    return PRIM_NONE;
}

uint32_t find_blocker(const struct tracer *t, const struct ray *ray)
{
    struct hit hit;
    accel_closest(&t->accel, ray, &hit);
    if (t->modern)
        return first_opaque(t, *ray, hit);
    return hit.prim != PRIM_NONE && !is_emissive(t, hit.prim) ? hit.prim : PRIM_NONE;
}

/* A ray is blocked when its nearest hit is not emissive, in modern also when something behind it is
 * not; where nothing is emissive, when it hits anything. */
uint64_t find_blocked(struct worker *w, const struct target_list *list)
{
    const struct tracer *t = w->tracer;
    const struct ray_batch *rays = &w->shadow_rays;
    struct hit_batch hits;
    uint64_t blocked = 0;
    w->stats.shadow += rays->n;
    if (!lets_light(t, list))
        return bundle_any(&t->accel, t->bundles, rays, list);
    bundle_closest(&t->accel, t->bundles, rays, list, &hits);
    for (uint32_t i = 0; i < rays->n; i++) {
        bool stops = hits.prim[i] != PRIM_NONE && !is_emissive(t, (uint32_t)hits.prim[i]);
        if (t->modern && hits.prim[i] != PRIM_NONE && !stops)
            stops = first_opaque(t, ray_get(rays, i), hit_get(&hits, i)) != PRIM_NONE;
        blocked |= (uint64_t)stops << i;
    }
    return blocked;
}

/* The rays from the point through the lamp's points. */
static void aim_at_all(struct ray_batch *rays, const struct lamp *lamp,
                       const struct lamp_points *to, struct vec3 p, uint32_t prim)
{
    double reach = vec3_length(vec3_sub(lamp->light->position, p));
    rays->n = to->n;
    rays->common_origin = true;
    for (uint32_t i = 0; i < to->n; i++) {
        struct vec3 way = vec3_sub(vec3_get(&to->at, i), p);
        double t_max = reach / vec3_length(way);
        vec3_put(&rays->direction, i, way);
        rays->t_max[i] = t_max <= RAY_UNBOUNDED ? t_max : RAY_UNBOUNDED;
    }
    vec3_fill(&rays->origin, 0, to->n, p);
    fill(rays->from, 0, to->n, prim);
}

/* Leaves those of the rays that meet the light's object, by lines without an end that start on
 * nothing, and tells how often each counts. */
static void keep_counted(struct worker *w, const struct lamp *lamp, const struct lamp_points *to,
                         uint32_t *counts)
{
    struct ray_batch *rays = &w->shadow_rays;
    double t_max[BATCH], from = rays->from[0];
    uint32_t n = 0;
    memcpy(t_max, rays->t_max, to->n * sizeof *t_max);
    fill(rays->t_max, 0, to->n, RAY_UNBOUNDED);
    fill(rays->from, 0, to->n, PRIM_NONE);
    uint64_t meets = bundle_any(&lamp->object, w->tracer->bundles, rays, &lamp->targets);
    fill(rays->from, 0, to->n, from);
    for (uint32_t i = 0; i < to->n; i++) {
        if (!(meets >> i & 1) && !to->counts[i])
            continue;
        vec3_put(&rays->direction, n, vec3_get(&rays->direction, i));
        rays->t_max[n] = t_max[i];
        counts[n++] = to->count[i];
    }
    rays->n = n;
}

void aim_at_points(struct worker *w, const struct lamp *lamp, size_t batch, struct vec3 p,
                   uint32_t prim, uint32_t room[BATCH], const uint32_t **counts)
{
    const struct lamp_points *to = &lamp->points[batch];
    aim_at_all(&w->shadow_rays, lamp, to, p, prim);
    *counts = to->count;
    if (to->all_count)
        return;
    keep_counted(w, lamp, to, room);
    *counts = room;
}

/* The share of the lamp's points that are lit, each tried. */
static double sampled_share(struct worker *w, const struct lamp *lamp,
                            const struct target_list *list, struct vec3 p, uint32_t prim)
{
    uint64_t counted = 0, lit = 0;
    for (size_t k = 0; k < lamp->point_batches && !worker_gives_up(w); k++) {
        uint32_t room[BATCH];
        const uint32_t *counts;
        aim_at_points(w, lamp, k, p, prim, room, &counts);
        uint64_t blocked = find_blocked(w, list);
        for (uint32_t i = 0; i < w->shadow_rays.n; i++) {
            counted += counts[i];
            lit += blocked >> i & 1 ? 0 : counts[i];
        }
    }
    return counted ? (double)lit / (double)counted : 0;
}

/* What nothing is in the way of is lit only where some point counts seen from anywhere. */
static void area_shares(struct worker *w, const struct lamp *lamp, struct box box, double *shares)
{
    const struct shade_batch *points = &w->points;
    struct sight sight;
    for (uint32_t k = 0, end = 0; k < points->n; k++) {
        if (k == end)
            end = see_lamp(w->tracer, lamp, &points->p, points->prim, box, k, points->n, &sight);
        struct target_list own;
        if (points->finish[k]->glows) {
            shares[k] = 1;
            continue;
        }
        enum lamp_view view = lamp_view(w->tracer, &sight, k, &own);
        if (view == LAMP_PARTLY || (view == LAMP_OPEN && !lamp->always_counts)) {
            shares[k] = sampled_share(w, lamp, &own, vec3_get(&points->p, k), points->prim[k]);
            w->stats.skipped[SKIP_DUPLICATE] += lamp->duplicates;
            continue;
        }
        w->stats.skipped[view == LAMP_OPEN ? SKIP_OPEN : SKIP_UMBRA] += lamp->samples;
        shares[k] = view == LAMP_OPEN;
    }
}

uint64_t lit_points(struct worker *w, const struct lamp *lamp)
{
    const struct shade_batch *points = &w->points;
    uint64_t all = UINT64_MAX >> (BATCH - points->n), lit = all;
    for (uint32_t k = 0; k < points->n && points->any_glowing; k++)
        lit &= ~((uint64_t)points->finish[k]->glows << k);
    if (!w->tracer->modern || !tracer_skips(w->tracer, SKIP_BEHIND))
        return lit;
    uint64_t front = lit & w->tracer->kernels->front(points, lamp);
    uint64_t rays = lamp->light->kind == LIGHT_AREA ? lamp->light->samples.n : 1;
    w->stats.skipped[SKIP_BEHIND] += rays * (uint64_t)__builtin_popcountll(lit & ~front);
    return front;
}

/* Modern's shadow rays end this much of their length before the light, so that what the light lies
 * on does not shadow it: far more than rounding errors, far less than can be seen. */
#define LIGHT_CLEARANCE 0x1p-32

double shadow_reach(const struct tracer *t, const struct light *light)
{
    return light->kind == LIGHT_SUN ? RAY_UNBOUNDED : t->modern ? 1 - LIGHT_CLEARANCE : 1;
}

void aim_at_light(struct worker *w, const struct light *light, const uint32_t *which, uint32_t n)
{
    const struct tracer *t = w->tracer;
    const struct shade_batch *points = &w->points;
    struct ray_batch *rays = &w->shadow_rays;
    t->kernels->aim_at(light, shadow_origins(points), points->prim, shadow_reach(t, light),
                       points->n, rays);
    for (uint32_t i = 0; i < n && n < points->n; i++) {
        vec3_put(&rays->origin, i, vec3_get(&rays->origin, which[i]));
        vec3_put(&rays->direction, i, vec3_get(&rays->direction, which[i]));
        rays->from[i] = points->prim[which[i]];
    }
    rays->n = n;
    rays->common_origin = n == 1;
}

/* Traces rays from the points of `lit`; returns those that are blocked. */
static uint64_t find_shadowed(struct worker *w, const struct lamp *lamp,
                              const struct target_list *list, uint64_t lit)
{
    uint32_t which[BATCH], n = 0;
    uint64_t shadowed = 0;
    bool all = lit == UINT64_MAX >> (BATCH - w->points.n);
    for (uint64_t left = all ? 0 : lit; left; left &= left - 1)
        which[n++] = (uint32_t)__builtin_ctzll(left);
    aim_at_light(w, lamp->light, all ? NULL : which, all ? w->points.n : n);
    uint64_t blocked = find_blocked(w, list);
    if (all)
        return blocked;
    for (; blocked; blocked &= blocked - 1)
        shadowed |= UINT64_C(1) << which[__builtin_ctzll(blocked)];
    return shadowed;
}

const double *lamp_shares(struct worker *w, const struct lamp *lamp, struct box box,
                          double room[BATCH_ROOM])
{
    struct target_list list;
    list.usable = false;
    if (lamp->light->kind == LIGHT_AREA) {
        fill_rest(room, w->points.n, 0);
        area_shares(w, lamp, box, room);
        return room;
    }
    const struct tracer *t = w->tracer;
    uint64_t lit = lit_points(w, lamp);
    if (t->skips && lit && w->points.n > 1 && !bundle_needs_no_lists(&t->accel))
        list_shadowers(t, lamp, box, &list);
    if (list.usable && list.n == 0 && tracer_skips(t, SKIP_OPEN)) {
        w->stats.skipped[SKIP_OPEN] += (uint64_t)__builtin_popcountll(lit);
        return w->ones;
    }
    uint64_t shadowed = lit ? find_shadowed(w, lamp, &list, lit) : 0;
    if (!shadowed)
        return w->ones;
    memcpy(room, w->ones, BATCH_ROOM * sizeof *room);
    for (; shadowed; shadowed &= shadowed - 1)
        room[__builtin_ctzll(shadowed)] = 0;
    return room;
}
