/* The canonical layout, as `wrt fmt` prints it. */
#include "config.h"

#include "lsp/server.h"

#include "print/printer.h"

/* Bytes at the start of both texts that are alike, up to a line's beginning. */
static size_t alike_before(struct str a, struct str b)
{
    size_t n = 0, line = 0;
    while (n < a.n && n < b.n && a.at[n] == b.at[n])
        if (a.at[n++] == '\n')
            line = n;
    return line;
}

/* Likewise at the end, behind what is alike at the start. */
static size_t alike_behind(struct str a, struct str b, size_t before)
{
    size_t n = 0, line = 0;
    while (n < a.n - before && n < b.n - before && a.at[a.n - 1 - n] == b.at[b.n - 1 - n]) {
        if (a.at[a.n - 1 - n] == '\n')
            line = n;
        n++;
    }
    return line;
}

/* One change, of the lines that differ; none where nothing does. */
static json_t *edits_between(const struct server *s, const struct document *doc, struct str new)
{
    struct str old = {doc->text.at, doc->text.n};
    size_t before = alike_before(old, new);
    size_t behind = alike_behind(old, new, before);
    if (str_equal(old, new))
        return json_array();
    struct str middle = {new.at + before, new.n - before - behind};
    return json_pack("[{s:o, s:o}]", "range",
                     wire_range(s, &doc->lines, (uint32_t)before, (uint32_t)(old.n - behind)),
                     "newText", wire_text(middle));
}

/* Names and values may be wrong; a text that does not parse stays as it is. */
json_t *lsp_formatting(struct server *s, const json_t *params)
{
    struct wire_place place;
    struct buffer text = {0};
    if (!wire_whole(s, params, &place))
        return NULL;
    if (!place.analysis->parsed)
        return server_fail(s, RPC_FAILED, "the text has syntax errors, so it is left as it is");
    print_scene(&place.analysis->ast, &text);
    json_t *edits = edits_between(s, place.doc, (struct str){text.at, text.n});
    buffer_free(&text);
    return edits;
}
