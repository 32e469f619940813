/* Texts as the client opens, changes and closes them.  What is wrong with a change is passed over,
 * as notifications have no answer: the next one of the whole text mends it. */
#include "config.h"

#include "lsp/server.h"

static bool read_text(const json_t *json, struct str *out)
{
    *out = (struct str){json_string_value(json), json_string_length(json)};
    return json_is_string(json);
}

static void set_version(struct document *doc, const json_t *identifier)
{
    const json_t *version = json_object_get(identifier, "version");
    doc->has_version = json_is_integer(version);
    doc->version = json_integer_value(version);
}

void lsp_did_open(struct server *s, const json_t *params)
{
    const json_t *item = json_object_get(params, "textDocument");
    const char *uri = json_string_value(json_object_get(item, "uri"));
    struct str text;
    if (!uri || !read_text(json_object_get(item, "text"), &text))
        return;
    set_version(documents_open(&s->documents, uri, text), item);
}

/* A part of the text, or without a range all of it. */
static void change(const struct server *s, struct document *doc, const json_t *json)
{
    const json_t *range = json_object_get(json, "range");
    uint32_t begin = 0, end = (uint32_t)doc->text.n;
    struct str text;
    if (read_text(json_object_get(json, "text"), &text) &&
        (!range || wire_read_range(s, &doc->lines, range, &begin, &end)))
        document_edit(doc, begin, end, text);
}

void lsp_did_change(struct server *s, const json_t *params)
{
    struct document *doc = wire_document(s, params);
    const json_t *changes = json_object_get(params, "contentChanges");
    if (!doc)
        return;
    for (size_t i = 0; i < json_array_size(changes); i++)
        change(s, doc, json_array_get(changes, i));
    set_version(doc, json_object_get(params, "textDocument"));
    doc->due = true;
}

/* Files on the disk are new, which other texts may include. */
void lsp_did_save(struct server *s, const json_t *params)
{
    (void)params;
    for (size_t i = 0; i < s->documents.list.n; i++)
        document_changed(s->documents.list.at[i]);
}

void lsp_did_close(struct server *s, const json_t *params)
{
    struct document *doc = wire_document(s, params);
    if (!doc)
        return;
    publish_nothing(s, doc);
    documents_close(&s->documents, doc);
}
