#include "config.h"

#include "validate/validate.h"

#include "image/picture.h"
#include "schema/describe.h"

#include <math.h>

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

/* ---- what the schema says of each property alone ---- */

static void check_required(const struct desc_object *o, struct diag *diag)
{
    for (int i = 0; i < SCHEMA_PROPS; i++) {
        enum schema_prop_id id = (enum schema_prop_id)i;
        if (!schema_has(o->kind, id) || !schema_props[id].required || desc_find(o, id))
            continue;
        struct str name = prop_name(o, id);
        struct diag_entry *e = diag_report(diag, DIAG_MISSING_PROPERTY, o->span, "%s has no '%.*s'",
                                           kind_name(o), STR_ARG(name));
        diag_note(e, "'%.*s': %s", STR_ARG(name), schema_props[id].doc);
    }
}

/* XML properties made of several leaves need all of them. */
static void check_leaves(const struct desc_object *o, const struct desc_prop *p, struct diag *diag)
{
    enum schema_prop_id id = (enum schema_prop_id)p->id;
    unsigned n = o->xml ? schema_leaf_count(id) : 1;
    for (unsigned i = 0; i < n; i++)
        if (!(p->leaves >> i & 1))
            diag_report(diag, DIAG_MISSING_PROPERTY, o->span, "%s has no '%.*s'", kind_name(o),
                        STR_ARG(schema_leaf(id, i)));
}

static bool in_range(const struct schema_prop *s, double x)
{
    bool low = s->has_least && (s->above ? !(x > s->least) : !(x >= s->least));
    return isfinite(x) && !low && !(s->most != 0 && x > s->most);
}

static void check_range(const struct desc_object *o, const struct desc_prop *p, struct diag *diag)
{
    enum schema_prop_id id = (enum schema_prop_id)p->id;
    const struct schema_prop *s = &schema_props[id];
    unsigned n = s->type == TYPE_SIZE ? 2 : 1;
    if (!s->has_least)
        return;
    for (unsigned i = 0; i < n; i++) {
        bool given = !o->xml || n == 1 || p->leaves >> i & 1;
        if (!given || in_range(s, p->value.number[i]))
            continue;
        struct buffer range = {0};
        describe_range(&range, id);
        struct str name = o->xml && n > 1 ? schema_leaf(id, i) : prop_name(o, id);
        diag_report(diag, DIAG_OUT_OF_RANGE, o->xml && i > 0 ? p->value.second : p->value.span,
                    "'%.*s' must be %.*s", STR_ARG(name), (int)range.n, range.at);
        buffer_free(&range);
    }
}

static bool check_props(const struct desc_object *o, struct diag *diag)
{
    size_t errors = diag->errors;
    diag->frame = o->frame;
    if (!o->broken)
        check_required(o, diag);
    for (const struct desc_prop *p = o->props; p; p = p->next) {
        if (!o->broken)
            check_leaves(o, p, diag);
        if (!p->broken && !p->inherited)
            check_range(o, p, diag);
    }
    return !o->broken && diag->errors == errors;
}

/* ---- rules between the properties of a kind ---- */

/* The sine of the angle between two directions, free of overflow. */
static double sine_between(struct vec3 a, struct vec3 b)
{
    a = vec3_scale(a, 1 / vec3_largest(a));
    b = vec3_scale(b, 1 / vec3_largest(b));
    return vec3_length(vec3_cross(vec3_normalize(a), vec3_normalize(b)));
}

/* Up counts as parallel to the view below this sine. */
#define PARALLEL_SINE 1e-9

static void check_camera(const struct desc_object *o, struct diag *diag)
{
    struct vec3 size = desc_vector(o, PROP_RESOLUTION);
    struct span back = value_span(o, PROP_BACK), up = value_span(o, PROP_UP);
    struct vec3 z = desc_vector(o, PROP_BACK), y = desc_vector(o, PROP_UP);
    if (vec3_is_zero(z))
        diag_report(diag, DIAG_DEGENERATE, back, "'%.*s' is a direction without length",
                    STR_ARG(prop_name(o, PROP_BACK)));
    else if (vec3_is_zero(y))
        diag_report(diag, DIAG_DEGENERATE, up, "'%.*s' is a direction without length",
                    STR_ARG(prop_name(o, PROP_UP)));
    else if (!(sine_between(z, y) > PARALLEL_SINE))
        diag_report(diag, DIAG_DEGENERATE, up,
                    "'%.*s' is parallel to the view, so it cannot say what is up",
                    STR_ARG(prop_name(o, PROP_UP)));
    if (!image_size_allowed((uint64_t)size.x, (uint64_t)size.y))
        diag_report(diag, DIAG_OUT_OF_RANGE, value_span(o, PROP_RESOLUTION),
                    "a picture has at most %d pixels in all", IMAGE_PIXEL_LIMIT);
    double half = desc_number(o, PROP_YFOV) * size.x / size.y;
    if (!(half < 90)) {
        struct diag_entry *e =
            diag_report(diag, DIAG_OUT_OF_RANGE, value_span(o, PROP_YFOV),
                        "'%.*s' times width over height must be below 90 degrees, but is %.6g",
                        STR_ARG(prop_name(o, PROP_YFOV)), half);
        diag_note(e, "classic takes that product as half the horizontal field of view");
    }
}

static void report_conflict(const struct desc_object *o, enum schema_prop_id one,
                            enum schema_prop_id other, struct diag *diag)
{
    struct diag_entry *e = diag_report(diag, DIAG_CONFLICT, name_span(o, other),
                                       "'%.*s' and '%.*s' cannot be given together",
                                       STR_ARG(prop_name(o, one)), STR_ARG(prop_name(o, other)));
    diag_label(e, name_span(o, one), "'%.*s' is given here", STR_ARG(prop_name(o, one)));
}

static void check_surface(const struct desc_object *o, bool in_scene, struct diag *diag);

static void check_area_light(const struct desc_object *o, struct diag *diag)
{
    const struct desc_value *object = desc_get(o, PROP_OBJECT);
    const struct desc_value *shape = desc_get(o, PROP_SHAPE), *size = desc_get(o, PROP_LIGHT_SIZE);
    if (object && shape)
        report_conflict(o, PROP_OBJECT, PROP_SHAPE, diag);
    else if (object && size)
        report_conflict(o, PROP_OBJECT, PROP_LIGHT_SIZE, diag);
    else if (!object && !shape && !size)
        diag_report(diag, DIAG_MISSING_PROPERTY, o->span,
                    "%s needs a shape: 'shape' and 'size', or 'object'", kind_name(o));
    else if (!object && !(shape && size))
        diag_report(diag, DIAG_MISSING_PROPERTY, o->span, "%s has no '%s'", kind_name(o),
                    shape ? "size" : "shape");
    if (object && object->object)
        check_surface(object->object, false, diag);
}

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
    else if (vec3_is_zero(vec3_sub(vec3(top->number[0], top->number[1], top->number[2]), base)))
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

/* The property with a surface's texture coordinates; SCHEMA_PROPS: it needs none, or, as a mesh, may
 * have some in its file. */
static enum schema_prop_id uv_prop(enum schema_kind kind)
{
    return kind == KIND_TRIANGLE ? PROP_TRIANGLE_UVS
           : kind == KIND_QUAD   ? PROP_QUAD_UVS
                                 : SCHEMA_PROPS;
}

static void check_uvs(const struct desc_object *o, struct diag *diag)
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

/* A light's object has no material: only its shape counts. */
static void check_surface(const struct desc_object *o, bool in_scene, struct diag *diag)
{
    struct desc_object shape = *o;
    const struct desc_value none = {0};
    struct desc_prop material = {.id = PROP_MATERIAL, .leaves = 1, .value = none};
    if (!in_scene && !desc_get(o, PROP_MATERIAL)) {
        material.next = shape.props;
        shape.props = &material;
    }
    if (!check_props(&shape, diag))
        return;
    if (o->kind == KIND_CYLINDER)
        check_cylinder(o, diag);
    if (o->kind == KIND_MESH)
        check_mesh(o, diag);
    if (in_scene)
        check_uvs(o, diag);
}

bool validate_scene(const struct desc *d, struct diag *diag)
{
    size_t errors = diag->errors;
    if (!d->camera && !d->incomplete)
        diag_report(diag, DIAG_MISSING_OBJECT, d->start, "the scene has no camera");
    if (d->camera && check_props(d->camera, diag))
        check_camera(d->camera, diag);
    for (size_t i = 0; i < d->textures.n; i++)
        check_props(d->textures.at[i], diag);
    for (size_t i = 0; i < d->materials.n; i++)
        check_props(d->materials.at[i], diag);
    for (size_t i = 0; i < d->lights.n; i++)
        if (check_props(d->lights.at[i], diag) && d->lights.at[i]->kind == KIND_AREA_LIGHT)
            check_area_light(d->lights.at[i], diag);
    for (size_t i = 0; i < d->surfaces.n; i++)
        check_surface(d->surfaces.at[i], true, diag);
    diag->frame = NULL;
    return diag->errors == errors;
}
