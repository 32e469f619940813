/* Values: literals, names, lists, choices; operators and calls are elsewhere. */
#include "config.h"

#include "eval/context.h"
#include "math/srgb.h"

#include <math.h>

/* ---- literals ---- */

static struct value eval_error(struct eval *e, const struct ast_node *node)
{
    (void)e;
    return value_error(node->span);
}

/* A number too large for a double was reported by the parser. */
static struct value eval_number(struct eval *e, const struct ast_node *node)
{
    (void)e;
    return isfinite(node->number) ? value_of_number(node->number) : value_error(node->span);
}

static struct value eval_angle(struct eval *e, const struct ast_node *node)
{
    double x = node->unit == AST_RADIANS ? node->number * (180 / PI) : node->number;
    (void)e;
    return isfinite(x) ? value_of_angle(x) : value_error(node->span);
}

static struct value eval_string(struct eval *e, const struct ast_node *node)
{
    (void)e;
    return (struct value){.type = VALUE_STRING, .string = node->text, .spelt = node->span.begin};
}

static struct value eval_bool(struct eval *e, const struct ast_node *node)
{
    (void)e;
    return (struct value){.type = VALUE_BOOL, .boolean = node->boolean};
}

/* #rrggbb: in classic each byte over 255, in modern the light that sRGB means by it. */
static struct value eval_colour(struct eval *e, const struct ast_node *node)
{
    struct value v = {.type = VALUE_VECTOR, .n = 3, .colour = true};
    for (int i = 0; i < 3; i++) {
        double x = (node->rgb >> (16 - 8 * i) & 0xFF) / 255.0;
        v.number[i] = e->out->model == SCHEMA_MODERN ? srgb_decode(x) : x;
    }
    return v;
}

static struct value eval_vector(struct eval *e, const struct ast_node *node)
{
    struct value v = {.type = VALUE_VECTOR};
    bool right = true;
    for (const struct ast_node *c = node->children; c; c = c->next) {
        struct value x = eval_value(e, c);
        right &= x.type == VALUE_NUMBER;
        if (x.type != VALUE_NUMBER && x.type != VALUE_ERROR)
            diag_report(e->diag, DIAG_WRONG_TYPE, c->span,
                        "a vector's component is a number, but this is %s", value_type_name(&x));
        if (x.type == VALUE_NUMBER && v.n < 3) {
            v.number[v.n] = x.number[0];
            v.angles |= (uint8_t)(x.angles << v.n);
        }
        v.n++;
    }
    if (v.n > 3)
        diag_report(e->diag, DIAG_WRONG_COUNT, node->span,
                    "a vector has two or three components, but here are %u", v.n);
    return right && v.n <= 3 ? v : value_error(node->span);
}

/* ---- lists ---- */

struct value value_item(const struct value *list, size_t i)
{
    if (list->items)
        return list->items[i];
    struct value v = value_of_number(list->first + (double)i * list->step);
    v.span = list->span;
    return v;
}

bool list_allowed(struct eval *e, double n, struct span span)
{
    bool right = n <= (double)e->options->max_objects && n <= UINT32_MAX;
    if (!right)
        diag_report(e->diag, DIAG_TOO_MANY_OBJECTS, span,
                    "a list of %.0f items is longer than the %zu objects that --max-objects allows",
                    n, e->options->max_objects);
    return right;
}

struct value *list_reserve(struct eval *e, size_t n, struct span span)
{
    bool right = list_allowed(e, (double)n, span) && eval_spend(e, n, span);
    return right ? eval_alloc(e, n * sizeof(struct value), span) : NULL;
}

static struct value eval_list(struct eval *e, const struct ast_node *node)
{
    struct value v = {.type = VALUE_LIST};
    struct value *items = list_reserve(e, ast_count(node->children), node->span);
    if (!items)
        return value_error(node->span);
    for (const struct ast_node *c = node->children; c; c = c->next)
        items[v.n++] = eval_value(e, c);
    v.items = items;
    return v;
}

static struct value eval_comprehension(struct eval *e, const struct ast_node *node)
{
    const struct ast_node *body = node->children;
    struct value sequence = eval_sequence(e, body->next);
    struct value *items =
        sequence.type == VALUE_LIST ? list_reserve(e, sequence.n, node->span) : NULL;
    if (!items)
        return value_error(node->span);
    struct scope *outer = e->scope, scope;
    struct frame frame;
    frame_open(e, &frame, DIAG_FRAME_ROUND, node->name_span);
    for (uint32_t i = 0; i < sequence.n; i++) {
        struct arena_mark mark = arena_mark(e->scratch);
        struct binding b = {
            .name = node->name, .span = node->name_span, .value = value_item(&sequence, i)};
        scope_open(e, &scope, outer);
        scope_add(&scope, &b);
        frame_next(&frame, &b.value, i);
        items[i] = eval_value(e, body);
        scope_close(e, outer);
        if (value_is_flat(&items[i]))
            arena_release(e->scratch, mark);
        if (eval_stopped(e) || e->given_up)
            break;
    }
    frame_close(e, &frame);
    if (eval_stopped(e) || e->given_up)
        return value_error(node->span);
    return (struct value){.type = VALUE_LIST, .n = sequence.n, .items = items};
}

/* ---- names ---- */

static void report_no_value(struct eval *e, const struct ast_node *node, const struct binding *b)
{
    bool template = b->kind == BINDING_TEMPLATE;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_WRONG_TYPE, node->span, "'%.*s' is a %s, not a value",
                    STR_ARG(node->name), template ? "template" : "function");
    if (template)
        diag_note(entry, "a template is used as a statement: %.*s(...)", STR_ARG(node->name));
    else
        diag_note(entry, "a function is called: %.*s(...)", STR_ARG(node->name));
}

static struct value eval_name(struct eval *e, const struct ast_node *node)
{
    const struct binding *b = scope_find(e, node->name);
    if (b && b->kind == BINDING_VALUE)
        return b->value;
    if (b)
        report_no_value(e, node, b);
    else
        report_undefined(e, SCHEMA_PROPS, node);
    return value_error(node->span);
}

/* ---- materials, textures, surfaces made in place ---- */

/* The kind that `name { ... }` makes, whatever its group; SCHEMA_KINDS: none. */
static enum schema_kind constructible_kind(struct str name)
{
    static const enum schema_group groups[] = {SCHEMA_MATERIAL, SCHEMA_TEXTURE, SCHEMA_SURFACE};
    for (size_t i = 0; i < sizeof groups / sizeof *groups; i++) {
        enum schema_kind k = schema_find_kind(groups[i], name, false);
        if (k != SCHEMA_KINDS)
            return k;
    }
    return SCHEMA_KINDS;
}

/* Returns the kind that was meant, or SCHEMA_KINDS. */
static enum schema_kind report_not_constructible(struct eval *e, const struct ast_node *node)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_KIND, node->name_span,
                    "'%.*s' is neither a kind nor a material or texture", STR_ARG(node->name));
    struct str_nearest nearest = str_nearest_to(node->name);
    for (int k = 0; k < SCHEMA_KINDS; k++)
        if (constructible_kind(str_of(schema_kinds[k].native)) != SCHEMA_KINDS)
            str_nearest_try(&nearest, str_of(schema_kinds[k].native));
    scope_try_names(e, &nearest, 1u << BINDING_VALUE);
    struct str meant = str_nearest_found(&nearest);
    bool told = report_meant(e, entry, node, meant);
    diag_note(entry,
              "the materials are: lambert phong shiny metal glass emissive; a texture is 'image'");
    return told ? constructible_kind(meant) : SCHEMA_KINDS;
}

/* `phong { ... }` makes an object; `gold { ... }` one like gold, with changes. */
static struct value eval_construct(struct eval *e, const struct ast_node *node)
{
    const struct binding *b = scope_find(e, node->name);
    const struct value *named = b && b->kind == BINDING_VALUE ? &b->value : NULL;
    const struct desc_object *base = named && named->type == VALUE_OBJECT ? named->object : NULL;
    enum schema_kind kind = base ? base->kind : b ? SCHEMA_KINDS : constructible_kind(node->name);
    if (named && named->type == VALUE_ERROR)
        return value_error(node->span);
    if (kind == SCHEMA_KINDS && (b || !scope_lost(e, node->name, node->name_span)))
        kind = report_not_constructible(e, node);
    if (kind == SCHEMA_KINDS)
        return value_error(node->span);
    struct desc_object *o = eval_block(e, kind, node);
    if (base)
        object_inherit(e, o, base);
    else
        object_complete(e, o);
    object_register(e, o);
    return (struct value){.type = VALUE_OBJECT, .object = o};
}

/* ---- parts of values ---- */

static struct value select_member(struct eval *e, const struct value *v, const struct ast_node *m)
{
    static const char components[] = "xyzrgb";
    const char *at = m->name.n == 1 ? memchr(components, *m->name.at, sizeof components - 1) : NULL;
    uint32_t i = at ? (uint32_t)(at - components) % 3 : 3;
    if (v->type == VALUE_VECTOR && i < v->n)
        return (struct value){
            .type = VALUE_NUMBER, .n = 1, .angles = value_is_angle(v, i), .number = {v->number[i]}};
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_WRONG_TYPE, m->name_span, "%s has no '%.*s'", value_type_name(v),
                    STR_ARG(m->name));
    if (v->type == VALUE_VECTOR)
        diag_note(entry, v->n == 2 ? "a pair has x y" : "a vector has x y z, or r g b");
    else
        diag_note(entry, "only vectors and colours have parts: x y z, or r g b");
    return value_error(m->span);
}

static void report_index(struct eval *e, const struct value *v, double i, struct span span)
{
    struct diag_entry *entry = diag_report(e->diag, DIAG_INDEX, span, "there is no item %.17g", i);
    if (v->n)
        diag_note(entry, "there are %u, from 0 to %u", v->n, v->n - 1);
    else
        diag_note(entry, "the list is empty");
}

static struct value select_item(struct eval *e, const struct value *v, const struct ast_node *node)
{
    struct value i = eval_value(e, node->children);
    bool indexed = v->type == VALUE_LIST || v->type == VALUE_VECTOR;
    if (i.type == VALUE_ERROR)
        return i;
    if (!indexed)
        diag_report(e->diag, DIAG_WRONG_TYPE, node->span, "%s has no items", value_type_name(v));
    else if (i.type != VALUE_NUMBER || i.angles || i.number[0] != floor(i.number[0]))
        diag_report(e->diag, DIAG_WRONG_TYPE, i.span, "an index is a whole number, but this is %s",
                    i.type == VALUE_NUMBER && !i.angles ? "not whole" : value_type_name(&i));
    else if (i.number[0] < 0 || i.number[0] >= v->n)
        report_index(e, v, i.number[0], i.span);
    else if (v->type == VALUE_LIST)
        return value_item(v, (size_t)i.number[0]);
    else {
        uint32_t at = (uint32_t)i.number[0];
        return value_is_angle(v, at) ? value_of_angle(v->number[at])
                                     : value_of_number(v->number[at]);
    }
    return value_error(node->span);
}

static struct value eval_select(struct eval *e, const struct ast_node *node)
{
    struct value v = eval_value(e, node->children);
    for (const struct ast_node *s = node->children->next; s && v.type != VALUE_ERROR; s = s->next) {
        v = s->kind == AST_MEMBER ? select_member(e, &v, s) : select_item(e, &v, s);
        v.span = span_join(node->span, s->span);
    }
    return v;
}

/* ---- operators ---- */

bool eval_condition(struct eval *e, const struct ast_node *node, bool *out)
{
    struct value v = eval_value(e, node);
    *out = v.type == VALUE_BOOL && v.boolean;
    if (v.type != VALUE_BOOL && v.type != VALUE_ERROR)
        diag_report(e->diag, DIAG_WRONG_TYPE, v.span, "expected true or false, but this is %s",
                    value_type_name(&v));
    return v.type == VALUE_BOOL;
}

/* a && b && ...: the rest is evaluated only while it matters. */
static struct value eval_logic(struct eval *e, const struct ast_node *node, bool goes_on)
{
    bool b = goes_on;
    for (const struct ast_node *c = node->children; c && b == goes_on; c = c->next)
        if (!eval_condition(e, c, &b))
            return value_error(node->span);
    return (struct value){.type = VALUE_BOOL, .boolean = b};
}

static struct value eval_chain(struct eval *e, const struct ast_node *node)
{
    const struct ast_node *c = node->children->next;
    if (c->operator== AST_AND || c->operator== AST_OR)
        return eval_logic(e, node, c->operator== AST_AND);
    struct value v = eval_value(e, node->children);
    for (; c; c = c->next) {
        struct value right = eval_value(e, c);
        struct span span = span_join(node->span, c->span);
        v = value_combine(e, (enum ast_operator)c->operator, & v, &right, span);
        v.span = span;
    }
    return v;
}

static struct value eval_prefix(struct eval *e, const struct ast_node *node)
{
    struct value v = eval_value(e, node->children);
    return value_prefix(e, (enum ast_operator)node->children->operator, & v, node->span);
}

static struct value eval_conditional(struct eval *e, const struct ast_node *node)
{
    bool first;
    if (!eval_condition(e, node->children, &first))
        return value_error(node->span);
    const struct ast_node *yes = node->children->next;
    return eval_value(e, first ? yes : yes->next);
}

static struct value eval_parentheses(struct eval *e, const struct ast_node *node)
{
    return eval_value(e, node->children);
}

/* ---- any ---- */

typedef struct value evaluator(struct eval *e, const struct ast_node *node);
static evaluator *const evaluators[AST_KINDS] = {
    [AST_ERROR] = eval_error,
    [AST_NUMBER] = eval_number,
    [AST_ANGLE] = eval_angle,
    [AST_STRING] = eval_string,
    [AST_BOOL] = eval_bool,
    [AST_COLOUR] = eval_colour,
    [AST_NAME] = eval_name,
    [AST_VECTOR] = eval_vector,
    [AST_LIST] = eval_list,
    [AST_COMPREHENSION] = eval_comprehension,
    [AST_CONSTRUCT] = eval_construct,
    [AST_CALL] = eval_call,
    [AST_SELECT] = eval_select,
    [AST_PREFIX] = eval_prefix,
    [AST_CHAIN] = eval_chain,
    [AST_CONDITIONAL] = eval_conditional,
    [AST_PARENTHESES] = eval_parentheses,
};

struct value eval_value(struct eval *e, const struct ast_node *node)
{
    struct value v;
    if (e->given_up || !eval_enter(e, node->span))
        return value_error(node->span);
    v = evaluators[node->kind](e, node);
    v.span = node->span;
    eval_leave(e);
    return v;
}

const char *value_type_name(const struct value *v)
{
    switch ((enum value_type)v->type) {
    case VALUE_NUMBER:
        return v->angles ? "an angle" : "a number";
    case VALUE_BOOL:
        return "true or false";
    case VALUE_STRING:
        return "a string";
    case VALUE_VECTOR:
        return v->colour   ? "a colour"
               : v->angles ? "a vector of angles"
               : v->n == 2 ? "a pair of numbers"
                           : "a vector";
    case VALUE_LIST:
        return "a list";
    case VALUE_OBJECT:
        return schema_kinds[v->object->kind].group == SCHEMA_MATERIAL  ? "a material"
               : schema_kinds[v->object->kind].group == SCHEMA_TEXTURE ? "a texture"
                                                                       : "a surface";
    case VALUE_NONE:
    case VALUE_ERROR:
        break;
    }
    return "an error";
}
