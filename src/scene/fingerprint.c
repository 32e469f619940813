/* Field by field, for what the compiler leaves between fields is anything; arrays of doubles as
 * they lie in memory.  What lowering derives of other fields is left out, and so is what surfaces
 * share: each counts by what it is made of. */
#include "config.h"

#include "scene/fingerprint.h"

#include "base/hash.h"
#include "base/map.h"

/* What several surfaces share is hashed once. */
struct sharing {
    struct arena arena;
    struct map numbers; /* of what lies at an address, from 1 */
    VEC(uint64_t) hashes;
};

static void add_count(struct hash *h, uint64_t n)
{
    hash_add(h, &n, sizeof n);
}

static void add_number(struct hash *h, double x)
{
    hash_add(h, &x, sizeof x);
}

static void add_vector(struct hash *h, struct vec3 v)
{
    hash_add(h, &v, sizeof v);
}

static void add_uv_map(struct hash *h, const struct uv_map *m)
{
    hash_add(h, m, sizeof *m);
}

/* ---- shapes ---- */

static void add_instance(struct hash *h, const struct instance *i)
{
    hash_add(h, &i->to_world, sizeof i->to_world);
    add_count(h, (uint64_t)i->prototype << 32 | i->only);
}

static void add_prims(struct hash *h, const struct geometry *g)
{
    add_count(h, g->prims.n);
    for (size_t i = 0; i < g->prims.n; i++) {
        const struct prim *p = &g->prims.at[i];
        add_count(h, (uint64_t)p->surface << 32 | (uint64_t)p->index << 2 | p->kind);
    }
}

static void add_geometry(struct hash *h, const struct geometry *g)
{
    add_prims(h, g);
    for (size_t i = 0; i < g->spheres.n; i++) {
        add_vector(h, g->spheres.at[i].center);
        add_number(h, g->spheres.at[i].radius);
    }
    for (size_t i = 0; i < g->cylinders.n; i++) {
        const struct cylinder *c = &g->cylinders.at[i];
        add_vector(h, c->base);
        add_vector(h, c->axis);
        add_number(h, c->height);
        add_number(h, c->radius);
    }
    for (size_t i = 0; i < g->triangles.n; i++)
        hash_add(h, g->triangles.at[i].vertex, sizeof g->triangles.at[i].vertex);
    add_count(h, g->vertices.n);
    if (g->vertices.n > 0)
        hash_add(h, g->vertices.at, g->vertices.n * sizeof *g->vertices.at);
    for (size_t i = 0; i < g->instances.n; i++)
        add_instance(h, &g->instances.at[i]);
    for (size_t i = 0; i < g->prototypes.n; i++)
        add_geometry(h, &g->prototypes.at[i]->shapes);
}

uint64_t geometry_fingerprint(const struct geometry *g)
{
    struct hash h;
    hash_begin(&h, 0);
    add_geometry(&h, g);
    return hash_end(&h);
}

/* ---- what surfaces share ---- */

/* The hash of what lies at the address, if it is known. */
static bool find_shared(const struct sharing *sharing, const void *what, uint64_t *hash)
{
    struct str key = {(const char *)&what, sizeof what};
    size_t number = (size_t)(uintptr_t)map_get(&sharing->numbers, key);
    if (number > 0)
        *hash = sharing->hashes.at[number - 1];
    return number > 0;
}

static uint64_t note_shared(struct sharing *sharing, const void *what, const struct hash *h)
{
    struct str key = {(const char *)&what, sizeof what};
    vec_push(&sharing->hashes, hash_end(h));
    key.at = arena_copy(&sharing->arena, key.at, key.n);
    map_set(&sharing->numbers, key, (void *)(uintptr_t)sharing->hashes.n);
    return hash_end(h);
}

static uint64_t hash_image(struct sharing *sharing, const struct image *i)
{
    uint64_t known;
    struct hash h;
    if (find_shared(sharing, i, &known))
        return known;
    size_t channels = (size_t)3 * i->width * i->height;
    hash_begin(&h, 0);
    add_count(&h, (uint64_t)i->width << 32 | i->height);
    add_count(&h, i->data16 != NULL);
    if (i->data16)
        hash_add(&h, i->data16, channels * sizeof *i->data16);
    else
        hash_add(&h, i->data8, channels);
    return note_shared(sharing, i, &h);
}

static void add_texture(struct hash *h, const struct scene *s, struct sharing *sharing,
                        uint32_t number)
{
    add_count(h, number != TEXTURE_NONE);
    if (number == TEXTURE_NONE)
        return;
    const struct texture *t = &s->textures.at[number];
    add_count(h, (uint64_t)t->linear << 2 | (uint64_t)t->centred << 1 | (t->decode != NULL));
    add_count(h, hash_image(sharing, t->image));
}

static uint64_t hash_material(const struct scene *s, struct sharing *sharing,
                              const struct material *m)
{
    uint64_t known;
    struct hash h;
    if (find_shared(sharing, m, &known))
        return known;
    hash_begin(&h, 0);
    add_count(&h, m->kind);
    add_vector(&h, m->diffuse);
    add_vector(&h, m->specular);
    add_vector(&h, m->reflection);
    add_vector(&h, m->refraction);
    add_number(&h, m->exponent);
    add_number(&h, m->ior);
    add_uv_map(&h, &m->uv);
    add_texture(&h, s, sharing, m->texture);
    return note_shared(sharing, m, &h);
}

/* ---- surfaces ---- */

static uint64_t hash_normals(const struct scene *scene, struct sharing *sharing,
                             const struct surface *surface)
{
    struct surface_faces f = surface_faces(scene, surface);
    uint64_t known;
    struct hash h;
    if (!surface->normals)
        return 0;
    if (find_shared(sharing, surface->normals, &known))
        return known;
    hash_begin(&h, 0);
    for (uint32_t i = 0; i < f.n; i++) {
        uint32_t triangle = f.geometry->prims.at[f.first_prim + i].index;
        const uint32_t *corner = surface->normal_corners
                                     ? surface->normal_corners[i].at
                                     : f.geometry->triangles.at[triangle].vertex;
        uint32_t base = surface->normal_corners ? 0 : f.first_vertex;
        for (int k = 0; k < 3; k++)
            add_vector(&h, surface->normals[corner[k] - base]);
    }
    return note_shared(sharing, surface->normals, &h);
}

static uint64_t hash_uvs(const struct scene *scene, struct sharing *sharing,
                         const struct surface *surface)
{
    uint64_t known;
    struct hash h;
    if (!surface->uvs)
        return 0;
    if (find_shared(sharing, surface->uvs, &known))
        return known;
    hash_begin(&h, 0);
    hash_add(&h, surface->uvs, (size_t)3 * surface_faces(scene, surface).n * sizeof *surface->uvs);
    return note_shared(sharing, surface->uvs, &h);
}

static void add_surface(struct hash *h, const struct scene *s, struct sharing *sharing,
                        const struct surface *surface)
{
    add_count(h, (uint64_t)surface->kind << 32 | (uint64_t)surface->flip << 1 | surface->needs_uv);
    add_count(h, (uint64_t)surface->first_prim << 32 | surface->prim_count);
    add_count(h, hash_material(s, sharing, &s->materials.at[surface->material]));
    add_texture(h, s, sharing, surface->normal_map);
    if (surface->normal_map != TEXTURE_NONE)
        add_uv_map(h, &surface->uv);
    if (surface->prim_count == 0)
        return;
    add_count(h, hash_normals(s, sharing, surface));
    add_count(h, hash_uvs(s, sharing, surface));
}

/* ---- the rest ---- */

static void add_camera(struct hash *h, const struct camera *c)
{
    add_vector(h, c->origin);
    add_vector(h, c->back);
    add_vector(h, c->up);
    add_number(h, c->yfov);
    add_number(h, c->view_height);
    add_count(h, (uint64_t)c->width << 32 | c->height);
    add_count(h, (uint64_t)c->compatible << 1 | c->modern);
}

static void add_light(struct hash *h, const struct light *l)
{
    add_count(h, (uint64_t)l->kind << 32 | l->grid);
    add_count(h, (uint64_t)l->inverse_square << 1 | l->both_sides);
    add_vector(h, l->position);
    add_vector(h, l->intensity);
    add_number(h, l->growth);
    add_geometry(h, &l->object);
    add_count(h, l->points.n);
    for (size_t i = 0; i < l->points.n; i++) {
        add_vector(h, l->points.at[i].position);
        add_count(h, l->points.at[i].count);
    }
}

uint64_t scene_fingerprint(const struct scene *s)
{
    struct hash h;
    struct sharing sharing = {0};
    hash_begin(&h, 0);
    add_count(&h, (uint64_t)s->model << 1 | s->linear);
    add_vector(&h, s->background);
    add_vector(&h, s->ambient);
    add_count(&h, (uint64_t)s->depth << 32 | s->grid);
    add_camera(&h, &s->camera);
    add_geometry(&h, &s->geometry);
    add_count(&h, s->surfaces.n);
    for (size_t i = 0; i < s->surfaces.n; i++)
        add_surface(&h, s, &sharing, &s->surfaces.at[i]);
    add_count(&h, s->lights.n);
    for (size_t i = 0; i < s->lights.n; i++)
        add_light(&h, &s->lights.at[i]);
    vec_free(&sharing.hashes);
    map_free(&sharing.numbers);
    arena_free(&sharing.arena);
    return hash_end(&h);
}
