/* Descriptions to runtime scenes. */
#include "config.h"

#include "base/file.h"

#include "folder.h"
#include "load.h"
#include "unit.h"

#include <stdio.h>
#include <stdlib.h>

#define NATIVE               \
    "wrt 1\nmodel classic\n" \
    "camera { eye: (0, 0, 1)  back: (0, 0, 1)  up: (0, 1, 0)  yfov: 20  resolution: (8, 6) }\n"
#define WHITE "material: lambert { diffuse: 1 }"

static const char tetrahedron[] = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                                  "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
static const char uv_list[] = "0 0\n1 0\n0 1\n0 0\n1 0\n0 1\n0 0\n1 0\n0 1\n0 0\n1 0\n0 .5\n";

static struct folder folder;
static char scene_name[80];

/* A folder with a mesh, its UV list and a texture. */
static void set_up(void)
{
    folder_enter(&folder);
    snprintf(scene_name, sizeof scene_name, "%s/scene", folder.path);
    ck_assert_ptr_null(file_write("m.off", tetrahedron, sizeof tetrahedron - 1));
    ck_assert_ptr_null(file_write("uv.txt", uv_list, sizeof uv_list - 1));
    folder_add_picture("t.png");
}

static void tear_down(void)
{
    static const char *const names[] = {"m.off", "uv.txt", "t.png"};
    folder_leave(&folder, names, COUNT(names));
}

/* Without OpenMesh meshes are errors of their own. */
#ifdef HAVE_OPENMESH
enum { MESH_TESTS = 1 };
#else
enum { MESH_TESTS = 0 };
#endif

static bool without_meshes(const char *body)
{
    return !MESH_TESTS && strstr(body, "mesh {");
}

static const struct scene *lower(struct load *l, const char *body)
{
    char text[2000];
    snprintf(text, sizeof text, NATIVE "%s\n", body);
    ck_assert_msg(load_lower(l, scene_name, text), "%s: %s", body, load_first(l));
    return &l->lowered.scene;
}

static void check_vec3(struct vec3 v, double x, double y, double z)
{
    ck_assert_msg(v.x == x && v.y == y && v.z == z,
                  "(%.17g %.17g %.17g) is not (%.17g %.17g %.17g)", v.x, v.y, v.z, x, y, z);
}

START_TEST(metal_is_tinted)
{
    struct load l;
    const struct scene *s =
        lower(&l, "sphere { center: 0  radius: 1  material: metal { diffuse: (0.5, 0.25, 1)"
                  "  specular: (1, 2, 4)  exponent: 3  reflection: (0.5, 9, 9) } }");
    const struct material *m = &s->materials.at[0];
    ck_assert_int_eq(m->kind, MATERIAL_METAL);
    check_vec3(m->diffuse, 0.5, 0.25, 1);
    check_vec3(m->specular, 0.5, 0.5, 4);
    check_vec3(m->reflection, 0.25, 0.125, 0.5);
    load_free(&l);
}
END_TEST

START_TEST(other_materials_are_not)
{
    struct load l;
    const struct scene *s =
        lower(&l, "sphere { center: 0  radius: 1  material: shiny { diffuse: 0.5"
                  "  specular: 1  exponent: 3  reflection: (0.5, 0.6, 0.7) } }");
    check_vec3(s->materials.at[0].specular, 1, 1, 1);
    check_vec3(s->materials.at[0].reflection, 0.5, 0.6, 0.7);
    load_free(&l);
}
END_TEST

START_TEST(quad_is_two_triangles)
{
    static const uint32_t corner[6] = {0, 1, 2, 2, 3, 0};
    struct load l;
    const struct scene *s =
        lower(&l, "sphere { center: 0  radius: 1  " WHITE " }\n"
                  "quad { vertices: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]"
                  "  uvs: [(0.1, 0), (0.2, 0), (0.3, 1), (0.4, 1)]"
                  "  material: lambert { diffuse: 1  texture: image { file: \"t.png\" } } }");
    const struct surface *q = &s->surfaces.at[1];
    ck_assert(q->kind == SURFACE_QUAD && q->first_prim == 1 && q->prim_count == 2 && q->needs_uv);
    for (uint32_t i = 0; i < 6; i++) {
        const struct triangle *t = &s->geometry.triangles.at[i / 3];
        ck_assert_uint_eq(t->vertex[i % 3], corner[i]);
        ck_assert_double_eq(q->uvs[i].x,
                            0.1 * (corner[i] + 1) + (corner[i] == 2 ? 0.3 - 0.1 * 3 : 0));
    }
    for (uint32_t i = 0; i < s->geometry.prims.n; i++)
        ck_assert_uint_eq(s->geometry.prims.at[i].surface, i > 0);
    load_free(&l);
}
END_TEST

static const struct {
    const char *body;
    double base[3], axis[3], height;
} cylinders[] = {
    {"base: (1, 2, 3)  height: 2", {1, 2, 3}, {0, 1, 0}, 2},
    {"base: (1, 2, 3)  height: -2", {1, 2, 3}, {0, -1, 0}, 2},
    {"base: (1, 2, 3)  top: (1, 2, 7)", {1, 2, 3}, {0, 0, 1}, 4},
    {"base: (1, 2, 3)  top: (1, 2, 7)  height: 5", {1, 2, 3}, {0, 1, 0}, 5},
    {"base: (1, 2, 3)  top: (1, 2, 7)  height: 0", {1, 2, 3}, {0, 0, 1}, 4},
};

START_TEST(cylinder_forms)
{
    struct load l;
    char body[200];
    snprintf(body, sizeof body, "cylinder { %s  radius: 0.5  " WHITE " }", cylinders[_i].body);
    const struct cylinder *c = &lower(&l, body)->geometry.cylinders.at[0];
    const double *b = cylinders[_i].base, *a = cylinders[_i].axis;
    check_vec3(c->base, b[0], b[1], b[2]);
    check_vec3(c->axis, a[0], a[1], a[2]);
    ck_assert_double_eq(c->height, cylinders[_i].height);
    ck_assert_double_eq(c->radius, 0.5);
    load_free(&l);
}
END_TEST

/* The boxes that the grids of light objects span, with the original's oddities. */
static const struct {
    const char *object;
    double lo[3], hi[3];
} boxes[] = {
    {"shape: sphere  size: 2  position: (1, 2, 3)", {0, 1, 2}, {2, 3, 4}},
    {"shape: quad  size: 2  position: (1, 2, 3)", {0, 2, 2}, {2, 2, 4}},
    {"object: sphere { center: (1, 2, 3)  radius: 0.5 }", {0.5, 1.5, 2.5}, {1.5, 2.5, 3.5}},
    {"object: triangle { vertices: [(1, 2, 3), (4, 2, 3), (1, 6, 9)] }", {1, 2, 3}, {4, 6, 9}},
    {"object: quad { vertices: [(1, 2, 3), (4, 2, 3), (4, 6, 3), (1, 6, 3)] }",
     {1, 2, 3},
     {4, 6, 3}},
    {"object: cylinder { base: (1, 2, 3)  height: 4  radius: 0.5 }", {0.5, 2, 2.5}, {1.5, 6, 3.5}},
    /* with a top: widened by the radius, but by the height along y */
    {"object: cylinder { base: (1, 2, 3)  top: (1, 2, 7)  radius: 0.5 }",
     {0.5, 1.5, 2.5},
     {1.5, 6, 7.5}},
    {"object: cylinder { base: (1, 2, 3)  top: (1, 6, 3)  radius: 0.5 }",
     {0.5, 1.5, 2.5},
     {1.5, 10, 3.5}},
    /* a mesh: and the world's origin */
    {"object: mesh { file: \"m.off\"  position: (2, 3, 4)  scale: 2 }", {0, 0, 0}, {4, 5, 6}},
    {"object: mesh { file: \"m.off\"  position: -0.5 }", {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}},
};

START_TEST(light_grids)
{
    enum { SAMPLES = 3 };
    struct load l;
    char body[300];
    snprintf(body, sizeof body, "light area { %s }", boxes[_i].object);
    if (without_meshes(body))
        return;
    const struct light *light = &lower(&l, body)->lights.at[0];
    struct box box = {light->points.at[0].position, light->points.at[0].position};
    uint32_t count = 0;
    for (size_t i = 0; i < light->points.n; i++) {
        box = box_add(box, light->points.at[i].position);
        count += light->points.at[i].count;
    }
    ck_assert_uint_eq(count, SAMPLES * SAMPLES * SAMPLES);
    check_vec3(box.lo, boxes[_i].lo[0], boxes[_i].lo[1], boxes[_i].lo[2]);
    check_vec3(box.hi, boxes[_i].hi[0], boxes[_i].hi[1], boxes[_i].hi[2]);
    ck_assert_uint_eq(l.lowered.scene.geometry.prims.n, 0); /* no part of the scene */
    ck_assert_uint_eq(l.lowered.scene.surfaces.n, 0);
    load_free(&l);
}
END_TEST

START_TEST(light_samples)
{
    static const uint32_t given[] = {0, 1, 2, 3, 4, 7}, used[] = {3, 3, 3, 3, 4, 7};
    struct load l;
    char body[300];
    snprintf(body, sizeof body, "light area { shape: sphere  size: 1  samples: %u }", given[_i]);
    const struct light *light = &lower(&l, body)->lights.at[0];
    ck_assert_uint_eq(light->points.n, used[_i] * used[_i] * used[_i]);
    load_free(&l);
}
END_TEST

START_TEST(unused_things_are_left_out)
{
    struct load l;
    const struct scene *s = lower(
        &l, "texture none = image { file: \"missing.png\" }\n"
            "material spare = lambert { diffuse: 1  texture: none }\n"
            "sphere { center: 0  radius: 1  " WHITE " }\n"
            "mesh { file: \"m.off\"  uv_file: \"missing.txt\"  " WHITE " }\n"
            "triangle { vertices: [(0, 0), (1, 0), (0, 1)]  uvs: [(0, 0), (1, 0), (0, 1)]  " WHITE
            " }");
    ck_assert_uint_eq(s->textures.n, 0);
    ck_assert_uint_eq(s->images.n, 0);
    ck_assert_uint_eq(s->materials.n, 3);
    for (size_t i = 0; i < s->surfaces.n; i++)
        ck_assert(!s->surfaces.at[i].needs_uv && !s->surfaces.at[i].uvs);
    ck_assert_uint_eq(s->skipped.n, 3);
    ck_assert_str_eq(s->skipped.at[0], "texture missing.png");
    ck_assert_str_eq(s->skipped.at[1], "material spare");
    ck_assert_str_eq(s->skipped.at[2], "uv_file missing.txt");
    load_free(&l);
}
END_TEST

START_TEST(files_are_read_once)
{
    struct load l;
    const struct scene *s = lower(
        &l, "texture a = image { file: \"t.png\" }\n"
            "texture b = image { file: \"t.png\"  filter: nearest }\n"
            "material m = lambert { diffuse: 1  texture: a }\n"
            "sphere { center: 0  radius: 1  material: m }\n"
            "sphere { center: 1  radius: 1  material: m  normal_map: a }\n"
            "sphere { center: 2  radius: 1  material: m  normal_map: b }\n"
            "mesh { file: \"m.off\"  " WHITE " }\nmesh { file: \"m.off\"  scale: 2  " WHITE " }");
    ck_assert_uint_eq(s->images.n, 1);
    ck_assert_uint_eq(s->textures.n, 2);
    ck_assert_ptr_eq(s->textures.at[0].image, s->textures.at[1].image);
    ck_assert(s->textures.at[0].linear && !s->textures.at[1].linear);
    ck_assert_uint_eq(s->surfaces.at[1].normal_map, s->materials.at[0].texture);
    ck_assert_uint_eq(s->surfaces.at[0].material, s->surfaces.at[2].material);
    ck_assert_uint_eq(l.lowered.meshes.n, 1);
    ck_assert_uint_eq(s->geometry.vertices.n, 8);
    load_free(&l);
}
END_TEST

START_TEST(mesh_is_scaled_then_moved)
{
    struct load l;
    const struct scene *s =
        lower(&l, "mesh { file: \"m.off\"  position: (10, 20, 30)  scale: (2, -3, 4)"
                  "  smooth: false  flip_normals: true  uv_file: \"uv.txt\""
                  "  normal_map: image { file: \"t.png\" }  " WHITE " }");
    const struct surface *m = &s->surfaces.at[0];
    check_vec3(s->geometry.vertices.at[0], 10, 20, 30);
    check_vec3(s->geometry.vertices.at[1], 12, 20, 30);
    check_vec3(s->geometry.vertices.at[2], 10, 17, 30);
    check_vec3(s->geometry.vertices.at[3], 10, 20, 34);
    ck_assert(m->flip && !m->normals && m->needs_uv && m->prim_count == 4);
    ck_assert_double_eq(m->uvs[11].y, 0.5);
    load_free(&l);
}
END_TEST

START_TEST(normals_are_shown)
{
    struct load l;
    const struct scene *s = lower(&l, "mesh { file: \"m.off\"  show_normals: 0.5  " WHITE " }");
    ck_assert_uint_eq(s->surfaces.n, 2);
    const struct surface *mesh = &s->surfaces.at[0], *shown = &s->surfaces.at[1];
    ck_assert_ptr_nonnull(mesh->normals);
    ck_assert(shown->kind == SURFACE_CYLINDER && shown->prim_count == 4 && shown->first_prim == 4);
    check_vec3(s->materials.at[shown->material].diffuse, 1, 1, 1);
    for (uint32_t i = 0; i < 4; i++) {
        const struct cylinder *c = &s->geometry.cylinders.at[i];
        struct vec3 v = s->geometry.vertices.at[i];
        check_vec3(c->base, v.x, v.y, v.z);
        ck_assert_double_eq_tol(c->height, 0.5, 1e-15);
        ck_assert_double_eq_tol(c->radius, 0.05, 1e-15);
        ck_assert_double_eq_tol(vec3_dot(c->axis, mesh->normals[i]), 1, 1e-15);
        ck_assert_uint_eq(s->geometry.prims.at[4 + i].surface, 1);
    }
    load_free(&l);
}
END_TEST

static const struct {
    const char *body;
    enum diag_code code;
} failures[] = {
    {"sphere { center: 0  radius: 1  material: lambert { diffuse: 1  texture: image { file: "
     "\"none.png\" } } }",
     DIAG_FILE_MISSING},
    {"sphere { center: 0  radius: 1  material: lambert { diffuse: 1  texture: image { file: "
     "\"m.off\" } } }",
     DIAG_TEXTURE_DAMAGED},
    {"mesh { file: \"none.off\"  " WHITE " }", DIAG_FILE_MISSING},
    {"mesh { file: \"t.png\"  " WHITE " }", DIAG_MESH_FORMAT},
    {"mesh { file: \"m.off\"  scale: 1e308  position: 1e308  " WHITE " }", DIAG_NOT_FINITE},
    {"cylinder { base: (0, 1e20, 0)  height: 1  radius: 1  " WHITE " }", DIAG_DEGENERATE},
    {"mesh { file: \"m.off\"  uv_file: \"m.off\"  normal_map: image { file: \"t.png\" }  " WHITE
     " }",
     DIAG_MESH_SYNTAX},
};

START_TEST(files_that_fail)
{
    struct load l;
    char text[1000];
    snprintf(text, sizeof text, NATIVE "%s\n", failures[_i].body);
    if (without_meshes(text))
        return;
    ck_assert(!load_lower(&l, scene_name, text));
    ck_assert_uint_eq(l.diag.entries.n, 1);
    ck_assert_msg(l.diag.entries.at[0]->code == failures[_i].code, "%s", load_first(&l));
    ck_assert(span_known(l.diag.entries.at[0]->span));
    load_free(&l);
}
END_TEST

/* ---- places ---------------------------------------------------------------------------------- */

static const struct scene *lower_at(struct load *l, const struct affine *place, const char *body)
{
    char text[4000];
    snprintf(text, sizeof text, NATIVE "%s\n", body);
    ck_assert_msg(load_lower_placed(l, scene_name, text, place), "%s: %s", body, load_first(l));
    return &l->lowered.scene;
}

static void check_near(struct vec3 v, double x, double y, double z)
{
    ck_assert_msg(vec3_largest(vec3_sub(v, vec3(x, y, z))) < 1e-14,
                  "(%.17g %.17g %.17g) is not (%.17g %.17g %.17g)", v.x, v.y, v.z, x, y, z);
}

/* A quarter turn about z, twice as large, moved. */
static const struct affine even = {{{0, -2, 0, 10}, {2, 0, 0, 20}, {0, 0, 2, 30}}};
static const struct affine grown = {{{2, 0, 0, 10}, {0, 2, 0, 20}, {0, 0, 2, 30}}};
static const struct affine uneven = {{{1, 0, 0, 10}, {0, 2, 0, 20}, {0, 0, 3, 30}}};
static const struct affine mirror = {{{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
static const struct affine flat = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {1, 1, 0, 0}}};

#define TEXTURED "material: lambert { diffuse: 1  texture: image { file: \"t.png\" } }"

START_TEST(round_things_stay_round)
{
    struct load l;
    const struct scene *s =
        lower_at(&l, &even,
                 "sphere { center: (1, 2, 3)  radius: 0.5  " WHITE " }\n"
                 "cylinder { base: (1, 2, 3)  height: 4  radius: 0.5  " WHITE " }\n"
                 "triangle { vertices: [(1, 0, 0), (0, 1, 0), (0, 0, 1)]  " WHITE " }\n"
                 "light point { position: (1, 2, 3) }\nlight area { position: (1, 2, 3)  shape: "
                 "sphere  size: 1 }");
    ck_assert_uint_eq(s->geometry.instances.n, 0);
    check_vec3(s->geometry.spheres.at[0].center, 6, 22, 36);
    ck_assert_double_eq(s->geometry.spheres.at[0].radius, 1);
    const struct cylinder *c = &s->geometry.cylinders.at[0];
    check_vec3(c->base, 6, 22, 36);
    check_vec3(c->axis, -1, 0, 0);
    ck_assert_double_eq(c->height, 8);
    ck_assert_double_eq(c->radius, 1);
    check_vec3(s->geometry.vertices.at[0], 10, 22, 30);
    ck_assert(!s->surfaces.at[2].flip);
    check_vec3(s->lights.at[0].position, 6, 22, 36);
    check_vec3(s->lights.at[1].object.spheres.at[0].center, 6, 22, 36);
    ck_assert_double_eq(s->lights.at[1].object.spheres.at[0].radius, 1);
    load_free(&l);
}
END_TEST

START_TEST(others_become_instances)
{
    struct load l;
    const struct scene *s =
        lower_at(&l, &uneven,
                 "sphere { center: (1, 2, 3)  radius: 0.5  " WHITE " }\n"
                 "cylinder { base: (1, 2, 3)  height: 4  radius: 0.5  " WHITE " }\n"
                 "light area { position: (1, 2, 3)  shape: sphere  size: 1 }");
    const struct geometry *g = &s->geometry;
    ck_assert(g->instances.n == 2 && g->prims.n == 2 && g->spheres.n == 0);
    check_vec3(g->instances.at[0].box.lo, 10.5, 23, 37.5);
    check_vec3(g->instances.at[0].box.hi, 11.5, 25, 40.5);
    check_near(g->instances.at[1].box.lo, 10.5, 24, 37.5);
    check_near(g->instances.at[1].box.hi, 11.5, 32, 40.5);
    ck_assert_uint_eq(g->prims.at[1].surface, 1);
    check_vec3(geometry_bounds(&s->lights.at[0].object).lo, 10.5, 23, 37.5);
    load_free(&l);
}
END_TEST

/* Texture coordinates turn with what they are on. */
START_TEST(textures_turn_along)
{
    struct load l;
    const char *body = "sphere { center: (1, 2, 3)  radius: 0.5  " TEXTURED " }\n"
                       "cylinder { base: (1, 2, 3)  height: 4  radius: 0.5  " TEXTURED " }";
    ck_assert_uint_eq(lower_at(&l, &grown, body)->geometry.instances.n, 0);
    load_free(&l);
    const struct scene *s = lower_at(&l, &even, body);
    ck_assert_uint_eq(s->geometry.instances.n, 2);
    for (uint32_t i = 0; i < 2; i++) {
        struct hit hit = {.prim = i, .part = CYLINDER_SIDE};
        struct vec3 p = affine_point(&even, vec3(1.3, i ? 5 : 2.4, 3));
        struct vec2 uv = surface_uv(s, &s->surfaces.at[i], &hit, p);
        struct geometry plain = {0};
        geometry_add_sphere(&plain, 0, vec3(1, 2, 3), 0.5);
        geometry_add_cylinder(&plain, 1, vec3(1, 2, 3), vec3(1, 6, 3), 0.5);
        struct scene other = {.geometry = plain};
        struct vec2 wanted =
            surface_uv(&other, &s->surfaces.at[i], &hit, vec3(1.3, i ? 5 : 2.4, 3));
        ck_assert_double_eq_tol(uv.x, wanted.x, 1e-14);
        ck_assert_double_eq_tol(uv.y, wanted.y, 1e-14);
        geometry_free(&plain);
    }
    load_free(&l);
}
END_TEST

/* What was lit stays lit: corners run the other way round in a mirror. */
START_TEST(mirrors_keep_sides)
{
    struct load l;
    const struct scene *s =
        lower_at(&l, &mirror,
                 "triangle { vertices: [(0, 0, 0), (1, 0, 0), (0, 1, 0)]  " WHITE " }\n"
                 "sphere { center: (1, 2, 3)  radius: 0.5  " WHITE " }");
    struct hit hit = {.prim = 0};
    struct vec3 geometric = s->geometry.triangles.at[0].normal;
    check_vec3(geometric, 0, 0, -1);
    check_vec3(surface_normal(s, &s->surfaces.at[0], &hit, geometric), -0.0, -0.0, 1);
    ck_assert(!s->surfaces.at[1].flip);
    check_vec3(s->geometry.spheres.at[0].center, -1, 2, 3);
    load_free(&l);
}
END_TEST

static struct vec3 corner_normal(const struct surface *s, uint32_t vertex)
{
    return vec3_scale(s->normals[vertex], s->flip ? -1 : 1);
}

/* Normals are those of the mesh as it is in the file, and turned by the place like planes. */
START_TEST(mesh_normals_turn_like_planes)
{
    struct load l;
    double third = 1 / sqrt(3);
    const struct scene *s = lower_at(&l, &uneven, "mesh { file: \"m.off\"  " WHITE " }");
    struct vec3 n = vec3(-third, -third / 2, -third / 3);
    n = vec3_normalize(n);
    check_near(corner_normal(&s->surfaces.at[0], 0), n.x, n.y, n.z);
    check_vec3(s->geometry.vertices.at[3], 10, 20, 33);
    load_free(&l);
    s = lower_at(&l, &mirror, "mesh { file: \"m.off\"  " WHITE " }");
    check_near(corner_normal(&s->surfaces.at[0], 0), third, -third, -third);
    load_free(&l);
    /* classic: after the mesh's own scale, which turns normals as the original's did */
    s = lower_at(&l, NULL, "mesh { file: \"m.off\"  scale: (-1, 1, 1)  " WHITE " }");
    check_near(corner_normal(&s->surfaces.at[0], 0), -third, third, third);
    load_free(&l);
}
END_TEST

enum { MANY = 20000 }; /* surfaces: more than 65536 / 4 copies of a tetrahedron */

static char *many_meshes(const char *each)
{
    static const char head[] = NATIVE "material m = lambert { diffuse: 1 }\n";
    size_t n = strlen(each), size = sizeof head + MANY / 2 * n;
    char *text = mem_alloc(size, 1);
    strcpy(text, head);
    for (size_t i = 0; i < MANY / 2; i++)
        memcpy(text + sizeof head - 1 + i * n, each, n + 1);
    return text;
}

START_TEST(many_uses_share_one_mesh)
{
    struct load l;
    char *text = many_meshes("mesh{file:\"m.off\" position:1 scale:3 material:m}\n"
                             "mesh{file:\"m.off\" position:(5,6,7) scale:2 material:m}\n");
    ck_assert(load_lower_placed(&l, scene_name, text, &uneven));
    const struct geometry *g = &l.lowered.scene.geometry;
    ck_assert_uint_eq(g->instances.n, MANY);
    ck_assert_uint_eq(g->prims.n, MANY);
    ck_assert_uint_eq(g->vertices.n, 0);
    ck_assert_uint_eq(g->prototypes.n, 2);
    ck_assert_uint_eq(g->prototypes.at[1]->shapes.triangles.n, 4);
    const struct surface *first = &l.lowered.scene.surfaces.at[0];
    ck_assert_ptr_eq(first->normals, l.lowered.scene.surfaces.at[MANY - 1].normals);
    ck_assert_uint_eq(g->prims.at[7].surface, 7);
    check_vec3(g->instances.at[7].box.lo, 15, 32, 51);
    check_vec3(g->instances.at[7].box.hi, 17, 36, 57);
    struct hit hit = {.prim = 7, .part = 3}; /* at the first corner */
    double third = 1 / sqrt(3);
    struct vec3 n = surface_normal(&l.lowered.scene, first, &hit, vec3_all(0));
    struct vec3 wanted = vec3_normalize(vec3(third, (third - 1) / 2, (third - 1) / 3));
    check_near(n, wanted.x, wanted.y, wanted.z);
    load_free(&l);
    free(text);
}
END_TEST

/* A use more or less must not change how a mesh looks. */
START_TEST(copies_look_like_instances)
{
    struct load one, many;
    const char *each = "mesh{file:\"m.off\" position:1 scale:(1,-2,3) material:m}\n"
                       "mesh{file:\"m.off\" position:2 scale:(1,-2,3) material:m}\n";
    static const struct affine skewed = {{{-1, 0.5, 0, 1}, {0, 2, 0, 2}, {0.2, 0, 3, 3}}};
    char *text = many_meshes(each);
    const struct scene *copy = lower_at(
        &one, &skewed, "mesh { file: \"m.off\"  position: 1  scale: (1, -2, 3)  " WHITE " }");
    ck_assert(load_lower_placed(&many, scene_name, text, &skewed));
    const struct scene *shared = &many.lowered.scene;
    ck_assert(shared->geometry.instances.n == MANY && copy->geometry.instances.n == 0);
    for (uint32_t face = 0; face < 4; face++) {
        for (int k = 0; k < 36; k++) {
            struct hit a = {.prim = face, .b1 = k % 6 / 10.0, .b2 = k / 6 / 10.0}, b = a;
            b.prim = 0;
            b.part = face;
            struct vec3 n = surface_normal(copy, &copy->surfaces.at[0], &a, vec3_all(0));
            struct vec3 m = surface_normal(shared, &shared->surfaces.at[0], &b, vec3_all(0));
            check_near(n, m.x, m.y, m.z);
        }
    }
    load_free(&one);
    load_free(&many);
    free(text);
}
END_TEST

static const struct {
    const char *body;
    const struct affine *place;
    enum diag_code code;
    const char *message;
} displaced[] = {
    {"sphere { center: 0  radius: 1  " WHITE " }", &flat, DIAG_DEGENERATE, "flatten it"},
    {"mesh { file: \"m.off\"  " WHITE " }", &flat, DIAG_DEGENERATE, "flatten it"},
    {"light point { position: 1 }", &flat, DIAG_DEGENERATE, "flatten it"},
    {"light area { shape: quad  size: 1 }", &flat, DIAG_DEGENERATE, "flatten it"},
    {"sphere { center: 1e308  radius: 1  " WHITE " }", &even, DIAG_NOT_FINITE, "too large"},
    {"sphere { center: 1e308  radius: 1  " WHITE " }", &uneven, DIAG_DEGENERATE, "too large"},
    {"sphere { center: 1  radius: 1e308  " WHITE " }", &even, DIAG_DEGENERATE, "too large"},
    {"triangle { vertices: [(1e308, 0, 0), (0, 1, 0), (0, 0, 1)]  " WHITE " }", &even,
     DIAG_NOT_FINITE, "too large"},
    {"cylinder { base: (1, 1e16, 1)  height: 1  radius: 1  " WHITE " }", &uneven, DIAG_DEGENERATE,
     "lost in rounding"},
    {"cylinder { base: 1e308  height: 1e300  radius: 1  " WHITE " }", &even, DIAG_NOT_FINITE,
     "too large"},
};

START_TEST(places_that_fail)
{
    struct load l;
    char text[1000];
    snprintf(text, sizeof text, NATIVE "%s\n", displaced[_i].body);
    if (without_meshes(text))
        return;
    ck_assert(!load_lower_placed(&l, scene_name, text, displaced[_i].place));
    ck_assert_uint_eq(l.diag.entries.n, 1);
    ck_assert_msg(l.diag.entries.at[0]->code == displaced[_i].code &&
                      strstr(load_first(&l), displaced[_i].message),
                  "%s", load_first(&l));
    load_free(&l);
}
END_TEST

Suite *lower_suite(void)
{
    Suite *s = suite_create("lower");
    TCase *t = tcase_create("scenes");
    tcase_add_checked_fixture(t, set_up, tear_down);
    tcase_add_test(t, metal_is_tinted);
    tcase_add_test(t, other_materials_are_not);
    tcase_add_test(t, quad_is_two_triangles);
    tcase_add_loop_test(t, cylinder_forms, 0, COUNT(cylinders));
    tcase_add_loop_test(t, light_grids, 0, COUNT(boxes));
    tcase_add_loop_test(t, light_samples, 0, 6);
    tcase_add_loop_test(t, unused_things_are_left_out, 0, MESH_TESTS);
    tcase_add_loop_test(t, files_are_read_once, 0, MESH_TESTS);
    tcase_add_loop_test(t, mesh_is_scaled_then_moved, 0, MESH_TESTS);
    tcase_add_loop_test(t, normals_are_shown, 0, MESH_TESTS);
    tcase_add_loop_test(t, files_that_fail, 0, COUNT(failures));
    tcase_add_test(t, round_things_stay_round);
    tcase_add_test(t, others_become_instances);
    tcase_add_test(t, textures_turn_along);
    tcase_add_test(t, mirrors_keep_sides);
    tcase_add_loop_test(t, mesh_normals_turn_like_planes, 0, MESH_TESTS);
    tcase_add_loop_test(t, many_uses_share_one_mesh, 0, MESH_TESTS);
    tcase_add_loop_test(t, copies_look_like_instances, 0, MESH_TESTS);
    tcase_add_loop_test(t, places_that_fail, 0, COUNT(displaced));
    suite_add_tcase(s, t);
    return s;
}
