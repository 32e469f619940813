/* Surfaces and lights that are there twice.
 *
 * Each surface is written down as numbers, once for its shape and place and once for its look;
 * shapes are sorted by a hash of theirs, and what has the same is compared in full. */
#include "config.h"

#include "lint/checks.h"

#include "base/file.h"

#include <stdlib.h>
#include <string.h>

struct numbers {
    VEC(double) list;
};

struct twins {
    const struct lint *l;
    struct arena arena;
    struct map files, textures, materials; /* what is the same to its number */
    double *texture_of, *material_of;      /* of the description's */
    struct numbers one, other;             /* scratch */
};

/* -0 is 0. */
static void put(struct numbers *n, double x)
{
    vec_push(&n->list, x + 0.0);
}

static void put_vector(struct numbers *n, struct vec3 v)
{
    put(n, v.x);
    put(n, v.y);
    put(n, v.z);
}

/* The number of a key among those of the map: the same for the same bytes. */
static double number_of(struct twins *t, struct map *map, const void *key, size_t n)
{
    struct str bytes = {key, n};
    uintptr_t number = (uintptr_t)map_get(map, bytes);
    if (!number) {
        number = map->n + 1;
        bytes.at = arena_copy(&t->arena, key, n);
        map_set(map, bytes, (void *)number);
    }
    return (double)number;
}

static double number_of_list(struct twins *t, struct map *map, const struct numbers *n)
{
    return number_of(t, map, n->list.at, n->list.n * sizeof *n->list.at);
}

/* 0 for none. */
static double file_number(struct twins *t, const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_value *v = desc_get(o, id);
    if (!v)
        return 0;
    const struct source *s = srcmap_source(t->l->sources, v->spelt);
    char *path = file_resolve(s ? s->name : "", v->string.at, v->string.n);
    struct file_id file;
    double number = file_identify(path, &file) ? number_of(t, &t->files, &file, sizeof file)
                                               : number_of(t, &t->files, path, strlen(path));
    free(path);
    return number;
}

static double texture_number(const struct twins *t, const struct desc_object *o,
                             enum schema_prop_id id)
{
    const struct desc_value *v = desc_get(o, id);
    return v ? t->texture_of[v->object->number] : 0;
}

/* ---- numbers of a surface ---- */

static void put_place(struct numbers *n, const struct affine *place)
{
    static const struct affine identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    const struct affine *a = place ? place : &identity;
    for (int i = 0; i < 12; i++)
        put(n, a->m[i / 4][i % 4]);
}

static void put_points(struct numbers *n, const struct desc_object *o, enum schema_prop_id id,
                       bool moved)
{
    const struct desc_value *v = desc_get(o, id);
    put(n, v ? v->n : 0);
    for (uint32_t i = 0; v && i < v->n; i++)
        put_vector(n, moved && o->place ? affine_point(o->place, v->points[i]) : v->points[i]);
}

static void put_cylinder(struct numbers *n, const struct desc_object *o)
{
    struct vec3 base = desc_vector(o, PROP_BASE);
    double height = desc_get(o, PROP_HEIGHT) ? desc_number(o, PROP_HEIGHT) : 0;
    put_vector(n, base);
    put_vector(n, height != 0 ? vec3_add(base, vec3(0, height, 0)) : desc_vector(o, PROP_TOP));
    put(n, desc_number(o, PROP_RADIUS));
}

static void put_mesh(struct twins *t, struct numbers *n, const struct desc_object *o)
{
    put(n, file_number(t, o, PROP_MESH_FILE));
    put_vector(n, desc_vector(o, PROP_MESH_POSITION));
    put_vector(n, desc_vector(o, PROP_MESH_SCALE));
}

/* Corners are moved; what else is placed is the same only in the same place. */
static void put_shape(struct twins *t, struct numbers *n, const struct desc_object *o)
{
    n->list.n = 0;
    put(n, o->kind);
    if (o->kind == KIND_TRIANGLE) {
        put_points(n, o, PROP_TRIANGLE_VERTICES, true);
        return;
    }
    if (o->kind == KIND_QUAD) {
        put_points(n, o, PROP_QUAD_VERTICES, true);
        return;
    }
    put_place(n, o->place);
    if (o->kind == KIND_CYLINDER) {
        put_cylinder(n, o);
    } else if (o->kind == KIND_MESH) {
        put_mesh(t, n, o);
    } else {
        put_vector(n, desc_vector(o, PROP_CENTER));
        put(n, desc_number(o, PROP_RADIUS));
    }
}

static void put_look(struct twins *t, struct numbers *n, const struct desc_object *o)
{
    n->list.n = 0;
    put(n, t->material_of[desc_get(o, PROP_MATERIAL)->object->number]);
    put(n, texture_number(t, o, PROP_NORMAL_MAP));
    put_vector(n, desc_vector(o, PROP_UV_OFFSET));
    put_vector(n, desc_vector(o, PROP_UV_SCALE));
    if (o->kind == KIND_TRIANGLE)
        put_points(n, o, PROP_TRIANGLE_UVS, false);
    if (o->kind == KIND_QUAD)
        put_points(n, o, PROP_QUAD_UVS, false);
    if (o->kind != KIND_MESH)
        return;
    put(n, file_number(t, o, PROP_UV_FILE));
    put(n, desc_number(o, PROP_SMOOTH) > 0);
    put(n, desc_number(o, PROP_FLIP_NORMALS));
    put(n, desc_get(o, PROP_SHOW_NORMALS) ? desc_number(o, PROP_SHOW_NORMALS) : 0);
}

static bool equal(const struct numbers *a, const struct numbers *b)
{
    return a->list.n == b->list.n &&
           memcmp(a->list.at, b->list.at, a->list.n * sizeof *a->list.at) == 0;
}

/* ---- numbers of textures and materials ---- */

static void put_property(struct twins *t, struct numbers *n, const struct desc_object *o,
                         enum schema_prop_id id)
{
    enum schema_type type = schema_props[id].type;
    if (type == TYPE_TEXTURE)
        put(n, texture_number(t, o, id));
    else if (type == TYPE_FILE)
        put(n, file_number(t, o, id));
    else if (type == TYPE_WORD)
        put(n, desc_word(o, id));
    else
        put_vector(n, desc_vector(o, id));
}

static void number_all(struct twins *t, struct desc_object *const *objects, size_t count,
                       struct map *map, double *out)
{
    for (size_t i = 0; i < count; i++) {
        t->one.list.n = 0;
        put(&t->one, objects[i]->kind);
        for (int p = 0; p < SCHEMA_PROPS; p++)
            if (schema_has(objects[i]->kind, (enum schema_prop_id)p))
                put_property(t, &t->one, objects[i], (enum schema_prop_id)p);
        out[i] = number_of_list(t, map, &t->one);
    }
}

/* ---- the same ---- */

struct ranked {
    uint64_t hash;
    uint32_t surface;
};

/* By bits and not by bytes: surfaces are many. */
static uint64_t hash_of(const struct numbers *n)
{
    uint64_t h = n->list.n;
    for (size_t i = 0; i < n->list.n; i++) {
        uint64_t bits;
        memcpy(&bits, &n->list.at[i], sizeof bits);
        h = (h ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
        h ^= h >> 32;
    }
    return h;
}

static int compare(const void *pa, const void *pb)
{
    const struct ranked *a = pa, *b = pb;
    if (a->hash != b->hash)
        return a->hash < b->hash ? -1 : 1;
    return a->surface < b->surface ? -1 : a->surface > b->surface;
}

static void report_twin(struct twins *t, const struct desc_object *o,
                        const struct desc_object *earlier)
{
    const char *kind = schema_kind_name(o->kind, o->xml);
    put_look(t, &t->one, o);
    put_look(t, &t->other, earlier);
    bool same = equal(&t->one, &t->other);
    t->l->diag->frame = o->frame;
    struct diag_entry *e = diag_report(
        t->l->diag, same ? DIAG_DUPLICATE_SURFACE : DIAG_COINCIDENT_SURFACES, o->span,
        same ? "this %s is there twice"
             : "this %s is where another one is, of another material: which one shows is chance",
        kind);
    diag_label_made(e, earlier->span, earlier->frame, "the first is here");
    const struct ast_node *node = same ? lint_surface_node(t->l, o) : NULL;
    if (node)
        lint_remove(t->l, e, node->span, DIAG_FIX_MAYBE);
}

static void compare_run(struct twins *t, const struct ranked *run, size_t n)
{
    struct desc_object *const *surfaces = t->l->desc->surfaces.at;
    const struct desc_object *first = surfaces[run->surface];
    for (size_t i = 1; i < n; i++) {
        const struct desc_object *o = surfaces[run[i].surface];
        put_shape(t, &t->one, first);
        put_shape(t, &t->other, o);
        if (equal(&t->one, &t->other))
            report_twin(t, o, first);
    }
    t->l->diag->frame = NULL;
}

static void rank(struct twins *t, struct ranked *ranked, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        put_shape(t, &t->one, t->l->desc->surfaces.at[i]);
        ranked[i] = (struct ranked){hash_of(&t->one), (uint32_t)i};
    }
    if (n)
        qsort(ranked, n, sizeof *ranked, compare);
}

void lint_twins(const struct lint *l)
{
    const struct desc *d = l->desc;
    size_t n = d->surfaces.n;
    struct twins t = {.l = l,
                      .texture_of = mem_zalloc(d->textures.n, sizeof(double)),
                      .material_of = mem_zalloc(d->materials.n, sizeof(double))};
    struct ranked *ranked = mem_zalloc(n, sizeof *ranked);
    number_all(&t, d->textures.at, d->textures.n, &t.textures, t.texture_of);
    number_all(&t, d->materials.at, d->materials.n, &t.materials, t.material_of);
    rank(&t, ranked, n);
    for (size_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && ranked[end].hash == ranked[i].hash;)
            end++;
        compare_run(&t, ranked + i, end - i);
    }
    free(ranked);
    free(t.texture_of);
    free(t.material_of);
    vec_free(&t.one.list);
    vec_free(&t.other.list);
    map_free(&t.files);
    map_free(&t.textures);
    map_free(&t.materials);
    arena_free(&t.arena);
}

/* ---- lights ---- */

/* False for one whose shape is a surface of its own. */
static bool put_light(struct numbers *n, const struct desc_object *o)
{
    n->list.n = 0;
    put(n, o->kind);
    put_place(n, o->place);
    for (int i = 0; i < SCHEMA_PROPS; i++) {
        enum schema_prop_id id = (enum schema_prop_id)i;
        const struct desc_value *v = desc_get(o, id);
        bool known = v || (schema_props[id].has_default >> o->model & 1);
        if (!schema_has(o->kind, id) || (!known && schema_props[id].type != TYPE_POINTS))
            continue;
        put(n, i);
        if (schema_props[id].type == TYPE_SURFACE)
            return false;
        if (schema_props[id].type == TYPE_POINTS)
            put_points(n, o, id, false);
        else if (schema_props[id].type == TYPE_WORD)
            put(n, desc_word(o, id));
        else
            put_vector(n, desc_vector(o, id));
    }
    return true;
}

void lint_twin_lights(const struct lint *l)
{
    struct twins t = {.l = l};
    VEC(const struct desc_object *) firsts = {0}; /* by number in the map */
    for (size_t i = 0; i < l->desc->lights.n; i++) {
        const struct desc_object *o = l->desc->lights.at[i];
        if (vec3_is_zero(desc_vector(o, PROP_INTENSITY)) || !put_light(&t.one, o))
            continue;
        size_t number = (size_t)number_of_list(&t, &t.materials, &t.one);
        if (number > firsts.n) {
            vec_push(&firsts, o);
            continue;
        }
        const struct desc_object *first = firsts.at[number - 1];
        l->diag->frame = o->frame;
        struct diag_entry *e = diag_report(l->diag, DIAG_DUPLICATE_LIGHT, o->span,
                                           "this light is there twice: it costs twice as much as "
                                           "one of twice the intensity");
        diag_label_made(e, first->span, first->frame, "the first is here");
    }
    l->diag->frame = NULL;
    vec_free(&firsts);
    vec_free(&t.one.list);
    map_free(&t.materials);
    arena_free(&t.arena);
}
