#include "config.h"

#include "cmd/info.h"

#include "base/file.h"

#include <stdlib.h>
#include <string.h>

static void add_path(struct info_files *f, const char *path)
{
    if (map_get(&f->known, str_of(path)))
        return;
    const char *kept = arena_copy(&f->arena, path, strlen(path));
    map_set(&f->known, str_of(kept), f);
    vec_push(&f->paths, kept);
}

static void add_value(struct info_files *f, const struct info *i, const struct desc_value *file)
{
    const struct source *s = srcmap_source(&i->frontend.sources, file->spelt);
    char *path = file_resolve(s ? s->name : "", file->string.at, file->string.n);
    add_path(f, path);
    free(path);
}

/* Texture coordinates are read only where a picture asks for them. */
static bool wants_uvs(const struct desc_object *o)
{
    const struct desc_value *material = desc_get(o, PROP_MATERIAL);
    return desc_get(o, PROP_NORMAL_MAP) || (material && desc_get(material->object, PROP_TEXTURE));
}

static void add_object(struct info_files *f, const struct info *i, const struct desc_object *o)
{
    for (const struct desc_prop *p = o->props; p; p = p->next) {
        enum schema_type type = schema_props[p->id].type;
        if (type == TYPE_FILE && (p->id != PROP_UV_FILE || wants_uvs(o)))
            add_value(f, i, &p->value);
        else if (type == TYPE_MATERIAL || type == TYPE_TEXTURE)
            add_object(f, i, p->value.object);
    }
}

/* Of a light's object only the shape counts. */
static void add_shape(struct info_files *f, const struct info *i, const struct desc_object *light)
{
    const struct desc_value *object = desc_get(light, PROP_OBJECT);
    const struct desc_value *file = object ? desc_get(object->object, PROP_MESH_FILE) : NULL;
    if (file)
        add_value(f, i, file);
}

void info_files(const struct info *i, struct info_files *out)
{
    const struct srcmap *sources = &i->frontend.sources;
    const struct desc *d = &i->frontend.desc;
    *out = (struct info_files){0};
    for (size_t k = 0; k < sources->sources.n; k++)
        if (sources->sources.at[k]->name[0] != '<') /* no file: <stdin>, <-D size> */
            add_path(out, sources->sources.at[k]->name);
    for (size_t k = 0; k < d->lights.n; k++)
        add_shape(out, i, d->lights.at[k]);
    for (size_t k = 0; k < d->surfaces.n; k++)
        add_object(out, i, d->surfaces.at[k]);
}

void info_files_free(struct info_files *f)
{
    map_free(&f->known);
    vec_free(&f->paths);
    arena_free(&f->arena);
}
