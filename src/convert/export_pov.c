/* A scene for POV-Ray 3.7.
 *
 * Classic's arithmetic is that of the picture's bytes, hence assumed_gamma srgb: POV-Ray then works
 * on encoded values, too, and writes them as they are.  Reflection and refraction are scaled by the
 * sum of the lights, as classic does.  Modern's arithmetic is POV-Ray's own.  Glass is made twice,
 * once to be seen and once, unseen, for its full shadow. */
#include "config.h"

#include "convert/pov.h"

void pov_add_vector(struct buffer *out, struct vec3 v)
{
    buffer_puts(out, "<");
    export_vec3(out, v, ",");
    buffer_puts(out, ">");
}

void pov_add_field(struct buffer *out, const char *name, double x)
{
    buffer_printf(out, " %s ", name);
    buffer_number(out, x);
}

/* ---- camera and lights ----------------------------------------------------------------------- */

static void add_camera(struct exporting *e)
{
    struct export_view view = export_view(e->scene);
    buffer_printf(e->out, "camera {\n  %s\n  location ",
                  view.parallel ? "orthographic" : "perspective");
    pov_add_vector(e->out, view.eye);
    buffer_puts(e->out, "\n  direction ");
    pov_add_vector(e->out, view.ahead);
    buffer_puts(e->out, "\n  right ");
    pov_add_vector(e->out, vec3_scale(view.across, 2));
    buffer_puts(e->out, "\n  up ");
    pov_add_vector(e->out, vec3_scale(view.upwards, 2));
    buffer_puts(e->out, "\n}\n");
}

static void add_area(struct exporting *e, const struct light *l, const struct export_area *area)
{
    size_t points = 0;
    for (size_t i = 0; i < l->points.n; i++)
        points += l->points.at[i].count;
    int along = e->scene->model == SCENE_CLASSIC ? (int)lround(cbrt((double)points)) : (int)l->grid;
    buffer_puts(e->out, " area_light ");
    pov_add_vector(e->out, area->sides[0]);
    buffer_puts(e->out, ", ");
    pov_add_vector(e->out, area->sides[1]);
    buffer_printf(e->out, ", %d, %d%s", along, along,
                  l->object.spheres.n ? " circular orient" : "");
}

/* The brightness of a light that falls off is 2 / (1 + (d / distance)^2) times its colour. */
#define FADE_DISTANCE 1e-3

static void open_light(struct exporting *e, const struct light *l, struct vec3 position)
{
    struct vec3 colour = l->intensity;
    if (l->inverse_square)
        colour = vec3_scale(colour, 0.5 / (FADE_DISTANCE * FADE_DISTANCE));
    buffer_puts(e->out, "light_source { ");
    pov_add_vector(e->out, position);
    buffer_puts(e->out, ", rgb ");
    pov_add_vector(e->out, colour);
    if (l->inverse_square) {
        pov_add_field(e->out, "fade_distance", FADE_DISTANCE);
        pov_add_field(e->out, "fade_power", 2);
    }
}

/* Outside of everything: POV-Ray's parallel light begins at its place. */
static void add_sun(struct exporting *e, const struct light *l)
{
    double reach;
    struct vec3 middle = export_middle(e->scene, &reach);
    open_light(e, l, vec3_mad(middle, reach + 1, l->position));
    buffer_puts(e->out, " parallel point_at ");
    pov_add_vector(e->out, middle);
    buffer_puts(e->out, " }\n");
}

/* A modern light with two sides: a spot of 90 degrees for each has the cosine. */
static void add_two_sided(struct exporting *e, const struct light *l,
                          const struct export_area *area)
{
    struct vec3 normal = vec3_normalize(vec3_cross(area->sides[0], area->sides[1]));
    for (int side = -1; side <= 1; side += 2) {
        open_light(e, l, area->middle);
        buffer_puts(e->out, " spotlight radius 90 falloff 90 tightness 1 point_at ");
        pov_add_vector(e->out, vec3_mad(area->middle, side, normal));
        add_area(e, l, area);
        buffer_puts(e->out, " }\n");
    }
}

static void add_light(struct exporting *e, const struct light *l)
{
    struct export_area area = export_area(l);
    if (l->kind == LIGHT_SUN) {
        add_sun(e, l);
        return;
    }
    if (l->kind == LIGHT_AREA)
        export_lose(e, LOSS_AREA_GRID, l->span);
    if (l->both_sides) {
        add_two_sided(e, l, &area);
        return;
    }
    open_light(e, l, area.middle);
    if (l->kind == LIGHT_AREA)
        add_area(e, l, &area);
    buffer_puts(e->out, " }\n");
}

static void note_losses(struct exporting *e, const struct surface *s, const struct material *m)
{
    bool bounces = !vec3_is_zero(m->reflection) || !vec3_is_zero(m->refraction);
    if (s->normal_map != TEXTURE_NONE)
        export_lose(e, LOSS_NORMAL_MAP, s->span);
    if (!vec3_is_even(m->specular) && !export_is_tint(m->specular, m->diffuse))
        export_lose(e, LOSS_HIGHLIGHT, s->span);
    if (!vec3_is_even(m->refraction))
        export_lose(e, LOSS_REFRACTION, s->span);
    if (bounces && e->falls_off && e->scene->model == SCENE_CLASSIC)
        export_lose(e, LOSS_FALLOFF, s->span);
}

/* ---- surfaces: each shape up to where its material stands ------------------------------------ */

static void open_sphere(struct buffer *out, const struct sphere *s)
{
    buffer_puts(out, "sphere { ");
    pov_add_vector(out, s->center);
    buffer_puts(out, ", ");
    buffer_number(out, s->radius);
}

static void open_cylinder(struct buffer *out, const struct cylinder *c)
{
    buffer_puts(out, "cylinder { ");
    pov_add_vector(out, c->base);
    buffer_puts(out, ", ");
    pov_add_vector(out, vec3_mad(c->base, c->height, c->axis));
    buffer_puts(out, ", ");
    buffer_number(out, c->radius);
}

static void add_vertices(struct buffer *out, const struct vec3 *v, size_t n)
{
    buffer_printf(out, " vertex_vectors { %zu", n);
    for (size_t i = 0; i < n; i++) {
        buffer_puts(out, i % 4 ? "," : ",\n");
        pov_add_vector(out, v[i]);
    }
    buffer_puts(out, " }\n");
}

/* POV-Ray wants a direction even where normals cancel out. */
static void add_normals(struct buffer *out, const struct vec3 *v, size_t n)
{
    buffer_printf(out, " normal_vectors { %zu", n);
    for (size_t i = 0; i < n; i++) {
        buffer_puts(out, i % 4 ? "," : ",\n");
        pov_add_vector(out, vec3_is_zero(v[i]) ? vec3(0, 1, 0) : v[i]);
    }
    buffer_puts(out, " }\n");
}

static void add_uvs(struct buffer *out, const struct vec2 *uv, size_t n)
{
    buffer_printf(out, " uv_vectors { %zu", n);
    for (size_t i = 0; i < n; i++) {
        buffer_puts(out, i % 6 ? ",<" : ",\n<");
        buffer_number(out, uv[i].x);
        buffer_puts(out, ",");
        buffer_number(out, uv[i].y);
        buffer_puts(out, ">");
    }
    buffer_puts(out, " }\n");
}

enum face_part { FACE_POINTS, FACE_NORMALS, FACE_UVS };

/* What the faces are made of; of texture coordinates each has its own three. */
static void add_faces(struct buffer *out, const struct facets *f, const struct surface *s,
                      enum face_part what)
{
    static const char *const names[] = {"face_indices", "normal_indices", "uv_indices"};
    buffer_printf(out, " %s { %zu", names[what], f->solid);
    for (size_t i = 0, k = 0; i < f->n; i++) {
        struct triangle_corners c = {
            {(uint32_t)(3 * i), (uint32_t)(3 * i + 1), (uint32_t)(3 * i + 2)}};
        if (vec3_is_zero(f->at[i].normal))
            continue;
        if (what == FACE_POINTS)
            c = export_corners(f, i);
        else if (what == FACE_NORMALS)
            c = export_normal_corners(f, s, i);
        buffer_printf(out, "%s<%u,%u,%u>", k++ % 6 ? "," : ",\n", c.at[0], c.at[1], c.at[2]);
    }
    buffer_puts(out, " }\n");
}

static void open_facets(struct exporting *e, const struct surface *s)
{
    struct facets f = export_facets(e->scene, s);
    buffer_puts(e->out, "mesh2 {\n");
    add_vertices(e->out, f.points, f.point_count);
    if (s->normals)
        add_normals(e->out, s->normals, f.normal_count);
    if (s->uvs)
        add_uvs(e->out, s->uvs, 3 * f.n);
    add_faces(e->out, &f, s, FACE_POINTS);
    if (s->normal_corners)
        add_faces(e->out, &f, s, FACE_NORMALS);
    if (s->uvs)
        add_faces(e->out, &f, s, FACE_UVS);
}

static void open_shape(struct exporting *e, const struct surface *s, uint32_t prim)
{
    if (s->kind == SURFACE_SPHERE)
        open_sphere(e->out, export_sphere(e->scene, prim));
    else if (s->kind == SURFACE_CYLINDER)
        open_cylinder(e->out, export_cylinder(e->scene, prim));
    else
        open_facets(e, s);
}

/* Textures are placed with what they are on. */
static void add_place(struct buffer *out, const struct affine *place)
{
    if (!place)
        return;
    buffer_puts(out, " matrix <");
    for (int i = 0; i < 12; i++) {
        buffer_puts(out, i ? "," : "");
        buffer_number(out, place->m[i % 3][i / 3]);
    }
    buffer_puts(out, ">");
}

static void add_object(struct exporting *e, const struct surface *s, uint32_t prim)
{
    enum material_kind kind = e->scene->materials.at[s->material].kind;
    bool glass = kind == MATERIAL_GLASS;
    const struct affine *place = export_place(e->scene, prim);
    buffer_puts(e->out, glass ? "#declare Glass = " : "");
    open_shape(e, s, prim);
    buffer_puts(e->out, glass ? " }\nobject { Glass " : " ");
    pov_add_material_use(e, s, prim);
    add_place(e->out, place);
    if (glass) {
        buffer_puts(e->out, " no_shadow }\nobject { Glass no_image no_reflection");
        add_place(e->out, place);
        buffer_puts(e->out, " }\n");
        return;
    }
    buffer_puts(e->out, kind == MATERIAL_EMISSIVE ? " no_shadow }\n" : " }\n");
}

static void add_surface(struct exporting *e, const struct surface *s)
{
    bool round = s->kind == SURFACE_SPHERE || s->kind == SURFACE_CYLINDER;
    uint32_t objects = round ? s->prim_count : export_facets(e->scene, s).solid > 0;
    note_losses(e, s, &e->scene->materials.at[s->material]);
    for (uint32_t i = 0; i < objects; i++)
        add_object(e, s, s->first_prim + i);
}

/* ---- the file -------------------------------------------------------------------------------- */

static void add_head(struct exporting *e)
{
    const struct scene *s = e->scene;
    buffer_printf(e->out,
                  "// made by wrt: povray +W%u +H%u%s FILE.pov\n"
                  "#version 3.7;\n"
                  "global_settings { assumed_gamma %s max_trace_level %d }\n"
                  "#default { finish { ambient 0 diffuse 1 } }\n",
                  s->camera.width, s->camera.height, s->linear ? " File_Gamma=1" : "",
                  s->model == SCENE_CLASSIC ? "srgb" : "1", export_ray_depth(s));
    if (vec3_is_zero(s->background))
        return;
    buffer_puts(e->out, "background { rgb ");
    pov_add_vector(e->out, s->background);
    buffer_puts(e->out, " }\n");
}

void export_pov(const struct scene *scene, const char *path, struct buffer *out, struct diag *diag)
{
    struct exporting e;
    export_begin(&e, scene, path, out, diag);
    add_head(&e);
    add_camera(&e);
    for (size_t i = 0; i < scene->lights.n; i++)
        add_light(&e, &scene->lights.at[i]);
    pov_declare_materials(&e);
    for (size_t i = 0; i < scene->surfaces.n; i++)
        add_surface(&e, &scene->surfaces.at[i]);
    export_end(&e);
}
