/* Native values as the types of the schema: one row of a table each. */
#include "config.h"

#include "eval/context.h"

#include <math.h>

struct target {
    struct eval *e;
    enum schema_prop_id id;
    const struct schema_prop *prop;
    struct desc_value *out;
};

static void copy_numbers(const struct value *v, struct desc_value *out)
{
    out->n = v->n;
    for (int i = 0; i < 3; i++)
        out->number[i] = (uint32_t)i < v->n ? v->number[i] : 0;
}

static bool is_plain(const struct value *v)
{
    return value_is_numeric(v) && !v->angles;
}

static bool as_number(const struct target *t, const struct value *v)
{
    copy_numbers(v, t->out);
    return v->type == VALUE_NUMBER && !v->angles;
}

static bool as_integer(const struct target *t, const struct value *v)
{
    return as_number(t, v) && v->number[0] == floor(v->number[0]);
}

static bool as_angle(const struct target *t, const struct value *v)
{
    copy_numbers(v, t->out);
    return v->type == VALUE_NUMBER;
}

static bool as_number_or_switch(const struct target *t, const struct value *v)
{
    if (v->type != VALUE_BOOL)
        return as_number(t, v);
    t->out->n = 1;
    t->out->number[0] = v->boolean;
    return true;
}

static bool as_switch(const struct target *t, const struct value *v)
{
    return as_number_or_switch(t, v) && (t->out->number[0] == 0 || t->out->number[0] == 1);
}

/* A number stands for all three. */
static bool as_vector(const struct target *t, const struct value *v)
{
    copy_numbers(v, t->out);
    if (v->n == 1)
        t->out->number[1] = t->out->number[2] = v->number[0];
    return is_plain(v) && v->n != 2;
}

static bool as_vector_or_pair(const struct target *t, const struct value *v)
{
    as_vector(t, v);
    return is_plain(v);
}

/* Numbers are degrees; a single one would not say about which axis. */
static bool as_rotation(const struct target *t, const struct value *v)
{
    copy_numbers(v, t->out);
    return (v->type == VALUE_VECTOR && v->n == 3) || (v->type == VALUE_NUMBER && v->number[0] == 0);
}

static bool as_matrix(const struct target *t, const struct value *v)
{
    enum { NUMBERS = 12 };
    if (v->type != VALUE_LIST)
        return false;
    if (v->n != NUMBERS) {
        diag_report(t->e->diag, DIAG_WRONG_COUNT, v->span, "'%s' takes %d numbers, but found %u",
                    t->prop->native, NUMBERS, v->n);
        return false;
    }
    struct affine *m = arena_alloc(&t->e->out->arena, sizeof *m);
    for (uint32_t i = 0; i < NUMBERS; i++) {
        struct value item = value_item(v, i);
        if (item.type != VALUE_NUMBER || item.angles) {
            diag_report(t->e->diag, DIAG_WRONG_TYPE, item.span,
                        "a matrix is made of numbers, but this is %s", value_type_name(&item));
            return false;
        }
        m->m[i / 4][i % 4] = item.number[0];
    }
    t->out->matrix = m;
    return true;
}

static bool as_size(const struct target *t, const struct value *v)
{
    copy_numbers(v, t->out);
    return is_plain(v) && v->n == 2 && v->number[0] == floor(v->number[0]) &&
           v->number[1] == floor(v->number[1]);
}

static bool as_points(const struct target *t, const struct value *v)
{
    if (v->type != VALUE_LIST)
        return false;
    unsigned want = schema_leaf_count(t->id);
    if (v->n != want) {
        diag_report(t->e->diag, DIAG_WRONG_COUNT, v->span, "'%s' takes %u points, but found %u",
                    t->prop->native, want, v->n);
        t->out->n = 0;
        return false;
    }
    t->out->points = arena_zalloc(&t->e->out->arena, want, sizeof *t->out->points);
    t->out->n = want;
    for (unsigned i = 0; i < want; i++) {
        struct value item = value_item(v, i);
        if (item.type != VALUE_VECTOR || item.angles) {
            diag_report(t->e->diag, DIAG_WRONG_TYPE, item.span,
                        "a point is two or three numbers, but this is %s", value_type_name(&item));
            return false;
        }
        t->out->points[i] = vec3(item.number[0], item.number[1], item.n == 3 ? item.number[2] : 0);
    }
    return true;
}

static bool as_word(const struct target *t, const struct value *v)
{
    int word = v->type == VALUE_STRING ? schema_find_word(t->id, v->string, false) : -1;
    t->out->word = word >= 0 ? (unsigned)word : 0;
    return word >= 0;
}

static bool as_file(const struct target *t, const struct value *v)
{
    if (v->type != VALUE_STRING)
        return false;
    const char *kept = arena_copy(&t->e->out->arena, v->string.at, v->string.n);
    t->out->string = (struct str){kept, v->string.n};
    t->out->spelt = v->spelt ? v->spelt : v->span.begin;
    if (!v->string.n)
        diag_report(t->e->diag, DIAG_WRONG_TYPE, v->span,
                    "'%s' takes a file name, but this is empty", t->prop->native);
    return v->string.n > 0;
}

static bool as_member(const struct target *t, const struct value *v, enum schema_group group)
{
    t->out->object = v->type == VALUE_OBJECT ? v->object : NULL;
    return t->out->object && schema_kinds[v->object->kind].group == group;
}

static bool as_material(const struct target *t, const struct value *v)
{
    return as_member(t, v, SCHEMA_MATERIAL);
}

static bool as_texture(const struct target *t, const struct value *v)
{
    return as_member(t, v, SCHEMA_TEXTURE);
}

static bool as_surface(const struct target *t, const struct value *v)
{
    return as_member(t, v, SCHEMA_SURFACE);
}

typedef bool converter(const struct target *t, const struct value *v);
static converter *const converters[SCHEMA_TYPES] = {
    [TYPE_NUMBER] = as_number,
    [TYPE_INTEGER] = as_integer,
    [TYPE_ANGLE] = as_angle,
    [TYPE_SWITCH] = as_switch,
    [TYPE_NUMBER_OR_SWITCH] = as_number_or_switch,
    [TYPE_VECTOR] = as_vector,
    [TYPE_VECTOR_OR_PAIR] = as_vector_or_pair,
    [TYPE_SCALE] = as_vector,
    [TYPE_COLOUR] = as_vector,
    [TYPE_ROTATION] = as_rotation,
    [TYPE_MATRIX] = as_matrix,
    [TYPE_SIZE] = as_size,
    [TYPE_POINTS] = as_points,
    [TYPE_WORD] = as_word,
    [TYPE_FILE] = as_file,
    [TYPE_MATERIAL] = as_material,
    [TYPE_TEXTURE] = as_texture,
    [TYPE_SURFACE] = as_surface,
};

/* A list of numbers where a vector is meant; the value is written in its place. */
static void add_vector(struct diag_entry *entry, const struct value *v, struct str text)
{
    for (uint32_t i = 0; i < v->n; i++)
        if (v->items && v->items[i].type != VALUE_NUMBER)
            return;
    if (v->n < 2 || v->n > 3 || text.n < 2 || text.at[0] != '[' || text.at[text.n - 1] != ']')
        return;
    diag_note(entry, "vectors are written (x, y, z); brackets make lists");
    diag_fix(entry, (struct span){v->span.begin, v->span.begin + 1}, DIAG_FIX_SAFE, "(");
    diag_fix(entry, (struct span){v->span.end - 1, v->span.end}, DIAG_FIX_SAFE, ")");
}

/* A name in quotes. */
static void add_name(struct eval *e, struct diag_entry *entry, const struct value *v,
                     struct str text)
{
    if (!scope_find(e, v->string) || text.n != v->string.n + 2 || text.at[0] != '"')
        return;
    diag_note(entry, "names stand without quotes");
    diag_fix(entry, v->span, DIAG_FIX_SAFE, "%.*s", STR_ARG(v->string));
}

/* Two numbers, one of them not whole. */
static bool report_size(struct eval *e, const struct schema_prop *p, const struct value *v)
{
    bool pair = p->type == TYPE_SIZE && v->type == VALUE_VECTOR && v->n == 2 && !v->angles;
    for (uint32_t i = 0; pair && i < v->n; i++)
        if (v->number[i] != floor(v->number[i]))
            diag_report(e->diag, DIAG_WRONG_TYPE, v->span,
                        "'%s' takes two whole numbers, but %c is %.17g", p->native, "xy"[i],
                        v -> number[i]);
    return pair;
}

static void report_misfit(struct eval *e, enum schema_prop_id id, const struct value *v)
{
    const struct schema_prop *p = &schema_props[id];
    struct str text = srcmap_text(e->diag->sources, v->span);
    if (p->type == TYPE_WORD && v->type == VALUE_STRING) {
        report_unknown_word(e, id, v->string, v->span, false);
        return;
    }
    if (p->type == TYPE_INTEGER && v->type == VALUE_NUMBER && !v->angles) {
        diag_report(e->diag, DIAG_WRONG_TYPE, v->span,
                    "'%s' takes a whole number, but this is %.17g", p->native, v->number[0]);
        return;
    }
    if (report_size(e, p, v))
        return;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_WRONG_TYPE, v->span, "'%s' takes %s, but this is %s", p->native,
                    schema_type_name(p->type), value_type_name(v));
    if (v->type == VALUE_LIST)
        add_vector(entry, v, text);
    else if (v->type == VALUE_STRING)
        add_name(e, entry, v, text);
}

bool value_convert(struct eval *e, enum schema_prop_id id, const struct value *v,
                   struct desc_value *out)
{
    if (v->type == VALUE_ERROR)
        return false;
    for (uint32_t i = 0; v->type == VALUE_LIST && v->items && i < v->n; i++)
        if (v->items[i].type == VALUE_ERROR)
            return false;
    size_t errors = e->diag->errors;
    struct target t = {e, id, &schema_props[id], out};
    if (converters[t.prop->type](&t, v))
        return true;
    if (e->diag->errors == errors)
        report_misfit(e, id, v);
    return false;
}
