/* Names of files that mean something else, or nothing, on another machine. */
#include "config.h"

#include "lint/checks.h"

#include "base/file.h"

#include <stdlib.h>
#include <string.h>

/* A file that some object names; it may be named by many. */
struct known {
    bool readable;
    char *twin; /* another file's name that differs only in case, or NULL */
};

struct paths {
    const struct lint *l;
    struct arena arena;
    struct map known; /* by path */
};

static const struct known *know(struct paths *p, const char *path)
{
    struct known *k = map_get(&p->known, str_of(path));
    const char *reason;
    if (k)
        return k;
    k = arena_zalloc(&p->arena, 1, sizeof *k);
    k->readable = file_readable(p->l->sources->fence, path, &reason);
    char *twin = k->readable ? file_other_case(path) : NULL;
    k->twin = twin ? arena_copy(&p->arena, twin, strlen(twin)) : NULL;
    free(twin);
    map_set(&p->known, str_of(arena_copy(&p->arena, path, strlen(path))), k);
    return k;
}

static bool is_absolute(struct str name)
{
    bool drive = name.n > 2 && name.at[1] == ':' && (name.at[2] == '/' || name.at[2] == '\\');
    return (name.n && *name.at == '/') || drive;
}

/* A file that is missing is an error, which says whether its name's spelling is why. */
static void check_name(struct paths *p, struct str name, struct span span, uint32_t spelt)
{
    const struct source *s = srcmap_source(p->l->sources, spelt);
    char *path = file_resolve(s ? s->name : "", name.at, name.n);
    const struct known *k = know(p, path);
    if (k->readable && is_absolute(name))
        diag_report(p->l->diag, DIAG_ABSOLUTE_PATH, span,
                    "an absolute path: the file is found on this machine only");
    if (k->readable && memchr(name.at, '\\', name.n))
        diag_report(p->l->diag, DIAG_BACKSLASH_PATH, span,
                    "'\\' is part of the name here, and the end of a folder's name elsewhere");
    if (k->twin)
        diag_report(p->l->diag, DIAG_TEXTURE_NOT_FOUND_CASE, span,
                    "there is '%s', too: where case does not count, only one of them", k->twin);
    free(path);
}

static void check_objects(struct paths *p, struct desc_object *const *objects, size_t n,
                          enum schema_prop_id id)
{
    for (size_t i = 0; i < n; i++) {
        const struct desc_value *v = lint_own(objects[i], id);
        p->l->diag->frame = objects[i]->frame;
        if (v)
            check_name(p, v->string, v->span, v->spelt);
    }
    p->l->diag->frame = NULL;
}

/* Files that are included from anywhere in the tree. */
static void check_includes(struct paths *p, const struct ast_node *first)
{
    for (const struct ast_node *n = first; n; n = n->next) {
        if (n->kind == AST_INCLUDE)
            check_name(p, n->children->text, n->children->span, n->children->span.begin);
        else if (n->kind != AST_PROPERTY)
            check_includes(p, n->children);
    }
}

void lint_paths(const struct lint *l)
{
    const struct desc *d = l->desc;
    struct paths p = {.l = l};
    check_objects(&p, d->textures.at, d->textures.n, PROP_FILE);
    check_objects(&p, d->surfaces.at, d->surfaces.n, PROP_MESH_FILE);
    check_objects(&p, d->surfaces.at, d->surfaces.n, PROP_UV_FILE);
    if (!l->ast->xml)
        check_includes(&p, l->ast->statements);
    for (size_t i = 0; i < d->included.n; i++)
        if (!d->included.at[i]->xml)
            check_includes(&p, d->included.at[i]->statements);
    map_free(&p.known);
    arena_free(&p.arena);
}
