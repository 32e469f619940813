/* Quick fixes: the fix-its of findings. */
#include "config.h"

#include "lsp/server.h"

#include "diag/fix.h"

static const char quick_fix[] = "quickfix", fix_all[] = "source.fixAll.wrt";

static const json_t *wanted_kinds(const json_t *params)
{
    return json_object_get(json_object_get(params, "context"), "only");
}

/* Whether the client asks for a kind by its name, or by one that begins it as `source` does. */
static bool is_asked_for(const json_t *params, const char *kind)
{
    const json_t *only = wanted_kinds(params);
    for (size_t i = 0; i < json_array_size(only); i++) {
        const char *name = json_string_value(json_array_get(only, i));
        size_t n = name ? strlen(name) : 0;
        if (name && strncmp(kind, name, n) == 0 && (kind[n] == 0 || kind[n] == '.'))
            return true;
    }
    return false;
}

/* ---- one finding ----------------------------------------------------------------------------- */

/* Some of the fix-its of a finding: one of several to choose from, or all together. */
struct proposal {
    const struct diag_entry *entry;
    const struct diag_fixit *fixits;
    size_t n;
};

/* On one line, and not too long. */
static json_t *wire_title(struct buffer *text)
{
    enum { MOST = 60 };
    struct str all = str_trim((struct str){text->at, text->n});
    struct buffer title = {0};
    size_t n = all.n < MOST ? all.n : MOST;
    while (n && n < all.n && (all.at[n] & 0xC0) == 0x80)
        n--;
    buffer_add(&title, all.at, n);
    buffer_puts(&title, n < all.n ? "..." : "");
    for (size_t i = 0; i < title.n; i++)
        if (title.at[i] == '\n')
            title.at[i] = ' ';
    buffer_free(text);
    return wire_buffer(&title);
}

static json_t *title_of(const struct analysis *a, const struct proposal *p)
{
    struct buffer text = {0};
    const struct diag_fixit *f = p->fixits;
    struct str old = srcmap_text(&a->sources, f->span), new = str_trim(str_of(f->text));
    if (p->n > 1)
        buffer_printf(&text, "change as proposed: %s", p->entry->message);
    else if (f->span.begin == f->span.end)
        buffer_printf(&text, "insert '%.*s'", STR_ARG(new));
    else if (!*f->text)
        buffer_printf(&text, "remove '%.*s'", STR_ARG(old));
    else
        buffer_printf(&text, "replace '%.*s' by '%.*s'", STR_ARG(old), STR_ARG(new));
    return wire_title(&text);
}

/* The changes in this text, all or none; NULL: none. */
static json_t *edits_of(const struct server *s, const struct wire_place *place,
                        const struct proposal *p, bool *safe)
{
    json_t *edits = json_array();
    *safe = true;
    for (size_t i = 0; i < p->n; i++) {
        const struct diag_fixit *f = &p->fixits[i];
        if (!analysis_owns(place->analysis, f->span)) {
            json_decref(edits);
            return NULL;
        }
        *safe &= f->kind == DIAG_FIX_SAFE;
        json_array_append_new(edits, json_pack("{s:o, s:o}", "range",
                                               wire_span(s, place->doc, place->analysis, f->span),
                                               "newText", wire_text(str_of(f->text))));
    }
    return edits;
}

static void add_proposal(const struct server *s, const struct wire_place *place,
                         const struct proposal *p, json_t *actions)
{
    bool safe;
    json_t *edits = edits_of(s, place, p, &safe);
    if (!edits)
        return;
    json_array_append_new(
        actions, json_pack("{s:o, s:s, s:b, s:[o], s:o}", "title", title_of(place->analysis, p),
                           "kind", quick_fix, "isPreferred", (int)safe, "diagnostics",
                           publish_entry(s, place->doc, place->analysis, p->entry), "edit",
                           wire_workspace_edit(place->doc, edits)));
}

/* Changes of one place are to choose from: 30 may become 30deg or 30rad. */
static bool are_alternatives(const struct diag_entry *e)
{
    for (size_t i = 1; i < e->fixits.n; i++)
        if (e->fixits.at[i].span.begin == e->fixits.at[0].span.begin)
            return true;
    return false;
}

static void add_fixes(const struct server *s, const struct wire_place *place,
                      const struct diag_entry *e, json_t *actions)
{
    size_t together = are_alternatives(e) ? 1 : e->fixits.n;
    for (size_t i = 0; i < e->fixits.n; i += together) {
        struct proposal p = {e, &e->fixits.at[i], together};
        add_proposal(s, place, &p, actions);
    }
}

/* ---- all ------------------------------------------------------------------------------------- */

/* What is safe everywhere in the text, where there is any: only for who asks for it. */
static void add_fix_all(const struct server *s, const struct wire_place *place, json_t *actions)
{
    struct buffer text = {0};
    struct document *doc = place->doc;
    if (diag_fix_text(&doc->analysis->diag, place->analysis->source, false, &text) == 0) {
        buffer_free(&text);
        return;
    }
    json_t *edits =
        json_pack("[{s:o, s:o}]", "range", wire_range(s, &doc->lines, 0, (uint32_t)doc->text.n),
                  "newText", wire_buffer(&text));
    json_array_append_new(actions,
                          json_pack("{s:s, s:s, s:o}", "title", "do all that is safe", "kind",
                                    fix_all, "edit", wire_workspace_edit(doc, edits)));
}

json_t *lsp_code_action(struct server *s, const json_t *params)
{
    struct wire_place place;
    uint32_t begin, end;
    if (!wire_whole(s, params, &place))
        return NULL;
    if (!wire_read_range(s, &place.doc->lines, json_object_get(params, "range"), &begin, &end))
        return server_fail(s, RPC_INVALID_PARAMS, "no range");
    const struct analysis *a = place.analysis;
    struct span asked = {analysis_offset(a, begin), analysis_offset(a, end)}, at;
    json_t *actions = json_array();
    bool fixes = !wanted_kinds(params) || is_asked_for(params, quick_fix);
    for (size_t i = 0; i < a->diag.entries.n && fixes; i++) {
        const struct diag_entry *e = a->diag.entries.at[i];
        if (publish_place(s, a, e, &at) && at.begin <= asked.end && at.end >= asked.begin)
            add_fixes(s, &place, e, actions);
    }
    if (is_asked_for(params, fix_all))
        add_fix_all(s, &place, actions);
    return actions;
}
