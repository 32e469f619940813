#include "config.h"

#include "lsp/bindings.h"

#include "schema/schema.h"

static const struct span nowhere;

/* What is around a node on the way through the tree. */
struct around {
    struct span scope, function;
};

static bool holds(struct span outer, uint32_t at)
{
    return at >= outer.begin && at < outer.end;
}

/* ---- collecting ------------------------------------------------------------------------------ */

static void add_def(struct bindings *b, const struct ast_node *node, struct str name,
                    struct span span, struct span seen, uint32_t from)
{
    size_t last = (size_t)map_get(&b->last, name);
    vec_push(&b->defs, (struct name_def){.name = name,
                                         .span = span,
                                         .seen = seen,
                                         .from = from,
                                         .node = node,
                                         .next = last ? last - 1 : BINDING_NONE});
    map_set(&b->last, name, (void *)b->defs.n);
}

static void define(struct bindings *b, const struct ast_node *node, struct span seen, uint32_t from)
{
    add_def(b, node, node->name, node->name_span, seen, from);
}

static size_t use(struct bindings *b, const struct ast_node *node, const struct around *a,
                  size_t callee)
{
    vec_push(&b->uses, (struct name_use){.name = node->name,
                                         .span = node->name_span,
                                         .function = a->function,
                                         .callee = callee,
                                         .def = BINDING_NONE});
    return b->uses.n - 1;
}

static void walk(struct bindings *b, const struct ast_node *n, const struct around *a);

static void walk_all(struct bindings *b, const struct ast_node *first, const struct around *a)
{
    for (const struct ast_node *n = first; n; n = n->next)
        walk(b, n, a);
}

/* fn, define: parameters and what follows share a scope. */
static void walk_function(struct bindings *b, const struct ast_node *n, const struct around *a)
{
    struct around inner = {n->span, n->span};
    define(b, n, a->scope, n->span.begin);
    for (const struct ast_node *c = n->children; c; c = c->next) {
        if (c->kind == AST_PARAMETER)
            define(b, c, n->span, n->span.begin);
        walk_all(b, c->kind == AST_BODY || c->kind == AST_PARAMETER ? c->children : NULL, &inner);
        if (c->kind != AST_BODY && c->kind != AST_PARAMETER)
            walk(b, c, &inner);
    }
}

/* A name for each item of a sequence: the loop of statements, and that of a list. */
static void walk_loop(struct bindings *b, const struct ast_node *n, const struct ast_node *sequence,
                      const struct ast_node *body, const struct around *a)
{
    struct around inner = {body->span, a->function};
    walk(b, sequence, a);
    define(b, n, body->span, body->span.begin);
    walk_all(b, body->kind == AST_BODY ? body->children : NULL, &inner);
    if (body->kind != AST_BODY)
        walk(b, body, &inner);
}

static void walk_call(struct bindings *b, const struct ast_node *n, const struct around *a)
{
    size_t callee = use(b, n, a, BINDING_NONE);
    for (const struct ast_node *c = n->children; c; c = c->next) {
        if (c->kind == AST_ARGUMENT)
            use(b, c, a, callee);
        walk(b, c, a);
    }
}

/* A word that a property takes is no name. */
static bool is_word(const struct ast_node *property)
{
    const struct ast_node *value = property->children;
    if (!value || value->kind != AST_NAME)
        return false;
    for (int p = 0; p < SCHEMA_PROPS; p++)
        if (schema_props[p].type == TYPE_WORD && str_is(property->name, schema_props[p].native) &&
            schema_find_word((enum schema_prop_id)p, value->name, false) >= 0)
            return true;
    return false;
}

static bool is_kind(struct str name)
{
    return schema_find_kind(SCHEMA_MATERIAL, name, false) != SCHEMA_KINDS ||
           schema_find_kind(SCHEMA_TEXTURE, name, false) != SCHEMA_KINDS ||
           schema_find_kind(SCHEMA_SURFACE, name, false) != SCHEMA_KINDS;
}

static void walk(struct bindings *b, const struct ast_node *n, const struct around *a)
{
    struct around inner = {n->span, a->function};
    switch ((enum ast_kind)n->kind) {
    case AST_LET:
    case AST_PARAM:
    case AST_MATERIAL:
    case AST_TEXTURE:
        walk_all(b, n->children, a);
        define(b, n, a->scope, n->span.end);
        return;
    case AST_FN:
    case AST_DEFINE:
        walk_function(b, n, a);
        return;
    case AST_FOR:
        walk_loop(b, n, n->children, n->children->next, a);
        return;
    case AST_COMPREHENSION:
        walk_loop(b, n, n->children->next, n->children, a);
        return;
    case AST_USE:
    case AST_CALL:
        walk_call(b, n, a);
        return;
    case AST_NAME:
        use(b, n, a, BINDING_NONE);
        return;
    case AST_CONSTRUCT:
        if (!is_kind(n->name))
            use(b, n, a, BINDING_NONE);
        walk_all(b, n->children, a);
        return;
    case AST_PROPERTY:
        if (!is_word(n))
            walk_all(b, n->children, a);
        return;
    case AST_BODY:
    case AST_BLOCK:
        walk_all(b, n->children, &inner);
        return;
    default:
        walk_all(b, n->children, a);
    }
}

/* ---- XML: the ids of materials --------------------------------------------------------------- */

static struct span without_quotes(struct span s)
{
    return s.end - s.begin >= 2 ? (struct span){s.begin + 1, s.end - 1} : s;
}

static void walk_xml(struct bindings *b, const struct ast_node *n, struct span document)
{
    for (const struct ast_node *c = n->children; c; c = c->next) {
        if (c->kind == AST_BLOCK)
            walk_xml(b, c, document);
        if (c->kind != AST_ATTRIBUTE || !str_is(n->name, "material"))
            continue;
        struct str name = str_trim(c->children->text);
        struct span span = without_quotes(c->children->span);
        if (str_is(c->name, "id"))
            add_def(b, n, name, span, document, document.begin);
        else if (str_is(c->name, "ref"))
            vec_push(&b->uses,
                     (struct name_use){
                         .name = name, .span = span, .callee = BINDING_NONE, .def = BINDING_NONE});
    }
}

/* ---- meaning --------------------------------------------------------------------------------- */

/* A function is called later than it is defined, so it sees what follows in scopes around it. */
static bool is_seen(const struct name_def *d, uint32_t at, struct span function)
{
    bool later = function.begin > d->seen.begin && function.end <= d->seen.end;
    return holds(d->seen, at) && (at >= d->from || later);
}

size_t bindings_find(const struct bindings *b, struct str name, uint32_t at, struct span function)
{
    size_t last = (size_t)map_get(&b->last, name), best = BINDING_NONE;
    for (size_t i = last ? last - 1 : BINDING_NONE; i != BINDING_NONE; i = b->defs.at[i].next) {
        const struct name_def *d = &b->defs.at[i];
        bool inner = best == BINDING_NONE || d->seen.begin >= b->defs.at[best].seen.begin;
        if (inner && is_seen(d, at, function))
            best = i;
    }
    return best;
}

/* The parameter that an argument names. */
static size_t find_parameter(const struct bindings *b, const struct name_use *argument)
{
    size_t callee = b->uses.at[argument->callee].def;
    if (callee == BINDING_NONE)
        return BINDING_NONE;
    const struct ast_node *function = b->defs.at[callee].node;
    if (function->kind != AST_FN && function->kind != AST_DEFINE)
        return BINDING_NONE;
    for (const struct ast_node *p = function->children; p; p = p->next)
        if (p->kind == AST_PARAMETER && str_equal(p->name, argument->name))
            return bindings_find(b, p->name, p->name_span.begin, function->span);
    return BINDING_NONE;
}

/* Callees come before the names of their arguments. */
static void resolve(struct bindings *b)
{
    for (size_t i = 0; i < b->uses.n; i++) {
        struct name_use *u = &b->uses.at[i];
        u->def = u->callee == BINDING_NONE ? bindings_find(b, u->name, u->span.begin, u->function)
                                           : find_parameter(b, u);
    }
}

/* What files that are included define at their top. */
static void add_foreign(struct bindings *b, const struct desc *desc, struct span document)
{
    for (size_t i = 0; i < desc->included.n; i++) {
        const struct ast *ast = desc->included.at[i];
        for (const struct ast_node *n = ast->xml ? NULL : ast->statements; n; n = n->next) {
            if (n->kind != AST_LET && n->kind != AST_PARAM && n->kind != AST_MATERIAL &&
                n->kind != AST_TEXTURE && n->kind != AST_FN && n->kind != AST_DEFINE)
                continue;
            define(b, n, document, document.begin);
            b->defs.at[b->defs.n - 1].foreign = true;
        }
    }
}

void bindings_build(struct bindings *b, const struct ast *ast, const struct desc *desc)
{
    *b = (struct bindings){0};
    if (!ast->statements)
        return;
    uint32_t base = ast->source->base;
    struct around top = {{base, base + ast->source->n + 1}, nowhere};
    add_foreign(b, desc, top.scope);
    if (ast->xml)
        walk_xml(b, ast->statements, top.scope);
    else
        walk_all(b, ast->statements, &top);
    resolve(b);
}

void bindings_free(struct bindings *b)
{
    vec_free(&b->defs);
    vec_free(&b->uses);
    map_free(&b->last);
}

struct span bindings_function(const struct bindings *b, uint32_t at)
{
    struct span best = nowhere;
    for (size_t i = 0; i < b->defs.n; i++) {
        const struct name_def *d = &b->defs.at[i];
        bool function = d->node->kind == AST_FN || d->node->kind == AST_DEFINE;
        if (function && holds(d->node->span, at) && d->node->span.begin >= best.begin)
            best = d->node->span;
    }
    return best;
}

size_t bindings_at(const struct bindings *b, uint32_t at, struct span *place)
{
    for (size_t i = 0; i < b->uses.n; i++)
        if (at >= b->uses.at[i].span.begin && at <= b->uses.at[i].span.end) {
            *place = b->uses.at[i].span;
            return b->uses.at[i].def;
        }
    for (size_t i = 0; i < b->defs.n; i++)
        if (at >= b->defs.at[i].span.begin && at <= b->defs.at[i].span.end) {
            *place = b->defs.at[i].span;
            return i;
        }
    return BINDING_NONE;
}
