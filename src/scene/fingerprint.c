/* Field by field, for what the compiler leaves between fields is anything; arrays of doubles as
 * they lie in memory.  What lowering derives of other fields is left out. */
#include "config.h"

#include "scene/fingerprint.h"

#include "base/hash.h"
#include "base/map.h"

/* An array that several surfaces share is hashed once, and then told by its number. */
struct sharing {
    struct arena arena;
    struct map numbers; /* of the array's address */
    size_t n;
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

/* ---- what surfaces have at their corners ---- */

/* Whether the array comes for the first time; adds its number. */
static bool add_shared(struct hash *h, struct sharing *sharing, const void *array)
{
    struct str key = {(const char *)&array, sizeof array};
    size_t number = (size_t)(uintptr_t)map_get(&sharing->numbers, key);
    bool first = array && number == 0;
    if (first) {
        number = ++sharing->n;
        key.at = arena_copy(&sharing->arena, key.at, key.n);
        map_set(&sharing->numbers, key, (void *)(uintptr_t)number);
    }
    add_count(h, number);
    return first;
}

static void add_corner_normals(struct hash *h, const struct scene *s, const struct surface *surface)
{
    const struct geometry *g = &s->geometry;
    const struct prim *first = &g->prims.at[surface->first_prim];
    uint32_t faces = surface->prim_count, base = surface->first_vertex;
    if (first->kind == PRIM_INSTANCE) {
        g = &g->prototypes.at[g->instances.at[first->index].prototype]->shapes;
        first = g->prims.at;
        faces = (uint32_t)g->prims.n;
        base = 0;
    }
    for (uint32_t i = 0; i < faces; i++) {
        const uint32_t *corner = surface->normal_corners ? surface->normal_corners[i].at
                                                         : g->triangles.at[first[i].index].vertex;
        for (int k = 0; k < 3; k++)
            add_vector(h, surface->normals[surface->normal_corners ? corner[k] : corner[k] - base]);
    }
}

static void add_uvs(struct hash *h, const struct scene *s, const struct surface *surface)
{
    const struct geometry *g = &s->geometry;
    const struct prim *first = &g->prims.at[surface->first_prim];
    size_t faces = surface->prim_count;
    if (first->kind == PRIM_INSTANCE)
        faces = g->prototypes.at[g->instances.at[first->index].prototype]->shapes.prims.n;
    hash_add(h, surface->uvs, 3 * faces * sizeof *surface->uvs);
}

static void add_surface(struct hash *h, const struct scene *s, struct sharing *sharing,
                        const struct surface *surface)
{
    add_count(h, (uint64_t)surface->kind << 32 | surface->material);
    add_count(h, (uint64_t)surface->first_prim << 32 | surface->prim_count);
    add_count(h, (uint64_t)surface->normal_map << 32 | (uint64_t)surface->flip << 1 |
                     surface->needs_uv);
    if (surface->normal_map != TEXTURE_NONE)
        add_uv_map(h, &surface->uv);
    if (surface->prim_count == 0)
        return;
    if (add_shared(h, sharing, surface->normals))
        add_corner_normals(h, s, surface);
    if (add_shared(h, sharing, surface->uvs))
        add_uvs(h, s, surface);
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

static void add_material(struct hash *h, const struct material *m)
{
    add_count(h, (uint64_t)m->kind << 32 | m->texture);
    add_vector(h, m->diffuse);
    add_vector(h, m->specular);
    add_vector(h, m->reflection);
    add_vector(h, m->refraction);
    add_number(h, m->exponent);
    add_number(h, m->ior);
    add_uv_map(h, &m->uv);
}

static void add_image(struct hash *h, const struct image *i)
{
    size_t channels = (size_t)3 * i->width * i->height;
    add_count(h, (uint64_t)i->width << 32 | i->height);
    add_count(h, i->data16 != NULL);
    if (i->data16)
        hash_add(h, i->data16, channels * sizeof *i->data16);
    else
        hash_add(h, i->data8, channels);
}

static void add_texture(struct hash *h, struct sharing *sharing, const struct texture *t)
{
    add_count(h, (uint64_t)t->linear << 2 | (uint64_t)t->centred << 1 | (t->decode != NULL));
    if (add_shared(h, sharing, t->image))
        add_image(h, t->image);
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
    add_count(&h, s->materials.n);
    for (size_t i = 0; i < s->materials.n; i++)
        add_material(&h, &s->materials.at[i]);
    add_count(&h, s->textures.n);
    for (size_t i = 0; i < s->textures.n; i++)
        add_texture(&h, &sharing, &s->textures.at[i]);
    add_count(&h, s->lights.n);
    for (size_t i = 0; i < s->lights.n; i++)
        add_light(&h, &s->lights.at[i]);
    map_free(&sharing.numbers);
    arena_free(&sharing.arena);
    return hash_end(&h);
}
