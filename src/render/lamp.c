/* Lights made ready, and what stands between them and the points they light. */
#include "config.h"

#include "render/tracer.h"

static void add_point(struct lamp *lamp, const struct light_point *point, bool skips)
{
    struct lamp_points *points = &lamp->points[lamp->point_batches - 1];
    if (points->n == BATCH) {
        points++;
        lamp->point_batches++;
        points->all_count = true;
    }
    uint32_t i = points->n++;
    vec3_put(&points->at, i, point->position);
    points->count[i] = skips ? point->count : 1;
    points->counts[i] = point->on_object || (point->inside && skips);
    points->all_count &= points->counts[i];
    lamp->always_counts |= point->on_object || point->inside;
    lamp->box = box_add(lamp->box, point->position);
}

static void add_points(struct lamp *lamp, bool skips)
{
    const struct light *light = lamp->light;
    for (size_t i = 0; i < light->points.n; i++)
        lamp->samples += light->points.at[i].count;
    size_t batches = (skips ? light->points.n : lamp->samples) / BATCH + 1;
    lamp->points = mem_alloc_aligned(batches, sizeof *lamp->points);
    memset(lamp->points, 0, batches * sizeof *lamp->points);
    lamp->points[0].all_count = true;
    lamp->point_batches = 1;
    lamp->box = box_empty();
    for (size_t i = 0; i < light->points.n; i++)
        for (uint32_t k = 0; k < (skips ? 1 : light->points.at[i].count); k++)
            add_point(lamp, &light->points.at[i], skips);
    lamp->duplicates = skips ? lamp->samples - light->points.n : 0;
}

static void add_places(struct lamp *lamp)
{
    const struct light *light = lamp->light;
    size_t batches = light->samples.n / BATCH + 1;
    lamp->places = mem_alloc_aligned(batches, sizeof *lamp->places);
    memset(lamp->places, 0, batches * sizeof *lamp->places);
    for (size_t i = 0; i < light->samples.n; i++) {
        struct sample_batch *b = &lamp->places[i / BATCH];
        sample_batch_put(b, b->n++, &light->samples.at[i]);
    }
}

/* All of the light's own surface, if it is little enough. */
static void list_object(struct lamp *lamp)
{
    const struct accel *object = &lamp->object;
    struct target_list *list = &lamp->targets;
    list->usable = object->target_count <= TARGET_LIST_LIMIT;
    for (uint32_t i = 0; i < object->target_count && list->usable; i++) {
        list->usable = object->targets[i].kind != PRIM_INSTANCE;
        list->nearest[list->n] = 0;
        list->at[list->n++] = object->targets[i];
    }
}

void lamp_init(struct lamp *lamp, const struct light *light, bool brute_force, bool skips)
{
    *lamp = (struct lamp){.light = light, .box = {light->position, light->position}};
    if (light->kind != LIGHT_AREA)
        return;
    accel_build(&lamp->object, &light->object, brute_force);
    if (skips)
        list_object(lamp);
    lamp->box = geometry_bounds(&light->object);
    if (light->samples.n > 0)
        add_places(lamp);
    else
        add_points(lamp, skips);
    lamp->always_counts |= light->samples.n > 0;

    /* larger by more than rounding errors */
    double extra = 0x1p-48 * fmax(vec3_largest(lamp->box.lo), vec3_largest(lamp->box.hi));
    lamp->center = box_center(lamp->box);
    lamp->half = vec3_add(vec3_sub(lamp->box.hi, lamp->center), vec3_all(extra));
    lamp->radius = vec3_length(lamp->half);
    const struct geometry *g = &light->object;
    lamp->ball = g->prims.n == 1 && g->prims.at[0].kind == PRIM_SPHERE;
    if (lamp->ball) {
        lamp->center = g->spheres.at[0].center;
        lamp->radius = g->spheres.at[0].radius + extra;
    }
}

void lamp_free(struct lamp *lamp)
{
    if (lamp->object.geometry)
        accel_free(&lamp->object);
    free(lamp->points);
    free(lamp->places);
}

/* ---- what is between --------------------------------------------------------------------------
 */

/* Distance from the nearest point of one box to the nearest of the other. */
static double box_gap(struct box a, struct box b)
{
    struct vec3 d = vec3_max(vec3_sub(a.lo, b.hi), vec3_sub(b.lo, a.hi));
    return vec3_length(vec3_max(d, vec3_all(0)));
}

/* The largest t at which a shadow ray from the box to a sample of the lamp still counts: the
 * distance to the light's position over that to the sample.  Infinite when it cannot be told. */
static double longest_shadow_ray(const struct lamp *lamp, struct box from)
{
    if (lamp->light->kind == LIGHT_POINT || lamp->light->samples.n > 0)
        return 1;
    struct vec3 p = lamp->light->position;
    struct vec3 d = vec3_max(vec3_sub(p, from.lo), vec3_sub(from.hi, p));
    return vec3_length(d) / box_gap(from, lamp->box) * (1 + 0x1p-30);
}

bool shaft_to_lamp(const struct accel *a, const struct lamp *lamp, struct box from,
                   struct shaft *shaft)
{
    if (lamp->light->kind == LIGHT_SUN) {
        *shaft = shaft_of_rays(a, from, lamp->box);
        return true;
    }
    double t_max = longest_shadow_ray(lamp, from);
    if (!(t_max <= 4))
        return false;
    *shaft = shaft_between(a, from, lamp->box, t_max > 1 ? t_max : 1);
    return true;
}

void list_shadowers(const struct tracer *t, const struct lamp *lamp, struct box from,
                    struct target_list *list)
{
    struct shaft shaft;
    list->usable = false;
    if (shaft_to_lamp(&t->accel, lamp, from, &shaft))
        shaft_list(&t->accel, &shaft, list);
}

/* ---- what points see --------------------------------------------------------------------------
 */

/* The listed targets that hide what is behind them.  What is emissive does not, and in classic a
 * ray that meets it first is lit whatever comes then. */
static uint32_t opaque_targets(const struct tracer *t, const struct target_list *list)
{
    uint32_t opaque = UINT32_MAX;
    for (uint32_t i = 0; i < list->n && t->any_emissive; i++) {
        bool glows = t->emissive[t->scene->geometry.prims.at[list->at[i].prim].surface];
        if (glows && !t->modern)
            return 0;
        opaque &= ~((uint32_t)glows << i);
    }
    return opaque;
}

static struct box box_of(const struct vec3_batch *points, uint32_t first, uint32_t end)
{
    struct box box = box_empty();
    for (uint32_t k = first; k < end; k++) {
        struct vec3 p = vec3_get(points, k);
        box.lo = vec3_min(p, box.lo);
        box.hi = vec3_max(p, box.hi);
    }
    return box;
}

uint32_t see_lamp(const struct tracer *t, const struct lamp *lamp, const struct vec3_batch *from,
                  const uint32_t *prims, struct box box, uint32_t first, uint32_t n,
                  struct sight *sight)
{
    sight->list.usable = false;
    if (!t->skips)
        return n;
    uint32_t size = BATCH, end = n;
    while (first % size)
        size /= 8;
    for (;; size /= 8) {
        end = n - first < size ? n : first + size;
        list_shadowers(t, lamp, end - first == n ? box : box_of(from, first, end), &sight->list);
        if (sight->list.usable || end - first == 1)
            break;
    }
    if (sight->list.usable)
        t->kernels->see(&t->scene->geometry, lamp, opaque_targets(t, &sight->list), from, prims,
                        first, end, sight);
    return end;
}

enum lamp_view lamp_view(const struct tracer *t, const struct sight *sight, uint32_t k,
                         struct target_list *own)
{
    own->usable = sight->list.usable;
    own->n = 0;
    if (!own->usable)
        return LAMP_PARTLY;
    if (sight->hidden >> k & 1 && tracer_skips(t, SKIP_UMBRA))
        return LAMP_HIDDEN;
    for (uint32_t i = 0; i < sight->list.n; i++) {
        if (!(sight->near[i] >> k & 1))
            continue;
        own->nearest[own->n] = 0;
        own->at[own->n++] = sight->list.at[i];
    }
    return own->n > 0 || !tracer_skips(t, SKIP_OPEN) ? LAMP_PARTLY : LAMP_OPEN;
}
