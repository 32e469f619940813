/* The native language to XML.
 *
 * What becomes an element is what evaluation made of the text: loops, templates, functions and
 * defaults are gone.  The tree still tells how a number was spelt, and where comments go: those of
 * an object evaluated several times are written with the first.
 *
 * The text written here is no more than right; the printer lays it out. */
#include "config.h"

#include "convert/translating.h"

#include "base/map.h"
#include "base/num.h"
#include "convert/comments.h"
#include "convert/names.h"
#include "convert/places.h"

#include <stdlib.h>

/* A tree node that objects, properties and values are looked up by, by its offset. */
struct entry {
    uint32_t begin;
    const struct ast_node *node;
};

/* How a material with an id is written. */
struct shared {
    struct str
        id; /* as XML spells it in quotes; empty: it has none and is written wherever it is used */
    uint32_t place; /* offset of the value that a note calls its definition; 0: the first use */
    bool written;
};

struct writer {
    const struct translation *t;
    const struct ast *ast;
    const struct desc *desc;
    struct buffer *out;
    struct arena arena;
    struct places places;
    VEC(struct entry) nodes; /* rising */
    struct shared *shared;   /* one for each material */
    struct str *texture_ids; /* one for each texture; empty: none */
    bool *begun;             /* one for each stop: its comments are written */
};

/* ---- the tree ---- */

static void index_nodes(struct writer *w, const struct ast_node *n)
{
    for (; n; n = n->next) {
        bool looked_up =
            n->kind == AST_BLOCK || n->kind == AST_CONSTRUCT || n->kind == AST_PROPERTY;
        if (looked_up)
            vec_push(&w->nodes, (struct entry){n->span.begin, n});
        if (n->kind == AST_PROPERTY && n->children->kind != AST_CONSTRUCT)
            vec_push(&w->nodes, (struct entry){n->children->span.begin, n->children});
        index_nodes(w, n->children);
    }
}

/* The node that begins there in the scene's own text, or NULL. */
static const struct ast_node *node_at(const struct writer *w, struct span span)
{
    size_t first = 0, last = w->nodes.n;
    while (first < last) {
        size_t middle = first + (last - first) / 2;
        if (w->nodes.at[middle].begin < span.begin)
            first = middle + 1;
        else
            last = middle;
    }
    bool found = first < w->nodes.n && w->nodes.at[first].begin == span.begin;
    return found ? w->nodes.at[first].node : NULL;
}

static const struct ast_node *property_at(const struct writer *w, const struct desc_prop *p)
{
    const struct ast_node *n = p->inherited ? NULL : node_at(w, p->name_span);
    return n && n->kind == AST_PROPERTY ? n : NULL;
}

static bool is_own(const struct writer *w, uint32_t offset)
{
    const struct source *s = w->ast->source;
    return offset >= s->base && offset <= s->base + s->n;
}

/* ---- comments ---- */

static void put(struct writer *w, const char *text)
{
    buffer_puts(w->out, text);
}

static void put_comment(struct writer *w, size_t i, enum comment_place place)
{
    if (w->places.comments[i].done)
        return;
    w->places.comments[i].done = true;
    comment_to_xml(w->ast, &w->ast->trivia.at[i], place, w->out);
}

/* All that are left between two offsets. */
static void put_between(struct writer *w, uint32_t begin, uint32_t end, enum comment_place place)
{
    for (size_t i = gap_at(w->ast, begin).comment;
         i < w->ast->trivia.n && w->ast->trivia.at[i].span.begin < end; i++)
        put_comment(w, i, place);
}

/* Those of a stop that go to a place. */
static void put_placed(struct writer *w, size_t owner, enum place_kind kind)
{
    const struct stop *stop = &w->places.stops.at[owner];
    for (size_t i = stop->first; i < stop->last; i++) {
        const struct place *p = &w->places.comments[i];
        if (p->kind != kind || p->owner != owner || p->done)
            continue;
        if (kind != PLACE_BEHIND)
            begin_line(w->out, kind != PLACE_SECTION &&
                                   gap_blank_before(w->ast, w->ast->trivia.at[i].span.begin));
        put_comment(w, i, kind == PLACE_BEHIND ? COMMENT_BEHIND : COMMENT_OWN_LINE);
    }
}

/* Those outside of statements that belong to the scene as a whole. */
static void put_outside(struct writer *w, enum place_kind kind)
{
    for (size_t i = 0; i < w->ast->trivia.n; i++) {
        if (w->places.comments[i].kind != kind || w->places.comments[i].done)
            continue;
        begin_line(w->out, gap_blank_before(w->ast, w->ast->trivia.at[i].span.begin));
        put_comment(w, i, COMMENT_OWN_LINE);
    }
}

/* Those on the line on which something ends, when nothing else follows there. */
static void put_behind(struct writer *w, uint32_t end)
{
    struct gap g = gap_at(w->ast, end);
    struct gap_unit u;
    g.separators = ",;";
    if (gap_next(&g, &u) && u.newlines == 0 && u.ends_line)
        put_between(w, end, w->ast->trivia.at[u.first + u.n - 1].span.end, COMMENT_BEHIND);
}

/* Those before a member of a block: what is left since the member before, or the brace. */
static void put_lead(struct writer *w, uint32_t begin)
{
    size_t last = gap_at(w->ast, begin).comment, first = last;
    uint32_t at = begin;
    const char *text = w->ast->source->text;
    for (;;) {
        while (memchr(" \t\r\n,;", text[at - 1 - w->ast->source->base], 6))
            at--;
        if (first == 0 || w->ast->trivia.at[first - 1].span.end != at)
            break;
        at = w->ast->trivia.at[--first].span.begin;
    }
    for (; first < last; first++) {
        begin_line(w->out, gap_blank_before(w->ast, w->ast->trivia.at[first].span.begin));
        put_comment(w, first, COMMENT_OWN_LINE);
    }
    begin_line(w->out, gap_blank_before(w->ast, begin));
}

/* The value of a note between two offsets, which is used up. */
static struct str take_note(struct writer *w, uint32_t begin, uint32_t end, const char *name)
{
    for (size_t i = gap_at(w->ast, begin).comment;
         i < w->ast->trivia.n && w->ast->trivia.at[i].span.begin < end; i++) {
        struct note note;
        if (!note_read(w->ast, &w->ast->trivia.at[i], &note) || !str_is(note.name, name))
            continue;
        w->places.comments[i].done = true;
        return note.value;
    }
    return (struct str){0};
}

/* Where the token behind some comments begins. */
static uint32_t next_token(const struct writer *w, uint32_t at)
{
    struct gap g = gap_at(w->ast, at);
    struct gap_unit u;
    while (gap_next(&g, &u))
        ;
    return g.at;
}

/* ---- spellings ---- */

static const struct ast_node *inside_brackets(const struct ast_node *n)
{
    while (n && n->kind == AST_PARENTHESES)
        n = n->children;
    return n;
}

/* The n-th part of a value as written: of a vector or list, or the whole for a number that stands
 * for all parts; NULL when the text does not spell it. */
static const struct ast_node *part_of(const struct ast_node *value, unsigned n)
{
    const struct ast_node *v = inside_brackets(value), *c = v ? v->children : NULL;
    if (!v || (v->kind != AST_VECTOR && v->kind != AST_LIST))
        return v;
    while (n-- && c)
        c = c->next;
    return c;
}

/* The number as the text spells it, if that is the number. */
static struct str spelling_of(struct writer *w, double x, const struct ast_node *n)
{
    n = inside_brackets(n);
    struct str s = n ? translate_text(w->t, n->span) : (struct str){0};
    double spelt;
    if (n && n->kind == AST_ANGLE && s.n > 3)
        s.n -= 3; /* the unit; radians are another number */
    bool right = s.n && num_parse(s.at, s.at + s.n, &spelt) == s.at + s.n &&
                 memcmp(&spelt, &x, sizeof x) == 0;
    if (right)
        return s;
    char digits[NUM_PRINT_BYTES];
    size_t length = num_print(x, digits);
    return (struct str){arena_copy(&w->arena, digits, length), length};
}

static void put_numbers(struct writer *w, const double *x, unsigned n, const struct ast_node *value)
{
    for (unsigned i = 0; i < n; i++) {
        if (i > 0)
            put(w, " ");
        buffer_str(w->out, spelling_of(w, x[i], part_of(value, i)));
    }
}

/* ---- values ---- */

static void report_unsayable(struct writer *w, struct span span, const char *what)
{
    diag_report(w->t->diag, DIAG_UNSAYABLE, span, "XML cannot say %s, so nothing is written", what);
}

static void put_file(struct writer *w, const struct desc_value *v)
{
    struct str name = translate_file(w->t, v->string, v->spelt, &w->arena);
    if (!xml_can_say(name))
        report_unsayable(w, v->span, "a file name with control characters");
    else if (str_trim(name).n != name.n)
        report_unsayable(w, v->span, "a file name with blanks at its ends");
    xml_escape(name, false, w->out);
}

/* The schema's word, or the letters that a note keeps. */
static void put_word(struct writer *w, enum schema_prop_id id, const struct desc_value *v,
                     const struct ast_node *value)
{
    struct str word = schema_word(id, v->word, true), noted = {0};
    if (value)
        noted = take_note(w, value->span.end, next_token(w, value->span.end), schema_props[id].xml);
    bool same = noted.at && schema_find_word(id, noted, true) == (int)v->word;
    buffer_str(w->out, same ? noted : word);
}

/* The text of a leaf. */
static void put_text(struct writer *w, enum schema_prop_id id, const struct desc_value *v,
                     const struct ast_node *value)
{
    switch (schema_props[id].type) {
    case TYPE_VECTOR:
    case TYPE_VECTOR_OR_PAIR:
    case TYPE_SCALE:
    case TYPE_COLOUR:
        put_numbers(w, v->number, 3, value);
        break;
    case TYPE_WORD:
        put_word(w, id, v, value);
        break;
    case TYPE_FILE:
        put_file(w, v);
        break;
    case TYPE_TEXTURE:
        buffer_printf(w->out, "%u", v->object->number);
        break;
    default:
        put_numbers(w, v->number, 1, value);
        break;
    }
}

/* ---- properties ---- */

static void put_element(struct writer *w, const struct desc_object *o, const char *tag,
                        struct str id);

/* One leaf of those that a list of points or a size becomes. */
static void put_part(struct writer *w, enum schema_prop_id id, unsigned i,
                     const struct desc_value *v, const struct ast_node *value)
{
    struct str leaf = schema_leaf(id, i);
    const struct ast_node *list = inside_brackets(value);
    const struct ast_node *part = list && list->children ? part_of(list, i) : NULL;
    begin_line(w->out, false);
    if (part)
        put_lead(w, part->span.begin);
    buffer_printf(w->out, "<%.*s>", STR_ARG(leaf));
    if (part)
        put_between(w, part->span.begin, part->span.end, COMMENT_INSIDE);
    if (schema_props[id].type == TYPE_POINTS)
        put_numbers(w, &v->points[i].x, 3, part);
    else
        put_numbers(w, &v->size[i], 1, part);
    buffer_printf(w->out, "</%.*s>", STR_ARG(leaf));
    if (part)
        put_between(w, part->span.end, next_token(w, part->span.end), COMMENT_BEHIND);
}

static void put_leaf(struct writer *w, enum schema_prop_id id, const struct desc_value *v,
                     const struct ast_node *property)
{
    const struct ast_node *value = property ? property->children : NULL;
    struct buffer *out = w->out, text = {0};
    struct str leaf = schema_leaf(id, 0);
    buffer_printf(out, "<%.*s>", STR_ARG(leaf));
    w->out = &text; /* a note in it is no comment of the leaf */
    put_text(w, id, v, value);
    w->out = out;
    if (property)
        put_between(w, property->span.begin, property->span.end, COMMENT_INSIDE);
    buffer_str(out, (struct str){text.at, text.n});
    buffer_printf(out, "</%.*s>", STR_ARG(leaf));
    buffer_free(&text);
}

/* The value's material: its definition, or a reference to it. */
static void put_material(struct writer *w, const struct desc_value *v,
                         const struct ast_node *property)
{
    const struct desc_object *m = v->object;
    struct shared *s = &w->shared[m->number];
    bool here = !s->id.n || (s->place ? s->place == v->span.begin : !s->written);
    if (property && here)
        put_between(w, property->span.begin, property->children->name_span.begin, COMMENT_OWN_LINE);
    if (here) {
        s->written = true;
        put_element(w, m, "material", s->id);
        return;
    }
    buffer_printf(w->out, "<material ref=\"%.*s\">", STR_ARG(s->id));
    if (property)
        put_between(w, property->span.begin, property->span.end, COMMENT_INSIDE);
    put(w, "</material>");
}

/* What several leaves make: a list of points, or a size. */
static void put_parts(struct writer *w, const struct desc_prop *p, const struct ast_node *property)
{
    const struct ast_node *value = property ? property->children : NULL;
    unsigned n = schema_leaf_count((enum schema_prop_id)p->id);
    if (property)
        put_between(w, property->span.begin, value->span.begin, COMMENT_OWN_LINE);
    for (unsigned i = 0; i < n; i++)
        put_part(w, (enum schema_prop_id)p->id, i, &p->value, value);
}

static void put_property(struct writer *w, const struct desc_prop *p)
{
    enum schema_prop_id id = (enum schema_prop_id)p->id;
    const struct ast_node *property = property_at(w, p);
    unsigned leaves = schema_leaf_count(id);
    if (property)
        put_lead(w, property->span.begin);
    if (leaves == 0)
        report_unsayable(w, p->name_span, arena_printf(&w->arena, "'%s'", schema_props[id].native));
    else if (schema_props[id].type == TYPE_MATERIAL)
        put_material(w, &p->value, property);
    else if (schema_props[id].type == TYPE_SURFACE)
        put_element(w, p->value.object, "object", (struct str){0});
    else if (leaves == 1)
        put_leaf(w, id, &p->value, property);
    else
        put_parts(w, p, property);
    if (property)
        put_behind(w, property->span.end);
    begin_line(w->out, false);
}

/* ---- objects ---- */

/* Where the brace of an object stands: behind its name and label. */
static uint32_t brace_of(const struct writer *w, const struct ast_node *n)
{
    const char *text = w->ast->source->text - w->ast->source->base;
    uint32_t at = next_token(w, n->name_span.end);
    while (text[at] != '{') {
        while (!memchr(" \t\r\n/{", text[at], 6))
            at++;
        at = next_token(w, at);
    }
    return at;
}

/* The class as a note keeps it, where another name of the kind was used. */
static struct str class_of(struct writer *w, const struct desc_object *o, const struct ast_node *n)
{
    struct str noted = n ? take_note(w, n->span.begin, brace_of(w, n), "class") : (struct str){0};
    enum schema_group group = schema_kinds[o->kind].group;
    bool same = noted.at && schema_find_kind(group, noted, true) == o->kind;
    return same ? noted : str_of(schema_kinds[o->kind].xml);
}

static void put_element(struct writer *w, const struct desc_object *o, const char *tag,
                        struct str id)
{
    const struct ast_node *n = node_at(w, o->span);
    enum schema_group group = schema_kinds[o->kind].group;
    struct str class = class_of(w, o, n);
    buffer_printf(w->out, "<%s", tag);
    if (group != SCHEMA_CAMERA && group != SCHEMA_SETTINGS && group != SCHEMA_TEXTURE)
        buffer_printf(w->out, " class=\"%.*s\"", STR_ARG(class));
    if (id.n)
        buffer_printf(w->out, " id=\"%.*s\"", STR_ARG(id));
    put(w, ">");
    for (const struct desc_prop *p = o->props; p; p = p->next)
        put_property(w, p);
    if (n)
        put_between(w, n->span.begin, n->span.end, COMMENT_OWN_LINE);
    buffer_printf(w->out, "</%s>", tag);
}

/* An object's label, or the id that a note keeps. */
static struct str label_of(struct writer *w, const struct desc_object *o)
{
    const struct ast_node *n = node_at(w, o->span);
    struct str noted = n ? take_note(w, n->span.begin, brace_of(w, n), "id") : (struct str){0};
    return noted.at ? noted : o->name;
}

static void put_camera(struct writer *w, const struct desc_object *o)
{
    put_element(w, o, "camera", (struct str){0});
}

static void put_settings(struct writer *w, const struct desc_object *o)
{
    put_element(w, o, "settings", (struct str){0});
}

/* Names that were made from the file's go without saying. */
static void put_texture(struct writer *w, const struct desc_object *o)
{
    put_element(w, o, "Texture", w->texture_ids[o->number]);
}

static void put_light(struct writer *w, const struct desc_object *o)
{
    put_element(w, o, "light", label_of(w, o));
}

static void put_surface(struct writer *w, const struct desc_object *o)
{
    put_element(w, o, "surface", label_of(w, o));
}

/* ---- sections ---- */

struct section {
    const char *name;
    bool array;
    struct desc_object *const *at;
    size_t n;
    void (*put)(struct writer *w, const struct desc_object *o);
    unsigned rank;             /* among sections that begin with one statement */
    uint32_t begin;            /* of its first statement, or of the note that holds its place */
    const struct stop *holder; /* that note, or NULL */
};

/* Where evaluation of the scene's own text came to the object. */
static uint32_t origin_of(const struct writer *w, const struct desc_object *o)
{
    uint32_t at = is_own(w, o->span.begin) ? o->span.begin : w->ast->source->base;
    for (const struct diag_frame *f = o->frame; f; f = f->parent)
        if (is_own(w, f->at.begin))
            at = f->at.begin;
    return at;
}

/* The comments of a statement, before the first element it makes. */
static void begin_stop(struct writer *w, size_t k)
{
    if (w->begun[k])
        return;
    w->begun[k] = true;
    put_placed(w, k, PLACE_SECTION);
    put_placed(w, k, PLACE_BEFORE);
}

static void end_stop(struct writer *w, size_t k)
{
    put_placed(w, k, PLACE_BEHIND);
    put_placed(w, k, PLACE_AFTER);
}

/* An object, with its own comments where it stands inside of a statement. */
static void put_object(struct writer *w, const struct section *s, const struct desc_object *o,
                       uint32_t statement)
{
    const struct ast_node *n = node_at(w, o->span);
    bool inside = n && n->kind == AST_BLOCK && n->span.begin != statement;
    if (inside)
        put_lead(w, n->span.begin);
    begin_line(w->out, false);
    s->put(w, o);
    if (inside)
        put_behind(w, n->span.end);
}

static void put_objects(struct writer *w, const struct section *s)
{
    for (size_t i = 0; i < s->n; i++) {
        size_t k = places_stop(&w->places, origin_of(w, s->at[i]));
        size_t next = i + 1 < s->n ? places_stop(&w->places, origin_of(w, s->at[i + 1])) : SIZE_MAX;
        begin_line(w->out, !w->begun[k] && gap_blank_before(w->ast, w->places.stops.at[k].begin));
        begin_stop(w, k);
        put_object(w, s, s->at[i], w->places.stops.at[k].begin);
        if (next != k)
            end_stop(w, k);
    }
}

static void put_section(struct writer *w, const struct section *s)
{
    size_t k = s->holder ? (size_t)(s->holder - w->places.stops.at)
                         : places_stop(&w->places, origin_of(w, s->at[0]));
    put_placed(w, k, PLACE_SECTION);
    if (!s->array) {
        put_objects(w, s);
        return;
    }
    begin_line(w->out, false);
    buffer_printf(w->out, "<%s>", s->name);
    if (s->holder)
        begin_stop(w, k);
    put_objects(w, s);
    if (s->holder)
        end_stop(w, k);
    begin_line(w->out, false);
    buffer_printf(w->out, "</%s>\n", s->name);
}

static int compare_sections(const void *a, const void *b)
{
    const struct section *x = a, *y = b;
    if (x->begin != y->begin)
        return x->begin < y->begin ? -1 : 1;
    return (x->rank > y->rank) - (x->rank < y->rank);
}

static void locate_section(struct writer *w, struct section *s)
{
    s->begin = s->n ? UINT32_MAX : 0;
    for (size_t i = 0; i < s->n; i++) {
        size_t k = places_stop(&w->places, origin_of(w, s->at[i]));
        uint32_t at = w->places.stops.at[k].begin;
        s->begin = at < s->begin ? at : s->begin;
    }
    for (size_t k = 0; k < w->places.stops.n; k++) {
        if (!str_is(w->places.stops.at[k].section, s->name))
            continue;
        s->holder = &w->places.stops.at[k];
        s->begin = s->holder->begin;
    }
}

/* ---- the scene ---- */

/* The attributes of the root. */
static void put_model(struct writer *w)
{
    struct str noted = {0};
    for (const struct ast_node *s = w->ast->statements; s; s = s->next)
        if (s->kind == AST_MODEL)
            noted = take_note(w, s->span.end, next_token(w, s->span.end), "model");
    if (w->desc->model == SCHEMA_MODERN)
        put(w, " model=\"modern\"");
    else if (noted.at)
        buffer_printf(w->out, " model=\"%.*s\"", STR_ARG(noted));
}

/* What evaluation left without a place: comments inside statements that XML does not have. */
static void put_left_over(struct writer *w)
{
    for (size_t i = 0; i < w->ast->trivia.n; i++)
        if (w->places.comments[i].kind != PLACE_FOOT)
            put_comment(w, i, COMMENT_OWN_LINE);
}

static void report_unused(struct writer *w)
{
    for (size_t i = 0; i < w->desc->materials.n; i++)
        if (w->shared[i].id.n && !w->shared[i].written)
            diag_report(w->t->diag, DIAG_DROPPED, w->desc->materials.at[i]->span,
                        "XML has materials only where they are used, so '%.*s' is left out",
                        STR_ARG(w->desc->materials.at[i]->name));
}

static void put_scene(struct writer *w, struct section *sections, size_t n)
{
    put_outside(w, PLACE_HEAD);
    begin_line(w->out, gap_blank_before(w->ast, next_token(w, w->ast->source->base)));
    put(w, "<scene");
    put_model(w);
    put(w, ">");
    for (size_t i = 0; i < n; i++)
        if (sections[i].n || sections[i].holder)
            put_section(w, &sections[i]);
    put_outside(w, PLACE_TAIL);
    put_left_over(w);
    begin_line(w->out, false);
    put(w, "</scene>\n");
    put_outside(w, PLACE_FOOT);
    report_unused(w);
}

/* ---- names ---- */

/* The note behind a name in the scene's own text. */
static struct str noted_id(struct writer *w, struct str name)
{
    const struct source *s = w->ast->source;
    uintptr_t at = (uintptr_t)name.at - (uintptr_t)s->text;
    if (!name.n || at >= s->n)
        return (struct str){0};
    uint32_t end = s->base + (uint32_t)(at + name.n);
    return take_note(w, end, next_token(w, end), "id");
}

/* The first material of each name gets an id, unless all are to be written out. */
static void name_materials(struct writer *w)
{
    struct map known = {0};
    w->shared = arena_zalloc(&w->arena, w->desc->materials.n, sizeof *w->shared);
    for (size_t i = 0; i < w->desc->materials.n; i++) {
        struct desc_object *m = w->desc->materials.at[i];
        struct str noted = noted_id(w, m->name);
        if (!m->name.n || map_get(&known, m->name) || w->t->expand)
            continue;
        map_set(&known, m->name, m);
        w->shared[i].id = noted.at ? noted : m->name;
    }
    map_free(&known);
}

/* Notes behind the names of materials where they are used: there XML had the definition. */
static void place_definitions(struct writer *w, const struct desc_object *o)
{
    for (const struct desc_prop *p = o->props; p; p = p->next) {
        const struct ast_node *property = property_at(w, p);
        if (p->id == PROP_OBJECT)
            place_definitions(w, p->value.object);
        if (p->id != PROP_MATERIAL || !property || property->children->kind != AST_NAME)
            continue;
        uint32_t end = property->span.end;
        if (take_note(w, end, next_token(w, end), "id").at)
            w->shared[p->value.object->number].place = property->children->span.begin;
    }
}

/* The ids of textures, none for a name that to_native.c would make of the file's. */
static void name_textures(struct writer *w)
{
    struct names names = {.arena = &w->arena};
    w->texture_ids = arena_zalloc(&w->arena, w->desc->textures.n, sizeof *w->texture_ids);
    for (size_t i = 0; i < w->desc->textures.n; i++) {
        const struct desc_object *o = w->desc->textures.at[i];
        struct str noted = noted_id(w, o->name);
        struct str made = names_of_file(&names, desc_get(o, PROP_FILE)->string);
        if (noted.at || (o->name.n && !str_equal(o->name, made)))
            w->texture_ids[i] = noted.at ? noted : o->name;
        if (o->name.n)
            names_take(&names, o->name);
    }
    names_free(&names);
}

static int compare_offsets(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static void find_places(struct writer *w, const struct section *sections, size_t n)
{
    VEC(uint32_t) origins = {0};
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < sections[i].n; j++)
            vec_push(&origins, origin_of(w, sections[i].at[j]));
    qsort(origins.at, origins.n, sizeof *origins.at, compare_offsets);
    places_find(&w->places, w->ast, origins.at, origins.n);
    w->begun = arena_zalloc(&w->arena, w->places.stops.n, sizeof *w->begun);
    vec_free(&origins);
}

bool translate_description(const struct translation *t, struct buffer *out)
{
    const struct desc *d = t->desc;
    struct writer w = {.t = t, .ast = t->ast, .desc = d, .out = out};
    struct section sections[] = {
        {"camera", false, &d->camera, 1, put_camera, .rank = 0},
        {"settings", false, &d->settings, d->settings != NULL, put_settings, .rank = 1},
        {"textures", true, d->textures.at, d->textures.n, put_texture, .rank = 2},
        {"lights", true, d->lights.at, d->lights.n, put_light, .rank = 3},
        {"surfaces", true, d->surfaces.at, d->surfaces.n, put_surface, .rank = 4},
    };
    enum { SECTIONS = sizeof sections / sizeof *sections };
    size_t errors = t->diag->errors;
    index_nodes(&w, t->ast->statements);
    find_places(&w, sections, SECTIONS);
    for (size_t i = 0; i < SECTIONS; i++)
        locate_section(&w, &sections[i]);
    qsort(sections, SECTIONS, sizeof *sections, compare_sections);
    name_materials(&w);
    name_textures(&w);
    for (size_t i = 0; i < d->surfaces.n; i++)
        place_definitions(&w, d->surfaces.at[i]);
    for (size_t i = 0; i < d->lights.n; i++)
        place_definitions(&w, d->lights.at[i]);
    put_scene(&w, sections, SECTIONS);
    places_free(&w.places);
    vec_free(&w.nodes);
    arena_free(&w.arena);
    return t->diag->errors == errors;
}
