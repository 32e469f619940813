/* What the checks of scenes rest on: the view, nearness, what is inside what. */
#include "config.h"

#include "unit.h"

#define TRIES_SEED 11
#include "tries.h"

#include "folder.h"
#include "lint/frustum.h"
#include "lint/nearby.h"
#include "lint/survey.h"
#include "load.h"

#include <stdio.h>

/* ---- the view -------------------------------------------------------------------------------- */

static struct camera random_camera(void)
{
    struct camera c = {.origin = random_vector(5),
                       .back = random_direction(),
                       .up = random_direction(),
                       .width = 1 + below(2000),
                       .height = 1 + below(2000),
                       .compatible = below(2) > 0,
                       .modern = below(2) > 0};
    c.yfov = c.modern ? uniform(1, 170) : uniform(0.01, 89) * fmin(c.height / (double)c.width, 1);
    if (c.modern && below(3) == 0)
        c.yfov = 0, c.view_height = uniform(0.1, 9);
    return c;
}

/* A box around a point that a ray of the picture passes is beyond no side, and has its share. */
START_TEST(what_rays_meet_is_in_view)
{
    for (int i = 0; i < TRIES(50000); i++) {
        struct camera c = random_camera();
        struct frustum f = frustum_of(&c);
        double x = uniform(-1, 1), y = uniform(-1, 1);
        struct vec3 p =
            vec3_mad(lens_origin(&f.lens, x, y), uniform(0, 20), lens_direction(&f.lens, x, y));
        struct box b = {vec3_sub(p, vec3_all(uniform(0, 1))), vec3_add(p, vec3_all(uniform(0, 1)))};
        ck_assert_uint_eq(frustum_beyond(&f, b), 0);
        ck_assert(frustum_share(&f, b) > 0);
    }
}
END_TEST

/* As the picture shows them: x is to the right of somebody who looks along z. */
START_TEST(sides_are_told_apart)
{
    struct camera c = {.back = {0, 0, 1},
                       .up = {0, 1, 0},
                       .yfov = 90,
                       .width = 100,
                       .height = 100,
                       .modern = true};
    static const struct {
        struct vec3 at;
        unsigned sides;
    } places[] = {
        {{0, 0, -5}, 0},
        {{9, 0, -5}, 1u << FRUSTUM_LEFT},
        {{-9, 0, -5}, 1u << FRUSTUM_RIGHT},
        {{0, -9, -5}, 1u << FRUSTUM_BELOW},
        {{0, 9, -5}, 1u << FRUSTUM_ABOVE},
        {{-9, 9, -5}, 1u << FRUSTUM_RIGHT | 1u << FRUSTUM_ABOVE},
        {{5.05, 0, -5}, 0}, /* within the pixel beside the picture */
    };
    struct frustum f = frustum_of(&c);
    for (int i = 0; i < COUNT(places); i++) {
        struct box b = {places[i].at, places[i].at};
        ck_assert_uint_eq(frustum_beyond(&f, b), places[i].sides);
    }
    struct box behind = {{0, 0, 1}, {0, 0, 1}};
    ck_assert_uint_ne(frustum_beyond(&f, behind) & 1u << FRUSTUM_EYE, 0);
    struct box quarter = {{0, 0, -5}, {5, 5, -5}};
    ck_assert(fabs(frustum_share(&f, quarter) - 0.25) < 1e-3);
}
END_TEST

/* ---- nearness -------------------------------------------------------------------------------- */

static void add_random_prim(struct geometry *g, uint32_t number)
{
    struct vec3 p = random_vector(10);
    if (number % 3 == 0)
        geometry_add_sphere(g, number, p, uniform(0.1, 2));
    if (number % 3 == 1)
        geometry_add_cylinder(g, number, p, vec3_add(p, random_direction()), uniform(0.1, 2));
    if (number % 3 == 2) {
        uint32_t v = geometry_add_vertex(g, p);
        geometry_add_vertex(g, vec3_add(p, random_vector(2)));
        geometry_add_vertex(g, vec3_add(p, random_vector(2)));
        geometry_add_triangle(g, number, v, v + 1, v + 2);
    }
}

/* A point at a known distance from one primitive: hit points moved along the normal, which nothing
 * is nearer to. */
START_TEST(distances_are_right)
{
    struct geometry g = {0};
    struct accel a;
    for (uint32_t i = 0; i < 300; i++)
        add_random_prim(&g, i);
    accel_build(&a, &g, false);
    for (int i = 0; i < TRIES(20000); i++) {
        struct ray ray = {.origin = random_vector(20),
                          .direction = random_direction(),
                          .t_max = RAY_UNBOUNDED,
                          .from = PRIM_NONE,
                          .surface = below(300)};
        struct hit hit;
        struct vec3 normal;
        if (!accel_closest(&a, &ray, &hit))
            continue;
        struct vec3 p = geometry_hit_point(&g, &ray, &hit, &normal);
        double off = uniform(1e-6, 1);
        struct vec3 q = vec3_mad(p, off, normal);
        ck_assert_uint_eq(nearby_prim(&a, q, off * 1.0001, ray.surface), hit.prim);
        ck_assert_uint_eq(nearby_prim(&a, q, off * 0.9999, ray.surface), PRIM_NONE);
        ck_assert_uint_le(nearby_prim(&a, q, off * 1.0001, SURFACE_NONE), hit.prim);
        ck_assert(nearby_box(&a, q, off * 1.0001));
        q = vec3_mad(p, -off * 0.01, normal); /* inside, where another part may be nearer */
        ck_assert_uint_eq(nearby_prim(&a, q, off * 0.010001, ray.surface), hit.prim);
    }
    accel_free(&a);
    geometry_free(&g);
}
END_TEST

/* ---- inside ---------------------------------------------------------------------------------- */

#ifdef HAVE_OPENMESH
/* A tetrahedron as it is and inside out; copied, moved, mirrored. */
static const char *const solids[] = {
    "mesh { file: \"solid.off\"  material: lambert { diffuse: 1 } }\n",
    "mesh { file: \"turned.off\"  material: lambert { diffuse: 1 } }\n",
    "mesh { file: \"solid.off\"  flip_normals: true  material: lambert { diffuse: 1 } }\n",
    "group { scale: (-1, 1, 1)  translate: (1, 0, 0)  mesh { file: \"mirrored.off\"  material: "
    "lambert { diffuse: 1 } } }\n",
};

static void write_solid(const char *name, bool turned, bool mirrored)
{
    static const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    FILE *f = fopen(name, "w");
    ck_assert_ptr_nonnull(f);
    fprintf(f, "OFF\n4 4 0\n%s 0 0\n%s 0 0\n%s 1 0\n%s 0 1\n", mirrored ? "1" : "0",
            mirrored ? "0" : "1", mirrored ? "1" : "0", mirrored ? "1" : "0");
    for (int i = 0; i < 4; i++)
        fprintf(f, "3 %d %d %d\n", faces[i][0], faces[i][turned ? 2 : 1], faces[i][turned ? 1 : 2]);
    fclose(f);
}

START_TEST(closed_meshes_hold_what_is_inside)
{
    static const char *const names[] = {"solid.off", "turned.off", "mirrored.off"};
    struct folder folder;
    folder_enter(&folder);
    write_solid("solid.off", false, false);
    write_solid("turned.off", true, false);
    write_solid("mirrored.off", false, true);
    char text[1024];
    struct load l;
    snprintf(
        text, sizeof text,
        "wrt 1\nmodel modern\ncamera { eye: (0, 1, -4)  look_at: 0  fov: 54  resolution: (8, 8) "
        "}\n%s",
        solids[_i]);
    ck_assert(load_lower(&l, "in.wrt", text));
    struct survey *s = survey_new(&l.desc, &l.lowered);
    for (int i = 0; i < TRIES(3000); i++) {
        struct vec3 p = random_vector(1.1);
        double sum = p.x + p.y + p.z, gap = fmin(fmin(p.x, p.y), fmin(p.z, 1 - sum));
        uint32_t around[SURVEY_AROUND];
        if (fabs(gap) < 1e-6)
            continue;
        ck_assert_int_eq(survey_holds(s, 0, p), gap > 0);
        ck_assert_uint_eq(survey_around(s, p, around), gap > 0);
    }
    survey_free(s);
    load_free(&l);
    folder_leave(&folder, names, COUNT(names));
}
END_TEST
#endif

Suite *lint_suite(void)
{
    Suite *s = suite_create("lint");
    TCase *c = tcase_create("scenes");
    tcase_add_test(c, what_rays_meet_is_in_view);
    tcase_add_test(c, sides_are_told_apart);
    tcase_add_test(c, distances_are_right);
#ifdef HAVE_OPENMESH
    tcase_add_loop_test(c, closed_meshes_hold_what_is_inside, 0, COUNT(solids));
#endif
    suite_add_tcase(s, c);
    return s;
}
