/* Textures and meshes that lowering is going to ask for, decoded by several threads before it does.
 * What fails here, or says anything, is left to lowering, which does it again and reports. */
#include "config.h"

#include "lower/lowering.h"

#include "base/fence.h"
#include "base/file.h"
#include "base/thread.h"

#include <string.h>

/* Whether lowering will read this file, and nothing before has. */
static bool is_news(struct lowering *l, const struct desc_value *file, const struct map *kept)
{
    return !fence_refusal(l->sources->fence, file->string) &&
           !memchr(file->string.at, 0, file->string.n) &&
           !map_get(&l->ahead_of, str_of(lower_path_of(l, file))) &&
           !(kept && map_get(kept, str_of(lower_path_of(l, file))));
}

static void add(struct lowering *l, struct lower_ahead a)
{
    vec_push(&l->ahead, a);
    map_set(&l->ahead_of, str_of(a.path), (void *)(uintptr_t)l->ahead.n);
}

static void foresee_texture(struct lowering *l, bool *seen, const struct desc_value *texture)
{
    if (!texture || seen[texture->object->number])
        return;
    const struct desc_value *file = desc_get(texture->object, PROP_FILE);
    seen[texture->object->number] = true;
    if (is_news(l, file, l->kept ? &l->kept->images : NULL))
        add(l, (struct lower_ahead){.path = lower_path_of(l, file)});
}

/* Nothing where meshes cannot be used. */
static void foresee_mesh(struct lowering *l, const struct desc_object *o)
{
#ifdef HAVE_OPENMESH
    const struct desc_value *file = o->kind == KIND_MESH ? desc_get(o, PROP_MESH_FILE) : NULL;
    char *data;
    size_t n;
    if (!file || !is_news(l, file, l->kept ? &l->kept->meshes : NULL))
        return;
    const char *path = lower_path_of(l, file);
    if (file_read_within(l->sources->fence, path, &data, &n))
        return;
    const struct source *s = srcmap_add(l->sources, path, data, n);
    if (s)
        add(l, (struct lower_ahead){.path = path, .source = s});
#else
    (void)l, (void)o;
#endif
}

static void decode_texture(const struct lowering *l, struct lower_ahead *a)
{
    char *data, reason[IMAGE_REASON_BYTES];
    size_t n;
    if (file_read_within(l->sources->fence, a->path, &data, &n))
        return;
    a->image = image_decode(data, n, reason);
    free(data);
}

static void parse_mesh(const struct lowering *l, struct lower_ahead *a)
{
    struct diag diag;
    diag_init(&diag, l->sources);
    diag.policy = l->diag->policy;
    struct mesh *m = mesh_parse(a->source, &diag);
    if (diag.entries.n == 0)
        a->mesh = m;
    else
        mesh_free(m);
    diag_free(&diag);
}

static void decode(void *context, size_t item, unsigned worker)
{
    struct lowering *l = context;
    struct lower_ahead *a = &l->ahead.at[item];
    (void)worker;
    if (a->source)
        parse_mesh(l, a);
    else
        decode_texture(l, a);
}

void lower_look_ahead(struct lowering *l, unsigned threads)
{
    const struct desc *d = l->desc;
    if (threads == 1 || d->surfaces.n < 2)
        return;
    bool *seen = mem_zalloc(d->textures.n, sizeof *seen);
    for (size_t i = 0; i < d->surfaces.n; i++) {
        const struct desc_object *o = d->surfaces.at[i];
        const struct desc_value *material = desc_get(o, PROP_MATERIAL);
        foresee_texture(l, seen, desc_get(o, PROP_NORMAL_MAP));
        foresee_texture(l, seen, material ? desc_get(material->object, PROP_TEXTURE) : NULL);
        foresee_mesh(l, o);
    }
    free(seen);
    if (l->ahead.n > 1)
        thread_share(l->ahead.n, threads, decode, l);
}

struct lower_ahead *lower_ahead(struct lowering *l, const char *path)
{
    uintptr_t number = (uintptr_t)map_get(&l->ahead_of, str_of(path));
    return number ? &l->ahead.at[number - 1] : NULL;
}

void lower_ahead_free(struct lowering *l)
{
    for (size_t i = 0; i < l->ahead.n; i++) {
        image_free(l->ahead.at[i].image);
        mesh_free(l->ahead.at[i].mesh);
    }
    vec_free(&l->ahead);
    map_free(&l->ahead_of);
}
