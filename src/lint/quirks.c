/* Where the original program's arithmetic surprises. */
#include "config.h"

#include "lint/checks.h"
#include "lint/survey.h"

#include <math.h>

static void check_exponent(const struct lint *l, const struct desc_object *o)
{
    const struct desc_value *v = lint_own(o, PROP_EXPONENT);
    if (!v || v->number[0] == floor(v->number[0]))
        return;
    struct diag_entry *e = diag_report(l->diag, DIAG_EXPONENT_FRACTIONAL_CLASSIC, v->span,
                                       "a light behind the surface has no highlight to this power");
    diag_note(e,
              "classic raises negative numbers to it, too; the result is none, and shows as black");
}

void lint_exponents(const struct lint *l)
{
    if (l->desc->model == SCHEMA_CLASSIC)
        lint_each_material(l, check_exponent);
}

/* Whether a light is in the surface or close to it, so that the two are one lamp. */
static bool is_lamp(const struct lint *l, struct box box)
{
    double near = LINT(LAMP_REACH) * vec3_length(vec3_sub(box.hi, box.lo));
    for (size_t i = 0; i < l->lowered->scene.lights.n; i++) {
        const struct light *light = &l->lowered->scene.lights.at[i];
        if (light->kind == LIGHT_SUN)
            continue;
        struct box lit = survey_light_box(light);
        double gap = 0;
        for (int axis = 0; axis < 3; axis++)
            gap = fmax(gap, fmax(vec3_at(lit.lo, axis) - vec3_at(box.hi, axis),
                                 vec3_at(box.lo, axis) - vec3_at(lit.hi, axis)));
        if (gap <= near)
            return true;
    }
    return false;
}

void lint_emissives(const struct lint *l)
{
    for (uint32_t i = 0; i < l->lowered->scene.surfaces.n; i++) {
        const struct desc_object *o = survey_object(l->survey, i);
        const struct desc_object *material = desc_get(o, PROP_MATERIAL)->object;
        if (material->kind != KIND_EMISSIVE || vec3_is_zero(desc_vector(material, PROP_DIFFUSE)) ||
            is_lamp(l, survey_boxes(l->survey)[i]))
            continue;
        l->diag->frame = o->frame;
        struct diag_entry *e =
            diag_report(l->diag, DIAG_EMISSIVE_IGNORED_LIGHT, o->span,
                        "this %s shines, but lights nothing", schema_kind_name(o->kind, o->xml));
        diag_label(e, material->span, "its material is emissive");
        diag_note(e, "a light in its place gives light");
    }
    l->diag->frame = NULL;
}

/* Behind the element with the file's name, on a line of its own when that has one. */
static void add_breakang(const struct lint *l, struct diag_entry *e, const struct desc_value *file)
{
    static const char closing[] = "</filename>";
    const struct source *s = srcmap_source(l->sources, file->span.end);
    uint32_t at = file->span.end - s->base;
    if (!str_begins((struct str){s->text + at, s->n - at}, closing))
        return;
    const char *line = s->text + (file->span.begin - s->base);
    while (line > s->text && line[-1] != '\n')
        line--;
    size_t indent = strspn(line, " \t");
    bool alone = str_begins(str_of(line + indent), "<filename>") && line > s->text;
    at = file->span.end + (uint32_t)strlen(closing);
    diag_fix(e, (struct span){at, at}, DIAG_FIX_SAFE, "%s%.*s<breakang>1</breakang>",
             alone ? "\n" : "", alone ? (int)indent : 0, line);
}

static void check_breakang(const struct lint *l, const struct desc_object *o)
{
    if (o->kind != KIND_MESH || !o->xml || desc_get(o, PROP_SMOOTH))
        return;
    struct diag_entry *e = diag_report(l->diag, DIAG_BREAKANG_IMPLICIT, o->span,
                                       "this mesh does not say whether it is smooth");
    diag_note(e, "the original's manual has breakang 1 then, which is taken; its program has 0");
    add_breakang(l, e, desc_get(o, PROP_MESH_FILE));
}

void lint_breakangs(const struct lint *l)
{
    if (l->desc->model == SCHEMA_CLASSIC)
        lint_each_surface(l, check_breakang);
}

/* ---- cylinders ---- */

static void check_top(const struct lint *l, const struct desc_object *o)
{
    const struct desc_value *top = o->kind == KIND_CYLINDER ? lint_own(o, PROP_TOP) : NULL;
    const struct desc_value *height = desc_get(o, PROP_HEIGHT);
    if (!top || !height || height->number[0] == 0)
        return;
    struct vec3 up = {0, height->number[0], 0};
    struct vec3 other = vec3_add(desc_vector(o, PROP_BASE), up);
    struct vec3 off = vec3_sub(desc_vector(o, PROP_TOP), other);
    const double rounding = 1e-12;
    if (vec3_largest(off) <= rounding * vec3_largest(other))
        return;
    struct diag_entry *e = diag_report(l->diag, DIAG_TOP_AND_HEIGHT, top->span,
                                       "this '%.*s' is not used: the height wins when it is not 0",
                                       STR_ARG(lint_name(o, PROP_TOP)));
    diag_label(e, height->span, "the height is here");
}

void lint_tops(const struct lint *l)
{
    lint_each_surface(l, check_top);
}
