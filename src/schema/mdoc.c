/* The schema as a part of wrt(5). */
#include "config.h"

#include "schema/describe.h"

#include <ctype.h>

static const struct {
    const char *title, *common;
} groups[SCHEMA_GROUPS] = {
    [SCHEMA_CAMERA] = {"Camera", NULL},
    [SCHEMA_SETTINGS] = {"Settings", NULL},
    [SCHEMA_LIGHT] = {"Lights", "Every light also has:"},
    [SCHEMA_TEXTURE] = {"Textures", NULL},
    [SCHEMA_SURFACE] = {"Surfaces", "Every surface also has:"},
    [SCHEMA_PLACE] = {"Groups", NULL},
    [SCHEMA_MATERIAL] = {"Materials", "Every material also has:"},
};

/* Text that troff must not read as a request or an escape. */
static void add_text(struct buffer *out, struct str text)
{
    if (text.n && (text.at[0] == '.' || text.at[0] == '\''))
        buffer_puts(out, "\\&");
    for (size_t i = 0; i < text.n; i++)
        if (text.at[i] == '\\')
            buffer_puts(out, "\\e");
        else
            buffer_add(out, &text.at[i], 1);
}

/* A sentence of its own line: a capital, a full stop. */
static void add_sentence(struct buffer *out, const char *text)
{
    size_t start = out->n;
    add_text(out, str_of(text));
    out->at[start] = (char)toupper((unsigned char)out->at[start]);
    buffer_puts(out, ".\n");
}

static void add_property(struct buffer *out, enum schema_prop_id id)
{
    const struct schema_prop *p = &schema_props[id];
    buffer_printf(out, ".It Ic %s Ns No \\&: ", p->native);
    describe_value(out, id, false);
    if (p->required || p->models != IN_BOTH)
        buffer_puts(out, ", ");
    describe_conditions(out, id);
    buffer_puts(out, "\n");
    add_sentence(out, p->doc);
    if (p->has_default) {
        bool one = describe_has_one_default(id);
        buffer_puts(out, one ? "The default is\n.Ql " : "The default is ");
        describe_default(out, id);
        buffer_puts(out, one ? " .\n" : ".\n");
    }
    if (*p->xml && strcmp(p->native, p->xml) != 0) {
        buffer_puts(out, "In XML:\n.Ql ");
        describe_leaves(out, id);
        buffer_puts(out, " .\n");
    }
}

/* The properties that are the kind's own, or those of every kind in its group. */
static void add_properties(struct buffer *out, enum schema_kind kind, bool common)
{
    enum schema_group group = schema_kinds[kind].group;
    bool any = false;
    for (int p = 0; p < SCHEMA_PROPS; p++) {
        enum schema_prop_id id = (enum schema_prop_id)p;
        if (!schema_has(kind, id) || describe_is_common(group, id) != common)
            continue;
        buffer_puts(out, any ? "" : ".Bl -tag -width Ds\n");
        any = true;
        add_property(out, id);
    }
    buffer_puts(out, any ? ".El\n" : "");
}

static void add_kind(struct buffer *out, enum schema_kind kind)
{
    const struct schema_kind_row *k = &schema_kinds[kind];
    buffer_printf(out, ".Ic %s\n\\(em ", k->native);
    add_text(out, str_of(k->doc));
    buffer_puts(out, k->models == IN_MODERN ? "; model modern only.\n" : ".\n");
    if (k->group != SCHEMA_PLACE) {
        buffer_puts(out, "In XML:\n.Ql ");
        describe_element(out, kind);
        buffer_puts(out, " .\n");
    }
    add_properties(out, kind, false);
}

static void add_group(struct buffer *out, enum schema_group group)
{
    enum schema_kind last = SCHEMA_KINDS;
    buffer_printf(out, ".Ss %s\n", groups[group].title);
    for (int k = 0; k < SCHEMA_KINDS; k++) {
        if (schema_kinds[k].group != group)
            continue;
        buffer_puts(out, last == SCHEMA_KINDS ? "" : ".Pp\n");
        last = (enum schema_kind)k;
        add_kind(out, last);
    }
    if (groups[group].common) {
        buffer_printf(out, ".Pp\n%s\n", groups[group].common);
        add_properties(out, last, true);
    }
}

void describe_manual(struct buffer *out)
{
    for (int g = 0; g < SCHEMA_GROUPS; g++)
        add_group(out, (enum schema_group)g);
}
