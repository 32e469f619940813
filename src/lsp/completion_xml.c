/* What may be written at a place of an XML text. */
#include "config.h"

#include "lsp/completion.h"
#include "lsp/cursor_xml.h"
#include "lsp/locate.h"

struct tags {
    struct completion *c;
    struct tag_cursor cursor;
    const char *bracket; /* what an element needs before its name */
};

static const struct tag_open *open_tag(const struct tags *t, size_t from_inside)
{
    size_t n = t->cursor.open.n;
    return from_inside < n ? &t->cursor.open.at[n - 1 - from_inside] : NULL;
}

static struct str name_of(const struct tag_open *open)
{
    return open ? open->name : (struct str){0};
}

/* The kind that an open element makes; SCHEMA_KINDS: none. */
static enum schema_kind kind_of(const struct tags *t, size_t from_inside)
{
    const struct tag_open *open = open_tag(t, from_inside);
    if (!open)
        return SCHEMA_KINDS;
    return locate_kind_by_tags(open->name, name_of(open_tag(t, from_inside + 1)),
                               str_trim(open->class));
}

static bool is_given(const struct tags *t, struct str name)
{
    const struct tag_open *open = open_tag(t, 0);
    for (size_t i = open ? open->given : 0; i < t->cursor.given.n; i++)
        if (str_equal(t->cursor.given.at[i], name))
            return true;
    return false;
}

/* ---- elements -------------------------------------------------------------------------------- */

static void add_element(struct tags *t, const char *name, enum item_kind kind, const char *behind,
                        const char *detail)
{
    struct buffer text = {0};
    buffer_printf(&text, "%s%s%s", t->bracket, name, behind);
    json_t *item = completion_add(t->c, str_of(name), kind, detail);
    json_object_set_new(item, "insertText", wire_buffer(&text));
}

/* The elements around objects, by what is around them. */
static const struct {
    const char *around, *name, *behind, *doc;
    unsigned models;
} structure[] = {
    {"", "scene", ">", "the whole", IN_BOTH},
    {"scene", "camera", ">", "the eye", IN_BOTH},
    {"scene", "settings", ">", "what holds for the whole picture", IN_MODERN},
    {"scene", "lights", ">", "all lights", IN_BOTH},
    {"scene", "textures", ">", "all textures", IN_BOTH},
    {"scene", "surfaces", ">", "all surfaces", IN_BOTH},
    {"lights", "light", " class=\"", "a light", IN_BOTH},
    {"textures", "Texture", ">", "a picture file as a texture", IN_BOTH},
    {"surfaces", "surface", " class=\"", "a surface", IN_BOTH},
};

static void add_structure(struct tags *t)
{
    struct str around = name_of(open_tag(t, 0));
    for (size_t i = 0; i < sizeof structure / sizeof *structure; i++) {
        struct str name = str_of(structure[i].name);
        bool once = str_is(around, "scene");
        if (str_is(around, structure[i].around) && completion_has(t->c, structure[i].models) &&
            !(once && is_given(t, name)))
            add_element(t, structure[i].name, ITEM_KEYWORD, structure[i].behind, structure[i].doc);
    }
}

static void add_leaves(struct tags *t, enum schema_kind kind)
{
    for (int p = 0; p < SCHEMA_PROPS; p++) {
        enum schema_prop_id id = (enum schema_prop_id)p;
        if (!schema_has(kind, id) || !completion_has(t->c, schema_props[id].models))
            continue;
        bool object =
            schema_props[id].type == TYPE_MATERIAL || schema_props[id].type == TYPE_SURFACE;
        for (unsigned n = 0; n < schema_leaf_count(id); n++) {
            struct str leaf = schema_leaf(id, n);
            if (!is_given(t, leaf))
                completion_add_prop(t->c, id, leaf, t->bracket, object ? " class=\"" : ">");
        }
    }
}

/* What a leaf's text may be, where that is words. */
static void add_text(struct tags *t)
{
    enum schema_prop_id id =
        locate_prop(t->c->where->analysis, kind_of(t, 1), name_of(open_tag(t, 0)));
    if (id == SCHEMA_PROPS)
        return;
    struct str word;
    if (schema_props[id].type == TYPE_SWITCH)
        completion_add_words(t->c, "0 1", ITEM_VALUE, schema_props[id].doc);
    for (unsigned n = 0; schema_props[id].type == TYPE_WORD && (word = schema_word(id, n, true)).n;
         n++)
        completion_add(t->c, word, ITEM_VALUE, schema_props[id].doc);
}

static void complete_element(struct tags *t)
{
    enum schema_kind kind = kind_of(t, 0);
    add_structure(t);
    if (kind != SCHEMA_KINDS)
        add_leaves(t, kind);
}

static void complete_closing(struct tags *t)
{
    struct str name = name_of(open_tag(t, 0));
    if (!name.n)
        return;
    struct buffer text = {0};
    buffer_printf(&text, "%.*s>", STR_ARG(name));
    json_t *item = completion_add(t->c, name, ITEM_KEYWORD, "ends the element");
    json_object_set_new(item, "insertText", wire_buffer(&text));
}

/* ---- attributes ------------------------------------------------------------------------------ */

static enum schema_group group_of(const struct tags *t)
{
    return locate_group_by_tags(name_of(open_tag(t, 0)), name_of(open_tag(t, 1)));
}

static bool has_class(enum schema_group group)
{
    return group == SCHEMA_LIGHT || group == SCHEMA_SURFACE || group == SCHEMA_MATERIAL;
}

static bool takes_attribute(const struct tags *t, const char *name)
{
    enum schema_group group = group_of(t);
    if (strcmp(name, "model") == 0)
        return t->cursor.open.n == 1;
    if (strcmp(name, "ref") == 0)
        return group == SCHEMA_MATERIAL;
    return has_class(group) || (group == SCHEMA_TEXTURE && strcmp(name, "id") == 0);
}

static void complete_attribute(struct tags *t)
{
    static const struct {
        const char *name, *doc;
    } attributes[] = {{"class", "the kind"},
                      {"id", "a name"},
                      {"ref", "the id of a material that is meant here"},
                      {"model", "which arithmetic the scene means"}};
    for (size_t i = 0; i < sizeof attributes / sizeof *attributes; i++) {
        bool given = false;
        for (size_t k = 0; k < t->cursor.attributes.n; k++)
            given |= str_is(t->cursor.attributes.at[k], attributes[i].name);
        if (given || !takes_attribute(t, attributes[i].name))
            continue;
        struct buffer text = {0};
        buffer_printf(&text, "%s=\"", attributes[i].name);
        json_t *item =
            completion_add(t->c, str_of(attributes[i].name), ITEM_PROPERTY, attributes[i].doc);
        json_object_set_new(item, "insertText", wire_buffer(&text));
    }
}

static void add_classes(struct tags *t)
{
    enum schema_group group = group_of(t);
    for (int k = 0; k < SCHEMA_KINDS && has_class(group); k++) {
        const struct schema_kind_row *row = &schema_kinds[k];
        if (row->group == group && completion_has(t->c, row->models))
            completion_add(t->c, str_of(row->xml), ITEM_CLASS, row->doc);
    }
}

static void complete_value(struct tags *t)
{
    struct str name = t->cursor.attributes.at[t->cursor.attributes.n - 1];
    const struct bindings *names = &t->c->where->analysis->bindings;
    if (str_is(name, "class"))
        add_classes(t);
    if (str_is(name, "model"))
        completion_add_words(t->c, "modern classic", ITEM_VALUE,
                             "which arithmetic the scene means");
    for (size_t i = 0; i < names->defs.n && str_is(name, "ref"); i++)
        completion_add(t->c, names->defs.at[i].name, ITEM_CONSTANT, "material");
}

void complete_xml(struct completion *c, struct str text, uint32_t at)
{
    struct tags t = {.c = c};
    tag_cursor_find(&t.cursor, text, at);
    c->model = str_is(t.cursor.model, "modern") ? SCHEMA_MODERN : SCHEMA_CLASSIC;
    t.bracket = t.cursor.place == TAG_CONTENT ? "<" : "";
    switch (t.cursor.place) {
    case TAG_NOWHERE:
        break;
    case TAG_CONTENT:
        add_text(&t);
        if (!t.cursor.text)
            complete_element(&t);
        break;
    case TAG_NAME:
        complete_element(&t);
        break;
    case TAG_CLOSING:
        complete_closing(&t);
        break;
    case TAG_ATTRIBUTE:
        complete_attribute(&t);
        break;
    case TAG_VALUE:
        complete_value(&t);
        break;
    }
    tag_cursor_free(&t.cursor);
}
