#include "config.h"

#include "math/angle.h"
#include "scene/scene.h"

static double clamp(double x, double lo, double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* The original takes longitudes by asin(z / q) and latitudes by acos(y / radius): the same angles,
 * less exact where these are steep. */
struct vec2 sphere_uv(const struct sphere *s, struct vec3 p)
{
    struct vec3 d = vec3_sub(p, s->center);
    double q = sqrt(d.x * d.x + d.z * d.z);
    double longitude = q == 0 ? 0 : angle_of(d.x, d.z), latitude = angle_of(d.y, q);
    return (struct vec2){longitude * (1 / (2 * PI)), latitude * (-1 / PI)};
}

static struct vec2 cylinder_uv(const struct cylinder *c, struct vec3 point)
{
    struct vec3 e = c->axis, p = vec3_sub(point, c->base);
    double along = vec3_dot(e, p), x = p.x, z = p.z;
    if (!(fabs(e.y) > 1 - 1e-6)) { /* not upright */
        p = vec3_mad(p, -along, e);
        x = p.y;
        z = vec3_dot(p, vec3_normalize(vec3_cross(vec3(0, 1, 0), e)));
    }
    double turn = atan(x / z) / (2 * PI);
    return (struct vec2){z <= 0 ? -(0.5 + turn) : -turn, clamp(along / c->height, 0, 1)};
}

size_t surface_face(const struct surface *surface, const struct spot *spot)
{
    return spot->instance ? spot->prim : spot->prim - surface->first_prim;
}

struct surface_faces surface_faces(const struct scene *s, const struct surface *surface)
{
    const struct geometry *g = &s->geometry;
    const struct prim *p = &g->prims.at[surface->first_prim];
    if (surface->prim_count != 1 || p->kind != PRIM_INSTANCE)
        return (struct surface_faces){g, surface->first_prim, surface->prim_count,
                                      surface->first_vertex};
    const struct geometry *shapes = &g->prototypes.at[g->instances.at[p->index].prototype]->shapes;
    return (struct surface_faces){shapes, 0, (uint32_t)shapes->prims.n, 0};
}

struct vec2 surface_uv(const struct scene *s, const struct surface *surface, const struct hit *hit,
                       struct vec3 p)
{
    struct spot spot = geometry_spot(&s->geometry, hit);
    struct prim prim = spot.geometry->prims.at[spot.prim];
    if (spot.instance)
        p = affine_point(&spot.instance->to_shape, p);
    if (prim.kind == PRIM_SPHERE)
        return sphere_uv(&spot.geometry->spheres.at[prim.index], p);
    if (prim.kind == PRIM_CYLINDER)
        return cylinder_uv(&spot.geometry->cylinders.at[prim.index], p);
    if (surface->uvs == NULL)
        return (struct vec2){0, 0};
    return triangle_uv(surface->uvs + 3 * surface_face(surface, &spot), hit->b1, hit->b2);
}

/* A direction's, which may be no direction at all. */
static struct vec3 placed_normal(const struct instance *i, struct vec3 n)
{
    n = affine_normal(&i->to_shape, n);
    return vec3_largest(n) > 0 ? vec3_normalize(n) : n;
}

struct vec3 surface_corner_normal(const struct surface *surface, const struct spot *spot, int i)
{
    const struct geometry *g = spot->geometry;
    const struct triangle *t = &g->triangles.at[g->prims.at[spot->prim].index];
    const struct triangle_corners *own = surface->normal_corners;
    uint32_t at = own ? own[surface_face(surface, spot)].at[i] : t->vertex[i];
    struct vec3 n = surface->normals[own || spot->instance ? at : at - surface->first_vertex];
    return spot->instance ? placed_normal(spot->instance, n) : n;
}

/* Where the vertex normals cancel out, the face's own is taken. */
static struct vec3 smooth_normal(const struct surface *surface, const struct spot *spot,
                                 const struct hit *hit)
{
    const struct geometry *g = spot->geometry;
    struct vec3 n = vec3_scale(surface_corner_normal(surface, spot, 0), 1 - hit->b1 - hit->b2);
    n = vec3_mad(n, hit->b1, surface_corner_normal(surface, spot, 1));
    n = vec3_mad(n, hit->b2, surface_corner_normal(surface, spot, 2));
    if (vec3_largest(n) > 0)
        return vec3_normalize(n);
    n = g->triangles.at[g->prims.at[spot->prim].index].normal;
    return spot->instance ? placed_normal(spot->instance, n) : n;
}

struct vec3 surface_normal(const struct scene *s, const struct surface *surface,
                           const struct hit *hit, struct vec3 geometric)
{
    struct vec3 n = geometric;
    if (surface->normals) {
        struct spot spot = geometry_spot(&s->geometry, hit);
        n = smooth_normal(surface, &spot, hit);
    }
    return surface->flip ? vec3_neg(n) : n;
}
