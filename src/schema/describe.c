#include "config.h"

#include "schema/describe.h"

void describe_range(struct buffer *out, enum schema_prop_id id)
{
    const struct schema_prop *p = &schema_props[id];
    buffer_puts(out, p->above ? "above " : "at least ");
    buffer_number(out, p->least);
    if (p->most != 0) {
        buffer_puts(out, " and at most ");
        buffer_number(out, p->most);
    }
}

static void describe_words(struct buffer *out, enum schema_prop_id id, bool xml)
{
    struct str word;
    for (unsigned n = 0; (word = schema_word(id, n, xml)).n; n++) {
        buffer_puts(out, n ? ", " : "one of ");
        buffer_str(out, word);
    }
}

void describe_value(struct buffer *out, enum schema_prop_id id, bool xml)
{
    const struct schema_prop *p = &schema_props[id];
    if (p->type == TYPE_WORD)
        describe_words(out, id, xml);
    else if (p->type == TYPE_POINTS)
        buffer_printf(out, "a list of %u points", schema_leaf_count(id));
    else
        buffer_puts(out, schema_type_name(p->type));
    if (p->has_least) {
        buffer_puts(out, " ");
        describe_range(out, id);
    }
    if (p->type == TYPE_ANGLE)
        buffer_puts(out, p->has_least ? " degrees" : " in degrees");
}

static void describe_numbers(struct buffer *out, const double *x, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        buffer_puts(out, i ? ", " : n > 1 ? "(" : "");
        buffer_number(out, x[i]);
    }
    buffer_puts(out, n > 1 ? ")" : "");
}

static void describe_default_in(struct buffer *out, enum schema_prop_id id, enum schema_model model)
{
    static const uint8_t components[SCHEMA_TYPES] = {
        [TYPE_VECTOR] = 3, [TYPE_VECTOR_OR_PAIR] = 3, [TYPE_SCALE] = 3,
        [TYPE_COLOUR] = 3, [TYPE_SIZE] = 2,           [TYPE_ROTATION] = 3,
    };
    const struct schema_prop *p = &schema_props[id];
    if (p->type == TYPE_WORD)
        buffer_str(out, schema_word(id, (unsigned)p->value[model][0], false));
    else
        describe_numbers(out, p->value[model], components[p->type] ? components[p->type] : 1);
}

bool describe_has_one_default(enum schema_prop_id id)
{
    const struct schema_prop *p = &schema_props[id];
    const double(*v)[3] = p->value;
    bool same = memcmp(v[SCHEMA_CLASSIC], v[SCHEMA_MODERN], sizeof v[0]) == 0;
    return (p->has_default & p->models) == p->models && (same || p->models != IN_BOTH);
}

void describe_default(struct buffer *out, enum schema_prop_id id)
{
    unsigned models = schema_props[id].has_default & schema_props[id].models;
    bool any = false;
    for (int m = 0; m < SCHEMA_MODELS; m++) {
        if (!(models >> m & 1))
            continue;
        buffer_puts(out, any ? ", " : "");
        any = true;
        describe_default_in(out, id, (enum schema_model)m);
        if (describe_has_one_default(id))
            return;
        buffer_printf(out, " in %s", schema_model_name((enum schema_model)m));
    }
}

void describe_conditions(struct buffer *out, enum schema_prop_id id)
{
    const struct schema_prop *p = &schema_props[id];
    if (p->required)
        buffer_puts(out, "required");
    if (p->required && p->required != IN_BOTH)
        buffer_printf(out, " in %s", p->required == IN_MODERN ? "modern" : "classic");
    if (p->models != IN_BOTH)
        buffer_printf(out, "%smodel %s only", p->required ? ", " : "",
                      p->models == IN_MODERN ? "modern" : "classic");
}

void describe_leaves(struct buffer *out, enum schema_prop_id id)
{
    struct str leaf;
    for (unsigned n = 0; (leaf = schema_leaf(id, n)).n; n++)
        buffer_printf(out, "%s<%.*s>", n ? " " : "", STR_ARG(leaf));
}

void describe_element(struct buffer *out, enum schema_kind kind)
{
    const struct schema_kind_row *k = &schema_kinds[kind];
    if (k->group == SCHEMA_PLACE)
        buffer_puts(out, "none");
    else if (k->group == SCHEMA_CAMERA || k->group == SCHEMA_SETTINGS || k->group == SCHEMA_TEXTURE)
        buffer_printf(out, "<%s>", k->xml);
    else
        buffer_printf(out, "<%s class=\"%s\">", schema_group_name(k->group), k->xml);
}

bool describe_is_common(enum schema_group group, enum schema_prop_id id)
{
    unsigned kinds = 0, with = 0;
    for (int k = 0; k < SCHEMA_KINDS; k++) {
        kinds += schema_kinds[k].group == group;
        with += schema_kinds[k].group == group && schema_has((enum schema_kind)k, id);
    }
    return kinds > 1 && with == kinds;
}
