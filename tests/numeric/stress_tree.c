/* The tree of boxes and the kernels of each instruction set against the search of everything; input
 * that has no shape. */
#include "config.h"

#include "stress.h"

#include "accel/bundle.h"

#include <string.h>

/* ---- scenes ---------------------------------------------------------------------------------- */

static void add_triangle(struct geometry *g, struct vec3 a, struct vec3 b, struct vec3 c)
{
    uint32_t v = geometry_add_vertex(g, a);
    geometry_add_vertex(g, b);
    geometry_add_vertex(g, c);
    geometry_add_triangle(g, 0, v, v + 1, v + 2);
}

/* Slivers, triangles without area, equal ones, and such as are much larger than the rest. */
static void add_odd_triangle(struct dice *d, struct geometry *g, struct vec3 at, double size)
{
    struct vec3 a = vec3_add(at, random_vector(d, size)), b = vec3_add(at, random_vector(d, size));
    switch (below(d, 5)) {
    case 0:
        add_triangle(g, at, a, vec3_mad(a, 1e-12, random_vector(d, size)));
        break;
    case 1:
        add_triangle(g, at, a, at);
        break;
    case 2:
        add_triangle(g, at, a, b);
        add_triangle(g, at, a, b);
        break;
    case 3:
        add_triangle(g, at, vec3_mad(at, 1e4, vec3_sub(a, at)), vec3_mad(at, 1e4, vec3_sub(b, at)));
        break;
    default:
        add_triangle(g, at, a, b);
    }
}

enum scene { SCENE_TRIANGLES, SCENE_SOLIDS, SCENE_GLOBES, SCENE_INSTANCES };

static void add_solids(struct dice *d, struct geometry *g, struct vec3 at, double size)
{
    geometry_add_sphere(g, 0, at, size * uniform(d, 0.01, 2));
    geometry_add_cylinder(g, 0, at, vec3_mad(at, size, random_direction(d)),
                          size * uniform(d, 0.01, 1));
}

static void fill_scene(struct dice *d, struct geometry *g, enum scene scene, double size)
{
    uint32_t prototype = geometry_add_prototype(g);
    add_globe(&g->prototypes.at[prototype]->shapes, vec3_all(0), 1, 4);
    for (uint32_t n = 1 + below(d, 60); n > 0; n--) {
        struct vec3 at = random_vector(d, 10 * size);
        if (scene == SCENE_TRIANGLES)
            add_odd_triangle(d, g, at, size);
        else if (scene == SCENE_SOLIDS)
            add_solids(d, g, at, size);
        else if (scene == SCENE_GLOBES && n % 8 == 0)
            add_globe(g, at, size, 4);
        else {
            struct affine map = random_map(d, size, magnitude(d, 1, 1000), 10);
            bool ball = below(d, 2);
            geometry_add_instance(g, 0, ball ? PROTOTYPE_SOLIDS : prototype, ball ? 0 : PRIM_NONE,
                                  &map);
        }
    }
}

/* ---- rays ------------------------------------------------------------------------------------ */

static struct vec3 target_in(struct dice *d, const struct geometry *g, double size)
{
    if (g->vertices.n > 0 && below(d, 2)) {
        const uint32_t *v = g->triangles.at[below(d, (uint32_t)g->triangles.n)].vertex;
        struct vec3 a = g->vertices.at[v[0]], b = g->vertices.at[v[1]];
        return vec3_mad(a, below(d, 2) ? uniform(d, 0, 1) : 0, vec3_sub(b, a));
    }
    return random_vector(d, 10 * size);
}

/* From somewhere in the plane of a triangle, or near it, over the triangle. */
static struct ray grazing_ray(struct dice *d, const struct geometry *g, double size)
{
    const uint32_t *v = g->triangles.at[below(d, (uint32_t)g->triangles.n)].vertex;
    struct vec3 a = g->vertices.at[v[0]], b = g->vertices.at[v[1]], c = g->vertices.at[v[2]];
    struct vec3 from = vec3_mad(a, magnitude(d, 1, 1e5), vec3_sub(b, a));
    from = vec3_add(from, random_vector(d, size * magnitude(d, 1e-16, 1e-6)));
    return ray_between(from, vec3_mad(b, uniform(d, 0, 1), vec3_sub(c, b)));
}

static struct ray any_ray(struct dice *d, const struct geometry *g, double size)
{
    static const double odd[] = {0, -0.0, 1, -1, INFINITY, NAN};
    if (g->triangles.n > 0 && below(d, 4) == 0)
        return grazing_ray(d, g, size);
    struct vec3 from = random_vector(d, size * (below(d, 4) ? 20 : 1e5));
    struct ray ray = ray_between(from, target_in(d, g, size));
    if (below(d, 8) == 0)
        ray.t_max = uniform(d, 0, 2);
    if (below(d, 8) == 0) /* along an axis, in a plane of two, or no direction at all */
        ray.direction = vec3(odd[below(d, 4)], odd[below(d, 4)], odd[below(d, 4)]);
    if (below(d, 64) == 0)
        ray.direction = vec3(odd[below(d, 6)], odd[below(d, 6)], odd[below(d, 6)]);
    if (below(d, 2))
        ray.direction = vec3_scale(ray.direction, magnitude(d, 1e-3, 1e3) / size);
    return ray;
}

static bool same_hit(const struct hit *a, const struct hit *b)
{
    return a->prim == b->prim && (a->prim == PRIM_NONE || (a->t == b->t && a->part == b->part));
}

/* ---- trees ----------------------------------------------------------------------------------- */

static void compare(const struct accel *tree, const struct accel *brute, const struct ray *ray,
                    struct hit *hit, struct tally *tally)
{
    struct hit other;
    bool found = accel_closest(brute, ray, &other);
    tally->wrong += accel_closest(tree, ray, hit) != found || !same_hit(hit, &other) ||
                    accel_any(tree, ray) != found || accel_any(brute, ray) != found;
    tally->cases++;
}

enum { RAYS_A_SCENE = 2000 };

static void try_scene(struct dice *d, enum scene scene, struct tally *tally)
{
    struct geometry g = {0};
    struct accel tree, brute;
    double size = magnitude(d, 1e-8, 1e8);
    fill_scene(d, &g, scene, size);
    struct accel_options options = {.isa = isa_best(), .threads = 1, .rays = below(d, 2) * 1e12};
    if (below(d, 2))
        accel_build_with(&tree, &g, &options);
    else
        accel_build(&tree, &g, false);
    accel_build(&brute, &g, true);
    for (int i = 0; i < RAYS_A_SCENE / 2; i++) {
        struct ray ray = any_ray(d, &g, size);
        struct hit hit;
        compare(&tree, &brute, &ray, &hit, tally);
        if (hit.prim == PRIM_NONE)
            continue;
        struct vec3 normal;
        struct ray next = any_ray(d, &g, size);
        next.origin = geometry_hit_point(&g, &ray, &hit, &normal);
        next.from = hit.prim;
        next.spawned = true;
        compare(&tree, &brute, &next, &hit, tally);
    }
    accel_free(&tree);
    accel_free(&brute);
    geometry_free(&g);
}

static void try_triangles(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_scene(d, SCENE_TRIANGLES, tally);
}

static void try_solids(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_scene(d, SCENE_SOLIDS, tally);
}

static void try_globes(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_scene(d, SCENE_GLOBES, tally);
}

static void try_instances(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_scene(d, SCENE_INSTANCES, tally);
}

/* No box tree can part them: what counts is that it is built and walked, and the first wins. */
static void try_equal(struct dice *d, uint64_t cases, struct tally *tally)
{
    struct geometry g = {0};
    struct accel tree;
    for (int k = 0; k < 3; k++)
        geometry_add_vertex(&g, vec3(k == 1, k == 2, 0.5));
    for (int i = 0; i < 100000; i++)
        geometry_add_triangle(&g, 0, 0, 1, 2);
    accel_build(&tree, &g, false);
    for (uint64_t i = 0; i < cases; i++) {
        struct hit hit;
        struct vec3 to = vec3(uniform(d, 0, 0.5), uniform(d, 0, 0.5), 0.5);
        struct ray ray = ray_between(vec3(0, 0, -1), to);
        tally->wrong += !accel_closest(&tree, &ray, &hit) || hit.prim != 0;
    }
    tally->cases += cases;
    accel_free(&tree);
    geometry_free(&g);
}

/* ---- kernels --------------------------------------------------------------------------------- */

static void fill_batch(struct dice *d, struct ray_batch *batch, const struct geometry *g,
                       double size)
{
    struct vec3 from = random_vector(d, 20 * size);
    memset(batch, 0, sizeof *batch);
    batch->n = 1 + below(d, BATCH);
    batch->spawned = below(d, 2);
    batch->common_origin = below(d, 2);
    for (uint32_t i = 0; i < batch->n; i++) {
        struct ray ray = any_ray(d, g, size);
        vec3_put(&batch->origin, i, batch->common_origin ? from : ray.origin);
        vec3_put(&batch->direction, i, ray.direction);
        batch->t_max[i] = ray.t_max;
        batch->from[i] = below(d, 4) ? PRIM_NONE : below(d, (uint32_t)g->prims.n);
    }
}

static void compare_kernels(const struct geometry *g, const struct ray_batch *rays,
                            const struct target_list *list, struct tally *tally)
{
    struct hit_batch expected, hits;
    bundle_kernels_of(ISA_PLAIN)->closest(g, rays, list, &expected);
    for (int isa = ISA_PLAIN; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        bundle_kernels_of((enum isa)isa)->closest(g, rays, list, &hits);
        uint64_t blocked = bundle_kernels_of((enum isa)isa)->any(g, rays, list);
        for (uint32_t i = 0; i < rays->n; i++) {
            struct hit a = hit_get(&hits, i), b = hit_get(&expected, i);
            tally->wrong += !same_hit(&a, &b) || (blocked >> i & 1) != (b.prim != PRIM_NONE);
        }
    }
    tally->cases += rays->n;
}

static void try_kernels(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases) {
        struct geometry g = {0};
        struct target_list list = {.usable = true};
        double size = magnitude(d, 1e-8, 1e8);
        fill_scene(d, &g, below(d, 2) ? SCENE_TRIANGLES : SCENE_SOLIDS, size);
        for (; list.n < g.prims.n && list.n < TARGET_LIST_LIMIT; list.n++)
            list.at[list.n] = target_of(&g, list.n);
        for (int i = 0; i < 20; i++) {
            struct ray_batch rays;
            fill_batch(d, &rays, &g, size);
            compare_kernels(&g, &rays, &list, tally);
        }
        geometry_free(&g);
    }
}

const struct row rows_tree[] = {
    {"tree and brute force: triangles, slivers, none", "", 0, 30000, 10000000, try_triangles,
     false},
    {"tree and brute force: spheres and cylinders", "", 0, 40000, 10000000, try_solids, false},
    {"tree and brute force: meshes and instances", "", 0, 12000, 2000000, try_globes, false},
    {"tree and brute force: instances", "", 0, 16000, 10000000, try_instances, false},
    {"1e5 equal triangles", "", 0, 4, 10000, try_equal, false},
    {"kernels of every instruction set, bit by bit", "", 0, 100000, 100000000, try_kernels, false},
    {0},
};
