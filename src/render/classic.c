/* The original program's light and rays; each kernel set has the arithmetic of its lights. */
#include "config.h"

#include "render/tracer.h"

static struct box classic_begin(struct worker *w)
{
    const struct render_kernels *kernels = w->tracer->kernels;
    kernels->fill(w->light.direct, 0, w->points.n, vec3_all(0));
    if (w->points.any_bounces)
        kernels->fill(&w->light.intensity, 0, w->points.n, vec3_all(0));
    return kernels->bounds(&w->points.p, w->points.n);
}

static void classic_add(struct worker *w, size_t k, struct box box)
{
    const struct tracer *t = w->tracer;
    alignas(64) double room[BATCH_ROOM];
    const double *shares = lamp_shares(w, &t->lamps[k], box, room);
    t->kernels->add_light(&w->points, &t->scene->lights.at[k], shares, &w->light);
}

/* Which surface a refracted ray is tested against alone before all others. */
static uint32_t surface_crossed(const struct scene *scene, uint32_t surface, bool inside)
{
    enum surface_kind kind = scene->surfaces.at[surface].kind;
    if (kind == SURFACE_SPHERE || kind == SURFACE_CYLINDER)
        return surface;
    return kind == SURFACE_MESH && !inside ? surface : SURFACE_NONE;
}

/* `index` is that of the arriving ray. */
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
    struct path *path = spawn_ray(&level->refracted, points, k, direction, weight);
    path->crossed = surface_crossed(scene, s.surface, inside);
    path->index = inside ? 1 : ior;
}

/* All points are of one surface, and each mirrors some light: false where that is not so. */
static bool reflect_all(const struct worker *w, struct level *level)
{
    const struct shade_batch *points = &w->points;
    const struct material *m = points->finish[0]->material;
    struct offspring *o = &level->reflected;
    if (!points->in_order || !points->one_surface || !vec3_is_zero(m->refraction) ||
        w->tracer->kernels->weigh(&w->light.intensity, m->reflection, points->n, &o->weight) !=
            UINT64_MAX >> (BATCH - points->n))
        return false;
    for (uint32_t k = 0; k < points->n; k++)
        o->parent[k] = k;
    w->tracer->kernels->reflect(points, &o->rays);
    o->rays.n = points->n;
    o->rays.common_from = points->noted >= points->n;
    o->in_order = true;
    return true;
}

/* The rays' share does not depend on the light, so each is traced once, for the sum of all lights.
 */
static void classic_spawn(struct worker *w, struct level *level, const struct path *paths)
{
    const struct shade_batch *points = &w->points;
    struct ray_batch mirrored;
    if (reflect_all(w, level))
        return;
    w->tracer->kernels->reflect(points, &mirrored);
    for (uint32_t k = 0; k < points->n; k++) {
        const struct material *m = points->finish[k]->material;
        if (!points->finish[k]->bounces)
            continue;
        struct vec3 intensity = vec3_get(&w->light.intensity, k);
        struct vec3 reflected = vec3_mul(intensity, m->reflection);
        struct vec3 refracted = vec3_mul(intensity, m->refraction);
        if (!vec3_is_zero(reflected))
            spawn_ray(&level->reflected, points, k, vec3_get(&mirrored.direction, k), reflected);
        if (!vec3_is_zero(refracted))
            add_refraction(level, w->tracer->scene, points, k,
                           paths ? paths[points->ray[k]].index : 1, refracted);
    }
}

const struct shading shading_classic = {classic_begin, classic_add, classic_spawn};
