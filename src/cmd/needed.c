#include "config.h"

#include "cmd/needed.h"

#include "base/fence.h"
#include "base/file.h"

#include <stdlib.h>
#include <string.h>

/* What is done with each value that names a file. */
struct visit {
    const struct frontend *frontend;
    void (*file)(struct visit *v, enum schema_prop_id id, const struct desc_value *file);
    struct needed *needed;
    struct diag *diag; /* for what is found; or NULL */
};

/* Texture coordinates are read only where a picture asks for them. */
static bool wants_uvs(const struct desc_object *o)
{
    const struct desc_value *material = desc_get(o, PROP_MATERIAL);
    return desc_get(o, PROP_NORMAL_MAP) || (material && desc_get(material->object, PROP_TEXTURE));
}

static void visit_object(struct visit *v, const struct desc_object *o)
{
    for (const struct desc_prop *p = o->props; p; p = p->next) {
        enum schema_type type = schema_props[p->id].type;
        if (type == TYPE_FILE && (p->id != PROP_UV_FILE || wants_uvs(o)))
            v->file(v, p->id, &p->value);
        else if (type == TYPE_MATERIAL || type == TYPE_TEXTURE)
            visit_object(v, p->value.object);
    }
}

/* Of a light's object only the shape counts. */
static void visit_shape(struct visit *v, const struct desc_object *light)
{
    const struct desc_value *object = desc_get(light, PROP_OBJECT);
    const struct desc_value *file = object ? desc_get(object->object, PROP_MESH_FILE) : NULL;
    if (file)
        v->file(v, PROP_MESH_FILE, file);
}

static void visit_scene(struct visit *v)
{
    const struct desc *d = &v->frontend->desc;
    for (size_t k = 0; k < d->lights.n; k++)
        visit_shape(v, d->lights.at[k]);
    for (size_t k = 0; k < d->surfaces.n; k++) {
        if (v->diag)
            v->diag->frame = d->surfaces.at[k]->frame;
        visit_object(v, d->surfaces.at[k]);
    }
    if (v->diag)
        v->diag->frame = NULL;
}

/* ---- all of them ---- */

/* False when it is known. */
static bool add_path(struct needed *n, const char *path)
{
    if (map_get(&n->known, str_of(path)))
        return false;
    const char *kept = arena_copy(&n->arena, path, strlen(path));
    map_set(&n->known, str_of(kept), n);
    vec_push(&n->paths, kept);
    return true;
}

static char *path_of(const struct visit *v, const struct desc_value *file)
{
    const struct source *s = srcmap_source(&v->frontend->sources, file->spelt);
    return file_resolve(s ? s->name : "", file->string.at, file->string.n);
}

static void add_file(struct visit *v, enum schema_prop_id id, const struct desc_value *file)
{
    (void)id;
    char *path = path_of(v, file);
    add_path(v->needed, path);
    free(path);
}

void needed_files(const struct frontend *f, struct needed *out)
{
    const struct srcmap *sources = &f->sources;
    struct visit v = {.frontend = f, .file = add_file, .needed = out};
    *out = (struct needed){0};
    for (size_t k = 0; k < sources->sources.n; k++)
        if (sources->sources.at[k]->name[0] != '<') /* no file: <stdin>, <-D size> */
            add_path(out, sources->sources.at[k]->name);
    visit_scene(&v);
}

void needed_free(struct needed *n)
{
    map_free(&n->known);
    vec_free(&n->paths);
    arena_free(&n->arena);
}

/* ---- those that may not be read ---- */

static void check_file(struct visit *v, enum schema_prop_id id, const struct desc_value *file)
{
    const struct file_fence *fence = v->frontend->sources.fence;
    char *path = path_of(v, file);
    const char *reason = fence_refusal(fence, file->string);
    if (!reason)
        reason = fence_objection(fence, path);
    if (add_path(v->needed, path) && reason)
        diag_report(v->diag, DIAG_FILE_MISSING, file->span, "could not read the %s '%s': %s",
                    id == PROP_MESH_FILE ? "mesh"
                    : id == PROP_UV_FILE ? "UV list"
                                         : "texture",
                    path, reason);
    free(path);
}

bool needed_check(struct frontend *f)
{
    size_t before = f->diag.entries.n;
    struct needed known = {0};
    struct visit v = {.frontend = f, .file = check_file, .needed = &known, .diag = &f->diag};
    if (f->sources.fence)
        visit_scene(&v);
    needed_free(&known);
    return f->diag.entries.n == before;
}
