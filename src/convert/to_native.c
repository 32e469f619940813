/* XML to the native language: element by element, in the order of the file.
 *
 * Sections have no twin: their items follow each other.  Comments tell where they stood by blank
 * lines, which to_xml.c reads back: one that touches an item belongs to it, one that is set apart
 * stands between the sections.  Names must exist before they are used, so a material with an id
 * becomes a statement before the first object that uses it, and textures may have to move.  What
 * would be lost is kept in notes (comments.h).
 *
 * The text written here is no more than right; the printer lays it out. */
#include "config.h"

#include "convert/translating.h"

#include "base/num.h"
#include "convert/comments.h"
#include "convert/names.h"

/* An element among its siblings, with its comments: those before it, and those behind it on its
 * line. */
struct member {
    const struct ast_node *node;
    size_t lead, leads, behind, behinds; /* runs of ast->trivia */
};

struct members {
    VEC(struct member) v;
    size_t tail, tails; /* comments before the closing tag */
};

/* A material with an id. */
struct shared {
    struct str id, name;
    const struct ast_node *node; /* its definition */
    bool written;
    bool late; /* used before its definition */
};

struct writer {
    const struct translation *t;
    const struct ast *ast;
    struct buffer *out;
    struct arena arena;
    struct names names;
    struct str *textures; /* their names, by index */
    bool *texture_notes;  /* which have an id that their name does not tell of */
    size_t texture_count;
    struct map shared; /* id to struct shared */
};

/* ---- elements ---- */

static bool is_element(const struct ast_node *n)
{
    return n->kind == AST_BLOCK || n->kind == AST_PROPERTY;
}

static struct str attribute(const struct ast_node *n, const char *name)
{
    for (const struct ast_node *a = n->children; a; a = a->next)
        if (a->kind == AST_ATTRIBUTE && str_is(a->name, name))
            return str_trim(a->children->text);
    return (struct str){0};
}

static const struct ast_node *section_of(const struct writer *w, const char *name)
{
    for (const struct ast_node *c = w->ast->statements->children; c; c = c->next)
        if (is_element(c) && str_is(c->name, name))
            return c;
    return NULL;
}

/* The element's children with their comments. */
static void collect(const struct writer *w, const struct ast_node *element, struct members *out)
{
    struct gap_unit u;
    struct gap g = gap_at(w->ast, gap_content(w->ast, element));
    *out = (struct members){0};
    for (const struct ast_node *c = element->children;; c = c->next) {
        if (c && !is_element(c))
            continue;
        struct member *last = out->v.n ? &out->v.at[out->v.n - 1] : NULL;
        struct member next = {.node = c};
        while (g.at < element->span.end && gap_next(&g, &u)) { /* `<lights/>` has no inside */
            bool behind = last && u.ends_line && u.newlines == 0 && next.leads == 0;
            size_t *first = behind ? &last->behind : &next.lead;
            size_t *n = behind ? &last->behinds : &next.leads;
            *first = *n ? *first : u.first;
            *n += u.n;
        }
        if (!c) {
            out->tail = next.lead;
            out->tails = next.leads;
            return;
        }
        vec_push(&out->v, next);
        gap_move(&g, c->span.end);
    }
}

/* ---- comments ---- */

static void put(struct writer *w, const char *text)
{
    buffer_puts(w->out, text);
}

static void put_comment(struct writer *w, size_t i, enum comment_place place)
{
    const struct trivia *c = &w->ast->trivia.at[i];
    if (c->kind != TRIVIA_PI) {
        comment_to_native(w->ast, c, place, w->out);
        return;
    }
    struct str text = translate_text(w->t, c->span);
    if (!str_begins(text, "<?xml") || !memchr(" \t\r\n", text.at[5], 4))
        diag_report(w->t->diag, DIAG_DROPPED, c->span,
                    "the native language has no processing instructions, so this one is left out");
}

static void put_comments(struct writer *w, size_t first, size_t n, enum comment_place place)
{
    for (size_t i = first; i < first + n; i++)
        put_comment(w, i, place);
}

/* On lines of their own, with the blank lines that stood before them. */
static void put_lead(struct writer *w, const struct member *m, bool blanks)
{
    for (size_t i = m->lead; i < m->lead + m->leads; i++) {
        begin_line(w->out, blanks && gap_blank_before(w->ast, w->ast->trivia.at[i].span.begin));
        put_comment(w, i, COMMENT_OWN_LINE);
    }
    begin_line(w->out, blanks && gap_blank_before(w->ast, m->node->span.begin));
}

static void put_behind(struct writer *w, const struct member *m)
{
    for (size_t i = 0; i < m->behinds; i++)
        put_comment(w, m->behind + i, i + 1 < m->behinds ? COMMENT_BEHIND_MORE : COMMENT_BEHIND);
}

/* All comments inside a leaf, as they come. */
static void put_inside(struct writer *w, const struct ast_node *n)
{
    for (size_t i = gap_at(w->ast, n->span.begin).comment;
         i < w->ast->trivia.n && w->ast->trivia.at[i].span.begin < n->span.end; i++)
        put_comment(w, i, COMMENT_INSIDE);
}

static void put_note(struct writer *w, const char *name, struct str value)
{
    put(w, " ");
    note_write(name, value, COMMENT_INSIDE, w->out);
}

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
static void put_numbers(struct writer *w, struct str text, enum schema_type type)
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

static void put_string(struct writer *w, struct str text)
{
    put(w, "\"");
    native_escape(text, w->out);
    put(w, "\"");
}

/* The schema's word; what XML wrote otherwise (in other letters) is kept in a note. */
static void put_word(struct writer *w, enum schema_prop_id id, const struct ast_node *leaf)
{
    unsigned word = (unsigned)schema_find_word(id, leaf->children->text, true);
    buffer_str(w->out, schema_word(id, word, false));
    if (!str_equal(schema_word(id, word, true), leaf->children->text))
        put_note(w, schema_props[id].xml, leaf->children->text);
}

static void put_texture(struct writer *w, struct str index)
{
    double x = 0;
    num_parse(index.at, index.at + index.n, &x);
    buffer_str(w->out, w->textures[(size_t)x]);
}

static void put_leaf(struct writer *w, enum schema_prop_id id, const struct ast_node *leaf)
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

static void put_block(struct writer *w, const struct ast_node *n, enum schema_kind kind);

static void put_class(struct writer *w, const struct ast_node *n, enum schema_kind kind)
{
    struct str name = attribute(n, "class");
    if (!str_is(name, schema_kinds[kind].xml))
        put_note(w, "class", name);
}

/* `phong { ... }` */
static void put_construct(struct writer *w, const struct ast_node *n, enum schema_group group)
{
    enum schema_kind kind = schema_find_kind(group, attribute(n, "class"), true);
    put(w, schema_kinds[kind].native);
    put_class(w, n, kind);
    put_block(w, n, kind);
}

static struct shared *shared_material(struct writer *w, const struct ast_node *material)
{
    struct str ref = attribute(material, "ref");
    return map_get(&w->shared, ref.n ? ref : attribute(material, "id"));
}

static void put_shared(struct writer *w, struct shared *s)
{
    begin_line(w->out, false);
    put(w, "material ");
    buffer_str(w->out, s->name);
    if (!str_equal(s->name, s->id))
        put_note(w, "id", s->id);
    put(w, " = ");
    put_construct(w, s->node, SCHEMA_MATERIAL);
    s->written = true;
}

/* Writes the shared materials that an object uses, those that are not written yet. */
static void put_shared_of(struct writer *w, const struct ast_node *object)
{
    for (const struct ast_node *c = object->children; c; c = c->next) {
        struct shared *s =
            c->kind == AST_BLOCK && str_is(c->name, "material") ? shared_material(w, c) : NULL;
        if (s && !s->written) {
            s->late = s->node != c;
            put_shared(w, s);
        }
        if (c->kind == AST_BLOCK && str_is(c->name, "object"))
            put_shared_of(w, c);
    }
}

static void collect_shared(struct writer *w, const struct ast_node *n)
{
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (c->kind == AST_BLOCK)
            collect_shared(w, c);
    struct str id = str_is(n->name, "material") ? attribute(n, "id") : (struct str){0};
    if (!id.at)
        return;
    struct shared *s = arena_zalloc(&w->arena, 1, sizeof *s);
    *s = (struct shared){.id = id, .name = names_take(&w->names, id), .node = n};
    map_set(&w->shared, id, s);
}

/* ---- properties ---- */

/* A shared material by its name; a note tells where its definition stands, unless that is its first
 * use. */
static void put_material(struct writer *w, const struct ast_node *n)
{
    struct shared *s = shared_material(w, n);
    if (!s) {
        put_construct(w, n, SCHEMA_MATERIAL);
        return;
    }
    if (s->node != n)
        put_inside(w, n);
    buffer_str(w->out, s->name);
    if (s->node == n && s->late)
        put_note(w, "id", s->id);
}

static void put_value(struct writer *w, enum schema_prop_id id, const struct ast_node *n)
{
    if (schema_props[id].type == TYPE_MATERIAL) {
        put_material(w, n);
    } else if (schema_props[id].type == TYPE_SURFACE) {
        put_construct(w, n, SCHEMA_SURFACE);
    } else {
        put_inside(w, n);
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
static void put_item(struct writer *w, enum schema_type type, const struct ast_node *leaf)
{
    struct str text = leaf->children->text, word[3];
    bool commented =
        gap_at(w->ast, leaf->span.begin).comment != gap_at(w->ast, leaf->span.end).comment;
    if (type == TYPE_POINTS || commented)
        put(w, "(");
    put_inside(w, leaf);
    for (int i = 0; next_word(&text, &word[0]); i++)
        buffer_printf(w->out, i ? ", %.*s" : "%.*s", STR_ARG(word[0]));
    if (type == TYPE_POINTS || commented)
        put(w, ")");
}

/* `vertices: [...]` of v0, v1, ...: it stands where the first of them does. */
static void put_merged(struct writer *w, enum schema_prop_id id, const struct members *m)
{
    bool points = schema_props[id].type == TYPE_POINTS;
    unsigned n = schema_leaf_count(id);
    put_lead(w, find_member(m, schema_leaf(id, 0)), true);
    buffer_printf(w->out, "%s: %s", schema_props[id].native, points ? "[" : "(");
    for (unsigned i = 0; i < n; i++) {
        const struct member *leaf = find_member(m, schema_leaf(id, i));
        if (i > 0)
            put_comments(w, leaf->lead, leaf->leads, COMMENT_INSIDE);
        put_item(w, schema_props[id].type, leaf->node);
        if (i + 1 < n) {
            put_comments(w, leaf->behind, leaf->behinds, COMMENT_INSIDE);
            put(w, ", ");
        }
    }
    put(w, points ? "]" : ")");
    put_behind(w, find_member(m, schema_leaf(id, n - 1)));
}

static void put_property(struct writer *w, enum schema_prop_id id, const struct member *m)
{
    put_lead(w, m, true);
    buffer_printf(w->out, "%s: ", schema_props[id].native);
    put_value(w, id, m->node);
    put_behind(w, m);
}

static void put_block(struct writer *w, const struct ast_node *n, enum schema_kind kind)
{
    struct members members;
    bool written[SCHEMA_PROPS] = {0};
    collect(w, n, &members);
    put(w, " {");
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
    put_comments(w, members.tail, members.tails, COMMENT_OWN_LINE);
    begin_line(w->out, false);
    put(w, "}");
    vec_free(&members.v);
}

/* ---- statements ---- */

/* An object's name, or a note where the id cannot be one. */
static void put_label(struct writer *w, const struct ast_node *n)
{
    struct str id = attribute(n, "id");
    if (name_is_free(id))
        buffer_printf(w->out, " %.*s", STR_ARG(id));
    else if (id.at)
        put_note(w, "id", id);
}

static void put_object(struct writer *w, const struct ast_node *n, enum schema_group group)
{
    enum schema_kind kind = schema_find_kind(group, attribute(n, "class"), true);
    put(w, schema_kinds[kind].native);
    put_label(w, n);
    put_class(w, n, kind);
    put_block(w, n, kind);
}

static void put_light(struct writer *w, const struct ast_node *n)
{
    put_object(w, n, SCHEMA_LIGHT);
}

static void put_surface(struct writer *w, const struct ast_node *n)
{
    put_object(w, n, SCHEMA_SURFACE);
}

static void put_texture_statement(struct writer *w, const struct ast_node *n)
{
    size_t i = w->texture_count++;
    put(w, "texture ");
    buffer_str(w->out, w->textures[i]);
    if (w->texture_notes[i])
        put_note(w, "id", attribute(n, "id"));
    put(w, " = image");
    put_block(w, n, KIND_IMAGE);
}

/* The sections that are arrays. */
static const struct section {
    const char *name;
    void (*put)(struct writer *w, const struct ast_node *n);
} sections[] = {
    {"textures", put_texture_statement}, {"lights", put_light}, {"surfaces", put_surface}};
enum { SECTIONS = sizeof sections / sizeof *sections };

/* The items of a section.  Comments in front of the first touch it, whatever blank lines the file
 * has: set apart they would stand before the section. */
static void put_items(struct writer *w, const struct section *s, const struct ast_node *n)
{
    struct members items;
    collect(w, n, &items);
    for (size_t i = 0; i < items.v.n; i++) {
        put_shared_of(w, items.v.at[i].node);
        put_lead(w, &items.v.at[i], i > 0);
        s->put(w, items.v.at[i].node);
        put_behind(w, &items.v.at[i]);
    }
    put_comments(w, items.tail, items.tails, COMMENT_OWN_LINE);
    vec_free(&items.v);
}

/* ---- the scene ---- */

static bool holds_items(const struct ast_node *section)
{
    for (const struct ast_node *c = section->children; c; c = c->next)
        if (is_element(c))
            return true;
    return false;
}

static bool uses_texture(const struct ast_node *n)
{
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (str_is(c->name, "texture") || str_is(c->name, "bTexture") || uses_texture(c))
            return true;
    return false;
}

/* The section that stands after this one and must come before it: textures that it uses. */
static const struct ast_node *needed_before(const struct writer *w, const struct ast_node *n)
{
    const struct ast_node *textures = section_of(w, "textures");
    bool later = textures && textures->span.begin > n->span.begin && w->texture_count == 0;
    return later && uses_texture(n) ? textures : NULL;
}

static void put_section(struct writer *w, const struct section *s, const struct member *m)
{
    const struct ast_node *moved = needed_before(w, m->node);
    bool away = s == &sections[0] && w->texture_count > 0; /* its items were needed before */
    if (moved) {
        put_items(w, &sections[0], moved);
        begin_line(w->out, true);
    }
    put_comments(w, m->lead, m->leads, COMMENT_OWN_LINE);
    begin_line(w->out, m->leads > 0);
    if (!away)
        put_items(w, s, m->node);
    if (away || !holds_items(m->node))
        note_write("section", str_of(s->name), COMMENT_OWN_LINE, w->out);
    begin_line(w->out, true);
}

static const struct section *section_named(struct str name)
{
    for (int i = 0; i < SECTIONS; i++)
        if (str_is(name, sections[i].name))
            return &sections[i];
    return NULL;
}

/* A section has no last line for comments to stand behind: they go before what follows. */
static void hand_on_comments(struct members *children)
{
    for (size_t i = 0; i < children->v.n; i++) {
        struct member *m = &children->v.at[i];
        bool last = i + 1 == children->v.n;
        size_t *first = last ? &children->tail : &children->v.at[i + 1].lead;
        size_t *n = last ? &children->tails : &children->v.at[i + 1].leads;
        if (!section_named(m->node->name) || m->behinds == 0)
            continue;
        *first = m->behind;
        *n += m->behinds;
    }
}

static void put_child(struct writer *w, const struct member *m)
{
    const struct section *s = section_named(m->node->name);
    if (s) {
        put_section(w, s, m);
        return;
    }
    bool camera = str_is(m->node->name, "camera");
    put_comments(w, m->lead, m->leads, COMMENT_OWN_LINE);
    put(w, camera ? "camera" : "settings");
    put_block(w, m->node, camera ? KIND_CAMERA : KIND_SETTINGS);
    put_behind(w, m);
    begin_line(w->out, true);
}

/* Comments outside the root; what is behind it comes after a note. */
static void put_outside(struct writer *w, struct gap g, bool behind)
{
    struct gap_unit u;
    for (bool first = behind; gap_next(&g, &u); first = false) {
        if (first)
            note_write("end", str_of("scene"), COMMENT_OWN_LINE, w->out);
        begin_line(w->out,
                   !first && gap_blank_before(w->ast, w->ast->trivia.at[u.first].span.begin));
        put_comments(w, u.first, u.n, COMMENT_OWN_LINE);
    }
    begin_line(w->out, behind || gap_blank_before(w->ast, g.at));
}

static void put_scene(struct writer *w)
{
    const struct ast_node *root = w->ast->statements;
    struct str model = attribute(root, "model");
    struct members children;
    put_outside(w, gap_at(w->ast, w->ast->source->base), false);
    put(w, "wrt 1\nmodel ");
    put(w, w->t->desc->model == SCHEMA_MODERN ? "modern" : "classic");
    if (model.at && w->t->desc->model == SCHEMA_CLASSIC)
        put_note(w, "model", model);
    begin_line(w->out, true);
    collect(w, root, &children);
    hand_on_comments(&children);
    for (size_t i = 0; i < children.v.n; i++)
        put_child(w, &children.v.at[i]);
    put_comments(w, children.tail, children.tails, COMMENT_OWN_LINE);
    begin_line(w->out, true);
    put_outside(w, gap_at(w->ast, root->span.end), true);
    vec_free(&children.v);
}

static struct str leaf_text(const struct ast_node *n, const char *name)
{
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (c->kind == AST_PROPERTY && str_is(c->name, name))
            return c->children->text;
    return (struct str){0};
}

/* A texture without an id is called after its file; one whose id is that very name needs a note. */
static void name_textures(struct writer *w)
{
    const struct ast_node *section = section_of(w, "textures");
    size_t i = 0;
    w->textures = arena_zalloc(&w->arena, w->t->desc->textures.n, sizeof *w->textures);
    w->texture_notes = arena_zalloc(&w->arena, w->t->desc->textures.n, sizeof *w->texture_notes);
    for (const struct ast_node *c = section ? section->children : NULL; c; c = c->next) {
        if (!is_element(c))
            continue;
        struct str id = attribute(c, "id"), made = names_of_file(&w->names, leaf_text(c, "file"));
        struct str name = names_take(&w->names, id.at ? id : made);
        w->texture_notes[i] = id.at && (!str_equal(id, name) || str_equal(made, name));
        w->textures[i++] = name;
    }
}

void translate_xml(const struct translation *t, struct buffer *out)
{
    struct writer w = {.t = t, .ast = t->ast, .out = out};
    w.names.arena = &w.arena;
    name_textures(&w);
    collect_shared(&w, t->ast->statements);
    put_scene(&w);
    names_free(&w.names);
    map_free(&w.shared);
    arena_free(&w.arena);
}
