/* Where a name is defined, and where it is used. */
#include "config.h"

#include "lsp/locate.h"
#include "lsp/server.h"

#include "base/file.h"
#include "lsp/uri.h"

#include <stdlib.h>

/* The file that an include names, as it was found; NULL: there is none. */
static const struct source *included_file(const struct analysis *a, struct str name)
{
    char *path = file_resolve(a->source->name, name.at, name.n);
    const struct source *found = NULL;
    for (size_t i = 1; i < a->sources.sources.n; i++) {
        const struct source *s = a->sources.sources.at[i];
        size_t n = strlen(s->name);
        bool ends = n >= name.n && memcmp(s->name + n - name.n, name.at, name.n) == 0;
        if (strcmp(s->name, path) == 0 || (!found && ends)) /* in a folder of -I */
            found = s;
    }
    free(path);
    return found;
}

static json_t *include_at(const struct server *s, const struct wire_place *place)
{
    struct locate_path path;
    const struct source *file = NULL;
    locate(&path, &place->analysis->ast, place->at);
    if (path.nodes.n && path.nodes.at[0]->kind == AST_INCLUDE)
        file = included_file(place->analysis, path.nodes.at[0]->children->text);
    vec_free(&path.nodes);
    return file ? wire_location(s, place->doc, place->analysis,
                                (struct span){file->base, file->base})
                : json_null();
}

json_t *lsp_definition(struct server *s, const json_t *params)
{
    struct wire_place place;
    struct span span;
    if (!wire_place(s, params, &place))
        return NULL;
    const struct bindings *b = &place.analysis->bindings;
    size_t def = bindings_at(b, place.at, &span);
    if (def == BINDING_NONE)
        return include_at(s, &place);
    return wire_location(s, place.doc, place.analysis, b->defs.at[def].span);
}

json_t *lsp_references(struct server *s, const json_t *params)
{
    struct wire_place place;
    struct span span;
    if (!wire_place(s, params, &place))
        return NULL;
    const struct bindings *b = &place.analysis->bindings;
    size_t def = bindings_at(b, place.at, &span);
    json_t *list = json_array();
    const json_t *context = json_object_get(params, "context");
    if (def != BINDING_NONE && json_is_true(json_object_get(context, "includeDeclaration")))
        json_array_append_new(list,
                              wire_location(s, place.doc, place.analysis, b->defs.at[def].span));
    for (size_t i = 0; i < b->uses.n && def != BINDING_NONE; i++)
        if (b->uses.at[i].def == def)
            json_array_append_new(list,
                                  wire_location(s, place.doc, place.analysis, b->uses.at[i].span));
    return list;
}
