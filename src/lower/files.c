/* The files a scene names, each read once and only when something needs it. */
#include "config.h"

#include "lower/lowering.h"

#include "math/srgb.h"

#include "base/fence.h"
#include "base/file.h"

#include <string.h>

const char *lower_path_of(struct lowering *l, const struct desc_value *file)
{
    const struct source *s = srcmap_source(l->sources, file->spelt);
    char *path = file_resolve(s ? s->name : "", file->string.at, file->string.n);
    const char *kept = arena_copy(&l->scene->arena, path, strlen(path));
    free(path);
    return kept;
}

/* Offers another spelling of the file's name. */
static void offer(struct lowering *l, struct diag_entry *e, const struct desc_value *file,
                  const char *right)
{
    struct str text = srcmap_text(l->sources, file->span);
    const char *at = memmem(text.at, text.n, file->string.at, file->string.n);
    uint32_t begin = at ? file->span.begin + (uint32_t)(at - text.at) : 0;
    if (at)
        diag_fix(e, (struct span){begin, begin + (uint32_t)file->string.n}, DIAG_FIX_MAYBE, "%s",
                 right);
    else if (text.n && *text.at == '"')
        diag_fix(e, file->span, DIAG_FIX_MAYBE, "\"%s\"", right);
}

/* What other machines would have made of the name. */
static void explain_missing(struct lowering *l, struct diag_entry *e, const struct desc_value *file,
                            const char *path)
{
    bool backslash = memchr(file->string.at, '\\', file->string.n);
    size_t n = strlen(path), from = n - (file->string.n < n ? file->string.n : n);
    bool ends =
        str_is(file->string, path + from) && !fence_refusal(l->sources->fence, file->string);
    char *meant = ends ? file_meant(l->sources->fence, path, from) : NULL;
    char *near = ends && !meant ? file_nearest(l->sources->fence, path) : NULL;
    if (backslash)
        diag_note(e, "'\\' is part of a name; '/' stands between folders");
    if (meant) {
        diag_note(e, backslash ? "there is '%s'" : "there is '%s': the names differ only in case",
                  meant);
        offer(l, e, file, meant + from);
    } else if (near) {
        diag_note(e, "did you mean '%s'?", near + from);
        offer(l, e, file, near + from);
    } else if (*file->string.at == '/') {
        diag_note(e, "an absolute path holds on the machine it was written on");
    }
    free(meant);
    free(near);
}

static bool read_file(struct lowering *l, const struct desc_value *file, const char *path,
                      const char *what, char **data, size_t *n)
{
    const struct file_fence *fence = l->sources->fence;
    const char *reason = fence_refusal(fence, file->string);
    if (strlen(path) != file->string.n && memchr(file->string.at, 0, file->string.n))
        reason = "the name holds a zero byte";
    else if (!reason)
        reason = file_read_within(fence, path, data, n);
    if (reason)
        explain_missing(l,
                        diag_report(l->diag, DIAG_FILE_MISSING, file->span,
                                    "could not read the %s '%s': %s", what, path, reason),
                        file, path);
    return reason == NULL;
}

/* ---- files that are kept ---- */

struct lower_files *lower_files_new(void)
{
    return mem_zalloc(1, sizeof(struct lower_files));
}

void lower_files_free(struct lower_files *f)
{
    for (size_t i = 0; i < f->all_images.n; i++)
        image_free(f->all_images.at[i]);
    for (size_t i = 0; i < f->all_meshes.n; i++)
        mesh_free(f->all_meshes.at[i]);
    vec_free(&f->all_images);
    vec_free(&f->all_meshes);
    map_free(&f->images);
    map_free(&f->meshes);
    map_free(&f->lists);
    arena_free(&f->arena);
    free(f);
}

static void keep(struct lower_files *f, struct map *map, struct str key, void *value)
{
    map_set(map, (struct str){arena_copy(&f->arena, key.at, key.n), key.n}, value);
}

/* ---- textures ---- */

static struct image *decode_image(struct lowering *l, const struct desc_value *file,
                                  const char *path)
{
    struct lower_ahead *ahead = lower_ahead(l, path);
    char *data, reason[256];
    size_t n;
    if (ahead && ahead->image) {
        struct image *image = ahead->image;
        ahead->image = NULL;
        return image;
    }
    if (!read_file(l, file, path, "texture", &data, &n))
        return NULL;
    struct image *image = image_decode(data, n, reason);
    free(data);
    if (!image)
        diag_report(l->diag, DIAG_TEXTURE_DAMAGED, file->span, "cannot use the texture '%s': %s",
                    path, reason);
    return image;
}

static struct image *load_image(struct lowering *l, const struct desc_value *file)
{
    const char *path = lower_path_of(l, file);
    struct image *image = map_get(&l->images, str_of(path));
    if (image)
        return image;
    image = l->kept ? map_get(&l->kept->images, str_of(path)) : NULL;
    bool known = image != NULL;
    if (!known)
        image = decode_image(l, file, path);
    if (!image)
        return NULL;
    if (l->kept && !known) {
        vec_push(&l->kept->all_images, image);
        keep(l->kept, &l->kept->images, str_of(path), image);
    }
    vec_push(&l->scene->images, image);
    map_set(&l->images, str_of(path), image);
    return image;
}

/* The light of each sample value of an image. */
static const double *decoding_of(struct lowering *l, const struct image *image)
{
    const double **table = image->data8 ? &l->decode8 : &l->decode16;
    uint32_t n = image->data8 ? 256 : 65536;
    if (*table)
        /* cppcheck-suppress identicalInnerCondition */
        return *table;
    double *values = arena_zalloc(&l->scene->arena, n, sizeof *values);
    for (uint32_t i = 0; i < n; i++)
        values[i] = srgb_decode(i / (double)(n - 1));
    return *table = values;
}

uint32_t lower_texture(struct lowering *l, const struct desc_object *o, bool data)
{
    bool modern = l->scene->model == SCENE_MODERN;
    if (!o)
        return TEXTURE_NONE;
    uint32_t *number = &(data && modern ? l->data_of : l->texture_of)[o->number];
    uint32_t twin = (data && modern ? l->texture_of : l->data_of)[o->number]; /* the same file */
    if (*number != TEXTURE_NONE)
        return *number;
    const struct desc_value *file = desc_get(o, PROP_FILE);
    struct texture t = {.image = twin == TEXTURE_NONE ? load_image(l, file)
                                                      : l->scene->textures.at[twin].image,
                        .file = lower_path_of(l, file),
                        .linear = desc_word(o, PROP_FILTER) == 1,
                        .centred = modern};
    if (modern && !data && t.image)
        t.decode = decoding_of(l, t.image);
    *number = (uint32_t)l->scene->textures.n;
    vec_push(&l->scene->textures, t);
    return *number;
}

/* A text file as a source, so that findings can point into it. */
static const struct source *load_source(struct lowering *l, const struct desc_value *file,
                                        const char *path, const char *what)
{
    char *data;
    size_t n;
    if (!read_file(l, file, path, what, &data, &n))
        return NULL;
    const struct source *s = srcmap_add(l->sources, path, data, n);
    if (!s)
        diag_report(l->diag, DIAG_SCENE_TOO_LARGE, file->span,
                    "the %s '%s' is too large together with the other files (limit 4 GB in all)",
                    what, path);
    return s;
}

void lower_label_request(struct lowering *l, size_t first, const struct desc_value *file)
{
    for (size_t i = first; i < l->diag->entries.n; i++)
        diag_label(l->diag->entries.at[i], file->span, "the scene names the file here");
}

static struct mesh *read_mesh(struct lowering *l, const struct desc_value *file, const char *path)
{
#ifdef HAVE_OPENMESH
    struct lower_ahead *ahead = lower_ahead(l, path);
    if (ahead && ahead->mesh) {
        struct mesh *mesh = ahead->mesh;
        ahead->mesh = NULL;
        return mesh;
    }
    const struct source *s =
        ahead && ahead->source ? ahead->source : load_source(l, file, path, "mesh");
    size_t first = l->diag->entries.n;
    struct mesh *m = s ? mesh_parse(s, l->diag) : NULL;
    if (s)
        lower_label_request(l, first, file);
    return m;
#else
    diag_report(l->diag, DIAG_MESH_SUPPORT, file->span,
                "cannot use the mesh '%s': this wrt was built without OpenMesh", path);
    return NULL;
#endif
}

/* Where a kept file said something is not known any more in the next scene. */
static struct mesh *load_mesh(struct lowering *l, const struct desc_value *file, const char *path)
{
    struct mesh *m = l->kept ? map_get(&l->kept->meshes, str_of(path)) : NULL;
    if (m) {
        m->bare = (struct span){0};
        return m;
    }
    m = read_mesh(l, file, path);
    if (m && l->kept) {
        vec_push(&l->kept->all_meshes, m);
        keep(l->kept, &l->kept->meshes, str_of(path), m);
    }
    return m;
}

const struct lower_mesh *lower_mesh_file(struct lowering *l, const struct desc_value *file)
{
    const char *path = lower_path_of(l, file);
    uintptr_t known = (uintptr_t)map_get(&l->meshes, str_of(path));
    if (!known) {
        struct lower_mesh m = {path, load_mesh(l, file, path), file, l->diag->frame};
        vec_push(&l->out->meshes, m);
        known = l->out->meshes.n;
        map_set(&l->meshes, str_of(path), (void *)known);
    }
    return &l->out->meshes.at[known - 1];
}

/* In the arena of what keeps it; NULL after reporting. */
static struct vec2 *read_uv_list(struct lowering *l, const struct desc_value *file,
                                 const char *path, size_t faces)
{
    const struct source *s = load_source(l, file, path, "UV list");
    struct vec2 *uvs = NULL;
    size_t first = l->diag->entries.n, n = 3 * faces;
    if (!s)
        return NULL;
    if (!uv_list_parse(s, faces, &uvs, l->diag)) {
        lower_label_request(l, first, file);
        return NULL;
    }
    struct arena *arena = l->kept ? &l->kept->arena : &l->scene->arena;
    struct vec2 *copy = arena_zalloc(arena, n, sizeof *copy);
    memcpy(copy, uvs, n * sizeof *copy);
    free(uvs);
    return copy;
}

const struct vec2 *lower_uv_file(struct lowering *l, const struct desc_value *file, size_t faces)
{
    const char *path = lower_path_of(l, file);
    struct str key = str_of(arena_printf(&l->scene->arena, "%zu %s", faces, path));
    static struct vec2 unreadable; /* reported once */
    struct vec2 *known = map_get(&l->uv_lists, key);
    if (known)
        return known == &unreadable ? NULL : known;
    struct vec2 *uvs = l->kept ? map_get(&l->kept->lists, key) : NULL;
    if (!uvs && (uvs = read_uv_list(l, file, path, faces)) && l->kept)
        keep(l->kept, &l->kept->lists, key, uvs);
    map_set(&l->uv_lists, key, uvs ? uvs : &unreadable);
    return uvs;
}
