/* The schema, readable: `wrt doc`, `wrt doc sphere`, `wrt doc sphere.radius`, `wrt doc light.shape`
 * for what a light of any kind has, and `wrt doc radius` for what has such a property; names are
 * native or XML's.  Likewise the functions and statements of the native language, and the params
 * that options give. */
#include "config.h"

#include "cmd/commands.h"

#include "eval/signature.h"
#include "schema/describe.h"

/* The names that were asked for. */
struct question {
    struct str kind, prop; /* prop: behind the point; empty without one */
};

static bool is_kind(enum schema_kind kind, struct str name)
{
    const char *native = schema_kinds[kind].native, *space = strchr(native, ' ');
    return str_is(name, native) || (space && str_is(name, space + 1)) ||
           schema_find_kind(schema_kinds[kind].group, name, true) == kind;
}

/* By its native name, or the word that tells it from the others of its group, or its XML class. */
static enum schema_kind find_kind(struct str name)
{
    int k = 0;
    while (k < SCHEMA_KINDS && !is_kind((enum schema_kind)k, name))
        k++;
    return (enum schema_kind)k;
}

static enum schema_prop_id find_prop(enum schema_kind kind, struct str name)
{
    unsigned leaf;
    enum schema_prop_id id = schema_find_prop(kind, name, false, &leaf);
    return id != SCHEMA_PROPS ? id : schema_find_prop(kind, name, true, &leaf);
}

/* ---- answers --------------------------------------------------------------------------------- */

static void add_group(struct buffer *out, enum schema_group group)
{
    const char *name = schema_group_name(group);
    buffer_printf(out, "%s%s:\n", name, name[strlen(name) - 1] == 's' ? "" : "s");
    for (int k = 0; k < SCHEMA_KINDS; k++)
        if (schema_kinds[k].group == group)
            buffer_printf(out, "  %-14s %s\n", schema_kinds[k].native, schema_kinds[k].doc);
}

static void add_overview(struct buffer *out)
{
    for (int g = 0; g < SCHEMA_GROUPS; g++) {
        add_group(out, (enum schema_group)g);
        buffer_puts(out, "\n");
    }
    buffer_puts(out, "'wrt doc KIND' shows the properties of a kind, 'wrt doc KIND.PROPERTY' all "
                     "about one;\n'wrt doc functions' and 'wrt doc statements' list those of the "
                     "native language\n");
}

static void add_line(struct buffer *out, enum schema_prop_id id)
{
    const struct schema_prop *p = &schema_props[id];
    buffer_printf(out, "  %-14s ", p->native);
    describe_value(out, id, false);
    if (p->required || p->models != IN_BOTH)
        buffer_puts(out, ", ");
    describe_conditions(out, id);
    if (p->has_default) {
        buffer_puts(out, " = ");
        describe_default(out, id);
    }
    buffer_printf(out, "\n  %-14s %s\n", "", p->doc);
}

static void add_kind(struct buffer *out, enum schema_kind kind)
{
    buffer_printf(out, "%s: %s\nin XML: ", schema_kinds[kind].native, schema_kinds[kind].doc);
    describe_element(out, kind);
    buffer_puts(out, "\n\n");
    for (int p = 0; p < SCHEMA_PROPS; p++)
        if (schema_has(kind, (enum schema_prop_id)p))
            add_line(out, (enum schema_prop_id)p);
}

static void add_property(struct buffer *out, enum schema_kind kind, enum schema_prop_id id)
{
    const struct schema_prop *p = &schema_props[id];
    buffer_printf(out, "%s.%s: %s\n\n  value    ", schema_kinds[kind].native, p->native, p->doc);
    describe_value(out, id, false);
    buffer_puts(out, "\n  default  ");
    if (p->has_default)
        describe_default(out, id);
    else
        buffer_puts(out, p->required ? "none: it must be given" : "none");
    if (p->has_default && p->required)
        buffer_puts(out, "; otherwise it must be given");
    if (p->models != IN_BOTH)
        buffer_printf(out, "\n  model    %s only", p->models == IN_MODERN ? "modern" : "classic");
    buffer_puts(out, "\n  in XML   ");
    if (*p->xml)
        describe_leaves(out, id);
    else
        buffer_puts(out, "none");
    if (p->type == TYPE_WORD) {
        buffer_puts(out, ", ");
        describe_value(out, id, true);
    }
    buffer_puts(out, "\n  kinds    ");
    bool any = false;
    for (int k = 0; k < SCHEMA_KINDS; k++)
        if (schema_has((enum schema_kind)k, id)) {
            buffer_printf(out, "%s%s", any ? ", " : "", schema_kinds[k].native);
            any = true;
        }
    buffer_puts(out, "\n");
}

/* All properties of that name in a group, or in all (SCHEMA_GROUPS), each once; false when there is
 * none. */
static bool add_properties(struct buffer *out, enum schema_group group, struct str name)
{
    size_t before = out->n;
    for (int p = 0; p < SCHEMA_PROPS; p++) {
        enum schema_prop_id id = (enum schema_prop_id)p;
        int k = 0;
        while (k < SCHEMA_KINDS &&
               !((group == SCHEMA_GROUPS || schema_kinds[k].group == group) &&
                 schema_has((enum schema_kind)k, id) && find_prop((enum schema_kind)k, name) == id))
            k++;
        if (k == SCHEMA_KINDS)
            continue;
        buffer_puts(out, out->n > before ? "\n" : "");
        add_property(out, (enum schema_kind)k, id);
    }
    return out->n > before;
}

/* ---- names that do not exist ----------------------------------------------------------------- */

static int unknown(struct str name, const char *what, const char *list,
                   const struct str_nearest *nearest)
{
    struct str meant = str_nearest_found(nearest);
    if (meant.n)
        return usage_error("doc: there is no %s '%.*s'; did you mean '%.*s'?", what, STR_ARG(name),
                           STR_ARG(meant));
    return usage_error("doc: there is no %s '%.*s'; 'wrt doc%s' lists them", what, STR_ARG(name),
                       list);
}

static void try_props(struct str_nearest *nearest, enum schema_kind kind)
{
    struct str leaf;
    for (int p = 0; p < SCHEMA_PROPS; p++) {
        if (!schema_has(kind, (enum schema_prop_id)p))
            continue;
        str_nearest_try(nearest, str_of(schema_props[p].native));
        for (unsigned n = 0; (leaf = schema_leaf((enum schema_prop_id)p, n)).n; n++)
            str_nearest_try(nearest, leaf);
    }
}

static int unknown_property(enum schema_kind kind, struct str name)
{
    char what[64], list[64];
    struct str_nearest nearest = str_nearest_to(name);
    try_props(&nearest, kind);
    snprintf(what, sizeof what, "property of %s called", schema_kinds[kind].native);
    snprintf(list, sizeof list, " %s", schema_kinds[kind].native);
    return unknown(name, what, list, &nearest);
}

static int unknown_in_group(enum schema_group group, struct str name)
{
    char what[64];
    struct str_nearest nearest = str_nearest_to(name);
    for (int k = 0; k < SCHEMA_KINDS; k++)
        if (schema_kinds[k].group == group)
            try_props(&nearest, (enum schema_kind)k);
    snprintf(what, sizeof what, "property of any %s called", schema_group_name(group));
    return unknown(name, what, "", &nearest);
}

static int unknown_name(struct str name, bool props_too)
{
    struct str_nearest nearest = str_nearest_to(name);
    for (int k = 0; k < SCHEMA_KINDS; k++) {
        const char *native = schema_kinds[k].native, *space = strchr(native, ' ');
        str_nearest_try(&nearest, str_of(native));
        str_nearest_try(&nearest, str_of(space ? space + 1 : native));
        str_nearest_try(&nearest, str_of(schema_kinds[k].xml));
        if (props_too)
            try_props(&nearest, (enum schema_kind)k);
    }
    if (props_too)
        signature_try_names(&nearest);
    return unknown(name, props_too ? "kind, property, function or statement" : "kind", "",
                   &nearest);
}

/* ---- the command ----------------------------------------------------------------------------- */

static enum schema_group find_group(struct str name)
{
    int g = 0;
    while (g < SCHEMA_GROUPS && !str_is(name, schema_group_name((enum schema_group)g)))
        g++;
    return (enum schema_group)g;
}

static int answer_property(struct buffer *out, const struct question *q)
{
    enum schema_kind kind = find_kind(q->kind);
    enum schema_group group = find_group(q->kind);
    enum schema_prop_id id = kind == SCHEMA_KINDS ? SCHEMA_PROPS : find_prop(kind, q->prop);
    if (id != SCHEMA_PROPS)
        add_property(out, kind, id);
    else if (kind != SCHEMA_KINDS)
        return unknown_property(kind, q->prop);
    else if (group == SCHEMA_GROUPS)
        return unknown_name(q->kind, false);
    else if (!add_properties(out, group, q->prop))
        return unknown_in_group(group, q->prop);
    return 0;
}

/* A group's word may be that of a statement, too. */
static int answer(struct buffer *out, struct str name)
{
    enum schema_kind kind = find_kind(name);
    enum schema_group group = find_group(name);
    if (kind != SCHEMA_KINDS)
        add_kind(out, kind);
    else if (group != SCHEMA_GROUPS) {
        add_group(out, group);
        buffer_puts(out, "\n");
    } else if (str_is(name, "functions"))
        signature_list_functions(out);
    else if (str_is(name, "statements"))
        signature_list_statements(out);
    bool told = signature_describe_statement(out, name) || signature_describe_function(out, name) ||
                signature_describe_param(out, name);
    return told || out->n || add_properties(out, SCHEMA_GROUPS, name) ? 0
                                                                      : unknown_name(name, true);
}

/* `light point.intensity`, as one argument or several. */
static void join(struct buffer *out, const struct options *o)
{
    for (size_t i = 0; i < o->scenes.n; i++) {
        buffer_puts(out, i ? " " : "");
        buffer_puts(out, o->scenes.at[i]);
    }
}

int command_doc(const struct options *o)
{
    struct buffer out = {0}, words = {0};
    int status = 0;
    join(&words, o);
    struct str all = {words.at, words.n};
    const char *point = all.n ? memchr(all.at, '.', all.n) : NULL;
    size_t n = point ? (size_t)(point - all.at) : all.n;
    struct question q = {.kind = {all.at, n}};
    if (point)
        q.prop = (struct str){point + 1, all.n - n - 1};
    if (o->manual && all.n && !str_is(all, "functions"))
        status = usage_error("doc --man: the tables of all kinds, or of 'functions'; not of '%.*s'",
                             STR_ARG(all));
    else if (o->manual && all.n)
        signature_manual(&out);
    else if (o->manual)
        describe_manual(&out);
    else if (q.prop.n)
        status = answer_property(&out, &q);
    else if (all.n)
        status = answer(&out, q.kind);
    else
        add_overview(&out);
    if (out.n)
        fwrite(out.at, 1, out.n, stdout);
    buffer_free(&words);
    buffer_free(&out);
    return status;
}
