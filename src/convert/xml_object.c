#include "config.h"

#include "base/num.h"
#include "convert/to_xml.h"

#include <math.h>

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
static struct str spelling_of(struct xml_writer *w, double x, const struct ast_node *n)
{
    n = inside_brackets(n);
    struct str s = n ? translate_text(w->t, n->span) : (struct str){0};
    double spelt;
    if (n && n->kind == AST_ANGLE && s.n > 3)
        s.n -= 3; /* the unit; radians are another number */
    bool right = s.n && num_parse(s.at, s.at + s.n, &spelt) == s.at + s.n && spelt == x &&
                 !signbit(spelt) == !signbit(x);
    if (right)
        return s;
    char digits[NUM_PRINT_BYTES];
    size_t length = num_print(x, digits);
    return (struct str){arena_copy(&w->arena, digits, length), length};
}

static void put_numbers(struct xml_writer *w, const double *x, unsigned n,
                        const struct ast_node *value)
{
    for (unsigned i = 0; i < n; i++) {
        if (i > 0)
            xml_put(w, " ");
        buffer_str(w->out, spelling_of(w, x[i], part_of(value, i)));
    }
}

/* ---- values ---- */

static void report_unsayable(struct xml_writer *w, struct span span, const char *what)
{
    diag_report(w->t->diag, DIAG_UNSAYABLE, span, "XML cannot say %s, so nothing is written", what);
}

static void put_file(struct xml_writer *w, const struct desc_value *v)
{
    struct str name = translate_file(w->t, v->string, v->spelt, &w->arena);
    if (!xml_can_say(name))
        report_unsayable(w, v->span, "a file name with control characters");
    else if (str_trim(name).n != name.n)
        report_unsayable(w, v->span, "a file name with blanks at its ends");
    xml_escape(name, false, w->out);
}

/* The schema's word, or the letters that a note keeps. */
static void put_word(struct xml_writer *w, enum schema_prop_id id, const struct desc_value *v,
                     const struct ast_node *value)
{
    struct str word = schema_word(id, v->word, true), noted = {0};
    if (value)
        noted = xml_take_note(w, value->span.end, xml_next_token(w, value->span.end),
                              schema_props[id].xml);
    bool same = noted.at && schema_find_word(id, noted, true) == (int)v->word;
    buffer_str(w->out, same ? noted : word);
}

/* The text of a leaf. */
static void put_text(struct xml_writer *w, enum schema_prop_id id, const struct desc_value *v,
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

/* One leaf of those that a list of points or a size becomes. */
static void put_part(struct xml_writer *w, enum schema_prop_id id, unsigned i,
                     const struct desc_value *v, const struct ast_node *value)
{
    struct str leaf = schema_leaf(id, i);
    const struct ast_node *list = inside_brackets(value);
    const struct ast_node *part = list && list->children ? part_of(list, i) : NULL;
    begin_line(w->out, false);
    if (part)
        xml_put_lead(w, part->span.begin);
    buffer_printf(w->out, "<%.*s>", STR_ARG(leaf));
    if (part)
        xml_put_between(w, part->span.begin, part->span.end, COMMENT_INSIDE);
    if (schema_props[id].type == TYPE_POINTS)
        put_numbers(w, &v->points[i].x, 3, part);
    else
        put_numbers(w, &v->size[i], 1, part);
    buffer_printf(w->out, "</%.*s>", STR_ARG(leaf));
    if (part)
        xml_put_between(w, part->span.end, xml_next_token(w, part->span.end), COMMENT_BEHIND);
}

static void put_leaf(struct xml_writer *w, enum schema_prop_id id, const struct desc_value *v,
                     const struct ast_node *property)
{
    const struct ast_node *value = property ? ast_value(property, &w->arena) : NULL;
    struct buffer *out = w->out, text = {0};
    struct str leaf = schema_leaf(id, 0);
    buffer_printf(out, "<%.*s>", STR_ARG(leaf));
    w->out = &text; /* a note in it is no comment of the leaf */
    put_text(w, id, v, value);
    w->out = out;
    if (property)
        xml_put_between(w, property->span.begin, property->span.end, COMMENT_INSIDE);
    buffer_str(out, (struct str){text.at, text.n});
    buffer_printf(out, "</%.*s>", STR_ARG(leaf));
    buffer_free(&text);
}

/* The value's material: its definition, or a reference to it. */
static void put_material(struct xml_writer *w, const struct desc_value *v,
                         const struct ast_node *property)
{
    const struct desc_object *m = v->object;
    struct shared *s = &w->shared[m->number];
    bool here = !s->id.n || (s->place ? s->place == v->span.begin : !s->written);
    if (property && here)
        xml_put_between(w, property->span.begin, property->children->name_span.begin,
                        COMMENT_OWN_LINE);
    if (here) {
        s->written = true;
        xml_put_element(w, m, "material", s->id);
        return;
    }
    buffer_printf(w->out, "<material ref=\"%.*s\">", STR_ARG(s->id));
    if (property)
        xml_put_between(w, property->span.begin, property->span.end, COMMENT_INSIDE);
    xml_put(w, "</material>");
}

/* What several leaves make: a list of points, or a size. */
static void put_parts(struct xml_writer *w, const struct desc_prop *p,
                      const struct ast_node *property)
{
    const struct ast_node *value = property ? ast_value(property, &w->arena) : NULL;
    unsigned n = schema_leaf_count((enum schema_prop_id)p->id);
    if (property)
        xml_put_between(w, property->span.begin, value->span.begin, COMMENT_OWN_LINE);
    for (unsigned i = 0; i < n; i++)
        put_part(w, (enum schema_prop_id)p->id, i, &p->value, value);
}

static void put_property(struct xml_writer *w, const struct desc_prop *p)
{
    enum schema_prop_id id = (enum schema_prop_id)p->id;
    const struct ast_node *property = xml_property_at(w, p);
    unsigned leaves = schema_leaf_count(id);
    if (property)
        xml_put_lead(w, property->span.begin);
    if (leaves == 0)
        report_unsayable(w, p->name_span, arena_printf(&w->arena, "'%s'", schema_props[id].native));
    else if (schema_props[id].type == TYPE_MATERIAL)
        put_material(w, &p->value, property);
    else if (schema_props[id].type == TYPE_SURFACE)
        xml_put_element(w, p->value.object, "object", (struct str){0});
    else if (leaves == 1)
        put_leaf(w, id, &p->value, property);
    else
        put_parts(w, p, property);
    if (property)
        xml_put_behind(w, property->span.end);
    begin_line(w->out, false);
}

/* ---- objects ---- */

/* Where the brace of an object stands: behind its name and label. */
static uint32_t brace_of(const struct xml_writer *w, const struct ast_node *n)
{
    const char *text = w->ast->source->text - w->ast->source->base;
    uint32_t at = xml_next_token(w, n->name_span.end);
    while (text[at] != '{') {
        while (!memchr(" \t\r\n/{", text[at], 6))
            at++;
        at = xml_next_token(w, at);
    }
    return at;
}

/* The class as a note keeps it, where another name of the kind was used. */
static struct str class_of(struct xml_writer *w, const struct desc_object *o,
                           const struct ast_node *n)
{
    struct str noted =
        n ? xml_take_note(w, n->span.begin, brace_of(w, n), "class") : (struct str){0};
    enum schema_group group = schema_kinds[o->kind].group;
    bool same = noted.at && schema_find_kind(group, noted, true) == o->kind;
    return same ? noted : str_of(schema_kinds[o->kind].xml);
}

void xml_put_element(struct xml_writer *w, const struct desc_object *o, const char *tag,
                     struct str id)
{
    const struct ast_node *n = xml_node_at(w, o->span);
    enum schema_group group = schema_kinds[o->kind].group;
    struct str class = class_of(w, o, n);
    buffer_printf(w->out, "<%s", tag);
    if (group != SCHEMA_CAMERA && group != SCHEMA_SETTINGS && group != SCHEMA_TEXTURE)
        buffer_printf(w->out, " class=\"%.*s\"", STR_ARG(class));
    if (id.n)
        buffer_printf(w->out, " id=\"%.*s\"", STR_ARG(id));
    xml_put(w, ">");
    for (const struct desc_prop *p = o->props; p; p = p->next)
        put_property(w, p);
    if (n)
        xml_put_between(w, n->span.begin, n->span.end, COMMENT_OWN_LINE);
    buffer_printf(w->out, "</%s>", tag);
}

struct str xml_label_of(struct xml_writer *w, const struct desc_object *o)
{
    const struct ast_node *n = xml_node_at(w, o->span);
    struct str noted = n ? xml_take_note(w, n->span.begin, brace_of(w, n), "id") : (struct str){0};
    return noted.at ? noted : o->name;
}
