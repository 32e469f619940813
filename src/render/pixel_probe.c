#include "config.h"

#include "render/pixel_probe.h"

#include "render/samples.h"

struct probe {
    struct worker *worker;
    struct arena *arena;
};

/* ---- shadows ----------------------------------------------------------------------------------
 */

static void count_blocker(struct probe *p, struct probe_light *light, uint32_t prim, uint64_t rays)
{
    uint32_t surface = p->worker->tracer->scene->geometry.prims.at[prim].surface;
    struct probe_blocker **at = &light->blockers;
    while (*at && (*at)->surface != surface)
        at = &(*at)->next;
    if (!*at) {
        *at = arena_zalloc(p->arena, 1, sizeof **at);
        (*at)->surface = surface;
        (*at)->prim = prim;
    }
    (*at)->rays += rays;
}

/* Follows the worker's shadow rays; counts: how often each is there, or NULL: once. */
static void count_rays(struct probe *p, const uint32_t *counts, struct probe_light *light)
{
    const struct ray_batch *rays = &p->worker->shadow_rays;
    for (uint32_t i = 0; i < rays->n; i++) {
        struct ray ray = ray_get(rays, i);
        uint32_t prim = find_blocker(p->worker->tracer, &ray), count = counts ? counts[i] : 1;
        light->rays += count;
        if (prim == PRIM_NONE)
            light->lit += count;
        else
            count_blocker(p, light, prim, count);
    }
}

static void find_shadows(struct probe *p, const struct lamp *lamp, struct probe_light *light)
{
    struct worker *w = p->worker;
    static const uint32_t first = 0;
    uint32_t room[BATCH];
    const uint32_t *counts;
    struct vec3 gives[BATCH];
    if (lamp->light->kind != LIGHT_AREA) {
        aim_at_light(w, lamp->light, &first, 1);
        count_rays(p, NULL, light);
        return;
    }
    for (uint32_t number = 0; number < lamp->light->samples.n;) {
        number = aim_at_samples(w, lamp, 0, number, gives);
        count_rays(p, NULL, light);
    }
    for (size_t k = 0; k < lamp->point_batches; k++) {
        aim_at_points(w, lamp, k, vec3_get(&w->points.p, 0), w->points.prim[0], room, &counts);
        count_rays(p, counts, light);
    }
}

/* ---- light ------------------------------------------------------------------------------------
 */

/* The diffuse part of what the light adds: that of a surface without highlights. */
static struct vec3 diffuse_part(struct worker *w, size_t k, struct box box)
{
    struct shade_batch *points = &w->points;
    const struct finish *finish = points->finish[0];
    struct finish matt = *finish;
    struct light_batch light = w->light;
    struct vec3 direct = vec3_get(w->light.direct, 0);
    struct vec3 specular = vec3_get(&points->specular, 0);
    int64_t power = points->power[0];
    matt.specular = vec3_all(0);
    matt.squared = true;
    matt.power = 0;
    points->finish[0] = &matt;
    points->power[0] = 0;
    vec3_put(&points->specular, 0, vec3_all(0));
    vec3_put(w->light.direct, 0, vec3_all(0));
    w->tracer->shading->add(w, k, box);
    struct vec3 diffuse = vec3_get(w->light.direct, 0);
    points->finish[0] = finish;
    points->power[0] = power;
    vec3_put(&points->specular, 0, specular);
    w->light = light;
    vec3_put(w->light.direct, 0, direct);
    return diffuse;
}

static void probe_lights(struct probe *p, struct probe_ray *r)
{
    struct worker *w = p->worker;
    const struct tracer *t = w->tracer;
    struct box box = t->shading->begin(w);
    r->without = vec3_get(w->light.direct, 0);
    r->lights = arena_zalloc(p->arena, t->scene->lights.n, sizeof *r->lights);
    for (size_t k = 0; k < t->scene->lights.n; k++) {
        struct probe_light *light = &r->lights[k];
        struct vec3 before = vec3_get(w->light.direct, 0);
        light->diffuse = diffuse_part(w, k, box);
        t->shading->add(w, k, box);
        struct vec3 added = vec3_sub(vec3_get(w->light.direct, 0), before);
        bool dull = vec3_is_zero(w->points.finish[0]->specular) || w->points.finish[0]->glows;
        light->highlight = dull ? vec3_all(0) : vec3_sub(added, light->diffuse);
        if (!w->points.finish[0]->glows)
            find_shadows(p, &t->lamps[k], light);
    }
}

/* ---- rays -------------------------------------------------------------------------------------
 */

static void note_hit(const struct worker *w, struct probe_ray *r)
{
    const struct shade_batch *points = &w->points;
    r->hit = true;
    r->distance = points->t[0];
    r->point = vec3_get(&points->p, 0);
    r->normal = vec3_get(&points->normal, 0);
    r->diffuse = vec3_get(&points->diffuse, 0);
    r->surface = points->surface[0];
    r->prim = points->prim[0];
}

static struct probe_ray *probe_ray(struct probe *p, uint32_t depth, const struct ray_batch *rays,
                                   const struct path *path, struct vec3 weight, enum probe_way way);

static struct probe_ray *probe_offspring(struct probe *p, uint32_t depth, const struct offspring *o,
                                         enum probe_way way, struct vec3 *colour)
{
    if (o->rays.n == 0)
        return NULL;
    struct probe_ray *r = probe_ray(p, depth + 1, &o->rays, o->paths, vec3_get(&o->weight, 0), way);
    *colour = vec3_add(*colour, vec3_mul(r->weight, r->colour));
    return r;
}

/* As trace_batch, for one ray, as deep. */
static struct probe_ray *probe_ray(struct probe *p, uint32_t depth, const struct ray_batch *rays,
                                   const struct path *path, struct vec3 weight, enum probe_way way)
{
    struct worker *w = p->worker;
    const struct tracer *t = w->tracer;
    struct level *level = level_at(w, depth);
    struct probe_ray *r = arena_zalloc(p->arena, 1, sizeof *r);
    r->way = way;
    r->weight = weight;
    r->origin = vec3_get(&rays->origin, 0);
    r->direction = vec3_get(&rays->direction, 0);
    r->without = r->colour = t->scene->background;
    find_points(w, rays, path);
    if (w->points.n == 0)
        return r;
    note_hit(w, r);
    probe_lights(p, r);
    r->colour = vec3_get(w->light.direct, 0);
    if (depth < t->options->depth && w->points.any_bounces)
        t->shading->spawn(w, level, path);
    r->reflected = probe_offspring(p, depth, &level->reflected, PROBE_REFLECTED, &r->colour);
    r->refracted = probe_offspring(p, depth, &level->refracted, PROBE_REFRACTED, &r->colour);
    return r;
}

const struct probe_ray *probe_pixel(const struct scene *scene, const struct render_options *options,
                                    uint32_t x, uint32_t y, struct arena *arena)
{
    struct tracer tracer;
    tracer_init(&tracer, scene, options);
    struct probe p = {.worker = camera_worker(&tracer), .arena = arena};
    struct tile tile = {x, y, x + 1, y + 1};
    struct sample sample = sample_at(&tracer, 0, 0, 1);
    const struct ray_batch *rays = camera_rays(p.worker, &tile, &sample);
    const struct probe_ray *r = probe_ray(&p, 0, rays, NULL, vec3_all(1), PROBE_CAMERA);
    worker_free(p.worker);
    tracer_free(&tracer);
    return r;
}
