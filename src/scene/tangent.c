/* Modern: the frames of normal maps, and where shadow rays of smooth meshes start. */
#include "config.h"

#include "scene/scene.h"

/* How a place moves as u and v grow, any length. */
struct directions {
    struct vec3 u, v;
};

static struct directions on_sphere(const struct sphere *s, struct vec3 p)
{
    struct vec3 d = vec3_sub(p, s->center);
    return (struct directions){vec3(-d.z, 0, d.x), vec3(0, 1, 0)};
}

/* u falls as cylinder_uv's angle around the axis grows. */
static struct directions on_cylinder(const struct cylinder *c, struct vec3 p)
{
    struct vec3 turn = vec3_cross(c->axis, vec3_sub(p, c->base));
    bool upside_down = c->axis.y < -(1 - 1e-6);
    return (struct directions){upside_down ? turn : vec3_neg(turn), c->axis};
}

/* Solves e1 = du1 u + dv1 v, e2 = du2 u + dv2 v, but for the length. */
static struct directions on_triangle(const struct vec3 corner[3], const struct vec2 *uv)
{
    struct vec3 e1 = vec3_sub(corner[1], corner[0]), e2 = vec3_sub(corner[2], corner[0]);
    double du1 = uv[1].x - uv[0].x, dv1 = uv[1].y - uv[0].y;
    double du2 = uv[2].x - uv[0].x, dv2 = uv[2].y - uv[0].y;
    double sign = copysign(1, difference_of_products(du1, dv2, du2, dv1));
    return (struct directions){
        vec3_scale(vec3_mad(vec3_scale(e1, dv2), -dv1, e2), sign),
        vec3_scale(vec3_mad(vec3_scale(e2, du1), -du2, e1), sign),
    };
}

static void corners_of(const struct geometry *g, const struct triangle *t, struct vec3 corner[3])
{
    for (int i = 0; i < 3; i++)
        corner[i] = g->vertices.at[t->vertex[i]];
}

static struct directions directions_at(const struct surface *surface, const struct spot *spot,
                                       struct vec3 p)
{
    const struct geometry *g = spot->geometry;
    struct prim prim = g->prims.at[spot->prim];
    struct vec3 corner[3];
    if (prim.kind == PRIM_SPHERE)
        return on_sphere(&g->spheres.at[prim.index], p);
    if (prim.kind == PRIM_CYLINDER)
        return on_cylinder(&g->cylinders.at[prim.index], p);
    if (!surface->uvs)
        return (struct directions){{0, 0, 0}, {0, 0, 0}};
    corners_of(g, &g->triangles.at[prim.index], corner);
    return on_triangle(corner, surface->uvs + 3 * surface_face(surface, spot));
}

void surface_frame(const struct scene *s, const struct surface *surface, const struct hit *hit,
                   struct vec3 p, struct vec3 normal, struct vec3 *x, struct vec3 *y)
{
    struct spot spot = geometry_spot(&s->geometry, hit);
    struct directions d = directions_at(
        surface, &spot, spot.instance ? affine_point(&spot.instance->to_shape, p) : p);
    if (spot.instance) {
        d.u = affine_vector(&spot.instance->to_world, d.u);
        d.v = affine_vector(&spot.instance->to_world, d.v);
    }
    *x = vec3_mad(d.u, -vec3_dot(d.u, normal), normal);
    if (!(vec3_dot(*x, *x) > 0)) {
        vec3_basis(normal, x, y);
        return;
    }
    *x = vec3_normalize(*x);
    *y = vec3_cross(normal, *x);
    if (vec3_dot(*y, d.v) < 0)
        *y = vec3_neg(*y);
}

struct vec3 surface_lift(const struct scene *s, const struct surface *surface,
                         const struct hit *hit, struct vec3 p, struct vec3 outwards)
{
    struct spot spot = geometry_spot(&s->geometry, hit);
    const struct triangle *t =
        &spot.geometry->triangles.at[spot.geometry->prims.at[spot.prim].index];
    double weight[3] = {1 - hit->b1 - hit->b2, hit->b1, hit->b2};
    struct vec3 corner[3], lifted = p;
    corners_of(spot.geometry, t, corner);
    for (int i = 0; i < 3; i++) {
        struct vec3 n = surface_corner_normal(surface, &spot, i);
        if (spot.instance)
            corner[i] = affine_point(&spot.instance->to_world, corner[i]);
        if (vec3_dot(n, outwards) < 0)
            n = vec3_neg(n);
        double above = vec3_dot(vec3_sub(p, corner[i]), n);
        if (above < 0)
            lifted = vec3_mad(lifted, -weight[i] * above, n);
    }
    return lifted;
}
