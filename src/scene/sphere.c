#include "config.h"

#include "scene/shape.h"

static const struct sphere *sphere_at(const struct geometry *g, uint32_t prim)
{
    return &g->spheres.at[g->prims.at[prim].index];
}

struct box sphere_bounds(const struct geometry *g, uint32_t prim)
{
    const struct sphere *s = sphere_at(g, prim);
    struct vec3 r = vec3_all(s->radius);
    return (struct box){ vec3_sub(s->center, r), vec3_add(s->center, r) };
}

double sphere_power(const struct sphere *s, struct vec3 p)
{
    struct vec3 f = vec3_sub(p, s->center);
    double c = vec3_dot(f, f) - s->radius * s->radius;
    double reach = vec3_largest(p) + vec3_largest(s->center) + s->radius;
    return fabs(c) <= SPAWN_TOLERANCE * 2 * s->radius * reach ? 0 : c;
}

/* The discriminant from the ray's point nearest to the center keeps its digits however far the
 * origin is (Haines, Guenther, Akenine-Moeller, Precision improvements for ray/sphere intersection,
 * Ray Tracing Gems 2019, ch. 7). */
bool sphere_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                      const struct ray_frame *frame, struct hit *best)
{
    const struct sphere *s = sphere_at(g, prim);
    struct vec3 d = ray->direction, f = vec3_sub(ray->origin, s->center);
    double a = vec3_dot(d, d), b = -vec3_dot(f, d);
    (void)frame;
    double near, far;
    double c = ray->spawned ? sphere_power(s, ray->origin)
                            : vec3_dot(f, f) - s->radius * s->radius;
    if (c == 0) { /* the origin is one root, the chord's other end the other */
        near = far = 2 * b / a;
    } else {
        struct vec3 l = vec3_mad(f, b / a, d);
        double discriminant = s->radius * s->radius - vec3_dot(l, l);
        if (!(discriminant >= 0))
            return false;
        double q = b + copysign(sqrt(a * discriminant), b);
        near = c / q;
        far = q / a;
        if (near > far) {
            double swap = near;
            near = far;
            far = swap;
        }
    }
    double t = near > 0 ? near : far;
    if (!hit_before(t, prim, best))
        return false;
    *best = (struct hit){ .t = t, .prim = prim };
    return true;
}

bool sphere_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p)
{
    return sphere_power(sphere_at(g, prim), p) == 0;
}

struct vec3 sphere_hit_point(const struct geometry *g, const struct ray *ray,
                             const struct hit *hit)
{
    const struct sphere *s = sphere_at(g, hit->prim);
    struct vec3 f = vec3_sub(ray->origin, s->center);
    f = vec3_mad(f, hit->t, ray->direction);
    return vec3_mad(s->center, s->radius / vec3_length(f), f);
}

struct vec3 sphere_normal(const struct geometry *g, const struct hit *hit, struct vec3 p)
{
    return vec3_normalize(vec3_sub(p, sphere_at(g, hit->prim)->center));
}
