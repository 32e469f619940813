#include "config.h"

#include "scene/geometry.h"

#include "scene/intersect.h"
#include "scene/shape.h"

#include <assert.h>

struct shape {
    struct box (*bounds)(const struct geometry *g, uint32_t prim);
    bool (*lies_on)(const struct geometry *g, uint32_t prim, struct vec3 p, double reach);
    struct vec3 (*hit_point)(const struct geometry *g, const struct ray *ray, const struct hit *hit,
                             struct vec3 *normal);
};

static const struct shape shapes[PRIM_KINDS] = {
    [PRIM_SPHERE] = {sphere_bounds, sphere_lies_on, sphere_hit_point},
    [PRIM_CYLINDER] = {cylinder_bounds, cylinder_lies_on, cylinder_hit_point},
    [PRIM_TRIANGLE] = {triangle_bounds, triangle_lies_on, triangle_hit_point},
    [PRIM_INSTANCE] = {instance_bounds, instance_lies_on, instance_hit_point},
};

static const struct shape *shape_of(const struct geometry *g, uint32_t prim)
{
    return &shapes[g->prims.at[prim].kind];
}

void geometry_free(struct geometry *g)
{
    vec_free(&g->prims);
    vec_free(&g->spheres);
    vec_free(&g->cylinders);
    vec_free(&g->triangles);
    vec_free(&g->vertices);
    vec_free(&g->instances);
    for (size_t i = 0; i < g->prototypes.n; i++) {
        geometry_free(&g->prototypes.at[i]->shapes);
        free(g->prototypes.at[i]);
    }
    vec_free(&g->prototypes);
}

void geometry_add_prim(struct geometry *g, enum prim_kind kind, size_t index, uint32_t surface)
{
    assert(g->prims.n < GEOMETRY_LIMIT && index < GEOMETRY_LIMIT);
    vec_push(&g->prims, (struct prim){.kind = kind,
                                      .index = (uint32_t)index & (GEOMETRY_LIMIT - 1),
                                      .surface = surface});
}

void geometry_add_sphere(struct geometry *g, uint32_t surface, struct vec3 center, double radius)
{
    geometry_add_prim(g, PRIM_SPHERE, g->spheres.n, surface);
    vec_push(&g->spheres, (struct sphere){center, radius, vec3_largest(center) + radius});
}

void geometry_add_cylinder(struct geometry *g, uint32_t surface, struct vec3 base, struct vec3 top,
                           double radius)
{
    struct vec3 along = vec3_sub(top, base);
    double height = vec3_length(along);
    /* Divided, not scaled by 1/height: an axis along a coordinate is exactly that. */
    struct vec3 axis = vec3(along.x / height, along.y / height, along.z / height);
    geometry_add_prim(g, PRIM_CYLINDER, g->cylinders.n, surface);
    vec_push(&g->cylinders, (struct cylinder){base, axis, height, radius});
}

void geometry_add_triangle(struct geometry *g, uint32_t surface, uint32_t v0, uint32_t v1,
                           uint32_t v2)
{
    assert(v0 < g->vertices.n && v1 < g->vertices.n && v2 < g->vertices.n);
    const struct vec3 *v = g->vertices.at;
    struct box b = box_add(box_add((struct box){v[v0], v[v0]}, v[v1]), v[v2]);
    struct triangle t = {.vertex = {v0, v1, v2},
                         .reach = fmax(vec3_largest(b.lo), vec3_largest(b.hi))};
    t.normal = triangle_unit_normal(v[v0], v[v1], v[v2]);
    geometry_add_prim(g, PRIM_TRIANGLE, g->triangles.n, surface);
    vec_push(&g->triangles, t);
}

uint32_t geometry_add_vertex(struct geometry *g, struct vec3 p)
{
    vec_push(&g->vertices, p);
    return (uint32_t)(g->vertices.n - 1);
}

struct geometry *geometry_solids(struct geometry *g)
{
    if (g->prototypes.n == 0) {
        vec_push(&g->prototypes, mem_zalloc(1, sizeof(struct prototype)));
        geometry_add_sphere(&g->prototypes.at[0]->shapes, 0, vec3_all(0), 1);
    }
    return &g->prototypes.at[PROTOTYPE_SOLIDS]->shapes;
}

uint32_t geometry_add_prototype(struct geometry *g)
{
    struct prototype *p = mem_zalloc(1, sizeof *p);
    p->box = box_empty();
    geometry_solids(g);
    vec_push(&g->prototypes, p);
    return (uint32_t)(g->prototypes.n - 1);
}

struct box geometry_prim_bounds(const struct geometry *g, uint32_t prim)
{
    return shape_of(g, prim)->bounds(g, prim);
}

struct box geometry_bounds(const struct geometry *g)
{
    struct box b = box_empty();
    for (uint32_t i = 0; i < g->prims.n; i++)
        b = box_join(b, geometry_prim_bounds(g, i));
    return b;
}

bool geometry_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                        const struct ray_frame *frame, struct hit *best)
{
    if (g->prims.at[prim].kind == PRIM_INSTANCE)
        return instance_intersect(g, prim, ray, best);
    return target_intersect(g, target_of(g, prim), ray, frame, best);
}

bool geometry_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach)
{
    return shape_of(g, prim)->lies_on(g, prim, p, reach);
}

struct spot geometry_spot(const struct geometry *g, const struct hit *hit)
{
    struct prim prim = g->prims.at[hit->prim];
    if (prim.kind != PRIM_INSTANCE)
        return (struct spot){g, hit->prim, hit->part, NULL};
    const struct instance *i = &g->instances.at[prim.index];
    bool whole = i->only == PRIM_NONE;
    return (struct spot){&g->prototypes.at[i->prototype]->shapes, whole ? hit->part : i->only,
                         whole ? 0 : hit->part, i};
}

struct vec3 geometry_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit, struct vec3 *normal)
{
    return shape_of(g, hit->prim)->hit_point(g, ray, hit, normal);
}
