/* Textures that lowering is going to ask for, decoded by several threads before it does.  What
 * fails here is left to lowering, which reads it again and reports. */
#include "config.h"

#include "lower/lowering.h"

#include "base/fence.h"
#include "base/file.h"
#include "base/thread.h"

#include <string.h>

/* What has been looked at: textures by their numbers, paths. */
struct seen {
    bool *textures;
    struct map paths;
};

static void foresee(struct lowering *l, struct seen *seen, const struct desc_value *texture)
{
    if (!texture || seen->textures[texture->object->number])
        return;
    const struct desc_value *file = desc_get(texture->object, PROP_FILE);
    seen->textures[texture->object->number] = true;
    if (fence_refusal(l->sources->fence, file->string) ||
        memchr(file->string.at, 0, file->string.n))
        return;
    const char *path = lower_path_of(l, file);
    struct str key = str_of(path);
    if (map_get(&seen->paths, key) || (l->kept && map_get(&l->kept->images, key)))
        return;
    map_set(&seen->paths, key, l);
    vec_push(&l->ahead, (struct lower_ahead){path, NULL});
}

static void decode(void *context, size_t item, unsigned worker)
{
    struct lowering *l = context;
    struct lower_ahead *a = &l->ahead.at[item];
    char *data, reason[IMAGE_REASON_BYTES];
    size_t n;
    (void)worker;
    if (file_read_within(l->sources->fence, a->path, &data, &n))
        return;
    a->image = image_decode(data, n, reason);
    free(data);
}

void lower_look_ahead(struct lowering *l, unsigned threads)
{
    const struct desc *d = l->desc;
    if (threads == 1 || d->textures.n < 2)
        return;
    struct seen seen = {.textures = mem_zalloc(d->textures.n, sizeof *seen.textures)};
    for (size_t i = 0; i < d->surfaces.n; i++) {
        const struct desc_value *material = desc_get(d->surfaces.at[i], PROP_MATERIAL);
        foresee(l, &seen, desc_get(d->surfaces.at[i], PROP_NORMAL_MAP));
        foresee(l, &seen, material ? desc_get(material->object, PROP_TEXTURE) : NULL);
    }
    map_free(&seen.paths);
    free(seen.textures);
    if (l->ahead.n > 1)
        thread_share(l->ahead.n, threads, decode, l);
}

struct image *lower_ahead_take(struct lowering *l, const char *path)
{
    for (size_t i = 0; i < l->ahead.n; i++) {
        struct image *image = l->ahead.at[i].image;
        if (!image || strcmp(l->ahead.at[i].path, path) != 0)
            continue;
        l->ahead.at[i].image = NULL;
        return image;
    }
    return NULL;
}

void lower_ahead_free(struct lowering *l)
{
    for (size_t i = 0; i < l->ahead.n; i++)
        image_free(l->ahead.at[i].image);
    vec_free(&l->ahead);
}
