/* The arithmetic of `model modern` against closed forms. */
#include "config.h"

#include "load.h"
#include "unit.h"

#include "render/render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A scene text whose one pixel looks along +z at the origin, from (0, 0, -5) unless said. */
#define EYE(eye)                                                                           \
    "wrt 1 model modern camera { eye: " eye " look_at: 0 lens: orthographic height: 1e-6 " \
    "resolution: (1, 1) }\n"
#define PIXEL EYE("(0, 0, -5)")
/* A wall across the view that faces the eye. */
#define WALL(material) \
    "quad { vertices: [(-9, -9, 0), (-9, 9, 0), (9, 9, 0), (9, -9, 0)] material: " material " }\n"
#define WHITE "lambert { diffuse: 1 }"

static struct picture *render_text(const char *text, bool floats, bool plain)
{
    struct load l;
    struct render_stats stats;
    ck_assert_msg(load_lower(&l, "scene.wrt", text), "%s", load_first(&l));
    const struct scene *s = &l.lowered.scene;
    struct render_options o = {.isa = isa_best(),
                               .width = s->camera.width,
                               .height = s->camera.height,
                               .grid = s->grid,
                               .depth = s->depth,
                               .threads = 1,
                               .no_skip = plain ? NO_SKIP_ALL : 0};
    o.crop.x1 = o.width;
    o.crop.y1 = o.height;
    struct picture *p = picture_new(o.width, o.height, floats);
    picture_encode_as(p, s->linear ? ENCODING_LINEAR : ENCODING_SRGB);
    render_scene(s, &o, p, &stats);
    load_free(&l);
    return p;
}

static const struct {
    const char *text;
    double expected, tolerance; /* of the red channel; the tolerance is relative */
} pixels[] = {
    {PIXEL "settings { background: 0.25 }", 0.25, 1e-7},
    {PIXEL WALL("emissive { diffuse: 0.5 }") "light sun { direction: (0, 0, 1) intensity: 9 }", 0.5,
     1e-7},
    {PIXEL WALL("lambert { diffuse: 0.5 }") "settings { ambient: 0.5 }", 0.25, 1e-7},
    /* suns: lit from the eye's side only, on either side of an open surface */
    {PIXEL WALL("lambert { diffuse: 0.5 }") "light sun { direction: (0, 0, 1) intensity: 0.5 }",
     0.25, 1e-7},
    {PIXEL WALL("lambert { diffuse: 0.5 }") "light sun { direction: (0, 0, -1) intensity: 0.5 }", 0,
     0},
    {EYE("(0, 0, 5)")
         WALL("lambert { diffuse: 0.5 }") "light sun { direction: (0, 0, -1) intensity: 0.5 }",
     0.25, 1e-7},
    /* points: intensity over the square of the distance, times the cosine */
    {PIXEL WALL("lambert { diffuse: 0.25 }") "light point { position: (0, 0, -2) intensity: 8 }",
     0.5, 1e-7},
    {PIXEL WALL("lambert { diffuse: 0.5 }") "light point { position: (3, 0, -4) intensity: 25 }",
     0.4, 1e-7},
    {PIXEL WALL("lambert { diffuse: 0.5 }") "light point { position: (3, 0, -4) intensity: 1 "
                                            "falloff: none }",
     0.4, 1e-7},
    /* in the shadow of a ball; of an emissive one; of one behind the light */
    {PIXEL WALL(WHITE) "light sun { direction: (0, -1, 1) intensity: 1 }"
                       "sphere { center: (0, 2, -2) radius: 0.5 material: " WHITE "}",
     0, 0},
    {PIXEL WALL(
         WHITE) "light sun { direction: (0, -1, 1) intensity: 1 }"
                "sphere { center: (0, 2, -2) radius: 0.5 material: emissive { diffuse: 1 } }",
     0.70710678118654752, 1e-7},
    {PIXEL WALL(WHITE) "light sun { direction: (0, -1, 1) intensity: 1 }"
                       "sphere { center: (0, 2, -2) radius: 0.5 material: emissive { diffuse: 1 } }"
                       "sphere { center: (0, 4, -4) radius: 0.5 material: " WHITE "}",
     0, 0},
    {PIXEL WALL(WHITE) "light point { position: (0, 1, -1) intensity: 2 }"
                       "sphere { center: (0, 2, -2) radius: 0.5 material: " WHITE "}",
     0.70710678118654752, 1e-7},
    /* a light that lies on another surface is not shadowed by it */
    {PIXEL WALL(WHITE) "light point { position: (0, 3, -4) intensity: 25 }"
                       "quad { vertices: [(-1, 3, -9), (1, 3, -9), (1, 3, 9), (-1, 3, 9)]"
                       "       material: " WHITE "}",
     0.8, 1e-7},
    /* highlights: the cosine to the mirrored direction, to the power of the exponent */
    {PIXEL WALL("phong { diffuse: 0 specular: 0.5 exponent: 10 }") "light sun { direction: (0, 0, "
                                                                   "1) intensity: 1 }",
     0.5, 1e-7},
    {PIXEL WALL("phong { diffuse: 0 specular: 0.5 exponent: 2 }") "light sun { direction: (0, "
                                                                  "-0.6, 0.8) intensity: 1 }",
     0.32, 1e-7},
    {PIXEL WALL("phong { diffuse: 0 specular: 0.5 exponent: 1.5 }") "light sun { direction: (0, "
                                                                    "-0.6, 0.8) intensity: 1 }",
     0.35777087639996635, 1e-7},
    /* a ball as a light: from afar as strong as a point, whatever its size */
    {PIXEL WALL(WHITE) "light area { shape: sphere size: 1 position: (0, 0, -100) samples: 16"
                       "             intensity: 1e4 }",
     1, 0.02},
    {PIXEL WALL(WHITE) "light area { shape: sphere size: 9 position: (0, 0, -100) samples: 16"
                       "             intensity: 1e4 }",
     1, 0.02},
    {PIXEL WALL(WHITE) "light area { object: cylinder { base: (0, 0, -100) top: (0, 1, -100)"
                       "             radius: 0.5 material: " WHITE "} samples: 32 intensity: 1e4 }",
     0.849, 0.04}, /* four times the area seen, 2 r h, over the area there is, 2 pi r (r + h) */
    /* a mirror counts once, its own light too */
    {PIXEL WALL("shiny { diffuse: 0 specular: 0 exponent: 1 reflection: 0.5 }") "settings { "
                                                                                "background: 0.5 }",
     0.25, 1e-7},
    /* glass of index 1 is not there; nor is glass within glass of the same index */
    {PIXEL "sphere { center: (0.3, 0.2, 0) radius: 1 material: glass { diffuse: 0 specular: 0"
           "  exponent: 1 reflection: 0 refraction: 1 ior: 1 } }"
           "sphere { center: (0, 0, 90) radius: 1e-3 material: emissive { diffuse: 0.5 } }",
     0.5, 1e-7},
    /* total reflection, from within: everything goes the mirrored way */
    {PIXEL "quad { vertices: [(-9, -9, -9), (9, -9, 9), (9, 9, 9), (-9, 9, -9)] material: glass {"
           "  diffuse: 0 specular: 0 exponent: 1 reflection: 0.05 refraction: 0.9 ior: 1.5 } }"
           "sphere { center: (40, 0, 0) radius: 1e-3 material: emissive { diffuse: 1 } }",
     0.95, 1e-7},
};

START_TEST(pixels_are_right)
{
    struct picture *p = render_text(pixels[_i].text, true, false);
    ck_assert_double_le(fabs(p->floats[0] - pixels[_i].expected),
                        pixels[_i].tolerance * pixels[_i].expected);
    struct picture *plain = render_text(pixels[_i].text, true, true);
    ck_assert(p->floats[0] == plain->floats[0]);
    picture_free(plain);
    picture_free(p);
}
END_TEST

/* Seen from a point below its middle, a square of side 2 x at height 1 fills this much of the view:
 * Howell, A Catalog of Radiation Heat Transfer Configuration Factors, factor B-4. */
static double square_above(double x)
{
    double w = sqrt(1 + x * x);
    return 4 * (2 * x / w * atan(x / w)) / (2 * 3.14159265358979323846);
}

START_TEST(squares_shine_as_they_should)
{
    double half = 0.25 * (_i + 1);
    char text[512];
    snprintf(
        text, sizeof text,
        PIXEL WALL(WHITE) "light area { vertices: [(-%g, -%g, -1), (%g, -%g, -1), (%g, %g, -1),"
                          " (-%g, %g, -1)] samples: 32 intensity: 1 }",
        half, half, half, half, half, half, half, half);
    struct picture *p = render_text(text, true, false);
    double expected = square_above(half) * 3.14159265358979323846 / (4 * half * half);
    ck_assert_double_eq_tol(p->floats[0], expected, 2e-3 * expected);
    picture_free(p);
}
END_TEST

START_TEST(snell_bends_rays)
{
    double degrees = 5 + 12 * _i, sine = sin(degrees * 3.14159265358979323846 / 180);
    double after = asin(sine / 1.5);
    char text[768];
    /* The wall is glass behind which the refracted ray meets a tiny lamp far away. */
    snprintf(text, sizeof text,
             "wrt 1 model modern camera { eye: (%.17g, 0, %.17g) look_at: 0 lens: orthographic"
             " height: 1e-9 resolution: (1, 1) }"
             "quad { vertices: [(-9, -9, 0), (-9, 9, 0), (9, 9, 0), (9, -9, 0)] material: glass {"
             " diffuse: 0 specular: 0 exponent: 1 reflection: 0 refraction: 1 ior: 1.5 } }"
             "sphere { center: (%.17g, 0, %.17g) radius: 1e-7 material: emissive { diffuse: 1 } }",
             -5 * sine, -5 * sqrt(1 - sine * sine), 1000 * sin(after), 1000 * cos(after));
    struct picture *p = render_text(text, true, false);
    ck_assert(p->floats[0] == 1);
    picture_free(p);
}
END_TEST

START_TEST(orthographic_pixels_are_centred)
{
    struct picture *p =
        render_text("wrt 1 model modern camera { eye: (0, 0, -5) look_at: 0"
                    " lens: orthographic height: 4 resolution: (48, 32) }"
                    "sphere { center: 0 radius: 1 material: emissive { diffuse: 1 } }",
                    true, false);
    for (int y = 0; y < 32; y++) {
        for (int x = 0; x < 48; x++) {
            double at = (x + 0.5 - 24) / 8, up = (y + 0.5 - 16) / 8;
            ck_assert(p->floats[3 * (48 * y + x)] == (at * at + up * up < 1));
        }
    }
    picture_free(p);
}
END_TEST

/* 90 degrees from bottom to top: the picture's edge is where x or y is z. */
START_TEST(perspective_is_vertical)
{
    struct picture *p = render_text("wrt 1 model modern camera { eye: 0 look_at: (0, 0, 1) fov: 90"
                                    " resolution: (8, 4) }"
                                    "sphere { center: (70, 30, 40) radius: 1"
                                    " material: emissive { diffuse: 1 } }",
                                    true, false);
    for (int i = 0; i < 32; i++) /* pixel (7, 0): x from 1.5 to 2, y from 0.5 to 1 */
        ck_assert(p->floats[3 * i] == (i == 7));
    picture_free(p);
}
END_TEST

START_TEST(pictures_are_encoded)
{
    struct picture *p =
        render_text(PIXEL WALL("emissive { diffuse: (0.5, 0.001, 7) }"), false, false);
    ck_assert_uint_eq(p->bytes[0], 188);
    ck_assert_uint_eq(p->bytes[1], 3);
    ck_assert_uint_eq(p->bytes[2], 255);
    picture_free(p);
    p = render_text(
        PIXEL WALL("emissive { diffuse: (0.5, 0.001, 7) }") "settings { encoding: linear }", false,
        false);
    ck_assert_uint_eq(p->bytes[0], 128);
    ck_assert_uint_eq(p->bytes[1], 0);
    picture_free(p);
    p = render_text(PIXEL WALL("emissive { diffuse: #40b0ff }"), false, false);
    ck_assert_uint_eq(p->bytes[0], 0x40);
    ck_assert_uint_eq(p->bytes[1], 0xb0);
    ck_assert_uint_eq(p->bytes[2], 0xff);
    picture_free(p);
}
END_TEST

/* Everything that has a mirror image, mirrored. */
static struct picture *render_mirrored(int sign)
{
    char text[1024];
    snprintf(
        text, sizeof text,
        "wrt 1 model modern let s = %d camera { eye: (s * 0.5, 1, -5) look_at: 0 fov: 50"
        " resolution: (37, 23) }"
        "default sphere { material: phong { diffuse: (0.9, 0.8, 0.7) specular: 0.4 exponent: 7 } }"
        "light point { position: (s * 3, 5, -4) intensity: 40 }"
        "light point { position: (s * -2, 4, -3) intensity: 15 }"
        "sphere { center: (s * 1.25, 0, 0) radius: 1 } sphere { center: (s * -0.6, 0.3, -1) "
        "radius: 0.4 }"
        "cylinder { base: (s * -2, -1, 0) top: (s * -1.5, 1, 0.5) radius: 0.3"
        " material: lambert { diffuse: 0.5 } }"
        "quad { vertices: [(-9, -1, -9), (9, -1, -9), (9, -1, 9), (-9, -1, 9)]"
        " material: lambert { diffuse: 0.8 } }",
        sign);
    return render_text(text, true, false);
}

START_TEST(mirrored_scenes_make_mirrored_pictures)
{
    struct picture *p = render_mirrored(1), *q = render_mirrored(-1);
    for (size_t y = 0; y < p->height; y++)
        for (size_t x = 0; x < p->width; x++)
            ck_assert(memcmp(p->floats + 3 * (y * p->width + x),
                             q->floats + 3 * (y * p->width + p->width - 1 - x),
                             3 * sizeof *p->floats) == 0);
    picture_free(p);
    picture_free(q);
}
END_TEST

static struct picture *render_scaled(int exponent)
{
    char text[1024];
    snprintf(
        text, sizeof text,
        "wrt 1 model modern let k = 2 ^ %d camera { eye: k * (0.5, 1, -5) look_at: k * (0, 0.1, 0)"
        " fov: 50 resolution: (32, 24) }"
        "light point { position: k * (3, 5, -4) intensity: 40 * k * k }"
        "light area { shape: sphere position: k * (-2, 4, -3) size: k intensity: 15 * k * k }"
        "sphere { center: k * (1.25, 0, 0) radius: k material: glass { diffuse: 0.1 specular: 0.4"
        " exponent: 7 reflection: 0.2 refraction: 0.8 ior: 1.5 } }"
        "cylinder { base: k * (-2, -1, 0) top: k * (-1.5, 1, 0.5) radius: 0.3 * k"
        " material: lambert { diffuse: 0.5 } }"
        "quad { vertices: [k * (-9, -1, -9), k * (9, -1, -9), k * (9, -1, 9), k * (-9, -1, 9)]"
        " material: shiny { diffuse: 0.8 specular: 0 exponent: 1 reflection: 0.3 } }",
        exponent);
    return render_text(text, true, false);
}

START_TEST(scale_does_not_matter)
{
    struct picture *p = render_scaled(0), *q = render_scaled(_i ? 40 : -40);
    ck_assert_int_eq(memcmp(p->floats, q->floats, 3 * 32 * 24 * sizeof *p->floats), 0);
    picture_free(p);
    picture_free(q);
}
END_TEST

/* ---- textures and their frames -----------------------------------------------------------------
 */

START_TEST(texels_lie_at_their_centres)
{
    uint8_t data[2 * 2 * 3] = {0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 255, 0}; /* top row first */
    struct image image = {.width = 2, .height = 2, .data8 = data};
    struct texture t = {.image = &image, .linear = true, .centred = true};
    struct vec3 c = texture_fetch(&t, 0.25, 0.25);
    ck_assert(c.x == 1 && c.y == 0 && c.z == 0);
    c = texture_fetch(&t, 1.75, -0.75); /* repeated */
    ck_assert(c.x == 0 && c.y == 1 && c.z == 0);
    c = texture_fetch(&t, 0.5, 0.75);
    ck_assert(c.x == 0.5 && c.y == 0.5 && c.z == 0.5);
    c = texture_fetch(&t, 0, 0.25); /* half of the left one, half of the right one repeated */
    ck_assert(c.x == 0.5 && c.y == 0.5 && c.z == 0);
    t.linear = false;
    c = texture_fetch(&t, 0.49, 0.49);
    ck_assert(c.x == 1 && c.y == 0);
    c = texture_fetch(&t, NAN, INFINITY);
    ck_assert(c.x == 1);
}
END_TEST

/* The frame's vectors against differences of the coordinates. */
START_TEST(frames_follow_the_coordinates)
{
    struct load l;
    ck_assert(load_lower(
        &l, "scene.wrt",
        PIXEL "default sphere { material: lambert { diffuse: 1 } }"
              "sphere { center: (1, 2, 3) radius: 2 }"
              "cylinder { base: 0 top: (0, 2, 0) radius: 1 material: lambert { diffuse: 1 } }"
              "cylinder { base: 0 top: (0, -2, 0) radius: 1 material: lambert { diffuse: 1 } }"
              "cylinder { base: 0 top: (1, 2, 0.5) radius: 1 material: lambert { diffuse: 1 } }"
              "group { scale: (1, 2, 0.5) rotate: (10, 20, 30) sphere { center: 0 radius: 1 } }"));
    const struct scene *s = &l.lowered.scene;
    const struct surface *surface = &s->surfaces.at[_i];
    for (int i = 0; i < 50; i++) {
        double a = 0.11 + i, b = 0.3 + 0.017 * i; /* a ray from within, never along an axis */
        struct vec3 d = vec3(sin(a) * cos(b), sin(b), cos(a) * cos(b)), n, x, y;
        struct vec3 from = _i == 0   ? vec3(1, 2, 3)
                           : _i == 2 ? vec3(0, -1, 0)
                                     : vec3(0.3, 0.6, 0.15);
        if (_i == 4)
            from = vec3_all(0);
        struct ray ray = {
            .origin = from, .direction = d, .t_max = RAY_UNBOUNDED, .from = PRIM_NONE};
        struct ray_frame frame = ray_frame_of(&ray);
        struct hit hit = hit_none(ray.t_max);
        ck_assert(geometry_intersect(&s->geometry, surface->first_prim, &ray, &frame, &hit));
        if (surface->kind == SURFACE_CYLINDER && hit.part != CYLINDER_SIDE)
            continue;
        struct vec3 p = geometry_hit_point(&s->geometry, &ray, &hit, &n);
        surface_frame(s, surface, &hit, p, n, &x, &y);
        ck_assert_double_eq_tol(vec3_dot(x, x), 1, 1e-12);
        ck_assert_double_eq_tol(vec3_dot(y, y), 1, 1e-12);
        ck_assert(fabs(vec3_dot(x, n)) < 1e-12 && fabs(vec3_dot(y, n)) < 1e-12);
        struct vec2 at = surface_uv(s, surface, &hit, p);
        struct vec2 along_x = surface_uv(s, surface, &hit, vec3_mad(p, 1e-6, x));
        struct vec2 along_y = surface_uv(s, surface, &hit, vec3_mad(p, 1e-6, y));
        double du = along_x.x - at.x, dv = along_y.y - at.y;
        ck_assert(du - floor(du + 0.5) > 1e-8 && dv > 1e-8);
    }
    load_free(&l);
}
END_TEST

#ifdef HAVE_OPENMESH

/* A smooth mesh of a ball is lit as the ball is, though it has just 20 faces a great circle. */
static void write_ball(FILE *f)
{
    enum { AROUND = 20, RINGS = 9 };
    fprintf(f, "OFF\n%d %d 0\n0 1 0\n0 -1 0\n", AROUND * RINGS + 2, 2 * AROUND * RINGS);
    for (int i = 1; i <= RINGS; i++)
        for (int j = 0; j < AROUND; j++)
            fprintf(f, "%.17g %.17g %.17g\n",
                    sin(M_PI * i / (RINGS + 1)) * cos(2 * M_PI * j / AROUND),
                    cos(M_PI * i / (RINGS + 1)),
                    sin(M_PI * i / (RINGS + 1)) * sin(2 * M_PI * j / AROUND));
    for (int j = 0; j < AROUND; j++) {
        int next = (j + 1) % AROUND, last = 2 + (RINGS - 1) * AROUND;
        fprintf(f, "3 0 %d %d\n3 1 %d %d\n", 2 + next, 2 + j, last + j, last + next);
        for (int i = 0; i + 1 < RINGS; i++) {
            int a = 2 + i * AROUND, b = a + AROUND;
            fprintf(f, "3 %d %d %d\n3 %d %d %d\n", a + j, a + next, b + j, b + j, a + next,
                    b + next);
        }
    }
}

START_TEST(smooth_meshes_have_no_terminator)
{
    char path[] = "/tmp/wrt-ball-XXXXXX.off", text[1024];
    int fd = mkstemps(path, 4);
    ck_assert_int_ge(fd, 0);
    FILE *f = fdopen(fd, "w");
    write_ball(f);
    fclose(f);
    static const char scene[] =
        "wrt 1 model modern camera { eye: (0, 0, -5) look_at: 0 lens: orthographic height: 1.3"
        " resolution: (64, 64) } light sun { direction: (1, -0.3, 0.2) intensity: 1 }\n";
    snprintf(text, sizeof text, "%ssphere { center: 0 radius: 1 material: " WHITE " }", scene);
    struct picture *ball = render_text(text, true, false);
    snprintf(text, sizeof text, "%smesh { file: \"%s\" smooth: true material: " WHITE " }", scene,
             path);
    struct picture *mesh = render_text(text, true, false);
    unlink(path);
    double worst = 0;
    for (int i = 0; i < 3 * 64 * 64; i++)
        worst = fmax(worst, fabs(ball->floats[i] - mesh->floats[i]));
    ck_assert_double_lt(worst, 0.06);
    picture_free(ball);
    picture_free(mesh);
}
END_TEST

#endif

Suite *modern_suite(void)
{
    Suite *s = suite_create("modern");
    TCase *c = tcase_create("modern");
    tcase_add_loop_test(c, pixels_are_right, 0, COUNT(pixels));
    tcase_add_loop_test(c, squares_shine_as_they_should, 0, 8);
    tcase_add_loop_test(c, snell_bends_rays, 0, 7);
    tcase_add_test(c, orthographic_pixels_are_centred);
    tcase_add_test(c, perspective_is_vertical);
    tcase_add_test(c, pictures_are_encoded);
    tcase_add_test(c, mirrored_scenes_make_mirrored_pictures);
    tcase_add_loop_test(c, scale_does_not_matter, 0, 2);
    tcase_add_test(c, texels_lie_at_their_centres);
    tcase_add_loop_test(c, frames_follow_the_coordinates, 0, 5);
#ifdef HAVE_OPENMESH
    tcase_add_test(c, smooth_meshes_have_no_terminator);
#endif
    suite_add_tcase(s, c);
    return s;
}
