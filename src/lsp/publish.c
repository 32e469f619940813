/* Findings as the protocol's diagnostics. */
#include "config.h"

#include "lsp/server.h"

#include "diag/print.h"

/* ---- where ----------------------------------------------------------------------------------- */

/* The outermost frame in the text: by which include, call or use the finding came. */
static struct span way_to(const struct analysis *a, const struct diag_entry *e)
{
    for (size_t i = e->frames.n; i > 0; i--)
        if (analysis_owns(a, e->frames.at[i - 1].span))
            return e->frames.at[i - 1].span;
    return (struct span){a->source->base, a->source->base};
}

bool publish_place(const struct server *s, const struct analysis *a, const struct diag_entry *e,
                   struct span *place)
{
    *place = e->span;
    if (!diag_is_shown(e, DIAG_WARNING))
        return false;
    if (span_known(e->span) && analysis_owns(a, e->span))
        return true;
    const struct source *other = srcmap_source(&a->sources, e->span.begin);
    *place = way_to(a, e);
    return !other || !documents_find_file(&s->documents, other->name);
}

/* ---- what ------------------------------------------------------------------------------------ */

static json_t *message_of(const struct analysis *a, const struct diag_entry *e, bool elsewhere)
{
    struct buffer text = {0};
    struct location at = srcmap_locate(&a->sources, e->span.begin);
    if (elsewhere && at.source)
        buffer_printf(&text, "in %s:%u: ", at.source->name, at.line);
    buffer_puts(&text, e->message);
    for (size_t i = 0; i < e->notes.n; i++)
        buffer_printf(&text, "\n%s", e->notes.at[i]);
    if (e->repeats)
        buffer_printf(&text, "\nthe same was found %zu more time%s", e->repeats,
                      e->repeats == 1 ? "" : "s");
    return wire_buffer(&text);
}

static void add_related(const struct server *s, const struct document *doc,
                        const struct analysis *a, struct span span, const char *text, json_t *list)
{
    json_t *location = span_known(span) ? wire_location(s, doc, a, span) : NULL;
    if (location)
        json_array_append_new(list, json_pack("{s:o, s:o}", "location", location, "message",
                                              wire_text(str_of(text))));
}

static json_t *related_of(const struct server *s, const struct document *doc,
                          const struct analysis *a, const struct diag_entry *e, bool elsewhere)
{
    json_t *list = json_array();
    if (elsewhere)
        add_related(s, doc, a, e->span, e->message, list);
    for (size_t i = 0; i < e->labels.n; i++)
        add_related(s, doc, a, e->labels.at[i].span, e->labels.at[i].text, list);
    for (size_t i = 0; i < e->frames.n; i++)
        add_related(s, doc, a, e->frames.at[i].span, e->frames.at[i].text, list);
    return list;
}

json_t *publish_entry(const struct server *s, const struct document *doc, const struct analysis *a,
                      const struct diag_entry *e)
{
    static const int severities[] = {[DIAG_ERROR] = 1, [DIAG_WARNING] = 2, [DIAG_NOTE] = 3};
    const struct diag_rule *rule = &diag_rules[e->code];
    struct span place;
    struct buffer code = {0};
    publish_place(s, a, e, &place);
    bool elsewhere = place.begin != e->span.begin && span_known(e->span);
    buffer_printf(&code, "%s-%s", rule->code, rule->slug);
    json_t *j = json_pack("{s:o, s:i, s:o, s:s, s:o}", "range", wire_span(s, doc, a, place),
                          "severity", severities[e->level], "code", wire_buffer(&code), "source",
                          "wrt", "message", message_of(a, e, elsewhere));
    json_t *related = related_of(s, doc, a, e, elsewhere);
    if (s->related && json_array_size(related))
        json_object_set(j, "relatedInformation", related);
    json_decref(related);
    return j;
}

/* ---- telling --------------------------------------------------------------------------------- */

static json_t *findings_of(const struct server *s, struct document *doc)
{
    const struct analysis *a = analysis_of(doc, s->options);
    json_t *list = json_array();
    struct span place;
    for (size_t i = 0; a && i < a->diag.entries.n; i++)
        if (publish_place(s, a, a->diag.entries.at[i], &place))
            json_array_append_new(list, publish_entry(s, doc, a, a->diag.entries.at[i]));
    return list;
}

void publish(struct server *s, struct document *doc)
{
    json_t *params = json_pack("{s:s, s:o}", "uri", doc->uri, "diagnostics", findings_of(s, doc));
    if (doc->has_version)
        json_object_set_new(params, "version", json_integer(doc->version));
    doc->due = false;
    server_notify(s, "textDocument/publishDiagnostics", params);
}

void publish_nothing(struct server *s, const struct document *doc)
{
    server_notify(s, "textDocument/publishDiagnostics",
                  json_pack("{s:s, s:[]}", "uri", doc->uri, "diagnostics"));
}
