/* Diagnostics as JSON, one object a line. */
#include "config.h"

#include "diag/print.h"

#include <jansson.h>

static json_t *text_of(const char *s)
{
    json_t *j = json_string(s);
    return j ? j : json_string("(not UTF-8)");
}

static json_t *place_of(const struct diag *d, struct span span)
{
    struct location begin = srcmap_locate(d->sources, span.begin);
    struct location end = srcmap_locate(d->sources, span.end);
    if (!begin.source || !end.source)
        return json_null();
    return json_pack("{s:o, s:i, s:i, s:i, s:i, s:I, s:I}", "file", text_of(begin.source->name),
                     "line", begin.line, "column", begin.column, "end_line", end.line, "end_column",
                     end.column, "byte", (json_int_t)(span.begin - begin.source->base), "end_byte",
                     (json_int_t)(span.end - begin.source->base));
}

static json_t *labels_of(const struct diag *d, const struct diag_label *labels, size_t n)
{
    json_t *list = json_array();
    for (size_t i = 0; i < n; i++)
        json_array_append_new(list, json_pack("{s:o, s:o}", "place", place_of(d, labels[i].span),
                                              "message", text_of(labels[i].text)));
    return list;
}

static json_t *fixits_of(const struct diag *d, const struct diag_entry *e)
{
    json_t *list = json_array();
    for (size_t i = 0; i < e->fixits.n; i++) {
        const struct diag_fixit *f = &e->fixits.at[i];
        json_array_append_new(list, json_pack("{s:o, s:o, s:s}", "place", place_of(d, f->span),
                                              "replacement", text_of(f->text), "applicability",
                                              f->kind == DIAG_FIX_SAFE ? "safe" : "maybe"));
    }
    return list;
}

void diag_print_json(const struct diag *d, const struct diag_entry *e, FILE *out)
{
    const struct diag_rule *rule = &diag_rules[e->code];
    json_t *notes = json_array();
    for (size_t i = 0; i < e->notes.n; i++)
        json_array_append_new(notes, text_of(e->notes.at[i]));
    json_t *object = json_pack(
        "{s:s, s:s, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:I}", "level", diag_level_name(e->level),
        "code", rule->code, "slug", rule->slug, "message", text_of(e->message), "place",
        place_of(d, e->span), "labels", labels_of(d, e->labels.at, e->labels.n), "notes", notes,
        "fixits", fixits_of(d, e), "frames", labels_of(d, e->frames.at, e->frames.n), "repeats",
        (json_int_t)e->repeats);
    if (!object || json_dumpf(object, out, JSON_COMPACT) != 0)
        fputs("{}", out);
    putc('\n', out);
    json_decref(object);
}
