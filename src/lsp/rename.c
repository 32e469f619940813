/* A new name for a definition and all its uses in the text. */
#include "config.h"

#include "lsp/server.h"

#include "syntax/syntax.h"

/* The definition under the cursor that may be renamed; BINDING_NONE after server_fail. */
static size_t renamed(struct server *s, const struct wire_place *place, struct span *span)
{
    const struct bindings *b = &place->analysis->bindings;
    size_t def = bindings_at(b, place->at, span);
    if (def == BINDING_NONE)
        server_fail(s, RPC_FAILED, "there is no name here that the scene defines");
    else if (b->defs.at[def].foreign) {
        server_fail(s, RPC_FAILED, "'%.*s' is defined in another file: rename it there",
                    STR_ARG(b->defs.at[def].name));
        def = BINDING_NONE;
    }
    return def;
}

json_t *lsp_prepare_rename(struct server *s, const json_t *params)
{
    struct wire_place place;
    struct span span;
    if (!wire_place(s, params, &place) || renamed(s, &place, &span) == BINDING_NONE)
        return NULL;
    return json_pack("{s:o, s:o}", "range", wire_span(s, place.doc, place.analysis, span),
                     "placeholder", wire_text(srcmap_text(&place.analysis->sources, span)));
}

/* ---- new names ------------------------------------------------------------------------------- */

static bool is_word(struct str name)
{
    bool word = name.n > 0 && !(name.at[0] >= '0' && name.at[0] <= '9');
    for (size_t i = 0; i < name.n; i++) {
        char c = name.at[i];
        word &=
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    }
    return word;
}

/* Whether the name means something else wherever this one is seen: both would be mixed up. */
static bool is_taken(const struct bindings *b, size_t def, struct str name)
{
    const struct name_def *d = &b->defs.at[def];
    for (size_t i = 0; i < b->defs.n; i++) {
        const struct name_def *other = &b->defs.at[i];
        bool apart = other->seen.end <= d->seen.begin || d->seen.end <= other->seen.begin;
        if (i != def && !apart && str_equal(other->name, name))
            return true;
    }
    return false;
}

/* False after server_fail.  An XML id is any text that needs no escape. */
static bool check_name(struct server *s, const struct analysis *a, size_t def, struct str name)
{
    bool fits = a->ast.xml ? name.n && str_trim(name).n == name.n && !strpbrk(name.at, "<>&\"'")
                           : is_word(name);
    if (!fits)
        server_fail(s, RPC_INVALID_PARAMS, "'%.100s' is no name", name.at);
    else if (!a->ast.xml && syntax_is_keyword(name))
        server_fail(s, RPC_INVALID_PARAMS, "'%.*s' is a word of the language", STR_ARG(name));
    else if (is_taken(&a->bindings, def, name))
        server_fail(s, RPC_FAILED, "'%.100s' is defined already", name.at);
    else
        return true;
    return false;
}

/* ---- edits ----------------------------------------------------------------------------------- */

static void add_edit(const struct server *s, const struct wire_place *place, struct span span,
                     struct str name, json_t *edits)
{
    json_array_append_new(edits, json_pack("{s:o, s:o}", "range",
                                           wire_span(s, place->doc, place->analysis, span),
                                           "newText", wire_text(name)));
}

json_t *lsp_rename(struct server *s, const json_t *params)
{
    struct wire_place place;
    struct span span;
    const json_t *json = json_object_get(params, "newName");
    if (!wire_place(s, params, &place))
        return NULL;
    if (!json_is_string(json))
        return server_fail(s, RPC_INVALID_PARAMS, "no new name");
    struct str name = {json_string_value(json), json_string_length(json)};
    const struct bindings *b = &place.analysis->bindings;
    size_t def = renamed(s, &place, &span);
    if (def == BINDING_NONE || !check_name(s, place.analysis, def, name))
        return NULL;
    json_t *edits = json_array();
    add_edit(s, &place, b->defs.at[def].span, name, edits);
    for (size_t i = 0; i < b->uses.n; i++)
        if (b->uses.at[i].def == def)
            add_edit(s, &place, b->uses.at[i].span, name, edits);
    return wire_workspace_edit(place.doc, edits);
}
