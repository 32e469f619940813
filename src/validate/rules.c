#include "config.h"

#include "validate/rules.h"

#include "image/picture.h"

static const char *kind_name(const struct desc_object *o)
{
    return schema_kind_name(o->kind, o->xml);
}

static struct str prop_name(const struct desc_object *o, enum schema_prop_id id)
{
    return schema_prop_name(id, o->xml);
}

/* Where the property's name or value stands; no place when it is not given. */
static struct span name_span(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_prop *p = desc_find(o, id);
    return p ? p->name_span : (struct span){0};
}

static struct span value_span(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_value *v = desc_get(o, id);
    return v ? v->span : (struct span){0};
}

static struct vec3 vector_of(const struct desc_value *v)
{
    return vec3(v->number[0], v->number[1], v->number[2]);
}

static void report_conflict(const struct desc_object *o, enum schema_prop_id one,
                            enum schema_prop_id other, struct diag *diag)
{
    struct diag_entry *e = diag_report(diag, DIAG_CONFLICT, name_span(o, other),
                                       "'%.*s' and '%.*s' cannot be given together",
                                       STR_ARG(prop_name(o, one)), STR_ARG(prop_name(o, other)));
    diag_label(e, name_span(o, one), "'%.*s' is given here", STR_ARG(prop_name(o, one)));
}

static void report_no_direction(const struct desc_object *o, enum schema_prop_id id,
                                struct diag *diag)
{
    diag_report(diag, DIAG_DEGENERATE, value_span(o, id), "'%.*s' is a direction without length",
                STR_ARG(prop_name(o, id)));
}

/* ---- camera ---- */

/* The sine of the angle between two directions, free of overflow. */
static double sine_between(struct vec3 a, struct vec3 b)
{
    a = vec3_scale(a, 1 / vec3_largest(a));
    b = vec3_scale(b, 1 / vec3_largest(b));
    return vec3_length(vec3_cross(vec3_normalize(a), vec3_normalize(b)));
}

/* Up counts as parallel to the view below this sine. */
#define PARALLEL_SINE 1e-9

static void check_up(const struct desc_object *o, struct vec3 view, struct diag *diag)
{
    struct vec3 up = desc_vector(o, PROP_UP);
    const struct desc_value *given = desc_get(o, PROP_UP);
    if (vec3_is_zero(up))
        report_no_direction(o, PROP_UP, diag);
    else if (!(sine_between(view, up) > PARALLEL_SINE))
        diag_report(diag, DIAG_DEGENERATE, given ? given->span : o->span,
                    "'%.*s' is parallel to the view, so it cannot say what is up",
                    STR_ARG(prop_name(o, PROP_UP)));
}

static void check_classic_camera(const struct desc_object *o, struct diag *diag)
{
    struct vec3 size = desc_vector(o, PROP_RESOLUTION), back = desc_vector(o, PROP_BACK);
    if (vec3_is_zero(back))
        report_no_direction(o, PROP_BACK, diag);
    else
        check_up(o, back, diag);
    double half = desc_number(o, PROP_YFOV) * size.x / size.y;
    if (half < 90)
        return;
    struct diag_entry *e =
        diag_report(diag, DIAG_OUT_OF_RANGE, value_span(o, PROP_YFOV),
                    "'%.*s' times width over height must be below 90 degrees, but is %.6g",
                    STR_ARG(prop_name(o, PROP_YFOV)), half);
    diag_note(e, "classic takes that product as half the horizontal field of view");
}

static void check_view(const struct desc_object *o, struct diag *diag)
{
    const struct desc_value *look_at = desc_get(o, PROP_LOOK_AT), *view = desc_get(o, PROP_VIEW);
    if (look_at && view)
        report_conflict(o, PROP_LOOK_AT, PROP_VIEW, diag);
    else if (!look_at && !view)
        diag_report(diag, DIAG_MISSING_PROPERTY, o->span, "%s has neither '%s' nor '%s'",
                    kind_name(o), "look_at", "direction");
    if (!look_at == !view)
        return;
    struct vec3 along =
        view ? vector_of(view) : vec3_sub(vector_of(look_at), desc_vector(o, PROP_EYE));
    if (!vec3_is_zero(along))
        check_up(o, along, diag);
    else if (view)
        report_no_direction(o, PROP_VIEW, diag);
    else
        diag_report(diag, DIAG_DEGENERATE, look_at->span,
                    "'look_at' equals '%.*s', so there is no direction to look in",
                    STR_ARG(prop_name(o, PROP_EYE)));
}

/* Each lens has its own measure of how much is seen. */
static void check_lens(const struct desc_object *o, struct diag *diag)
{
    enum { PERSPECTIVE, ORTHOGRAPHIC };
    static const enum schema_prop_id measures[] = {
        [PERSPECTIVE] = PROP_FOV, [ORTHOGRAPHIC] = PROP_VIEW_HEIGHT};
    unsigned lens = desc_word(o, PROP_LENS);
    struct str name = schema_word(PROP_LENS, lens, o->xml);
    enum schema_prop_id wanted = measures[lens], other = measures[!lens];
    if (!desc_get(o, wanted))
        diag_report(diag, DIAG_MISSING_PROPERTY, o->span,
                    "%s has no '%s', which the %.*s lens needs", kind_name(o),
                    schema_props[wanted].native, STR_ARG(name));
    if (desc_get(o, other))
        diag_report(diag, DIAG_CONFLICT, name_span(o, other), "'%s' means nothing to the %.*s lens",
                    schema_props[other].native, STR_ARG(name));
}

static void check_camera(const struct desc_object *o, struct diag *diag)
{
    struct vec3 size = desc_vector(o, PROP_RESOLUTION);
    if (!image_size_allowed((uint64_t)size.x, (uint64_t)size.y))
        diag_report(diag, DIAG_OUT_OF_RANGE, value_span(o, PROP_RESOLUTION),
                    "the picture has %.0f pixels, and %d is the most there can be, whatever "
                    "--max-pixels allows",
                    size.x * size.y, IMAGE_PIXEL_LIMIT);
    if (o->model == SCHEMA_CLASSIC) {
        check_classic_camera(o, diag);
    } else {
        check_view(o, diag);
        check_lens(o, diag);
    }
}

/* ---- lights ---- */

static void check_sun(const struct desc_object *o, struct diag *diag)
{
    if (vec3_is_zero(desc_vector(o, PROP_SUN_DIRECTION)))
        report_no_direction(o, PROP_SUN_DIRECTION, diag);
}

/* A light has its shape from one property, and no two that say it twice. */
static bool has_one_shape(const struct desc_object *o, struct diag *diag)
{
    static const enum schema_prop_id pairs[][2] = {{PROP_OBJECT, PROP_SHAPE},
                                                   {PROP_OBJECT, PROP_LIGHT_SIZE},
                                                   {PROP_OBJECT, PROP_LIGHT_VERTICES},
                                                   {PROP_LIGHT_VERTICES, PROP_LIGHT_SIZE},
                                                   {PROP_LIGHT_VERTICES, PROP_LIGHT_POSITION}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        if (desc_get(o, pairs[i][0]) && desc_get(o, pairs[i][1])) {
            report_conflict(o, pairs[i][0], pairs[i][1], diag);
            return false;
        }
    return true;
}

static void check_area_light(const struct desc_object *o, struct diag *diag)
{
    enum { SHAPE_SPHERE };
    const struct desc_value *samples = desc_get(o, PROP_LIGHT_SAMPLES);
    const struct desc_value *shape = desc_get(o, PROP_SHAPE), *size = desc_get(o, PROP_LIGHT_SIZE);
    bool vertices = desc_get(o, PROP_LIGHT_VERTICES);
    if (o->model == SCHEMA_MODERN && samples && samples->number[0] < 1)
        diag_report(diag, DIAG_OUT_OF_RANGE, samples->span, "'%.*s' must be at least 1",
                    STR_ARG(prop_name(o, PROP_LIGHT_SAMPLES)));
    if (!has_one_shape(o, diag) || desc_get(o, PROP_OBJECT))
        return;
    if (vertices && shape && shape->word == SHAPE_SPHERE)
        diag_report(diag, DIAG_CONFLICT, shape->span, "a sphere has no '%s'",
                    schema_props[PROP_LIGHT_VERTICES].native);
    else if (!vertices && !shape && !size)
        diag_report(diag, DIAG_MISSING_PROPERTY, o->span,
                    "%s needs a shape: 'shape' and 'size', or 'object'", kind_name(o));
    else if (!vertices && !(shape && size))
        diag_report(diag, DIAG_MISSING_PROPERTY, o->span, "%s has no '%s'", kind_name(o),
                    shape ? "size" : "shape");
}

/* ---- surfaces ---- */

static void check_cylinder(const struct desc_object *o, struct diag *diag)
{
    const struct desc_value *height = desc_get(o, PROP_HEIGHT), *top = desc_get(o, PROP_TOP);
    if (height && height->number[0] != 0)
        return;
    struct vec3 base = desc_vector(o, PROP_BASE);
    if (!top && height)
        diag_report(diag, DIAG_OUT_OF_RANGE, height->span,
                    "a cylinder without height needs a '%.*s'", STR_ARG(prop_name(o, PROP_TOP)));
    else if (!top)
        diag_report(diag, DIAG_MISSING_PROPERTY, o->span, "%s has neither '%.*s' nor '%.*s'",
                    kind_name(o), STR_ARG(prop_name(o, PROP_HEIGHT)),
                    STR_ARG(prop_name(o, PROP_TOP)));
    else if (vec3_is_zero(vec3_sub(vector_of(top), base)))
        diag_report(diag, DIAG_DEGENERATE, top->span, "'%.*s' equals '%.*s': no height",
                    STR_ARG(prop_name(o, PROP_TOP)), STR_ARG(prop_name(o, PROP_BASE)));
}

static void check_mesh(const struct desc_object *o, struct diag *diag)
{
    const struct desc_value *scale = desc_get(o, PROP_MESH_SCALE);
    for (int i = 0; scale && i < 3; i++) {
        if (scale->number[i] != 0)
            continue;
        diag_report(diag, DIAG_OUT_OF_RANGE, scale->span, "'%.*s' has a factor of 0",
                    STR_ARG(prop_name(o, PROP_MESH_SCALE)));
        return;
    }
}

/* The property with a surface's texture coordinates; SCHEMA_PROPS: it needs none, or, as a mesh,
 * may have some in its file. */
static enum schema_prop_id uv_prop(enum schema_kind kind)
{
    return kind == KIND_TRIANGLE ? PROP_TRIANGLE_UVS
           : kind == KIND_QUAD   ? PROP_QUAD_UVS
                                 : SCHEMA_PROPS;
}

void rules_uvs(const struct desc_object *o, struct diag *diag)
{
    enum schema_prop_id uvs = uv_prop(o->kind);
    const struct desc_value *material = desc_get(o, PROP_MATERIAL);
    const struct desc_prop *map = desc_find(o, PROP_NORMAL_MAP);
    if (uvs == SCHEMA_PROPS || desc_get(o, uvs))
        return;
    const struct desc_object *m = material ? material->object : NULL;
    const struct desc_prop *texture = m ? desc_find(m, PROP_TEXTURE) : NULL;
    const struct desc_prop *why = map ? map : texture;
    if (!why)
        return;
    struct diag_entry *e =
        diag_report(diag, DIAG_MISSING_UV, o->span, "%s has %s but no texture coordinates",
                    kind_name(o), map ? "a normal map" : "a texture");
    diag_label(e, why->name_span, "%s is given here", map ? "the normal map" : "the texture");
    diag_note(e, "give '%.*s', one for each corner", STR_ARG(prop_name(o, uvs)));
}

rule_check *const rules_of_kind[SCHEMA_KINDS] = {
    [KIND_CAMERA] = check_camera,
    [KIND_SUN_LIGHT] = check_sun,
    [KIND_AREA_LIGHT] = check_area_light,
    [KIND_CYLINDER] = check_cylinder,
    [KIND_MESH] = check_mesh,
};
