/* Affine maps: exact quarter turns, the order of turns, products. */
#include "config.h"

#include "load.h"
#include "unit.h"

#include "math/transform.h"

static const struct {
    double angle, sine, cosine;
} quarters[] = {{0, 0, 1},    {90, 1, 0},   {180, 0, -1}, {270, -1, 0},
                {360, 0, 1},  {-90, -1, 0}, {450, 1, 0},  {360.0 * 1e9 + 180, 0, -1},
                {-180, 0, -1}};

START_TEST(quarter_turns_are_exact)
{
    ck_assert(sin_degrees(quarters[_i].angle) == quarters[_i].sine);
    ck_assert(cos_degrees(quarters[_i].angle) == quarters[_i].cosine);
}
END_TEST

START_TEST(angles_follow_libm)
{
    for (double a = -800; a < 800; a += 0.37) {
        ck_assert_double_eq_tol(sin_degrees(a), sin(a * PI / 180), 1e-14);
        ck_assert_double_eq_tol(cos_degrees(a), cos(a * PI / 180), 1e-14);
    }
}
END_TEST

/* Where a map takes a point. */
static const struct {
    struct vec3 scale, rotate, translate, point, image;
} images[] = {
    {{1, 1, 1}, {90, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{1, 1, 1}, {0, 90, 0}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}},
    {{1, 1, 1}, {0, 0, 90}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
    {{1, 1, 1}, {90, 90, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, /* x first: y to z, then z to x */
    {{1, 1, 1}, {0, 90, 90}, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}}, /* y before z */
    {{2, 3, 4}, {0, 0, 90}, {10, 20, 30}, {1, 1, 1}, {7, 22, 34}},
    {{-1, 1, 1}, {0, 0, 0}, {0, 0, 0}, {1, 2, 3}, {-1, 2, 3}},
};

START_TEST(scale_then_rotate_then_translate)
{
    struct affine t = affine_translation(images[_i].translate);
    struct affine r = affine_rotation(images[_i].rotate);
    struct affine s = affine_scaling(images[_i].scale);
    struct affine rs = affine_times(&r, &s), all = affine_times(&t, &rs);
    struct vec3 p = affine_point(&all, images[_i].point);
    ck_assert(p.x == images[_i].image.x && p.y == images[_i].image.y && p.z == images[_i].image.z);
    struct vec3 v = affine_vector(&all, images[_i].point);
    ck_assert(p.x == v.x + images[_i].translate.x);
    struct vec3 f = images[_i].scale;
    ck_assert_double_eq(affine_determinant(&all), f.x * f.y * f.z);
}
END_TEST

START_TEST(turning_about_an_axis)
{
    struct vec3 x = vec3_rotate(vec3(1, 2, 3), vec3(5, 0, 0), 90);
    ck_assert(x.x == 1 && x.y == -3 && x.z == 2);
    struct vec3 y = vec3_rotate(vec3(1, 2, 3), vec3(1, 1, 1), 120);
    ck_assert_double_eq_tol(y.x, 3, 1e-14);
    ck_assert_double_eq_tol(y.y, 1, 1e-14);
    ck_assert_double_eq_tol(y.z, 2, 1e-14);
}
END_TEST

Suite *transform_suite(void)
{
    Suite *s = suite_create("transform");
    TCase *t = tcase_create("affine");
    tcase_add_loop_test(t, quarter_turns_are_exact, 0, COUNT(quarters));
    tcase_add_test(t, angles_follow_libm);
    tcase_add_loop_test(t, scale_then_rotate_then_translate, 0, COUNT(images));
    tcase_add_test(t, turning_about_an_axis);
    suite_add_tcase(s, t);
    return s;
}
