#include "config.h"

#include "render/tracer.h"

static bool is_zero(struct vec3 v)
{
    return v.x == 0 && v.y == 0 && v.z == 0;
}

static struct ray spawned_ray(const struct shade_point *s, struct vec3 direction)
{
    return (struct ray){ .origin = s->p,
                         .direction = direction,
                         .t_max = RAY_UNBOUNDED,
                         .from = s->prim,
                         .surface = SURFACE_NONE,
                         .spawned = true };
}

static void push_reflection(struct worker *w, const struct path *path, const struct shade_point *s,
                            struct vec3 weight)
{
    double cosine = vec3_dot(s->normal, s->incoming);
    struct vec3 direction = vec3_normalize(vec3_mad(s->incoming, -2 * cosine, s->normal));
    w->stats.reflection++;
    vec_push(&w->paths, (struct path){ .ray = spawned_ray(s, direction),
                                       .weight = weight,
                                       .index = 1,
                                       .depth = path->depth + 1,
                                       .crossed = SURFACE_NONE });
}

/* Which surface a refracted ray is tested against alone before all others. */
static uint32_t surface_crossed(const struct worker *w, const struct shade_point *s, bool inside)
{
    uint32_t number = (uint32_t)(s->surface - w->tracer->scene->surfaces.at);
    enum surface_kind kind = s->surface->kind;
    if (kind == SURFACE_SPHERE || kind == SURFACE_CYLINDER)
        return number;
    return kind == SURFACE_MESH && !inside ? number : SURFACE_NONE;
}

/* original.md, section 4. */
static void push_refraction(struct worker *w, const struct path *path, const struct shade_point *s,
                            bool inside, struct vec3 weight)
{
    double ior = s->material->ior, eta = inside ? ior : path->index / ior;
    struct vec3 normal = inside ? vec3_neg(s->normal) : s->normal;
    double c = -vec3_dot(s->incoming, normal), k = 1 - eta * eta * (1 - c * c);
    if (!(k > 0))
        return;
    struct vec3 direction = vec3_scale(s->incoming, eta);
    direction = vec3_mad(direction, eta * c - sqrt(k), normal);
    w->stats.refraction++;
    vec_push(&w->paths, (struct path){ .ray = spawned_ray(s, direction),
                                       .weight = weight,
                                       .index = inside ? 1 : ior,
                                       .depth = path->depth + 1,
                                       .crossed = surface_crossed(w, s, inside) });
}

/* The hit of the ray with its own surface alone. */
static bool hits_crossed_surface(const struct tracer *t, const struct path *path, struct hit *hit)
{
    const struct surface *surface = &t->scene->surfaces.at[path->crossed];
    if (surface->prim_count == 1) {
        struct ray_frame frame = ray_frame_of(&path->ray);
        *hit = hit_none(path->ray.t_max);
        return ray_has_direction(&path->ray) &&
               geometry_intersect(&t->scene->geometry, surface->first_prim, &path->ray, &frame,
                                  hit);
    }
    struct ray ray = path->ray;
    ray.surface = path->crossed;
    return accel_closest(&t->accel, &ray, hit);
}

/* Traces one ray: returns what it adds to the picture itself and notes the rays it gives rise to.
 * Their share does not depend on the light, so each is traced once, for the sum of all lights. */
static struct vec3 trace_path(struct worker *w, const struct path *path)
{
    const struct tracer *t = w->tracer;
    struct hit hit;
    bool inside = path->crossed != SURFACE_NONE && hits_crossed_surface(t, path, &hit);
    if (!inside && !accel_closest(&t->accel, &path->ray, &hit))
        return vec3_all(0);
    struct shade_point s = shade_point_of(t->scene, &path->ray, &hit);
    struct vec3 intensity, direct = shade_direct(w, &s, &intensity);
    if (path->depth < t->options->depth) {
        const struct material *m = s.material;
        struct vec3 weight = vec3_mul(path->weight, intensity);
        struct vec3 reflected = vec3_mul(weight, m->reflection);
        struct vec3 refracted = vec3_mul(weight, m->refraction);
        if (!is_zero(reflected))
            push_reflection(w, path, &s, reflected);
        if (!is_zero(refracted))
            push_refraction(w, path, &s, inside, refracted);
    }
    return vec3_mul(path->weight, direct);
}

struct vec3 trace_colour(struct worker *w, const struct ray *ray)
{
    struct vec3 colour = vec3_all(0);
    w->stats.primary++;
    w->paths.n = 0;
    vec_push(&w->paths, (struct path){ .ray = *ray,
                                       .weight = vec3_all(1),
                                       .index = 1,
                                       .crossed = SURFACE_NONE });
    while (w->paths.n > 0) {
        struct path path = w->paths.at[--w->paths.n];
        colour = vec3_add(colour, trace_path(w, &path));
    }
    return colour;
}
