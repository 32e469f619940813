#include "config.h"

#include "base/num.h"
#include "convert/to_native.h"

/* ---- values ---- */

static bool next_word(struct str *text, struct str *word)
{
    *text = str_trim(*text);
    size_t n = 0;
    while (n < text->n && !memchr(" \t\r\n", text->at[n], 4))
        n++;
    *word = (struct str){text->at, n};
    *text = (struct str){text->at + n, text->n - n};
    return n > 0;
}

static bool is_zero(struct str number)
{
    double x;
    return num_parse(number.at, number.at + number.n, &x) && x == 0;
}

/* One number, or the numbers of a vector; three equal ones may be one where that means the same and
 * reads well. */
static void put_numbers(struct native_writer *w, struct str text, enum schema_type type)
{
    struct str word[3] = {{0}};
    unsigned n = 0;
    while (n < 3 && next_word(&text, &word[n]))
        n++;
    bool equal = n == 3 && str_equal(word[0], word[1]) && str_equal(word[0], word[2]);
    bool spreads =
        type == TYPE_COLOUR || type == TYPE_SCALE || (type == TYPE_VECTOR && is_zero(word[0]));
    if (n == 1 || (equal && spreads))
        buffer_str(w->out, word[0]);
    else
        buffer_printf(w->out, "(%.*s, %.*s, %.*s)", STR_ARG(word[0]), STR_ARG(word[1]),
                      STR_ARG(word[2]));
}

static void put_string(struct native_writer *w, struct str text)
{
    native_put(w, "\"");
    native_escape(text, w->out);
    native_put(w, "\"");
}

/* The schema's word; what XML wrote otherwise (in other letters) is kept in a note. */
static void put_word(struct native_writer *w, enum schema_prop_id id, const struct ast_node *leaf)
{
    unsigned word = (unsigned)schema_find_word(id, leaf->children->text, true);
    buffer_str(w->out, schema_word(id, word, false));
    if (!str_equal(schema_word(id, word, true), leaf->children->text))
        native_put_note(w, schema_props[id].xml, leaf->children->text);
}

static void put_texture(struct native_writer *w, struct str index)
{
    double x = 0;
    num_parse(index.at, index.at + index.n, &x);
    buffer_str(w->out, w->textures[(size_t)x]);
}

static void put_leaf(struct native_writer *w, enum schema_prop_id id, const struct ast_node *leaf)
{
    struct str text = leaf->children->text;
    switch (schema_props[id].type) {
    case TYPE_FILE:
        put_string(w, translate_file(w->t, text, leaf->span.begin, &w->arena));
        break;
    case TYPE_TEXTURE:
        put_texture(w, text);
        break;
    case TYPE_WORD:
        put_word(w, id, leaf);
        break;
    default:
        put_numbers(w, text, schema_props[id].type);
        break;
    }
}

/* ---- materials with an id ---- */

void native_put_class(struct native_writer *w, const struct ast_node *n, enum schema_kind kind)
{
    struct str name = element_attribute(n, "class");
    if (!str_is(name, schema_kinds[kind].xml))
        native_put_note(w, "class", name);
}

/* `phong { ... }` */
static void put_construct(struct native_writer *w, const struct ast_node *n,
                          enum schema_group group)
{
    enum schema_kind kind = schema_find_kind(group, element_attribute(n, "class"), true);
    native_put(w, schema_kinds[kind].native);
    native_put_class(w, n, kind);
    native_put_block(w, n, kind);
}

static struct shared *shared_material(struct native_writer *w, const struct ast_node *material)
{
    struct str ref = element_attribute(material, "ref");
    return map_get(&w->shared, ref.n ? ref : element_attribute(material, "id"));
}

static void put_shared(struct native_writer *w, struct shared *s)
{
    begin_line(w->out, false);
    native_put(w, "material ");
    buffer_str(w->out, s->name);
    if (!str_equal(s->name, s->id))
        native_put_note(w, "id", s->id);
    native_put(w, " = ");
    put_construct(w, s->node, SCHEMA_MATERIAL);
    s->written = true;
}

void native_put_shared(struct native_writer *w, const struct ast_node *object)
{
    for (const struct ast_node *c = object->children; c; c = c->next) {
        struct shared *s =
            c->kind == AST_BLOCK && str_is(c->name, "material") ? shared_material(w, c) : NULL;
        if (s && !s->written) {
            s->late = s->node != c;
            put_shared(w, s);
        }
        if (c->kind == AST_BLOCK && str_is(c->name, "object"))
            native_put_shared(w, c);
    }
}

void native_find_shared(struct native_writer *w, const struct ast_node *n)
{
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (c->kind == AST_BLOCK)
            native_find_shared(w, c);
    struct str id = str_is(n->name, "material") ? element_attribute(n, "id") : (struct str){0};
    if (!id.at)
        return;
    struct shared *s = arena_zalloc(&w->arena, 1, sizeof *s);
    *s = (struct shared){.id = id, .name = names_take(&w->names, id), .node = n};
    map_set(&w->shared, id, s);
}

/* ---- properties ---- */

/* A shared material by its name; a note tells where its definition stands, unless that is its first
 * use. */
static void put_material(struct native_writer *w, const struct ast_node *n)
{
    struct shared *s = shared_material(w, n);
    if (!s) {
        put_construct(w, n, SCHEMA_MATERIAL);
        return;
    }
    if (s->node != n)
        native_put_inside(w, n);
    buffer_str(w->out, s->name);
    if (s->node == n && s->late)
        native_put_note(w, "id", s->id);
}

static void put_value(struct native_writer *w, enum schema_prop_id id, const struct ast_node *n)
{
    if (schema_props[id].type == TYPE_MATERIAL) {
        put_material(w, n);
    } else if (schema_props[id].type == TYPE_SURFACE) {
        put_construct(w, n, SCHEMA_SURFACE);
    } else {
        native_put_inside(w, n);
        put_leaf(w, id, n);
    }
}

/* One of the leaves that are required together. */
static const struct member *find_member(const struct members *m, struct str name)
{
    size_t i = 0;
    while (!str_equal(m->v.at[i].node->name, name))
        i++;
    return &m->v.at[i];
}

/* A leaf as an item of the list that several leaves make; comments within a leaf go into brackets
 * of the item. */
static void put_item(struct native_writer *w, enum schema_type type, const struct ast_node *leaf)
{
    struct str text = leaf->children->text, word[3];
    bool commented =
        gap_at(w->ast, leaf->span.begin).comment != gap_at(w->ast, leaf->span.end).comment;
    if (type == TYPE_POINTS || commented)
        native_put(w, "(");
    native_put_inside(w, leaf);
    for (int i = 0; next_word(&text, &word[0]); i++)
        buffer_printf(w->out, i ? ", %.*s" : "%.*s", STR_ARG(word[0]));
    if (type == TYPE_POINTS || commented)
        native_put(w, ")");
}

/* `vertices: [...]` of v0, v1, ...: it stands where the first of them does. */
static void put_merged(struct native_writer *w, enum schema_prop_id id, const struct members *m)
{
    bool points = schema_props[id].type == TYPE_POINTS;
    unsigned n = schema_leaf_count(id);
    native_put_lead(w, find_member(m, schema_leaf(id, 0)), true);
    buffer_printf(w->out, "%s: %s", schema_props[id].native, points ? "[" : "(");
    for (unsigned i = 0; i < n; i++) {
        const struct member *leaf = find_member(m, schema_leaf(id, i));
        if (i > 0)
            native_put_comments(w, leaf->lead, leaf->leads, COMMENT_INSIDE);
        put_item(w, schema_props[id].type, leaf->node);
        if (i + 1 < n) {
            native_put_comments(w, leaf->behind, leaf->behinds, COMMENT_INSIDE);
            native_put(w, ", ");
        }
    }
    native_put(w, points ? "]" : ")");
    native_put_behind(w, find_member(m, schema_leaf(id, n - 1)));
}

static void put_property(struct native_writer *w, enum schema_prop_id id, const struct member *m)
{
    native_put_lead(w, m, true);
    buffer_printf(w->out, "%s: ", schema_props[id].native);
    put_value(w, id, m->node);
    native_put_behind(w, m);
}

void native_put_block(struct native_writer *w, const struct ast_node *n, enum schema_kind kind)
{
    struct members members;
    bool written[SCHEMA_PROPS] = {0};
    native_members(w, n, &members);
    native_put(w, " {");
    for (size_t i = 0; i < members.v.n; i++) {
        unsigned component;
        const struct member *m = &members.v.at[i];
        enum schema_prop_id id = schema_find_prop(kind, m->node->name, true, &component);
        if (written[id])
            continue;
        written[id] = true;
        if (schema_leaf_count(id) > 1)
            put_merged(w, id, &members);
        else
            put_property(w, id, m);
    }
    native_put_comments(w, members.tail, members.tails, COMMENT_OWN_LINE);
    begin_line(w->out, false);
    native_put(w, "}");
    vec_free(&members.v);
}
