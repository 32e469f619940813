/* What stands under the pointer: a kind or property of the schema, a name and its definition. */
#include "config.h"

#include "lsp/locate.h"
#include "lsp/server.h"

#include "schema/describe.h"

struct hover {
    const struct wire_place *where;
    struct span span; /* of what the text is about */
    struct buffer text;
};

/* ---- texts ----------------------------------------------------------------------------------- */

static void add_kind(struct hover *h, enum schema_kind kind)
{
    const struct schema_kind_row *row = &schema_kinds[kind];
    buffer_printf(&h->text, "%s: %s\n", row->native, row->doc);
    if (row->models != IN_BOTH)
        buffer_printf(&h->text, "model %s only\n", row->models == IN_MODERN ? "modern" : "classic");
    buffer_puts(&h->text, "in XML: ");
    describe_element(&h->text, kind);
    buffer_puts(&h->text, "\nproperties:");
    for (int p = 0; p < SCHEMA_PROPS; p++)
        if (schema_has(kind, (enum schema_prop_id)p))
            buffer_printf(&h->text, " %s", schema_props[p].native);
}

static void add_prop(struct hover *h, enum schema_kind kind, enum schema_prop_id id)
{
    const struct schema_prop *p = &schema_props[id];
    bool xml = h->where->analysis->ast.xml;
    buffer_printf(&h->text, "%s.%s: %s\nvalue: ", schema_kinds[kind].native, p->native, p->doc);
    describe_value(&h->text, id, xml);
    if (p->required || p->models != IN_BOTH) {
        buffer_puts(&h->text, "\n");
        describe_conditions(&h->text, id);
    }
    if (p->has_default) {
        buffer_puts(&h->text, "\ndefault: ");
        describe_default(&h->text, id);
    }
    buffer_puts(&h->text, "\nin XML: ");
    if (*p->xml)
        describe_leaves(&h->text, id);
    else
        buffer_puts(&h->text, "none");
}

/* The definition as it is written: its first lines. */
static void add_definition(struct hover *h, const struct name_def *d)
{
    enum { LINES = 12, BYTES = 1000 };
    struct str text = srcmap_text(&h->where->analysis->sources, d->node->span);
    size_t n = 0;
    for (int lines = 0; n < text.n && n < BYTES; n++)
        if (text.at[n] == '\n' && ++lines == LINES)
            break;
    while (n < text.n && n && (text.at[n] & 0xC0) == 0x80)
        n--;
    if (d->node->kind == AST_PARAMETER)
        buffer_puts(&h->text, "parameter ");
    if (d->node->kind == AST_FOR || d->node->kind == AST_COMPREHENSION)
        buffer_printf(&h->text, "variable of the loop\n");
    buffer_add(&h->text, text.at, n);
    buffer_puts(&h->text, n < text.n ? "\n..." : "");
    if (d->foreign)
        buffer_printf(&h->text, "\nin %s",
                      srcmap_source(&h->where->analysis->sources, d->span.begin)->name);
}

/* A function of the language. */
static bool add_builtin(struct hover *h, struct str name)
{
    static const struct {
        const char *name, *parameters, *doc;
    } functions[] = {
#define FUNCTION(name, parameters, takes, required, more, doc) {#name, parameters, doc},
#include "eval/functions.def"
#undef FUNCTION
    };
    for (size_t i = 0; i < sizeof functions / sizeof *functions; i++) {
        if (!str_is(name, functions[i].name))
            continue;
        buffer_printf(&h->text, "%s(", functions[i].name);
        struct str parameter;
        for (unsigned k = 0; (parameter = str_nth_word(functions[i].parameters, k)).n; k++)
            buffer_printf(&h->text, "%s%.*s", k ? ", " : "", STR_ARG(parameter));
        buffer_printf(&h->text, "): %s", functions[i].doc);
        return true;
    }
    return false;
}

/* ---- what is meant --------------------------------------------------------------------------- */

static bool hover_name(struct hover *h)
{
    const struct bindings *b = &h->where->analysis->bindings;
    size_t def = bindings_at(b, h->where->at, &h->span);
    if (def == BINDING_NONE)
        return false;
    add_definition(h, &b->defs.at[def]);
    return true;
}

/* A property by its name, or by a word that is its value. */
static bool hover_prop(struct hover *h, const struct locate_path *path, size_t i)
{
    const struct ast_node *n = path->nodes.at[i];
    enum schema_kind kind = i ? locate_kind(h->where->analysis, path, i - 1) : SCHEMA_KINDS;
    enum schema_prop_id id = locate_prop(h->where->analysis, kind, n->name);
    if (id == SCHEMA_PROPS)
        return false;
    h->span = n->name_span;
    add_prop(h, kind, id);
    return true;
}

/* The words that open a block, or an element's class. */
static bool hover_kind(struct hover *h, const struct locate_path *path, size_t i)
{
    enum schema_kind kind = locate_kind(h->where->analysis, path, i);
    if (kind == SCHEMA_KINDS)
        return false;
    add_kind(h, kind);
    return true;
}

/* The words before a block's brace, with its label. */
static struct span head_of(const struct hover *h, const struct ast_node *n)
{
    struct span head = n->name_span;
    struct str text = srcmap_text(&h->where->analysis->sources, n->span);
    if (n->label.n && !n->xml)
        head.end = n->span.begin + (uint32_t)(n->label.at + n->label.n - text.at);
    return head;
}

/* A property by its name, or by a value that is no object of its own; a plain one has no node. */
static bool is_about_prop(const struct hover *h, const struct locate_path *path, size_t i)
{
    const struct ast_node *n = path->nodes.at[i];
    bool value =
        i + 1 < path->nodes.n ? path->nodes.at[i + 1]->kind != AST_CONSTRUCT : !n->children;
    return value || locate_touches(n->name_span, h->where->at);
}

static bool hover_node(struct hover *h, const struct locate_path *path, size_t i)
{
    const struct ast_node *n = path->nodes.at[i];
    bool named = locate_touches(n->name_span, h->where->at);
    h->span = n->name_span;
    switch ((enum ast_kind)n->kind) {
    case AST_PROPERTY:
        return is_about_prop(h, path, i) && hover_prop(h, path, i);
    case AST_BLOCK:
    case AST_DEFAULT:
        if (named && n->xml && hover_prop(h, path, i))
            return true;
        h->span = head_of(h, n);
        return locate_touches(h->span, h->where->at) && hover_kind(h, path, i);
    case AST_CONSTRUCT:
        return named && hover_kind(h, path, i);
    case AST_ATTRIBUTE:
        h->span = n->span;
        return str_is(n->name, "class") && i && hover_kind(h, path, i - 1);
    case AST_CALL:
        return named && add_builtin(h, n->name);
    default:
        return false;
    }
}

/* The innermost node that has something to say. */
static bool find_text(struct hover *h)
{
    struct locate_path path;
    bool found = hover_name(h);
    locate(&path, &h->where->analysis->ast, h->where->at);
    for (size_t i = path.nodes.n; i > 0 && !found; i--)
        found = hover_node(h, &path, i - 1);
    vec_free(&path.nodes);
    return found;
}

json_t *lsp_hover(struct server *s, const json_t *params)
{
    struct wire_place place;
    struct hover h = {.where = &place};
    if (!wire_place(s, params, &place))
        return NULL;
    if (!find_text(&h)) {
        buffer_free(&h.text);
        return json_null();
    }
    return json_pack("{s:{s:s, s:o}, s:o}", "contents", "kind", "plaintext", "value",
                     wire_buffer(&h.text), "range",
                     wire_span(s, place.doc, place.analysis, h.span));
}
