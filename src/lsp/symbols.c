/* The outline of a text. */
#include "config.h"

#include "lsp/server.h"

/* SymbolKind. */
enum symbol_kind {
    SYMBOL_MODULE = 2,
    SYMBOL_NAMESPACE = 3,
    SYMBOL_CLASS = 5,
    SYMBOL_FUNCTION = 12,
    SYMBOL_VARIABLE = 13,
    SYMBOL_CONSTANT = 14,
    SYMBOL_OBJECT = 19,
};

/* Which nodes are symbols, and the word before their name (NULL: the name says it all). */
static const struct {
    enum symbol_kind kind;
    const char *word;
} rows[AST_KINDS] = {
    [AST_INCLUDE] = {SYMBOL_MODULE, "include"},
    [AST_LET] = {SYMBOL_VARIABLE, "let"},
    [AST_PARAM] = {SYMBOL_VARIABLE, "param"},
    [AST_MATERIAL] = {SYMBOL_CONSTANT, "material"},
    [AST_TEXTURE] = {SYMBOL_CONSTANT, "texture"},
    [AST_FN] = {SYMBOL_FUNCTION, "fn"},
    [AST_DEFINE] = {SYMBOL_CLASS, "define"},
    [AST_DEFAULT] = {SYMBOL_OBJECT, "default"},
    [AST_FOR] = {SYMBOL_NAMESPACE, "for"},
    [AST_IF] = {SYMBOL_NAMESPACE, "if"},
    [AST_USE] = {SYMBOL_OBJECT, NULL},
    [AST_BLOCK] = {SYMBOL_OBJECT, NULL},
};

/* `sphere ball`, `light point lamp`, `material gold`, `surface Sphere`. */
static json_t *name_of(const struct ast_node *n)
{
    struct buffer text = {0};
    const char *word = rows[n->kind].word;
    if (word)
        buffer_printf(&text, "%s%s", word, n->name.n ? " " : "");
    buffer_str(&text, n->name);
    if (!n->xml && (n->kind == AST_BLOCK || n->kind == AST_DEFAULT) && n->label.n)
        buffer_printf(&text, " %.*s", STR_ARG(n->label));
    for (const struct ast_node *c = n->children; c; c = c->next) {
        if (c->kind == AST_LABEL)
            buffer_printf(&text, " %.*s", STR_ARG(c->name));
        else if (c->kind == AST_ATTRIBUTE)
            buffer_printf(&text, " %.*s", STR_ARG(c->children->text));
        else if (n->kind == AST_INCLUDE)
            buffer_printf(&text, " %.*s", STR_ARG(c->text));
    }
    return wire_buffer(&text);
}

static void add_symbols(const struct server *s, const struct wire_place *place,
                        const struct ast_node *first, json_t *out);

/* What stands in a body belongs to the statement that has it. */
static void add_inner(const struct server *s, const struct wire_place *place,
                      const struct ast_node *n, json_t *out)
{
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (c->kind == AST_BODY)
            add_symbols(s, place, c->children, out);
    if (n->kind == AST_BLOCK || n->kind == AST_IF)
        add_symbols(s, place, n->children, out);
}

static json_t *symbol_of(const struct server *s, const struct wire_place *place,
                         const struct ast_node *n)
{
    struct span name =
        span_known(n->name_span) ? n->name_span : (struct span){n->span.begin, n->span.begin};
    json_t *children = json_array();
    add_inner(s, place, n, children);
    json_t *symbol =
        json_pack("{s:o, s:i, s:o, s:o}", "name", name_of(n), "kind", (int)rows[n->kind].kind,
                  "range", wire_span(s, place->doc, place->analysis, n->span), "selectionRange",
                  wire_span(s, place->doc, place->analysis, name));
    if (json_array_size(children))
        json_object_set(symbol, "children", children);
    json_decref(children);
    return symbol;
}

/* An element without anything inside is a property, not an object. */
static void add_symbols(const struct server *s, const struct wire_place *place,
                        const struct ast_node *first, json_t *out)
{
    for (const struct ast_node *n = first; n; n = n->next)
        if (rows[n->kind].kind)
            json_array_append_new(out, symbol_of(s, place, n));
}

json_t *lsp_document_symbol(struct server *s, const json_t *params)
{
    struct wire_place place;
    if (!wire_whole(s, params, &place))
        return NULL;
    json_t *list = json_array();
    add_symbols(s, &place, place.analysis->ast.statements, list);
    return list;
}
