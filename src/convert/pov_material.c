#include "config.h"

#include "base/file.h"
#include "convert/pov.h"

#include <stdlib.h>

/* POV-Ray weakens what is diffuse by the share that shines through; a share of 1 would leave
 * nothing to make up for that with. */
#define TRANSMIT_MOST 0.999

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
        pov_add_vector(out, vec3(-m->offset.x, -m->offset.y, 0));
    }
    if (m->scale.x != 1 || m->scale.y != 1) {
        buffer_puts(out, " scale ");
        pov_add_vector(out, vec3(inverse_scale(m->scale.x), inverse_scale(m->scale.y), 1));
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
        pov_add_field(e->out, "transmit all", transmit);
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
        pov_add_vector(e->out, m->diffuse);
        if (transmit > 0)
            pov_add_field(e->out, "transmit", transmit);
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
    pov_add_field(out, "phong", vec3_mean(s) / (metallic ? vec3_mean(m->diffuse) : 1));
    pov_add_field(out, "phong_size", m->exponent);
    buffer_puts(out, metallic ? " metallic" : "");
}

static void add_mirror(struct exporting *e, const struct material *m)
{
    struct vec3 mirror = vec3_mul(m->reflection, e->bounce);
    if (vec3_is_zero(mirror))
        return;
    buffer_puts(e->out, " reflection { rgb ");
    pov_add_vector(e->out, mirror);
    buffer_puts(e->out, " }");
}

/* What the light does to the pigment; the part that shines through is made up for. */
static void add_response(struct exporting *e, const struct material *m, double transmit)
{
    struct vec3 ambient = e->scene->ambient;
    if (m->kind == MATERIAL_EMISSIVE) {
        buffer_puts(e->out, " diffuse 0 emission rgb ");
        pov_add_vector(e->out, e->bounce);
        return;
    }
    pov_add_field(e->out, "diffuse", 1 / (1 - transmit));
    if (vec3_is_zero(ambient))
        return;
    buffer_puts(e->out, " ambient rgb ");
    pov_add_vector(e->out, vec3_scale(ambient, 1 / (1 - transmit)));
}

static void add_finish(struct exporting *e, const struct material *m, double transmit)
{
    buffer_puts(e->out, " finish {");
    add_response(e, m, transmit);
    if (m->kind != MATERIAL_EMISSIVE)
        add_highlight(e->out, m);
    add_mirror(e, m);
    buffer_puts(e->out, " }");
}

/* A picture multiplied by the diffuse colour: seen through a layer of that colour, which also has
 * what the colour must not touch.  In classic a metal's colour counts twice, once as its mean. */
static void add_tinted(struct exporting *e, const struct material *m, const struct mapping *mapping,
                       double transmit)
{
    bool twice = m->kind == MATERIAL_METAL && e->scene->model == SCENE_CLASSIC;
    double metal = twice ? vec3_mean(m->diffuse) : 1;
    buffer_puts(e->out, "texture { ");
    add_pigment(e, m, mapping, transmit);
    buffer_puts(e->out, " finish {");
    add_response(e, m, transmit);
    buffer_puts(e->out, " } } texture { pigment { rgb ");
    pov_add_vector(e->out, vec3_scale(m->diffuse, metal));
    buffer_puts(e->out, " filter 1 } finish { diffuse 0");
    add_highlight(e->out, m);
    add_mirror(e, m);
    buffer_puts(e->out, " } }");
}

static void add_material(struct exporting *e, const struct material *m,
                         const struct mapping *mapping)
{
    bool tinted = m->texture != TEXTURE_NONE && !(vec3_is_even(m->diffuse) && m->diffuse.x == 1);
    double transmit = vec3_mean(vec3_mul(m->refraction, e->bounce));
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
        pov_add_field(e->out, "ior", m->ior);
        buffer_puts(e->out, " }");
    }
    buffer_puts(e->out, " }");
}

static void write_material(struct exporting *e, const struct material *m)
{
    add_material(e, m, &(struct mapping){.uv = m->uv});
}

void pov_declare_materials(struct exporting *e)
{
    export_materials(e, "#declare M", " = ", write_material);
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

void pov_add_material_use(struct exporting *e, const struct surface *s, uint32_t prim)
{
    const struct material *m = &e->scene->materials.at[s->material];
    bool round = s->kind == SURFACE_CYLINDER;
    struct mapping mapping = {picture_map(s, m), round ? export_cylinder(e->scene, prim) : NULL};
    if (m->texture != TEXTURE_NONE && (round || s->normal_map != TEXTURE_NONE)) {
        add_material(e, m, &mapping);
        if (round && mapping.uv.scale.x != 1)
            export_lose(e, LOSS_CYLINDER_UV, s->span);
    } else {
        buffer_printf(e->out, "material { M%u }", e->name_of[s->material]);
    }
}
