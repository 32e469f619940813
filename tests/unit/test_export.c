/* The lowered scene in other programs' formats: what each text must hold, and what it leaves out.
 * Whether those programs then make the same picture, tests/numeric/export.sh tells. */
#include "config.h"

#include "convert/export.h"

#include "folder.h"
#include "load.h"
#include "unit.h"

#include <jansson.h>
#include <stdlib.h>

#define HEAD                                                                                       \
    "wrt 1\nmodel classic\n"                                                                       \
    "camera { eye: (1, 2, 3)  back: (0, 0, 2)  up: (0, 1, 1)  yfov: 22.5  resolution: (200, 100) " \
    "}\n"
#define LAMP "light point { position: (4, 5, 6)  intensity: 0.5 }\n"
#define WHITE "material: lambert { diffuse: 1 }"
#define BALL "sphere { center: (0.1, 0, 0)  radius: 2  "

static struct folder folder;
static char scene_name[80];

static void set_up(void)
{
    folder_enter(&folder);
    snprintf(scene_name, sizeof scene_name, "%s/scene", folder.path);
    folder_add_picture("t.png");
}

static void tear_down(void)
{
    static const char *const names[] = {"t.png"};
    folder_leave(&folder, names, COUNT(names));
}

typedef void writer(const struct scene *scene, const char *path, struct buffer *out,
                    struct diag *diag);

/* The text a scene becomes, NUL-terminated. */
static char *text_of(struct load *l, const char *scene, writer *write)
{
    struct buffer out = {0};
    ck_assert_msg(load_lower(l, "scene", scene), "%s", load_first(l));
    write(&l->lowered.scene, "out", &out, &l->diag);
    buffer_add(&out, "", 1);
    return out.at;
}

static const struct {
    const char *title;
    writer *write;
    const char *scene, *part;
} parts[] = {
    {"camera", export_pov, HEAD, "location <1,2,3>\n  direction <0,0,-1>\n  right <-1.99999999"},
    {"light", export_pov, HEAD LAMP, "light_source { <4,5,6>, rgb <0.5,0.5,0.5> }\n"},
    {"sphere", export_pov, HEAD BALL WHITE " }", "sphere { <0.1,0,0>, 2 material { M0 } }\n"},
    {"cylinder", export_pov, HEAD "cylinder { base: (1, 1, 1)  height: 2  radius: 3 " WHITE " }",
     "cylinder { <1,1,1>, <1,3,1>, 3 material { M0 } }\n"},
    {"quad", export_pov, HEAD "quad { vertices: [(0,0,0), (1,0,0), (1,1,0), (0,1,0)] " WHITE " }",
     "mesh2 {\n vertex_vectors { 4,\n<0,0,0>,<1,0,0>,<1,1,0>,<0,1,0> }\n"
     " face_indices { 2,\n<0,1,2>,<2,3,0> }\n material { M0 } }\n"},
    {"mirror", export_pov,
     HEAD LAMP LAMP BALL
     "material: shiny { diffuse: 0  specular: 0  exponent: 1  reflection: 0.25 } }",
     "finish { diffuse 1 reflection { rgb <0.25,0.25,0.25> } }"},
    {"glass", export_pov,
     HEAD LAMP BALL "material: glass { diffuse: 0.5  specular: 0  exponent: 1  reflection: 0"
                    "  refraction: 1  ior: 1.5 } }",
     "material { texture { pigment { rgb <0.5,0.5,0.5> transmit 0.5 } finish { diffuse 2 } }"
     " interior { ior 1.5 } }\n"
     "#declare Glass = sphere { <0.1,0,0>, 2 }\n"
     "object { Glass material { M0 } no_shadow }\nobject { Glass no_image no_reflection }\n"},
    {"metal", export_pov,
     HEAD BALL "material: metal { diffuse: (0.5, 0.25, 0)  specular: 0.5  exponent: 7"
               "  reflection: 0 } }",
     "phong 0.5 phong_size 7 metallic"},
    {"emissive", export_pov, HEAD LAMP BALL "material: emissive { diffuse: (1, 0, 0) } }",
     "pigment { rgb <1,0,0> } finish { diffuse 0 emission rgb <0.5,0.5,0.5> }"},
    {"picture", export_pov,
     HEAD BALL "material: lambert { diffuse: 1  texture: image { file: \"t.png\" }"
               "  uv_scale: (2, 4)  uv_offset: (1, 0) } }",
     "uv_mapping image_map { png \"t.png\" interpolate 2 } translate <-1,0,0> scale <0.5,0.25,1>"},
    {"area light", export_pov,
     HEAD "light area { position: (0, 9, 0)  intensity: 1  samples: 5  shape: quad  size: 2 }",
     "area_light <2,0,0>, <0,0,2>, 5, 5 }"},
    {"round light", export_pov,
     HEAD "light area { position: (0, 9, 0)  intensity: 1  samples: 4  shape: sphere  size: 2 }",
     "area_light <2,0,0>, <0,2,0>, 4, 4 circular orient }"},

    {"camera", export_tachyon, HEAD,
     "RESOLUTION 200 100\nCAMERA\n PROJECTION PERSPECTIVE ZOOM 1 ASPECTRATIO 1 ANTIALIASING 0 "
     "RAYDEPTH 5\n CENTER 1 2 3 VIEWDIR 0 0 -1 UPDIR 0 0.4999"},
    {"light", export_tachyon, HEAD LAMP, "LIGHT CENTER 4 5 6 RAD 0 COLOR 0.5 0.5 0.5\n"},
    {"falloff", export_tachyon,
     HEAD "light point { position: (4, 5, 6)  intensity: 2  falloff: inverse_square }",
     "RAD 0 ATTENUATION CONSTANT 0 LINEAR 0 QUADRATIC 0.012987012987012988 COLOR "
     "0.025974025974025976 "},
    {"sphere", export_tachyon, HEAD BALL WHITE " }", "\nSPHERE CENTER 0.1 0 0 RAD 2 M0\n"},
    {"cylinder", export_tachyon,
     HEAD "cylinder { base: (1, 1, 1)  height: 2  radius: 3 " WHITE " }",
     "FCYLINDER BASE 1 1 1 APEX 1 3 1 RAD 3 M0\n"
     "RING CENTER 1 1 1 NORMAL 0 -1 0 INNER 0 OUTER 3 M0\n"
     "RING CENTER 1 3 1 NORMAL 0 1 0 INNER 0 OUTER 3 M0\n"},
    {"triangle", export_tachyon,
     HEAD "triangle { vertices: [(0,0,0), (1,0,0), (0,1,0)] " WHITE " }",
     "TRI V0 0 0 0 V1 1 0 0 V2 0 1 0 M0\n"},
    {"picture", export_tachyon,
     HEAD BALL "material: lambert { diffuse: 1  texture: image { file: \"t.png\" } } }",
     "COLOR 1 0.5"},
    {"glass", export_tachyon,
     HEAD LAMP BALL "material: glass { diffuse: 0.5  specular: 0  exponent: 1  reflection: 1"
                    "  refraction: 1  ior: 1.5 } }",
     "AMBIENT 0 DIFFUSE 1 SPECULAR 0.5 OPACITY 0.5 COLOR 0.5 0.5 0.5 TEXFUNC 0\n"},
};

/* Words of `model modern`; tests/cli/export/modern has the rest. */
#define MODERN                                                                                   \
    "wrt 1\nmodel modern\n"                                                                      \
    "camera { eye: (0, 0, -4)  look_at: 0  lens: orthographic  height: 3  resolution: (20, 10) " \
    "}\n"

START_TEST(modern_camera_is_parallel)
{
    struct load l;
    char *pov = text_of(&l, MODERN, export_pov);
    ck_assert_ptr_nonnull(strstr(pov, "orthographic\n  location <0,0,-4>"));
    ck_assert_ptr_nonnull(strstr(pov, "right <6,0,0>\n  up <0,3,0>"));
    ck_assert_ptr_nonnull(strstr(pov, "assumed_gamma 1 "));
    free(pov);
    load_free(&l);
}
END_TEST

/* What classic scales by its lights, modern takes as it is. */
START_TEST(modern_mirror_is_itself)
{
    struct load l;
    char *pov =
        text_of(&l,
                MODERN LAMP LAMP BALL
                "material: shiny { diffuse: 0  specular: 0  exponent: 1  reflection: 0.25 } }",
                export_pov);
    ck_assert_ptr_nonnull(strstr(pov, "reflection { rgb <0.25,0.25,0.25> }"));
    ck_assert_uint_eq(l.diag.entries.n, 0);
    free(pov);
    load_free(&l);
}
END_TEST

START_TEST(part_written)
{
    struct load l;
    char *text = text_of(&l, parts[_i].scene, parts[_i].write);
    ck_assert_msg(strstr(text, parts[_i].part), "%s: %s", parts[_i].title, text);
    free(text);
    load_free(&l);
}
END_TEST

static const struct {
    writer *write;
    const char *scene, *note; /* "": none */
} notes[] = {
#define SHINY(s) "material: phong { diffuse: (0.5, 0.25, 0)  specular: " s "  exponent: 2 } }"
    {export_pov, HEAD LAMP BALL WHITE " }", ""},
    {export_pov, HEAD BALL SHINY("(1, 0, 0)"),
     "coloured highlights become white ones of the same mean"},
    {export_pov, HEAD BALL SHINY("(1, 0.5, 0)"), ""},
    {export_pov, HEAD BALL SHINY("0.5"), ""},
    {export_pov, HEAD BALL SHINY("(1, 0, 0)") BALL SHINY("(0, 1, 0)"),
     "coloured highlights become white ones of the same mean, here for the first time of 2"},
    {export_pov, HEAD BALL WHITE "  normal_map: image { file: \"t.png\" } }",
     "normal maps are left out"},
    {export_pov,
     HEAD "cylinder { base: (0, 0, 0)  height: 1  radius: 1  material: lambert { diffuse: 1"
          "  texture: image { file: \"t.png\" }  uv_scale: (2, 1) } }",
     "the scale of textures around cylinders is left out"},
    {export_pov,
     HEAD "light area { position: (0, 9, 0)  intensity: 1  samples: 3  shape: quad  size: 2 }",
     "area lights become flat grids of points"},
    {export_tachyon,
     HEAD "light area { position: (0, 9, 0)  intensity: 1  samples: 3  shape: quad  size: 2 }",
     "area lights become points: their shadows are hard"},
    {export_tachyon, HEAD BALL "material: emissive { diffuse: 1 } }",
     "emissive surfaces cast shadows"},
    {export_tachyon,
     HEAD BALL "material: lambert { diffuse: 1  texture: image { file: \"t.png\" } } }",
     "textures are left out: surfaces have their mean colour"},
    {export_json,
     HEAD BALL WHITE
     "  normal_map: image { file: \"t.png\" } }"
     "light area { position: (0, 9, 0)  intensity: 1  samples: 3  shape: quad  size: 2 }",
     ""},
};

START_TEST(loss_noted)
{
    struct load l;
    free(text_of(&l, notes[_i].scene, notes[_i].write));
    ck_assert_str_eq(load_first(&l), notes[_i].note);
    ck_assert_uint_le(l.diag.entries.n, 1);
    ck_assert(!l.diag.entries.n || l.diag.entries.at[0]->level == DIAG_NOTE);
    load_free(&l);
}
END_TEST

static unsigned count(const char *text, const char *part)
{
    unsigned n = 0;
    for (; (text = strstr(text, part)); text++)
        n++;
    return n;
}

START_TEST(equal_materials_once)
{
    struct load l;
    const char *scene = HEAD BALL WHITE " }" BALL WHITE " }" BALL SHINY("0.5") BALL WHITE " }";
    char *pov = text_of(&l, scene, export_pov);
    ck_assert_uint_eq(count(pov, "#declare M"), 2);
    ck_assert_uint_eq(count(pov, "material { M0 }"), 3);
    free(pov);
    load_free(&l);
}
END_TEST

/* The number at a path of keys and indexes, as in "surfaces/0/center/1". */
static double number_at(json_t *j, const char *path)
{
    char copy[64], *rest = copy;
    strcpy(copy, path);
    for (char *key; (key = strsep(&rest, "/"));)
        j = json_is_array(j) ? json_array_get(j, strtoul(key, NULL, 10)) : json_object_get(j, key);
    ck_assert_msg(json_is_number(j), "%s is no number", path);
    return json_number_value(j);
}

static const struct {
    const char *path;
    double value;
} numbers[] = {
    {"version", 1},
    {"camera/eye/2", 3},
    {"camera/yfov", 22.5},
    {"camera/resolution/0", 200},
    {"textures/0/size/1", 3},
    {"materials/0/texture", 0},
    {"materials/0/uv_scale/0", 2},
    {"materials/1/ior", 1.5},
    {"lights/0/position/1", 5},
    {"lights/1/points/0/3", 3},
    {"lights/1/line", 5},
    {"surfaces/0/shapes/0/center/0", 0.1},
    {"surfaces/0/line", 6},
    {"surfaces/1/shapes/0/height", 2},
    {"surfaces/1/material", 1},
    {"surfaces/2/vertices/2/1", 1},
    {"surfaces/2/triangles/1/0", 2},
    {"surfaces/2/uvs/5/1", 0},
};

START_TEST(json_read_back)
{
    static const char scene[] = HEAD LAMP
        "light area { position: (0, 9, 0)  intensity: 1  samples: 3  shape: quad  size: 2 }\n" BALL
        "material: lambert { diffuse: 1  texture: image { file: \"t.png\" }  uv_scale: (2, 2) } }\n"
        "cylinder { base: (1, 1, 1)  height: 2  radius: 3  material: glass { diffuse: 0.5"
        "  specular: 0  exponent: 1  reflection: 1  refraction: 1  ior: 1.5 } }\n"
        "quad { vertices: [(0,0,0), (1,0,0), (1,1,0), (0,1,0)]  uvs: [(0, 0), (1, 0), (1, 1), (0, "
        "1)]"
        "  material: lambert { diffuse: 1  texture: image { file: \"t.png\" } } }\n";
    struct load l;
    char *text = text_of(&l, scene, export_json);
    json_error_t error;
    json_t *j = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    ck_assert_msg(j, "%s: %s", error.text, text);
    ck_assert_str_eq(json_string_value(json_object_get(j, "format")), "wrt scene");
    for (int i = 0; i < COUNT(numbers); i++)
        ck_assert_msg(number_at(j, numbers[i].path) == numbers[i].value, "%s", numbers[i].path);
    json_decref(j);
    free(text);
    load_free(&l);
}
END_TEST

Suite *export_suite(void)
{
    Suite *s = suite_create("export");
    TCase *t = tcase_create("texts");
    tcase_add_checked_fixture(t, set_up, tear_down);
    tcase_add_loop_test(t, part_written, 0, COUNT(parts));
    tcase_add_test(t, modern_camera_is_parallel);
    tcase_add_test(t, modern_mirror_is_itself);
    tcase_add_loop_test(t, loss_noted, 0, COUNT(notes));
    tcase_add_test(t, equal_materials_once);
    tcase_add_test(t, json_read_back);
    suite_add_tcase(s, t);
    return s;
}
