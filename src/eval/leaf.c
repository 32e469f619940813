/* The text of XML leaves, read as the schema says. */
#include "config.h"

#include "eval/context.h"

#include "base/num.h"

#include <math.h>

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/* The place of bytes [from, to) of the text. */
static struct span place_in(const struct ast_node *text, const char *from, const char *to)
{
    if (!text->exact)
        return text->span;
    uint32_t begin = text->span.begin + (uint32_t)(from - text->text.at);
    return (struct span){begin, begin + (uint32_t)(to - from)};
}

static void report_not_a_number(struct eval *e, const struct ast_node *text, const char *from,
                                const char *to)
{
    int n = to - from < 40 ? (int)(to - from) : 40;
    diag_report(e->diag, DIAG_NUMBER_SYNTAX, place_in(text, from, to), "'%.*s' is not a number", n,
                from);
}

/* Reads exactly `want` numbers, 1 to 3. */
static bool read_numbers(struct eval *e, const struct ast_node *leaf, unsigned want, double *out)
{
    const struct ast_node *text = leaf->children;
    const char *at = text->text.at, *end = at + text->text.n;
    unsigned n = 0;
    for (;; n++) {
        while (at < end && is_space(*at))
            at++;
        if (at == end)
            break;
        double x = 0;
        const char *after = num_parse(at, end, &x);
        if (!after || (after < end && !is_space(*after))) {
            const char *word = at;
            while (word < end && !is_space(*word))
                word++;
            report_not_a_number(e, text, at, word);
            return false;
        }
        if (!isfinite(x)) {
            diag_report(e->diag, DIAG_NOT_FINITE, place_in(text, at, after),
                        "the number is too large");
            return false;
        }
        if (n < want)
            out[n] = x;
        at = after;
    }
    if (n == want)
        return true;
    diag_report(e->diag, DIAG_WRONG_COUNT, text->text.n ? text->span : leaf->span,
                "'%.*s' takes %u number%s, but found %u", STR_ARG(leaf->name), want,
                want == 1 ? "" : "s", n);
    return false;
}

static bool require_whole(struct eval *e, const struct ast_node *leaf, double x)
{
    if (x == floor(x))
        return true;
    diag_report(e->diag, DIAG_WRONG_TYPE, leaf->children->span, "'%.*s' takes a whole number",
                STR_ARG(leaf->name));
    return false;
}

static bool read_texture_index(struct eval *e, const struct ast_node *leaf, struct desc_value *out)
{
    double x;
    if (!read_numbers(e, leaf, 1, &x) || !require_whole(e, leaf, x))
        return false;
    size_t n = e->out->textures.n - e->first_texture;
    if (x >= 0 && x < (double)n) {
        out->object = e->out->textures.at[e->first_texture + (size_t)x];
        return true;
    }
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_TEXTURE_INDEX, leaf->children->span, "there is no texture %.*s",
                    STR_ARG(leaf->children->text));
    if (n)
        diag_note(entry, "the scene's textures are numbered from 0 to %zu", n - 1);
    else
        diag_note(entry, "the scene has no textures");
    return false;
}

static bool read_switch(struct eval *e, const struct ast_node *leaf, struct desc_value *out)
{
    if (!read_numbers(e, leaf, 1, out->number))
        return false;
    if (out->number[0] == 0 || out->number[0] == 1)
        return true;
    diag_report(e->diag, DIAG_OUT_OF_RANGE, leaf->children->span, "'%.*s' is 0 or 1",
                STR_ARG(leaf->name));
    return false;
}

static bool read_word(struct eval *e, enum schema_prop_id id, const struct ast_node *leaf,
                      struct desc_value *out)
{
    const struct ast_node *text = leaf->children;
    int word = schema_find_word(id, text->text, true);
    if (word >= 0)
        out->word = (unsigned)word;
    else
        report_unknown_word(e, id, text->text, text->span, true);
    return word >= 0;
}

static bool read_file(struct eval *e, const struct ast_node *leaf, struct desc_value *out)
{
    out->string = leaf->children->text;
    out->spelt = leaf->children->span.begin;
    if (out->string.n)
        return true;
    diag_report(e->diag, DIAG_WRONG_TYPE, leaf->span, "'%.*s' takes a file name",
                STR_ARG(leaf->name));
    return false;
}

/* One of the leaves that make a list of points, or a size. */
static bool read_part(struct eval *e, enum schema_prop_id id, unsigned part,
                      const struct ast_node *leaf, struct desc_value *out)
{
    double x[3] = {0};
    bool point = schema_props[id].type == TYPE_POINTS;
    if (!read_numbers(e, leaf, point ? 3 : 1, x))
        return false;
    if (!point) {
        out->number[part] = x[0];
        return require_whole(e, leaf, x[0]);
    }
    unsigned count = schema_leaf_count(id);
    if (!out->n)
        out->points = arena_zalloc(&e->out->arena, count, sizeof *out->points);
    out->n = count;
    out->points[part] = vec3(x[0], x[1], x[2]);
    return true;
}

static bool read_value(struct eval *e, enum schema_prop_id id, unsigned part,
                       const struct ast_node *leaf, struct desc_value *out)
{
    switch (schema_props[id].type) {
    case TYPE_INTEGER:
        return read_numbers(e, leaf, 1, out->number) && require_whole(e, leaf, out->number[0]);
    case TYPE_NUMBER:
    case TYPE_ANGLE:
    case TYPE_NUMBER_OR_SWITCH:
        return read_numbers(e, leaf, 1, out->number);
    case TYPE_SWITCH:
        return read_switch(e, leaf, out);
    case TYPE_VECTOR:
    case TYPE_VECTOR_OR_PAIR:
    case TYPE_SCALE:
    case TYPE_COLOUR:
        return read_numbers(e, leaf, 3, out->number);
    case TYPE_SIZE:
    case TYPE_POINTS:
        return read_part(e, id, part, leaf, out);
    case TYPE_WORD:
        return read_word(e, id, leaf, out);
    case TYPE_FILE:
        return read_file(e, leaf, out);
    case TYPE_TEXTURE:
        return read_texture_index(e, leaf, out);
    case TYPE_ROTATION: /* of groups, which XML lacks */
    case TYPE_MATRIX:
    case TYPE_MATERIAL:
    case TYPE_SURFACE:
    case SCHEMA_TYPES:
        break;
    }
    diag_report(e->diag, DIAG_WRONG_TYPE, leaf->span,
                "'%.*s' takes %s: an element with a 'class' and leaves of its own",
                STR_ARG(leaf->name), schema_type_name(schema_props[id].type));
    return false;
}

/* An empty leaf has no text whose place could be shown. */
static bool report_empty(struct eval *e, enum schema_prop_id id, const struct ast_node *leaf)
{
    if (leaf->children->text.n)
        return false;
    diag_report(e->diag, DIAG_WRONG_COUNT, leaf->span, "'%.*s' is empty, but takes %s",
                STR_ARG(leaf->name),
                schema_props[id].type == TYPE_POINTS ? "three numbers"
                                                     : schema_type_name(schema_props[id].type));
    return true;
}

void eval_leaf(struct eval *e, struct desc_object *o, const struct ast_node *leaf)
{
    unsigned part;
    enum schema_prop_id id = object_find_prop(e, o, leaf->name, leaf->name_span, &part);
    struct desc_prop *p =
        id != SCHEMA_PROPS ? object_prop(e, &e->out->arena, o, id, part, leaf->name_span) : NULL;
    bool right = p && !report_empty(e, id, leaf) && read_value(e, id, part, leaf, &p->value);
    o->broken |= !right;
    if (!p)
        return;
    p->broken |= !right;
    if (schema_props[id].type == TYPE_SIZE && part > 0)
        p->value.second = leaf->children->span;
    else
        p->value.span = leaf->children->span;
}
