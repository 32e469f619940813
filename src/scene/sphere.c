#include "config.h"

#include "scene/intersect.h"
#include "scene/shape.h"

static const struct sphere *sphere_at(const struct geometry *g, uint32_t prim)
{
    return &g->spheres.at[g->prims.at[prim].index];
}

struct box sphere_bounds(const struct geometry *g, uint32_t prim)
{
    const struct sphere *s = sphere_at(g, prim);
    struct vec3 r = vec3_all(s->radius);
    return (struct box){vec3_sub(s->center, r), vec3_add(s->center, r)};
}

bool sphere_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach)
{
    const struct sphere *s = sphere_at(g, prim);
    return sphere_power(s, vec3_sub(p, s->center), reach, SPAWN_TOLERANCE) == 0;
}

struct vec3 sphere_hit_point(const struct geometry *g, const struct ray *ray, const struct hit *hit,
                             struct vec3 *normal)
{
    const struct sphere *s = sphere_at(g, hit->prim);
    struct vec3 f = vec3_sub(ray->origin, s->center);
    *normal = vec3_normalize(vec3_mad(f, hit->t, ray->direction));
    return vec3_mad(s->center, s->radius, *normal);
}
