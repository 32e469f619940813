/* The lowered scene as JSON, in the layout that wrt(1) documents. */
#include "config.h"

#include "base/file.h"
#include "convert/exporting.h"

#include <stdlib.h>

enum { LAYOUT_VERSION = 1 };

/* A document under construction: what was written last says whether a comma is due. */
struct json {
    struct buffer *out;
    bool comma;
};

static void separate(struct json *j)
{
    buffer_puts(j->out, j->comma ? "," : "");
    j->comma = true;
}

static void add_string(struct json *j, struct str text)
{
    separate(j);
    buffer_puts(j->out, "\"");
    for (size_t i = 0; i < text.n; i++) {
        unsigned char c = (unsigned char)text.at[i];
        if (c < 0x20 || c == 0x7f)
            buffer_printf(j->out, "\\u%04x", c);
        else
            buffer_printf(j->out, c == '"' || c == '\\' ? "\\%c" : "%c", c);
    }
    buffer_puts(j->out, "\"");
}

static void add_key(struct json *j, const char *key)
{
    separate(j);
    buffer_printf(j->out, "\"%s\":", key);
    j->comma = false;
}

static void add_word(struct json *j, const char *key, const char *word)
{
    add_key(j, key);
    add_string(j, str_of(word));
}

static void add_number(struct json *j, double x)
{
    separate(j);
    buffer_number(j->out, x);
}

static void add_field(struct json *j, const char *key, double x)
{
    add_key(j, key);
    add_number(j, x);
}

static void open_with(struct json *j, const char *bracket)
{
    separate(j);
    buffer_puts(j->out, bracket);
    j->comma = false;
}

static void close_with(struct json *j, const char *bracket)
{
    buffer_puts(j->out, bracket);
    j->comma = true;
}

static void add_vec3(struct json *j, struct vec3 v)
{
    separate(j);
    buffer_puts(j->out, "[");
    export_vec3(j->out, v, ",");
    buffer_puts(j->out, "]");
}

static void add_vec2(struct json *j, struct vec2 v)
{
    open_with(j, "[");
    add_number(j, v.x);
    add_number(j, v.y);
    close_with(j, "]");
}

static void add_vector(struct json *j, const char *key, struct vec3 v)
{
    add_key(j, key);
    add_vec3(j, v);
}

/* An item of a list at the top begins a line. */
static void open_item(struct json *j)
{
    separate(j);
    buffer_puts(j->out, "\n{");
    j->comma = false;
}

static void open_list(struct json *j, const char *key)
{
    separate(j);
    buffer_printf(j->out, "\n\"%s\":[", key);
    j->comma = false;
}

/* ---- parts ----------------------------------------------------------------------------------- */

static void add_place(struct json *j, const struct srcmap *sources, struct span span)
{
    struct location at = srcmap_locate(sources, span.begin);
    if (!at.source)
        return;
    add_word(j, "file", at.source->name);
    add_field(j, "line", at.line);
    add_field(j, "column", at.column);
}

static void add_camera(struct json *j, const struct camera *c)
{
    open_with(j, "{");
    add_vector(j, "eye", c->origin);
    add_vector(j, "back", c->back);
    add_vector(j, "up", c->up);
    if (!c->modern)
        add_field(j, "yfov", c->yfov);
    else if (c->yfov > 0)
        add_field(j, "fov", c->yfov);
    else
        add_field(j, "height", c->view_height);
    add_key(j, "resolution");
    add_vec2(j, (struct vec2){c->width, c->height});
    if (!c->modern)
        add_field(j, "compat", c->compatible);
    close_with(j, "}");
}

static void add_settings(struct json *j, const struct scene *s)
{
    add_key(j, "settings");
    open_with(j, "{");
    add_vector(j, "background", s->background);
    add_vector(j, "ambient", s->ambient);
    add_field(j, "depth", s->depth);
    add_field(j, "samples", s->grid);
    add_word(j, "encoding", s->linear ? "linear" : "srgb");
    close_with(j, "}");
}

static void add_texture(struct json *j, const struct texture *t, const char *path)
{
    char *file = file_relative(path, t->file);
    open_item(j);
    add_word(j, "file", file);
    free(file);
    add_word(j, "filter", t->linear ? "linear" : "nearest");
    add_key(j, "size");
    add_vec2(j, (struct vec2){t->image->width, t->image->height});
    close_with(j, "}");
}

static void add_uv_map(struct json *j, const struct uv_map *m)
{
    add_key(j, "uv_offset");
    add_vec2(j, m->offset);
    add_key(j, "uv_scale");
    add_vec2(j, m->scale);
}

static void add_material(struct json *j, const struct material *m)
{
    static const char *const kinds[] = {
        [MATERIAL_LAMBERT] = "lambert", [MATERIAL_PHONG] = "phong",
        [MATERIAL_SHINY] = "shiny",     [MATERIAL_METAL] = "metal",
        [MATERIAL_GLASS] = "glass",     [MATERIAL_EMISSIVE] = "emissive",
    };
    bool glossy = m->kind != MATERIAL_LAMBERT && m->kind != MATERIAL_EMISSIVE;
    open_item(j);
    add_word(j, "kind", kinds[m->kind]);
    add_vector(j, "diffuse", m->diffuse);
    if (glossy) {
        add_vector(j, "specular", m->specular);
        add_field(j, "exponent", m->exponent);
    }
    if (glossy && m->kind != MATERIAL_PHONG)
        add_vector(j, "reflection", m->reflection);
    if (m->kind == MATERIAL_GLASS) {
        add_vector(j, "refraction", m->refraction);
        add_field(j, "ior", m->ior);
    }
    if (m->texture != TEXTURE_NONE) {
        add_field(j, "texture", m->texture);
        add_uv_map(j, &m->uv);
    }
    close_with(j, "}");
}

/* Classic: where the points of the grid are, and how many there. */
static void add_points_of_light(struct json *j, const struct light *l)
{
    add_key(j, "points");
    open_with(j, "[");
    for (size_t i = 0; i < l->points.n; i++) {
        open_with(j, "[");
        export_vec3(j->out, l->points.at[i].position, ",");
        buffer_printf(j->out, ",%u", l->points.at[i].count);
        close_with(j, "]");
    }
    close_with(j, "]");
}

/* Modern: place, normal and share. */
static void add_samples_of_light(struct json *j, const struct light *l)
{
    add_field(j, "both_sides", l->both_sides);
    add_key(j, "samples");
    open_with(j, "[");
    for (size_t i = 0; i < l->samples.n; i++) {
        open_with(j, "[");
        export_vec3(j->out, l->samples.at[i].position, ",");
        buffer_puts(j->out, ",");
        export_vec3(j->out, l->samples.at[i].normal, ",");
        buffer_puts(j->out, ",");
        buffer_number(j->out, l->samples.at[i].share);
        close_with(j, "]");
    }
    close_with(j, "]");
}

static void add_light(struct json *j, const struct light *l, enum scene_model model,
                      const struct srcmap *sources)
{
    static const char *const kinds[] = {
        [LIGHT_POINT] = "point", [LIGHT_AREA] = "area", [LIGHT_SUN] = "sun"};
    bool sun = l->kind == LIGHT_SUN, sampled = l->kind == LIGHT_AREA && model == SCENE_MODERN;
    open_item(j);
    add_word(j, "kind", kinds[l->kind]);
    if (!sampled)
        add_vector(j, sun ? "direction" : "position", sun ? vec3_neg(l->position) : l->position);
    add_vector(j, "intensity", l->intensity);
    if (!sun)
        add_word(j, "falloff", l->inverse_square ? "inverse_square" : "none");
    if (sampled)
        add_samples_of_light(j, l);
    else if (l->kind == LIGHT_AREA)
        add_points_of_light(j, l);
    add_place(j, sources, l->span);
    close_with(j, "}");
}

/* ---- surfaces -------------------------------------------------------------------------------- */

/* Twelve numbers, row by row. */
static void add_map(struct json *j, const struct affine *a)
{
    add_key(j, "place");
    open_with(j, "[");
    for (int i = 0; i < 12; i++) {
        separate(j);
        buffer_number(j->out, a->m[i / 4][i % 4]);
    }
    close_with(j, "]");
}

static void add_round(struct json *j, const struct scene *scene, enum surface_kind kind,
                      uint32_t prim)
{
    open_with(j, "{");
    if (kind == SURFACE_SPHERE) {
        const struct sphere *s = export_sphere(scene, prim);
        add_vector(j, "center", s->center);
        add_field(j, "radius", s->radius);
    } else {
        const struct cylinder *c = export_cylinder(scene, prim);
        add_vector(j, "base", c->base);
        add_vector(j, "axis", c->axis);
        add_field(j, "height", c->height);
        add_field(j, "radius", c->radius);
    }
    if (export_place(scene, prim))
        add_map(j, export_place(scene, prim));
    close_with(j, "}");
}

static void add_points(struct json *j, const char *key, const struct vec3 *v, size_t n)
{
    add_key(j, key);
    open_with(j, "[");
    for (size_t i = 0; i < n; i++)
        add_vec3(j, v[i]);
    close_with(j, "]");
}

static void add_corners(struct json *j, struct triangle_corners c)
{
    separate(j);
    buffer_printf(j->out, "[%u,%u,%u]", c.at[0], c.at[1], c.at[2]);
}

static void add_facets(struct json *j, const struct scene *scene, const struct surface *s)
{
    struct facets f = export_facets(scene, s);
    add_points(j, "vertices", f.points, f.point_count);
    add_key(j, "triangles");
    open_with(j, "[");
    for (size_t i = 0; i < f.n; i++)
        add_corners(j, export_corners(&f, i));
    close_with(j, "]");
    if (s->normals)
        add_points(j, "normals", s->normals, f.normal_count);
    if (s->normal_corners) {
        add_key(j, "normal_triangles");
        open_with(j, "[");
        for (size_t i = 0; i < f.n; i++)
            add_corners(j, s->normal_corners[i]);
        close_with(j, "]");
    }
    if (!s->uvs)
        return;
    add_key(j, "uvs");
    open_with(j, "[");
    for (size_t i = 0; i < 3 * f.n; i++)
        add_vec2(j, s->uvs[i]);
    close_with(j, "]");
}

static void add_surface(struct json *j, const struct scene *scene, const struct surface *s,
                        const struct srcmap *sources)
{
    static const char *const kinds[] = {
        [SURFACE_SPHERE] = "sphere",     [SURFACE_CYLINDER] = "cylinder",
        [SURFACE_TRIANGLE] = "triangle", [SURFACE_QUAD] = "quad",
        [SURFACE_MESH] = "mesh",
    };
    open_item(j);
    add_word(j, "kind", kinds[s->kind]);
    add_field(j, "material", s->material);
    if (s->normal_map != TEXTURE_NONE) {
        add_field(j, "normal_map", s->normal_map);
        add_uv_map(j, &s->uv);
    }
    if (s->flip)
        add_field(j, "flip_normals", 1);
    if (s->kind == SURFACE_SPHERE || s->kind == SURFACE_CYLINDER) {
        add_key(j, "shapes");
        open_with(j, "[");
        for (uint32_t i = 0; i < s->prim_count; i++)
            add_round(j, scene, s->kind, s->first_prim + i);
        close_with(j, "]");
    } else {
        add_facets(j, scene, s);
    }
    add_place(j, sources, s->span);
    close_with(j, "}");
}

void export_json(const struct scene *scene, const char *path, struct buffer *out, struct diag *diag)
{
    struct json j = {out, false};
    open_with(&j, "{");
    add_word(&j, "format", "wrt scene");
    add_field(&j, "version", LAYOUT_VERSION);
    add_word(&j, "model", scene->model == SCENE_MODERN ? "modern" : "classic");
    add_key(&j, "camera");
    add_camera(&j, &scene->camera);
    if (scene->model == SCENE_MODERN)
        add_settings(&j, scene);
    open_list(&j, "textures");
    for (size_t i = 0; i < scene->textures.n; i++)
        add_texture(&j, &scene->textures.at[i], path);
    close_with(&j, "]");
    open_list(&j, "materials");
    for (size_t i = 0; i < scene->materials.n; i++)
        add_material(&j, &scene->materials.at[i]);
    close_with(&j, "]");
    open_list(&j, "lights");
    for (size_t i = 0; i < scene->lights.n; i++)
        add_light(&j, &scene->lights.at[i], scene->model, diag->sources);
    close_with(&j, "]");
    open_list(&j, "surfaces");
    for (size_t i = 0; i < scene->surfaces.n; i++)
        add_surface(&j, scene, &scene->surfaces.at[i], diag->sources);
    close_with(&j, "]");
    buffer_puts(out, "}\n");
}
