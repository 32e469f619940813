/* Light and rays of `model modern`; wrt(5) has the formulas. */
#include "config.h"

#include "math/optics.h"
#include "math/rng.h"
#include "render/tracer.h"

#include <string.h>

/* A point as its eye sees it: all normals on the eye's side. */
struct seen_point {
    struct shade_point s;
    struct vec3 normal, smooth, geometric;
    struct vec3 lifted; /* where shadow rays start */
};

static struct seen_point seen_point_get(const struct shade_batch *points, uint32_t k)
{
    struct seen_point seen = {.s = shade_point_get(points, k)};
    seen.normal = seen.s.normal;
    seen.smooth = vec3_get(smooth_normals(points), k);
    seen.geometric = vec3_get(geometric_normals(points), k);
    seen.lifted = vec3_get(shadow_origins(points), k);
    if (vec3_dot(seen.geometric, seen.s.incoming) > 0) {
        seen.normal = vec3_neg(seen.normal);
        seen.smooth = vec3_neg(seen.smooth);
        seen.geometric = vec3_neg(seen.geometric);
    }
    return seen;
}

/* How much of the light on a bent normal is let through, so that it fades out before the surface
 * itself turns away: Chiang, Li, Burley, Taming the shadow terminator, SIGGRAPH talks 2019. */
static double terminator(double cosine, double smooth_cosine, double between)
{
    double g = smooth_cosine / (cosine * between);
    return g < 1 && between > 0 ? g * (1 + g * (1 - g)) : 1;
}

/* What is reflected of light of strength 1 from a unit direction; nothing from behind. */
static struct vec3 reflected_light(const struct seen_point *p, struct vec3 to_light)
{
    const struct finish *f = p->s.finish;
    double cosine = vec3_dot(p->normal, to_light);
    double smooth_cosine = vec3_dot(p->smooth, to_light);
    if (!(cosine > 0 && smooth_cosine > 0))
        return vec3_all(0);
    double mirrored =
        vec3_dot(p->s.incoming, to_light) - 2 * cosine * vec3_dot(p->normal, p->s.incoming);
    struct vec3 light = vec3_scale(p->s.diffuse, cosine);
    if (mirrored > 0)
        light = vec3_mad(light, finish_highlight(f, mirrored), f->specular);
    return vec3_scale(light, terminator(cosine, smooth_cosine, vec3_dot(p->normal, p->smooth)));
}

/* ---- point lights and suns ------------------------------------------------------------------- */

void modern_add_light(const struct shade_batch *points, const struct light *light,
                      const double *shares, struct light_batch *sums)
{
    for (uint32_t k = 0; k < points->n; k++) {
        if (shares[k] == 0 || points->finish[k]->glows)
            continue;
        struct seen_point p = seen_point_get(points, k);
        struct vec3 to_light = light->position;
        double strength = 1;
        if (light->kind == LIGHT_POINT) {
            struct vec3 way = vec3_sub(light->position, p.s.p);
            double square = vec3_dot(way, way);
            to_light = vec3_scale(way, 1 / sqrt(square));
            strength = light->inverse_square ? 1 / square : 1;
        }
        struct vec3 lit = vec3_mul(reflected_light(&p, to_light), light->intensity);
        struct vec3 sum = vec3_get(sums->direct, k);
        vec3_put(sums->direct, k, vec3_mad(sum, strength, lit));
    }
}

/* ---- area lights ----------------------------------------------------------------------------- */

/* Samples from `first` on, of the whole light for the point k: each in the middle of its stratum,
 * or at random there by the point itself, so that neither threads nor tiles matter. */
static const struct sample_batch *samples_for(struct worker *w, const struct lamp *lamp, uint32_t k,
                                              uint32_t first)
{
    const struct render_options *o = w->tracer->options;
    const struct sample_batch *places = &lamp->places[first / BATCH];
    uint32_t grid = lamp->light->grid;
    uint64_t x, y, z;
    if (!o->jitter)
        return places;
    memcpy(&x, &w->points.p.x[k], sizeof x);
    memcpy(&y, &w->points.p.y[k], sizeof y);
    memcpy(&z, &w->points.p.z[k], sizeof z);
    uint64_t key = x ^ (y << 21 | y >> 43) ^ (z << 42 | z >> 22);
    w->jittered.n = places->n;
    for (uint32_t i = 0; i < places->n; i++) {
        uint32_t number = first + i;
        double a = rng_uniform(o->seed, key, number, 0), b = rng_uniform(o->seed, key, number, 1);
        struct light_sample sample =
            light_surface_at(lamp->light, (number / grid + a) / grid, (number % grid + b) / grid);
        sample_batch_put(&w->jittered, i, &sample);
    }
    return &w->jittered;
}

/* What the sample gives the point if nothing is in the way. */
static struct vec3 sample_light(const struct light *light, const struct light_sample *sample,
                                const struct seen_point *p)
{
    struct vec3 way = vec3_sub(sample->position, p->s.p);
    double square = vec3_dot(way, way);
    struct vec3 to_light = vec3_scale(way, 1 / sqrt(square));
    double cosine = -vec3_dot(sample->normal, to_light);
    if (light->both_sides)
        cosine = fabs(cosine);
    if (!(cosine > 0))
        return vec3_all(0);
    double strength = sample->share * cosine / (light->inverse_square ? square : 1);
    return vec3_scale(vec3_mul(reflected_light(p, to_light), light->intensity), strength);
}

void modern_give(const struct shade_batch *points, uint32_t k, const struct light *light,
                 const struct sample_batch *samples, struct vec3_batch *gives)
{
    struct seen_point p = seen_point_get(points, k);
    for (uint32_t i = 0; i < samples->n; i++) {
        struct light_sample sample = {vec3_get(&samples->position, i),
                                      vec3_get(&samples->normal, i), samples->share[i]};
        vec3_put(gives, i, sample_light(light, &sample, &p));
    }
}

uint32_t aim_at_samples(struct worker *w, const struct lamp *lamp, uint32_t k, uint32_t first,
                        struct vec3 gives[BATCH])
{
    const struct tracer *t = w->tracer;
    struct ray_batch *rays = &w->shadow_rays;
    const struct sample_batch *samples = samples_for(w, lamp, k, first);
    struct vec3 from = vec3_get(shadow_origins(&w->points), k);
    struct vec3_batch given;
    uint32_t n = 0;
    t->kernels->give(&w->points, k, lamp->light, samples, &given);
    for (uint32_t i = 0; i < samples->n; i++) {
        gives[n] = vec3_get(&given, i);
        if (!vec3_is_zero(gives[n]))
            vec3_put(&rays->direction, n++, vec3_sub(vec3_get(&samples->position, i), from));
    }
    t->kernels->fill(&rays->origin, 0, n, from);
    fill(rays->t_max, 0, n, shadow_reach(t, lamp->light));
    fill(rays->from, 0, n, w->points.prim[k]);
    rays->n = n;
    rays->common_origin = true;
    return first + samples->n;
}

/* What arrives at point k. */
static struct vec3 area_light(struct worker *w, const struct lamp *lamp,
                              const struct target_list *list, uint32_t k)
{
    struct vec3 gives[BATCH], sum = vec3_all(0);
    for (uint32_t number = 0; number < lamp->light->samples.n && !worker_gives_up(w);) {
        number = aim_at_samples(w, lamp, k, number, gives);
        uint64_t blocked = find_blocked(w, list);
        for (uint32_t i = 0; i < w->shadow_rays.n; i++)
            sum = blocked >> i & 1 ? sum : vec3_add(sum, gives[i]);
    }
    return sum;
}

/* The same where nothing is in the way. */
static struct vec3 open_light(struct worker *w, const struct lamp *lamp, uint32_t k)
{
    struct vec3 sum = vec3_all(0);
    for (uint32_t number = 0; number < lamp->light->samples.n && !worker_gives_up(w);
         number += BATCH) {
        const struct sample_batch *samples = samples_for(w, lamp, k, number);
        struct vec3_batch gives;
        w->tracer->kernels->give(&w->points, k, lamp->light, samples, &gives);
        for (uint32_t i = 0; i < samples->n; i++)
            sum = vec3_add(sum, vec3_get(&gives, i));
        w->stats.skipped[SKIP_OPEN] += samples->n;
    }
    return sum;
}

static void add_area(struct worker *w, const struct lamp *lamp, struct box box)
{
    const struct shade_batch *points = &w->points;
    struct target_list own;
    struct sight sight;
    uint64_t lit = lit_points(w, lamp);
    for (uint32_t k = 0, end = 0; k < points->n; k++) {
        if (!(lit >> k & 1))
            continue;
        if (k >= end)
            end = see_lamp(w->tracer, lamp, shadow_origins(points), points->prim, box, k, points->n,
                           &sight);
        enum lamp_view view = lamp_view(w->tracer, &sight, k, &own);
        if (view == LAMP_HIDDEN) {
            w->stats.skipped[SKIP_UMBRA] += lamp->light->samples.n;
            continue;
        }
        struct vec3 light =
            view == LAMP_OPEN ? open_light(w, lamp, k) : area_light(w, lamp, &own, k);
        vec3_put(w->light.direct, k, vec3_add(vec3_get(w->light.direct, k), light));
    }
}

static void scale_all(double *to, const double *x, double by, uint32_t n)
{
    for (uint32_t k = 0; k < n; k++)
        to[k] = x[k] * by;
}

static struct box modern_begin(struct worker *w)
{
    const struct shade_batch *points = &w->points;
    struct vec3 ambient = w->tracer->scene->ambient;
    scale_all(w->light.direct->x, points->diffuse.x, ambient.x, points->n);
    scale_all(w->light.direct->y, points->diffuse.y, ambient.y, points->n);
    scale_all(w->light.direct->z, points->diffuse.z, ambient.z, points->n);
    for (uint32_t k = 0; k < points->n && points->any_glowing; k++)
        if (points->finish[k]->glows)
            vec3_put(w->light.direct, k, vec3_get(&points->diffuse, k));
    return w->tracer->kernels->bounds(shadow_origins(points), points->n);
}

static void modern_add(struct worker *w, size_t k, struct box box)
{
    const struct lamp *lamp = &w->tracer->lamps[k];
    alignas(64) double room[BATCH_ROOM];
    if (lamp->light->kind == LIGHT_AREA) {
        add_area(w, lamp, box);
        return;
    }
    const double *shares = lamp_shares(w, lamp, box, room);
    w->tracer->kernels->add_modern(&w->points, lamp->light, shares, &w->light);
}

/* ---- mirrored and refracted rays ------------------------------------------------------------- */

/* The mirrored direction; one that a bent normal sends below the primitive is bent back. */
static struct vec3 mirrored(const struct seen_point *p)
{
    struct vec3 d = vec3_mirrored(p->s.incoming, p->normal);
    if (vec3_dot(d, p->geometric) < 0)
        d = vec3_mirrored(d, p->geometric);
    return vec3_renormalized(d);
}

static double index_inside(const struct scene *scene, const struct media *media)
{
    if (media->n == 0)
        return 1;
    uint32_t surface = media->surface[media->n - 1];
    return scene->materials.at[scene->surfaces.at[surface].material].ior;
}

/* The media beyond the surface: it is entered, or left wherever it stands among them. */
static struct media media_beyond(const struct media *media, uint32_t surface, bool entering)
{
    struct media beyond = {0};
    for (uint32_t i = 0; i < media->n; i++)
        if (entering || media->surface[i] != surface)
            beyond.surface[beyond.n++] = media->surface[i];
    if (entering && beyond.n < MEDIA_LIMIT)
        beyond.surface[beyond.n++] = surface;
    return beyond;
}

/* False for total reflection, and where a bent normal would send the ray back. */
static bool refracted(const struct seen_point *p, double eta, struct vec3 *direction)
{
    return vec3_refracted(p->s.incoming, p->normal, eta, direction) &&
           vec3_dot(*direction, p->geometric) < 0;
}

static void spawn_from(struct worker *w, struct level *level, const struct path *paths, uint32_t k)
{
    static const struct media outside = {0};
    const struct scene *scene = w->tracer->scene;
    struct seen_point p = seen_point_get(&w->points, k);
    const struct material *m = p.s.finish->material;
    const struct media *media = paths ? &paths[w->points.ray[k]].media : &outside;
    struct vec3 reflection = m->reflection, direction;
    if (!vec3_is_zero(m->refraction)) {
        bool entering = vec3_dot(vec3_get(geometric_normals(&w->points), k), p.s.incoming) < 0;
        struct path path = {.media = media_beyond(media, p.s.surface, entering)};
        double before = entering || media->n > 0 ? index_inside(scene, media) : m->ior;
        if (refracted(&p, before / index_inside(scene, &path.media), &direction))
            *spawn_ray(&level->refracted, &w->points, k, direction, m->refraction) = path;
        else
            reflection = vec3_add(reflection, m->refraction);
    }
    if (!vec3_is_zero(reflection))
        spawn_ray(&level->reflected, &w->points, k, mirrored(&p), reflection)->media = *media;
}

static void modern_spawn(struct worker *w, struct level *level, const struct path *paths)
{
    for (uint32_t k = 0; k < w->points.n; k++)
        if (w->points.finish[k]->bounces)
            spawn_from(w, level, paths, k);
}

const struct shading shading_modern = {modern_begin, modern_add, modern_spawn};
