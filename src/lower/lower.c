#include "config.h"

#include "lower/lowering.h"

#include <string.h>

static void lower_classic_camera(const struct desc_object *o, struct camera *c)
{
    c->back = desc_vector(o, PROP_BACK);
    c->yfov = desc_number(o, PROP_YFOV);
    c->compatible = desc_number(o, PROP_COMPAT) != 0;
}

/* A lens has a field of view or a height, never both. */
static void lower_modern_camera(const struct desc_object *o, struct camera *c)
{
    c->modern = true;
    c->back = desc_get(o, PROP_VIEW) ? vec3_neg(desc_vector(o, PROP_VIEW))
                                     : vec3_sub(c->origin, desc_vector(o, PROP_LOOK_AT));
    if (desc_get(o, PROP_FOV))
        c->yfov = desc_number(o, PROP_FOV);
    else
        c->view_height = desc_number(o, PROP_VIEW_HEIGHT);
}

static void lower_camera(struct lowering *l)
{
    const struct desc_object *o = l->desc->camera;
    const struct desc_value *size = desc_get(o, PROP_RESOLUTION);
    struct camera *c = &l->scene->camera;
    *c = (struct camera){.origin = desc_vector(o, PROP_EYE),
                         .up = desc_vector(o, PROP_UP),
                         .width = (uint32_t)size->number[0],
                         .height = (uint32_t)size->number[1]};
    if (l->scene->model == SCENE_MODERN)
        lower_modern_camera(o, c);
    else
        lower_classic_camera(o, c);
}

/* A modern scene without settings has their defaults. */
static const struct desc_object *settings_of(const struct desc *d)
{
    static const struct desc_object defaults = {.kind = KIND_SETTINGS, .model = SCHEMA_MODERN};
    return d->settings ? d->settings : &defaults;
}

/* Classic has no choice. */
uint32_t lower_depth(const struct desc *d)
{
    return d->model == SCHEMA_CLASSIC ? 3 : (uint32_t)desc_number(settings_of(d), PROP_DEPTH);
}

static void lower_settings(struct lowering *l)
{
    const struct desc_object *o = settings_of(l->desc);
    struct scene *s = l->scene;
    s->depth = lower_depth(l->desc);
    s->grid = 1;
    if (s->model == SCENE_CLASSIC)
        return;
    s->background = desc_vector(o, PROP_BACKGROUND);
    s->ambient = desc_vector(o, PROP_AMBIENT);
    s->grid = (uint32_t)desc_number(o, PROP_SAMPLES);
    s->linear = desc_word(o, PROP_ENCODING) == 1;
}

static uint32_t *none_of(size_t n)
{
    uint32_t *numbers = mem_alloc(n, sizeof *numbers);
    memset(numbers, 0xFF, n * sizeof *numbers);
    return numbers;
}

static void note_skipped(struct lowering *l, const char *what, struct str name)
{
    vec_push(&l->scene->skipped, arena_printf(&l->scene->arena, "%s %.*s", what, STR_ARG(name)));
}

/* Names what was left out, for --stats. */
static void note_unused(struct lowering *l)
{
    const struct desc *d = l->desc;
    for (size_t i = 0; i < d->textures.n; i++)
        if (l->texture_of[i] == UINT32_MAX && l->data_of[i] == UINT32_MAX)
            note_skipped(l, "texture", desc_get(d->textures.at[i], PROP_FILE)->string);
    for (size_t i = 0; i < d->materials.n; i++)
        if (l->material_of[i] == UINT32_MAX && d->materials.at[i]->name.n)
            note_skipped(l, "material", d->materials.at[i]->name);
    for (size_t i = 0; i < d->surfaces.n; i++) {
        const struct desc_value *uvs = desc_get(d->surfaces.at[i], PROP_UV_FILE);
        if (uvs && !desc_get(d->surfaces.at[i], PROP_NORMAL_MAP) &&
            !desc_get(desc_get(d->surfaces.at[i], PROP_MATERIAL)->object, PROP_TEXTURE))
            note_skipped(l, "uv_file", uvs->string);
    }
}

static bool lower_desc(const struct desc *d, struct srcmap *sources, struct lower_files *kept,
                       unsigned threads, struct lowered *out, bool copied, struct diag *diag)
{
    *out = (struct lowered){.borrowed = kept != NULL};
    out->scene.model = d->model == SCHEMA_MODERN ? SCENE_MODERN : SCENE_CLASSIC;
    struct lowering l = {
        .kept = kept,
        .desc = d,
        .sources = sources,
        .out = out,
        .scene = &out->scene,
        .diag = diag,
        .copied = copied,
        .material_of = none_of(d->materials.n),
        .texture_of = none_of(d->textures.n),
        .data_of = none_of(d->textures.n),
    };
    size_t errors = diag->errors;
    lower_camera(&l);
    lower_look_ahead(&l, threads);
    lower_count_meshes(&l);
    lower_settings(&l);
    for (size_t i = 0; i < d->lights.n; i++) {
        diag->frame = d->lights.at[i]->frame;
        lower_light(&l, d->lights.at[i]);
    }
    for (size_t i = 0; i < d->surfaces.n; i++) {
        size_t first = l.scene->surfaces.n;
        diag->frame = d->surfaces.at[i]->frame;
        lower_surface(&l, d->surfaces.at[i]);
        for (size_t k = first; k < l.scene->surfaces.n; k++)
            l.scene->surfaces.at[k].described = (uint32_t)i;
    }
    diag->frame = NULL;
    note_unused(&l);
    free(l.material_of);
    free(l.texture_of);
    free(l.data_of);
    lower_ahead_free(&l);
    map_free(&l.images);
    map_free(&l.meshes);
    map_free(&l.models);
    map_free(&l.uv_lists);
    return diag->errors == errors;
}

bool lower_scene(const struct desc *d, struct srcmap *sources, struct lowered *out,
                 struct diag *diag)
{
    return lower_desc(d, sources, NULL, 1, out, false, diag);
}

bool lower_scene_keeping(const struct desc *d, struct srcmap *sources, struct lower_files *files,
                         unsigned threads, struct lowered *out, struct diag *diag)
{
    return lower_desc(d, sources, files, threads, out, false, diag);
}

bool lower_scene_copied(const struct desc *d, struct srcmap *sources, struct lowered *out,
                        struct diag *diag)
{
    return lower_desc(d, sources, NULL, 1, out, true, diag);
}

void lower_free(struct lowered *l)
{
    for (size_t i = 0; i < l->meshes.n && !l->borrowed; i++)
        mesh_free(l->meshes.at[i].mesh);
    if (l->borrowed)
        l->scene.images.n = 0;
    vec_free(&l->meshes);
    scene_free(&l->scene);
}
