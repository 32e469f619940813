#include "config.h"

#include "convert/compare.h"

#include "base/buffer.h"

#include <stddef.h>
#include <stdio.h>

/* The thing of both scenes that is being compared. */
struct subject {
    struct comparison *out;
    size_t most;
    const struct scene *a, *b;
    char name[80];                            /* "surface 3 (sphere)" */
    const struct geometry *equal_a, *equal_b; /* shapes of instances that were compared */
    struct span at_a, at_b;
};

/* The values are static, or in an arena that lives as long as the result. */
static void report(struct subject *s, const char *what, const char *a, const char *b)
{
    struct arena *arena = &s->out->arena;
    if (s->out->count++ < s->most)
        vec_push(&s->out->found,
                 (struct scene_difference){
                     arena_printf(arena, "%s%s%s", s->name, *what ? ": " : "", what),
                     arena_copy(arena, a, strlen(a)), arena_copy(arena, b, strlen(b)), s->at_a,
                     s->at_b});
}

/* ---- numbers ---- */

static const char *print_numbers(struct arena *arena, const double *x, unsigned n)
{
    struct buffer text = {0};
    for (unsigned i = 0; i < n; i++) {
        buffer_puts(&text, i ? ", " : n > 1 ? "(" : "");
        buffer_number(&text, x[i]);
    }
    buffer_puts(&text, n > 1 ? ")" : "");
    const char *kept = arena_copy(arena, text.at, text.n);
    buffer_free(&text);
    return kept;
}

static void compare_numbers(struct subject *s, const char *what, const double *a, const double *b,
                            unsigned n)
{
    if (memcmp(a, b, n * sizeof *a) != 0)
        report(s, what, print_numbers(&s->out->arena, a, n), print_numbers(&s->out->arena, b, n));
}

static void compare_counts(struct subject *s, const char *what, size_t a, size_t b)
{
    struct arena *arena = &s->out->arena;
    if (a != b)
        report(s, what, arena_printf(arena, "%zu", a), arena_printf(arena, "%zu", b));
}

static void compare_words(struct subject *s, const char *what, const char *a, const char *b)
{
    if (strcmp(a, b) != 0)
        report(s, what, a, b);
}

/* ---- tables of fields ---- */

enum field_type { FIELD_NUMBER = 1, FIELD_PAIR = 2, FIELD_VECTOR = 3, FIELD_FLAG, FIELD_WHOLE };

struct field {
    const char *name;
    size_t offset;
    enum field_type type;
};

static const struct field scene_fields[] = {
    {"background", offsetof(struct scene, background), FIELD_VECTOR},
    {"ambient", offsetof(struct scene, ambient), FIELD_VECTOR},
    {"depth", offsetof(struct scene, depth), FIELD_WHOLE},
    {"samples", offsetof(struct scene, grid), FIELD_WHOLE},
    {"encoding linear", offsetof(struct scene, linear), FIELD_FLAG},
    {0},
};

static const struct field camera_fields[] = {
    {"eye", offsetof(struct camera, origin), FIELD_VECTOR},
    {"back", offsetof(struct camera, back), FIELD_VECTOR},
    {"up", offsetof(struct camera, up), FIELD_VECTOR},
    {"yfov", offsetof(struct camera, yfov), FIELD_NUMBER},
    {"view height", offsetof(struct camera, view_height), FIELD_NUMBER},
    {"width", offsetof(struct camera, width), FIELD_WHOLE},
    {"height", offsetof(struct camera, height), FIELD_WHOLE},
    {"compat", offsetof(struct camera, compatible), FIELD_FLAG},
    {0},
};

static const struct field uv_fields[] = {
    {"uv_offset", offsetof(struct uv_map, offset), FIELD_PAIR},
    {"uv_scale", offsetof(struct uv_map, scale), FIELD_PAIR},
    {0},
};

static const struct field material_fields[] = {
    {"diffuse", offsetof(struct material, diffuse), FIELD_VECTOR},
    {"specular", offsetof(struct material, specular), FIELD_VECTOR},
    {"exponent", offsetof(struct material, exponent), FIELD_NUMBER},
    {"reflection", offsetof(struct material, reflection), FIELD_VECTOR},
    {"refraction", offsetof(struct material, refraction), FIELD_VECTOR},
    {"ior", offsetof(struct material, ior), FIELD_NUMBER},
    {0},
};

static const struct field light_fields[] = {
    {"position", offsetof(struct light, position), FIELD_VECTOR},
    {"intensity", offsetof(struct light, intensity), FIELD_VECTOR},
    {"falloff inverse_square", offsetof(struct light, inverse_square), FIELD_FLAG},
    {"samples", offsetof(struct light, grid), FIELD_WHOLE},
    {"growth", offsetof(struct light, growth), FIELD_NUMBER},
    {"both sides", offsetof(struct light, both_sides), FIELD_FLAG},
    {0},
};

static const struct field sphere_fields[] = {
    {"center", offsetof(struct sphere, center), FIELD_VECTOR},
    {"radius", offsetof(struct sphere, radius), FIELD_NUMBER},
    {0},
};

static const struct field cylinder_fields[] = {
    {"base", offsetof(struct cylinder, base), FIELD_VECTOR},
    {"axis", offsetof(struct cylinder, axis), FIELD_VECTOR},
    {"height", offsetof(struct cylinder, height), FIELD_NUMBER},
    {"radius", offsetof(struct cylinder, radius), FIELD_NUMBER},
    {0},
};

static void compare_fields(struct subject *s, const struct field *fields, const void *a,
                           const void *b)
{
    for (const struct field *f = fields; f->name; f++) {
        const void *x = (const char *)a + f->offset, *y = (const char *)b + f->offset;
        if (f->type == FIELD_FLAG)
            compare_words(s, f->name, *(const bool *)x ? "yes" : "no",
                          *(const bool *)y ? "yes" : "no");
        else if (f->type == FIELD_WHOLE)
            compare_counts(s, f->name, *(const uint32_t *)x, *(const uint32_t *)y);
        else
            compare_numbers(s, f->name, x, y, f->type);
    }
}

/* ---- what surfaces are made of ---- */

static const struct texture *texture_at(const struct scene *s, uint32_t number)
{
    return number == TEXTURE_NONE ? NULL : &s->textures.at[number];
}

static void compare_textures(struct subject *s, const char *what, uint32_t number_a,
                             uint32_t number_b)
{
    const struct texture *a = texture_at(s->a, number_a), *b = texture_at(s->b, number_b);
    char name[40];
    if (!a || !b) {
        compare_words(s, what, a ? "given" : "none", b ? "given" : "none");
        return;
    }
    snprintf(name, sizeof name, "%s: filter", what);
    compare_words(s, name, a->linear ? "linear" : "nearest", b->linear ? "linear" : "nearest");
    snprintf(name, sizeof name, "%s: pixels", what);
    compare_words(s, what, a->decode ? "decoded" : "plain", b->decode ? "decoded" : "plain");
    if (!image_equal(a->image, b->image))
        report(s, name, a->file, b->file);
}

static void compare_materials(struct subject *s, uint32_t number_a, uint32_t number_b)
{
    static const char *const kinds[] = {
        [MATERIAL_LAMBERT] = "lambert", [MATERIAL_PHONG] = "phong",
        [MATERIAL_SHINY] = "shiny",     [MATERIAL_METAL] = "metal",
        [MATERIAL_GLASS] = "glass",     [MATERIAL_EMISSIVE] = "emissive",
    };
    const struct material *a = &s->a->materials.at[number_a], *b = &s->b->materials.at[number_b];
    compare_words(s, "material", kinds[a->kind], kinds[b->kind]);
    compare_fields(s, material_fields, a, b);
    compare_textures(s, "texture", a->texture, b->texture);
    compare_fields(s, uv_fields, &a->uv, &b->uv);
}

static void compare_triangles(struct subject *s, const struct geometry *a, uint32_t i,
                              const struct geometry *b, uint32_t j)
{
    static const char *const names[] = {"vertex 1", "vertex 2", "vertex 3"};
    for (int k = 0; k < 3; k++)
        compare_numbers(s, names[k], &a->vertices.at[a->triangles.at[i].vertex[k]].x,
                        &b->vertices.at[b->triangles.at[j].vertex[k]].x, 3);
}

static void compare_instances(struct subject *s, const struct geometry *ga, uint32_t i,
                              const struct geometry *gb, uint32_t j);

static void compare_prims(struct subject *s, const struct geometry *a, uint32_t i,
                          const struct geometry *b, uint32_t j)
{
    static const char *const kinds[PRIM_KINDS] = {[PRIM_SPHERE] = "sphere",
                                                  [PRIM_CYLINDER] = "cylinder",
                                                  [PRIM_TRIANGLE] = "triangle",
                                                  [PRIM_INSTANCE] = "instance"};
    const struct prim *p = &a->prims.at[i], *q = &b->prims.at[j];
    if (p->kind != q->kind)
        report(s, "primitive", kinds[p->kind], kinds[q->kind]);
    else if (p->kind == PRIM_SPHERE)
        compare_fields(s, sphere_fields, &a->spheres.at[p->index], &b->spheres.at[q->index]);
    else if (p->kind == PRIM_CYLINDER)
        compare_fields(s, cylinder_fields, &a->cylinders.at[p->index], &b->cylinders.at[q->index]);
    else if (p->kind == PRIM_TRIANGLE)
        compare_triangles(s, a, p->index, b, q->index);
    else
        compare_instances(s, a, p->index, b, q->index);
}

/* ---- whole things ---- */

/* The subject's name followed by that of a part, when there are several. */
static size_t enter_part(struct subject *s, const char *what, size_t number, size_t parts)
{
    size_t end = strlen(s->name);
    if (parts > 1)
        snprintf(s->name + end, sizeof s->name - end, ": %s %zu", what, number + 1);
    return end;
}

/* The same primitives, or the first that differs. */
static void compare_all_prims(struct subject *s, const struct geometry *a, uint32_t i,
                              const struct geometry *b, uint32_t j, uint32_t n)
{
    size_t before = s->out->count;
    for (uint32_t k = 0; k < n && s->out->count == before; k++) {
        size_t end = enter_part(s, "primitive", k, n);
        compare_prims(s, a, i + k, b, j + k);
        s->name[end] = 0;
    }
}

/* The same map and shape. */
static void compare_instances(struct subject *s, const struct geometry *ga, uint32_t i,
                              const struct geometry *gb, uint32_t j)
{
    const struct instance *a = &ga->instances.at[i], *b = &gb->instances.at[j];
    const struct geometry *shapes_a = &ga->prototypes.at[a->prototype]->shapes;
    const struct geometry *shapes_b = &gb->prototypes.at[b->prototype]->shapes;
    compare_numbers(s, "place", a->to_world.m[0], b->to_world.m[0], 12);
    compare_words(s, "shape", a->only == PRIM_NONE ? "mesh" : "solid",
                  b->only == PRIM_NONE ? "mesh" : "solid");
    if ((a->only == PRIM_NONE) != (b->only == PRIM_NONE))
        return;
    if (a->only != PRIM_NONE) {
        compare_prims(s, shapes_a, a->only, shapes_b, b->only);
        return;
    }
    if (s->equal_a == shapes_a && s->equal_b == shapes_b)
        return;
    s->equal_a = shapes_a;
    s->equal_b = shapes_b;
    compare_counts(s, "primitives", shapes_a->prims.n, shapes_b->prims.n);
    if (shapes_a->prims.n == shapes_b->prims.n)
        compare_all_prims(s, shapes_a, 0, shapes_b, 0, (uint32_t)shapes_a->prims.n);
}

static const struct vec3 *corner_normal(const struct surface *surface,
                                        const struct surface_faces *f, uint32_t n, int corner)
{
    const struct geometry *g = f->geometry;
    const struct prim *p = &g->prims.at[f->first_prim + n];
    if (surface->normal_corners)
        return &surface->normals[surface->normal_corners[n].at[corner]];
    return &surface->normals[g->triangles.at[p->index].vertex[corner] - f->first_vertex];
}

/* What shading interpolates, or the first face where it differs. */
static void compare_corners(struct subject *s, const struct surface *a, const struct surface *b)
{
    struct surface_faces f = surface_faces(s->a, a), g = surface_faces(s->b, b);
    size_t before = s->out->count;
    if (f.n != g.n || (a->normals == NULL && a->uvs == NULL))
        return;
    for (uint32_t n = 0; n < f.n && s->out->count == before; n++) {
        size_t end = enter_part(s, "primitive", n, f.n);
        for (int k = 0; k < 3 && a->normals && b->normals; k++)
            compare_numbers(s, "normal", &corner_normal(a, &f, n, k)->x,
                            &corner_normal(b, &g, n, k)->x, 3);
        for (int k = 0; k < 3 && a->uvs && b->uvs; k++)
            compare_numbers(s, "uv", &a->uvs[3 * n + k].x, &b->uvs[3 * n + k].x, 2);
        s->name[end] = 0;
    }
}

static void compare_surfaces(struct subject *s, const struct surface *a, const struct surface *b)
{
    compare_materials(s, a->material, b->material);
    compare_textures(s, "normal_map", a->normal_map, b->normal_map);
    if (a->normal_map != TEXTURE_NONE)
        compare_fields(s, uv_fields, &a->uv, &b->uv);
    compare_words(s, "flip_normals", a->flip ? "yes" : "no", b->flip ? "yes" : "no");
    compare_words(s, "smooth", a->normals ? "yes" : "no", b->normals ? "yes" : "no");
    compare_words(s, "uvs", a->uvs ? "given" : "none", b->uvs ? "given" : "none");
    compare_counts(s, "primitives", a->prim_count, b->prim_count);
    if (a->prim_count != b->prim_count)
        return;
    compare_all_prims(s, &s->a->geometry, a->first_prim, &s->b->geometry, b->first_prim,
                      a->prim_count);
    compare_corners(s, a, b);
}

/* The same sample grids, or the first point that differs. */
static void compare_points(struct subject *s, const struct light *a, const struct light *b)
{
    size_t before = s->out->count;
    compare_counts(s, "sample points", a->points.n, b->points.n);
    compare_counts(s, "samples", a->samples.n, b->samples.n);
    for (size_t i = 0; i < a->samples.n && s->out->count == before; i++) {
        const struct light_sample *p = &a->samples.at[i], *q = &b->samples.at[i];
        compare_numbers(s, "sample", &p->position.x, &q->position.x, 3);
        compare_numbers(s, "normal of a sample", &p->normal.x, &q->normal.x, 3);
        compare_numbers(s, "share of a sample", &p->share, &q->share, 1);
    }
    for (size_t i = 0; i < a->points.n && s->out->count == before; i++) {
        const struct light_point *p = &a->points.at[i], *q = &b->points.at[i];
        compare_numbers(s, "sample point", &p->position.x, &q->position.x, 3);
        compare_counts(s, "weight of a sample point", p->count, q->count);
    }
}

static void compare_lights(struct subject *s, const struct light *a, const struct light *b)
{
    compare_fields(s, light_fields, a, b);
    compare_counts(s, "primitives", a->object.prims.n, b->object.prims.n);
    if (a->object.prims.n == b->object.prims.n)
        compare_all_prims(s, &a->object, 0, &b->object, 0, (uint32_t)a->object.prims.n);
    compare_points(s, a, b);
}

static void compare_all_surfaces(struct subject *s)
{
    static const char *const kinds[] = {
        [SURFACE_SPHERE] = "sphere",     [SURFACE_CYLINDER] = "cylinder",
        [SURFACE_TRIANGLE] = "triangle", [SURFACE_QUAD] = "quad",
        [SURFACE_MESH] = "mesh",
    };
    for (size_t i = 0; i < s->a->surfaces.n && i < s->b->surfaces.n; i++) {
        const struct surface *a = &s->a->surfaces.at[i], *b = &s->b->surfaces.at[i];
        s->at_a = a->span;
        s->at_b = b->span;
        snprintf(s->name, sizeof s->name, "surface %zu", i + 1);
        if (a->kind != b->kind) {
            report(s, "", kinds[a->kind], kinds[b->kind]);
            continue;
        }
        snprintf(s->name, sizeof s->name, "surface %zu (%s)", i + 1, kinds[a->kind]);
        compare_surfaces(s, a, b);
    }
}

static void compare_all_lights(struct subject *s)
{
    static const char *const kinds[] = {
        [LIGHT_POINT] = "point", [LIGHT_AREA] = "area", [LIGHT_SUN] = "sun"};
    for (size_t i = 0; i < s->a->lights.n && i < s->b->lights.n; i++) {
        const struct light *a = &s->a->lights.at[i], *b = &s->b->lights.at[i];
        s->at_a = a->span;
        s->at_b = b->span;
        snprintf(s->name, sizeof s->name, "light %zu", i + 1);
        if (a->kind != b->kind)
            report(s, "", kinds[a->kind], kinds[b->kind]);
        else
            compare_lights(s, a, b);
    }
}

bool compare_scenes(const struct scene *a, const struct scene *b, size_t most,
                    struct comparison *out)
{
    static const char *const models[] = {[SCENE_CLASSIC] = "classic", [SCENE_MODERN] = "modern"};
    struct subject s = {.out = out, .most = most, .a = a, .b = b, .name = "camera"};
    compare_fields(&s, camera_fields, &a->camera, &b->camera);
    snprintf(s.name, sizeof s.name, "scene");
    compare_words(&s, "model", models[a->model], models[b->model]);
    compare_fields(&s, scene_fields, a, b);
    compare_counts(&s, "lights", a->lights.n, b->lights.n);
    compare_counts(&s, "surfaces", a->surfaces.n, b->surfaces.n);
    compare_all_lights(&s);
    compare_all_surfaces(&s);
    return out->count == 0;
}

void comparison_free(struct comparison *c)
{
    vec_free(&c->found);
    arena_free(&c->arena);
}
