#include "config.h"

#include "lsp/server.h"

#include "lsp/uri.h"

json_t *wire_text(struct str text)
{
    json_t *j = json_stringn(text.at, text.n);
    return j ? j : json_string("(not UTF-8)");
}

json_t *wire_buffer(struct buffer *text)
{
    json_t *j = wire_text((struct str){text->at ? text->at : "", text->n});
    buffer_free(text);
    return j;
}

static json_t *wire_position(struct position p)
{
    return json_pack("{s:I, s:I}", "line", (json_int_t)p.line, "character",
                     (json_int_t)p.character);
}

json_t *wire_range(const struct server *s, const struct line_index *lines, uint32_t begin,
                   uint32_t end)
{
    return json_pack("{s:o, s:o}", "start", wire_position(position_of(lines, begin, s->encoding)),
                     "end", wire_position(position_of(lines, end, s->encoding)));
}

json_t *wire_span(const struct server *s, const struct document *doc, const struct analysis *a,
                  struct span span)
{
    return wire_range(s, &doc->lines, span.begin - a->source->base, span.end - a->source->base);
}

json_t *wire_location(const struct server *s, const struct document *doc, const struct analysis *a,
                      struct span span)
{
    if (analysis_owns(a, span))
        return json_pack("{s:s, s:o}", "uri", doc->uri, "range", wire_span(s, doc, a, span));
    const struct source *source = srcmap_source(&a->sources, span.begin);
    struct buffer uri = {0};
    struct line_index lines = {0};
    if (!source)
        return NULL;
    uri_add(&uri, source->name);
    line_index_build(&lines, (struct str){source->text, source->n});
    json_t *range = wire_range(s, &lines, span.begin - source->base, span.end - source->base);
    line_index_free(&lines);
    return json_pack("{s:o, s:o}", "uri", wire_buffer(&uri), "range", range);
}

json_t *wire_workspace_edit(const struct document *doc, json_t *edits)
{
    return json_pack("{s:{s:o}}", "changes", doc->uri, edits);
}

/* ---- reading --------------------------------------------------------------------------------- */

struct document *wire_document(struct server *s, const json_t *params)
{
    const char *uri =
        json_string_value(json_object_get(json_object_get(params, "textDocument"), "uri"));
    struct document *doc = uri ? documents_find(&s->documents, uri) : NULL;
    if (!uri)
        server_fail(s, RPC_INVALID_PARAMS, "no document is named");
    else if (!doc)
        server_fail(s, RPC_INVALID_PARAMS, "the document is not open: %s", uri);
    return doc;
}

/* A number of lines or units; what is too large for any text stands for its end. */
static bool read_count(const json_t *json, uint32_t *out)
{
    json_int_t n = json_integer_value(json);
    *out = n > INT32_MAX ? INT32_MAX : (uint32_t)n;
    return json_is_integer(json) && n >= 0;
}

bool wire_read_position(const struct server *s, const struct line_index *lines, const json_t *json,
                        uint32_t *offset)
{
    struct position p;
    if (!read_count(json_object_get(json, "line"), &p.line) ||
        !read_count(json_object_get(json, "character"), &p.character))
        return false;
    *offset = position_offset(lines, p, s->encoding);
    return true;
}

bool wire_read_range(const struct server *s, const struct line_index *lines, const json_t *json,
                     uint32_t *begin, uint32_t *end)
{
    return wire_read_position(s, lines, json_object_get(json, "start"), begin) &&
           wire_read_position(s, lines, json_object_get(json, "end"), end) && *begin <= *end;
}

bool wire_whole(struct server *s, const json_t *params, struct wire_place *out)
{
    *out = (struct wire_place){.doc = wire_document(s, params)};
    if (!out->doc)
        return false;
    out->analysis = analysis_of(out->doc, s->options);
    if (!out->analysis) {
        server_fail(s, RPC_FAILED, "the text is too large");
        return false;
    }
    out->at = out->analysis->source->base;
    return true;
}

bool wire_place(struct server *s, const json_t *params, struct wire_place *out)
{
    if (!wire_whole(s, params, out))
        return false;
    const json_t *position = json_object_get(params, "position");
    if (!wire_read_position(s, &out->doc->lines, position, &out->in_text)) {
        server_fail(s, RPC_INVALID_PARAMS, "no position");
        return false;
    }
    out->at = analysis_offset(out->analysis, out->in_text);
    return true;
}
