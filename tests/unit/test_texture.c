/* Texel fetch and texture coordinates. */
#include "config.h"

#include "unit.h"

#include "image/codec.h"
#include "scene/scene.h"

/* Channel r of texel (i, j), j from the bottom, is 10 j + i. */
static struct image *numbered(uint32_t width, uint32_t height)
{
    struct image *image = image_new(width, height, 8);
    for (uint32_t j = 0; j < height; j++)
        for (uint32_t i = 0; i < width; i++)
            image->data8[3 * ((height - 1 - j) * width + i)] = (uint8_t)(10 * j + i);
    return image;
}

struct fetch {
    double u, v;
    double nearest, linear; /* times 255 */
};

/* 4 x 2 texels. */
static const struct fetch fetches[] = {
    {0, 0, 0, 0},
    {0.25, 0, 1, 1},
    {0.375, 0, 1, 1.5},
    {0.875, 0, 3, 1.5}, /* between the last column and, around, the first */
    {1, 0, 3, 0},       /* 1 exactly: the last texel's end */
    {1.25, 0, 1, 1},    /* wrapped */
    {2, 0, 0, 0},
    {-0.25, 0, 3, 0},    /* trunc(-1) mod 4 = -1: 3, the fraction mirrored to 1 */
    {-0.125, 0, 0, 0.5}, /* trunc(-0.5) is 0, its fraction 0.5 */
    {-1.375, 0, 3, 1.5}, /* trunc(-5.5) mod 4 = -1 */
    {0, 0.5, 10, 10},
    {0, 0.25, 0, 5},
    {0.125, 0.25, 0, 5.5},
    {0, 1, 10, 0},
    {0x1p80, 0, 0, 0}, /* a whole number of turns */
    {NAN, 0.5, 10, 10},
    {INFINITY, -INFINITY, 0, 0},
};

START_TEST(texels_are_fetched)
{
    const struct fetch *f = &fetches[_i];
    struct image *image = numbered(4, 2);
    struct texture t = {.image = image, .linear = false};
    ck_assert_double_eq_tol(texture_fetch(&t, f->u, f->v).x * 255, f->nearest, 1e-12);
    t.linear = true;
    ck_assert_double_eq_tol(texture_fetch(&t, f->u, f->v).x * 255, f->linear, 1e-12);
    image_free(image);
}
END_TEST

START_TEST(any_coordinate_will_do)
{
    static const double odd[] = {0,
                                 -0.0,
                                 1,
                                 -1,
                                 1e-320,
                                 -1e-320,
                                 1e300,
                                 -1e300,
                                 1e19,
                                 -1e19,
                                 0.999999999999999999,
                                 0x1p62,
                                 -0x1p62,
                                 INFINITY,
                                 -INFINITY,
                                 NAN};
    enum { N = sizeof odd / sizeof *odd };
    struct image *image = numbered(3, 5);
    struct texture t = {.image = image, .linear = true};
    for (int i = 0; i < N * N; i++) {
        struct vec3 c = texture_fetch(&t, odd[i % N], odd[i / N]);
        ck_assert(c.x >= 0 && c.x <= 1);
    }
    image_free(image);
}
END_TEST

START_TEST(sixteen_bits_keep_their_precision)
{
    uint16_t data[6] = {257, 0, 65535, 1, 2, 3};
    struct image image = {.width = 2, .height = 1, .data16 = data};
    struct texture t = {.image = &image, .linear = false};
    ck_assert(texture_fetch(&t, 0, 0).x == 257 / 65535.0);
    ck_assert(texture_fetch(&t, 0, 0).z == 1);
    ck_assert(texture_fetch(&t, 0.5, 0).y == 2 / 65535.0);
}
END_TEST

static struct vec2 uv_at(struct scene *s, struct vec3 p)
{
    struct surface surface = {.prim_count = 1};
    struct hit hit = {.prim = 0};
    return surface_uv(s, &surface, &hit, p);
}

START_TEST(spheres_have_coordinates)
{
    struct scene s = {0};
    geometry_add_sphere(&s.geometry, 0, vec3(1, 2, 3), 2);
    struct vec2 uv = uv_at(&s, vec3(3, 2, 3));
    ck_assert(uv.x == 0 && uv.y == -0.5);
    uv = uv_at(&s, vec3(1, 2, 5));
    ck_assert_double_eq_tol(uv.x, 0.25, 1e-15);
    uv = uv_at(&s, vec3(-1, 2, 3));
    ck_assert_double_eq_tol(uv.x, 0.5, 1e-15);
    uv = uv_at(&s, vec3(1, 2, 1));
    ck_assert_double_eq_tol(uv.x, 0.75, 1e-15);
    uv = uv_at(&s, vec3(1, 4, 3));
    ck_assert(uv.x == 0 && uv.y == 0);
    uv = uv_at(&s, vec3(1, 0, 3));
    ck_assert(uv.x == 0 && uv.y == -1);
    uv = uv_at(&s, vec3(1, 4.0000000001, 3)); /* above the pole by a rounding error */
    ck_assert(uv.y == 0);
    scene_free(&s);
}
END_TEST

START_TEST(cylinders_have_coordinates)
{
    struct scene s = {0};
    geometry_add_cylinder(&s.geometry, 0, vec3(1, 0, 0), vec3(1, 4, 0), 1);
    struct vec2 uv = uv_at(&s, vec3(1, 1, 1));
    ck_assert(uv.x == 0 && uv.y == 0.25);
    uv = uv_at(&s, vec3(1, 5, -1));
    ck_assert(uv.x == -0.5 && uv.y == 1);
    uv = uv_at(&s, vec3(1 + sqrt(0.5), 3, sqrt(0.5)));
    ck_assert_double_eq_tol(uv.x, -0.125, 1e-15);
    ck_assert(uv.y == 0.75);
    scene_free(&s);
}
END_TEST

START_TEST(lying_cylinders_have_coordinates)
{
    struct scene s = {0};
    geometry_add_cylinder(&s.geometry, 0, vec3(0, 0, 0), vec3(2, 0, 0), 1);
    struct vec2 uv = uv_at(&s, vec3(1, 0, -1)); /* (0, 1, 0) x e = -z, so z = 1, x = 0 */
    ck_assert(uv.x == 0 && uv.y == 0.5);
    uv = uv_at(&s, vec3(2, sqrt(0.5), -sqrt(0.5)));
    ck_assert_double_eq_tol(uv.x, -0.125, 1e-15);
    scene_free(&s);
}
END_TEST

START_TEST(triangles_mix_their_coordinates)
{
    struct scene s = {0};
    static const struct vec2 uvs[6] = {{0, 0}, {0, 0}, {0, 0}, {1, 2}, {3, 2}, {1, 8}};
    struct surface surface = {.prim_count = 2, .uvs = uvs};
    struct hit hit = {.prim = 1, .b1 = 0.25, .b2 = 0.5};
    for (int i = 0; i < 3; i++)
        geometry_add_vertex(&s.geometry, vec3(i == 1, i == 2, 0));
    geometry_add_triangle(&s.geometry, 0, 0, 1, 2);
    geometry_add_triangle(&s.geometry, 0, 0, 1, 2);
    struct vec2 uv = surface_uv(&s, &surface, &hit, vec3(0, 0, 0));
    ck_assert(uv.x == 1.5 && uv.y == 5);
    scene_free(&s);
}
END_TEST

START_TEST(light_grids_merge_equal_points)
{
    struct light l = {.kind = LIGHT_AREA};
    uint32_t v[4];
    static const double at[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int i = 0; i < 4; i++)
        v[i] = geometry_add_vertex(&l.object, vec3(at[i][0], 5, at[i][1]));
    geometry_add_triangle(&l.object, 0, v[0], v[1], v[2]);
    geometry_add_triangle(&l.object, 0, v[2], v[3], v[0]);
    light_sample_grid(&l, geometry_bounds(&l.object), 5);
    ck_assert_uint_eq(l.points.n, 25);
    for (size_t i = 0; i < l.points.n; i++)
        ck_assert(l.points.at[i].count == 5 && l.points.at[i].on_object);
    geometry_free(&l.object);
    vec_free(&l.points);
}
END_TEST

START_TEST(light_grids_know_their_sphere)
{
    struct light l = {.kind = LIGHT_AREA};
    geometry_add_sphere(&l.object, 0, vec3(5, 5, -5), 1.25);
    light_sample_grid(&l, geometry_bounds(&l.object), 5);
    ck_assert_uint_eq(l.points.n, 125);
    int on = 0, inside = 0;
    for (size_t i = 0; i < l.points.n; i++) {
        on += l.points.at[i].on_object;
        inside += l.points.at[i].inside;
    }
    ck_assert_int_eq(on, 6);
    ck_assert_int_eq(inside, 27);
    geometry_free(&l.object);
    vec_free(&l.points);
}
END_TEST

Suite *texture_suite(void)
{
    Suite *s = suite_create("texture");
    TCase *c = tcase_create("texture");
    tcase_add_loop_test(c, texels_are_fetched, 0, sizeof fetches / sizeof *fetches);
    tcase_add_test(c, any_coordinate_will_do);
    tcase_add_test(c, sixteen_bits_keep_their_precision);
    tcase_add_test(c, spheres_have_coordinates);
    tcase_add_test(c, cylinders_have_coordinates);
    tcase_add_test(c, lying_cylinders_have_coordinates);
    tcase_add_test(c, triangles_mix_their_coordinates);
    tcase_add_test(c, light_grids_merge_equal_points);
    tcase_add_test(c, light_grids_know_their_sphere);
    suite_add_tcase(s, c);
    return s;
}
