/* The tree, the lists of bundles and the search of everything must agree to the last bit. */
#include "config.h"

#include "unit.h"

#define TRIES_SEED 2
#include "tries.h"

#include "accel/shaft.h"
#include "accel/wide.h"

#include <string.h>

static void add_triangle(struct geometry *g, uint32_t surface, struct vec3 a, struct vec3 b,
                         struct vec3 c)
{
    uint32_t v = geometry_add_vertex(g, a);
    geometry_add_vertex(g, b);
    geometry_add_vertex(g, c);
    geometry_add_triangle(g, surface, v, v + 1, v + 2);
}

/* Something of every kind: slivers, no area at all, coplanar on whole numbers, equal twins, huge.
 */
static void add_any(struct geometry *g, uint32_t i, double size)
{
    struct vec3 at = random_vector(10 * size), a = vec3_add(at, random_vector(size));
    struct vec3 b = vec3_add(at, random_vector(size));
    switch (below(9)) {
    case 0:
    case 1:
        geometry_add_sphere(g, i % 7, at, size * uniform(0.1, 2));
        break;
    case 2:
        geometry_add_cylinder(g, i % 7, at, a, size * uniform(0.01, 1));
        break;
    case 3:
        geometry_add_cylinder(g, i % 7, at, vec3(at.x, at.y + size, at.z), size);
        break;
    case 4:
        add_triangle(g, i % 7, at, a, vec3_mad(a, 1e-9, random_vector(size)));
        break;
    case 5:
        add_triangle(g, i % 7, at, a, at);
        break;
    case 6:
        at = vec3_scale(vec3(below(4), 1, below(4)), size);
        add_triangle(g, i % 7, at, vec3(at.x + 2 * size, size, at.z),
                     vec3(at.x, size, at.z + size));
        add_triangle(g, i % 7, at, vec3(at.x + 2 * size, size, at.z),
                     vec3(at.x, size, at.z + size));
        break;
    case 7:
        add_triangle(g, i % 7, random_vector(1000 * size), random_vector(1000 * size),
                     random_vector(1000 * size));
        break;
    default:
        add_triangle(g, i % 7, at, a, b);
    }
}

/* A point worth aiming at: corners, edges, rims, tangents, or nothing in particular. */
static struct vec3 any_target(const struct geometry *g, double size)
{
    if (g->vertices.n >= 3 && below(3) == 0) {
        const struct vec3 *v = g->vertices.at + 3 * below((uint32_t)g->vertices.n / 3);
        return vec3_mad(v[0], below(2) ? uniform(0, 1) : 0, vec3_sub(v[1 + below(2)], v[0]));
    }
    if (g->spheres.n > 0 && below(3) == 0) {
        const struct sphere *s = &g->spheres.at[below((uint32_t)g->spheres.n)];
        return vec3_mad(s->center, s->radius, vec3_normalize(random_vector(1)));
    }
    return random_vector(10 * size);
}

static struct ray any_ray(const struct geometry *g, double size)
{
    struct vec3 from = random_vector(size * (below(4) ? 20 : 1e5));
    struct ray ray = {.origin = from,
                      .direction = vec3_sub(any_target(g, size), from),
                      .t_max = below(3) ? RAY_UNBOUNDED : 1,
                      .from = PRIM_NONE,
                      .surface = below(8) ? SURFACE_NONE : below(7)};
    if (below(8) == 0) /* along an axis, or in a plane of two */
        ray.direction = vec3(below(3) - 1.0, below(3) - 1.0, below(2));
    if (below(2))
        ray.direction = vec3_scale(ray.direction, uniform(1e-3, 1e3) / size);
    return ray;
}

static bool same_hit(const struct hit *a, const struct hit *b)
{
    return a->prim == b->prim && (a->prim == PRIM_NONE || (a->t == b->t && a->part == b->part));
}

/* Whether triangles are cut. */
static double any_rays(void)
{
    return below(3) ? 1e12 : 0;
}

/* A tree for each instruction set of this machine. */
struct trees {
    const struct geometry *geometry;
    struct accel of[ISA_COUNT];
};

static struct trees trees_of(const struct geometry *g)
{
    struct trees t = {.geometry = g};
    for (int isa = 0; isa < ISA_COUNT; isa++)
        if (isa_available((enum isa)isa))
            accel_build_with(
                &t.of[isa], g,
                &(struct accel_options){.isa = (enum isa)isa, .threads = 2, .rays = any_rays()});
    return t;
}

static void trees_free(struct trees *t)
{
    for (int isa = 0; isa < ISA_COUNT; isa++)
        if (t->of[isa].geometry)
            accel_free(&t->of[isa]);
}

/* All trees see what the search of everything sees, which becomes *hit. */
static void compare(const struct trees *trees, const struct accel *brute, const struct ray *ray,
                    struct hit *hit)
{
    bool found = accel_closest(brute, ray, hit);
    ck_assert_int_eq(found, accel_any(brute, ray));
    for (int isa = 0; isa < ISA_COUNT; isa++) {
        const struct accel *tree = &trees->of[isa];
        struct hit other;
        if (!tree->geometry)
            continue;
        ck_assert_int_eq(found, accel_closest(tree, ray, &other));
        ck_assert_msg(same_hit(hit, &other), "%s: prim %u at %a, not %u at %a",
                      isa_name((enum isa)isa), other.prim, other.t, hit->prim, hit->t);
        ck_assert_int_eq(found, accel_any(tree, ray));
    }
}

START_TEST(trees_agree_with_brute_force)
{
    double size = pow(10, _i % 5 * 4 - 8);
    struct geometry g = {0};
    counter = (uint64_t)_i << 40;
    for (uint32_t i = 0, n = 1 + below(120); i < n; i++)
        add_any(&g, i, size);
    struct trees trees = trees_of(&g);
    struct accel brute;
    accel_build(&brute, &g, true);
    ck_assert(brute.nodes == NULL);
    for (int i = 0; i < TRIES(2000); i++) {
        struct ray ray = any_ray(&g, size);
        struct hit hit;
        compare(&trees, &brute, &ray, &hit);
        if (hit.prim == PRIM_NONE)
            continue;
        struct vec3 normal, p = geometry_hit_point(&g, &ray, &hit, &normal);
        struct ray spawned = any_ray(&g, size);
        spawned.direction = below(2) ? vec3_sub(any_target(&g, size), p) : random_vector(1);
        spawned.origin = p;
        spawned.from = hit.prim;
        spawned.spawned = true;
        compare(&trees, &brute, &spawned, &hit);
    }
    trees_free(&trees);
    accel_free(&brute);
    geometry_free(&g);
}
END_TEST

/* Of either kind. */
static struct accel some_tree(const struct geometry *g)
{
    struct accel tree;
    struct accel_options options = {
        .isa = below(2) ? isa_best() : ISA_PLAIN, .threads = 1, .rays = any_rays()};
    accel_build_with(&tree, g, &options);
    return tree;
}

static void batch_of(struct ray_batch *batch, const struct ray *rays, uint32_t n,
                     bool common_origin)
{
    memset(batch, 0, sizeof *batch);
    batch->n = n;
    batch->common_origin = common_origin;
    batch->spawned = rays[0].spawned;
    for (uint32_t i = 0; i < n; i++) {
        vec3_put(&batch->origin, i, rays[i].origin);
        vec3_put(&batch->direction, i, rays[i].direction);
        batch->t_max[i] = rays[i].t_max;
        batch->from[i] = rays[i].from;
    }
}

/* Endless rays from a box into a cone of directions. */
START_TEST(bundles_see_what_single_rays_see)
{
    double size = pow(10, _i % 5 * 4 - 8);
    struct geometry g = {0};
    counter = (uint64_t)_i << 40 | UINT64_C(1) << 30;
    for (uint32_t i = 0, n = 1 + below(60); i < n; i++)
        add_any(&g, i, size);
    struct accel tree = some_tree(&g);
    uint32_t usable = 0;
    for (int round = 0; round < TRIES(800); round++) {
        struct ray rays[BATCH];
        struct ray_batch batch;
        struct hit_batch hits;
        struct hit alone;
        struct box origins = box_empty(), directions = box_empty();
        struct vec3 from = random_vector(20 * size), to = any_target(&g, size);
        double spread = below(2) ? 0 : size * uniform(0, 1);
        bool spawned = below(2);
        for (int i = 0; i < BATCH; i++) {
            rays[i] = any_ray(&g, size);
            rays[i].surface = SURFACE_NONE;
            rays[i].spawned = spawned;
            rays[i].t_max = RAY_UNBOUNDED;
            rays[i].origin = vec3_add(from, random_vector(spread));
            rays[i].direction =
                vec3_normalize(vec3_sub(vec3_add(to, random_vector(size)), rays[i].origin));
            origins = box_add(origins, rays[i].origin);
            directions = box_add(directions, rays[i].direction);
        }
        struct target_list list;
        struct shaft shaft = shaft_of_rays(&tree, origins, directions);
        shaft_list(&tree, &shaft, &list);
        if (list.usable)
            shaft_sort(&tree, &shaft, &list);
        usable += list.usable;
        batch_of(&batch, rays, BATCH, spread == 0);
        bundle_closest(&tree, bundle_kernels_of(isa_best()), &batch, &list, &hits);
        for (int i = 0; i < BATCH; i++) {
            accel_closest(&tree, &rays[i], &alone);
            struct hit hit = hit_get(&hits, (uint32_t)i);
            ck_assert(same_hit(&hit, &alone));
        }
    }
    ck_assert_uint_gt(usable, TRIES(400));
    accel_free(&tree);
    geometry_free(&g);
}
END_TEST

/* Shadow rays from points of a surface to points of a box, and somewhat beyond. */
START_TEST(shafts_hold_all_shadow_rays)
{
    double size = pow(10, _i % 5 * 4 - 8);
    struct geometry g = {0};
    counter = (uint64_t)_i << 40 | UINT64_C(2) << 30;
    for (uint32_t i = 0, n = 1 + below(60); i < n; i++)
        add_any(&g, i, size);
    struct accel tree = some_tree(&g);
    for (int round = 0; round < TRIES(800); round++) {
        struct ray rays[BATCH];
        struct box p = box_empty(), q = box_empty();
        struct vec3 from = random_vector(20 * size), near = any_target(&g, size);
        struct vec3 lamp = random_vector(15 * size);
        double t_max = below(2) ? 1 : uniform(1, 3);
        uint32_t n = 0;
        for (int i = 0; i < BATCH; i++) {
            struct ray ray = any_ray(&g, size);
            struct hit hit;
            struct vec3 normal;
            ray.surface = SURFACE_NONE;
            ray.direction = vec3_sub(vec3_add(near, random_vector(0.5 * size)), from);
            ray.origin = from;
            if (!accel_closest(&tree, &ray, &hit))
                continue;
            struct vec3 to = vec3_add(lamp, random_vector(size));
            rays[n] = (struct ray){.origin = geometry_hit_point(&g, &ray, &hit, &normal),
                                   .t_max = uniform(0.5, t_max),
                                   .from = hit.prim,
                                   .surface = SURFACE_NONE,
                                   .spawned = true};
            rays[n].direction = vec3_sub(to, rays[n].origin);
            p = box_add(p, rays[n++].origin);
            q = box_add(q, to);
        }
        if (n == 0)
            continue;
        struct target_list list;
        struct shaft shaft = shaft_between(&tree, p, q, t_max);
        shaft_list(&tree, &shaft, &list);
        struct ray_batch batch;
        batch_of(&batch, rays, n, n == 1);
        uint64_t blocked = bundle_any(&tree, bundle_kernels_of(isa_best()), &batch, &list);
        for (uint32_t i = 0; i < n; i++)
            ck_assert_int_eq(blocked >> i & 1, accel_any(&tree, &rays[i]));
    }
    accel_free(&tree);
    geometry_free(&g);
}
END_TEST

/* As many as a wide leaf holds, and a few more and less. */
START_TEST(few_triangles_agree_with_brute_force)
{
    struct geometry g = {0};
    counter = (uint64_t)_i << 40 | UINT64_C(5) << 30;
    for (int i = 0; i < _i; i++)
        add_triangle(&g, 0, random_vector(1), random_vector(1), random_vector(1));
    struct trees trees = trees_of(&g);
    struct accel brute;
    accel_build(&brute, &g, true);
    for (int i = 0; i < 500; i++) {
        struct ray ray = any_ray(&g, 1);
        struct hit hit;
        compare(&trees, &brute, &ray, &hit);
    }
    trees_free(&trees);
    accel_free(&brute);
    geometry_free(&g);
}
END_TEST

START_TEST(equal_triangles_end)
{
    struct geometry g = {0};
    for (int k = 0; k < 3; k++)
        geometry_add_vertex(&g, vec3(k == 1, k == 2, 0));
    for (int i = 0; i < 100000; i++)
        geometry_add_triangle(&g, 0, 0, 1, 2);
    struct trees trees = trees_of(&g);
    struct accel brute;
    accel_build(&brute, &g, true);
    struct ray ray = {.origin = vec3(0.25, 0.25, 1),
                      .direction = vec3(0, 0, -1),
                      .t_max = 10,
                      .from = PRIM_NONE,
                      .surface = SURFACE_NONE};
    struct hit hit;
    compare(&trees, &brute, &ray, &hit);
    ck_assert_uint_eq(hit.prim, 0);
    ck_assert(hit.t == 1);
    trees_free(&trees);
    accel_free(&brute);
    geometry_free(&g);
}
END_TEST

START_TEST(nothing_is_hit_in_an_empty_geometry)
{
    struct geometry g = {0};
    struct trees trees = trees_of(&g);
    struct accel brute;
    accel_build(&brute, &g, true);
    struct ray ray = {
        .direction = vec3(0, 0, -1), .t_max = 10, .from = PRIM_NONE, .surface = SURFACE_NONE};
    struct hit hit;
    compare(&trees, &brute, &ray, &hit);
    ck_assert_uint_eq(hit.prim, PRIM_NONE);
    trees_free(&trees);
    accel_free(&brute);
}
END_TEST

/* A closed ball of 200 x 200 faces far from the origin. */
static void add_far_ball(struct geometry *g)
{
    enum { N = 200 };
    const double turn = 3.14159265358979323846 / N;
    for (int j = 0; j <= N; j++)
        for (int i = 0; i < N; i++)
            geometry_add_vertex(g, vec3(148376 + 2 * sin(j * turn) * cos(2 * i * turn),
                                        1234 + 2 * cos(j * turn),
                                        -223423 + 2 * sin(j * turn) * sin(2 * i * turn)));
    for (uint32_t i = 0; i < N; i++) /* one point each, whatever sin(pi) is */
        g->vertices.at[i] = vec3(148376, 1236, -223423),
        g->vertices.at[N * N + i] = vec3(148376, 1232, -223423);
    for (uint32_t j = 0; j < N; j++) {
        for (uint32_t i = 0; i < N; i++) {
            uint32_t a = j * N + i, b = j * N + (i + 1) % N;
            geometry_add_triangle(g, 0, a, b, b + N);
            geometry_add_triangle(g, 0, a, b + N, a + N);
        }
    }
}

/* What leaves of nothing but triangles are made of: a bumpy cloth of small ones, some without area,
 * some nine times over, somewhere far away, and a sphere so that not all leaves are. */
static void add_cloth(struct geometry *g, struct vec3 at, double size)
{
    enum { N = 20 };
    for (int i = 0; i < N * N; i++)
        geometry_add_vertex(g, vec3_add(at, vec3(size * (i % N), size * (i / N),
                                                 below(3) ? uniform(0, 2 * size) : 0)));
    for (uint32_t i = 0; i < N - 1; i++) {
        for (uint32_t j = 0; j < N - 1; j++) {
            uint32_t a = i * N + j, b = below(20) ? a + 1 : a;
            for (uint32_t k = 0; k < (below(40) ? 1 : 9); k++)
                geometry_add_triangle(g, below(7), a, b, a + N);
            geometry_add_triangle(g, below(7), b, a + N + 1, a + N);
        }
    }
    geometry_add_sphere(g, 0, vec3_add(at, vec3_all(size * N / 2)), size);
}

static struct vec3 strange_direction(struct vec3 d)
{
    switch (below(30)) {
    case 0:
        return vec3(NAN, d.y, d.z);
    case 1:
        return vec3_all(0);
    case 2:
        return vec3(-0.0, d.y, 1e-300);
    case 3:
        return vec3(0, d.y, d.z);
    case 4:
        return vec3_scale(d, 1e-290);
    case 5:
        return vec3(0, 0, d.z);
    case 6:
        return vec3(d.x, INFINITY, d.z);
    default:
        return d;
    }
}

START_TEST(cloth_agrees_with_brute_force)
{
    double size = pow(10, _i % 5 * 3 - 6);
    struct geometry g = {0};
    counter = (uint64_t)_i << 40 | UINT64_C(3) << 30;
    struct vec3 at = random_vector(_i % 2 ? 1e7 * size : size);
    add_cloth(&g, at, size);
    struct trees trees = trees_of(&g);
    struct accel brute;
    accel_build(&brute, &g, true);
    ck_assert_uint_gt(brute.target_count, 700);
    for (int i = 0; i < TRIES(2000); i++) {
        const struct vec3 *v = g.vertices.at + below((uint32_t)g.vertices.n - 20);
        struct vec3 to = vec3_mad(v[0], below(2) ? uniform(0, 1) : 0, vec3_sub(v[19], v[0]));
        struct ray ray = any_ray(&g, size);
        struct hit hit;
        ray.origin = vec3_add(at, random_vector(30 * size));
        ray.direction = strange_direction(vec3_sub(to, ray.origin));
        ray.t_max = below(2) ? RAY_UNBOUNDED : uniform(0.5, 1.5);
        compare(&trees, &brute, &ray, &hit);
        if (hit.prim == PRIM_NONE)
            continue;
        struct vec3 normal, p = geometry_hit_point(&g, &ray, &hit, &normal);
        ray = (struct ray){.origin = p,
                           .direction = vec3_sub(vec3_add(to, random_vector(3 * size)), p),
                           .t_max = RAY_UNBOUNDED,
                           .from = hit.prim,
                           .surface = SURFACE_NONE,
                           .spawned = true};
        compare(&trees, &brute, &ray, &hit);
    }
    trees_free(&trees);
    accel_free(&brute);
    geometry_free(&g);
}
END_TEST

/* Floats tell little of something small far from the middle, or of directions beyond their range.
 */
START_TEST(wide_ranges_agree_with_brute_force)
{
    struct geometry g = {0};
    counter = (uint64_t)_i << 40 | UINT64_C(5) << 30;
    double floor = pow(10, 2 * _i);
    struct vec3 at = random_vector(below(2) ? floor : 1);
    add_cloth(&g, at, 1);
    add_triangle(&g, 6, vec3(-floor, -4, -floor), vec3(floor, -4, -floor), vec3(0, -4, floor));
    geometry_add_sphere(&g, 5, vec3(0, -floor, 0), floor);
    struct trees trees = trees_of(&g);
    struct accel brute;
    accel_build(&brute, &g, true);
    for (int i = 0; i < TRIES(2000); i++) {
        const struct vec3 *v = g.vertices.at + below((uint32_t)g.vertices.n);
        struct ray ray = any_ray(&g, 1);
        struct hit hit;
        double length = below(2) ? 1 : pow(10, uniform(-150, 150));
        ray.origin = vec3_add(below(2) ? at : v[0], random_vector(below(2) ? 10 : floor));
        ray.direction = vec3_scale(vec3_normalize(vec3_sub(v[0], ray.origin)), length);
        ray.t_max = below(2) ? RAY_UNBOUNDED : uniform(0.5, 10) / length;
        compare(&trees, &brute, &ray, &hit);
    }
    trees_free(&trees);
    accel_free(&brute);
    geometry_free(&g);
}
END_TEST

START_TEST(closed_meshes_are_tight)
{
    struct geometry g = {0};
    add_far_ball(&g);
    struct trees trees = trees_of(&g);
    for (int i = 0; i < TRIES(60000); i++) {
        const struct vec3 *v = g.vertices.at + below((uint32_t)g.vertices.n - 201);
        struct vec3 to = i % 3 == 0 ? v[0] : vec3_mad(v[0], uniform(0, 1), vec3_sub(v[1], v[0]));
        struct ray ray = {.origin = vec3_add(vec3(148376, 1234, -223423), random_vector(0.9)),
                          .t_max = RAY_UNBOUNDED,
                          .from = PRIM_NONE,
                          .surface = SURFACE_NONE};
        ray.direction = i % 3 == 2 ? random_vector(1) : vec3_sub(to, ray.origin);
        struct hit hit;
        compare(&trees, &trees.of[ISA_PLAIN], &ray, &hit);
        ck_assert_uint_ne(hit.prim, PRIM_NONE);
    }
    trees_free(&trees);
    geometry_free(&g);
}
END_TEST

/* Rays from the eye to places near each other, or from there to a lamp, all one way, every way, or
 * longest along an axis that they run both ways. */
static uint32_t some_batch(const struct trees *trees, struct vec3 at, double size, struct ray *rays)
{
    const struct geometry *g = trees->geometry;
    const struct vec3 *v = g->vertices.at + below((uint32_t)g->vertices.n - 20);
    struct vec3 eye = vec3_add(at, random_vector(40 * size)), way = random_vector(1);
    struct vec3 lamp = vec3_add(at, random_vector((below(3) ? 40 : 1) * size));
    double spread = below(3) ? size * uniform(0, 3) : 0, reach = below(2) ? 1 : 1 - 0x1p-32;
    uint32_t kind = below(6), n = 0, wanted = 4 + below(BATCH - 3);
    bool strange = below(10) == 0;
    for (uint32_t i = 0; i < 3 * BATCH && n < wanted; i++) {
        struct vec3 to = vec3_add(below(3) ? v[0] : v[below(20)], random_vector(spread)), normal;
        struct ray ray = {.origin = eye,
                          .direction = vec3_sub(to, eye),
                          .t_max = RAY_UNBOUNDED,
                          .from = PRIM_NONE,
                          .surface = SURFACE_NONE};
        struct hit hit;
        if (kind > 0 && !accel_closest(&trees->of[ISA_PLAIN], &ray, &hit))
            continue;
        if (kind > 0) {
            ray.origin = geometry_hit_point(g, &ray, &hit, &normal);
            ray.from = hit.prim;
            ray.spawned = true;
            ray.direction = kind == 1   ? vec3_sub(lamp, ray.origin)
                            : kind == 2 ? way
                                        : vec3_add(way, random_vector(kind == 3 ? 0.2 : 2));
            ray.t_max = kind == 1 ? reach : RAY_UNBOUNDED;
        }
        if (kind == 5)
            ray.direction = vec3(below(2) ? 1 : -1, uniform(0.85, 0.99), uniform(-0.5, 0.5));
        if (strange)
            ray.direction = strange_direction(ray.direction);
        rays[n++] = ray;
    }
    return n;
}

START_TEST(packets_see_what_single_rays_see)
{
    double size = pow(10, _i % 5 * 3 - 6);
    struct geometry g = {0};
    counter = (uint64_t)_i << 40 | UINT64_C(4) << 30;
    struct vec3 at = random_vector(_i % 2 ? 1e7 * size : size);
    add_cloth(&g, at, size);
    for (uint32_t i = 0; _i % 3 == 0 && i < 40; i++)
        add_any(&g, i, size);
    struct trees trees = trees_of(&g);
    uint32_t traced = 0, tried = 0;
    for (int round = 0; round < TRIES(150); round++) {
        struct ray rays[BATCH];
        struct hit expected[BATCH];
        struct ray_batch batch;
        struct hit_batch hits;
        uint32_t n = some_batch(&trees, at, size, rays);
        if (n == 0)
            continue;
        batch_of(&batch, rays, n, !rays[0].spawned && below(2));
        for (uint32_t i = 0; i < n; i++)
            accel_closest(&trees.of[ISA_PLAIN], &rays[i], &expected[i]);
        for (int isa = ISA_GENERIC; isa < ISA_COUNT; isa++) {
            const struct accel *a = &trees.of[isa];
            if (!a->geometry)
                continue;
            tried++;
            if (!a->wide->kernels->packet(a, &batch, false, &hits))
                continue;
            traced++;
            for (uint32_t i = 0; i < n; i++) {
                struct hit hit = hit_get(&hits, i);
                ck_assert(same_hit(&hit, &expected[i]));
            }
            bool any = a->wide->kernels->packet(a, &batch, true, &hits);
            for (uint32_t i = 0; i < n && any; i++)
                ck_assert_int_eq(hits.prim[i] != PRIM_NONE, expected[i].prim != PRIM_NONE);
        }
    }
    ck_assert_uint_gt(6 * traced, tried);
    trees_free(&trees);
    geometry_free(&g);
}
END_TEST

Suite *bvh_suite(void)
{
    Suite *s = suite_create("bvh");
    TCase *c = tcase_create("bvh");
    tcase_set_timeout(c, 120);
    tcase_add_loop_test(c, trees_agree_with_brute_force, 0, 50);
    tcase_add_loop_test(c, bundles_see_what_single_rays_see, 0, 10);
    tcase_add_loop_test(c, shafts_hold_all_shadow_rays, 0, 10);
    tcase_add_loop_test(c, cloth_agrees_with_brute_force, 0, 10);
    tcase_add_loop_test(c, wide_ranges_agree_with_brute_force, 0, 10);
    tcase_add_loop_test(c, packets_see_what_single_rays_see, 0, 30);
    tcase_add_loop_test(c, few_triangles_agree_with_brute_force, 1, 20);
    tcase_add_test(c, equal_triangles_end);
    tcase_add_test(c, nothing_is_hit_in_an_empty_geometry);
    tcase_add_test(c, closed_meshes_are_tight);
    suite_add_tcase(s, c);
    return s;
}
