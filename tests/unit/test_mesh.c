/* Mesh files, UV lists, vertex normals and the half-edge analysis. */
#include "config.h"

#include "base/mem.h"
#include "scene/mesh.h"

#include "reading.h"
#include "unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- text OFF -------------------------------------------------------------------------------- */

#define TRIANGLE "0 0 0\n1 0 0\n0 1 0\n"

static const struct {
    const char *text;
    size_t points, faces;
    uint32_t last[3]; /* face */
} good[] = {
    {"OFF\n3 1 0\n" TRIANGLE "3 0 1 2\n", 3, 1, {0, 1, 2}},
    {"OFF 3 1 0\n" TRIANGLE "3 2 1 0", 3, 1, {2, 1, 0}},
    {"OFF\n3 1\n" TRIANGLE "3 0 1 2\n", 3, 1, {0, 1, 2}},
    {"OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n", 3, 1, {0, 1, 2}},
    {"\xEF\xBB\xBFOFF\n3 1 0\n" TRIANGLE "3 0 1 2\n", 3, 1, {0, 1, 2}},
    {"# made by hand\n\n  OFF # plain\n# counts\n3 1 0 # three\n\n" TRIANGLE "\n3 0 1 2#c\n#end",
     3,
     1,
     {0, 1, 2}},
    {"OFF\n3 2 0\n" TRIANGLE "3 0 1 2 255 0 0\n3 0 2 1 0.5 0.5 0.5 1\n", 3, 2, {0, 2, 1}},
    {"OFF\n3 1 0\n0 0 0 1 0 0 0 1 0\n3 0 1 2\n", 3, 1, {0, 1, 2}},
    {"OFF\n3 1 0\n0\n0\n0 1 0 0 0\n1\n0\n3\n0 1\n2\n", 3, 1, {0, 1, 2}},
    {"OFF\n3 1 0\n" TRIANGLE "3 0 1.0 2e0\n", 3, 1, {0, 1, 2}},
    {"OFF\n5 1 0\n" TRIANGLE "2 2 0\n3 1 0\n5 0 1 2 3 4\n", 5, 3, {0, 3, 4}},
    {"OFF\n4 2 0\n" TRIANGLE "1 1 0\n4 0 1 3 2\n3 3 2 1\n", 4, 3, {3, 2, 1}},
    {"OFF\n3 1 0\n" TRIANGLE "3 1 1 1\n", 3, 1, {1, 1, 1}},
    {"OFF\n0 0 0\n", 0, 0, {0}},
    {"OFF\n3 0 0\n" TRIANGLE, 3, 0, {0}},
};

START_TEST(off_is_read)
{
    struct reading r;
    reading_init(&r, "test.off", good[_i].text, strlen(good[_i].text));
    struct mesh *m = mesh_parse(r.source, &r.diag);
    ck_assert_msg(m && r.diag.entries.n == 0, "%s",
                  r.diag.entries.n ? r.diag.entries.at[0]->message : "no mesh");
    ck_assert_uint_eq(m->points.n, good[_i].points);
    ck_assert_uint_eq(m->faces.n, good[_i].faces);
    if (m->faces.n)
        ck_assert_mem_eq(m->faces.at[m->faces.n - 1].at, good[_i].last, sizeof good[_i].last);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

START_TEST(off_coordinates_are_nearest_doubles)
{
    static const char text[] = "OFF\n1 0 0\n1.00000000001 -.1 +123456789.123456789e-3\n";
    struct reading r;
    reading_init(&r, "test.off", text, sizeof text - 1);
    struct mesh *m = mesh_parse(r.source, &r.diag);
    ck_assert_ptr_nonnull(m);
    ck_assert(m->points.at[0].x == 1.00000000001);
    ck_assert(m->points.at[0].y == -.1);
    ck_assert(m->points.at[0].z == 123456789.123456789e-3);
    mesh_free(m);
    reading_free(&r);
}
END_TEST

static const struct {
    const char *text;
    enum diag_code code;
    const char *place, *message;
} damaged[] = {
    {"", DIAG_MESH_FORMAT, "", "empty"},
    {"# nothing\n", DIAG_MESH_FORMAT, "", "empty"},
    {"hello", DIAG_MESH_FORMAT, "hello", "not an OFF file"},
    {"off\n", DIAG_MESH_FORMAT, "off", "not an OFF file"},
    {"3 1 0\n" TRIANGLE, DIAG_MESH_FORMAT, "3", "not an OFF file"},
    {"#VRML V2.0 utf8\n", DIAG_MESH_FORMAT, "#VRML", "VRML files"},
    {"COFF\n3 1 0\n", DIAG_MESH_FORMAT, "COFF", "COFF files are not read"},
    {"NOFF\n3 1 0\n", DIAG_MESH_FORMAT, "NOFF", "NOFF files"},
    {"STOFF\n3 1 0\n", DIAG_MESH_FORMAT, "STOFF", "STOFF files"},
    {"4OFF\n3 1 0\n", DIAG_MESH_FORMAT, "4OFF", "4OFF files"},
    {"nOFF\n3 1 0\n", DIAG_MESH_FORMAT, "nOFF", "nOFF files"},
    {"STCN4nOFF BINARY\n", DIAG_MESH_FORMAT, "STCN4nOFF", "STCN4nOFF files"},
    {"NCOFF\n", DIAG_MESH_FORMAT, "NCOFF", "not an OFF file"},
    {"OFF", DIAG_MESH_SYNTAX, "", "ends before the number of vertices"},
    {"OFF ASCII\n", DIAG_MESH_SYNTAX, "ASCII", "expected the number of vertices"},
    {"OFF\n3\n1\n0\n", DIAG_MESH_SYNTAX, "", "the line ends before the number of faces"},
    {"OFF\n-3 1 0\n", DIAG_MESH_SYNTAX, "-3", "number of vertices"},
    {"OFF\n3.5 1 0\n", DIAG_MESH_SYNTAX, "3.5", "number of vertices"},
    {"OFF\n3x 1 0\n", DIAG_MESH_SYNTAX, "3x", "number of vertices"},
    {"OFF\n3 nan 0\n", DIAG_MESH_SYNTAX, "nan", "number of faces"},
    {"OFF\n3 1 \\\n0\n" TRIANGLE "3 0 1 2\n", DIAG_MESH_SYNTAX, "\\", "number of edges"},
    {"OFF\n3 1 0 7\n" TRIANGLE "3 0 1 2\n", DIAG_MESH_SYNTAX, "7", "end of the line"},
    {"OFF\n4000000000 1 0\n" TRIANGLE, DIAG_MESH_SYNTAX, "4000000000 1", "too short"},
    {"OFF\n3 4000000000 0\n" TRIANGLE, DIAG_MESH_SYNTAX, "3 4000000000", "too short"},
    {"OFF\n999999999999999999 999999999999999999\n", DIAG_MESH_SYNTAX,
     "999999999999999999 999999999999999999", "too short"},
    {"OFF\n1e300 1 0\n", DIAG_MESH_SYNTAX, "1e300", "number of vertices"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n", DIAG_MESH_SYNTAX, "nan",
     "a coordinate of vertex 3 of 3, found 'nan'"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 0x1 0\n3 0 1 2\n", DIAG_MESH_SYNTAX, "0x1", "vertex 3"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1,5 0\n3 0 1 2\n", DIAG_MESH_SYNTAX, "1,5", "vertex 3"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1e400 0\n3 0 1 2\n", DIAG_NOT_FINITE, "1e400", "too large"},
    {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 \x01 0\n3 0 1 2\n", DIAG_MESH_SYNTAX, "\x01", "no text"},
    {"OFF\n3 1 0\n" TRIANGLE "2 0 1     \n", DIAG_MESH_SYNTAX, "2", "at least 3"},
    {"OFF\n3 1 0\n" TRIANGLE "0         \n", DIAG_MESH_SYNTAX, "0", "at least 3"},
    {"OFF\n3 1 0\n" TRIANGLE "-3 0 1 2\n", DIAG_MESH_SYNTAX, "-3", "corners of face 1 of 1"},
    {"OFF\n3 1 0\n" TRIANGLE "3 0 1 3\n", DIAG_MESH_INDEX, "3", "there is no vertex 3"},
    {"OFF\n3 1 0\n" TRIANGLE "3 0 -1 2\n", DIAG_MESH_INDEX, "-1", "there is no vertex -1"},
    {"OFF\n3 1 0\n" TRIANGLE "3 0 4294967296 2\n", DIAG_MESH_INDEX, "4294967296", "no vertex"},
    {"OFF\n0 1 0\n3 0 1 2\n", DIAG_MESH_INDEX, "0", "there is no vertex 0"},
    {"OFF\n3 1 0\n" TRIANGLE "3 0 1.5 2\n", DIAG_MESH_SYNTAX, "1.5", "a vertex number of face 1"},
    {"OFF\n3 1 0\n" TRIANGLE "9 0 1 2 0 1\n", DIAG_MESH_SYNTAX, "", "the file ends before"},
    {"OFF\n3 1 0\n" TRIANGLE "99999999999999999999 0 1 2", DIAG_MESH_SYNTAX, "99999999999999999999",
     "corners"},
    {"OFF\n3 1 0\n" TRIANGLE "3 0 1 2\n3 0 1 2\n", DIAG_MESH_SYNTAX, "3", "end of the file"},
    {"OFF\n3 1 0\n0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2\n", DIAG_MESH_INDEX, "9",
     "no vertex 9"},
};

START_TEST(off_damage_is_reported)
{
    struct reading r;
    reading_init(&r, "test.off", damaged[_i].text, strlen(damaged[_i].text));
    ck_assert_ptr_null(mesh_parse(r.source, &r.diag));
    check_error(&r, damaged[_i].code, damaged[_i].place, damaged[_i].message);
    reading_free(&r);
}
END_TEST

/* Numbers behind the vertices of a plain OFF file show up late; the report says where they began.
 */
START_TEST(off_crowded_vertex_is_pointed_to)
{
    static const char text[] = "OFF\n2 1 0\n0 0 0 7 8 9\n1 2 0 7 8 9\n3 0 1 0\n";
    struct reading r;
    reading_init(&r, "test.off", text, sizeof text - 1);
    ck_assert_ptr_null(mesh_parse(r.source, &r.diag));
    const struct diag_entry *e = r.diag.entries.at[0];
    ck_assert_uint_eq(e->labels.n, 1);
    ck_assert_uint_eq(e->labels.at[0].span.begin, r.source->base + 16);
    reading_free(&r);
}
END_TEST

/* Every byte of the text up to its last newline matters; none may lead astray. */
START_TEST(off_truncation_and_flips)
{
    static const char text[] = "OFF\n4 2 5\n0 0 0\n1 0 0\n0 1.5 -2e1\n1 1 0\n3 0 1 3\n4 0 1 3 2\n";
    static const char flips[] = {1, 2, 16, 64, (char)0x80};
    struct reading r;
    for (size_t n = 0; n < sizeof text - 2; n++) {
        reading_init(&r, "test.off", text, n);
        ck_assert_msg(!mesh_parse(r.source, &r.diag), "a mesh from %zu bytes", n);
        ck_assert_uint_eq(r.diag.errors, 1);
        reading_free(&r);
    }
    for (size_t at = 0; at < sizeof text - 1; at++) {
        for (int k = 0; k < COUNT(flips); k++) {
            char flipped[sizeof text];
            memcpy(flipped, text, sizeof text);
            flipped[at] ^= flips[k];
            reading_init(&r, "test.off", flipped, sizeof text - 1);
            struct mesh *m = mesh_parse(r.source, &r.diag);
            ck_assert_uint_eq(r.diag.errors, m ? 0 : 1);
            mesh_free(m);
            reading_free(&r);
        }
    }
}
END_TEST

/* ---- binary OFF ------------------------------------------------------------------------------ */

/* Four points, a triangle and a quad; `colours` as Geomview has it, one component for the first
 * face and four for the second. */
static struct blob blob_make(bool big_endian, bool colours)
{
    static const char header[] = "OFF BINARY\n";
    static const float points[] = {0, 0, 0, 1, 0, 0, 1, 1, 0.1f, -2.5f, 1, 1e30f};
    static const uint32_t triangle[] = {3, 1, 2, 3}, quad[] = {4, 0, 1, 2, 3};
    struct blob b = {.big_endian = big_endian};
    blob_text(&b, header);
    blob_put(&b, 4, 4);
    blob_put(&b, 2, 4);
    blob_put(&b, 5, 4);
    for (int i = 0; i < COUNT(points); i++)
        blob_float(&b, points[i]);
    for (int i = 0; i < COUNT(triangle); i++)
        blob_put(&b, triangle[i], 4);
    if (colours) {
        blob_put(&b, 1, 4);
        blob_put(&b, 7, 4);
    }
    for (int i = 0; i < COUNT(quad); i++)
        blob_put(&b, quad[i], 4);
    if (colours) {
        blob_put(&b, 4, 4);
        for (int i = 0; i < 4; i++)
            blob_float(&b, 0.5f);
    }
    return b;
}

START_TEST(binary_off_is_read)
{
    static const struct triangle_corners wanted[] = {{{1, 2, 3}}, {{0, 1, 2}}, {{0, 2, 3}}};
    struct blob b = blob_make(_i & 1, _i & 2);
    struct reading r;
    reading_init(&r, "test.off", b.bytes.at, b.bytes.n);
    struct mesh *m = mesh_parse(r.source, &r.diag);
    ck_assert_ptr_nonnull(m);
    ck_assert_uint_eq(m->points.n, 4);
    ck_assert(m->points.at[3].x == -2.5);
    ck_assert(m->points.at[2].z == (double)0.1f);
    ck_assert_uint_eq(m->faces.n, COUNT(wanted));
    ck_assert_mem_eq(m->faces.at, wanted, sizeof wanted);
    mesh_free(m);
    reading_free(&r);
    vec_free(&b.bytes);
}
END_TEST

START_TEST(binary_off_damage_is_reported)
{
    struct blob b = blob_make(_i & 1, _i & 2);
    struct reading r;
    for (size_t n = 11; n < b.bytes.n; n++) {
        reading_init(&r, "test.off", b.bytes.at, n);
        ck_assert_msg(!mesh_parse(r.source, &r.diag), "a mesh from %zu bytes", n);
        check_error(&r, DIAG_MESH_SYNTAX, "BINARY", "damaged or ends early");
        reading_free(&r);
    }
    for (size_t at = 11; at < b.bytes.n; at++) {
        b.bytes.at[at] = (char)~b.bytes.at[at];
        reading_init(&r, "test.off", b.bytes.at, b.bytes.n);
        struct mesh *m = mesh_parse(r.source, &r.diag);
        ck_assert_uint_eq(r.diag.errors, m ? 0 : 1);
        mesh_free(m);
        reading_free(&r);
        b.bytes.at[at] = (char)~b.bytes.at[at];
    }
    vec_free(&b.bytes);
}
END_TEST

/* ---- UV lists -------------------------------------------------------------------------------- */

static const struct {
    const char *text;
    size_t faces;
    enum diag_code code; /* DIAG_CODES: read */
    const char *place, *message;
} uvs[] = {
    {"0 0\n1 0\n0.5 1\n", 1, DIAG_CODES, "", ""},
    {"\n 0 0 \r\n\n1\t0\n \n.5 1", 1, DIAG_CODES, "", ""},
    {"0 0\n1 0\n.5 1", 1, DIAG_CODES, "", ""},
    {"", 0, DIAG_CODES, "", ""},
    {"0 0\n1 0\n", 1, DIAG_UV_COUNT, "", "the UV list ends after at most 2 pairs"},
    {"0 0  \n1 0  \n", 1, DIAG_UV_COUNT, "", "the UV list ends after only 2 pairs"},
    {"", 1, DIAG_UV_COUNT, "", "ends after"},
    {"", SIZE_MAX, DIAG_UV_COUNT, "", "ends after"},
    {"0 0\n1 0\n.5 1\n7 7\n", 1, DIAG_UV_COUNT, "7 7", "more than the 3 pairs"},
    {"7 7\n", 0, DIAG_UV_COUNT, "7 7", "more than the 0 pairs"},
    {"0 0\n1 0 2\n.5 1\n", 1, DIAG_MESH_SYNTAX, "2", "a pair of numbers"},
    {"0 0\n1    \n.5 1\n", 1, DIAG_MESH_SYNTAX, NULL, "second number"},
    {"0 0\nu 1\n.5 1\n", 1, DIAG_MESH_SYNTAX, "u", "not a number"},
    {"0 0\n1 1x\n.5 1\n", 1, DIAG_MESH_SYNTAX, "1x", "not a number"},
    {"0 0\n1 nan\n.5 1\n", 1, DIAG_MESH_SYNTAX, "nan", "not a number"},
    {"0 0\n1 1e999\n.5 1\n", 1, DIAG_NOT_FINITE, "1e999", "too large"},
};

START_TEST(uv_list_is_read_or_refused)
{
    struct reading r;
    struct vec2 *out;
    reading_init(&r, "test.off", uvs[_i].text, strlen(uvs[_i].text));
    bool ok = uv_list_parse(r.source, uvs[_i].faces, &out, &r.diag);
    ck_assert_int_eq(ok, uvs[_i].code == DIAG_CODES);
    if (!ok) {
        ck_assert_ptr_null(out);
        if (uvs[_i].place)
            check_error(&r, uvs[_i].code, uvs[_i].place, uvs[_i].message);
    } else if (uvs[_i].faces) {
        ck_assert(out[0].x == 0 && out[0].y == 0 && out[1].x == 1 && out[1].y == 0);
        ck_assert(out[2].x == .5 && out[2].y == 1);
    }
    free(out);
    reading_free(&r);
}
END_TEST

/* ---- normals --------------------------------------------------------------------------------- */

static void check_near(struct vec3 a, struct vec3 b, double tolerance)
{
    ck_assert_msg(vec3_largest(vec3_sub(a, b)) <= tolerance, "(%g %g %g), not (%g %g %g)", a.x, a.y,
                  a.z, b.x, b.y, b.z);
}

/* The corners of a box by bits: x is 1, y is 2, z is 4; outward. */
static const struct triangle_corners box_faces[] = {
    {{0, 2, 3}}, {{0, 3, 1}}, {{4, 5, 7}}, {{4, 7, 6}}, {{0, 1, 5}}, {{0, 5, 4}},
    {{2, 6, 7}}, {{2, 7, 3}}, {{0, 4, 6}}, {{0, 6, 2}}, {{1, 3, 7}}, {{1, 7, 5}},
};

static void box_points(struct vec3 *out, struct vec3 from, double size)
{
    for (int i = 0; i < 8; i++)
        out[i] = vec3_mad(from, size, vec3(i & 1, i >> 1 & 1, i >> 2));
}

/* Two unit cubes that share the edge x = y = 1: eight points and six more, four faces at the edge.
 */
enum { PAIR_POINTS = 14, PAIR_FACES = 24 };

static void cube_pair(struct vec3 *points, struct triangle_corners *faces)
{
    static const uint32_t second[8] = {3, 8, 9, 10, 7, 11, 12, 13};
    struct vec3 box[8];
    box_points(points, vec3(0, 0, 0), 1);
    box_points(box, vec3(1, 1, 0), 1);
    for (int i = 0; i < 8; i++)
        points[second[i]] = box[i];
    memcpy(faces, box_faces, sizeof box_faces);
    for (int i = 0; i < 12; i++)
        for (int k = 0; k < 3; k++)
            faces[12 + i].at[k] = second[box_faces[i].at[k]];
}

START_TEST(normals_are_plain_sums)
{
    struct vec3 points[PAIR_POINTS], normals[PAIR_POINTS];
    struct triangle_corners faces[PAIR_FACES];
    cube_pair(points, faces);
    mesh_vertex_normals(points, PAIR_POINTS, faces, PAIR_FACES, normals);
    for (uint32_t v = 0; v < PAIR_POINTS; v++) {
        struct vec3 sum = vec3_all(0);
        for (int f = 0; f < PAIR_FACES; f++) {
            const uint32_t *c = faces[f].at;
            if (c[0] == v || c[1] == v || c[2] == v)
                sum =
                    vec3_add(sum, vec3_normalize(vec3_cross(vec3_sub(points[c[1]], points[c[0]]),
                                                            vec3_sub(points[c[2]], points[c[0]]))));
        }
        /* At the shared edge the sides cancel, but for the triangles' uneven share. */
        bool cancels = vec3_length(sum) < 1e-9;
        check_near(normals[v], cancels ? vec3_all(0) : vec3_normalize(sum), 1e-15);
    }
}
END_TEST

static const struct {
    struct vec3 a, b, c, normal;
} face_normals[] = {
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}, {0, 0, 1}},
    {{0, 0, 0}, {5e-324, 0, 0}, {0, 5e-324, 0}, {0, 0, 1}},
    {{0, 0, 0}, {1e200, 0, 0}, {0, 0, 1e200}, {0, -1, 0}},
    {{0, 0, 0}, {1e300, 0, 0}, {0, 1e-300, 0}, {0, 0, 1}},
    {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 0, 0}},
    {{1, 2, 3}, {1, 2, 3}, {4, 5, 6}, {0, 0, 0}},
    {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {0, 0, 0}},
    {{1e308, 0, 0}, {-1e308, 0, 0}, {0, 1e308, 0}, {0, 0, 0}}, /* overflows */
};

START_TEST(face_normal_has_any_scale)
{
    struct vec3 n, wanted = face_normals[_i].normal;
    int has_area = mesh_face_normal(face_normals[_i].a, face_normals[_i].b, face_normals[_i].c, &n);
    ck_assert_int_eq(has_area, vec3_length(wanted) > 0);
    check_near(n, wanted, 1e-15);
}
END_TEST

START_TEST(normals_skip_what_has_none)
{
    static const struct vec3 points[] = {{0, 0, 0}, {1, 0, 0},       {0, 1, 0},
                                         {2, 0, 0}, {0.3, 0.7, 0.1}, {9, 9, 9}};
    static const struct triangle_corners faces[] = {{{0, 1, 2}}, /* +z */
                                                    {{0, 1, 3}}, /* flat */
                                                    {{4, 3, 5}},
                                                    {{4, 5, 3}}}; /* a leaf */
    struct vec3 normals[6];
    mesh_vertex_normals(points, 6, faces, COUNT(faces), normals);
    check_near(normals[0], vec3(0, 0, 1), 0);
    check_near(normals[1], vec3(0, 0, 1), 0);
    check_near(normals[3], vec3_all(0), 0);
    check_near(normals[4], vec3_all(0), 0);
}
END_TEST

/* ---- analysis -------------------------------------------------------------------------------- */

#ifdef HAVE_OPENMESH

#define LIMIT 8

static const struct {
    const char *name;
    size_t point_count, face_count;
    struct vec3 points[LIMIT];
    struct triangle_corners faces[LIMIT];
    struct mesh_report wanted; /* boundary, non-manifold, degenerate, unused, volume, first */
} analyses[] = {
#define CORNER                       \
    {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, \
    {                                \
        0, 0, 1                      \
    }
#define TETRAHEDRON                        \
    {{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, \
    {                                      \
        {                                  \
            0, 3, 2                        \
        }                                  \
    }
    {"nothing", 0, 0, {{0, 0, 0}}, {{{0}}}, {0, 0, 0, 0, 0, 0, 0, 0, {0, 0}}},
    {"tetrahedron", 4, 4, {CORNER}, {TETRAHEDRON}, {0, 0, 0, 0, 1.0 / 6, 0, 0, 0, {0, 0}}},
    {"inside out",
     4,
     4,
     {CORNER},
     {{{0, 1, 2}}, {{0, 3, 1}}, {{1, 3, 2}}, {{0, 2, 3}}},
     {0, 0, 0, 0, -1.0 / 6, 0, 0, 0, {0, 0}}},
    {"open", 4, 3, {CORNER}, {TETRAHEDRON}, {3, 0, 0, 0, NAN, 0, 0, 0, {0, 2}}},
    {"unused vertices",
     6,
     4,
     {CORNER, {1, 1, 1}, {2, 2, 2}},
     {TETRAHEDRON},
     {0, 0, 0, 2, 1.0 / 6, 0, 0, 4, {0, 0}}},
    {"three faces at an edge",
     5,
     3,
     {CORNER, {0, -1, 0}},
     {{{0, 1, 2}}, {{0, 1, 3}}, {{0, 1, 4}}},
     {6, 2, 0, 0, NAN, 1, 0, 0, {0, 2}}},
    {"tetrahedra at a vertex",
     7,
     8,
     {CORNER, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
     {TETRAHEDRON, {{0, 4, 5}}, {{0, 6, 4}}, {{4, 6, 5}}, {{0, 5, 6}}},
     {0, 3, 0, 0, NAN, 4, 0, 0, {0, 0}}},
    {"tetrahedra at an edge",
     6,
     8,
     {CORNER, {0, -1, 0}, {0, 0, -1}},
     {TETRAHEDRON, {{0, 4, 1}}, {{0, 1, 5}}, {{1, 4, 5}}, {{0, 5, 4}}},
     {0, 4, 0, 0, NAN, 4, 0, 0, {0, 0}}},
    {"turned neighbour",
     4,
     2,
     {CORNER},
     {{{0, 1, 2}}, {{0, 1, 3}}},
     {4, 1, 0, 0, NAN, 1, 0, 0, {0, 2}}},
    {"face twice", 3, 2, {CORNER}, {{{0, 1, 2}}, {{0, 1, 2}}}, {0, 1, 0, 0, 0, 1, 0, 0, {0, 0}}},
    {"leaf", 3, 2, {CORNER}, {{{0, 1, 2}}, {{0, 2, 1}}}, {0, 0, 0, 0, 0, 0, 0, 0, {0, 0}}},
    {"repeated corners",
     4,
     6,
     {CORNER},
     {TETRAHEDRON, {{0, 0, 1}}, {{2, 2, 2}}},
     {0, 0, 2, 0, 1.0 / 6, 0, 4, 0, {0, 0}}},
    {"flat face closes a seam",
     5,
     3,
     {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {0, 1, 0}},
     {{{0, 2, 3}}, {{2, 1, 3}}, {{0, 1, 2}}},
     {3, 0, 1, 1, 0, 0, 2, 4, {0, 1}}},
};

/* Where file descriptor 2 led, while it leads to a file. */
struct capture {
    FILE *file;
    int before;
};

static struct capture capture_begin(void)
{
    struct capture c = {tmpfile(), dup(2)};
    ck_assert_ptr_nonnull(c.file);
    fflush(stderr);
    dup2(fileno(c.file), 2);
    return c;
}

/* How many bytes were written. */
static long capture_end(struct capture *c)
{
    fflush(stderr);
    dup2(c->before, 2);
    close(c->before);
    fseek(c->file, 0, SEEK_END);
    long n = ftell(c->file);
    fclose(c->file);
    return n;
}

static void check_report(const struct mesh_report *got, const struct mesh_report *wanted)
{
    ck_assert_uint_eq(got->boundary_edges, wanted->boundary_edges);
    ck_assert_uint_eq(got->non_manifold_faces, wanted->non_manifold_faces);
    ck_assert_uint_eq(got->degenerate_faces, wanted->degenerate_faces);
    ck_assert_uint_eq(got->unused_vertices, wanted->unused_vertices);
    ck_assert_uint_eq(got->first_non_manifold, wanted->first_non_manifold);
    ck_assert_uint_eq(got->first_degenerate, wanted->first_degenerate);
    if (wanted->unused_vertices)
        ck_assert_uint_eq(got->first_unused, wanted->first_unused);
    ck_assert_uint_eq(got->first_boundary[0], wanted->first_boundary[0]);
    ck_assert_uint_eq(got->first_boundary[1], wanted->first_boundary[1]);
    if (!isnan(wanted->volume))
        ck_assert_msg(fabs(got->volume - wanted->volume) < 1e-15, "volume %g", got->volume);
}

START_TEST(mesh_is_analysed_in_silence)
{
    struct mesh_report got;
    struct capture c = capture_begin();
    const char *reason = openmesh_analyse(analyses[_i].points, analyses[_i].point_count,
                                          analyses[_i].faces, analyses[_i].face_count, &got);
    ck_assert_int_eq(capture_end(&c), 0);
    ck_assert_ptr_null(reason);
    check_report(&got, &analyses[_i].wanted);
}
END_TEST

START_TEST(cubes_at_an_edge_are_closed)
{
    struct vec3 points[PAIR_POINTS];
    struct triangle_corners faces[PAIR_FACES];
    struct mesh_report got;
    cube_pair(points, faces);
    ck_assert_ptr_null(openmesh_analyse(points, PAIR_POINTS, faces, PAIR_FACES, &got));
    ck_assert_uint_eq(got.boundary_edges, 0);
    ck_assert_uint_gt(got.non_manifold_faces, 0);
    ck_assert(fabs(got.volume - 2) < 1e-14);
}
END_TEST

/* Around the world's origin the terms would be 1e24 and their sum, 1, lost. */
START_TEST(volume_far_away_does_not_cancel)
{
    struct vec3 points[8];
    struct mesh_report got;
    box_points(points, vec3(1e8, -3e8, 2e8), 1);
    ck_assert_ptr_null(openmesh_analyse(points, 8, box_faces, COUNT(box_faces), &got));
    ck_assert_msg(fabs(got.volume - 1) < 1e-14, "volume %.17g", got.volume);
}
END_TEST

START_TEST(too_many_faces_are_refused)
{
    struct mesh_report got;
    ck_assert_ptr_nonnull(openmesh_analyse(NULL, 0, NULL, SIZE_MAX, &got));
    ck_assert_ptr_nonnull(openmesh_analyse(NULL, SIZE_MAX, NULL, 0, &got));
}
END_TEST

static TCase *analysis_case(void)
{
    TCase *c = tcase_create("analysis");
    tcase_add_loop_test(c, mesh_is_analysed_in_silence, 0, COUNT(analyses));
    tcase_add_test(c, cubes_at_an_edge_are_closed);
    tcase_add_test(c, volume_far_away_does_not_cancel);
    tcase_add_test(c, too_many_faces_are_refused);
    return c;
}

#else

START_TEST(openmesh_is_missed)
{
    struct mesh_report got;
    ck_assert_str_eq(openmesh_analyse(NULL, 0, NULL, 0, &got),
                     "this wrt was built without OpenMesh");
}
END_TEST

static TCase *analysis_case(void)
{
    TCase *c = tcase_create("analysis");
    tcase_add_test(c, openmesh_is_missed);
    return c;
}

#endif

Suite *mesh_suite(void)
{
    Suite *s = suite_create("mesh");
    TCase *off = tcase_create("off"), *uv = tcase_create("uv"), *normals = tcase_create("normals");
    tcase_add_loop_test(off, off_is_read, 0, COUNT(good));
    tcase_add_test(off, off_coordinates_are_nearest_doubles);
    tcase_add_loop_test(off, off_damage_is_reported, 0, COUNT(damaged));
    tcase_add_test(off, off_crowded_vertex_is_pointed_to);
    tcase_add_test(off, off_truncation_and_flips);
    tcase_add_loop_test(off, binary_off_is_read, 0, 4);
    tcase_add_loop_test(off, binary_off_damage_is_reported, 0, 4);
    tcase_add_loop_test(uv, uv_list_is_read_or_refused, 0, COUNT(uvs));
    tcase_add_test(normals, normals_are_plain_sums);
    tcase_add_loop_test(normals, face_normal_has_any_scale, 0, COUNT(face_normals));
    tcase_add_test(normals, normals_skip_what_has_none);
    suite_add_tcase(s, off);
    suite_add_tcase(s, uv);
    suite_add_tcase(s, normals);
    suite_add_tcase(s, analysis_case());
    return s;
}
