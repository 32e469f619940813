#include "config.h"

#include "lsp/locate.h"

/* The child that holds the place, or else the one that ends there. */
static const struct ast_node *child_at(const struct ast_node *first, uint32_t at)
{
    const struct ast_node *before = NULL;
    for (const struct ast_node *n = first; n; n = n->next) {
        if (at >= n->span.begin && at < n->span.end)
            return n;
        if (at == n->span.end)
            before = n;
    }
    return before;
}

void locate(struct locate_path *path, const struct ast *ast, uint32_t at)
{
    *path = (struct locate_path){0};
    for (const struct ast_node *n = child_at(ast->statements, at); n; n = child_at(n->children, at))
        vec_push(&path->nodes, n);
}

enum schema_kind locate_kind_by_words(struct str first, struct str second)
{
    enum schema_kind kind = SCHEMA_KINDS;
    if (str_is(first, "light"))
        return schema_find_kind(SCHEMA_LIGHT, second, false);
    for (int g = 0; g < SCHEMA_GROUPS && kind == SCHEMA_KINDS; g++)
        if (g != SCHEMA_LIGHT)
            kind = schema_find_kind((enum schema_group)g, first, false);
    return kind;
}

/* Definitions may name each other in a circle while they are written. */
enum { CHAIN_LIMIT = 32 };

static enum schema_kind kind_of_value(const struct bindings *b, const struct ast_node *value,
                                      unsigned depth);

static enum schema_kind kind_of_def(const struct bindings *b, size_t def, unsigned depth)
{
    if (def == BINDING_NONE || depth == CHAIN_LIMIT)
        return SCHEMA_KINDS;
    const struct ast_node *n = b->defs.at[def].node;
    bool value = n->kind == AST_LET || n->kind == AST_MATERIAL || n->kind == AST_TEXTURE;
    return value ? kind_of_value(b, n->children, depth + 1) : SCHEMA_KINDS;
}

static enum schema_kind kind_of_value(const struct bindings *b, const struct ast_node *value,
                                      unsigned depth)
{
    if (!value || (value->kind != AST_CONSTRUCT && value->kind != AST_NAME))
        return SCHEMA_KINDS;
    enum schema_kind kind = value->kind == AST_CONSTRUCT
                                ? locate_kind_by_words(value->name, (struct str){0})
                                : SCHEMA_KINDS;
    uint32_t at = value->span.begin;
    if (kind == SCHEMA_KINDS)
        kind = kind_of_def(b, bindings_find(b, value->name, at, bindings_function(b, at)), depth);
    return kind;
}

enum schema_kind locate_kind_of_def(const struct bindings *b, size_t def)
{
    return kind_of_def(b, def, 0);
}

/* ---- XML ------------------------------------------------------------------------------------- */

/* Elements by their name, or by that of what is around them. */
static const struct element {
    const char *name;
    bool around;
    enum schema_group group;
    enum schema_kind kind; /* SCHEMA_KINDS: its class says */
} elements[] = {{"camera", false, SCHEMA_CAMERA, KIND_CAMERA},
                {"settings", false, SCHEMA_SETTINGS, KIND_SETTINGS},
                {"textures", true, SCHEMA_TEXTURE, KIND_IMAGE},
                {"lights", true, SCHEMA_LIGHT, SCHEMA_KINDS},
                {"surfaces", true, SCHEMA_SURFACE, SCHEMA_KINDS},
                {"object", false, SCHEMA_SURFACE, SCHEMA_KINDS},
                {"material", false, SCHEMA_MATERIAL, SCHEMA_KINDS}};

static const struct element *element_by_tags(struct str name, struct str around)
{
    for (size_t i = 0; i < sizeof elements / sizeof *elements; i++)
        if (str_is(elements[i].around ? around : name, elements[i].name))
            return &elements[i];
    return NULL;
}

enum schema_group locate_group_by_tags(struct str name, struct str around)
{
    const struct element *e = element_by_tags(name, around);
    return e ? e->group : SCHEMA_GROUPS;
}

enum schema_kind locate_kind_by_tags(struct str name, struct str around, struct str class)
{
    const struct element *e = element_by_tags(name, around);
    if (!e || e->kind != SCHEMA_KINDS)
        return e ? e->kind : SCHEMA_KINDS;
    return schema_find_kind(e->group, class, true);
}

static enum schema_kind kind_of_element(const struct ast_node *n, const struct ast_node *parent)
{
    struct str class = {0};
    for (const struct ast_node *c = n->children; c && !class.n; c = c->next)
        if (c->kind == AST_ATTRIBUTE && str_is(c->name, "class"))
            class = str_trim(c->children->text);
    return locate_kind_by_tags(n->name, parent ? parent->name : (struct str){0}, class);
}

/* ---- both ------------------------------------------------------------------------------------ */

enum schema_kind locate_kind(const struct analysis *a, const struct locate_path *path, size_t i)
{
    const struct ast_node *n = path->nodes.at[i];
    if (a->ast.xml)
        return n->kind == AST_BLOCK ? kind_of_element(n, i ? path->nodes.at[i - 1] : NULL)
                                    : SCHEMA_KINDS;
    switch ((enum ast_kind)n->kind) {
    case AST_BLOCK:
    case AST_DEFAULT:
        return locate_kind_by_words(n->name, n->label);
    case AST_CONSTRUCT:
        return kind_of_value(&a->bindings, n, 0);
    case AST_USE:
        return KIND_GROUP;
    case AST_BODY: /* that behind the arguments of a use */
        return i && path->nodes.at[i - 1]->kind == AST_USE ? KIND_GROUP : SCHEMA_KINDS;
    default:
        return SCHEMA_KINDS;
    }
}

enum schema_prop_id locate_prop(const struct analysis *a, enum schema_kind kind, struct str name)
{
    unsigned leaf;
    return kind == SCHEMA_KINDS ? SCHEMA_PROPS : schema_find_prop(kind, name, a->ast.xml, &leaf);
}
