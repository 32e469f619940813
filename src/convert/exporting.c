#include "config.h"

#include "convert/exporting.h"
#include "scene/camera.h"

#include <stdlib.h>

static const char *const loss_words[LOSS_COUNT] = {
#define LOSS(id, words) [LOSS_##id] = words,
    LOSSES(LOSS)
#undef LOSS
};

struct vec3 export_middle(const struct scene *scene, double *reach)
{
    struct box box = geometry_bounds(&scene->geometry);
    if (!(box.lo.x <= box.hi.x))
        box = (struct box){vec3_all(0), vec3_all(0)};
    *reach = vec3_length(vec3_sub(box.hi, box.lo));
    return box_center(box);
}

double export_strength(const struct scene *scene, const struct light *l)
{
    double reach;
    struct vec3 d = vec3_sub(export_area(l).middle, export_middle(scene, &reach));
    double weight = l->inverse_square ? 1 / vec3_dot(d, d) : 1;
    return isfinite(weight) && weight > 0 ? weight : 1;
}

static void sum_lights(struct exporting *e)
{
    const struct scene *s = e->scene;
    for (size_t i = 0; i < s->lights.n; i++) {
        const struct light *l = &s->lights.at[i];
        e->light = vec3_mad(e->light, export_strength(s, l), l->intensity);
        e->falls_off |= l->inverse_square;
    }
    e->bounce = s->model == SCENE_CLASSIC ? e->light : vec3_all(1);
}

void export_begin(struct exporting *e, const struct scene *scene, const char *path,
                  struct buffer *out, struct diag *diag)
{
    *e = (struct exporting){.scene = scene, .path = path, .out = out, .diag = diag};
    sum_lights(e);
}

void export_lose(struct exporting *e, enum loss loss, struct span span)
{
    if (!e->losses[loss].times++)
        e->losses[loss].first = span;
}

void export_end(struct exporting *e)
{
    for (int i = 0; i < LOSS_COUNT; i++) {
        size_t times = e->losses[i].times;
        if (times == 1)
            diag_report(e->diag, DIAG_LEFT_OUT, e->losses[i].first, "%s", loss_words[i]);
        else if (times > 1)
            diag_report(e->diag, DIAG_LEFT_OUT, e->losses[i].first,
                        "%s, here for the first time of %zu", loss_words[i], times);
    }
    map_free(&e->materials.map);
    arena_free(&e->materials.arena);
    free(e->name_of);
}

struct export_view export_view(const struct scene *scene)
{
    const struct camera *c = &scene->camera;
    struct lens lens = lens_of(c, c->width, c->height);
    struct vec3 flip = vec3(1, 1, lens.mirrored ? -1 : 1);
    return (struct export_view){.eye = lens.origin,
                                .ahead = vec3_mul(lens.ahead, flip),
                                .across = vec3_mul(lens.across, flip),
                                .upwards = vec3_mul(lens.upwards, flip),
                                .parallel = lens.parallel};
}

int export_ray_depth(const struct scene *scene)
{
    enum { ROOM = 2, MOST = 250 }; /* POV-Ray's limit is 256 */
    return scene->depth < MOST ? (int)scene->depth + ROOM : MOST;
}

/* Of a modern light given by four corners, these; else the two longest sides of the object's box,
 * which classic's light need not be in the middle of. */
struct export_area export_area(const struct light *l)
{
    const struct geometry *g = &l->object;
    bool modern = l->samples.n > 0;
    if (l->kind != LIGHT_AREA)
        return (struct export_area){.middle = l->position};
    if (modern && g->vertices.n == 4 && g->triangles.n == 2) {
        const struct vec3 *v = g->vertices.at;
        return (struct export_area){vec3_scale(vec3_add(v[0], v[2]), 0.5),
                                    {vec3_sub(v[1], v[0]), vec3_sub(v[2], v[1])}};
    }
    struct box box = geometry_bounds(g);
    struct vec3 side = vec3_sub(box.hi, box.lo);
    double least = fmin(side.x, fmin(side.y, side.z));
    bool flat_z = side.z == least, flat_y = !flat_z && side.y == least;
    return (struct export_area){modern ? box_center(box) : l->position,
                                {flat_z || flat_y ? vec3(side.x, 0, 0) : vec3(0, side.y, 0),
                                 flat_z ? vec3(0, side.y, 0) : vec3(0, 0, side.z)}};
}

/* Adding 0 takes the sign off zeros, which directions often have. */
void export_vec3(struct buffer *out, struct vec3 v, const char *between)
{
    buffer_number(out, v.x + 0.0);
    buffer_puts(out, between);
    buffer_number(out, v.y + 0.0);
    buffer_puts(out, between);
    buffer_number(out, v.z + 0.0);
}

double vec3_mean(struct vec3 v)
{
    return (v.x + v.y + v.z) / 3;
}

bool vec3_is_even(struct vec3 v)
{
    return v.x == v.y && v.y == v.z;
}

bool export_is_tint(struct vec3 colour, struct vec3 base)
{
    double share = vec3_mean(colour) / vec3_mean(base);
    return vec3_largest(vec3_mad(colour, -share, base)) <= 1e-9 * vec3_largest(colour);
}

static uint32_t highest(struct triangle_corners c)
{
    uint32_t most = c.at[0] > c.at[1] ? c.at[0] : c.at[1];
    return most > c.at[2] ? most : c.at[2];
}

struct triangle_corners export_corners(const struct facets *f, size_t face)
{
    const uint32_t *v = f->at[face].vertex;
    return (struct triangle_corners){
        {v[0] - f->first_vertex, v[1] - f->first_vertex, v[2] - f->first_vertex}};
}

struct triangle_corners export_normal_corners(const struct facets *f, const struct surface *s,
                                              size_t face)
{
    return s->normal_corners ? s->normal_corners[face] : export_corners(f, face);
}

struct facets export_facets(const struct scene *scene, const struct surface *s)
{
    const struct geometry *g = &scene->geometry;
    struct facets f = {.n = s->prim_count, .first_vertex = s->first_vertex};
    if (!f.n)
        return f;
    f.at = &g->triangles.at[g->prims.at[s->first_prim].index];
    f.points = &g->vertices.at[f.first_vertex];
    for (size_t i = 0; i < f.n; i++) {
        uint32_t points = highest(export_corners(&f, i)) + 1;
        uint32_t normals = s->normals ? highest(export_normal_corners(&f, s, i)) + 1 : 0;
        f.solid += !vec3_is_zero(f.at[i].normal);
        f.point_count = points > f.point_count ? points : f.point_count;
        f.normal_count = normals > f.normal_count ? normals : f.normal_count;
    }
    return f;
}

static struct spot spot_of(const struct scene *scene, uint32_t prim)
{
    struct hit hit = {.prim = prim};
    return geometry_spot(&scene->geometry, &hit);
}

const struct cylinder *export_cylinder(const struct scene *scene, uint32_t prim)
{
    struct spot s = spot_of(scene, prim);
    return &s.geometry->cylinders.at[s.geometry->prims.at[s.prim].index];
}

const struct sphere *export_sphere(const struct scene *scene, uint32_t prim)
{
    struct spot s = spot_of(scene, prim);
    return &s.geometry->spheres.at[s.geometry->prims.at[s.prim].index];
}

const struct affine *export_place(const struct scene *scene, uint32_t prim)
{
    struct spot s = spot_of(scene, prim);
    return s.instance ? &s.instance->to_world : NULL;
}

/* The number of the text; *fresh when it was not known before. */
static uint32_t name_text(struct export_names *names, struct str text, bool *fresh)
{
    uintptr_t known = (uintptr_t)map_get(&names->map, text);
    *fresh = !known;
    if (known)
        return (uint32_t)(known - 1);
    struct str key = {arena_copy(&names->arena, text.at, text.n), text.n};
    map_set(&names->map, key, (void *)((uintptr_t)names->n + 1)); /* a number, not a place */
    return names->n++;
}

void export_materials(struct exporting *e, const char *before, const char *between,
                      void (*write)(struct exporting *e, const struct material *m))
{
    const struct scene *s = e->scene;
    struct buffer text = {0}, *out = e->out;
    e->name_of = mem_zalloc(s->materials.n, sizeof *e->name_of);
    for (size_t i = 0; i < s->materials.n; i++) {
        bool fresh;
        text.n = 0;
        e->out = &text;
        write(e, &s->materials.at[i]);
        e->out = out;
        e->name_of[i] = name_text(&e->materials, (struct str){text.at, text.n}, &fresh);
        if (fresh)
            buffer_printf(out, "%s%u%s%.*s\n", before, e->name_of[i], between, (int)text.n,
                          text.at);
    }
    buffer_free(&text);
}
