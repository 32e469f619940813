/* Names that the schema does not have. */
#include "config.h"

#include "eval/context.h"

#include <math.h>

#include <stdio.h>

/* "sphere has: center radius ..." */
static void note_props(struct diag_entry *entry, const struct desc_object *o)
{
    char list[512] = "";
    size_t at = 0;
    struct str leaf;
    for (int p = 0; p < SCHEMA_PROPS && at < sizeof list; p++) {
        enum schema_prop_id id = (enum schema_prop_id)p;
        if (!(schema_props[id].models >> o->model & 1))
            continue;
        for (unsigned n = 0; schema_has(o->kind, id) && at < sizeof list &&
                             (leaf = o->xml ? schema_leaf(id, n) : schema_prop_name(id, false)).n;
             n++) {
            int put = snprintf(list + at, sizeof list - at, " %.*s", STR_ARG(leaf));
            at += put > 0 ? (size_t)put : 0;
            if (!o->xml)
                break;
        }
    }
    const char *kind = schema_kind_name(o->kind, o->xml);
    diag_note(entry, "%s has:%s", kind, list);
}

void report_unknown_property(struct eval *e, const struct desc_object *o, struct str name,
                             struct span name_span)
{
    const char *kind = schema_kind_name(o->kind, o->xml);
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_PROPERTY, name_span, "unknown %s '%.*s' of %s",
                    o->xml ? "element" : "property", STR_ARG(name), kind);
    struct str meant = schema_nearest_prop(o->kind, (enum schema_model)o->model, name, o->xml);
    diag_did_you_mean(entry, name_span, meant);
    note_props(entry, o);
}

/* Why the scene has the model it has. */
static void add_model(struct eval *e, struct diag_entry *entry)
{
    const char *model = schema_model_name(e->out->model);
    if (e->model)
        diag_label(entry, e->out->model_span, "the scene's model");
    else
        diag_note(entry,
                  e->out->xml ? "a document without model=\"modern\" is classic"
                              : "a scene that names no model is %s",
                  model);
}

void report_property_of_other_model(struct eval *e, const struct desc_object *o, struct str name,
                                    struct span name_span)
{
    struct diag_entry *entry = diag_report(
        e->diag, DIAG_OTHER_MODEL, name_span, "'%.*s' of %s exists only in 'model %s'",
        STR_ARG(name), schema_kind_name(o->kind, o->xml), schema_model_name(!e->out->model));
    add_model(e, entry);
    note_props(entry, o);
}

bool kind_exists(struct eval *e, enum schema_kind kind, struct span span, bool xml)
{
    if ((schema_kinds[kind].models >> e->out->model & 1) || e->model_unknown)
        return true;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_OTHER_MODEL, span, "'%s' exists only in 'model %s'",
                    schema_kind_name(kind, xml), schema_model_name(!e->out->model));
    add_model(e, entry);
    return false;
}

enum schema_kind report_unknown_kind(struct eval *e, enum schema_group group, struct str name,
                                     struct span span, bool xml)
{
    struct str meant = schema_nearest_kind(group, e->out->model, name, xml);
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_KIND, span, "unknown %s %s '%.*s'",
                    schema_group_name(group), xml ? "class" : "kind", STR_ARG(name));
    diag_did_you_mean(entry, span, meant);
    char list[256];
    size_t at = 0;
    for (int k = 0; k < SCHEMA_KINDS && at < sizeof list; k++) {
        if (schema_kinds[k].group != group || !(schema_kinds[k].models >> e->out->model & 1))
            continue;
        int put = snprintf(list + at, sizeof list - at, "%s%s", at ? ", " : " ",
                           schema_kind_name((enum schema_kind)k, xml));
        at += put > 0 ? (size_t)put : 0;
    }
    diag_note(entry, "there are:%s", list);
    return schema_find_kind(group, meant, xml);
}

void report_unknown_word(struct eval *e, enum schema_prop_id id, struct str word, struct span span,
                         bool xml)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_WORD, span, "'%.*s' is not one of the words of '%.*s'",
                    STR_ARG(word), STR_ARG(schema_prop_name(id, xml)));
    struct str_nearest nearest = str_nearest_to(word);
    char list[256];
    size_t at = 0;
    struct str known;
    for (unsigned n = 0; at < sizeof list && (known = schema_word(id, n, xml)).n; n++) {
        str_nearest_try(&nearest, known);
        int put = snprintf(list + at, sizeof list - at, " %.*s", STR_ARG(known));
        at += put > 0 ? (size_t)put : 0;
    }
    diag_did_you_mean(entry, span, str_nearest_found(&nearest));
    diag_note(entry, "there are:%s", list);
}

/* ---- names that are not defined ---- */

static bool defines_name(const struct ast_node *n)
{
    return n->kind == AST_LET || n->kind == AST_PARAM || n->kind == AST_MATERIAL ||
           n->kind == AST_TEXTURE || n->kind == AST_FN || n->kind == AST_DEFINE;
}

static const struct ast_node *find_later(struct eval *e, struct str name, struct span at)
{
    for (const struct scope *s = e->scope; s; s = s->parent)
        for (const struct ast_node *n = s->statements; n && scope_may_try(e); n = n->next)
            if (defines_name(n) && str_equal(n->name, name) && n->name_span.begin > at.begin)
                return n;
    return NULL;
}

bool report_meant(struct eval *e, struct diag_entry *entry, const struct ast_node *node,
                  struct str meant)
{
    const struct ast_node *later = find_later(e, node->name, node->name_span);
    if (later)
        diag_label(entry, later->name_span,
                   "defined later, here; names are defined before they are used");
    else
        diag_did_you_mean(entry, node->name_span, meant);
    return !later;
}

/* Words for colours that scenes elsewhere take, and which have no meaning here. */
static bool is_colour_word(struct str name)
{
    static const char *const words[] = {"black", "white",  "grey",   "gray", "red",   "green",
                                        "blue",  "yellow", "orange", "pink", "cyan",  "magenta",
                                        "brown", "purple", "violet", "gold", "silver"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (str_equal_nocase(name, str_of(words[i])))
            return true;
    return false;
}

/* What a name that means nothing was perhaps meant as, where the property expects a value. */
static void explain_value(struct diag_entry *entry, enum schema_prop_id id, struct str name)
{
    enum schema_type type = schema_props[id].type;
    if (type == TYPE_COLOUR && is_colour_word(name))
        diag_note(entry,
                  "a colour is written #rrggbb, rgb(r, g, b) or (r, g, b); 'let %.*s = ...' "
                  "gives it a name",
                  STR_ARG(name));
    else if (type == TYPE_MATERIAL &&
             schema_find_kind(SCHEMA_MATERIAL, name, false) != SCHEMA_KINDS)
        diag_note(entry, "a material is written '%.*s { ... }'", STR_ARG(name));
}

void report_undefined(struct eval *e, enum schema_prop_id id, const struct ast_node *node)
{
    if (scope_lost(e, node->name, node->span))
        return;
    struct diag_entry *entry = diag_report(e->diag, DIAG_UNKNOWN_NAME, node->span,
                                           "'%.*s' is not defined", STR_ARG(node->name));
    struct str_nearest nearest = str_nearest_to(node->name);
    scope_try_names(e, &nearest, 1u << BINDING_VALUE);
    report_meant(e, entry, node, str_nearest_found(&nearest));
    if (id != SCHEMA_PROPS)
        explain_value(entry, id, node->name);
}

/* ---- style ---- */

static bool is_plain_number(const struct ast_node *node)
{
    return node->kind == AST_NUMBER ||
           (node->kind == AST_PREFIX && node->children->kind == AST_NUMBER);
}

/* A unit behind each number that lacks one, when they are spelt out. */
static void add_units(struct diag_entry *entry, const struct ast_node *node, const struct value *v)
{
    const struct ast_node *c = node->kind == AST_VECTOR ? node->children : node;
    for (uint32_t i = 0; i < v->n; i++, c = c->next) {
        bool bare = v->number[i] != 0 && !value_is_angle(v, i);
        struct span end = {c->span.end, c->span.end};
        if (bare && is_plain_number(c))
            diag_fix(entry, end, DIAG_FIX_SAFE, "deg");
        if (node->kind != AST_VECTOR)
            return;
    }
}

static void report_missing_unit(struct eval *e, enum schema_prop_id id,
                                const struct ast_node *property, const struct value *v)
{
    bool bare = false;
    for (uint32_t i = 0; i < v->n; i++)
        bare |= v->number[i] != 0 && !value_is_angle(v, i);
    if (!bare || !diag_wants(e->diag, DIAG_ANGLE_WITHOUT_UNIT))
        return;
    const struct ast_node *node = ast_value(property, e->scratch);
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_ANGLE_WITHOUT_UNIT, node->span,
                    "'%s' without a unit is taken as degrees", schema_props[id].native);
    add_units(entry, node, v);
}

/* ---- degrees that look like radians ---- */

/* Whether four digits or more begin or round an angle of a usual part of a turn. */
static bool spells_radians(struct str digits, double x)
{
    static const double usual[] = {30, 45, 60, 90, 120, 135, 180, 270, 360};
    enum { FEWEST = 4 };
    unsigned significant = 0, decimals = 0;
    bool fraction = false;
    for (size_t i = 0; i < digits.n; i++) {
        bool digit = digits.at[i] >= '0' && digits.at[i] <= '9';
        if (!digit && digits.at[i] != '.')
            return false;
        significant += digit && (significant || digits.at[i] != '0');
        decimals += digit && fraction;
        fraction |= !digit;
    }
    double last = fmax(pow(10, -(double)decimals), 1e-12);
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (significant >= FEWEST && fabs(x - usual[i] * PI / 180) < last)
            return true;
    return false;
}

/* A multiple of 15 degrees up to two turns, but for rounding. */
static bool is_part_of_turn(double x)
{
    double parts = fabs(x) * 12 / PI;
    return parts < 48.5 && fabs(parts - round(parts)) < 1e-9 * parts;
}

/* Whether pi is a factor or term of the value; who divides by it makes degrees. */
static bool mentions_pi(const struct eval *e, const struct ast_node *node)
{
    const struct binding *b = node->kind == AST_NAME ? scope_find(e, node->name) : NULL;
    bool looks = node->kind == AST_CHAIN || node->kind == AST_PREFIX ||
                 node->kind == AST_PARENTHESES || node->kind == AST_VECTOR;
    if (b && str_is(node->name, "pi"))
        return b->kind == BINDING_VALUE && b->value.number[0] == PI;
    for (const struct ast_node *c = looks ? node->children : NULL; c; c = c->next)
        if (c->operator!= AST_DIVIDE && mentions_pi(e, c))
            return true;
    return false;
}

/* Tells one number, that of a field of view by W538; false when it looks right. */
static bool report_radians(struct eval *e, enum schema_prop_id id, const struct ast_node *node,
                           double x)
{
    bool plain = is_plain_number(node);
    const struct ast_node *bare = node->kind == AST_PREFIX ? node->children : node;
    struct str text = srcmap_text(e->diag->sources, node->span);
    struct str digits = srcmap_text(e->diag->sources, bare->span);
    if (plain ? id == PROP_FOV || !spells_radians(digits, fabs(x))
              : !is_part_of_turn(x) && !mentions_pi(e, node))
        return false;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_ANGLE_IN_RADIANS, node->span,
                    "'%s' takes degrees, and %.6g looks like radians", schema_props[id].native, x);
    diag_note(entry, "%.6g radians are %.6g degrees", x, x * (180 / PI));
    if (plain)
        diag_fix(entry, node->span, DIAG_FIX_MAYBE, "%.0fdeg", x * (180 / PI));
    else
        diag_fix(entry, node->span, DIAG_FIX_MAYBE,
                 node->kind == AST_NAME ? "%.*s * 1rad" : "(%.*s) * 1rad", STR_ARG(text));
    return true;
}

/* Each number of a vector that is spelt out, or all of it. */
static bool report_each_radians(struct eval *e, enum schema_prop_id id,
                                const struct ast_node *property, const struct value *v)
{
    bool found = false;
    if (!diag_wants(e->diag, DIAG_ANGLE_IN_RADIANS))
        return false;
    const struct ast_node *node = ast_value(property, e->scratch);
    const struct ast_node *c = node->kind == AST_VECTOR ? node->children : node;
    for (uint32_t i = 0; i < v->n && c; i++) {
        if (v->number[i] != 0 && !value_is_angle(v, i))
            found |= report_radians(e, id, c, v->number[i]);
        if (node->kind == AST_VECTOR)
            c = c->next;
        else if (found)
            break;
    }
    return found;
}

static void report_angle(struct eval *e, enum schema_prop_id id, const struct ast_node *property,
                         const struct value *v)
{
    if (!report_each_radians(e, id, property, v))
        report_missing_unit(e, id, property, v);
}

static void report_scalar_position(struct eval *e, enum schema_prop_id id,
                                   const struct ast_node *property, const struct value *v)
{
    if (v->type != VALUE_NUMBER || v->number[0] == 0 || !diag_wants(e->diag, DIAG_SCALAR_POSITION))
        return;
    const struct ast_node *node = ast_value(property, e->scratch);
    struct diag_entry *entry = diag_report(
        e->diag, DIAG_SCALAR_POSITION, node->span,
        "'%s' is given one number, which stands for x, y and z alike", schema_props[id].native);
    struct str text = srcmap_text(e->diag->sources, node->span);
    if (is_plain_number(node))
        diag_fix(entry, node->span, DIAG_FIX_MAYBE, "(%.*s, %.*s, %.*s)", STR_ARG(text),
                 STR_ARG(text), STR_ARG(text));
}

void report_style(struct eval *e, enum schema_prop_id id, const struct ast_node *property,
                  const struct value *v)
{
    enum schema_type type = schema_props[id].type;
    if (!value_is_numeric(v))
        return;
    if (type == TYPE_ANGLE || type == TYPE_ROTATION)
        report_angle(e, id, property, v);
    else if (type == TYPE_VECTOR)
        report_scalar_position(e, id, property, v);
}

static bool has_fraction(const struct value *v)
{
    for (uint32_t i = 0; i < v->n; i++)
        if (v->number[i] != floor(v->number[i]))
            return true;
    return false;
}

void report_float_comparison(struct eval *e, const struct value *a, const struct value *b,
                             struct span span)
{
    bool numbers = value_is_numeric(a) && value_is_numeric(b);
    if (!numbers || !diag_wants(e->diag, DIAG_COMPARISON_OF_FLOATS) ||
        !(has_fraction(a) || has_fraction(b)))
        return;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_COMPARISON_OF_FLOATS, span,
                    "numbers with fractions are seldom equal to the last digit");
    diag_note(entry, "abs(a - b) < 1e-9 leaves room for rounding");
}
