/* Whole pictures: the same bytes however they are computed. */
#include "config.h"

#include "unit.h"

#include "image/codec.h"
#include "render/render.h"

#include <string.h>

/* Of the pictures, and of the ways to sample them. */
enum { WIDTH = SANITIZED(40, 48), HEIGHT = SANITIZED(32, 36), SAMPLINGS = SANITIZED(1, 2) };

#define NO_UV    \
    {            \
        {0, 0},  \
        {        \
            1, 1 \
        }        \
    }

static uint32_t add_material(struct scene *s, struct material m)
{
    m.uv = (struct uv_map)NO_UV;
    vec_push(&s->materials, m);
    return (uint32_t)s->materials.n - 1;
}

static struct surface *add_surface(struct scene *s, enum surface_kind kind, uint32_t material)
{
    struct surface surface = {.kind = kind,
                              .material = material,
                              .normal_map = TEXTURE_NONE,
                              .first_prim = (uint32_t)s->geometry.prims.n,
                              .first_vertex = (uint32_t)s->geometry.vertices.n,
                              .uv = NO_UV};
    surface.needs_uv = s->materials.at[material].texture != TEXTURE_NONE;
    surface.prim_count = kind == SURFACE_QUAD ? 2 : 1;
    vec_push(&s->surfaces, surface);
    return &s->surfaces.at[s->surfaces.n - 1];
}

static uint32_t last_surface(const struct scene *s)
{
    return (uint32_t)s->surfaces.n - 1;
}

static void add_ball(struct scene *s, uint32_t material, struct vec3 at, double radius)
{
    add_surface(s, SURFACE_SPHERE, material);
    geometry_add_sphere(&s->geometry, last_surface(s), at, radius);
}

static void add_quad(struct geometry *g, uint32_t surface, struct vec3 at, struct vec3 u,
                     struct vec3 v)
{
    uint32_t first = geometry_add_vertex(g, at);
    geometry_add_vertex(g, vec3_add(at, u));
    geometry_add_vertex(g, vec3_add(vec3_add(at, u), v));
    geometry_add_vertex(g, vec3_add(at, v));
    geometry_add_triangle(g, surface, first, first + 1, first + 2);
    geometry_add_triangle(g, surface, first + 2, first + 3, first);
}

/* A heap of small faces; glass when the material is. */
static void add_mesh(struct scene *s, uint32_t material, struct vec3 at, double size)
{
    static const int8_t corner[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                        {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    struct surface *surface = add_surface(s, SURFACE_MESH, material);
    struct geometry *g = &s->geometry;
    uint32_t v = surface->first_vertex;
    surface->prim_count = 8;
    for (int i = 0; i < 6; i++)
        geometry_add_vertex(g, vec3_mad(at, size, vec3(corner[i][0], corner[i][1], corner[i][2])));
    for (uint32_t i = 0; i < 8; i++) {
        uint32_t x = v + (i & 1), y = v + 2 + (i >> 1 & 1), z = v + 4 + (i >> 2);
        bool odd = (i ^ i >> 1 ^ i >> 2) & 1;
        geometry_add_triangle(g, last_surface(s), x, odd ? z : y, odd ? y : z);
    }
}

/* The unit ball, a cylinder or a mesh, squashed and turned. */
static void add_instance(struct scene *s, uint32_t material, enum surface_kind kind, struct vec3 at,
                         double size)
{
    struct geometry *g = &s->geometry;
    struct affine scale = affine_scaling(vec3(size, 0.6 * size, -0.8 * size));
    struct affine turn = affine_rotation(vec3(20, 30, 40)), move = affine_translation(at);
    struct affine map = affine_times(&turn, &scale);
    map = affine_times(&move, &map);
    uint32_t only = 0, prototype = PROTOTYPE_SOLIDS;
    if (kind == SURFACE_CYLINDER) {
        only = (uint32_t)geometry_solids(g)->prims.n;
        geometry_add_cylinder(geometry_solids(g), 0, vec3(0, -1, 0), vec3(0, 1, 0.2), 0.7);
    } else if (kind == SURFACE_MESH) {
        prototype = geometry_add_prototype(g);
        struct geometry *shapes = &g->prototypes.at[prototype]->shapes;
        for (int i = 0; i < 8; i++)
            geometry_add_vertex(shapes, vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
        for (uint32_t i = 0; i < 6; i++)
            for (uint32_t k = i + 1; k < 8; k++)
                geometry_add_triangle(shapes, 0, i, k, k - 1);
        only = PRIM_NONE;
    } else {
        geometry_solids(g);
    }
    struct surface *surface = add_surface(s, kind, material);
    static const struct vec3 normals[8] = {{1, 0, 0}, {0, 1, 0},  {0, 0, 1},     {0.6, 0.8, 0},
                                           {0, 0, 0}, {0, -1, 0}, {0.8, 0, 0.6}, {-1, 0, 0}};
    surface->normals = kind == SURFACE_MESH ? normals : NULL;
    ck_assert(geometry_add_instance(g, last_surface(s), prototype, only, &map));
}

static struct light *add_light(struct scene *s, enum light_kind kind, struct vec3 at, double power)
{
    vec_push(&s->lights, (struct light){.kind = kind,
                                        .position = at,
                                        .intensity = vec3(power, 0.9 * power, 0.8 * power)});
    return &s->lights.at[s->lights.n - 1];
}

static void add_texture(struct scene *s)
{
    struct image *image = image_new(8, 8, 8);
    for (int i = 0; i < 192; i++)
        image->data8[i] = (uint8_t)(i * i * 37);
    vec_push(&s->images, image);
    vec_push(&s->textures, (struct texture){.image = image, .linear = true});
}

enum { MATT, SHINY, MIRROR, GLASS, GLOW, PATTERN, METAL };

static void add_materials(struct scene *s)
{
    struct vec3 white = vec3(0.9, 0.8, 0.7), grey = vec3_all(0.3);
    struct material m = {.kind = MATERIAL_LAMBERT, .diffuse = white, .texture = TEXTURE_NONE};
    add_material(s, m);
    m = (struct material){MATERIAL_PHONG, .diffuse = white, .specular = grey, .exponent = 7,
                          .texture = TEXTURE_NONE};
    add_material(s, m);
    m.kind = MATERIAL_SHINY;
    m.reflection = vec3(0.5, 0.4, 0.3);
    add_material(s, m);
    m.kind = MATERIAL_GLASS;
    m.refraction = vec3_all(0.6);
    m.ior = 1.5;
    add_material(s, m);
    m = (struct material){MATERIAL_EMISSIVE, .diffuse = white, .texture = TEXTURE_NONE};
    add_material(s, m);
    m = (struct material){MATERIAL_LAMBERT, .diffuse = white, .texture = 0};
    add_material(s, m);
    m = (struct material){MATERIAL_METAL,   .diffuse = white,   .specular = grey,
                          .exponent = 20.5, .reflection = grey, .texture = 0};
    add_material(s, m);
}

/* All kinds of surfaces, materials and lights; `scale` stretches every length.  `glow` says whether
 * something emissive stands about. */
static void make_scene(struct scene *s, double scale, bool glow)
{
    *s = (struct scene){.camera = {.origin = vec3(0, 1 * scale, -5 * scale),
                                   .back = vec3(0, 0.2, -1),
                                   .up = vec3(0, 1, 0),
                                   .yfov = 30,
                                   .width = WIDTH,
                                   .height = HEIGHT,
                                   .compatible = true}};
    struct geometry *g = &s->geometry;
    double k = scale;
    add_texture(s);
    add_materials(s);
    add_surface(s, SURFACE_QUAD, SHINY);
    add_quad(g, last_surface(s), vec3(-9 * k, -k, -9 * k), vec3(18 * k, 0, 0), vec3(0, 0, 18 * k));
    add_ball(s, GLASS, vec3(-0.8 * k, -0.2 * k, -k), 0.8 * k);
    add_ball(s, MIRROR, vec3(1.3 * k, 0, 0.5 * k), k);
    add_ball(s, PATTERN, vec3(0.2 * k, -0.6 * k, -2 * k), 0.4 * k);
    add_ball(s, METAL, vec3(-2 * k, 0.6 * k, k), 0.7 * k);
    add_mesh(s, GLASS, vec3(0.6 * k, 0.7 * k, -1.5 * k), 0.4 * k);
    add_mesh(s, MATT, vec3(-1.6 * k, 1.3 * k, -k), 0.3 * k);
    add_surface(s, SURFACE_CYLINDER, MIRROR);
    geometry_add_cylinder(g, last_surface(s), vec3(2 * k, -k, -k), vec3(1.5 * k, 0.5 * k, -k),
                          0.3 * k);
    add_surface(s, SURFACE_QUAD, GLASS);
    add_quad(g, last_surface(s), vec3(-k, -0.5 * k, -2.5 * k), vec3(0.5 * k, 0, 0),
             vec3(0, k, 0.1 * k));
    add_instance(s, GLASS, SURFACE_SPHERE, vec3(1.2 * k, -0.5 * k, -2 * k), 0.4 * k);
    add_instance(s, PATTERN, SURFACE_SPHERE, vec3(0, 1.4 * k, -k), 0.5 * k);
    add_instance(s, MIRROR, SURFACE_CYLINDER, vec3(-1.9 * k, -0.6 * k, -1.5 * k), 0.3 * k);
    add_instance(s, SHINY, SURFACE_MESH, vec3(1.6 * k, 1.5 * k, 0), 0.4 * k);
    add_instance(s, GLASS, SURFACE_MESH, vec3(-0.4 * k, 0.9 * k, -2 * k), 0.2 * k);
    if (glow) {
        add_surface(s, SURFACE_QUAD, GLOW);
        add_quad(g, last_surface(s), vec3(-k, 4 * k, -2 * k), vec3(2 * k, 0, 0), vec3(0, 0, 2 * k));
    }
    add_light(s, LIGHT_POINT, vec3(3 * k, 5 * k, -4 * k), 0.5);
    struct light *l = add_light(s, LIGHT_AREA, vec3(-2 * k, 3 * k, -2 * k), 0.4);
    geometry_add_sphere(&l->object, 0, l->position, 0.5 * k);
    light_sample_grid(l, geometry_bounds(&l->object), 3);
    l = add_light(s, LIGHT_AREA, vec3(0, 4 * k, -k), 0.3);
    add_quad(&l->object, 0, vec3(-0.5 * k, 4 * k, -1.5 * k), vec3(k, 0, 0), vec3(0, 0, k));
    light_sample_grid(l, geometry_bounds(&l->object), 4);
}

static struct render_options whole_picture(const struct scene *s)
{
    struct render_options o = {.isa = isa_best(),
                               .width = s->camera.width,
                               .height = s->camera.height,
                               .grid = 1,
                               .depth = 5,
                               .threads = 1};
    o.crop.x1 = o.width;
    o.crop.y1 = o.height;
    return o;
}

static struct picture *render(const struct scene *s, const struct render_options *o)
{
    struct render_stats stats;
    struct picture *p =
        picture_new(o->crop.x1 - o->crop.x0, o->crop.y1 - o->crop.y0, PICTURE_FLOATS);
    render_scene(s, o, p, &stats);
    ck_assert_uint_ge(stats.primary, (uint64_t)p->width * p->height);
    return p;
}

static bool same_bits(const struct picture *a, const struct picture *b)
{
    return a->width == b->width && a->height == b->height &&
           memcmp(a->floats, b->floats, 3 * sizeof *a->floats * a->width * a->height) == 0;
}

static void check_same(const struct scene *s, const struct render_options *o,
                       const struct picture *expected)
{
    struct picture *p = render(s, o);
    ck_assert(same_bits(p, expected));
    picture_free(p);
}

/* Bit 0: emissive surfaces; bit 1: 3 x 3 jittered samples. */
START_TEST(no_option_changes_a_bit)
{
    struct scene s;
    make_scene(&s, 1, _i & 1);
    struct render_options o = whole_picture(&s);
    if (_i & 2) {
        o.grid = 2;
        o.jitter = true;
        o.crop.y0 = HEIGHT / 2;
    }
    struct picture *expected = render(&s, &o);
    o.threads = 2;
    check_same(&s, &o, expected);
    o.threads = 7;
    check_same(&s, &o, expected);
    for (int isa = 0; isa < ISA_COUNT; isa++) {
        o.isa = (enum isa)isa;
        if (isa_available(o.isa))
            check_same(&s, &o, expected);
    }
    o.isa = isa_best();
    o.no_skip = NO_SKIP_ALL;
    check_same(&s, &o, expected);
    o.brute_force = true;
    check_same(&s, &o, expected);
    o.no_skip = 0;
    check_same(&s, &o, expected);
    picture_free(expected);
    scene_free(&s);
}
END_TEST

START_TEST(skipping_skips)
{
    struct scene s;
    make_scene(&s, 1, _i);
    struct render_options o = whole_picture(&s);
    struct render_stats with, without;
    struct picture *p = picture_new(o.width, o.height, PICTURE_BYTES);
    render_scene(&s, &o, p, &with);
    o.no_skip = NO_SKIP_ALL;
    render_scene(&s, &o, p, &without);
    ck_assert_uint_eq(shadow_rays_skipped(&without), 0);
    for (int i = 0; i < SKIP_BEHIND; i++)
        ck_assert_uint_gt(with.skipped[i], 0);
    ck_assert_uint_lt(with.shadow, without.shadow);
    ck_assert_uint_ge(with.shadow + shadow_rays_skipped(&with), without.shadow);
    ck_assert_uint_eq(with.reflection, without.reflection);
    ck_assert_uint_eq(with.refraction, without.refraction);
    picture_free(p);
    scene_free(&s);
}
END_TEST

static const enum render_show shows[] = {SHOW_PICTURE, SHOW_NORMALS, SHOW_DEPTH, SHOW_IDS};

START_TEST(a_crop_is_part_of_the_whole)
{
    struct scene s;
    make_scene(&s, 1, true);
    struct render_options o = whole_picture(&s);
    o.show = shows[_i % 4];
    o.grid = _i < 4 ? 1 : 2;
    o.jitter = _i >= 4;
    struct render_stats stats;
    struct picture *whole = picture_new(o.width, o.height, PICTURE_BYTES);
    render_scene(&s, &o, whole, &stats);
    o.crop.x0 = 13, o.crop.y0 = 7, o.crop.x1 = 40, o.crop.y1 = 29;
    struct picture *part = picture_new(27, 22, PICTURE_BYTES);
    render_scene(&s, &o, part, &stats);
    for (uint32_t y = 0; y < 22; y++)
        ck_assert(memcmp(part->bytes + (size_t)3 * 27 * y,
                         whole->bytes + 3 * ((size_t)o.width * (y + 7) + 13), (size_t)3 * 27) == 0);
    picture_free(whole);
    picture_free(part);
    scene_free(&s);
}
END_TEST

/* Every length times 2^k, from 2^-40 to 2^40. */
START_TEST(scale_changes_nothing)
{
    struct scene s;
    make_scene(&s, 1, true);
    struct render_options o = whole_picture(&s);
    struct picture *expected = render(&s, &o);
    scene_free(&s);
    make_scene(&s, ldexp(1, 8 * _i), true);
    check_same(&s, &o, expected);
    picture_free(expected);
    scene_free(&s);
}
END_TEST

START_TEST(classic_samples_pixel_corners)
{
    struct scene s;
    make_scene(&s, 1, false);
    struct render_options o = whole_picture(&s);
    struct picture *whole = render(&s, &o);
    o.width /= 4;
    o.height /= 4;
    o.crop.x1 = o.width;
    o.crop.y1 = o.height;
    struct picture *part = render(&s, &o);
    for (uint32_t y = 0; y < o.height; y++)
        for (uint32_t x = 0; x < o.width; x++)
            ck_assert(memcmp(part->floats + 3 * (y * o.width + x),
                             whole->floats + 3 * ((4 * y + 3) * whole->width + 4 * x),
                             3 * sizeof(float)) == 0);
    picture_free(whole);
    picture_free(part);
    scene_free(&s);
}
END_TEST

START_TEST(seeds_make_different_pictures)
{
    struct scene s;
    make_scene(&s, 1, false);
    struct render_options o = whole_picture(&s);
    o.jitter = true;
    o.seed = 1;
    struct picture *a = render(&s, &o);
    o.seed = 2;
    struct picture *b = render(&s, &o);
    ck_assert(!same_bits(a, b));
    picture_free(a);
    picture_free(b);
    scene_free(&s);
}
END_TEST

static struct picture *render_adaptive_part(const struct scene *s, double error, uint32_t cells,
                                            struct render_stats *stats)
{
    struct render_options o = whole_picture(s);
    o.adaptive = error;
    o.grid = cells;
    o.depth = 2;
    o.crop.x0 = 20, o.crop.y0 = 14, o.crop.x1 = 36, o.crop.y1 = 26;
    struct picture *p = picture_new(16, 12, PICTURE_FLOATS);
    render_scene(s, &o, p, stats);
    return p;
}

/* The root mean square of the errors is what it is estimated to be, within a factor of two. */
START_TEST(adaptive_errors_are_estimated)
{
    static const double wanted[] = {0.5, 0.1, 0.03};
    struct scene s;
    make_scene(&s, 1, true);
    struct render_stats stats, exact;
    struct picture *truth = render_adaptive_part(&s, 0.004, 8, &exact);
    struct picture *p = render_adaptive_part(&s, wanted[_i], 1, &stats);
    double squares = 0;
    size_t n = 3 * (size_t)p->width * p->height;
    for (size_t i = 0; i < n; i++)
        if (!isnan(p->floats[i]) && !isnan(truth->floats[i]))
            squares += (p->floats[i] - truth->floats[i]) * (p->floats[i] - truth->floats[i]);
    double ratio = sqrt(squares / (double)n) / stats.adaptive.error;
    ck_assert_msg(ratio > 0.5 && ratio < 2, "wanted %g: %g of the estimate", wanted[_i], ratio);
    ck_assert(stats.adaptive.worst <= wanted[_i]);
    ck_assert_uint_lt(stats.primary, exact.primary / 4);
    picture_free(truth);
    picture_free(p);
    scene_free(&s);
}
END_TEST

/* Two mirrors face to face, as deep as asked. */
START_TEST(deep_reflections_end)
{
    struct scene s = {.camera = {.origin = vec3(0, 0, 0),
                                 .back = vec3(0, 0, 1),
                                 .up = vec3(0, 1, 0),
                                 .yfov = 20,
                                 .width = 16,
                                 .height = 16,
                                 .compatible = true}};
    struct material m = {.kind = MATERIAL_SHINY,
                         .diffuse = vec3_all(0.001),
                         .reflection = vec3_all(1),
                         .texture = TEXTURE_NONE};
    add_material(&s, m);
    for (int side = -1; side <= 1; side += 2) {
        add_surface(&s, SURFACE_QUAD, 0);
        add_quad(&s.geometry, last_surface(&s), vec3(-1e4, -1e4, side), vec3(2e4, 0, 0),
                 vec3(0, 2e4, 0));
    }
    add_light(&s, LIGHT_POINT, vec3(0, 0.5, 0), 1);
    struct render_options o = whole_picture(&s);
    o.depth = 1000;
    struct render_stats stats;
    struct picture *p = picture_new(o.width, o.height, PICTURE_BYTES);
    render_scene(&s, &o, p, &stats);
    ck_assert_uint_eq(stats.reflection, 256 * 1000);
    picture_free(p);
    scene_free(&s);
}
END_TEST

/* No lights, nothing to see, no sample that counts: black. */
START_TEST(empty_scenes_are_black)
{
    struct scene s = {.camera = {.back = vec3(0, 0, 1),
                                 .up = vec3(0, 1, 0),
                                 .yfov = 20,
                                 .width = 20,
                                 .height = 10,
                                 .compatible = true}};
    struct render_options o = whole_picture(&s);
    o.show = shows[_i];
    struct render_stats stats;
    struct picture *p = picture_new(o.width, o.height, PICTURE_BYTES);
    render_scene(&s, &o, p, &stats);
    for (int i = 0; i < 600; i++)
        ck_assert_uint_eq(p->bytes[i], 0);
    picture_free(p);
    scene_free(&s);
}
END_TEST

static void count_reports(void *context, double done)
{
    double *last = context;
    ck_assert(done > *last && done <= 1);
    *last = done;
}

START_TEST(progress_is_reported)
{
    struct scene s;
    make_scene(&s, 1, false);
    struct render_options o = whole_picture(&s);
    double last = 0;
    o.progress.report = count_reports;
    o.progress.context = &last;
    picture_free(render(&s, &o));
    ck_assert(last == 1);
    scene_free(&s);
}
END_TEST

Suite *render_suite(void)
{
    Suite *s = suite_create("render");
    TCase *c = tcase_create("render");
    tcase_set_timeout(c, 120);
    tcase_add_loop_test(c, no_option_changes_a_bit, 0, 2 * SAMPLINGS);
    tcase_add_loop_test(c, skipping_skips, 0, 2);
    tcase_add_loop_test(c, a_crop_is_part_of_the_whole, 0, 5);
    tcase_add_loop_test(c, scale_changes_nothing, SANITIZED(-1, -5), SANITIZED(2, 6));
    tcase_add_test(c, classic_samples_pixel_corners);
    tcase_add_test(c, seeds_make_different_pictures);
    tcase_add_loop_test(c, adaptive_errors_are_estimated, 0, SANITIZED(1, 3));
    tcase_add_test(c, deep_reflections_end);
    tcase_add_loop_test(c, empty_scenes_are_black, 0, 4);
    tcase_add_test(c, progress_is_reported);
    suite_add_tcase(s, c);
    return s;
}
