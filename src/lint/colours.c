/* Colours of lights and materials, and what rays do at materials. */
#include "config.h"

#include "lint/checks.h"

#include <math.h>

/* ---- below zero, or nothing at all ---- */

static void check_colours(const struct lint *l, const struct desc_object *o)
{
    for (const struct desc_prop *p = o->props; p; p = p->next) {
        const double *c = p->value.number;
        if (p->inherited || schema_props[p->id].type != TYPE_COLOUR ||
            fmin(c[0], fmin(c[1], c[2])) >= 0)
            continue;
        diag_report(l->diag, DIAG_NEGATIVE_COLOUR, p->value.span,
                    "'%.*s' is below 0: it takes light away",
                    STR_ARG(lint_name(o, (enum schema_prop_id)p->id)));
    }
}

void lint_negative_colours(const struct lint *l)
{
    lint_each_light(l, check_colours);
    lint_each_material(l, check_colours);
    if (l->desc->settings)
        check_colours(l, l->desc->settings);
}

static void check_intensity(const struct lint *l, const struct desc_object *o)
{
    bool given = desc_get(o, PROP_INTENSITY);
    if (vec3_is_zero(desc_vector(o, PROP_INTENSITY)))
        diag_report(l->diag, DIAG_LIGHT_ZERO_INTENSITY, lint_place(o, PROP_INTENSITY),
                    given ? "an intensity of 0 lights nothing"
                          : "a light without '%.*s' lights nothing",
                    STR_ARG(lint_name(o, PROP_INTENSITY)));
}

void lint_intensities(const struct lint *l)
{
    lint_each_light(l, check_intensity);
}

/* ---- energy ---- */

/* What a material sends on of the light that reaches it.  A metal tints what it mirrors; classic by
 * one number for all three channels.  A highlight is as bright as a matt surface within a lobe
 * only: the integral of cos^n over the hemisphere, by that of cos, is 2 / (n + 1). */
struct shares {
    struct vec3 diffuse, specular, reflection, refraction;
};

static struct vec3 colour_of(const struct desc_object *o, enum schema_prop_id id)
{
    return desc_get(o, id) ? desc_vector(o, id) : vec3_all(0);
}

static struct shares shares_of(const struct desc_object *o)
{
    struct shares s = {colour_of(o, PROP_DIFFUSE), colour_of(o, PROP_SPECULAR),
                       colour_of(o, PROP_REFLECTION), colour_of(o, PROP_REFRACTION)};
    if (desc_get(o, PROP_EXPONENT))
        s.specular = vec3_scale(s.specular, fmin(1, 2 / (desc_number(o, PROP_EXPONENT) + 1)));
    if (o->kind != KIND_METAL)
        return s;
    s.specular = vec3_mul(s.specular, s.diffuse);
    s.reflection = o->model == SCHEMA_MODERN ? vec3_mul(s.diffuse, s.reflection)
                                             : vec3_scale(s.diffuse, s.reflection.x);
    return s;
}

static double largest(struct vec3 v)
{
    return fmax(v.x, fmax(v.y, v.z));
}

/* Sums of decimal fractions such as 0.7 + 0.3 may end up a little above. */
static bool exceeds(double sum, double limit)
{
    const double rounding = 1e-12;
    return sum > limit * (1 + rounding);
}

static void check_energy(const struct lint *l, const struct desc_object *o)
{
    if (o->kind == KIND_EMISSIVE || desc_get(o, PROP_TEXTURE))
        return; /* an emissive one shines by itself; a texture darkens, by how much is not known */
    struct shares s = shares_of(o);
    struct vec3 matt = vec3_add(s.diffuse, s.reflection);
    double passed = largest(vec3_add(matt, s.refraction));
    double shining = largest(vec3_add(matt, s.specular));
    bool refracts = !vec3_is_zero(s.refraction);
    if (exceeds(passed, LINT(MOST_PASSED)))
        diag_report(l->diag, DIAG_ENERGY_ABOVE_ONE, o->span,
                    "this %s gives back %.4g times the light it gets: diffuse + reflection%s",
                    schema_kind_name(o->kind, o->xml), passed, refracts ? " + refraction" : "");
    else if (exceeds(shining, LINT(MOST_SHINING)))
        diag_report(l->diag, DIAG_ENERGY_ABOVE_ONE, o->span,
                    "this %s gives back up to %.4g times the light it gets: diffuse + reflection + "
                    "what the highlight gathers",
                    schema_kind_name(o->kind, o->xml), shining);
}

void lint_energy(const struct lint *l)
{
    lint_each_material(l, check_energy);
}

/* ---- rays ---- */

static void check_ior(const struct lint *l, const struct desc_object *o)
{
    const struct desc_value *ior = lint_own(o, PROP_IOR);
    struct str name = lint_name(o, PROP_IOR);
    if (!ior)
        return;
    if (ior->number[0] < LINT(LEAST_IOR))
        diag_report(l->diag, DIAG_IOR_BELOW_ONE, ior->span,
                    "'%.*s' is below 1, that of empty space: is it the other way round?",
                    STR_ARG(name));
    else if (ior->number[0] > LINT(MOST_IOR))
        diag_report(l->diag, DIAG_IOR_IMPLAUSIBLE, ior->span,
                    "'%.*s' is above that of any clear substance; diamond has 2.42", STR_ARG(name));
}

void lint_iors(const struct lint *l)
{
    lint_each_material(l, check_ior);
}

static void check_depth(const struct lint *l, const struct desc_object *o)
{
    static const enum schema_prop_id props[] = {PROP_REFLECTION, PROP_REFRACTION};
    for (int i = 0; i < 2; i++) {
        const struct desc_value *v = lint_own(o, props[i]);
        if (!v || vec3_is_zero(desc_vector(o, props[i])))
            continue;
        struct diag_entry *e =
            diag_report(l->diag, DIAG_REFLECTION_WITHOUT_DEPTH, v->span,
                        "'%.*s' has no effect: no ray is followed beyond the first",
                        STR_ARG(lint_name(o, props[i])));
        diag_label(e, desc_get(l->desc->settings, PROP_DEPTH)->span, "because the depth is 0");
        return;
    }
}

void lint_depth(const struct lint *l)
{
    const struct desc_value *depth =
        l->desc->settings ? desc_get(l->desc->settings, PROP_DEPTH) : NULL;
    if (depth && depth->number[0] == 0)
        lint_each_material(l, check_depth);
}

/* ---- far above white ---- */

static bool are_bytes(struct vec3 c)
{
    for (int i = 0; i < 3; i++)
        if (!(vec3_at(c, i) >= 0 && vec3_at(c, i) <= 255 && vec3_at(c, i) == floor(vec3_at(c, i))))
            return false;
    return true;
}

static void check_bright(const struct lint *l, enum schema_prop_id id)
{
    const struct desc_value *v = lint_own(l->desc->settings, id);
    struct vec3 c = v ? desc_vector(l->desc->settings, id) : vec3_all(0);
    if (largest(c) <= LINT(MOST_BRIGHT))
        return;
    struct str name = lint_name(l->desc->settings, id);
    struct diag_entry *e = diag_report(l->diag, DIAG_COLOUR_IN_BYTES, v->span,
                                       "'%.*s' is %.4g times as bright as white, which is 1",
                                       STR_ARG(name), largest(c));
    if (!are_bytes(c) || !lint_is_spelt_out(srcmap_text(l->sources, v->span)))
        return;
    int r = (int)c.x, g = (int)c.y, b = (int)c.z;
    diag_note(e, "a colour in bytes is written #%02x%02x%02x", r, g, b);
    diag_fix(e, v->span, DIAG_FIX_MAYBE, "#%02x%02x%02x", r, g, b);
}

void lint_bright_settings(const struct lint *l)
{
    if (!l->desc->settings)
        return;
    check_bright(l, PROP_BACKGROUND);
    check_bright(l, PROP_AMBIENT);
}

/* ---- mirrors that are none ---- */

static void check_mirror(const struct lint *l, const struct desc_object *o)
{
    static const struct {
        enum schema_kind kind, like;
        enum schema_prop_id prop;
    } rows[] = {{KIND_SHINY, KIND_PHONG, PROP_REFLECTION},
                {KIND_GLASS, KIND_SHINY, PROP_REFRACTION}};
    int i = o->kind == KIND_GLASS;
    const struct desc_value *v = lint_own(o, rows[i].prop);
    if (o->kind != rows[i].kind || !v || !vec3_is_zero(desc_vector(o, rows[i].prop)) ||
        !lint_is_spelt_out(srcmap_text(l->sources, v->span)))
        return;
    diag_report(l->diag, DIAG_IDLE_MIRROR, v->span, "with a '%.*s' of 0 this %s is a %s",
                STR_ARG(lint_name(o, rows[i].prop)), schema_kind_name(o->kind, o->xml),
                schema_kind_name(rows[i].like, o->xml));
}

void lint_idle_mirrors(const struct lint *l)
{
    lint_each_material(l, check_mirror);
}
