/* Names that the schema does not have. */
#include "config.h"

#include "eval/context.h"

#include <stdio.h>

/* "sphere has: center radius ..." */
static void note_props(struct diag_entry *entry, const struct desc_object *o)
{
    char list[512] = "";
    size_t at = 0;
    struct str leaf;
    for (int p = 0; p < SCHEMA_PROPS && at < sizeof list; p++) {
        enum schema_prop_id id = (enum schema_prop_id)p;
        if (!(schema_props[id].models >> o->model & 1))
            continue;
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

void report_unknown_property(struct eval *e, const struct desc_object *o, struct str name,
                             struct span name_span)
{
    const char *kind = schema_kind_name(o->kind, o->xml);
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_PROPERTY, name_span, "unknown %s '%.*s' of %s",
                    o->xml ? "element" : "property", STR_ARG(name), kind);
    struct str meant = schema_nearest_prop(o->kind, (enum schema_model)o->model, name, o->xml);
    diag_did_you_mean(entry, name_span, meant);
    note_props(entry, o);
}

/* Why the scene has the model it has. */
static void add_model(struct eval *e, struct diag_entry *entry)
{
    const char *model = schema_model_name(e->out->model);
    if (e->model)
        diag_label(entry, e->out->model_span, "the scene's model");
    else
        diag_note(entry,
                  e->out->xml ? "a document without model=\"modern\" is classic"
                              : "a scene that names no model is %s",
                  model);
}

void report_property_of_other_model(struct eval *e, const struct desc_object *o, struct str name,
                                    struct span name_span)
{
    struct diag_entry *entry = diag_report(
        e->diag, DIAG_OTHER_MODEL, name_span, "'%.*s' of %s exists only in 'model %s'",
        STR_ARG(name), schema_kind_name(o->kind, o->xml), schema_model_name(!e->out->model));
    add_model(e, entry);
    note_props(entry, o);
}

bool kind_exists(struct eval *e, enum schema_kind kind, struct span span, bool xml)
{
    if ((schema_kinds[kind].models >> e->out->model & 1) || e->model_unknown)
        return true;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_OTHER_MODEL, span, "'%s' exists only in 'model %s'",
                    schema_kind_name(kind, xml), schema_model_name(!e->out->model));
    add_model(e, entry);
    return false;
}

void report_unknown_kind(struct eval *e, enum schema_group group, struct str name, struct span span,
                         bool xml)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_KIND, span, "unknown %s %s '%.*s'",
                    schema_group_name(group), xml ? "class" : "kind", STR_ARG(name));
    diag_did_you_mean(entry, span, schema_nearest_kind(group, e->out->model, name, xml));
    char list[256];
    size_t at = 0;
    for (int k = 0; k < SCHEMA_KINDS && at < sizeof list; k++) {
        if (schema_kinds[k].group != group || !(schema_kinds[k].models >> e->out->model & 1))
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
