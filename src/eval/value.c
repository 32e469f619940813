/* Values of the native language. */
#include "config.h"

#include "eval/context.h"

#include <math.h>

static struct value error_at(const struct ast_node *node)
{
    return (struct value){.type = VALUE_ERROR, .span = node->span};
}

static struct value number_value(enum value_type type, double x)
{
    return (struct value){.type = type, .n = 1, .number = {x}};
}

static struct value eval_angle(const struct ast_node *node)
{
    double x = node->number;
    return number_value(VALUE_ANGLE, node->unit == AST_RADIANS ? x * (180 / M_PI) : x);
}

/* #rrggbb in classic: each byte over 255. */
static struct value eval_colour(const struct ast_node *node)
{
    struct value v = {.type = VALUE_COLOUR, .n = 3};
    for (int i = 0; i < 3; i++)
        v.number[i] = (node->rgb >> (16 - 8 * i) & 0xFF) / 255.0;
    return v;
}

static struct value not_available(struct eval *e, const struct ast_node *node)
{
    diag_report(e->diag, DIAG_MISPLACED, node->span,
                "expressions are not evaluated by this version");
    return error_at(node);
}

static struct value eval_vector(struct eval *e, const struct ast_node *node)
{
    struct value v = {.type = VALUE_VECTOR};
    size_t n = ast_count(node->children);
    if (n > 3) {
        diag_report(e->diag, DIAG_WRONG_COUNT, node->span,
                    "a vector has two or three components, but here are %zu", n);
        return error_at(node);
    }
    for (const struct ast_node *c = node->children; c; c = c->next) {
        struct value x = eval_value(e, c);
        if (x.type == VALUE_NUMBER || x.type == VALUE_ANGLE) {
            v.number[v.n++] = x.number[0];
            continue;
        }
        if (x.type != VALUE_ERROR)
            diag_report(e->diag, DIAG_WRONG_TYPE, c->span,
                        "a vector's component is a number, but this is %s", value_type_name(&x));
        return error_at(node);
    }
    return v;
}

static struct value eval_list(struct eval *e, const struct ast_node *node)
{
    struct value v = {.type = VALUE_LIST};
    size_t n = ast_count(node->children);
    v.items = arena_zalloc(&e->out->arena, n, sizeof *v.items);
    for (const struct ast_node *c = node->children; c; c = c->next)
        v.items[v.n++] = eval_value(e, c);
    return v;
}

static struct value eval_negate(struct eval *e, const struct ast_node *node)
{
    if (node->children->operator!= AST_NEGATE)
        return not_available(e, node);
    struct value v = eval_value(e, node->children);
    if (v.type != VALUE_NUMBER && v.type != VALUE_ANGLE && v.type != VALUE_VECTOR) {
        if (v.type != VALUE_ERROR)
            diag_report(e->diag, DIAG_WRONG_TYPE, node->span, "'-' cannot be applied to %s",
                        value_type_name(&v));
        return error_at(node);
    }
    for (uint32_t i = 0; i < v.n; i++)
        v.number[i] = -v.number[i];
    return v;
}

static struct value eval_name(struct eval *e, const struct ast_node *node)
{
    const struct binding *b = map_get(&e->names, node->name);
    if (b)
        return b->value;
    struct diag_entry *entry = diag_report(e->diag, DIAG_UNKNOWN_NAME, node->span,
                                           "'%.*s' is not defined", STR_ARG(node->name));
    struct str_nearest nearest = str_nearest_to(node->name);
    try_defined_names(e, &nearest);
    diag_did_you_mean(entry, node->span, str_nearest_found(&nearest));
    return error_at(node);
}

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

static void report_not_constructible(struct eval *e, const struct ast_node *node)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_KIND, node->name_span,
                    "'%.*s' is neither a kind nor a material or texture", STR_ARG(node->name));
    struct str_nearest nearest = str_nearest_to(node->name);
    for (int k = 0; k < SCHEMA_KINDS; k++)
        if (constructible_kind(str_of(schema_kinds[k].native)) != SCHEMA_KINDS)
            str_nearest_try(&nearest, str_of(schema_kinds[k].native));
    try_defined_names(e, &nearest);
    diag_did_you_mean(entry, node->name_span, str_nearest_found(&nearest));
    diag_note(entry,
              "the materials are: lambert phong shiny metal glass emissive; a texture is 'image'");
}

/* `phong { ... }` makes an object; `gold { ... }` one like gold, with changes. */
static struct value eval_construct(struct eval *e, const struct ast_node *node)
{
    const struct binding *b = map_get(&e->names, node->name);
    const struct desc_object *base = b && b->value.type == VALUE_OBJECT ? b->value.object : NULL;
    if (b && b->value.type == VALUE_ERROR)
        return error_at(node);
    enum schema_kind kind = base ? base->kind : constructible_kind(node->name);
    if (kind == SCHEMA_KINDS || (b && !base)) {
        report_not_constructible(e, node);
        return error_at(node);
    }
    struct value v = {.type = VALUE_OBJECT, .object = eval_block(e, kind, node, base)};
    object_register(e, v.object);
    return v;
}

static struct value eval_by_kind(struct eval *e, const struct ast_node *node)
{
    switch (node->kind) {
    case AST_NUMBER:
        return number_value(VALUE_NUMBER, node->number);
    case AST_ANGLE:
        return eval_angle(node);
    case AST_STRING:
        return (struct value){.type = VALUE_STRING, .string = node->text};
    case AST_BOOL:
        return (struct value){.type = VALUE_BOOL, .boolean = node->boolean};
    case AST_COLOUR:
        return eval_colour(node);
    case AST_VECTOR:
        return eval_vector(e, node);
    case AST_LIST:
        return eval_list(e, node);
    case AST_PARENTHESES:
        return eval_value(e, node->children);
    case AST_PREFIX:
        return eval_negate(e, node);
    case AST_NAME:
        return eval_name(e, node);
    case AST_CONSTRUCT:
        return eval_construct(e, node);
    case AST_ERROR:
        return error_at(node);
    default:
        return not_available(e, node);
    }
}

struct value eval_value(struct eval *e, const struct ast_node *node)
{
    struct value v = eval_by_kind(e, node);
    v.span = node->span;
    return v;
}

const char *value_type_name(const struct value *v)
{
    switch (v->type) {
    case VALUE_NUMBER:
        return "a number";
    case VALUE_ANGLE:
        return "an angle";
    case VALUE_BOOL:
        return "true or false";
    case VALUE_STRING:
        return "a string";
    case VALUE_VECTOR:
        return v->n == 2 ? "a pair of numbers" : "a vector";
    case VALUE_COLOUR:
        return "a colour";
    case VALUE_LIST:
        return "a list";
    case VALUE_OBJECT:
        return schema_kinds[v->object->kind].group == SCHEMA_MATERIAL  ? "a material"
               : schema_kinds[v->object->kind].group == SCHEMA_TEXTURE ? "a texture"
                                                                       : "a surface";
    case VALUE_ERROR:
        break;
    }
    return "an error";
}
