/* OBJ, PLY and STL files, and which format a file is in.  (OFF: test_mesh.c.) */
#include "config.h"

#include "base/mem.h"
#include "scene/mesh.h"

#include "reading.h"
#include "unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct mesh *parse(struct reading *r, const char *name, const char *text)
{
    reading_init(r, name, text, strlen(text));
    return mesh_parse(r->source, &r->diag);
}

static void check_faces(const struct mesh *m, const char *wanted)
{
    char got[1000] = "";
    for (size_t i = 0; i < m->faces.n; i++)
        sprintf(got + strlen(got), "%s%u %u %u", i ? ", " : "", m->faces.at[i].at[0],
                m->faces.at[i].at[1], m->faces.at[i].at[2]);
    ck_assert_str_eq(got, wanted);
}

static void check_point(struct vec3 p, double x, double y, double z)
{
    ck_assert_msg(p.x == x && p.y == y && p.z == z, "(%.17g %.17g %.17g)", p.x, p.y, p.z);
}

/* ---- what is read ---------------------------------------------------------------------------- */

#define OBJ_POINTS "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
#define PLY_HEADER(vertices, faces)                                          \
    "ply\nformat ascii 1.0\nelement vertex " vertices "\nproperty float x\n" \
    "property float y\nproperty float z\nelement face " faces "\n"           \
    "property list uchar int vertex_indices\nend_header\n"
#define PLY_POINTS "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
#define FACET(a, b, c)                                                                            \
    "facet normal 0 0 0\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet" \
    "\n"

static const struct {
    const char *name, *text;
    size_t points;
    const char *faces;
} good[] = {
    /* OBJ */
    {"m", OBJ_POINTS "f 1 2 3\nf 1 3 4\n", 4, "0 1 2, 0 2 3"},
    {"m", OBJ_POINTS "f 1 2 3 4", 4, "0 1 2, 0 2 3"},
    {"m", OBJ_POINTS "fo 1 2 3", 4, "0 1 2"},
    {"m", OBJ_POINTS "f -4 -3 -2\nv 7 7 7\nf -1 -2 -3", 5, "0 1 2, 4 3 2"},
    {"m", "f 1 2 3\n" OBJ_POINTS, 4, "0 1 2"},
    {"m", OBJ_POINTS "f 1 2 \\\n 3 \\\r\n 4\\\n", 4, "0 1 2, 0 2 3"},
    {"m", "# head\\\n\n\tv 0 0 0 # a\r\nv 1 0 0\r\nv 0 1 0 1.0\r\nf 1\t2  3 #c\r\n", 3, "0 1 2"},
    {"m", "o a\ng b c\nv 0 0 0 1 0 0\nv 1 0 0 .5 .5 .5 1\nv 0 1 0\nf 3 2 1\n", 3, "2 1 0"},
    {"m", OBJ_POINTS "f 1 1 1\n", 4, "0 0 0"},
    {"m", "\xEF\xBB\xBFv 0 0 0\nf 1 1 1", 1, "0 0 0"},
    {"m.OBJ", "# nothing but a name\nbogus\n", 0, ""},
    {"m.off", OBJ_POINTS "f 1 2 3\n", 4, "0 1 2"},
    {"m", "v 1 2 3\n", 1, ""},
    /* PLY */
    {"m", PLY_HEADER("4", "2") PLY_POINTS "3 0 1 2\n4 0 1 2 3\n", 4, "0 1 2, 0 1 2, 0 2 3"},
    {"m", PLY_HEADER("4", "1") "\n" PLY_POINTS "\n3 0 1 2", 4, "0 1 2"},
    {"m.stl", PLY_HEADER("4", "0") PLY_POINTS, 4, ""},
    {"m",
     "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nobj_info 1\r\nelement face 1\r\n"
     "property uchar red\r\nproperty list uint8 uint32 vertex_index\r\n"
     "property list int float weights\r\nelement vertex 3\r\nproperty double z\r\n"
     "property float64 y\r\nproperty int16 flags\r\nproperty double x\r\nend_header\r\n"
     "255 3 2 1 0 2 .5 .5\r\n0 0 9 0\r\n0 0 9 1\r\n0 1 9 0\r\n",
     3, "2 1 0"},
    {"m",
     "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
     "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
     "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n12 0 1 2 3 -1 4 3 2 -1 0 -1 1\n",
     5, "0 1 2, 2 1 3, 4 3 2"},
    /* STL */
    {"m", "solid\n" FACET("0 0 0", "1 0 0", "0 1 0") FACET("0 1 0", "1 0 0", "1 1 0") "endsolid", 4,
     "0 1 2, 2 1 3"},
    {"m", "SOLID a facet\n" FACET("-0 0 0", "0 -0 0", "0 0 0") "endsolid a facet\n", 1, "0 0 0"},
    {"m",
     "solid a\n" FACET("0 0 0", "1 0 0", "0 1 0") "endsolid a\nsolid b\n"
                                                  "facet outer loop vertex 0 0 0 vertex 0 1 0 "
                                                  "vertex 1 0 0 endloop endfacet endsolid b\n",
     3, "0 1 2, 0 2 1"},
    {"m",
     "solid\nfacet normal nan nan nan outer loop\nvertex 1 2 3\nvertex 1 2 3.0\n"
     "vertex 1 2 4\nendloop\nendfacet\nendsolid\n",
     2, "0 0 1"},
    {"m", "solid empty\nendsolid empty\n", 0, ""},
};

START_TEST(mesh_is_read)
{
    struct reading r;
    struct mesh *m = parse(&r, good[_i].name, good[_i].text);
    ck_assert_msg(m && r.diag.errors == 0, "%s",
                  r.diag.entries.n ? r.diag.entries.at[0]->message : "no mesh");
    ck_assert_uint_eq(m->points.n, good[_i].points);
    check_faces(m, good[_i].faces);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

static const struct {
    const char *text;
} spellings[] = {
    {"v 1.00000000001 -.1 +123456789.123456789e-3\nf 1 1 1\n"},
    {PLY_HEADER("1", "1") "1.00000000001 -.1 +123456789.123456789e-3\n3 0 0 0\n"},
    {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float z\nproperty float x\n"
     "property float x\nproperty float y\nend_header\n123456789.123456789e-3 1.00000000001 9 -.1"},
    {"solid\nfacet outer loop\nvertex 1.00000000001 -.1 +123456789.123456789e-3\n"
     "vertex 0 0 0 vertex 0 0 0 endloop endfacet endsolid"},
};

START_TEST(coordinates_are_nearest_doubles)
{
    struct reading r;
    struct mesh *m = parse(&r, "m", spellings[_i].text);
    ck_assert_ptr_nonnull(m);
    check_point(m->points.at[0], 1.00000000001, -.1, 123456789.123456789e-3);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

/* ---- texture coordinates and normals --------------------------------------------------------- */

static void check_uvs(const struct mesh *m, const double *wanted, size_t n)
{
    ck_assert_uint_eq(m->uvs.n, n);
    for (size_t i = 0; i < n; i++)
        ck_assert_msg(m->uvs.at[i].x == wanted[2 * i] && m->uvs.at[i].y == wanted[2 * i + 1],
                      "%zu: %g %g", i, m->uvs.at[i].x, m->uvs.at[i].y);
}

START_TEST(obj_has_uvs_and_normals)
{
    static const double uvs[] = {.1, .2, .3, .4, .5, 0, .1, .2, .5, 0, .1, .2};
    struct reading r;
    struct mesh *m = parse(&r, "m",
                           OBJ_POINTS "vt .1 .2\nvt .3 .4 9\nvt .5\nvn 0 0 2\nvn 3 0 4\n"
                                      "f 1/1/1 2/2/2 3/-1/-1 4/1/1\n");
    ck_assert_ptr_nonnull(m);
    check_uvs(m, uvs, 6);
    ck_assert_uint_eq(m->bare_faces, 0);
    ck_assert_uint_eq(m->normals.n, 2);
    check_point(m->normals.at[0], 0, 0, 1);
    ck_assert(fabs(m->normals.at[1].x - .6) < 1e-15 && fabs(m->normals.at[1].z - .8) < 1e-15);
    ck_assert_uint_eq(m->normal_corners.n, 2);
    ck_assert_uint_eq(m->normal_corners.at[0].at[1], 1);
    ck_assert_uint_eq(m->normal_corners.at[1].at[2], 0);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

START_TEST(obj_faces_may_lack_them)
{
    static const double uvs[] = {0, 0, 0, 0, 0, 0, 7, 8, 7, 8, 7, 8, 0, 0, 0, 0, 0, 0};
    struct reading r;
    struct mesh *m = parse(&r, "m",
                           OBJ_POINTS "vt 7 8\nvn 1 0 0\nf 1//1 2//1 3//1\n"
                                      "f 1/1 2/1 3/1\nf 4 3 2\n");
    ck_assert_ptr_nonnull(m);
    check_uvs(m, uvs, 9);
    ck_assert_uint_eq(m->bare_faces, 2);
    ck_assert(str_is(srcmap_text(&r.map, m->bare), "1//1 2//1 3//1"));
    ck_assert_uint_eq(m->normal_corners.n, 3);
    ck_assert_uint_eq(m->normal_corners.at[0].at[0], 0);
    ck_assert_uint_eq(m->normal_corners.at[1].at[0], MESH_NO_INDEX);
    ck_assert_uint_eq(m->normal_corners.at[2].at[2], MESH_NO_INDEX);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

START_TEST(obj_without_uses_has_none)
{
    struct reading r;
    struct mesh *m = parse(&r, "m", OBJ_POINTS "vt 7 8\nvn 1 0 0\nf 1 2 3\n");
    ck_assert_ptr_nonnull(m);
    ck_assert(m->uvs.n == 0 && m->normals.n == 0 && m->normal_corners.n == 0 && !m->bare_faces);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

#define PLY_FULL(face_uvs)                                                          \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n" \
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"   \
    "property float s\nproperty float t\nelement face 2\n"                          \
    "property list uchar int vertex_indices\n" face_uvs "end_header\n"              \
    "0 0 0 0 0 3 .1 .2\n1 0 0 0 2 0 .3 .4\n0 1 0 0 0 0 .5 .6\n"

START_TEST(ply_vertices_have_uvs_and_normals)
{
    static const double uvs[] = {.1, .2, .3, .4, .5, .6, .5, .6, .3, .4, .1, .2};
    struct reading r;
    struct mesh *m = parse(&r, "m", PLY_FULL("") "3 0 1 2\n3 2 1 0\n");
    ck_assert_ptr_nonnull(m);
    check_uvs(m, uvs, 6);
    check_point(m->normals.at[0], 0, 0, 1);
    check_point(m->normals.at[1], 0, 1, 0);
    check_point(m->normals.at[2], 0, 0, 0);
    ck_assert_uint_eq(m->normal_corners.at[1].at[0], 2);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

/* A face's own texture coordinates win over its vertices'. */
START_TEST(ply_faces_have_uvs)
{
    static const double uvs[] = {0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6};
    struct reading r;
    struct mesh *m = parse(
        &r, "m",
        PLY_FULL("property list uchar float texcoord\n") "3 0 1 2 0\n3 2 1 0 6 1 2 3 4 5 6\n");
    ck_assert_ptr_nonnull(m);
    check_uvs(m, uvs, 6);
    ck_assert_uint_eq(m->bare_faces, 1);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

/* ---- damage ---------------------------------------------------------------------------------- */

static const struct {
    const char *name, *text;
    enum diag_code code;
    const char *place, *message;
} damaged[] = {
    {"m", "", DIAG_MESH_FORMAT, "", "empty"},
    {"m.obj", "# nothing\n", DIAG_MESH_FORMAT, "", "empty"},
    {"m", "hello\n", DIAG_MESH_FORMAT, "hello", "neither the content nor the name"},
    {"m.obj", "#VRML V2.0 utf8\n", DIAG_MESH_FORMAT, "#VRML", "VRML files are not read"},
    {"m.ply", "hello\n", DIAG_MESH_SYNTAX, "hello", "expected 'ply'"},
    {"m.stl", "hello\n", DIAG_MESH_SYNTAX, "", "neither a text nor a binary STL"},
    {"m.obj", "\x01\x02\n", DIAG_MESH_SYNTAX, "\x01\x02", "a statement of an OBJ file"},
    /* OBJ */
    {"m", "v 1 2\n", DIAG_MESH_SYNTAX, "", "the line ends before a coordinate of a vertex"},
    {"m", "v 1 2", DIAG_MESH_SYNTAX, "", "the file ends before a coordinate"},
    {"m", "v 1 2 x\n", DIAG_MESH_SYNTAX, "x", "a coordinate of a vertex, found 'x'"},
    {"m", "v 1 2 3 4 5 6 7 8 9\n", DIAG_MESH_SYNTAX, "9", "the end of the line"},
    {"m", "v 1 nan 3\n", DIAG_MESH_SYNTAX, "nan", "a coordinate"},
    {"m", "v 1 1e999 3\n", DIAG_NOT_FINITE, "1e999", "too large"},
    {"m", "vt\n", DIAG_MESH_SYNTAX, "", "a texture coordinate"},
    {"m", "vn 1 2 3 4\n", DIAG_MESH_SYNTAX, "4", "the end of the line"},
    {"m", OBJ_POINTS "f 1 2\n", DIAG_MESH_SYNTAX, "1 2", "at least 3 corners, not 2"},
    {"m", OBJ_POINTS "f\n", DIAG_MESH_SYNTAX, "", "at least 3 corners, not 0"},
    {"m", OBJ_POINTS "f 1 2 5\n", DIAG_MESH_INDEX, "5", "there is no vertex 5"},
    {"m", OBJ_POINTS "f 1 2 0\n", DIAG_MESH_INDEX, "0", "there is no vertex 0"},
    {"m", OBJ_POINTS "f 1 2 -5\n", DIAG_MESH_INDEX, "-5", "there is no vertex -5"},
    {"m", OBJ_POINTS "f 1 2 99999999999999999999\n", DIAG_MESH_INDEX, "99999999999999999999",
     "no vertex"},
    {"m", OBJ_POINTS "f 1 2 4294967296\n", DIAG_MESH_INDEX, "4294967296", "no vertex"},
    {"m", OBJ_POINTS "vt 0 0\nf 1/1 2/1 3/2\n", DIAG_MESH_INDEX, "2", "no texture coordinates 2"},
    {"m", OBJ_POINTS "vn 0 0 1\nf 1//1 2//1 3//-2\n", DIAG_MESH_INDEX, "-2", "no normal -2"},
    {"m", OBJ_POINTS "vt 0 0\nf 1/1 2/1 3\n", DIAG_MESH_SYNTAX, "3", "all be of one form"},
    {"m", OBJ_POINTS "vn 0 0 1\nf 1//1 2 3\n", DIAG_MESH_SYNTAX, "2", "all be of one form"},
    {"m", OBJ_POINTS "f 1/ 2/ 3/\n", DIAG_MESH_SYNTAX, "1/", "v, v/vt, v//vn or v/vt/vn"},
    {"m", OBJ_POINTS "f 1// 2// 3//\n", DIAG_MESH_SYNTAX, "1//", "a corner"},
    {"m", OBJ_POINTS "f 1/1/1/1 2 3\n", DIAG_MESH_SYNTAX, "1/1/1/1", "a corner"},
    {"m", OBJ_POINTS "f 1.5 2 3\n", DIAG_MESH_SYNTAX, "1.5", "a corner"},
    {"m", OBJ_POINTS "f 1 2 3\\x\n", DIAG_MESH_SYNTAX, "3\\x", "a corner"},
    {"m", OBJ_POINTS "f - 2 3\n", DIAG_MESH_SYNTAX, "-", "a corner"},
    /* PLY */
    {"m", "ply", DIAG_MESH_SYNTAX, "", "the file ends before 'element'"},
    {"m", "ply\nend_header\n", DIAG_MESH_SYNTAX, "end_header", "'format' before the end"},
    {"m", "ply x\n", DIAG_MESH_SYNTAX, "x", "the end of the line"},
    {"m", "ply\nformat text 1.0\n", DIAG_MESH_SYNTAX, "text", "'ascii'"},
    {"m", "ply\nformat ascii 2.0\n", DIAG_MESH_SYNTAX, "2.0", "version 1.0"},
    {"m", "ply\nformat ascii 1.0\nproperty float x\n", DIAG_MESH_SYNTAX, "float", "an element"},
    {"m", "ply\nformat ascii 1.0\nelement vertex x\n", DIAG_MESH_SYNTAX, "x", "number of an"},
    {"m", "ply\nformat ascii 1.0\nelement a 1\nelement a 2\n", DIAG_MESH_SYNTAX, "a 2",
     "two elements 'a'"},
    {"m", "ply\nformat ascii 1.0\nelement a 1\nproperty word x\n", DIAG_MESH_SYNTAX, "word",
     "a type"},
    {"m", "ply\nformat ascii 1.0\nelement a 1\nproperty list float int x\n", DIAG_MESH_SYNTAX,
     "float", "a whole number's type"},
    {"m", "ply\nformat ascii 1.0\nelement a 1\nproperty int\n", DIAG_MESH_SYNTAX, "",
     "the name of the property"},
    {"m", "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n1\n",
     DIAG_MESH_SYNTAX, "vertex 1", "has no property 'y'"},
    {"m", "ply\nformat ascii 1.0\nelement face 1\nproperty int x\nend_header\n1\n",
     DIAG_MESH_SYNTAX, "face 1", "has no list 'vertex_indices'"},
    {"m", PLY_HEADER("4000000000", "1") PLY_POINTS, DIAG_MESH_SYNTAX, "vertex 4000000000",
     "too short"},
    {"m", PLY_HEADER("4", "999999999999999999") PLY_POINTS, DIAG_MESH_SYNTAX,
     "face 999999999999999999", "too short"},
    {"m", PLY_HEADER("4", "1") PLY_POINTS "3 0 1 4\n", DIAG_MESH_INDEX, "4", "no vertex 4"},
    {"m", PLY_HEADER("4", "1") PLY_POINTS "3 0 1 -1\n", DIAG_MESH_INDEX, "-1", "no vertex -1"},
    {"m", PLY_HEADER("4", "1") PLY_POINTS "3 0 1 1.5\n", DIAG_MESH_INDEX, "1.5", "no vertex 1.5"},
    {"m", PLY_HEADER("4", "1") PLY_POINTS "3 0 1\n", DIAG_MESH_SYNTAX, "",
     "the line ends before 'vertex_indices' of face 1 of 1"},
    {"m", PLY_HEADER("4", "1") PLY_POINTS "3 0 1 2 3\n", DIAG_MESH_SYNTAX, "3",
     "the end of the line of face 1 of 1"},
    {"m", PLY_HEADER("4", "1") PLY_POINTS "2 0 1\n", DIAG_MESH_SYNTAX, "1", "has 2 corners"},
    {"m", PLY_HEADER("4", "1") PLY_POINTS "-3 0 1 2\n", DIAG_MESH_SYNTAX, "-3", "-3 items"},
    {"m", PLY_HEADER("4", "1") PLY_POINTS "4000000000 0 1 2\n", DIAG_MESH_SYNTAX, "",
     "the line ends"},
    {"m", PLY_HEADER("4", "1") PLY_POINTS "3 0 1 2\n3 0 1 2\n", DIAG_MESH_SYNTAX, "3",
     "the end of the file"},
    {"m", PLY_HEADER("1", "1") "0 0 x\n3 0 0 0\n", DIAG_MESH_SYNTAX, "x", "'z' of vertex 1 of 1"},
    {"m", PLY_HEADER("1", "1") "0 0 1e999\n3 0 0 0\n", DIAG_NOT_FINITE, "1e999", "too large"},
    {"m", PLY_FULL("property list uchar float texcoord\n") "3 0 1 2 5 1 2 3 4 5\n3 2 1 0 0\n",
     DIAG_MESH_SYNTAX, "5", "has 5 texture coordinates"},
    /* STL */
    {"m", "solid\n", DIAG_MESH_SYNTAX, "", "the file ends before 'endsolid'"},
    {"m", "solid\nfacets\n", DIAG_MESH_SYNTAX, "facets", "expected 'endsolid', found 'facets'"},
    {"m", "solid\nendsolid\nnoise\n", DIAG_MESH_SYNTAX, "noise", "expected 'solid'"},
    {"m", "solid\n" FACET("0 0", "1 0 0", "0 1 0"), DIAG_MESH_SYNTAX, "", "a coordinate"},
    {"m", "solid\n" FACET("0 0 nan", "1 0 0", "0 1 0"), DIAG_MESH_SYNTAX, "nan", "a coordinate"},
    {"m", "solid\n" FACET("0 0 1e999", "1 0 0", "0 1 0"), DIAG_NOT_FINITE, "1e999", "too large"},
    {"m", "solid\n" FACET("0 0 0", "1 0 0", "0 1 0\nvertex 1 1 1"), DIAG_MESH_SYNTAX, "vertex",
     "expected 'endloop'"},
};

START_TEST(damage_is_reported)
{
    struct reading r;
    ck_assert_ptr_null(parse(&r, damaged[_i].name, damaged[_i].text));
    check_error(&r, damaged[_i].code, damaged[_i].place, damaged[_i].message);
    reading_free(&r);
}
END_TEST

static const struct {
    const char *text;
    enum diag_code code;
    const char *place, *message;
} losses[] = {
    {OBJ_POINTS "mtllib a.mtl\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n", DIAG_MESH_UNUSED, "mtllib",
     "without effect: 3"},
    {OBJ_POINTS "s 1\nf 1 2 3\n", DIAG_MESH_UNUSED, "s", "smoothing"},
    {OBJ_POINTS "f 1 2 3\nl 1 2\np 1\\\n l 4\nl 3 4\n", DIAG_MESH_LEFT_OUT, "l", "left out"},
    {OBJ_POINTS "f 1 2 3\nvx 1 2\n", DIAG_MESH_LEFT_OUT, "vx", "does not have"},
    {"ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\nproperty int z\n"
     "end_header\n1 2 3\n",
     DIAG_MESH_LEFT_OUT, "vertex 1", "there are no faces"},
    {"ply\nformat ascii 1.0\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n"
     "element face 0\nproperty list int int vertex_index\nend_header\n0 0\n",
     DIAG_MESH_LEFT_OUT, "edge 1", "the elements 'edge'"},
};

START_TEST(losses_are_told)
{
    struct reading r;
    struct mesh *m = parse(&r, "m", losses[_i].text);
    ck_assert_ptr_nonnull(m);
    ck_assert_uint_eq(r.diag.errors, 0);
    check_error(&r, losses[_i].code, losses[_i].place, losses[_i].message);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

/* ---- binary ---------------------------------------------------------------------------------- */

/* All types, three points, a quad and a triangle. */
static struct blob ply_blob(bool big_endian)
{
    struct blob b = {.big_endian = big_endian};
    blob_text(&b, "ply\nformat binary_");
    blob_text(&b, big_endian ? "big_endian 1.0\n" : "little_endian 1.0\n");
    blob_text(&b, "element vertex 3\nproperty double x\nproperty float y\nproperty short z\n"
                  "property char a\nproperty uchar b\nproperty ushort c\nproperty int nx\n"
                  "property uint d\nproperty int ny\nproperty int8 nz\nelement face 2\n"
                  "property list ushort uchar vertex_indices\nproperty list char double w\n"
                  "end_header\n");
    for (int i = 0; i < 3; i++) {
        blob_double(&b, 0.1 + i);
        blob_float(&b, -2.5f * (float)i);
        blob_put(&b, (uint16_t)(-300 * i), 2);
        blob_put(&b, 0xFF, 1);
        blob_put(&b, 0xFF, 1);
        blob_put(&b, 0xFFFF, 2);
        blob_put(&b, 0, 4);
        blob_put(&b, 0xFFFFFFFF, 4);
        blob_put(&b, (uint32_t)-70000, 4);
        blob_put(&b, 0, 1);
    }
    static const uint8_t corners[] = {0, 1, 2, 1, 2, 1, 0};
    blob_put(&b, 4, 2);
    for (int i = 0; i < 4; i++)
        blob_put(&b, corners[i], 1);
    blob_put(&b, 1, 1);
    blob_double(&b, 7);
    blob_put(&b, 3, 2);
    for (int i = 4; i < 7; i++)
        blob_put(&b, corners[i], 1);
    blob_put(&b, 0, 1);
    return b;
}

START_TEST(binary_ply_is_read)
{
    struct blob b = ply_blob(_i);
    struct reading r;
    reading_init(&r, "m", b.bytes.at, b.bytes.n);
    struct mesh *m = mesh_parse(r.source, &r.diag);
    ck_assert_msg(m, "%s", r.diag.entries.n ? r.diag.entries.at[0]->message : "");
    check_point(m->points.at[0], 0.1, 0, 0);
    check_point(m->points.at[2], 2.1, -5, -600);
    check_point(m->normals.at[1], 0, -1, 0);
    check_faces(m, "0 1 2, 0 2 1, 2 1 0");
    mesh_free(m);
    reading_free(&r);
    vec_free(&b.bytes);
}
END_TEST

/* Four corners at three places. */
static struct blob stl_blob(const char *comment)
{
    static const float corners[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                       {0, 1, 0}, {1, 0, 0}, {0.1f, 1, -0.0f}};
    struct blob b = {0};
    blob_text(&b, comment);
    while (b.bytes.n < 80)
        vec_push(&b.bytes, ' ');
    blob_put(&b, 2, 4);
    for (int i = 0; i < 6; i++) {
        for (int k = 0; i % 3 == 0 && k < 3; k++)
            blob_float(&b, NAN);
        for (int k = 0; k < 3; k++)
            blob_float(&b, corners[i][k]);
        if (i % 3 == 2)
            blob_put(&b, 0xFFFF, 2);
    }
    return b;
}

START_TEST(binary_stl_is_read)
{
    static const char *const comments[] = {"", "solid of the other kind", "v 1 2 3\n"};
    struct blob b = stl_blob(comments[_i]);
    struct reading r;
    reading_init(&r, "m", b.bytes.at, b.bytes.n);
    struct mesh *m = mesh_parse(r.source, &r.diag);
    ck_assert_ptr_nonnull(m);
    ck_assert_uint_eq(m->points.n, 4);
    check_point(m->points.at[3], (double)0.1f, 1, 0);
    ck_assert(!signbit(m->points.at[3].z));
    check_faces(m, "0 1 2, 2 1 3");
    mesh_free(m);
    reading_free(&r);
    vec_free(&b.bytes);
}
END_TEST

START_TEST(binary_stl_counts_are_checked)
{
    struct blob b = stl_blob("");
    struct reading r;
    b.bytes.at[83] = 0x7F;
    reading_init(&r, "m.stl", b.bytes.at, b.bytes.n);
    ck_assert_ptr_null(mesh_parse(r.source, &r.diag));
    check_error(&r, DIAG_MESH_SYNTAX, "", "neither a text nor a binary STL");
    reading_free(&r);
    b.bytes.at[83] = 0;
    b.bytes.at[84 + 12 + 3] = 0x7F;       /* of the first coordinate: now 1.7e38 */
    b.bytes.at[84 + 12 + 2] = (char)0x80; /* infinite */
    reading_init(&r, "m.stl", b.bytes.at, b.bytes.n);
    ck_assert_ptr_null(mesh_parse(r.source, &r.diag));
    check_error(&r, DIAG_NOT_FINITE, "", "triangle 1 of this binary STL file is too large");
    reading_free(&r);
    vec_free(&b.bytes);
}
END_TEST

/* Many vertices through the table of equal ones. */
START_TEST(stl_vertices_are_merged)
{
    enum { SIDE = 60 };
    struct blob b = {0};
    blob_text(&b, "solid grid\n");
    for (int i = 0; i < SIDE * SIDE; i++) {
        char facet[200];
        sprintf(facet,
                "facet outer loop vertex %d %d 0 vertex %d %d 0 vertex %d %d 0 endloop endfacet\n",
                i / SIDE, i % SIDE, i / SIDE + 1, i % SIDE, i / SIDE, i % SIDE + 1);
        blob_text(&b, facet);
    }
    blob_text(&b, "endsolid\n");
    struct reading r;
    reading_init(&r, "m", b.bytes.at, b.bytes.n);
    struct mesh *m = mesh_parse(r.source, &r.diag);
    ck_assert_ptr_nonnull(m);
    ck_assert_uint_eq(m->points.n, (SIDE + 1) * (SIDE + 1) - 1);
    ck_assert_uint_eq(m->faces.n, SIDE * SIDE);
    for (int i = 0; i < SIDE * SIDE; i++)
        check_point(m->points.at[m->faces.at[i].at[1]], i / SIDE + 1, i % SIDE, 0);
    mesh_free(m);
    reading_free(&r);
    vec_free(&b.bytes);
}
END_TEST

/* ---- hostile bytes --------------------------------------------------------------------------- */

static struct blob sample(int i)
{
    static const char *const texts[] = {
        OBJ_POINTS
        "vt 0 1\nvn 0 0 1\ns off\nusemtl x\nf 1/1/1 2/1/1 -2/-1/-1 \\\n 4/1/1\nf 1 2 3\n",
        PLY_FULL("property list uchar float texcoord\n") "3 0 1 2 0\n3 2 1 0 6 1 2 3 4 5 6\n",
        "solid a\n" FACET("0 0 0", "1 0 0", "0 1 0") "endsolid a\n",
    };
    struct blob b = {0};
    if (i < COUNT(texts))
        blob_text(&b, texts[i]);
    else
        b = i == 3 ? stl_blob("x") : ply_blob(i == 4);
    return b;
}
enum { SAMPLES = 6 };

/* Whatever is wrong, there is a mesh or one error, and no more. */
static void try_bytes(const char *bytes, size_t n)
{
    static const char *const names[] = {"m.off", "m.obj", "m.ply", "m.stl"};
    for (int i = 0; i < COUNT(names); i++) {
        struct reading r;
        reading_init(&r, names[i], bytes, n);
        struct mesh *m = mesh_parse(r.source, &r.diag);
        ck_assert_uint_eq(r.diag.errors, m ? 0 : 1);
        for (size_t k = 0; m && k < 3 * m->faces.n; k++)
            ck_assert_uint_lt(m->faces.at[k / 3].at[k % 3], m->points.n);
        if (m && m->uvs.n)
            ck_assert_uint_eq(m->uvs.n, 3 * m->faces.n);
        if (m && m->normal_corners.n)
            ck_assert_uint_eq(m->normal_corners.n, m->faces.n);
        mesh_free(m);
        reading_free(&r);
    }
}

START_TEST(truncation_and_flips)
{
    static const char flips[] = {1, 2, 4, 16, 64, (char)0x80, (char)0xFF};
    struct blob b = sample(_i);
    for (size_t n = 0; n <= b.bytes.n; n++)
        try_bytes(b.bytes.at, n);
    for (size_t at = 0; at < b.bytes.n; at++) {
        for (int k = 0; k < COUNT(flips); k++) {
            b.bytes.at[at] ^= flips[k];
            try_bytes(b.bytes.at, b.bytes.n);
            b.bytes.at[at] ^= flips[k];
        }
    }
    vec_free(&b.bytes);
}
END_TEST

/* A binary body must end where the header says. */
START_TEST(binary_ends_matter)
{
    struct blob b = ply_blob(_i);
    size_t body = 0;
    while (memcmp(b.bytes.at + body, "end_header\n", 11) != 0)
        body++;
    for (size_t n = body + 11; n <= b.bytes.n + 1; n++) {
        struct reading r;
        vec_reserve(&b.bytes, 1);
        reading_init(&r, "m", b.bytes.at, n);
        struct mesh *m = mesh_parse(r.source, &r.diag);
        ck_assert_msg(!m == (n != b.bytes.n), "%zu of %zu bytes", n, b.bytes.n);
        mesh_free(m);
        reading_free(&r);
    }
    vec_free(&b.bytes);
}
END_TEST

Suite *formats_suite(void)
{
    Suite *s = suite_create("formats");
    TCase *c = tcase_create("formats");
    tcase_add_loop_test(c, mesh_is_read, 0, COUNT(good));
    tcase_add_loop_test(c, coordinates_are_nearest_doubles, 0, COUNT(spellings));
    tcase_add_test(c, obj_has_uvs_and_normals);
    tcase_add_test(c, obj_faces_may_lack_them);
    tcase_add_test(c, obj_without_uses_has_none);
    tcase_add_test(c, ply_vertices_have_uvs_and_normals);
    tcase_add_test(c, ply_faces_have_uvs);
    tcase_add_loop_test(c, damage_is_reported, 0, COUNT(damaged));
    tcase_add_loop_test(c, losses_are_told, 0, COUNT(losses));
    tcase_add_loop_test(c, binary_ply_is_read, 0, 2);
    tcase_add_loop_test(c, binary_stl_is_read, 0, 3);
    tcase_add_test(c, binary_stl_counts_are_checked);
    tcase_add_test(c, stl_vertices_are_merged);
    tcase_add_loop_test(c, truncation_and_flips, 0, SAMPLES);
    tcase_add_loop_test(c, binary_ends_matter, 0, 2);
    suite_add_tcase(s, c);
    return s;
}
