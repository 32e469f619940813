/* Both formats to descriptions: the same values, whatever they are spelt in; and validation. */
#include "config.h"

#include "load.h"
#include "unit.h"

#include <stdio.h>

#define XML_CAMERA                                                          \
    "<camera><origin>0 0 1</origin><z>0 0 1</z><y>0 1 0</y><yfov>20</yfov>" \
    "<xResolution>8</xResolution><yResolution>6</yResolution></camera>"
#define CAMERA \
    "camera { eye: (0, 0, 1)  back: (0, 0, 1)  up: (0, 1, 0)  yfov: 20  resolution: (8, 6) }\n"
#define NATIVE "wrt 1\nmodel classic\n" CAMERA

/* A property in both formats, on an object of the kind, and its value. */
static const struct row {
    enum schema_prop_id prop;
    enum schema_kind kind;
    const char *xml, *native;
    double number[3];
} rows[] = {
    {PROP_RADIUS, KIND_SPHERE, "<radius> 2.5e-1 </radius>", "radius: .25", {0.25}},
    {PROP_RADIUS, KIND_CYLINDER, "<radius>+2</radius>", "radius: -(-2)", {2}},
    {PROP_CENTER, KIND_SPHERE, "<position>1 -2\n3</position>", "center: (1, -2, 3)", {1, -2, 3}},
    {PROP_CENTER, KIND_SPHERE, "<position>7 7 7</position>", "center: 7", {7, 7, 7}},
    {PROP_CENTER, KIND_SPHERE, "<position>-1 2 -3</position>", "center: -(1, -2, 3)", {-1, 2, -3}},
    {PROP_UV_SCALE, KIND_SPHERE, "<tscale>2 3 0</tscale>", "uv_scale: (2, 3)", {2, 3, 0}},
    {PROP_UV_OFFSET, KIND_LAMBERT, "<toffset>2 3 4</toffset>", "uv_offset: (2, 3, 4)", {2, 3, 4}},
    {PROP_DIFFUSE, KIND_LAMBERT, "<diffuse>1 0 .2</diffuse>", "diffuse: #ff0033", {1, 0, 0.2}},
    {PROP_DIFFUSE, KIND_LAMBERT, "<diffuse>.5 .5 .5</diffuse>", "diffuse: 0.5", {0.5, 0.5, 0.5}},
    {PROP_MESH_SCALE, KIND_MESH, "<size>2 2 2</size>", "scale: 2", {2, 2, 2}},
    {PROP_SMOOTH, KIND_MESH, "<breakang>1</breakang>", "smooth: true", {1}},
    {PROP_SMOOTH, KIND_MESH, "<breakang>0</breakang>", "smooth: false", {0}},
    {PROP_SMOOTH, KIND_MESH, "<breakang>30</breakang>", "smooth: 30", {30}},
    {PROP_FLIP_NORMALS, KIND_MESH, "<invNormal>1</invNormal>", "flip_normals: true", {1}},
    {PROP_LIGHT_SAMPLES, KIND_AREA_LIGHT, "<nsamples>5</nsamples>", "samples: 5", {5}},
    {PROP_HEIGHT, KIND_CYLINDER, "<height>-3</height>", "height: -3", {-3}},
    {PROP_INTENSITY,
     KIND_POINT_LIGHT,
     "<intensity>1 2 3</intensity>",
     "intensity: (1, 2, 3)",
     {1, 2, 3}},
    {PROP_YFOV, KIND_CAMERA, "<yfov>45</yfov>", "yfov: 45deg", {45}},
    {PROP_YFOV, KIND_CAMERA, "<yfov>57.29577951308232</yfov>", "yfov: 1rad", {57.29577951308232}},
    {PROP_RESOLUTION,
     KIND_CAMERA,
     "<yResolution>7</yResolution><xResolution>9</xResolution>",
     "resolution: (9, 7)",
     {9, 7}},
    {PROP_COMPAT, KIND_CAMERA, "<compatMode>0</compatMode>", "compat: false", {0}},
};

/* A scene with nothing but that object. */
static void wrap(char *out, size_t room, const struct row *r, bool xml)
{
    const struct schema_kind_row *k = &schema_kinds[r->kind];
    static const char *const around[SCHEMA_GROUPS][2] = {
        [SCHEMA_CAMERA] = {"<camera>", "</camera>"},
        [SCHEMA_LIGHT] = {"<lights><l class='", "</l></lights>"},
        [SCHEMA_SURFACE] = {"<surfaces><s class='", "</s></surfaces>"},
        [SCHEMA_MATERIAL] = {"<surfaces><s class='Sphere'><material class='",
                             "</material></s></surfaces>"}};
    bool classed = k->group != SCHEMA_CAMERA;
    if (xml)
        snprintf(out, room, "<scene>%s%s%s%s%s</scene>", around[k->group][0], classed ? k->xml : "",
                 classed ? "'>" : "", r->xml, around[k->group][1]);
    else
        snprintf(out, room, "wrt 1 model classic %s%s { %s }",
                 k->group == SCHEMA_MATERIAL ? "material m = " : "", k->native, r->native);
}

static const struct desc_object *only_object(const struct desc *d, enum schema_kind kind)
{
    switch (schema_kinds[kind].group) {
    case SCHEMA_CAMERA:
        return d->camera;
    case SCHEMA_LIGHT:
        return d->lights.at[0];
    case SCHEMA_MATERIAL:
        return d->materials.at[0];
    default:
        return d->surfaces.at[0];
    }
}

START_TEST(value_in_both_formats)
{
    const struct row *r = &rows[_i];
    for (int xml = 0; xml < 2; xml++) {
        char text[500];
        struct load l;
        wrap(text, sizeof text, r, xml);
        ck_assert_msg(load_eval(&l, text), "%s: %s", text, load_first(&l));
        const struct desc_object *o = only_object(&l.desc, r->kind);
        ck_assert_int_eq(o->kind, r->kind);
        const struct desc_value *v = desc_get(o, r->prop);
        ck_assert_ptr_nonnull(v);
        unsigned n = schema_props[r->prop].type == TYPE_SIZE ? 2 : 3;
        for (unsigned i = 0; i < n; i++)
            ck_assert_msg(v->number[i] == r->number[i], "%s: %.17g is not %.17g", text,
                          v->number[i], r->number[i]);
        load_free(&l);
    }
}
END_TEST

static const char *const point_texts[2] = {
    "wrt 1 model classic let c = (7, 8) quad { vertices: [(1, 2, 3), (4, 5, 6), c, (0, 0, 9)]"
    " material: lambert { diffuse: 1 } } light area { shape: quad  falloff: inverse_square }",
    "<scene><surfaces><s class='Quad'><v3>0 0 9</v3><v0>1 2 3</v0><v1>4 5 6</v1><v2>7 8 0</v2>"
    "<material class='Lambert'><diffuse>1 1 1</diffuse></material></s></surfaces><lights>"
    "<l "
    "class='AreaLight'><shape>quaD</shape><attenuation>Inverse-Square</attenuation></l></lights></"
    "scene>"};

START_TEST(points_and_words_in_both_formats)
{
    static const double expected[4][3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 0}, {0, 0, 9}};
    struct load l;
    ck_assert_msg(load_eval(&l, point_texts[_i]), "%s", load_first(&l));
    const struct desc_value *v = desc_get(l.desc.surfaces.at[0], PROP_QUAD_VERTICES);
    ck_assert_uint_eq(v->n, 4);
    for (int i = 0; i < 4; i++) {
        ck_assert(v->points[i].x == expected[i][0] && v->points[i].y == expected[i][1]);
        ck_assert(v->points[i].z == expected[i][2]);
    }
    ck_assert_uint_eq(desc_get(l.desc.lights.at[0], PROP_SHAPE)->word, 1);
    ck_assert_uint_eq(desc_word(l.desc.lights.at[0], PROP_FALLOFF), 1);
    load_free(&l);
}
END_TEST

START_TEST(derived_objects)
{
    struct load l;
    ck_assert_msg(load_validate(&l, NATIVE
                                "material a = phong { diffuse: 1  specular: 0.5  exponent: 4 }\n"
                                "material b = a { exponent: 5 }\nmaterial c = b { diffuse: 0 }\n"
                                "sphere { center: 0  radius: 1  material: c { specular: 2 } }\n"
                                "sphere { center: 0  radius: 1  material: a }\n"),
                  "%s", load_first(&l));
    const struct desc_object *m = desc_get(l.desc.surfaces.at[0], PROP_MATERIAL)->object;
    ck_assert_int_eq(m->kind, KIND_PHONG);
    ck_assert_double_eq(desc_number(m, PROP_EXPONENT), 5);
    ck_assert_double_eq(desc_vector(m, PROP_DIFFUSE).x, 0);
    ck_assert_double_eq(desc_vector(m, PROP_SPECULAR).x, 2);
    const struct desc_object *a = desc_get(l.desc.surfaces.at[1], PROP_MATERIAL)->object;
    ck_assert_ptr_eq(a, l.desc.materials.at[0]);
    ck_assert_double_eq(desc_number(a, PROP_EXPONENT), 4);
    ck_assert_uint_eq(l.desc.materials.n, 4);
    load_free(&l);
}
END_TEST

START_TEST(shared_material_is_one_object)
{
    struct load l;
    ck_assert_msg(
        load_validate(
            &l,
            "<scene>" XML_CAMERA "<surfaces>"
            "<s class='Sphere'><material ref='m'/><position>0 0 0</position><radius>1</radius></s>"
            "<s class='Sphere'><material id='m' class='Lambert'><diffuse>1 1 1</diffuse></material>"
            "<position>0 0 0</position><radius>1</radius></s></surfaces></scene>"),
        "%s", load_first(&l));
    ck_assert_uint_eq(l.desc.materials.n, 1);
    ck_assert_ptr_eq(desc_get(l.desc.surfaces.at[0], PROP_MATERIAL)->object,
                     desc_get(l.desc.surfaces.at[1], PROP_MATERIAL)->object);
    load_free(&l);
}
END_TEST

START_TEST(defaults)
{
    struct load l;
    ck_assert_msg(load_validate(&l, NATIVE "light point { }\n"), "%s", load_first(&l));
    const struct desc_object *o = l.desc.lights.at[0];
    ck_assert_ptr_null(desc_get(o, PROP_INTENSITY));
    ck_assert_double_eq(desc_vector(o, PROP_INTENSITY).x, 0);
    ck_assert_uint_eq(desc_word(o, PROP_FALLOFF), 0);
    ck_assert_double_eq(desc_number(l.desc.camera, PROP_COMPAT), 1);
    load_free(&l);
}
END_TEST

/* What is found, as "code:text at its place" each. */
#define MATERIAL "  material: lambert { diffuse: 1 }"
static const struct {
    const char *body, *findings;
} mistakes[] = {
    {"sphere { center: 0  radius: 1" MATERIAL " }", ""},
    {"sphere { center: 0  radius: 0" MATERIAL " }", "E111:0|"},
    {"sphere { radius: 1" MATERIAL " }", "E112:sphere|"},
    {"sphere { center: (0, 0)  radius: (1, 2)" MATERIAL " }", "E109:(0, 0)|E109:(1, 2)|"},
    {"sphere { center: a  radius: b" MATERIAL " }", "E104:a|E104:b|"},
    {"let a = (1, \"x\")", "E109:\"x\"|"},
    {"let a = (1, 2, 3, 4)", "E110:(1, 2, 3, 4)|"},
    {"let a = -true", "E109:-true|"},
    {"let a = b let c = a let d = -a", "E104:b|"},
    {"texture t = lambert { diffuse: 1 }", "E109:lambert { diffuse: 1 }|"},
    {"material m = 5", "E109:5|"},
    {"material m = t { }", "E101:t|"},
    {"let m = 1 material n = m { }", "E101:m|"},
    {"cylinder { base: 0  radius: 1" MATERIAL " }", "E112:cylinder|"},
    {"cylinder { base: 0  radius: 1  height: 0" MATERIAL " }", "E111:0|"},
    {"cylinder { base: 1  radius: 1  top: (1, 1, 1)" MATERIAL " }", "E118:(1, 1, 1)|"},
    {"cylinder { base: 1  radius: 1  top: 1  height: 2" MATERIAL " }", ""},
    {"mesh { file: \"a\"  scale: (1, 0, 1)" MATERIAL " }", "E111:(1, 0, 1)|"},
    {"light area { }", "E112:light|"},
    {"light area { shape: quad }", "E112:light|"},
    {"light area { shape: quad  size: 1 }", ""},
    {"light area { object: sphere { center: 0  radius: 1 } }", ""},
    {"light area { object: sphere { center: 0  radius: 1 }  size: 1 }", "E117:size|"},
    {"light area { object: lambert { diffuse: 1 } }", "E109:lambert { diffuse: 1 }|"},
    {"light area { object: sphere { center: 0 } }", "E112:sphere|"},
    {"light { }", "E112:light|"},
    {"sphere { center: 0  radius: 1" MATERIAL "  light point { } }", "E108:light|"},
    {"quad { vertices: [0, 0, 0, 0]" MATERIAL " }", "E109:0|"},
    {"triangle { vertices: [(0,0), (1,0), (0,1)]  material: lambert { diffuse: 1"
     "  texture: image { file: \"a\" } } }",
     "E116:triangle|"},
    {"model classic", "E107:classic|"},
    {"light point { falloff: linear }", "E114:linear|"},
    {"light point { falloff: 1 }", "E109:1|"},
};

START_TEST(native_mistakes)
{
    struct load l;
    char text[1000], found[500];
    snprintf(text, sizeof text, NATIVE "%s\n", mistakes[_i].body);
    load_validate(&l, text);
    load_findings(&l, found, sizeof found);
    ck_assert_msg(strcmp(found, mistakes[_i].findings) == 0, "%s: %s", mistakes[_i].body, found);
    load_free(&l);
}
END_TEST

Suite *eval_suite(void)
{
    Suite *s = suite_create("eval");
    TCase *t = tcase_create("values");
    tcase_add_loop_test(t, value_in_both_formats, 0, COUNT(rows));
    tcase_add_loop_test(t, points_and_words_in_both_formats, 0, 2);
    tcase_add_test(t, derived_objects);
    tcase_add_test(t, shared_material_is_one_object);
    tcase_add_test(t, defaults);
    suite_add_tcase(s, t);

    t = tcase_create("mistakes");
    tcase_add_loop_test(t, native_mistakes, 0, COUNT(mistakes));
    suite_add_tcase(s, t);
    return s;
}
