/* Statements of the native language. */
#include "config.h"

#include "eval/context.h"

/* ---- names ---- */

/* NULL after reporting that the scope has the name. */
static struct binding *bind_value(struct eval *e, const struct ast_node *node,
                                  const struct value *v)
{
    struct binding *b = scope_bind(e, node->name, node->name_span, BINDING_VALUE);
    if (b)
        b->value = *v;
    return b;
}

static void eval_let(struct eval *e, const struct ast_node *node)
{
    struct value v = eval_value(e, node->children);
    bind_value(e, node, &v);
}

/* What -D gives.  A word that means nothing is a text, where the scene's own value is one. */
static struct value eval_define_value(struct eval *e, const struct ast_node *given,
                                      const struct value *own)
{
    bool word = given->kind == AST_NAME && own->type == VALUE_STRING && !scope_find(e, given->name);
    if (!word)
        return eval_value(e, given);
    return (struct value){.type = VALUE_STRING,
                          .span = given->span,
                          .string = given->name,
                          .spelt = given->span.begin};
}

/* One number may stand for several. */
static bool same_type(const struct value *a, const struct value *b)
{
    if (a->type == VALUE_OBJECT && b->type == VALUE_OBJECT)
        return schema_kinds[a->object->kind].group == schema_kinds[b->object->kind].group;
    return a->type == b->type || (value_is_numeric(a) && value_is_numeric(b));
}

/* What an option gives, such as --frames, is right: the scene's own value is not. */
static void report_given(struct eval *e, const struct ast_node *param, const struct value *own,
                         const struct value *given)
{
    diag_report(e->diag, DIAG_WRONG_TYPE, own->span,
                "--frames makes the param '%.*s' %s, but it is %s", STR_ARG(param->name),
                value_type_name(given), value_type_name(own));
}

/* A text that is no expression has no place but where it starts. */
static void report_define(struct eval *e, const struct ast_node *param, const struct value *own,
                          const struct value *given)
{
    const struct source *s = srcmap_source(e->diag->sources, given->span.begin);
    bool plain = given->span.begin == given->span.end;
    struct span span = plain ? (struct span){s->base, s->base + s->n} : given->span;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_WRONG_TYPE, span, "the param '%.*s' is %s, but this is %s",
                    STR_ARG(param->name), value_type_name(own), value_type_name(given));
    diag_label(entry, param->name_span, "the param and its own value");
    if (plain)
        diag_note(entry, "what is no expression is taken as a string");
}

static struct value eval_define(struct eval *e, size_t i, const struct ast_node *param,
                                const struct value *own)
{
    struct value v = eval_define_value(e, e->options->defines[i].value, own);
    e->define_used[i] = true;
    vec_push(&e->out->overridden, param->name_span);
    if (v.type == VALUE_ERROR || own->type == VALUE_ERROR || same_type(own, &v))
        return v;
    (e->options->defines[i].optional ? report_given : report_define)(e, param, own, &v);
    return value_error(v.span);
}

static void eval_param(struct eval *e, const struct ast_node *node)
{
    const struct value own = eval_value(e, node->children);
    struct value v = own;
    for (size_t i = 0; i < e->options->define_count; i++)
        if (str_equal(e->options->defines[i].name, node->name))
            v = eval_define(e, i, node, &own);
    struct binding *b = bind_value(e, node, &v);
    if (b)
        b->param = true;
}

/* `material a = v` and `texture a = v`: a let that says what v is. */
static void eval_named(struct eval *e, const struct ast_node *node)
{
    enum schema_group group = node->kind == AST_MATERIAL ? SCHEMA_MATERIAL : SCHEMA_TEXTURE;
    struct value v = eval_value(e, node->children);
    bool fits = v.type == VALUE_OBJECT && schema_kinds[v.object->kind].group == group;
    if (v.type != VALUE_ERROR && !fits) {
        diag_report(e->diag, DIAG_WRONG_TYPE, v.span, "expected a %s, but found %s",
                    schema_group_name(group), value_type_name(&v));
        v.type = VALUE_ERROR;
    }
    if (fits && !v.object->name.n)
        v.object->name = node->name;
    bind_value(e, node, &v);
}

static void report_twice(struct eval *e, const struct ast_node *parameter,
                         const struct ast_node *first)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_DUPLICATE_NAME, parameter->name_span,
                    "two parameters are called '%.*s'", STR_ARG(parameter->name));
    diag_label(entry, first->name_span, "the first is here");
}

/* `fn f(a) = v` and `define d(a) { ... }` */
static void eval_routine(struct eval *e, const struct ast_node *node)
{
    enum binding_kind kind = node->kind == AST_FN ? BINDING_FUNCTION : BINDING_TEMPLATE;
    uint32_t n = 0;
    for (const struct ast_node *p = node->children; p->kind == AST_PARAMETER; p = p->next, n++)
        for (const struct ast_node *q = node->children; q != p; q = q->next)
            if (str_equal(p->name, q->name))
                report_twice(e, p, q);
    struct binding *b = scope_bind(e, node->name, node->name_span, kind);
    if (!b)
        return;
    b->parameters = n;
    b->node = node;
    b->home = e->scope;
    b->busy = arena_zalloc(e->scratch, 1, sizeof *b->busy);
}

/* ---- the model ---- */

void eval_model(struct eval *e, struct str name, struct span span)
{
    if (str_is(name, "classic"))
        e->out->model = SCHEMA_CLASSIC;
    else if (str_is(name, "modern"))
        e->out->model = SCHEMA_MODERN;
    else {
        struct diag_entry *entry =
            diag_report(e->diag, DIAG_MODEL, span, "there is no model '%.*s'", STR_ARG(name));
        struct str_nearest nearest = str_nearest_to(name);
        str_nearest_try(&nearest, str_of("classic"));
        str_nearest_try(&nearest, str_of("modern"));
        struct str meant = str_nearest_found(&nearest);
        diag_did_you_mean(entry, span, meant);
        diag_note(entry, "there are: classic modern");
        e->out->model = str_is(meant, "modern") ? SCHEMA_MODERN : SCHEMA_CLASSIC;
        e->model_unknown = true;
    }
}

void eval_same_model(struct eval *e, struct str name, struct span span)
{
    enum schema_model scene = e->out->model;
    eval_model(e, name, span);
    if (e->out->model != scene) {
        struct diag_entry *entry = diag_report(
            e->diag, DIAG_MODEL, span, "this file is for the model '%.*s', but the scene is %s",
            STR_ARG(name), schema_model_name(scene));
        diag_label(entry, e->out->model_span, "the scene's model");
    }
    e->out->model = scene;
}

/* The scene's own was taken before anything else. */
static void eval_model_statement(struct eval *e, const struct ast_node *node)
{
    if (modules_inside(e)) {
        eval_same_model(e, node->name, node->name_span);
    } else if (node != e->model) {
        struct diag_entry *entry = diag_report(e->diag, DIAG_DUPLICATE_OBJECT, node->name_span,
                                               "the model is given twice");
        diag_label(entry, e->model->name_span, "first given here");
    }
}

/* ---- control ---- */

struct value eval_sequence(struct eval *e, const struct ast_node *node)
{
    struct value v = eval_value(e, node);
    if (v.type == VALUE_LIST || v.type == VALUE_ERROR)
        return v;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_WRONG_TYPE, v.span, "'for' goes through a list, but this is %s",
                    value_type_name(&v));
    if (v.type == VALUE_NUMBER && !v.angles) {
        struct str text = srcmap_text(e->diag->sources, v.span);
        diag_note(entry, "range(n) is the list 0, 1, ... below n");
        diag_fix(entry, v.span, DIAG_FIX_MAYBE, "range(%.*s)", STR_ARG(text));
    }
    return value_error(node->span);
}

/* The members of a body, in a scope of their own inside the current one. */
static void eval_branch(struct eval *e, const struct ast_node *body, struct binding *variable)
{
    struct scope *outer = e->scope, scope;
    unsigned inside = e->inside;
    e->inside |= INSIDE_BRANCH;
    scope_open(e, &scope, outer);
    if (variable)
        scope_add(&scope, variable);
    eval_statements(e, body->children);
    scope_close(e, outer);
    e->inside = inside;
}

static void eval_for(struct eval *e, const struct ast_node *node)
{
    struct value list = eval_sequence(e, node->children);
    struct frame frame;
    if (list.type != VALUE_LIST)
        return;
    frame_open(e, &frame, DIAG_FRAME_ROUND, node->name_span);
    for (uint32_t i = 0; i < list.n && !eval_stopped(e) && eval_spend(e, 1, node->span); i++) {
        struct arena_mark mark = arena_mark(e->scratch);
        struct binding b = {
            .name = node->name, .span = node->name_span, .value = value_item(&list, i)};
        frame_next(&frame, &b.value, i);
        eval_branch(e, node->children->next, &b);
        arena_release(e->scratch, mark);
    }
    frame_close(e, &frame);
}

static void eval_if(struct eval *e, const struct ast_node *node)
{
    for (bool yes; node;) {
        const struct ast_node *body = node->children->next;
        if (!eval_condition(e, node->children, &yes))
            return;
        const struct ast_node *taken = yes ? body : body->next;
        if (taken && taken->kind == AST_BODY)
            eval_branch(e, taken, NULL);
        node = taken && taken->kind == AST_IF ? taken : NULL; /* else if */
    }
}

static void eval_assert(struct eval *e, const struct ast_node *node)
{
    bool holds;
    if (!eval_condition(e, node->children, &holds) || holds)
        return;
    struct value v = eval_value(e, node->children->next);
    if (v.type == VALUE_STRING)
        diag_report(e->diag, DIAG_ASSERTION, node->children->span, "%.*s", STR_ARG(v.string));
    else if (v.type != VALUE_ERROR)
        diag_report(e->diag, DIAG_WRONG_TYPE, v.span,
                    "the message of 'assert' is a string, but this is %s", value_type_name(&v));
}

/* ---- any statement ---- */

static const struct rule {
    void (*run)(struct eval *e, const struct ast_node *node);
    const char *word;
    unsigned banned; /* enum inside: bodies it cannot stand in */
    bool keeps;      /* what it makes outlives it */
} rules[AST_KINDS] = {
    [AST_MODEL] = {eval_model_statement, "model", INSIDE_BRANCH | INSIDE_GROUP | INSIDE_TEMPLATE,
                   false},
    [AST_INCLUDE] = {eval_include, "include", 0, true},
    [AST_LET] = {eval_let, "let", 0, true},
    [AST_PARAM] = {eval_param, "param", INSIDE_BRANCH | INSIDE_GROUP | INSIDE_TEMPLATE, true},
    [AST_MATERIAL] = {eval_named, "material", 0, true},
    [AST_TEXTURE] = {eval_named, "texture", 0, true},
    [AST_FN] = {eval_routine, "fn", 0, true},
    [AST_DEFINE] = {eval_routine, "define", INSIDE_BRANCH, true},
    [AST_DEFAULT] = {eval_default, "default", 0, true},
    [AST_ASSERT] = {eval_assert, "assert", 0, false},
    [AST_FOR] = {eval_for, "for", 0, false},
    [AST_IF] = {eval_if, "if", 0, false},
    [AST_USE] = {eval_use, "a use", 0, false},
    [AST_BLOCK] = {eval_object, "an object", 0, false},
};

static const char *body_words(unsigned inside)
{
    return inside & INSIDE_BRANCH  ? "the body of 'for' or 'if'"
           : inside & INSIDE_GROUP ? "a group"
                                   : "the body of 'define'";
}

void eval_statement(struct eval *e, const struct ast_node *node)
{
    const struct rule *r = &rules[node->kind];
    if (node->kind == AST_ERROR) {
        struct str text = srcmap_text(e->diag->sources, node->span);
        vec_push(&e->damaged, node->span);
        e->defaults_lost |= memmem(text.at, text.n, "default", strlen("default")) != NULL;
    }
    if (!r->run) /* AST_VERSION says nothing more */
        return;
    if (e->inside & r->banned) {
        diag_report(e->diag, DIAG_MISPLACED, node->name_span, "'%s' cannot stand in %s", r->word,
                    body_words(e->inside & r->banned));
        return;
    }
    struct arena_mark mark = arena_mark(e->scratch);
    e->given_up = false;
    if (eval_enter(e, node->span))
        r->run(e, node);
    eval_leave(e);
    if (!r->keeps)
        arena_release(e->scratch, mark);
}

void eval_statements(struct eval *e, const struct ast_node *first)
{
    bool damaged = false; /* properties right behind what did not parse are left over from it */
    e->scope->statements = first;
    for (const struct ast_node *s = first; s && !eval_stopped(e); s = s->next) {
        if (s->kind != AST_PROPERTY)
            eval_statement(e, s);
        else if (!damaged)
            diag_report(e->diag, DIAG_MISPLACED, s->name_span,
                        "a property cannot stand here, outside an object");
        damaged = ast_is_damaged(s) || (damaged && s->kind == AST_PROPERTY);
    }
}

/* ---- a scene ---- */

/* The model holds for the whole scene, wherever it stands.  Without a name the scene is modern,
 * unless the name may stand in what did not parse. */
static void take_model(struct eval *e, const struct ast_node *statements)
{
    bool damaged = false;
    e->out->model = SCHEMA_MODERN;
    e->out->model_span = e->out->start;
    for (const struct ast_node *s = statements; s; s = s->next) {
        damaged |= s->kind == AST_ERROR;
        if (s->kind != AST_MODEL)
            continue;
        e->model = s;
        e->out->model_span = s->name_span;
        eval_model(e, s->name, s->name_span);
        return;
    }
    e->model_unknown = damaged;
}

void eval_native(struct eval *e, const struct ast_node *statements)
{
    take_model(e, statements);
    eval_statements(e, statements);
}
