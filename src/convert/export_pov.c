/* A scene for POV-Ray 3.7.
 *
 * Classic's arithmetic is that of the picture's bytes, hence assumed_gamma srgb: POV-Ray then works
 * on encoded values, too, and writes them as they are.  Reflection and refraction are scaled by the
 * sum of the lights, as classic does; glass is made twice, once to be seen and once, unseen, for
 * its full shadow. */
#include "config.h"

#include "base/file.h"
#include "convert/exporting.h"
#include "scene/camera.h"

#include <stdlib.h>

/* POV-Ray weakens what is diffuse by the share that shines through; a share of 1 would leave
 * nothing to make up for that with. */
#define TRANSMIT_MOST 0.999

enum { TRACE_LEVEL = 5 }; /* classic's 3 reflections, with room */

struct pov {
    struct exporting e;
    struct export_names materials;
    uint32_t *name_of; /* of each of the scene's materials */
};

static void add_vector(struct buffer *out, struct vec3 v)
{
    buffer_puts(out, "<");
    export_vec3(out, v, ",");
    buffer_puts(out, ">");
}

static void add_field(struct buffer *out, const char *name, double x)
{
    buffer_printf(out, " %s ", name);
    buffer_number(out, x);
}

/* ---- camera and lights ----------------------------------------------------------------------- */

static void add_camera(struct exporting *e)
{
    const struct camera *c = &e->scene->camera;
    struct lens lens = lens_of(c, c->width, c->height);
    struct vec3 flip = vec3(1, 1, lens.mirrored ? -1 : 1);
    buffer_puts(e->out, "camera {\n  perspective\n  location ");
    add_vector(e->out, lens.origin);
    buffer_puts(e->out, "\n  direction ");
    add_vector(e->out, vec3_mul(lens.ahead, flip));
    buffer_puts(e->out, "\n  right ");
    add_vector(e->out, vec3_scale(vec3_mul(lens.across, flip), 2));
    buffer_puts(e->out, "\n  up ");
    add_vector(e->out, vec3_scale(vec3_mul(lens.upwards, flip), 2));
    buffer_puts(e->out, "\n}\n");
}

/* The two longest sides of the object's box; as many points along each as classic takes. */
static void add_area(struct exporting *e, const struct light *l)
{
    struct box box = geometry_bounds(&l->object);
    struct vec3 side = vec3_sub(box.hi, box.lo);
    double least = fmin(side.x, fmin(side.y, side.z));
    bool flat_z = side.z == least, flat_y = !flat_z && side.y == least;
    struct vec3 a = flat_z || flat_y ? vec3(side.x, 0, 0) : vec3(0, side.y, 0);
    struct vec3 b = flat_z ? vec3(0, side.y, 0) : vec3(0, 0, side.z);
    size_t points = 0;
    for (size_t i = 0; i < l->points.n; i++)
        points += l->points.at[i].count;
    int along = (int)lround(cbrt((double)points));
    buffer_puts(e->out, " area_light ");
    add_vector(e->out, a);
    buffer_puts(e->out, ", ");
    add_vector(e->out, b);
    buffer_printf(e->out, ", %d, %d%s", along, along,
                  l->object.spheres.n ? " circular orient" : "");
}

/* The brightness of a light that falls off is 2 / (1 + (d / distance)^2) times its colour. */
#define FADE_DISTANCE 1e-3

static void add_light(struct exporting *e, const struct light *l)
{
    struct vec3 colour = l->intensity;
    if (l->inverse_square)
        colour = vec3_scale(colour, 0.5 / (FADE_DISTANCE * FADE_DISTANCE));
    buffer_puts(e->out, "light_source { ");
    add_vector(e->out, l->position);
    buffer_puts(e->out, ", rgb ");
    add_vector(e->out, colour);
    if (l->inverse_square) {
        add_field(e->out, "fade_distance", FADE_DISTANCE);
        add_field(e->out, "fade_power", 2);
    }
    if (l->kind == LIGHT_AREA) {
        add_area(e, l);
        export_lose(e, LOSS_AREA_GRID, l->span);
    }
    buffer_puts(e->out, " }\n");
}

/* ---- materials ------------------------------------------------------------------------------- */

/* How a picture comes to a surface: by its texture coordinates, which POV-Ray counts like classic
 * but on cylinders, where it has none. */
struct mapping {
    struct uv_map uv;
    const struct cylinder *around; /* or NULL */
};

static void add_string(struct buffer *out, const char *text)
{
    buffer_puts(out, "\"");
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            buffer_puts(out, "\\");
        buffer_add(out, text, 1);
    }
    buffer_puts(out, "\"");
}

static double inverse_scale(double x)
{
    return x == 0 ? 1e9 : 1 / x; /* one texel for all */
}

/* From texture coordinates times scale plus offset to texture coordinates. */
static void add_uv_transform(struct buffer *out, const struct uv_map *m)
{
    if (m->offset.x != 0 || m->offset.y != 0) {
        buffer_puts(out, " translate ");
        add_vector(out, vec3(-m->offset.x, -m->offset.y, 0));
    }
    if (m->scale.x != 1 || m->scale.y != 1) {
        buffer_puts(out, " scale ");
        add_vector(out, vec3(inverse_scale(m->scale.x), inverse_scale(m->scale.y), 1));
    }
}

/* Caps lie on the picture's last rows, which are also its first: this share of the height keeps
 * them apart. */
#define CAP_MARGIN 1e-4

/* From the unit cylinder that POV-Ray wraps pictures around to this one, with classic's angles
 * (cylinder_uv of scene/surface.c): where its x, y and z axes and its middle go. */
static void add_cylinder_transform(struct buffer *out, const struct cylinder *c,
                                   const struct uv_map *m)
{
    struct vec3 e = c->axis, up = vec3(0, 1, 0);
    bool upright = fabs(e.y) > 1 - 1e-6;
    struct vec3 across = vec3_mad(up, -e.y, e); /* shorter than 1: classic stretches the angle */
    struct vec3 x = upright ? vec3(0, 0, 1) : vec3_normalize(vec3_cross(up, e));
    struct vec3 z = upright ? vec3(-1, 0, 0) : vec3_scale(across, -1 / vec3_dot(across, across));
    struct vec3 y = vec3_scale(e, c->height / (1 - 2 * CAP_MARGIN) * inverse_scale(m->scale.y));
    double turn = 2 * PI * m->offset.x, cosine = cos(turn), sine = sin(turn);
    struct vec3 images[4] = {
        vec3_mad(vec3_scale(x, cosine), -sine, z),
        y,
        vec3_mad(vec3_scale(z, cosine), sine, x),
        vec3_mad(vec3_mad(c->base, -CAP_MARGIN * c->height, e), -m->offset.y, y),
    };
    buffer_puts(out, " matrix <");
    for (int i = 0; i < 4; i++) {
        buffer_puts(out, i ? "," : "");
        export_vec3(out, images[i], ",");
    }
    buffer_puts(out, ">");
}

static void add_picture(struct exporting *e, const struct material *m,
                        const struct mapping *mapping, double transmit)
{
    const struct texture *t = &e->scene->textures.at[m->texture];
    buffer_puts(e->out, mapping->around ? "image_map { " : "uv_mapping image_map { ");
    buffer_puts(e->out, t->image->jpeg ? "jpeg " : "png ");
    char *file = file_relative(e->path, t->file);
    add_string(e->out, file);
    free(file);
    buffer_puts(e->out, mapping->around ? " map_type 2" : "");
    buffer_puts(e->out, t->linear ? " interpolate 2" : "");
    if (transmit > 0)
        add_field(e->out, "transmit all", transmit);
    buffer_puts(e->out, " }");
    if (mapping->around)
        add_cylinder_transform(e->out, mapping->around, &mapping->uv);
    else
        add_uv_transform(e->out, &mapping->uv);
}

static void add_pigment(struct exporting *e, const struct material *m,
                        const struct mapping *mapping, double transmit)
{
    buffer_puts(e->out, "pigment { ");
    if (m->texture != TEXTURE_NONE) {
        add_picture(e, m, mapping, transmit);
    } else {
        buffer_puts(e->out, "rgb ");
        add_vector(e->out, m->diffuse);
        if (transmit > 0)
            add_field(e->out, "transmit", transmit);
    }
    buffer_puts(e->out, " }");
}

/* A highlight of the diffuse colour is POV-Ray's metallic one. */
static void add_highlight(struct buffer *out, const struct material *m)
{
    struct vec3 s = m->specular;
    bool metallic = !vec3_is_even(s) && export_is_tint(s, m->diffuse);
    if (vec3_is_zero(s))
        return;
    add_field(out, "phong", vec3_mean(s) / (metallic ? vec3_mean(m->diffuse) : 1));
    add_field(out, "phong_size", m->exponent);
    buffer_puts(out, metallic ? " metallic" : "");
}

static void add_mirror(struct exporting *e, const struct material *m)
{
    struct vec3 mirror = vec3_mul(m->reflection, e->light);
    if (vec3_is_zero(mirror))
        return;
    buffer_puts(e->out, " reflection { rgb ");
    add_vector(e->out, mirror);
    buffer_puts(e->out, " }");
}

static void add_finish(struct exporting *e, const struct material *m, double transmit)
{
    buffer_puts(e->out, " finish {");
    if (m->kind == MATERIAL_EMISSIVE) {
        buffer_puts(e->out, " diffuse 0 emission rgb ");
        add_vector(e->out, e->light);
    } else {
        add_field(e->out, "diffuse", 1 / (1 - transmit));
        add_highlight(e->out, m);
    }
    add_mirror(e, m);
    buffer_puts(e->out, " }");
}

/* A picture multiplied by the diffuse colour: seen through a layer of that colour, which also has
 * what the colour must not touch.  A metal's colour counts twice, once as its mean. */
static void add_tinted(struct exporting *e, const struct material *m, const struct mapping *mapping,
                       double transmit)
{
    double metal = m->kind == MATERIAL_METAL ? vec3_mean(m->diffuse) : 1;
    buffer_puts(e->out, "texture { ");
    add_pigment(e, m, mapping, transmit);
    buffer_puts(e->out, " finish {");
    if (m->kind == MATERIAL_EMISSIVE) {
        buffer_puts(e->out, " diffuse 0 emission rgb ");
        add_vector(e->out, e->light);
    } else {
        add_field(e->out, "diffuse", 1 / (1 - transmit));
    }
    buffer_puts(e->out, " } } texture { pigment { rgb ");
    add_vector(e->out, vec3_scale(m->diffuse, metal));
    buffer_puts(e->out, " filter 1 } finish { diffuse 0");
    add_highlight(e->out, m);
    add_mirror(e, m);
    buffer_puts(e->out, " } }");
}

static void add_material(struct exporting *e, const struct material *m,
                         const struct mapping *mapping)
{
    bool tinted = m->texture != TEXTURE_NONE && !(vec3_is_even(m->diffuse) && m->diffuse.x == 1);
    double transmit = vec3_mean(vec3_mul(m->refraction, e->light));
    transmit = fmax(fmin(transmit, TRANSMIT_MOST), 0);
    buffer_puts(e->out, "material { ");
    if (tinted) {
        add_tinted(e, m, mapping, transmit);
    } else {
        buffer_puts(e->out, "texture { ");
        add_pigment(e, m, mapping, transmit);
        add_finish(e, m, transmit);
        buffer_puts(e->out, " }");
    }
    if (m->kind == MATERIAL_GLASS) {
        buffer_puts(e->out, " interior {");
        add_field(e->out, "ior", m->ior);
        buffer_puts(e->out, " }");
    }
    buffer_puts(e->out, " }");
}

/* Equal materials, of which XML makes many, are declared once. */
static void declare_materials(struct pov *p)
{
    struct exporting *e = &p->e;
    struct buffer text = {0}, *out = e->out;
    p->name_of = mem_zalloc(e->scene->materials.n, sizeof *p->name_of);
    for (size_t i = 0; i < e->scene->materials.n; i++) {
        const struct material *m = &e->scene->materials.at[i];
        bool fresh;
        text.n = 0;
        e->out = &text;
        add_material(e, m, &(struct mapping){.uv = m->uv});
        e->out = out;
        p->name_of[i] = export_name(&p->materials, (struct str){text.at, text.n}, &fresh);
        if (fresh)
            buffer_printf(out, "#declare M%u = %.*s\n", p->name_of[i], (int)text.n, text.at);
    }
    buffer_free(&text);
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
    if (bounces && e->falls_off)
        export_lose(e, LOSS_FALLOFF, s->span);
}

/* ---- surfaces: each shape up to where its material stands ------------------------------------ */

static void open_sphere(struct buffer *out, const struct sphere *s)
{
    buffer_puts(out, "sphere { ");
    add_vector(out, s->center);
    buffer_puts(out, ", ");
    buffer_number(out, s->radius);
}

static void open_cylinder(struct buffer *out, const struct cylinder *c)
{
    buffer_puts(out, "cylinder { ");
    add_vector(out, c->base);
    buffer_puts(out, ", ");
    add_vector(out, vec3_mad(c->base, c->height, c->axis));
    buffer_puts(out, ", ");
    buffer_number(out, c->radius);
}

static void add_vertices(struct buffer *out, const struct vec3 *v, size_t n)
{
    buffer_printf(out, " vertex_vectors { %zu", n);
    for (size_t i = 0; i < n; i++) {
        buffer_puts(out, i % 4 ? "," : ",\n");
        add_vector(out, v[i]);
    }
    buffer_puts(out, " }\n");
}

/* POV-Ray wants a direction even where normals cancel out. */
static void add_normals(struct buffer *out, const struct vec3 *v, size_t n)
{
    buffer_printf(out, " normal_vectors { %zu", n);
    for (size_t i = 0; i < n; i++) {
        buffer_puts(out, i % 4 ? "," : ",\n");
        add_vector(out, vec3_is_zero(v[i]) ? vec3(0, 1, 0) : v[i]);
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

/* A normal map's coordinates, left out with it otherwise, are also those of the texture. */
static struct uv_map picture_map(const struct surface *s, const struct material *m)
{
    struct uv_map uv = m->uv;
    if (s->normal_map == TEXTURE_NONE)
        return uv;
    uv.offset.x += uv.scale.x * s->uv.offset.x;
    uv.offset.y += uv.scale.y * s->uv.offset.y;
    uv.scale.x *= s->uv.scale.x;
    uv.scale.y *= s->uv.scale.y;
    return uv;
}

static void add_material_use(struct pov *p, const struct surface *s, uint32_t prim)
{
    struct exporting *e = &p->e;
    const struct material *m = &e->scene->materials.at[s->material];
    bool round = s->kind == SURFACE_CYLINDER;
    struct mapping mapping = {picture_map(s, m), round ? export_cylinder(e->scene, prim) : NULL};
    if (m->texture != TEXTURE_NONE && (round || s->normal_map != TEXTURE_NONE)) {
        add_material(e, m, &mapping);
        if (round && mapping.uv.scale.x != 1)
            export_lose(e, LOSS_CYLINDER_UV, s->span);
    } else {
        buffer_printf(e->out, "material { M%u }", p->name_of[s->material]);
    }
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

static void add_object(struct pov *p, const struct surface *s, uint32_t prim)
{
    struct exporting *e = &p->e;
    enum material_kind kind = e->scene->materials.at[s->material].kind;
    bool glass = kind == MATERIAL_GLASS;
    const struct affine *place = export_place(e->scene, prim);
    buffer_puts(e->out, glass ? "#declare Glass = " : "");
    open_shape(e, s, prim);
    buffer_puts(e->out, glass ? " }\nobject { Glass " : " ");
    add_material_use(p, s, prim);
    add_place(e->out, place);
    if (glass) {
        buffer_puts(e->out, " no_shadow }\nobject { Glass no_image no_reflection");
        add_place(e->out, place);
        buffer_puts(e->out, " }\n");
        return;
    }
    buffer_puts(e->out, kind == MATERIAL_EMISSIVE ? " no_shadow }\n" : " }\n");
}

static void add_surface(struct pov *p, const struct surface *s)
{
    bool round = s->kind == SURFACE_SPHERE || s->kind == SURFACE_CYLINDER;
    uint32_t objects = round ? s->prim_count : export_facets(p->e.scene, s).solid > 0;
    note_losses(&p->e, s, &p->e.scene->materials.at[s->material]);
    for (uint32_t i = 0; i < objects; i++)
        add_object(p, s, s->first_prim + i);
}

/* ---- the file -------------------------------------------------------------------------------- */

static void add_head(struct exporting *e)
{
    const struct camera *c = &e->scene->camera;
    buffer_printf(e->out,
                  "// made by wrt: povray +W%u +H%u FILE.pov\n"
                  "#version 3.7;\n"
                  "global_settings { assumed_gamma srgb max_trace_level %d }\n"
                  "#default { finish { ambient 0 diffuse 1 } }\n",
                  c->width, c->height, TRACE_LEVEL);
}

void export_pov(const struct scene *scene, const char *path, struct buffer *out, struct diag *diag)
{
    struct pov p = {0};
    export_begin(&p.e, scene, path, out, diag);
    add_head(&p.e);
    add_camera(&p.e);
    for (size_t i = 0; i < scene->lights.n; i++)
        add_light(&p.e, &scene->lights.at[i]);
    declare_materials(&p);
    for (size_t i = 0; i < scene->surfaces.n; i++)
        add_surface(&p, &scene->surfaces.at[i]);
    export_end(&p.e);
    export_names_free(&p.materials);
    free(p.name_of);
}
