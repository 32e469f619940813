/* A scene for Tachyon 0.99, whose highlights are ours with -shade_phong.  Its lights, like
 * classic's, need no gamma; its pictures never have one, unlike modern's. */
#include "config.h"

#include "convert/exporting.h"

static void add_vector(struct buffer *out, const char *name, struct vec3 v)
{
    buffer_printf(out, " %s ", name);
    export_vec3(out, v, " ");
}

static void add_number(struct buffer *out, const char *name, double x)
{
    buffer_printf(out, " %s ", name);
    buffer_number(out, x);
}

/* ---- camera and lights ----------------------------------------------------------------------- */

/* The picture lies at distance 1, its right is up x view: that is classic's, too.  Tachyon samples
 * pixels at their upper right corners; half a pixel less is their middle. */
static void add_camera(struct exporting *e)
{
    const struct camera *c = &e->scene->camera;
    struct export_view view = export_view(e->scene);
    double right = vec3_length(view.across), top = vec3_length(view.upwards);
    double sides[4] = {-right - right / c->width, right - right / c->width, -top - top / c->height,
                       top - top / c->height};
    buffer_printf(e->out,
                  "CAMERA\n PROJECTION %s ZOOM 1 ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH %d\n",
                  view.parallel ? "ORTHOGRAPHIC" : "PERSPECTIVE", export_ray_depth(e->scene));
    add_vector(e->out, "CENTER", view.eye);
    add_vector(e->out, "VIEWDIR", view.ahead);
    add_vector(e->out, "UPDIR", view.upwards);
    buffer_puts(e->out, "\n FRUSTUM");
    for (int i = 0; i < 4; i++)
        add_number(e->out, "", sides[i]);
    buffer_puts(e->out, "\nEND_CAMERA\nBACKGROUND ");
    export_vec3(e->out, e->scene->background, " ");
    buffer_puts(e->out, "\n");
    if (e->scene->model == SCENE_MODERN && !e->scene->linear)
        export_lose(e, LOSS_ENCODING, (struct span){0});
}

/* A light of radius 0 is not seen itself.  One that falls off has the colour it has in the middle
 * of the scene: Tachyon's highlights have a light's colour however far it is, and it drops light of
 * less than a five hundredth of that. */
static void add_light(struct exporting *e, const struct light *l)
{
    double strength = export_strength(e->scene, l);
    if (l->kind == LIGHT_SUN) {
        buffer_puts(e->out, "DIRECTIONAL_LIGHT");
        add_vector(e->out, "DIRECTION", vec3_neg(l->position));
    } else {
        buffer_puts(e->out, "LIGHT");
        add_vector(e->out, "CENTER", export_area(l).middle);
        buffer_puts(e->out, " RAD 0");
    }
    if (l->inverse_square)
        add_number(e->out, "ATTENUATION CONSTANT 0 LINEAR 0 QUADRATIC", strength);
    add_vector(e->out, "COLOR", vec3_scale(l->intensity, strength));
    buffer_puts(e->out, "\n");
    if (l->kind == LIGHT_AREA)
        export_lose(e, LOSS_AREA_POINT, l->span);
    if (l->both_sides)
        export_lose(e, LOSS_SIDEWAYS, l->span);
}

/* ---- materials ------------------------------------------------------------------------------- */

/* Metallic highlights do not even take a light's colour: what it is on average. */
static double metallic_light(const struct exporting *e)
{
    size_t n = e->scene->lights.n;
    return n > 0 ? vec3_mean(e->light) / (double)n : 1;
}

static void add_highlight(const struct exporting *e, const struct material *m)
{
    bool metallic = !vec3_is_even(m->specular) && export_is_tint(m->specular, m->diffuse);
    if (vec3_is_zero(m->specular))
        return;
    double share = vec3_mean(m->specular) / (metallic ? vec3_mean(m->diffuse) : 1);
    add_number(e->out, metallic ? "PHONG METAL" : "PHONG PLASTIC",
               metallic ? share * metallic_light(e) : share);
    add_number(e->out, "PHONG_SIZE", m->exponent);
}

/* The mean of what a texture shows at a grid of places; white without one. */
static struct vec3 mean_texel(const struct scene *scene, const struct material *m)
{
    enum { ALONG = 32 };
    struct vec3 sum = {0, 0, 0};
    if (m->texture == TEXTURE_NONE)
        return vec3_all(1);
    for (int i = 0; i < ALONG * ALONG; i++) {
        int column = i % ALONG, row = i / ALONG;
        double u = (column + 0.5) / ALONG, v = (row + 0.5) / ALONG;
        struct vec3 texel = texture_fetch(&scene->textures.at[m->texture], u, v);
        sum = vec3_mad(sum, 1.0 / (ALONG * ALONG), texel);
    }
    return sum;
}

static void add_material(struct exporting *e, const struct material *m)
{
    bool emissive = m->kind == MATERIAL_EMISSIVE;
    double through = vec3_mean(vec3_mul(m->refraction, e->bounce));
    add_number(e->out, "AMBIENT", emissive ? 1 : vec3_mean(e->scene->ambient));
    add_number(e->out, "DIFFUSE", !emissive);
    add_number(e->out, "SPECULAR", vec3_mean(vec3_mul(m->reflection, e->bounce)));
    add_number(e->out, "OPACITY", 1 - fmax(fmin(through, 1), 0));
    add_highlight(e, m);
    struct vec3 colour = vec3_mul(m->diffuse, mean_texel(e->scene, m));
    add_vector(e->out, "COLOR", emissive ? vec3_mul(colour, e->bounce) : colour);
    buffer_puts(e->out, " TEXFUNC 0");
}

static void note_losses(struct exporting *e, const struct surface *s, const struct material *m)
{
    if (s->normal_map != TEXTURE_NONE)
        export_lose(e, LOSS_NORMAL_MAP, s->span);
    if (m->texture != TEXTURE_NONE)
        export_lose(e, LOSS_TEXTURE, s->span);
    if (!vec3_is_even(m->specular) && !export_is_tint(m->specular, m->diffuse))
        export_lose(e, LOSS_HIGHLIGHT, s->span);
    if (!vec3_is_even(m->reflection))
        export_lose(e, LOSS_REFLECTION, s->span);
    if (m->kind == MATERIAL_GLASS)
        export_lose(e, LOSS_BENDING, s->span);
    if (m->kind == MATERIAL_EMISSIVE)
        export_lose(e, LOSS_EMISSIVE_SHADOW, s->span);
    bool bounces = !vec3_is_zero(m->reflection) || !vec3_is_zero(m->refraction);
    if (e->falls_off && bounces && e->scene->model == SCENE_CLASSIC)
        export_lose(e, LOSS_FALLOFF, s->span);
    if (e->falls_off && !vec3_is_zero(m->specular))
        export_lose(e, LOSS_SHINE, s->span);
    if (m->kind != MATERIAL_EMISSIVE && !vec3_is_even(e->scene->ambient))
        export_lose(e, LOSS_AMBIENT, s->span);
}

/* ---- surfaces -------------------------------------------------------------------------------- */

static void add_sphere(struct buffer *out, const struct sphere *s, uint32_t material)
{
    buffer_puts(out, "SPHERE");
    add_vector(out, "CENTER", s->center);
    add_number(out, "RAD", s->radius);
    buffer_printf(out, " M%u\n", material);
}

static void add_cap(struct buffer *out, struct vec3 center, struct vec3 normal, double radius,
                    uint32_t material)
{
    buffer_puts(out, "RING");
    add_vector(out, "CENTER", center);
    add_vector(out, "NORMAL", normal);
    add_number(out, "INNER 0 OUTER", radius);
    buffer_printf(out, " M%u\n", material);
}

static void add_cylinder(struct buffer *out, const struct cylinder *c, uint32_t material)
{
    struct vec3 top = vec3_mad(c->base, c->height, c->axis);
    buffer_puts(out, "FCYLINDER");
    add_vector(out, "BASE", c->base);
    add_vector(out, "APEX", top);
    add_number(out, "RAD", c->radius);
    buffer_printf(out, " M%u\n", material);
    add_cap(out, c->base, vec3_neg(c->axis), c->radius, material);
    add_cap(out, top, c->axis, c->radius, material);
}

static void add_vectors(struct buffer *out, const char *name, const struct vec3 *v, size_t n)
{
    buffer_printf(out, "%s\n", name);
    for (size_t i = 0; i < n; i++) {
        export_vec3(out, v[i], " ");
        buffer_puts(out, "\n");
    }
}

/* One normal a vertex.  An array takes its material written out. */
static void add_array(struct exporting *e, const struct surface *s, const struct facets *f)
{
    struct buffer *out = e->out;
    buffer_printf(out, "VERTEXARRAY NUMVERTS %u\n", f->point_count);
    add_vectors(out, "COORDS", f->points, f->point_count);
    add_vectors(out, "NORMALS", s->normals, f->point_count);
    buffer_puts(out, "TEXTURE");
    add_material(e, &e->scene->materials.at[s->material]);
    buffer_printf(out, "\nTRIMESH %zu\n", f->solid);
    for (size_t i = 0; i < f->n; i++) {
        struct triangle_corners c = export_corners(f, i);
        if (!vec3_is_zero(f->at[i].normal))
            buffer_printf(out, "%u %u %u\n", c.at[0], c.at[1], c.at[2]);
    }
    buffer_puts(out, "END_VERTEXARRAY\n");
}

static void add_corners(struct buffer *out, const char letter, const struct vec3 *v,
                        struct triangle_corners c)
{
    for (int i = 0; i < 3; i++) {
        buffer_printf(out, " %c%d ", letter, i);
        export_vec3(out, v[c.at[i]], " ");
    }
}

/* Flat, or each face with normals of its own. */
static void add_triangles(struct buffer *out, const struct surface *s, const struct facets *f,
                          uint32_t material)
{
    for (size_t i = 0; i < f->n; i++) {
        if (vec3_is_zero(f->at[i].normal))
            continue;
        buffer_puts(out, s->normals ? "STRI" : "TRI");
        add_corners(out, 'V', f->points, export_corners(f, i));
        if (s->normals)
            add_corners(out, 'N', s->normals, export_normal_corners(f, s, i));
        buffer_printf(out, " M%u\n", material);
    }
}

/* Tachyon has no ellipsoids: a grid of triangles over the shape, placed. */
enum { AROUND = 96, ALONG = 48 };

/* u: once around; v: along, both from 0 to 1. */
static struct vec3 sphere_point(const struct sphere *s, double u, double v)
{
    struct vec3 n = vec3(sin(PI * v) * cos(2 * PI * u), cos(PI * v), sin(PI * v) * sin(2 * PI * u));
    return vec3_mad(s->center, s->radius, n);
}

/* A third of v for each cap and the side. */
static struct vec3 cylinder_point(const struct cylinder *c, double u, double v)
{
    struct vec3 e = c->axis, other = fabs(e.x) < 0.5 ? vec3(1, 0, 0) : vec3(0, 1, 0);
    struct vec3 x = vec3_normalize(vec3_cross(e, other)), y = vec3_cross(e, x);
    double outwards = fmin(1, fmin(3 * v, 3 - 3 * v)), up = fmin(1, fmax(0, 3 * v - 1));
    struct vec3 p = vec3_mad(c->base, up * c->height, e);
    p = vec3_mad(p, outwards * c->radius * cos(2 * PI * u), x);
    return vec3_mad(p, outwards * c->radius * sin(2 * PI * u), y);
}

static void add_triangle(struct buffer *out, const struct vec3 corners[3], uint32_t material)
{
    static const struct triangle_corners all = {{0, 1, 2}};
    buffer_puts(out, "TRI");
    add_corners(out, 'V', corners, all);
    buffer_printf(out, " M%u\n", material);
}

static void add_placed(struct exporting *e, const struct surface *s, uint32_t prim,
                       uint32_t material)
{
    const struct scene *scene = e->scene;
    const struct affine *place = export_place(scene, prim);
    export_lose(e, LOSS_UNEVEN, s->span);
    for (int i = 0; i < AROUND * ALONG; i++) {
        int column = i % AROUND, row = i / AROUND;
        struct vec3 p[4];
        for (int k = 0; k < 4; k++) {
            double u = (double)(column + (k == 1 || k == 2)) / AROUND;
            double v = (double)(row + (k >= 2)) / ALONG;
            p[k] = s->kind == SURFACE_SPHERE ? sphere_point(export_sphere(scene, prim), u, v)
                                             : cylinder_point(export_cylinder(scene, prim), u, v);
            p[k] = affine_point(place, p[k]);
        }
        struct vec3 other[3] = {p[2], p[3], p[0]};
        if (row > 0) /* not at the first pole */
            add_triangle(e->out, p, material);
        if (row < ALONG - 1)
            add_triangle(e->out, other, material);
    }
}

static void add_surface(struct exporting *e, const struct surface *s)
{
    const struct scene *scene = e->scene;
    struct buffer *out = e->out;
    uint32_t material = e->name_of[s->material];
    bool round = s->kind == SURFACE_SPHERE || s->kind == SURFACE_CYLINDER;
    note_losses(e, s, &scene->materials.at[s->material]);
    for (uint32_t i = 0; round && i < s->prim_count; i++) {
        if (export_place(scene, s->first_prim + i))
            add_placed(e, s, s->first_prim + i, material);
        else if (s->kind == SURFACE_SPHERE)
            add_sphere(out, export_sphere(scene, s->first_prim + i), material);
        else
            add_cylinder(out, export_cylinder(scene, s->first_prim + i), material);
    }
    if (round)
        return;
    struct facets f = export_facets(scene, s);
    if (s->normals && !s->normal_corners)
        add_array(e, s, &f);
    else
        add_triangles(out, s, &f, material);
}

void export_tachyon(const struct scene *scene, const char *path, struct buffer *out,
                    struct diag *diag)
{
    struct exporting e;
    export_begin(&e, scene, path, out, diag);
    buffer_printf(out,
                  "# made by wrt: tachyon FILE -shade_phong -format PNG -o FILE.png\n"
                  "BEGIN_SCENE\nRESOLUTION %u %u\n",
                  scene->camera.width, scene->camera.height);
    add_camera(&e);
    for (size_t i = 0; i < scene->lights.n; i++)
        add_light(&e, &scene->lights.at[i]);
    export_materials(&e, "TEXDEF M", "", add_material);
    for (size_t i = 0; i < scene->surfaces.n; i++)
        add_surface(&e, &scene->surfaces.at[i]);
    buffer_puts(out, "END_SCENE\n");
    export_end(&e);
}
