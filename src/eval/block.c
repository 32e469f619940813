/* Blocks: objects, what `default` gives, groups and uses of templates. */
#include "config.h"

#include "base/buffer.h"
#include "eval/context.h"

#include <math.h>

/* Uses of templates may nest this deep; one takes as long as so many calls. */
enum { USES_LIMIT = 256, STEPS_A_USE = 5 };

/* ---- properties ---- */

/* A property whose values are words takes the word first, then a variable that holds it. */
static bool eval_word(struct eval *e, enum schema_prop_id id, const struct ast_node *node,
                      struct desc_value *out)
{
    int word = schema_find_word(id, node->name, false);
    if (word >= 0) {
        out->word = (unsigned)word;
        return true;
    }
    const struct binding *b = scope_find(e, node->name);
    if (b && b->kind == BINDING_VALUE) {
        struct value v = eval_value(e, node);
        return value_convert(e, id, &v, out);
    }
    report_unknown_word(e, id, node->name, node->span, false);
    return false;
}

/* A plain value needs no nodes. */
static struct value plain_value(const struct eval *e, const struct ast_node *property)
{
    struct value v = {.span = ast_value_span(property)};
    if (e->given_up)
        return value_error(v.span);
    v.n = ast_plain_value(property, v.number);
    v.type = v.n == 1 ? VALUE_NUMBER : VALUE_VECTOR;
    return v;
}

static bool eval_property_value(struct eval *e, enum schema_prop_id id,
                                const struct ast_node *property, struct desc_value *out)
{
    const struct ast_node *node = property->children;
    if (node && schema_props[id].type == TYPE_WORD && node->kind == AST_NAME)
        return eval_word(e, id, node, out);
    if (node && node->kind == AST_NAME && !e->given_up && !scope_find(e, node->name)) {
        report_undefined(e, id, node);
        return false;
    }
    struct value v = node ? eval_value(e, node) : plain_value(e, property);
    report_style(e, id, property, &v);
    return value_convert(e, id, &v, out);
}

/* Memory for the property comes from `a`. */
static void eval_property(struct eval *e, struct arena *a, struct desc_object *o,
                          const struct ast_node *node)
{
    unsigned leaf;
    enum schema_prop_id id = object_find_prop(e, o, node->name, node->name_span, &leaf);
    struct desc_prop *p =
        id != SCHEMA_PROPS ? object_prop(e, a, o, id, leaf, node->name_span) : NULL;
    if (!p) {
        if (node->children)
            eval_value(e, node->children); /* for its own mistakes */
        o->broken = true;
        return;
    }
    p->broken = !eval_property_value(e, id, node, &p->value);
    p->value.span = ast_value_span(node);
    o->broken |= p->broken;
}

/* ---- objects ---- */

/* The third word of `light point lamp { }`; others have their label as second. */
static void take_label(struct eval *e, struct desc_object *o, const struct ast_node *label)
{
    o->name = label->name;
    if (schema_kinds[o->kind].group != SCHEMA_LIGHT)
        diag_report(e->diag, DIAG_MISPLACED, label->span, "'%s' takes one label, not two",
                    schema_kinds[o->kind].native);
}

/* A property without its ':' reads like the use of a template. */
static void report_statement(struct eval *e, enum schema_kind kind, const struct ast_node *m)
{
    unsigned component;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_MISPLACED, m->name_span,
                    "a statement cannot stand in a block of '%s'", schema_kinds[kind].native);
    if (schema_find_prop(kind, m->name, false, &component) == SCHEMA_PROPS)
        return;
    diag_note(entry, "':' stands behind the name of a property");
    diag_fix(entry, (struct span){m->name_span.end, m->name_span.end}, DIAG_FIX_MAYBE, ":");
}

struct desc_object *eval_block(struct eval *e, enum schema_kind kind, const struct ast_node *node)
{
    struct desc_object *o = object_new(e, &e->out->arena, kind, node);
    bool damaged = false; /* statements right behind what did not parse are left over from it */
    for (const struct ast_node *m = node->children; m; m = m->next) {
        if (m->kind == AST_PROPERTY)
            eval_property(e, &e->out->arena, o, m);
        else if (m->kind == AST_LABEL)
            take_label(e, o, m);
        else
            o->broken = true; /* what it might have held is not missed */
        damaged = ast_is_damaged(m) || (damaged && m->kind != AST_PROPERTY);
        if (m->kind != AST_PROPERTY && m->kind != AST_LABEL && !damaged)
            report_statement(e, kind, m);
    }
    return o;
}

static void add_surface(struct eval *e, enum schema_kind kind, const struct ast_node *node)
{
    struct desc_object *o = eval_block(e, kind, node);
    o->name = node->label;
    object_place(e, o);
}

/* The camera or the settings. */
static void set_only(struct eval *e, enum schema_kind kind, const struct ast_node *node,
                     struct desc_object **slot)
{
    if (!kind_exists(e, kind, node->name_span, false))
        return;
    struct desc_object *o = eval_block(e, kind, node);
    object_complete(e, o);
    if (e->groups) {
        diag_report(e->diag, DIAG_MISPLACED, node->name_span,
                    "the %s cannot stand in a group or template", schema_kinds[kind].native);
    } else if (*slot) {
        struct diag_entry *entry = diag_report(
            e->diag, DIAG_DUPLICATE_OBJECT, node->name_span,
            kind == KIND_CAMERA ? "the scene has two cameras" : "the scene has its settings twice");
        diag_label(entry, (*slot)->span, "the first is here");
    } else {
        *slot = o;
    }
}

/* The place of the second word of a block. */
static struct span label_span(struct eval *e, const struct ast_node *node)
{
    struct str head = srcmap_text(e->diag->sources, node->span);
    uint32_t begin = node->span.begin + (uint32_t)(node->label.at - head.at);
    return (struct span){begin, begin + (uint32_t)node->label.n};
}

/* The kind that `light point` names, or was meant to; SCHEMA_KINDS after reporting. */
static enum schema_kind light_kind(struct eval *e, const struct ast_node *node)
{
    if (!node->label.n) {
        diag_report(e->diag, DIAG_MISSING_PROPERTY, node->name_span, "'light' needs a kind: %s",
                    e->out->model == SCHEMA_MODERN ? "'light point', 'light area' or 'light sun'"
                                                   : "'light point' or 'light area'");
        return SCHEMA_KINDS;
    }
    enum schema_kind kind = schema_find_kind(SCHEMA_LIGHT, node->label, false);
    if (kind == SCHEMA_KINDS)
        kind = report_unknown_kind(e, SCHEMA_LIGHT, node->label, label_span(e, node), false);
    else if (!kind_exists(e, kind, label_span(e, node), false))
        kind = SCHEMA_KINDS;
    return kind;
}

/* Lists the kinds that make statements, and returns the one that was meant by the name, if any. */
static struct str standing_kinds(const struct eval *e, struct str name, struct buffer *list)
{
    struct str_nearest nearest = str_nearest_to(name);
    bool light = false;
    for (int k = 0; k < SCHEMA_KINDS; k++) {
        const struct schema_kind_row *row = &schema_kinds[k];
        bool value = row->group == SCHEMA_MATERIAL || row->group == SCHEMA_TEXTURE;
        bool again = row->group == SCHEMA_LIGHT && light;
        if (value || again || !(row->models >> e->out->model & 1))
            continue;
        light |= row->group == SCHEMA_LIGHT;
        struct str word = str_nth_word(row->native, 0);
        str_nearest_try(&nearest, word);
        buffer_printf(list, " %.*s", STR_ARG(word));
    }
    return str_nearest_found(&nearest);
}

/* Whether the name is only misspelt. */
static bool report_unknown_statement(struct eval *e, const struct ast_node *node, struct str meant,
                                     const struct buffer *kinds)
{
    const struct binding *b = scope_find(e, node->name);
    bool template = b && b->kind == BINDING_TEMPLATE;
    bool material = schema_find_kind(SCHEMA_MATERIAL, node->name, false) != SCHEMA_KINDS;
    bool misspelt = !template && !material && meant.n && !e->damaged.n;
    if (scope_told(e, node->name, node->name_span))
        return misspelt;
    struct diag_entry *entry = diag_report(e->diag, DIAG_UNKNOWN_KIND, node->name_span,
                                           "unknown kind '%.*s'", STR_ARG(node->name));
    if (template) {
        diag_note(entry, "a template is used with parentheses: '%.*s(...)'", STR_ARG(node->name));
    } else if (material) {
        struct str label = node->label.n ? node->label : str_of("NAME");
        diag_note(entry, "a material gets a name by 'material %.*s = %.*s { ... }'", STR_ARG(label),
                  STR_ARG(node->name));
    } else {
        diag_did_you_mean(entry, node->name_span, meant);
        diag_note(entry, "there are:%.*s", (int)kinds->n, kinds->at);
    }
    return misspelt;
}

/* ---- groups ---- */

static const enum schema_prop_id transforms[] = {PROP_TRANSLATE, PROP_ROTATE, PROP_GROUP_SCALE,
                                                 PROP_MATRIX};
enum { TRANSFORMS = sizeof transforms / sizeof *transforms };

/* Text that did not parse may give anything. */
static bool gives(const struct ast_node *members, enum schema_prop_id id)
{
    for (const struct ast_node *m = members; m; m = m->next)
        if (m->kind == AST_ERROR ||
            (m->kind == AST_PROPERTY && str_is(m->name, schema_props[id].native)))
            return true;
    return false;
}

/* A group or use while its members are evaluated, and what was around it. */
struct group {
    struct desc_object *object; /* its properties, in the memory of groups */
    struct place *outer_place;
    struct desc_prop *outer_material;
    struct arena_mark mark;
    unsigned inside;
};

/* The surfaces of a group share it; its value comes when the group's is known. */
static struct desc_prop *new_group_material(struct eval *e)
{
    struct desc_prop *p = arena_alloc(&e->out->arena, sizeof *p);
    *p = (struct desc_prop){.id = PROP_MATERIAL, .leaves = 1, .broken = true, .inherited = true};
    return p;
}

/* What the members will be given is made before they are evaluated and known after. */
static void group_open(struct eval *e, struct group *g, const struct ast_node *node,
                       const struct ast_node *members)
{
    *g = (struct group){.outer_place = e->place,
                        .outer_material = e->group_material,
                        .mark = arena_mark(&e->group_arena),
                        .inside = e->inside};
    g->object = object_new(e, &e->group_arena, KIND_GROUP, node);
    bool moves = false;
    for (int i = 0; i < TRANSFORMS; i++)
        moves |= gives(members, transforms[i]);
    if (moves) {
        struct place *p = arena_zalloc(&e->out->arena, 1, sizeof *p);
        *p = (struct place){.outer = e->place, .span = node->name_span};
        *e->last_place = p;
        e->last_place = &p->next;
        e->place = p;
    }
    if (gives(members, PROP_GROUP_MATERIAL))
        e->group_material = new_group_material(e);
    e->groups++;
}

static void report_both(struct eval *e, const struct desc_prop *one, const struct desc_prop *other)
{
    struct diag_entry *entry = diag_report(
        e->diag, DIAG_CONFLICT, other->name_span, "'%s' and '%s' cannot be given together",
        schema_props[one->id].native, schema_props[other->id].native);
    diag_label(entry, one->name_span, "'%s' is given here", schema_props[one->id].native);
}

/* The group's own transform; the identity after errors. */
static struct affine group_transform(struct eval *e, const struct desc_object *o)
{
    const struct affine identity = affine_scaling(vec3_all(1));
    const struct desc_prop *matrix = desc_find(o, PROP_MATRIX), *scale = NULL, *last = matrix;
    for (int i = 0; i < TRANSFORMS; i++) {
        const struct desc_prop *p = desc_find(o, transforms[i]);
        if (p && p->broken)
            return identity;
        if (p && matrix && p != matrix)
            report_both(e, matrix, p);
        if (p && transforms[i] == PROP_GROUP_SCALE)
            scale = p;
        last = p ? p : last;
    }
    struct affine t = affine_translation(desc_vector(o, PROP_TRANSLATE));
    struct affine r = affine_rotation(desc_vector(o, PROP_ROTATE));
    struct affine s = affine_scaling(desc_vector(o, PROP_GROUP_SCALE));
    struct affine rs = affine_times(&r, &s);
    struct affine all = matrix ? *matrix->value.matrix : affine_times(&t, &rs);
    double volume = affine_determinant(&all);
    if (volume != 0 && isfinite(volume))
        return all;
    const struct desc_prop *why = scale ? scale : last;
    diag_report(e->diag, DIAG_DEGENERATE, why->value.span,
                volume == 0 ? "'%s' leaves no volume: the group would be flat"
                            : "'%s' is too large",
                schema_props[why->id].native);
    return identity;
}

static void group_close(struct eval *e, struct group *g)
{
    const struct desc_prop *material = desc_find(g->object, PROP_GROUP_MATERIAL);
    if (e->group_material != g->outer_material && material) {
        e->group_material->value = material->value;
        e->group_material->name_span = material->name_span;
        e->group_material->broken = material->broken;
    }
    if (e->place != g->outer_place)
        e->place->affine = group_transform(e, g->object);
    e->groups--;
    e->place = g->outer_place;
    e->group_material = g->outer_material;
    e->inside = g->inside;
    arena_release(&e->group_arena, g->mark);
}

/* "group", "group wheels" */
static struct span group_words(const struct ast_node *node)
{
    struct span words = node->name_span;
    if (node->label.n)
        words.end = words.begin + (uint32_t)(node->label.at + node->label.n - node->name.at);
    return words;
}

static void eval_group(struct eval *e, const struct ast_node *node)
{
    struct scope *outer = e->scope, scope;
    struct frame frame;
    struct group g;
    frame_open(e, &frame, DIAG_FRAME_GROUP, group_words(node));
    group_open(e, &g, node, node->children);
    e->inside |= INSIDE_GROUP;
    scope_open(e, &scope, outer);
    scope.statements = node->children;
    for (const struct ast_node *m = node->children; m && !eval_stopped(e); m = m->next)
        if (m->kind == AST_PROPERTY)
            eval_property(e, &e->group_arena, g.object, m);
        else
            eval_statement(e, m);
    scope_close(e, outer);
    group_close(e, &g);
    frame_close(e, &frame);
}

/* Outer places come first in the list. */
void eval_places(struct eval *e)
{
    for (struct place *p = e->first_place; p; p = p->next) {
        if (p->outer)
            p->affine = affine_times(&p->outer->affine, &p->affine);
        double volume = affine_determinant(&p->affine);
        if (volume == 0 || !isfinite(volume))
            diag_report(e->diag, DIAG_NOT_FINITE, p->span,
                        "the transforms around this are too large or too small together");
    }
}

/* The statement as one of this kind; false when there is none. */
static bool eval_kind(struct eval *e, const struct ast_node *node, struct str name)
{
    enum schema_kind kind = schema_find_kind(SCHEMA_SURFACE, name, false);
    if (kind != SCHEMA_KINDS)
        add_surface(e, kind, node);
    else if (str_is(name, "light")) {
        kind = light_kind(e, node);
        if (kind != SCHEMA_KINDS)
            object_place(e, eval_block(e, kind, node));
    } else if (str_is(name, "group"))
        eval_group(e, node);
    else if (str_is(name, "camera"))
        set_only(e, KIND_CAMERA, node, &e->out->camera);
    else if (str_is(name, "settings"))
        set_only(e, KIND_SETTINGS, node, &e->out->settings);
    else
        return false;
    return true;
}

/* What is in a block of a misspelt kind is looked at as well, unless it may be what is left of text
 * that did not parse. */
void eval_object(struct eval *e, const struct ast_node *node)
{
    if (eval_kind(e, node, node->name))
        return;
    struct buffer kinds = {0};
    struct str meant = standing_kinds(e, node->name, &kinds);
    bool misspelt = report_unknown_statement(e, node, meant, &kinds);
    buffer_free(&kinds);
    if (!misspelt || !eval_kind(e, node, meant))
        e->out->incomplete = true;
}

/* ---- uses ---- */

static void report_unknown_template(struct eval *e, const struct ast_node *node,
                                    const struct binding *b)
{
    if (b ? b->kind == BINDING_VALUE && b->value.type == VALUE_ERROR
          : scope_lost(e, node->name, node->name_span))
        return;
    struct diag_entry *entry = diag_report(
        e->diag, DIAG_UNKNOWN_NAME, node->name_span,
        b ? "'%.*s' is no template" : "there is no template '%.*s'", STR_ARG(node->name));
    e->out->incomplete = true;
    if (b && b->kind != BINDING_VALUE)
        diag_note(entry, "a function gives a value; it is no statement");
    struct str_nearest nearest = str_nearest_to(node->name);
    scope_try_names(e, &nearest, 1u << BINDING_TEMPLATE);
    report_meant(e, entry, node, str_nearest_found(&nearest));
    if (schema_find_kind(SCHEMA_SURFACE, node->name, false) != SCHEMA_KINDS)
        diag_note(entry, "a surface is written '%.*s { ... }'", STR_ARG(node->name));
}

/* The template's body, where its own names are seen. */
static void eval_instance(struct eval *e, const struct binding *b, const struct ast_node *node,
                          const struct arguments *a)
{
    struct scope *outer = e->scope, scope;
    struct frame frame;
    const struct ast_node *body = b->node->children;
    while (body->kind == AST_PARAMETER)
        body = body->next;
    frame_open(e, &frame, DIAG_FRAME_USE, node->name_span);
    *b->busy = true;
    e->inside = INSIDE_TEMPLATE;
    scope_open(e, &scope, b->home);
    if (bind_arguments(e, b, a))
        eval_statements(e, body->children);
    scope_close(e, outer);
    *b->busy = false;
    frame_close(e, &frame);
}

/* The properties behind the arguments. */
static void eval_use_block(struct eval *e, struct desc_object *o, const struct ast_node *members)
{
    for (const struct ast_node *m = members; m; m = m->next)
        if (m->kind == AST_PROPERTY)
            eval_property(e, &e->group_arena, o, m);
        else if (m->kind != AST_ERROR)
            diag_report(e->diag, DIAG_MISPLACED, m->name_span,
                        "a use takes only the properties of a group");
}

static const struct ast_node *use_members(const struct ast_node *use)
{
    const struct ast_node *c = use->children;
    while (c && c->kind != AST_BODY)
        c = c->next;
    return c ? c->children : NULL;
}

void eval_use(struct eval *e, const struct ast_node *node)
{
    const struct binding *b = scope_find(e, node->name);
    struct arguments a;
    struct group g;
    if (!b || b->kind != BINDING_TEMPLATE) {
        report_unknown_template(e, node, b);
        return;
    }
    group_open(e, &g, node, use_members(node));
    eval_use_block(e, g.object, use_members(node));
    bool right = eval_arguments(e, b, node, &a) && eval_spend(e, STEPS_A_USE, node->span);
    if (*b->busy)
        diag_report(e->diag, DIAG_RECURSION, node->name_span, "'%.*s' uses itself",
                    STR_ARG(node->name));
    else if (e->groups > USES_LIMIT)
        diag_report(e->diag, DIAG_TOO_DEEP, node->name_span,
                    "groups and uses nested deeper than %d levels", USES_LIMIT);
    else if (right)
        eval_instance(e, b, node, &a);
    group_close(e, &g);
}

/* ---- default ---- */

/* The kind that the words of `default KIND { }` name; SCHEMA_KINDS: none. */
static enum schema_kind any_kind(struct str name)
{
    for (int k = 0; k < SCHEMA_KINDS; k++)
        if (str_is(name, schema_kinds[k].native))
            return (enum schema_kind)k;
    return SCHEMA_KINDS;
}

static enum schema_kind default_kind(struct eval *e, const struct ast_node *node)
{
    if (str_is(node->name, "light"))
        return light_kind(e, node);
    enum schema_kind kind = any_kind(node->name);
    if (kind == KIND_SETTINGS && !kind_exists(e, kind, node->name_span, false))
        return SCHEMA_KINDS;
    if (kind == SCHEMA_KINDS || kind == KIND_GROUP || node->label.n) {
        struct diag_entry *entry =
            diag_report(e->diag, DIAG_UNKNOWN_KIND, node->name_span,
                        kind == KIND_GROUP ? "'default' gives nothing to groups"
                        : node->label.n    ? "'default' takes a kind, and no label"
                                           : "unknown kind '%.*s'",
                        STR_ARG(node->name));
        struct str_nearest nearest = str_nearest_to(node->name);
        for (int k = 0; k < SCHEMA_KINDS && kind == SCHEMA_KINDS; k++)
            str_nearest_try(&nearest, str_of(schema_kinds[k].native));
        diag_did_you_mean(entry, node->name_span, str_nearest_found(&nearest));
        return SCHEMA_KINDS;
    }
    return kind;
}

void eval_default(struct eval *e, const struct ast_node *node)
{
    enum schema_kind kind = default_kind(e, node);
    if (kind == SCHEMA_KINDS)
        return;
    struct desc_object *o = eval_block(e, kind, node);
    struct fallback *f = arena_alloc(e->scratch, sizeof *f);
    *f = (struct fallback){e->scope->fallbacks, o};
    e->scope->fallbacks = f;
    e->fallback_kinds |= UINT32_C(1) << kind;
    vec_push(&e->out->defaults, o);
}
