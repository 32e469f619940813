#include "config.h"

#include "render/tracer.h"

#include <string.h>

struct worker *worker_new(const struct tracer *tracer)
{
    struct worker *w = mem_alloc_aligned(1, sizeof *w);
    memset(w, 0, sizeof *w);
    w->tracer = tracer;
    return w;
}

void worker_free(struct worker *w)
{
    for (size_t i = 0; i < w->levels.n; i++)
        free(w->levels.at[i]);
    vec_free(&w->levels);
    free(w);
}

static struct level *level_new(void)
{
    struct level *level = mem_alloc_aligned(1, sizeof *level);
    memset(level, 0, sizeof *level);
    level->reflected.rays.spawned = level->refracted.rays.spawned = true;
    return level;
}

/* The level of this depth, emptied.  Levels are made one after another. */
static struct level *level_at(struct worker *w, uint32_t depth)
{
    if (depth == w->levels.n)
        vec_push(&w->levels, level_new());
    struct level *level = w->levels.at[depth];
    level->reflected.rays.n = level->refracted.rays.n = 0;
    return level;
}

static void add_ray(struct offspring *o, const struct shade_batch *points, uint32_t k,
                    struct vec3 direction, struct path path)
{
    uint32_t i = o->rays.n++;
    vec3_put(&o->rays.origin, i, vec3_get(&points->p, k));
    vec3_put(&o->rays.direction, i, direction);
    o->rays.t_max[i] = RAY_UNBOUNDED;
    o->rays.from[i] = points->prim[k];
    o->paths[i] = path;
}

/* Which surface a refracted ray is tested against alone before all others. */
static uint32_t surface_crossed(const struct scene *scene, uint32_t surface, bool inside)
{
    enum surface_kind kind = scene->surfaces.at[surface].kind;
    if (kind == SURFACE_SPHERE || kind == SURFACE_CYLINDER)
        return surface;
    return kind == SURFACE_MESH && !inside ? surface : SURFACE_NONE;
}

/* Classic refraction.  `index` is that of the arriving ray. */
static void add_refraction(struct level *level, const struct scene *scene,
                           const struct shade_batch *points, uint32_t k, double index,
                           struct vec3 weight)
{
    struct shade_point s = shade_point_get(points, k);
    bool inside = points->inside[k];
    double ior = s.finish->material->ior, eta = inside ? ior : index / ior;
    struct vec3 normal = inside ? vec3_neg(s.normal) : s.normal;
    double c = inside ? s.facing : -s.facing, root = 1 - eta * eta * (1 - c * c);
    if (!(root > 0))
        return;
    struct vec3 direction = vec3_scale(s.incoming, eta);
    direction = vec3_mad(direction, eta * c - sqrt(root), normal);
    add_ray(&level->refracted, points, k, direction,
            (struct path){inside ? 1 : ior, surface_crossed(scene, s.surface, inside),
                          points->ray[k], weight});
}

/* Notes the rays that the hits give rise to.  Their share does not depend on the light, so each is
 * traced once, for the sum of all lights. */
static void add_offspring(struct worker *w, struct level *level, const struct path *paths)
{
    const struct shade_batch *points = &w->points;
    struct vec3_batch mirrored;
    w->tracer->kernels->reflect(points, &mirrored);
    for (uint32_t k = 0; k < points->n; k++) {
        const struct material *m = points->finish[k]->material;
        uint32_t ray = points->ray[k];
        if (!points->finish[k]->bounces)
            continue;
        struct vec3 intensity = vec3_get(&w->light.intensity, k);
        struct vec3 reflected = vec3_mul(intensity, m->reflection);
        struct vec3 refracted = vec3_mul(intensity, m->refraction);
        if (!vec3_is_zero(reflected))
            add_ray(&level->reflected, points, k, vec3_get(&mirrored, k),
                    (struct path){1, SURFACE_NONE, ray, reflected});
        if (!vec3_is_zero(refracted))
            add_refraction(level, w->tracer->scene, points, k, paths ? paths[ray].index : 1,
                           refracted);
    }
}

/* Traces the rays and adds their share to their parents' colours. */
static void trace_offspring(struct worker *w, struct level *level, uint32_t depth,
                            const struct offspring *o, struct vec3_batch *colours)
{
    if (o->rays.n == 0)
        return;
    trace_batch(w, depth + 1, &o->rays, o->paths, &level->colours);
    for (uint32_t i = 0; i < o->rays.n; i++) {
        const struct path *path = &o->paths[i];
        struct vec3 share = vec3_mul(path->weight, vec3_get(&level->colours, i));
        vec3_put(colours, path->parent, vec3_add(vec3_get(colours, path->parent), share));
    }
}

/* A ray's colour is its direct light, then its reflection, then its refraction: the order of the
 * sum, and so every bit of it, does not depend on what else is in the batch. */
void trace_batch(struct worker *w, uint32_t depth, const struct ray_batch *rays,
                 const struct path *paths, struct vec3_batch *colours)
{
    struct level *level = level_at(w, depth);
    const struct tracer *t = w->tracer;
    vec3_fill(colours, rays->n, vec3_all(0));
    find_points(w, rays, paths);
    shade_points(w);
    for (uint32_t k = 0; k < w->points.n; k++)
        vec3_put(colours, w->points.ray[k], vec3_get(&w->light.direct, k));
    if (depth < t->options->depth && w->points.any_bounces)
        add_offspring(w, level, paths);
    w->stats.reflection += level->reflected.rays.n;
    w->stats.refraction += level->refracted.rays.n;
    trace_offspring(w, level, depth, &level->reflected, colours);
    trace_offspring(w, level, depth, &level->refracted, colours);
}
