#include "config.h"

#include "render/tracer.h"

void lamp_init(struct lamp *lamp, const struct light *light, bool brute_force)
{
    *lamp = (struct lamp){ .light = light, .box = box_empty() };
    if (light->kind == LIGHT_POINT)
        return;
    accel_build(&lamp->object, &light->object, brute_force);
    for (size_t i = 0; i < light->points.n; i++) {
        const struct light_point *point = &light->points.at[i];
        lamp->box = box_add(lamp->box, point->position);
        lamp->always_counts |= point->on_object || point->inside;
    }
}

void lamp_free(struct lamp *lamp)
{
    if (lamp->light->kind == LIGHT_AREA)
        accel_free(&lamp->object);
}

static struct ray shadow_ray(const struct shade_point *s, struct vec3 target, double t_max)
{
    return (struct ray){ .origin = s->p,
                         .direction = vec3_sub(target, s->p),
                         .t_max = t_max,
                         .from = s->prim,
                         .surface = SURFACE_NONE,
                         .spawned = true };
}

/* Blocked when the nearest hit is not emissive. */
static bool is_blocked(struct worker *w, const struct ray *ray)
{
    const struct tracer *t = w->tracer;
    struct hit hit;
    w->stats.shadow++;
    if (!t->emissive)
        return accel_any(&t->accel, ray);
    if (!accel_closest(&t->accel, ray, &hit))
        return false;
    uint32_t surface = t->scene->geometry.prims.at[hit.prim].surface;
    uint32_t material = t->scene->surfaces.at[surface].material;
    return t->scene->materials.at[material].kind != MATERIAL_EMISSIVE;
}

/* Whether the ray from the point through the grid point meets the light's object. */
static bool point_counts(const struct lamp *lamp, const struct light_point *point,
                         const struct shade_point *s, bool no_skip)
{
    if (point->on_object || (point->inside && !no_skip))
        return true;
    struct ray ray = shadow_ray(s, point->position, RAY_UNBOUNDED);
    ray.from = PRIM_NONE;
    return accel_any(&lamp->object, &ray);
}

static double area_share(struct worker *w, const struct lamp *lamp, const struct shade_point *s)
{
    const struct light *light = lamp->light;
    double reach = vec3_length(vec3_sub(light->position, s->p));
    uint64_t counted = 0, lit = 0;
    for (size_t i = 0; i < light->points.n; i++) {
        const struct light_point *point = &light->points.at[i];
        if (!point_counts(lamp, point, s, w->tracer->options->no_skip))
            continue;
        struct ray ray = shadow_ray(s, point->position, 0);
        double t_max = reach / vec3_length(ray.direction);
        ray.t_max = t_max <= RAY_UNBOUNDED ? t_max : RAY_UNBOUNDED;
        counted += point->count;
        lit += is_blocked(w, &ray) ? 0 : point->count;
    }
    return counted ? (double)lit / (double)counted : 0;
}

double lamp_share(struct worker *w, const struct lamp *lamp, const struct shade_point *s)
{
    if (lamp->light->kind == LIGHT_AREA)
        return area_share(w, lamp, s);
    struct ray ray = shadow_ray(s, lamp->light->position, 1);
    return is_blocked(w, &ray) ? 0 : 1;
}
