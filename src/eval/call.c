/* Calls of functions, and the arguments of functions and templates. */
#include "config.h"

#include "base/buffer.h"
#include "eval/context.h"
#include "eval/signature.h"

/* Calls of fn may nest this deep. */
enum { CALLS_LIMIT = 256 };

/* ---- parameters ---- */

static const struct ast_node *parameter_node(const struct binding *b, uint32_t i)
{
    const struct ast_node *p = b->node->children;
    while (i--)
        p = p->next;
    return p;
}

static struct str parameter_name(const struct binding *b, uint32_t i)
{
    return b->kind == BINDING_BUILTIN ? builtin_parameter(b->builtin, i)
                                      : parameter_node(b, i)->name;
}

static bool is_required(const struct binding *b, uint32_t i)
{
    return b->kind == BINDING_BUILTIN ? i < builtin_required(b->builtin)
                                      : !parameter_node(b, i)->children;
}

static uint32_t find_parameter(const struct binding *b, struct str name)
{
    uint32_t i = 0;
    while (i < b->parameters && !str_equal(parameter_name(b, i), name))
        i++;
    return i;
}

/* ---- wrong arguments ---- */

/* Shows what may be given: `ring(i, n = ...)`. */
static void add_signature(struct diag_entry *entry, const struct binding *b)
{
    struct buffer text = {0};
    for (uint32_t i = 0; i < b->parameters; i++) {
        buffer_puts(&text, i ? ", " : "");
        buffer_str(&text, parameter_name(b, i));
        buffer_puts(&text, is_required(b, i) ? "" : " = ...");
    }
    bool more = b->kind == BINDING_BUILTIN && builtin_takes_more(b->builtin);
    diag_note(entry, "it is written %.*s(%.*s%s)", STR_ARG(b->name), (int)text.n,
              text.n ? text.at : "", more ? ", ..." : "");
    if (b->kind != BINDING_BUILTIN)
        diag_label(entry, b->span, "defined here");
    buffer_free(&text);
}

static void report_unknown(struct eval *e, const struct binding *b, const struct ast_node *argument)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_ARGUMENTS, argument->name_span, "'%.*s' has no parameter '%.*s'",
                    STR_ARG(b->name), STR_ARG(argument->name));
    struct str_nearest nearest = str_nearest_to(argument->name);
    for (uint32_t i = 0; i < b->parameters; i++)
        str_nearest_try(&nearest, parameter_name(b, i));
    diag_did_you_mean(entry, argument->name_span, str_nearest_found(&nearest));
    add_signature(entry, b);
}

static void report_surplus(struct eval *e, const struct binding *b, const struct ast_node *argument)
{
    struct diag_entry *entry = diag_report(
        e->diag, DIAG_ARGUMENTS, argument->span, "'%.*s' takes no more than %u argument%s",
        STR_ARG(b->name), b->parameters, b->parameters == 1 ? "" : "s");
    add_signature(entry, b);
}

static bool report_missing(struct eval *e, const struct binding *b, const struct ast_node *use,
                           const struct arguments *a)
{
    bool right = true;
    for (uint32_t i = 0; i < b->parameters; i++) {
        if (a->at[i].type != VALUE_NONE || !is_required(b, i))
            continue;
        struct diag_entry *entry =
            diag_report(e->diag, DIAG_ARGUMENTS, use->name_span, "'%.*s' is not given '%.*s'",
                        STR_ARG(b->name), STR_ARG(parameter_name(b, i)));
        add_signature(entry, b);
        right = false;
    }
    return right;
}

/* ---- arguments to parameters ---- */

/* The slot of an argument: `position` counts those without a name.  a->n after reporting. */
static uint32_t find_slot(struct eval *e, const struct binding *b, const struct ast_node *argument,
                          uint32_t *position, bool named, const struct arguments *a)
{
    if (argument->kind == AST_ARGUMENT) {
        uint32_t i = find_parameter(b, argument->name);
        if (i == b->parameters)
            report_unknown(e, b, argument);
        else if (a->at[i].type != VALUE_NONE)
            diag_report(e->diag, DIAG_ARGUMENTS, argument->name_span,
                        "'%.*s' is given '%.*s' twice", STR_ARG(b->name), STR_ARG(argument->name));
        else
            return i;
    } else if (named) {
        diag_report(e->diag, DIAG_ARGUMENTS, argument->span,
                    "an argument without a name cannot follow one with a name");
    } else if (*position == a->n) {
        report_surplus(e, b, argument);
    } else {
        return (*position)++;
    }
    return a->n;
}

static uint32_t count_slots(const struct binding *b, const struct ast_node *use)
{
    size_t given = ast_count(use->children);
    bool more = b->kind == BINDING_BUILTIN && builtin_takes_more(b->builtin);
    return more && given > b->parameters ? (uint32_t)given : b->parameters;
}

bool eval_arguments(struct eval *e, const struct binding *b, const struct ast_node *use,
                    struct arguments *a)
{
    uint32_t position = 0;
    bool named = false, placed = true, right = true;
    a->n = count_slots(b, use);
    a->at = arena_zalloc(e->scratch, a->n, sizeof *a->at);
    for (const struct ast_node *c = use->children; c && c->kind != AST_BODY; c = c->next) {
        uint32_t slot = find_slot(e, b, c, &position, named, a);
        named |= c->kind == AST_ARGUMENT;
        struct value v = eval_value(e, c->kind == AST_ARGUMENT ? c->children : c);
        placed &= slot < a->n;
        right &= v.type != VALUE_ERROR;
        if (slot < a->n)
            a->at[slot] = v;
    }
    return placed && report_missing(e, b, use, a) && right;
}

bool bind_arguments(struct eval *e, const struct binding *b, const struct arguments *a)
{
    const struct ast_node *p = b->node->children;
    struct binding *bindings = arena_zalloc(e->scratch, a->n, sizeof *bindings);
    bool right = true;
    for (uint32_t i = 0; i < a->n; i++, p = p->next) {
        bool given = a->at[i].type != VALUE_NONE;
        bindings[i] = (struct binding){.name = p->name,
                                       .span = p->name_span,
                                       .value = given ? a->at[i] : eval_value(e, p->children)};
        right &= bindings[i].value.type != VALUE_ERROR;
        scope_add(e->scope, &bindings[i]);
    }
    return right;
}

/* ---- calls ---- */

static struct value call_function(struct eval *e, const struct binding *b,
                                  const struct ast_node *call, const struct arguments *a)
{
    struct scope *outer = e->scope, scope;
    struct frame frame;
    struct value v = value_error(call->span);
    frame_open(e, &frame, DIAG_FRAME_CALL, call->name_span);
    if (e->calls == CALLS_LIMIT) {
        diag_report(e->diag, DIAG_TOO_DEEP, call->span, "calls nested deeper than %d levels",
                    CALLS_LIMIT);
        e->given_up = true;
    } else {
        e->calls++;
        scope_open(e, &scope, b->home);
        if (bind_arguments(e, b, a))
            v = eval_value(e, parameter_node(b, b->parameters));
        scope_close(e, outer);
        e->calls--;
    }
    frame_close(e, &frame);
    return v;
}

/* Arguments of a call to nothing still show their own mistakes. */
static struct value eval_stray_call(struct eval *e, const struct ast_node *node)
{
    for (const struct ast_node *c = node->children; c; c = c->next)
        eval_value(e, c->kind == AST_ARGUMENT ? c->children : c);
    return value_error(node->span);
}

static void report_unknown_function(struct eval *e, const struct ast_node *node)
{
    if (scope_lost(e, node->name, node->name_span))
        return;
    struct diag_entry *entry = diag_report(e->diag, DIAG_UNKNOWN_NAME, node->name_span,
                                           "there is no function '%.*s'", STR_ARG(node->name));
    struct str_nearest nearest = str_nearest_to(node->name);
    scope_try_names(e, &nearest, 1u << BINDING_FUNCTION | 1u << BINDING_BUILTIN);
    struct str meant = signature_meant(node->name);
    report_meant(e, entry, node, meant.n ? meant : str_nearest_found(&nearest));
    if (str_is(node->name, "pow"))
        diag_note(entry, "a power is written 'x ^ y'");
    if (schema_find_kind(SCHEMA_MATERIAL, node->name, false) != SCHEMA_KINDS)
        diag_note(entry, "a material is written '%.*s { ... }'", STR_ARG(node->name));
}

static void report_no_function(struct eval *e, const struct ast_node *node, const struct binding *b)
{
    if (b->kind == BINDING_TEMPLATE)
        diag_report(e->diag, DIAG_WRONG_TYPE, node->span,
                    "'%.*s' is a template: it makes objects, not a value", STR_ARG(node->name));
    else if (b->value.type != VALUE_ERROR)
        diag_report(e->diag, DIAG_WRONG_TYPE, node->name_span, "'%.*s' is %s, not a function",
                    STR_ARG(node->name), value_type_name(&b->value));
}

struct value eval_call(struct eval *e, const struct ast_node *node)
{
    const struct binding *b = scope_find(e, node->name);
    struct arena_mark mark = arena_mark(e->scratch);
    struct arguments arguments;
    if (!b)
        report_unknown_function(e, node);
    else if (b->kind != BINDING_FUNCTION && b->kind != BINDING_BUILTIN)
        report_no_function(e, node, b);
    if (!b || (b->kind != BINDING_FUNCTION && b->kind != BINDING_BUILTIN))
        return eval_stray_call(e, node);
    if (!eval_arguments(e, b, node, &arguments) || !eval_spend(e, 1, node->span))
        return value_error(node->span);
    struct value v = b->kind == BINDING_FUNCTION ? call_function(e, b, node, &arguments)
                                                 : builtin_call(e, b->builtin, node, &arguments);
    if (value_is_flat(&v))
        arena_release(e->scratch, mark);
    return v;
}
