/* Surfaces in the very place of an earlier one, which wins every tie: no ray needs them. */
#include "config.h"

#include "render/tracer.h"

/* What tells apart shapes of one kind in a place. */
struct shape_key {
    enum prim_kind kind;
    bool glows; /* what is emissive blocks no light, whatever lies there, too */
    double numbers[9];
};
_Static_assert(sizeof(struct sphere) <= 9 * sizeof(double) &&
                   sizeof(struct cylinder) <= 9 * sizeof(double),
               "a solid fits into a key");

/* False for what is not looked at: meshes, of which each face had to be, and instances. */
static bool key_of(const struct tracer *t, const struct prim *prim, struct shape_key *key)
{
    const struct geometry *g = &t->scene->geometry;
    memset(key, 0, sizeof *key);
    key->kind = prim->kind;
    key->glows = t->emissive[prim->surface];
    if (prim->kind == PRIM_SPHERE) {
        memcpy(key->numbers, &g->spheres.at[prim->index], sizeof(struct sphere));
    } else if (prim->kind == PRIM_CYLINDER) {
        memcpy(key->numbers, &g->cylinders.at[prim->index], sizeof(struct cylinder));
    } else if (prim->kind == PRIM_TRIANGLE &&
               t->scene->surfaces.at[prim->surface].kind != SURFACE_MESH) {
        for (int i = 0; i < 3; i++) {
            struct vec3 corner = g->vertices.at[g->triangles.at[prim->index].vertex[i]];
            memcpy(key->numbers + 3 * i, &corner, sizeof corner);
        }
    } else {
        return false;
    }
    return true;
}

static uint64_t hash_of(const struct shape_key *key)
{
    uint64_t hash = key->kind;
    for (size_t i = 0; i < sizeof key->numbers / sizeof *key->numbers; i++) {
        uint64_t bits;
        memcpy(&bits, &key->numbers[i], sizeof bits);
        hash = (hash ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
        hash ^= hash >> 32;
    }
    return hash;
}

/* A power of two, twice as much as there is to be kept. */
static size_t room_for(const struct scene *scene)
{
    size_t n = 0, room = 2;
    for (size_t i = 0; i < scene->surfaces.n; i++)
        n += scene->surfaces.at[i].kind != SURFACE_MESH ? scene->surfaces.at[i].prim_count : 0;
    while (room < 2 * n)
        room *= 2;
    return room;
}

uint32_t find_twins(const struct tracer *t, bool *twins)
{
    const struct geometry *g = &t->scene->geometry;
    size_t room = room_for(t->scene);
    uint32_t *known = mem_zalloc(room, sizeof *known), found = 0; /* number + 1 by hash */
    for (uint32_t i = 0; i < g->prims.n; i++) {
        struct shape_key key, other;
        if (!key_of(t, &g->prims.at[i], &key))
            continue;
        size_t at = hash_of(&key) & (room - 1);
        for (; known[at] && !twins[i]; at = (at + 1) & (room - 1)) {
            key_of(t, &g->prims.at[known[at] - 1], &other);
            twins[i] = memcmp(&key, &other, sizeof key) == 0;
        }
        if (!twins[i])
            known[at] = i + 1;
        found += twins[i];
    }
    free(known);
    return found;
}
