/* Surfaces and their materials. */
#include "config.h"

#include "lower/lowering.h"

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
        .texture = lower_texture(l, texture ? texture->object : NULL, false),
        .uv = uv_map_of(o),
    };
    if (m.kind == MATERIAL_METAL) { /* a metal tints what it mirrors */
        m.specular = vec3_mul(m.specular, m.diffuse);
        m.reflection = l->scene->model == SCENE_MODERN ? vec3_mul(m.diffuse, m.reflection)
                                                       : vec3_scale(m.diffuse, m.reflection.x);
    }
    uint32_t number = (uint32_t)l->scene->materials.n;
    vec_push(&l->scene->materials, m);
    return l->material_of[o->number] = number;
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

/* Spheres and cylinders have their own; meshes see to theirs. */
static const struct vec2 *surface_uvs(struct lowering *l, const struct desc_object *o)
{
    if (o->kind == KIND_TRIANGLE)
        return corner_uvs(l, desc_get(o, PROP_TRIANGLE_UVS));
    return o->kind == KIND_QUAD ? corner_uvs(l, desc_get(o, PROP_QUAD_UVS)) : NULL;
}

const struct desc_prop *lower_wants_uvs(const struct desc_object *o)
{
    const struct desc_prop *map = desc_find(o, PROP_NORMAL_MAP);
    const struct desc_value *material = desc_get(o, PROP_MATERIAL);
    return map || !material ? map : desc_find(material->object, PROP_TEXTURE);
}

/* Flat surfaces keep to the side their normal is on: mirrored, their corners run the other way
 * round. */
static bool is_turned_over(const struct desc_object *o)
{
    bool flat = o->kind == KIND_TRIANGLE || o->kind == KIND_QUAD;
    return flat && o->place && affine_determinant(o->place) < 0;
}

static enum surface_kind surface_kind_of(enum schema_kind kind)
{
    static const uint8_t kinds[SCHEMA_KINDS] = {
        [KIND_SPHERE] = SURFACE_SPHERE,     [KIND_CYLINDER] = SURFACE_CYLINDER,
        [KIND_TRIANGLE] = SURFACE_TRIANGLE, [KIND_QUAD] = SURFACE_QUAD,
        [KIND_MESH] = SURFACE_MESH,
    };
    return kinds[kind];
}

void lower_surface(struct lowering *l, const struct desc_object *o)
{
    const struct desc_value *map = desc_get(o, PROP_NORMAL_MAP);
    struct geometry *g = &l->scene->geometry;
    struct surface s = {
        .kind = surface_kind_of(o->kind),
        .material = lower_material(l, desc_get(o, PROP_MATERIAL)->object),
        .first_prim = (uint32_t)g->prims.n,
        .first_vertex = (uint32_t)g->vertices.n,
        .normal_map = lower_texture(l, map ? map->object : NULL, true),
        .uv = uv_map_of(o),
        .needs_uv = lower_wants_uvs(o) != NULL,
        .flip = is_turned_over(o),
        .span = o->span,
    };
    bool mesh = o->kind == KIND_MESH;
    if (mesh ? !lower_mesh(l, o, &s) : !lower_shape(l, o, g, (uint32_t)l->scene->surfaces.n))
        return;
    s.prim_count = (uint32_t)g->prims.n - s.first_prim;
    if (s.needs_uv && !mesh)
        s.uvs = surface_uvs(l, o);
    vec_push(&l->scene->surfaces, s);
    if (mesh && desc_get(o, PROP_SHOW_NORMALS))
        lower_normal_cylinders(l, o, &s);
}
