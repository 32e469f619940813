/* What may be written at a place of a native text. */
#include "config.h"

#include "lsp/completion.h"
#include "lsp/cursor.h"
#include "lsp/locate.h"

json_t *completion_add(struct completion *c, struct str label, enum item_kind kind,
                       const char *detail)
{
    json_t *item = json_pack("{s:o, s:i}", "label", wire_text(label), "kind", (int)kind);
    if (*detail)
        json_object_set_new(item, "detail", json_string(detail));
    json_array_append_new(c->items, item);
    return item;
}

void completion_add_words(struct completion *c, const char *words, enum item_kind kind,
                          const char *detail)
{
    struct str word;
    for (unsigned i = 0; (word = str_nth_word(words, i)).n; i++)
        completion_add(c, word, kind, detail);
}

void completion_add_prop(struct completion *c, enum schema_prop_id id, struct str name,
                         const char *before, const char *behind)
{
    bool required = schema_required(id, c->model);
    struct buffer detail = {0}, text = {0};
    describe_value(&detail, id, c->where->analysis->ast.xml);
    buffer_printf(&detail, "%s%c", required ? ", required" : "", 0);
    buffer_printf(&text, "%s%.*s%s", before, STR_ARG(name), behind);
    json_t *item = completion_add(c, name, ITEM_PROPERTY, detail.at);
    json_object_set_new(item, "documentation", json_string(schema_props[id].doc));
    json_object_set_new(item, "insertText", wire_buffer(&text));
    buffer_printf(&text, "%d%.*s", !required, STR_ARG(name));
    json_object_set_new(item, "sortText", wire_buffer(&text));
    buffer_free(&detail);
}

/* ---- the schema ------------------------------------------------------------------------------ */

/* The kinds of a group by the word that tells them apart. */
static void add_kinds(struct completion *c, enum schema_group group)
{
    for (int k = 0; k < SCHEMA_KINDS; k++) {
        const struct schema_kind_row *row = &schema_kinds[k];
        const char *space = strchr(row->native, ' ');
        if (row->group == group && completion_has(c, row->models))
            completion_add(c, str_of(space ? space + 1 : row->native), ITEM_CLASS, row->doc);
    }
}

static bool is_given(const struct completion *c, const char *name)
{
    size_t first = c->cursor.blocks.at[c->cursor.blocks.n - 1].given;
    for (size_t i = first; i < c->cursor.given.n; i++)
        if (str_is(c->cursor.given.at[i], name))
            return true;
    return false;
}

static void add_props(struct completion *c, enum schema_kind kind)
{
    for (int p = 0; p < SCHEMA_PROPS; p++)
        if (schema_has(kind, (enum schema_prop_id)p) && completion_has(c, schema_props[p].models) &&
            !is_given(c, schema_props[p].native))
            completion_add_prop(c, (enum schema_prop_id)p, str_of(schema_props[p].native), "",
                                ": ");
}

static void add_value_words(struct completion *c, enum schema_prop_id id)
{
    struct str word;
    for (unsigned n = 0; (word = schema_word(id, n, false)).n; n++)
        completion_add(c, word, ITEM_VALUE, schema_props[id].doc);
}

/* ---- names ----------------------------------------------------------------------------------- */

static const struct {
    const char *words; /* how the definition is told */
    enum item_kind kind;
} defs[AST_KINDS] = {
    [AST_LET] = {"let", ITEM_VARIABLE},
    [AST_PARAM] = {"param", ITEM_VARIABLE},
    [AST_MATERIAL] = {"material", ITEM_CONSTANT},
    [AST_TEXTURE] = {"texture", ITEM_CONSTANT},
    [AST_FN] = {"function", ITEM_FUNCTION},
    [AST_DEFINE] = {"template", ITEM_FUNCTION},
    [AST_PARAMETER] = {"parameter", ITEM_VARIABLE},
    [AST_FOR] = {"variable of the loop", ITEM_VARIABLE},
    [AST_COMPREHENSION] = {"variable of the loop", ITEM_VARIABLE},
};

/* The names that mean something here; `kinds` has a bit for each kind of node that defines one. */
static void add_names(struct completion *c, unsigned long long kinds)
{
    const struct bindings *b = &c->where->analysis->bindings;
    struct span function = bindings_function(b, c->where->at);
    for (size_t i = 0; i < b->defs.n; i++) {
        const struct name_def *d = &b->defs.at[i];
        bool wanted = kinds >> d->node->kind & 1;
        if (wanted && bindings_find(b, d->name, c->where->at, function) == i)
            completion_add(c, d->name, defs[d->node->kind].kind, defs[d->node->kind].words);
    }
}

static void add_functions(struct completion *c)
{
#define FUNCTION(name, parameters, takes, required, more, doc) \
    completion_add(c, str_of(#name), ITEM_FUNCTION, doc);
#include "eval/functions.def"
#undef FUNCTION
    completion_add_words(c, "pi true false", ITEM_CONSTANT, "constant");
}

#define BIT(kind) (1ull << (kind))
static const unsigned long long variables = BIT(AST_LET) | BIT(AST_PARAM) | BIT(AST_PARAMETER) |
                                            BIT(AST_FOR) | BIT(AST_COMPREHENSION) | BIT(AST_FN);
static const unsigned long long makers = BIT(AST_LET) | BIT(AST_PARAMETER) | BIT(AST_FN);

/* ---- places ---------------------------------------------------------------------------------- */

static enum schema_kind kind_of_block(const struct completion *c)
{
    const struct cursor_block *b = &c->cursor.blocks.at[c->cursor.blocks.n - 1];
    const struct bindings *names = &c->where->analysis->bindings;
    if (b->is_use)
        return KIND_GROUP;
    if (!b->first.n)
        return SCHEMA_KINDS;
    enum schema_kind kind = locate_kind_by_words(b->first, b->second);
    if (kind == SCHEMA_KINDS) /* `radius: r sphere {`: the first word is of what stands before */
        kind = locate_kind_by_words(b->second, b->second);
    struct span function = bindings_function(names, c->where->at);
    if (kind == SCHEMA_KINDS) /* `gold {` */
        kind = locate_kind_of_def(names, bindings_find(names, b->first, c->where->at, function));
    return kind;
}

static void complete_statement(struct completion *c)
{
    const struct cursor_block *b = &c->cursor.blocks.at[c->cursor.blocks.n - 1];
    enum schema_kind kind = kind_of_block(c);
    if (kind != SCHEMA_KINDS)
        add_props(c, kind);
    if (b->is_use || (b->first.n && kind != KIND_GROUP))
        return;
    add_kinds(c, SCHEMA_SURFACE);
    add_kinds(c, SCHEMA_PLACE);
    add_kinds(c, SCHEMA_CAMERA);
    add_kinds(c, SCHEMA_SETTINGS);
    completion_add_words(c, "light", ITEM_CLASS, "a light");
    completion_add_words(c, "let fn material texture define default include assert for if",
                         ITEM_KEYWORD, "keyword");
    if (c->cursor.blocks.n == 1)
        completion_add_words(c, "wrt model param", ITEM_KEYWORD, "keyword");
    add_names(c, BIT(AST_DEFINE));
}

static void complete_value(struct completion *c)
{
    const struct cursor_block *b = &c->cursor.blocks.at[c->cursor.blocks.n - 1];
    enum schema_kind kind = b->brackets ? SCHEMA_KINDS : kind_of_block(c);
    enum schema_prop_id id = locate_prop(c->where->analysis, kind, b->property);
    switch (id == SCHEMA_PROPS ? SCHEMA_TYPES : schema_props[id].type) {
    case TYPE_WORD:
        add_value_words(c, id);
        add_names(c, makers);
        return;
    case TYPE_SWITCH:
    case TYPE_NUMBER_OR_SWITCH:
        completion_add_words(c, "true false", ITEM_VALUE, "");
        add_names(c, variables);
        return;
    case TYPE_MATERIAL:
        add_names(c, makers | BIT(AST_MATERIAL));
        add_kinds(c, SCHEMA_MATERIAL);
        return;
    case TYPE_TEXTURE:
        add_names(c, makers | BIT(AST_TEXTURE));
        add_kinds(c, SCHEMA_TEXTURE);
        return;
    case TYPE_SURFACE:
        add_names(c, makers);
        add_kinds(c, SCHEMA_SURFACE);
        return;
    case SCHEMA_TYPES: /* any value */
        add_names(c, variables | BIT(AST_MATERIAL) | BIT(AST_TEXTURE));
        add_functions(c);
        add_kinds(c, SCHEMA_MATERIAL);
        add_kinds(c, SCHEMA_TEXTURE);
        return;
    default:
        add_names(c, variables);
        add_functions(c);
    }
}

static void complete_default(struct completion *c)
{
    add_kinds(c, SCHEMA_SURFACE);
    add_kinds(c, SCHEMA_CAMERA);
    add_kinds(c, SCHEMA_SETTINGS);
    completion_add_words(c, "light", ITEM_CLASS, "a light");
}

static void complete(struct completion *c)
{
    switch (c->cursor.place) {
    case CURSOR_NOWHERE:
        break;
    case CURSOR_STATEMENT:
        complete_statement(c);
        break;
    case CURSOR_VALUE:
        complete_value(c);
        break;
    case CURSOR_LIGHT:
        add_kinds(c, SCHEMA_LIGHT);
        break;
    case CURSOR_MODEL:
        completion_add_words(c, "modern classic", ITEM_VALUE, "which arithmetic the scene means");
        break;
    case CURSOR_DEFAULT:
        complete_default(c);
        break;
    }
}

json_t *lsp_completion(struct server *s, const json_t *params)
{
    struct wire_place place;
    if (!wire_place(s, params, &place))
        return NULL;
    struct completion c = {.where = &place, .items = json_array()};
    c.model = place.analysis->desc.model;
    struct str text = {place.doc->text.at, place.doc->text.n};
    if (place.analysis->ast.xml) {
        complete_xml(&c, text, place.in_text);
        return c.items;
    }
    cursor_find(&c.cursor, text, place.in_text);
    complete(&c);
    cursor_free(&c.cursor);
    return c.items;
}
