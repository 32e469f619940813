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

#include "base/num.h"
#include "convert/to_native.h"

/* ---- statements ---- */

/* An object's name, or a note where the id cannot be one. */
static void put_label(struct native_writer *w, const struct ast_node *n)
{
    struct str id = element_attribute(n, "id");
    if (name_is_free(id))
        buffer_printf(w->out, " %.*s", STR_ARG(id));
    else if (id.at)
        native_put_note(w, "id", id);
}

static void put_object(struct native_writer *w, const struct ast_node *n, enum schema_group group)
{
    enum schema_kind kind = schema_find_kind(group, element_attribute(n, "class"), true);
    native_put(w, schema_kinds[kind].native);
    put_label(w, n);
    native_put_class(w, n, kind);
    native_put_block(w, n, kind);
}

static void put_light(struct native_writer *w, const struct ast_node *n)
{
    put_object(w, n, SCHEMA_LIGHT);
}

static void put_surface(struct native_writer *w, const struct ast_node *n)
{
    put_object(w, n, SCHEMA_SURFACE);
}

static void put_texture_statement(struct native_writer *w, const struct ast_node *n)
{
    size_t i = w->texture_count++;
    native_put(w, "texture ");
    buffer_str(w->out, w->textures[i]);
    if (w->texture_notes[i])
        native_put_note(w, "id", element_attribute(n, "id"));
    native_put(w, " = image");
    native_put_block(w, n, KIND_IMAGE);
}

/* The sections that are arrays. */
static const struct section {
    const char *name;
    void (*put)(struct native_writer *w, const struct ast_node *n);
} sections[] = {
    {"textures", put_texture_statement}, {"lights", put_light}, {"surfaces", put_surface}};
enum { SECTIONS = sizeof sections / sizeof *sections };

/* The items of a section.  Comments in front of the first touch it, whatever blank lines the file
 * has: set apart they would stand before the section. */
static void put_items(struct native_writer *w, const struct section *s, const struct ast_node *n)
{
    struct members items;
    native_members(w, n, &items);
    for (size_t i = 0; i < items.v.n; i++) {
        native_put_shared(w, items.v.at[i].node);
        native_put_lead(w, &items.v.at[i], i > 0);
        s->put(w, items.v.at[i].node);
        native_put_behind(w, &items.v.at[i]);
    }
    native_put_comments(w, items.tail, items.tails, COMMENT_OWN_LINE);
    vec_free(&items.v);
}

/* ---- the scene ---- */

static bool holds_items(const struct ast_node *section)
{
    for (const struct ast_node *c = section->children; c; c = c->next)
        if (element_is(c))
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
static const struct ast_node *needed_before(const struct native_writer *w, const struct ast_node *n)
{
    const struct ast_node *textures = native_section(w, "textures");
    bool later = textures && textures->span.begin > n->span.begin && w->texture_count == 0;
    return later && uses_texture(n) ? textures : NULL;
}

static void put_section(struct native_writer *w, const struct section *s, const struct member *m)
{
    const struct ast_node *moved = needed_before(w, m->node);
    bool away = s == &sections[0] && w->texture_count > 0; /* its items were needed before */
    if (moved) {
        put_items(w, &sections[0], moved);
        begin_line(w->out, true);
    }
    native_put_comments(w, m->lead, m->leads, COMMENT_OWN_LINE);
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

static void put_child(struct native_writer *w, const struct member *m)
{
    const struct section *s = section_named(m->node->name);
    if (s) {
        put_section(w, s, m);
        return;
    }
    bool camera = str_is(m->node->name, "camera");
    native_put_comments(w, m->lead, m->leads, COMMENT_OWN_LINE);
    native_put(w, camera ? "camera" : "settings");
    native_put_block(w, m->node, camera ? KIND_CAMERA : KIND_SETTINGS);
    native_put_behind(w, m);
    begin_line(w->out, true);
}

/* Comments outside the root; what is behind it comes after a note. */
static void put_outside(struct native_writer *w, struct gap g, bool behind)
{
    struct gap_unit u;
    for (bool first = behind; gap_next(&g, &u); first = false) {
        if (first)
            note_write("end", str_of("scene"), COMMENT_OWN_LINE, w->out);
        begin_line(w->out,
                   !first && gap_blank_before(w->ast, w->ast->trivia.at[u.first].span.begin));
        native_put_comments(w, u.first, u.n, COMMENT_OWN_LINE);
    }
    begin_line(w->out, behind || gap_blank_before(w->ast, g.at));
}

static void put_scene(struct native_writer *w)
{
    const struct ast_node *root = w->ast->statements;
    struct str model = element_attribute(root, "model");
    struct members children;
    put_outside(w, gap_at(w->ast, w->ast->source->base), false);
    native_put(w, "wrt 1\nmodel ");
    native_put(w, w->t->desc->model == SCHEMA_MODERN ? "modern" : "classic");
    if (model.at && w->t->desc->model == SCHEMA_CLASSIC)
        native_put_note(w, "model", model);
    begin_line(w->out, true);
    native_members(w, root, &children);
    hand_on_comments(&children);
    for (size_t i = 0; i < children.v.n; i++)
        put_child(w, &children.v.at[i]);
    native_put_comments(w, children.tail, children.tails, COMMENT_OWN_LINE);
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
static void name_textures(struct native_writer *w)
{
    const struct ast_node *section = native_section(w, "textures");
    size_t i = 0;
    w->textures = arena_zalloc(&w->arena, w->t->desc->textures.n, sizeof *w->textures);
    w->texture_notes = arena_zalloc(&w->arena, w->t->desc->textures.n, sizeof *w->texture_notes);
    for (const struct ast_node *c = section ? section->children : NULL; c; c = c->next) {
        if (!element_is(c))
            continue;
        struct str id = element_attribute(c, "id"),
                   made = names_of_file(&w->names, leaf_text(c, "file"));
        struct str name = names_take(&w->names, id.at ? id : made);
        w->texture_notes[i] = id.at && (!str_equal(id, name) || str_equal(made, name));
        w->textures[i++] = name;
    }
}

void translate_xml(const struct translation *t, struct buffer *out)
{
    struct native_writer w = {.t = t, .ast = t->ast, .out = out};
    w.names.arena = &w.arena;
    name_textures(&w);
    native_find_shared(&w, t->ast->statements);
    put_scene(&w);
    names_free(&w.names);
    map_free(&w.shared);
    arena_free(&w.arena);
}
