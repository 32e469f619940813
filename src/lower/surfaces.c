/* Surfaces and their materials. */
#include "config.h"

#include "lower/lowering.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static struct uv_map uv_map_of(const struct desc_object *o)
{
    struct vec3 offset = desc_vector(o, PROP_UV_OFFSET), scale = desc_vector(o, PROP_UV_SCALE);
    return (struct uv_map){{offset.x, offset.y}, {scale.x, scale.y}};
}

static enum material_kind material_kind_of(enum schema_kind kind)
{
    static const uint8_t kinds[SCHEMA_KINDS] = {
        [KIND_LAMBERT] = MATERIAL_LAMBERT, [KIND_PHONG] = MATERIAL_PHONG,
        [KIND_SHINY] = MATERIAL_SHINY,     [KIND_METAL] = MATERIAL_METAL,
        [KIND_GLASS] = MATERIAL_GLASS,     [KIND_EMISSIVE] = MATERIAL_EMISSIVE,
    };
    return kinds[kind];
}

static uint32_t lower_material(struct lowering *l, const struct desc_object *o)
{
    if (l->material_of[o->number] != UINT32_MAX)
        return l->material_of[o->number];
    const struct desc_value *texture = desc_get(o, PROP_TEXTURE);
    struct material m = {
        .kind = material_kind_of(o->kind),
        .diffuse = desc_vector(o, PROP_DIFFUSE),
        .specular = desc_vector(o, PROP_SPECULAR),
        .reflection = desc_vector(o, PROP_REFLECTION),
        .refraction = desc_vector(o, PROP_REFRACTION),
        .exponent = desc_number(o, PROP_EXPONENT),
        .ior = desc_number(o, PROP_IOR),
        .texture = lower_texture(l, texture ? texture->object : NULL),
        .uv = uv_map_of(o),
    };
    if (m.kind == MATERIAL_METAL) { /* a metal tints what it mirrors */
        m.specular = vec3_mul(m.specular, m.diffuse);
        m.reflection = vec3_scale(m.diffuse, m.reflection.x);
    }
    uint32_t number = (uint32_t)l->scene->materials.n;
    vec_push(&l->scene->materials, m);
    return l->material_of[o->number] = number;
}

/* ---- shapes ---- */

bool lower_fits(struct lowering *l, const struct desc_object *o, const struct geometry *g,
                size_t more_prims, size_t more_vertices)
{
    if (more_prims < GEOMETRY_LIMIT - g->prims.n && more_vertices < GEOMETRY_LIMIT - g->vertices.n)
        return true;
    diag_report(l->diag, DIAG_SCENE_TOO_LARGE, o->span,
                "the scene has more triangles or vertices than can be held (limit %u)",
                GEOMETRY_LIMIT);
    return false;
}

static bool add_sphere(struct lowering *l, const struct desc_object *o, struct geometry *g,
                       uint32_t surface)
{
    (void)l;
    geometry_add_sphere(g, surface, desc_vector(o, PROP_CENTER), desc_number(o, PROP_RADIUS));
    return true;
}

/* A height that is not 0 wins over the top; a negative one puts the base above. */
static bool add_cylinder(struct lowering *l, const struct desc_object *o, struct geometry *g,
                         uint32_t surface)
{
    struct vec3 base = desc_vector(o, PROP_BASE), top = desc_vector(o, PROP_TOP);
    double height = desc_number(o, PROP_HEIGHT);
    if (height != 0)
        top = vec3_add(base, vec3(0, height, 0));
    if (base.x == top.x && base.y == top.y && base.z == top.z) {
        diag_report(l->diag, DIAG_DEGENERATE, o->span,
                    "the cylinder's height is lost in rounding at these coordinates");
        return false;
    }
    geometry_add_cylinder(g, surface, base, top, desc_number(o, PROP_RADIUS));
    return true;
}

static bool add_polygon(struct geometry *g, uint32_t surface, const struct desc_value *corners)
{
    uint32_t v = (uint32_t)g->vertices.n;
    for (uint32_t i = 0; i < corners->n; i++)
        geometry_add_vertex(g, corners->points[i]);
    geometry_add_triangle(g, surface, v, v + 1, v + 2);
    if (corners->n == 4)
        geometry_add_triangle(g, surface, v + 2, v + 3, v);
    return true;
}

static bool add_triangle(struct lowering *l, const struct desc_object *o, struct geometry *g,
                         uint32_t surface)
{
    (void)l;
    return add_polygon(g, surface, desc_get(o, PROP_TRIANGLE_VERTICES));
}

static bool add_quad(struct lowering *l, const struct desc_object *o, struct geometry *g,
                     uint32_t surface)
{
    (void)l;
    return add_polygon(g, surface, desc_get(o, PROP_QUAD_VERTICES));
}

static const struct shape_row {
    enum surface_kind surface;
    bool (*add)(struct lowering *l, const struct desc_object *o, struct geometry *g,
                uint32_t surface);
} shapes[SCHEMA_KINDS] = {
    [KIND_SPHERE] = {SURFACE_SPHERE, add_sphere},
    [KIND_CYLINDER] = {SURFACE_CYLINDER, add_cylinder},
    [KIND_TRIANGLE] = {SURFACE_TRIANGLE, add_triangle},
    [KIND_QUAD] = {SURFACE_QUAD, add_quad},
    [KIND_MESH] = {SURFACE_MESH, lower_mesh_shape},
};

bool lower_shape(struct lowering *l, const struct desc_object *o, struct geometry *g,
                 uint32_t surface, uint32_t *first_vertex)
{
    enum { MOST = 4 }; /* prims and vertices of any shape but a mesh, which asks for itself */
    *first_vertex = (uint32_t)g->vertices.n;
    assert(shapes[o->kind].add);
    return lower_fits(l, o, g, MOST, MOST) && shapes[o->kind].add(l, o, g, surface);
}

/* ---- what shading needs beyond the shape ---- */

static const struct vec2 *corner_uvs(struct lowering *l, const struct desc_value *corners)
{
    static const uint8_t order[6] = {0, 1, 2, 2, 3, 0}; /* a quad's two triangles */
    uint32_t n = corners->n == 4 ? 6 : 3;
    struct vec2 *uvs = arena_zalloc(&l->scene->arena, n, sizeof *uvs);
    for (uint32_t i = 0; i < n; i++) {
        const struct vec3 *p = &corners->points[order[i]];
        uvs[i] = (struct vec2){p->x, p->y};
    }
    return uvs;
}

/* Spheres and cylinders have their own. */
static const struct vec2 *surface_uvs(struct lowering *l, const struct desc_object *o,
                                      const struct desc_prop *why)
{
    if (o->kind == KIND_TRIANGLE)
        return corner_uvs(l, desc_get(o, PROP_TRIANGLE_UVS));
    if (o->kind == KIND_QUAD)
        return corner_uvs(l, desc_get(o, PROP_QUAD_UVS));
    return o->kind == KIND_MESH ? lower_mesh_uvs(l, o, why) : NULL;
}

/* The property that asks for texture coordinates, or NULL. */
static const struct desc_prop *wants_uvs(const struct desc_object *o)
{
    const struct desc_prop *map = desc_find(o, PROP_NORMAL_MAP);
    return map ? map : desc_find(desc_get(o, PROP_MATERIAL)->object, PROP_TEXTURE);
}

void lower_surface(struct lowering *l, const struct desc_object *o)
{
    const struct desc_value *map = desc_get(o, PROP_NORMAL_MAP);
    struct geometry *g = &l->scene->geometry;
    struct surface s = {
        .kind = shapes[o->kind].surface,
        .material = lower_material(l, desc_get(o, PROP_MATERIAL)->object),
        .first_prim = (uint32_t)g->prims.n,
        .normal_map = lower_texture(l, map ? map->object : NULL),
        .uv = uv_map_of(o),
        .span = o->span,
    };
    if (!lower_shape(l, o, g, (uint32_t)l->scene->surfaces.n, &s.first_vertex))
        return;
    s.prim_count = (uint32_t)g->prims.n - s.first_prim;
    const struct desc_prop *why = wants_uvs(o);
    s.needs_uv = why != NULL;
    if (why)
        s.uvs = surface_uvs(l, o, why);
    if (o->kind == KIND_MESH) {
        s.flip = desc_number(o, PROP_FLIP_NORMALS) != 0;
        if (desc_number(o, PROP_SMOOTH) > 0)
            lower_mesh_normals(l, o, &s);
    }
    vec_push(&l->scene->surfaces, s);
    if (o->kind == KIND_MESH && desc_get(o, PROP_SHOW_NORMALS))
        lower_normal_cylinders(l, o, &s);
}
