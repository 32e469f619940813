#include "config.h"

#include "scene/scene.h"

void scene_free(struct scene *s)
{
    geometry_free(&s->geometry);
    vec_free(&s->surfaces);
    vec_free(&s->materials);
    vec_free(&s->textures);
    for (size_t i = 0; i < s->images.n; i++)
        image_free(s->images.at[i]);
    vec_free(&s->images);
    for (size_t i = 0; i < s->lights.n; i++) {
        geometry_free(&s->lights.at[i].object);
        vec_free(&s->lights.at[i].points);
        vec_free(&s->lights.at[i].samples);
        vec_free(&s->lights.at[i].areas);
    }
    vec_free(&s->lights);
    vec_free(&s->skipped);
    arena_free(&s->arena);
}
