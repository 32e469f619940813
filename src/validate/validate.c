#include "config.h"

#include "validate/validate.h"

#include "schema/describe.h"
#include "validate/rules.h"

#include <math.h>

/* What each kind needs in the scene's model. */
struct requirements {
    uint8_t n[SCHEMA_KINDS];
    uint8_t props[SCHEMA_KINDS][SCHEMA_PROPS];
};

static void list_requirements(struct requirements *r, enum schema_model model)
{
    *r = (struct requirements){0};
    for (int k = 0; k < SCHEMA_KINDS; k++)
        for (int p = 0; p < SCHEMA_PROPS; p++)
            if (schema_has((enum schema_kind)k, (enum schema_prop_id)p) &&
                schema_required((enum schema_prop_id)p, model))
                r->props[k][r->n[k]++] = (uint8_t)p;
}

struct validation {
    struct diag *diag;
    struct requirements required;
};

/* A light's object has no material: only its shape counts. */
enum role { IN_SCENE, OF_LIGHT };

static bool is_missing(const struct desc_object *o, enum schema_prop_id id, enum role role)
{
    return !desc_find(o, id) && !(role == OF_LIGHT && id == PROP_MATERIAL);
}

/* One error for all that is missing. */
static void check_required(const struct validation *v, const struct desc_object *o, enum role role)
{
    const uint8_t *props = v->required.props[o->kind];
    struct buffer names = {0};
    for (uint8_t i = 0; i < v->required.n[o->kind]; i++)
        if (is_missing(o, (enum schema_prop_id)props[i], role))
            buffer_printf(&names, "%s'%.*s'", names.n ? ", " : "",
                          STR_ARG(schema_prop_name((enum schema_prop_id)props[i], o->xml)));
    if (!names.n)
        return;
    struct diag_entry *e = diag_report(v->diag, DIAG_MISSING_PROPERTY, o->span, "%s has no %.*s",
                                       schema_kind_name(o->kind, o->xml), (int)names.n, names.at);
    buffer_free(&names);
    for (uint8_t i = 0; i < v->required.n[o->kind]; i++) {
        enum schema_prop_id id = (enum schema_prop_id)props[i];
        if (is_missing(o, id, role))
            diag_note(e, "'%.*s': %s", STR_ARG(schema_prop_name(id, o->xml)), schema_props[id].doc);
    }
}

/* XML properties made of several leaves need all of them. */
static void check_leaves(const struct desc_object *o, const struct desc_prop *p, struct diag *diag)
{
    enum schema_prop_id id = (enum schema_prop_id)p->id;
    unsigned n = o->xml ? schema_leaf_count(id) : 0;
    for (unsigned i = 0; i < n; i++)
        if (!(p->leaves >> i & 1))
            diag_report(diag, DIAG_MISSING_PROPERTY, o->span, "%s has no '%.*s'",
                        schema_kind_name(o->kind, o->xml), STR_ARG(schema_leaf(id, i)));
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
        struct str name = o->xml && n > 1 ? schema_leaf(id, i) : schema_prop_name(id, o->xml);
        struct span span = o->xml && i > 0 ? p->value.second : p->value.span;
        if (o->xml || n == 1)
            diag_report(diag, DIAG_OUT_OF_RANGE, span, "'%.*s' must be %.*s", STR_ARG(name),
                        (int)range.n, range.at);
        else
            diag_report(diag, DIAG_OUT_OF_RANGE, span, "'%.*s' must be %.*s, but %c is %.17g",
                        STR_ARG(name), (int)range.n, range.at, "xy"[i], p -> value.number[i]);
        buffer_free(&range);
    }
}

static bool check_props(const struct validation *v, const struct desc_object *o, enum role role)
{
    size_t errors = v->diag->errors;
    v->diag->frame = o->frame;
    if (!o->broken)
        check_required(v, o, role);
    for (const struct desc_prop *p = o->props; p; p = p->next) {
        if (!o->broken)
            check_leaves(o, p, v->diag);
        if (!p->broken && !p->inherited)
            check_range(o, p, v->diag);
    }
    return !o->broken && v->diag->errors == errors;
}

static void check_object(const struct validation *v, const struct desc_object *o, enum role role)
{
    if (!check_props(v, o, role))
        return;
    if (rules_of_kind[o->kind])
        rules_of_kind[o->kind](o, v->diag);
    if (schema_kinds[o->kind].group == SCHEMA_SURFACE && role == IN_SCENE)
        rules_uvs(o, v->diag);
    const struct desc_value *shape = desc_get(o, PROP_OBJECT);
    if (shape && shape->object)
        check_object(v, shape->object, OF_LIGHT);
}

bool validate_scene(const struct desc *d, struct diag *diag)
{
    struct validation v = {.diag = diag};
    size_t errors = diag->errors;
    list_requirements(&v.required, d->model);
    if (!d->camera && !d->incomplete)
        diag_report(diag, DIAG_MISSING_OBJECT, d->start, "the scene has no camera");
    if (d->camera)
        check_object(&v, d->camera, IN_SCENE);
    if (d->settings)
        check_object(&v, d->settings, IN_SCENE);
    for (size_t i = 0; i < d->defaults.n; i++)
        for (const struct desc_prop *p = d->defaults.at[i]->props; p; p = p->next)
            if (!p->broken)
                check_range(d->defaults.at[i], p, diag);
    for (size_t i = 0; i < d->textures.n; i++)
        check_object(&v, d->textures.at[i], IN_SCENE);
    for (size_t i = 0; i < d->materials.n; i++)
        check_object(&v, d->materials.at[i], IN_SCENE);
    for (size_t i = 0; i < d->lights.n; i++)
        check_object(&v, d->lights.at[i], IN_SCENE);
    for (size_t i = 0; i < d->surfaces.n; i++)
        check_object(&v, d->surfaces.at[i], IN_SCENE);
    diag->frame = NULL;
    return diag->errors == errors;
}
