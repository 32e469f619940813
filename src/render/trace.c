#include "config.h"

#include "render/tracer.h"

void worker_init(struct worker *w, const struct tracer *tracer)
{
    *w = (struct worker){.tracer = tracer};
}

static void offspring_free(struct offspring *o)
{
    vec_free(&o->rays);
    vec_free(&o->paths);
}

void worker_free(struct worker *w)
{
    for (size_t i = 0; i < w->levels.n; i++) {
        offspring_free(&w->levels.at[i]->reflected);
        offspring_free(&w->levels.at[i]->refracted);
        free(w->levels.at[i]);
    }
    vec_free(&w->levels);
}

/* The level of this depth, emptied.  Levels are made one after another. */
static struct level *level_at(struct worker *w, uint32_t depth)
{
    if (depth == w->levels.n)
        vec_push(&w->levels, mem_zalloc(1, sizeof *w->levels.at[0]));
    struct level *level = w->levels.at[depth];
    level->reflected.rays.n = level->reflected.paths.n = 0;
    level->refracted.rays.n = level->refracted.paths.n = 0;
    return level;
}

static void add_ray(struct offspring *o, const struct shade_point *s, struct vec3 direction,
                    struct path path)
{
    vec_push(&o->rays, (struct ray){.origin = s->p,
                                    .direction = direction,
                                    .t_max = RAY_UNBOUNDED,
                                    .from = s->prim,
                                    .surface = SURFACE_NONE,
                                    .spawned = true});
    vec_push(&o->paths, path);
}

static void add_reflection(struct level *level, const struct shade_point *s, struct vec3 weight)
{
    struct vec3 direction = vec3_normalize(vec3_mad(s->incoming, -2 * s->facing, s->normal));
    add_ray(&level->reflected, s, direction, (struct path){1, SURFACE_NONE, s->ray, weight});
}

/* Which surface a refracted ray is tested against alone before all others. */
static uint32_t surface_crossed(const struct scene *scene, const struct shade_point *s)
{
    enum surface_kind kind = scene->surfaces.at[s->surface].kind;
    if (kind == SURFACE_SPHERE || kind == SURFACE_CYLINDER)
        return s->surface;
    return kind == SURFACE_MESH && !s->inside ? s->surface : SURFACE_NONE;
}

/* Classic refraction.  `index` is that of the arriving ray. */
static void add_refraction(struct level *level, const struct scene *scene,
                           const struct shade_point *s, double index, struct vec3 weight)
{
    double ior = s->finish->material->ior, eta = s->inside ? ior : index / ior;
    struct vec3 normal = s->inside ? vec3_neg(s->normal) : s->normal;
    double c = s->inside ? s->facing : -s->facing, k = 1 - eta * eta * (1 - c * c);
    if (!(k > 0))
        return;
    struct vec3 direction = vec3_scale(s->incoming, eta);
    direction = vec3_mad(direction, eta * c - sqrt(k), normal);
    add_ray(&level->refracted, s, direction,
            (struct path){s->inside ? 1 : ior, surface_crossed(scene, s), s->ray, weight});
}

/* The hit of the ray with the surface it crossed, alone. */
static bool hits_crossed_surface(const struct tracer *t, struct ray ray, uint32_t crossed,
                                 struct hit *hit)
{
    const struct surface *surface = &t->scene->surfaces.at[crossed];
    if (surface->prim_count == 1) {
        struct ray_frame frame = ray_frame_of(&ray);
        *hit = hit_none(ray.t_max);
        return ray_has_direction(&ray) &&
               geometry_intersect(&t->scene->geometry, surface->first_prim, &ray, &frame, hit);
    }
    ray.surface = crossed;
    return accel_closest(&t->accel, &ray, hit);
}

/* What the rays can hit at all, nearest first. */
static void find_targets(const struct tracer *t, const struct ray *rays, uint32_t n,
                         struct target_list *list)
{
    struct box origins = box_empty(), directions = box_empty();
    list->usable = false;
    if (!t->skips || n == 1)
        return;
    for (uint32_t i = 0; i < n; i++) {
        origins = box_add(origins, rays[i].origin);
        directions = box_add(directions, rays[i].direction);
    }
    struct shaft shaft = shaft_of_rays(&t->accel, origins, directions);
    shaft_list(&t->accel, &shaft, list);
    if (list->usable)
        shaft_sort(&t->accel, &shaft, list);
}

/* Fills in w->points with the hits of the batch; returns how many there are. */
static uint32_t find_points(struct worker *w, const struct ray *rays, const struct path *paths,
                            uint32_t n)
{
    const struct tracer *t = w->tracer;
    struct target_list list;
    struct hit hits[BATCH];
    uint32_t found = 0;
    find_targets(t, rays, n, &list);
    bundle_closest(&t->accel, &(struct bundle){rays, n, paths == NULL, &list}, hits);
    for (uint32_t i = 0; i < n; i++) {
        struct hit first;
        bool inside = paths && paths[i].crossed != SURFACE_NONE &&
                      hits_crossed_surface(t, rays[i], paths[i].crossed, &first);
        if (!inside && hits[i].prim == PRIM_NONE)
            continue;
        struct shade_point *s = &w->points[found++];
        shade_point_init(s, t, &rays[i], inside ? &first : &hits[i]);
        s->ray = i;
        s->inside = inside;
    }
    return found;
}

/* Notes the rays that the hit gives rise to.  Their share does not depend on the light, so each is
 * traced once, for the sum of all lights. */
static void add_offspring(struct level *level, const struct scene *scene,
                          const struct shade_point *s, struct vec3 intensity, double index)
{
    const struct material *m = s->finish->material;
    struct vec3 reflected = vec3_mul(intensity, m->reflection);
    struct vec3 refracted = vec3_mul(intensity, m->refraction);
    if (!vec3_is_zero(reflected))
        add_reflection(level, s, reflected);
    if (!vec3_is_zero(refracted))
        add_refraction(level, scene, s, index, refracted);
}

/* Traces the rays and adds their share to their parents' colours. */
static void trace_offspring(struct worker *w, struct level *level, uint32_t depth,
                            const struct offspring *o, struct vec3 *colours)
{
    for (size_t first = 0; first < o->rays.n; first += BATCH) {
        uint32_t n = o->rays.n - first < BATCH ? (uint32_t)(o->rays.n - first) : BATCH;
        const struct path *paths = o->paths.at + first;
        trace_batch(w, depth + 1, o->rays.at + first, paths, n, level->colours);
        for (uint32_t i = 0; i < n; i++) {
            struct vec3 *parent = &colours[paths[i].parent];
            *parent = vec3_add(*parent, vec3_mul(paths[i].weight, level->colours[i]));
        }
    }
}

/* A ray's colour is its direct light, then its reflection, then its refraction: the order of the
 * sum, and so every bit of it, does not depend on what else is in the batch. */
void trace_batch(struct worker *w, uint32_t depth, const struct ray *rays, const struct path *paths,
                 uint32_t n, struct vec3 *colours)
{
    struct level *level = level_at(w, depth);
    const struct tracer *t = w->tracer;
    for (uint32_t i = 0; i < n; i++)
        colours[i] = vec3_all(0);
    uint32_t found = find_points(w, rays, paths, n);
    shade_points(w, found);
    for (uint32_t i = 0; i < found; i++) {
        const struct shade_point *s = &w->points[i];
        colours[s->ray] = w->light[i].direct;
        if (depth < t->options->depth && s->finish->bounces)
            add_offspring(level, t->scene, s, w->light[i].intensity,
                          paths ? paths[s->ray].index : 1);
    }
    w->stats.reflection += level->reflected.rays.n;
    w->stats.refraction += level->refracted.rays.n;
    trace_offspring(w, level, depth, &level->reflected, colours);
    trace_offspring(w, level, depth, &level->refracted, colours);
}
