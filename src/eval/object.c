/* Objects of the description under construction. */
#include "config.h"

#include "eval/context.h"

#include <stdio.h>

struct desc_object *object_new(struct eval *e, enum schema_kind kind, const struct ast_node *node)
{
    struct desc_object *o = arena_zalloc(&e->out->arena, 1, sizeof *o);
    o->kind = kind;
    o->xml = node->xml;
    o->span = node->name_span;
    o->name = node->label;
    return o;
}

static struct desc_prop *find(struct desc_object *o, enum schema_prop_id id,
                              struct desc_prop ***end)
{
    struct desc_prop **at = &o->props;
    for (; *at; at = &(*at)->next)
        if ((*at)->id == id)
            return *at;
    *end = at;
    return NULL;
}

struct desc_prop *object_prop(struct eval *e, struct desc_object *o, enum schema_prop_id id,
                              unsigned leaf, struct span name_span)
{
    struct desc_prop **end = NULL, *p = find(o, id, &end);
    if (!p) {
        *end = p = arena_zalloc(&e->out->arena, 1, sizeof *p);
        p->id = (uint8_t)id;
        p->name_span = name_span;
    } else if (p->leaves >> leaf & 1) {
        struct str name = o->xml ? schema_leaf(id, leaf) : schema_prop_name(id, false);
        struct diag_entry *entry = diag_report(e->diag, DIAG_DUPLICATE_PROPERTY, name_span,
                                               "'%.*s' is given twice", STR_ARG(name));
        diag_label(entry, p->name_span, "first given here");
        o->broken = true;
        return NULL;
    }
    p->leaves |= (uint8_t)(1u << leaf);
    return p;
}

/* "a sphere has: center radius ..." */
static void note_props(struct diag_entry *entry, const struct desc_object *o)
{
    char list[512];
    size_t at = 0;
    struct str leaf;
    for (int p = 0; p < SCHEMA_PROPS && at < sizeof list; p++) {
        enum schema_prop_id id = (enum schema_prop_id)p;
        for (unsigned n = 0; schema_has(o->kind, id) && at < sizeof list &&
                             (leaf = o->xml ? schema_leaf(id, n) : schema_prop_name(id, false)).n;
             n++) {
            int put = snprintf(list + at, sizeof list - at, " %.*s", STR_ARG(leaf));
            at += put > 0 ? (size_t)put : 0;
            if (!o->xml)
                break;
        }
    }
    const char *kind = schema_kind_name(o->kind, o->xml);
    diag_note(entry, "%s has:%s", kind, list);
}

enum schema_prop_id object_find_prop(struct eval *e, const struct desc_object *o, struct str name,
                                     struct span name_span, unsigned *leaf)
{
    enum schema_prop_id id = schema_find_prop(o->kind, name, o->xml, leaf);
    if (id != SCHEMA_PROPS)
        return id;
    const char *kind = schema_kind_name(o->kind, o->xml);
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_PROPERTY, name_span, "unknown %s '%.*s' of %s",
                    o->xml ? "element" : "property", STR_ARG(name), kind);
    diag_did_you_mean(entry, name_span, schema_nearest_prop(o->kind, name, o->xml));
    note_props(entry, o);
    return SCHEMA_PROPS;
}

void object_place(struct eval *e, struct desc_object *o)
{
    struct desc *d = e->out;
    if (!o)
        return;
    size_t have = d->lights.n + d->surfaces.n;
    if (have == e->options->max_objects)
        diag_report(e->diag, DIAG_TOO_MANY_OBJECTS, o->span,
                    "more than the %zu objects that --max-objects allows", have);
    if (schema_kinds[o->kind].group == SCHEMA_LIGHT)
        vec_push(&d->lights, o);
    else
        vec_push(&d->surfaces, o);
}

void object_register(struct eval *e, struct desc_object *o)
{
    if (schema_kinds[o->kind].group == SCHEMA_TEXTURE) {
        o->number = (uint32_t)e->out->textures.n;
        vec_push(&e->out->textures, o);
    } else if (schema_kinds[o->kind].group == SCHEMA_MATERIAL) {
        o->number = (uint32_t)e->out->materials.n;
        vec_push(&e->out->materials, o);
    }
}

void try_defined_names(struct eval *e, struct str_nearest *nearest)
{
    enum {
        MOST = 1000 * 1000
    }; /* keeps thousands of unknown names among as many from taking minutes */
    e->names_tried += e->names.capacity;
    for (size_t i = 0; i < e->names.capacity && e->names_tried <= MOST; i++)
        if (e->names.slots[i].value)
            str_nearest_try(nearest, e->names.slots[i].key);
}

void report_unknown_kind(struct eval *e, enum schema_group group, struct str name, struct span span,
                         bool xml)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_KIND, span, "unknown %s %s '%.*s'",
                    schema_group_name(group), xml ? "class" : "kind", STR_ARG(name));
    diag_did_you_mean(entry, span, schema_nearest_kind(group, name, xml));
    char list[256];
    size_t at = 0;
    for (int k = 0; k < SCHEMA_KINDS && at < sizeof list; k++) {
        if (schema_kinds[k].group != group)
            continue;
        int put = snprintf(list + at, sizeof list - at, "%s%s", at ? ", " : " ",
                           schema_kind_name((enum schema_kind)k, xml));
        at += put > 0 ? (size_t)put : 0;
    }
    diag_note(entry, "there are:%s", list);
}

void report_unknown_word(struct eval *e, enum schema_prop_id id, struct str word, struct span span,
                         bool xml)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_WORD, span, "'%.*s' is not one of the words of '%.*s'",
                    STR_ARG(word), STR_ARG(schema_prop_name(id, xml)));
    struct str_nearest nearest = str_nearest_to(word);
    char list[256];
    size_t at = 0;
    struct str known;
    for (unsigned n = 0; at < sizeof list && (known = schema_word(id, n, xml)).n; n++) {
        str_nearest_try(&nearest, known);
        int put = snprintf(list + at, sizeof list - at, " %.*s", STR_ARG(known));
        at += put > 0 ? (size_t)put : 0;
    }
    diag_did_you_mean(entry, span, str_nearest_found(&nearest));
    diag_note(entry, "there are:%s", list);
}
