/* Instances: maps and their inverses, rays through them, rays that start on them, and trees in
 * trees. */
#include "config.h"

#include "unit.h"

#define TRIES_SEED 3
#include "tries.h"

#include "accel/bundle.h"
#include "accel/shaft.h"
#include "accel/wide.h"
#include "scene/geometry.h"

#include <float.h>

#define EPS 0x1p-53
#define COUNT(a) (int)(sizeof(a) / sizeof *(a))

/* Turned, scaled by up to `uneven` more along one axis than along another, turned again, and moved
 * by up to `far` times its size; every other one is a mirror. */
static struct affine random_map(double size, double uneven, double far)
{
    struct affine first = affine_rotation(random_vector(180));
    struct affine last = affine_rotation(random_vector(180));
    struct affine scale =
        affine_scaling(vec3(size * (below(2) ? 1 : -1), size * pow(uneven, -uniform(0, 1)),
                            size * pow(uneven, -uniform(0, 1))));
    struct affine move = affine_translation(random_vector(size * far));
    struct affine m = affine_times(&scale, &first);
    m = affine_times(&last, &m);
    return affine_times(&move, &m);
}

/* ---- maps ------------------------------------------------------------------------------------ */

START_TEST(inverses_undo)
{
    for (int i = 0; i < TRIES(20000); i++) {
        double uneven = pow(10, uniform(0, 6)), size = pow(10, uniform(-100, 100));
        struct affine m = random_map(size, uneven, 10), w;
        ck_assert(affine_invert(&m, &w));
        struct vec3 p = random_vector(1);
        struct vec3 back = affine_point(&w, affine_point(&m, p));
        ck_assert(vec3_largest(vec3_sub(back, p)) <= 2000 * EPS * uneven);
    }
}
END_TEST

static const struct {
    struct affine map;
    bool inverse, similar, keeps;
    double factor;
} maps[] = {
    {{{{1, 0, 0, 5}, {0, 1, 0, 6}, {0, 0, 1, 7}}}, true, true, true, 1},
    {{{{3, 0, 0, 5}, {0, 3, 0, 6}, {0, 0, 3, 7}}}, true, true, true, 3},
    {{{{0, -2, 0, 0}, {2, 0, 0, 0}, {0, 0, 2, 0}}}, true, true, false, 2},
    {{{{-3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}}}, true, true, false, 3},
    {{{{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3.0001, 0}}}, true, false, false, 0},
    {{{{1, 1, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, true, false, false, 0},
    {{{{1, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 1, 0}}}, false, false, false, 0},
    {{{{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 0, 1, 0}}}, false, false, false, 0},
    {{{{1, 1, 0, 0}, {1, 1 + DBL_EPSILON, 0, 0}, {0, 0, 1, 0}}}, false, false, false, 0},
    {{{{1e-200, 0, 0, 0}, {0, 1e200, 0, 0}, {0, 0, 1, 0}}}, true, false, false, 0},
    {{{{1e-200, 0, 0, 1e200}, {0, 1e-200, 0, 0}, {0, 0, 1e-200, 0}}}, false, true, true, 1e-200},
    {{{{1, 0, 0, 0}, {0, NAN, 0, 0}, {0, 0, 1, 0}}}, false, false, false, 0},
    {{{{1, 0, 0, INFINITY}, {0, 1, 0, 0}, {0, 0, 1, 0}}}, false, true, true, 1},
};

START_TEST(maps_are_told_apart)
{
    struct affine inverse;
    double factor;
    const struct affine *m = &maps[_i].map;
    ck_assert_int_eq(affine_invert(m, &inverse), maps[_i].inverse);
    ck_assert_int_eq(affine_keeps_directions(m), maps[_i].keeps);
    if (maps[_i].factor == 1e-200) /* its square is 0 */
        return;
    ck_assert_int_eq(affine_is_similarity(m, &factor), maps[_i].similar);
    if (maps[_i].similar)
        ck_assert(factor == maps[_i].factor);
}
END_TEST

START_TEST(turns_are_similarities)
{
    double factor;
    for (int i = 0; i < 10000; i++) {
        struct affine m = random_map(7, 1, 10), n = random_map(0.25, 1, 10);
        m = affine_times(&m, &n);
        ck_assert(affine_is_similarity(&m, &factor));
        ck_assert_double_eq_tol(factor, 1.75, 1e-14);
    }
}
END_TEST

/* ---- rays ------------------------------------------------------------------------------------ */

static uint32_t add_cube(struct geometry *g, struct vec3 at)
{
    static const uint8_t face[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                        {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                        {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    uint32_t number = geometry_add_prototype(g);
    struct geometry *shapes = &g->prototypes.at[number]->shapes;
    for (int k = 0; k < 8; k++)
        geometry_add_vertex(shapes,
                            vec3_add(at, vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
    for (int k = 0; k < 12; k++)
        geometry_add_triangle(shapes, 0, face[k][0], face[k][1], face[k][2]);
    return number;
}

/* A ball, a cylinder or a cube, all about as large as 1 around their origin. */
static void add_any(struct geometry *g, uint32_t surface, int kind, const struct affine *map)
{
    struct geometry *solids = geometry_solids(g);
    uint32_t only = 0, prototype = PROTOTYPE_SOLIDS;
    if (kind == 1) {
        struct vec3 axis = random_direction();
        only = (uint32_t)solids->prims.n;
        geometry_add_cylinder(solids, 0, vec3_scale(axis, -uniform(0.3, 1)), axis, uniform(0.3, 1));
    } else if (kind == 2) {
        prototype = g->prototypes.n > 1 ? 1 : add_cube(g, vec3_all(0));
        only = PRIM_NONE;
    }
    ck_assert(geometry_add_instance(g, surface, prototype, only, map));
}

static struct vec3 origin_of(const struct affine *m)
{
    return vec3(m->m[0][3], m->m[1][3], m->m[2][3]);
}

static struct ray ray_to(struct vec3 origin, struct vec3 target)
{
    return (struct ray){.origin = origin,
                        .direction = vec3_sub(target, origin),
                        .t_max = RAY_UNBOUNDED,
                        .from = PRIM_NONE,
                        .surface = SURFACE_NONE};
}

/* From the hit, nothing is hit outwards, and something inwards. */
static void check_spawned(const struct geometry *g, const struct ray *ray, const struct hit *hit,
                          struct vec3 middle)
{
    struct vec3 normal, p = geometry_hit_point(g, ray, hit, &normal);
    struct hit other;
    ck_assert(geometry_lies_on(g, hit->prim, p, vec3_largest(p)));
    ck_assert(vec3_dot(normal, vec3_sub(p, middle)) > 0); /* outwards, mirrored or not */
    for (int i = 0; i < 4; i++) {
        struct ray out = {.origin = p,
                          .direction = random_direction(),
                          .t_max = RAY_UNBOUNDED,
                          .from = hit->prim,
                          .surface = SURFACE_NONE,
                          .spawned = true};
        double along = vec3_dot(out.direction, normal);
        if (fabs(along) < 1e-6)
            continue;
        if (along < 0)
            out.direction = vec3_neg(out.direction);
        ck_assert_msg(!shoot(g, &out, &other), "self-hit at t = %g", other.t);
    }
    struct ray in = ray_to(p, middle);
    in.from = hit->prim;
    in.spawned = true;
    ck_assert_msg(shoot(g, &in, &other), "leak");
}

/* Of any size and unevenness, near and far from the origin.  _i: the kind. */
START_TEST(spawned_rays_leave_instances)
{
    int hits = 0;
    counter = (uint64_t)_i << 40;
    for (int i = 0; i < TRIES(60000); i++) {
        struct geometry g = {0};
        double size = pow(10, uniform(-8, 8)), uneven = pow(10, uniform(0, 3));
        struct affine map = random_map(size, uneven, i % 2 ? 3 : 1000);
        add_any(&g, 0, _i, &map);
        struct vec3 middle = origin_of(&map);
        struct vec3 to = affine_point(&map, random_vector(0.5));
        struct ray ray = ray_to(vec3_mad(middle, 30 * size, random_direction()), to);
        struct hit hit;
        if (shoot(&g, &ray, &hit)) {
            check_spawned(&g, &ray, &hit, middle);
            hits++;
        }
        geometry_free(&g);
    }
    ck_assert_int_gt(hits, TRIES(30000));
}
END_TEST

/* A shape far from the origin of its space, which its map brings back: what was lost out there must
 * not come back as self-hits. */
START_TEST(far_shapes_come_back)
{
    for (int i = 0; i < TRIES(30000); i++) {
        struct geometry g = {0};
        struct vec3 at = random_vector(pow(10, uniform(3, 8)));
        struct affine map = random_map(1, 1000, 0), back = affine_translation(vec3_neg(at));
        map = affine_times(&map, &back);
        uint32_t number = add_cube(&g, at);
        ck_assert(geometry_add_instance(&g, 0, number, PRIM_NONE, &map));
        struct ray ray = ray_to(vec3_scale(random_direction(), 30),
                                affine_point(&map, vec3_add(at, random_vector(0.3))));
        struct hit hit;
        ck_assert(shoot(&g, &ray, &hit));
        check_spawned(&g, &ray, &hit, affine_point(&map, at));
        geometry_free(&g);
    }
}
END_TEST

/* The hit point, put into the shape's space by wide arithmetic, is on the unit sphere as nearly as
 * the map's unevenness allows. */
START_TEST(ellipsoid_error_is_bounded)
{
    for (int i = 0; i < TRIES(50000); i++) {
        struct geometry g = {0};
        double uneven = pow(10, uniform(0, 3)), far = pow(10, uniform(0.5, 6));
        struct affine map = random_map(1, uneven, 3);
        add_any(&g, 0, 0, &map);
        const struct affine *w = &g.instances.at[0].to_shape;
        struct vec3 from = vec3_mad(origin_of(&map), far, random_direction());
        struct ray ray = ray_to(from, affine_point(&map, random_vector(0.4)));
        struct hit hit;
        ck_assert(shoot(&g, &ray, &hit));
        __float128 square = 0;
        struct vec3 normal, p = geometry_hit_point(&g, &ray, &hit, &normal);
        for (int k = 0; k < 3; k++) {
            __float128 x = (__float128)w->m[k][0] * p.x + (__float128)w->m[k][1] * p.y +
                           (__float128)w->m[k][2] * p.z + w->m[k][3];
            square += x * x;
        }
        double off = fabs((double)(square - 1));
        ck_assert_msg(off <= 400 * EPS * uneven, "off by %g eps", off / EPS / uneven);
        /* and along the ray, which is as far off as it is long */
        struct vec3 q = vec3_mad(ray.origin, hit.t, ray.direction);
        ck_assert(vec3_length(vec3_sub(p, q)) <= 100 * EPS * far * uneven);
        geometry_free(&g);
    }
}
END_TEST

/* An instance of a mesh is hit where its copy is. */
START_TEST(instances_are_like_copies)
{
    for (int i = 0; i < TRIES(3000); i++) {
        struct geometry g = {0}, copy = {0};
        struct affine map = random_map(1, 10, 3);
        uint32_t number = add_cube(&g, vec3_all(0));
        const struct geometry *shapes = &g.prototypes.at[number]->shapes;
        ck_assert(geometry_add_instance(&g, 0, number, PRIM_NONE, &map));
        for (size_t k = 0; k < shapes->vertices.n; k++)
            geometry_add_vertex(&copy, affine_point(&map, shapes->vertices.at[k]));
        for (size_t k = 0; k < shapes->triangles.n; k++) {
            const uint32_t *v = shapes->triangles.at[k].vertex;
            geometry_add_triangle(&copy, 0, v[0], v[1], v[2]);
        }
        struct box a = geometry_bounds(&g), b = geometry_bounds(&copy);
        ck_assert(vec3_largest(vec3_sub(a.lo, b.lo)) < 1e-13);
        ck_assert(vec3_largest(vec3_sub(a.hi, b.hi)) < 1e-13);
        for (int k = 0; k < 20; k++) {
            struct ray ray = ray_to(random_vector(30), affine_point(&map, random_vector(0.9)));
            struct hit one, other;
            struct vec3 n, m;
            ck_assert(shoot(&g, &ray, &one) && shoot(&copy, &ray, &other));
            ck_assert(fabs(one.t - other.t) < 1e-11);
            struct spot spot = geometry_spot(&g, &one);
            ck_assert(spot.instance == &g.instances.at[0] && spot.geometry == shapes);
            if (spot.prim != other.prim)
                continue; /* an edge, or both halves of a side */
            geometry_weights(&g, &ray, &one);
            geometry_weights(&copy, &ray, &other);
            ck_assert(fabs(one.b1 - other.b1) < 1e-10 && fabs(one.b2 - other.b2) < 1e-10);
            struct vec3 p = geometry_hit_point(&g, &ray, &one, &n);
            struct vec3 q = geometry_hit_point(&copy, &ray, &other, &m);
            ck_assert(vec3_largest(vec3_sub(p, q)) < 1e-11);
            double side = affine_determinant(&map) < 0 ? -1 : 1;
            ck_assert(vec3_largest(vec3_sub(n, vec3_scale(m, side))) < 1e-12);
        }
        geometry_free(&g);
        geometry_free(&copy);
    }
}
END_TEST

/* Every point of a shape's surface is in the box, and the box is not larger than need be. */
START_TEST(boxes_are_tight)
{
    for (int i = 0; i < TRIES(800); i++) {
        struct geometry g = {0};
        struct affine map = random_map(1, 30, 3);
        add_any(&g, 0, _i, &map);
        struct box box = geometry_bounds(&g), seen = box_empty();
        struct hit hit;
        struct vec3 n;
        for (int k = 0; k < 2000; k++) {
            struct ray ray = ray_to(vec3_mad(origin_of(&map), 20, random_direction()),
                                    affine_point(&map, random_vector(0.4)));
            if (shoot(&g, &ray, &hit))
                seen = box_add(seen, geometry_hit_point(&g, &ray, &hit, &n));
        }
        struct vec3 size = vec3_sub(box.hi, box.lo);
        struct vec3 below_lo = vec3_sub(box.lo, seen.lo), above_hi = vec3_sub(seen.hi, box.hi);
        double most = fmax(fmax(below_lo.x, below_lo.y), fmax(below_lo.z, above_hi.x));
        most = fmax(most, fmax(above_hi.y, above_hi.z));
        ck_assert_msg(most <= 1e-12, "%g outside", most);
        for (int k = 0; k < 2000; k++) /* of a ball, evenly all around */
            seen = box_add(seen, affine_point(&map, random_direction()));
        struct vec3 got = vec3_sub(seen.hi, seen.lo);
        if (_i == 0)
            ck_assert(got.x > 0.9 * size.x && got.y > 0.9 * size.y && got.z > 0.9 * size.z);
        geometry_free(&g);
    }
}
END_TEST

/* ---- trees ----------------------------------------------------------------------------------- */

static void fill_scene(struct geometry *g, double size, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        struct affine map = random_map(size, pow(10, uniform(0, below(4) ? 2 : 7)), 10);
        int kind = i == 0 ? 0 : (int)below(5);
        if (kind < 3) {
            add_any(g, i % 7, kind, &map);
        } else if (kind == 3) {
            geometry_add_sphere(g, i % 7, random_vector(10 * size), size);
        } else {
            uint32_t v = geometry_add_vertex(g, random_vector(10 * size));
            geometry_add_vertex(g, random_vector(10 * size));
            geometry_add_vertex(g, random_vector(10 * size));
            geometry_add_triangle(g, i % 7, v, v + 1, v + 2);
        }
    }
}

static struct ray any_ray(double size)
{
    struct vec3 from = random_vector(size * (below(4) ? 20 : 1e4));
    struct ray ray = ray_to(from, random_vector(10 * size));
    ray.surface = below(8) ? SURFACE_NONE : below(7);
    if (below(2))
        ray.direction = vec3_scale(ray.direction, uniform(1e-3, 1e3) / size);
    if (below(3) == 0)
        ray.t_max = uniform(0, 1);
    return ray;
}

/* Past the point of an instance's ball that lies farthest along an axis, across that axis, and
 * outside by next to nothing: what rounding errors make of it must not depend on the box. */
static struct ray grazing_ray(const struct geometry *g, double size)
{
    const struct instance *i = &g->instances.at[below((uint32_t)g->instances.n)];
    int axis = (int)below(3);
    const double *row = i->to_world.m[axis];
    struct vec3 to = affine_point(&i->to_world, vec3_normalize(vec3(row[0], row[1], row[2])));
    struct vec3 away = random_vector(size * pow(10, uniform(0, 6)));
    double outside = size * pow(10, -uniform(3, 14));
    to = vec3_add(to,
                  vec3(axis == 0 ? outside : 0, axis == 1 ? outside : 0, axis == 2 ? outside : 0));
    away = vec3(axis == 0 ? 0 : away.x, axis == 1 ? 0 : away.y, axis == 2 ? 0 : away.z);
    return ray_to(vec3_add(to, away), to);
}

static void compare(const struct accel *tree, const struct accel *brute, const struct ray *ray,
                    struct hit *hit)
{
    struct hit other;
    bool found = accel_closest(tree, ray, hit);
    ck_assert_int_eq(found, accel_closest(brute, ray, &other));
    ck_assert_msg(hit->prim == other.prim &&
                      (!found || (hit->t == other.t && hit->part == other.part)),
                  "prim %u at %a, not %u at %a", hit->prim, hit->t, other.prim, other.t);
    ck_assert_int_eq(found, accel_any(tree, ray));
    ck_assert_int_eq(found, accel_any(brute, ray));
}

START_TEST(trees_agree_with_brute_force)
{
    double size = pow(10, _i % 5 * 4 - 8);
    struct geometry g = {0};
    counter = (uint64_t)_i << 40;
    fill_scene(&g, size, 1 + below(80));
    struct accel tree, brute;
    enum isa isa = (enum isa)(_i % ISA_COUNT);
    accel_build_with(
        &tree, &g,
        &(struct accel_options){.isa = isa_available(isa) ? isa : isa_best(), .threads = 1});
    accel_build(&brute, &g, true);
    for (int i = 0; i < TRIES(6000); i++) {
        struct ray ray = i % 3 && g.instances.n ? grazing_ray(&g, size) : any_ray(size);
        struct hit hit;
        compare(&tree, &brute, &ray, &hit);
        if (hit.prim == PRIM_NONE)
            continue;
        struct vec3 normal;
        struct ray spawned = any_ray(size);
        spawned.origin = geometry_hit_point(&g, &ray, &hit, &normal);
        spawned.from = hit.prim;
        spawned.spawned = true;
        compare(&tree, &brute, &spawned, &hit);
    }
    accel_free(&tree);
    accel_free(&brute);
    geometry_free(&g);
}
END_TEST

/* What a shaft's list leaves out is hit by none of its rays, instances too. */
START_TEST(shafts_leave_nothing_out)
{
    double size = pow(10, _i % 5 * 4 - 8);
    struct geometry g = {0};
    counter = (uint64_t)_i << 40 | UINT64_C(1) << 30;
    fill_scene(&g, size, 1 + below(40));
    struct accel tree;
    accel_build(&tree, &g, false);
    uint32_t usable = 0;
    for (int round = 0; round < TRIES(2000); round++) {
        struct vec3 from = random_vector(20 * size), to = random_vector(10 * size);
        struct ray rays[16];
        struct box origins = box_empty(), directions = box_empty();
        for (int i = 0; i < COUNT(rays); i++) {
            rays[i] = ray_to(vec3_add(from, random_vector(0.1 * size)),
                             vec3_add(to, random_vector(0.1 * size)));
            rays[i].direction = vec3_normalize(rays[i].direction);
            origins = box_add(origins, rays[i].origin);
            directions = box_add(directions, rays[i].direction);
        }
        struct target_list list;
        struct shaft shaft = shaft_of_rays(&tree, origins, directions);
        shaft_list(&tree, &shaft, &list);
        if (!list.usable)
            continue;
        usable++;
        for (int i = 0; i < COUNT(rays); i++) {
            struct hit hit;
            if (!accel_closest(&tree, &rays[i], &hit))
                continue;
            bool listed = false;
            for (uint32_t k = 0; k < list.n; k++)
                listed |= list.at[k].prim == hit.prim;
            ck_assert(listed && g.prims.at[hit.prim].kind != PRIM_INSTANCE);
        }
    }
    ck_assert_uint_gt(usable, TRIES(20));
    accel_free(&tree);
    geometry_free(&g);
}
END_TEST

/* Instances of one mesh of so many triangles that it has a tree. */
static void add_balls(struct geometry *g, double size, int n)
{
    enum { ROUND = 16, HIGH = 9 };
    uint32_t number = geometry_add_prototype(g);
    struct geometry *shapes = &g->prototypes.at[number]->shapes;
    for (uint32_t k = 0; k <= HIGH * ROUND; k++) {
        double a = 2 * M_PI * (k % ROUND) / ROUND, b = M_PI * (k / ROUND + 0.5) / (HIGH + 1);
        geometry_add_vertex(
            shapes, vec3_scale(vec3(cos(a) * sin(b), sin(a) * sin(b), cos(b)), uniform(0.7, 1)));
    }
    for (uint32_t k = 0; k + ROUND < HIGH * ROUND; k++) {
        geometry_add_triangle(shapes, 0, k, k + 1, k + ROUND);
        geometry_add_triangle(shapes, 0, k + 1, k + 1 + ROUND, k + ROUND);
    }
    for (int i = 0; i < n; i++) {
        struct affine map = random_map(size, pow(10, uniform(0, below(2) ? 2 : 7)), 10);
        ck_assert(geometry_add_instance(g, (uint32_t)i, number, PRIM_NONE, &map));
    }
}

/* Rays from one place to others near each other, to one from there, and from each hit of the first
 * to anywhere. */
static void make_batch(struct ray_batch *rays, int kind, double size, const struct hit_batch *hits,
                       const struct geometry *g)
{
    struct vec3 from = random_vector(20 * size), to = random_vector(10 * size);
    double width = size * pow(10, uniform(-2, 0.5));
    struct ray_batch first = *rays;
    rays->n = kind == 2 ? first.n : BATCH - (below(2) ? below(40) : 0);
    rays->common_origin = kind == 0;
    rays->common_from = rays->common_origin;
    rays->spawned = kind == 2;
    for (uint32_t i = 0; i < rays->n; i++) {
        struct ray ray = ray_to(from, vec3_add(to, random_vector(width)));
        if (kind == 1)
            ray = ray_to(vec3_add(to, random_vector(width)), from);
        if (kind == 2 && hits->prim[i] != PRIM_NONE) {
            struct ray before = ray_get(&first, i);
            struct hit hit = hit_get(hits, i);
            struct vec3 normal;
            ray = ray_to(geometry_hit_point(g, &before, &hit, &normal), from);
            ray.from = hit.prim;
        }
        vec3_put(&rays->origin, i, ray.origin);
        vec3_put(&rays->direction, i, ray.direction);
        rays->t_max[i] = kind == 1 ? 1 : RAY_UNBOUNDED;
        rays->from[i] = ray.from;
    }
}

/* Returns how many hits the packet had; none is fine, too: it was not taken. */
static uint32_t compare_packet(const struct accel *tree, const struct accel *plain,
                               const struct ray_batch *rays, bool any)
{
    struct hit_batch hits;
    uint32_t met = 0;
    if (!tree->wide->kernels->packet(tree, rays, any, &hits))
        return 0;
    for (uint32_t i = 0; i < rays->n; i++) {
        struct ray ray = ray_get(rays, i);
        struct hit hit, of_packet = hit_get(&hits, i);
        bool found = accel_closest(plain, &ray, &hit);
        ck_assert_int_eq(of_packet.prim != PRIM_NONE, found);
        met += found;
        if (found && !any)
            ck_assert(of_packet.prim == hit.prim && of_packet.part == hit.part &&
                      of_packet.t == hit.t);
    }
    return met;
}

/* One by one and together, by each instruction set. */
START_TEST(packets_meet_instances)
{
    double size = pow(10, _i % 5 * 4 - 8);
    enum isa isa = (enum isa)(ISA_GENERIC + _i % (ISA_COUNT - ISA_GENERIC));
    struct geometry g = {0};
    counter = (uint64_t)_i << 40 | UINT64_C(2) << 30;
    fill_scene(&g, size, 10 + below(40));
    add_balls(&g, size, 12);
    struct accel tree, plain;
    accel_build_with(
        &tree, &g,
        &(struct accel_options){.isa = isa_available(isa) ? isa : isa_best(), .threads = 1});
    accel_build(&plain, &g, false);
    uint32_t met[3] = {0};
    for (int round = 0; round < TRIES(200) && tree.wide; round++) {
        struct ray_batch rays = {0};
        struct hit_batch hits;
        for (int kind = 0; kind < 3; kind++) {
            make_batch(&rays, kind, size, &hits, &g);
            for (int any = 0; any < 2; any++)
                met[kind] += compare_packet(&tree, &plain, &rays, any);
            for (uint32_t i = 0; i < rays.n; i++) {
                struct ray ray = ray_get(&rays, i);
                struct hit hit;
                accel_closest(&plain, &ray, &hit);
                hit_put(&hits, i, &hit);
            }
        }
    }
    for (int kind = 0; kind < 3; kind++)
        ck_assert_msg(!tree.wide || met[kind] > TRIES(40), "kind %d: %u", kind, met[kind]);
    accel_free(&tree);
    accel_free(&plain);
    geometry_free(&g);
}
END_TEST

START_TEST(equal_instances_tie_in_file_order)
{
    struct geometry g = {0};
    struct affine map = affine_translation(vec3(1, 2, 3));
    for (uint32_t i = 0; i < 9; i++)
        add_any(&g, i, 2, &map);
    struct accel tree;
    accel_build_with(&tree, &g, &(struct accel_options){.isa = isa_best(), .threads = 1});
    for (int i = 0; i < 1000; i++) {
        struct ray ray = ray_to(random_vector(50), vec3_add(vec3(1, 2, 3), random_vector(0.9)));
        struct hit hit;
        ck_assert(accel_closest(&tree, &ray, &hit));
        ck_assert_uint_eq(hit.prim, 0);
    }
    accel_free(&tree);
    geometry_free(&g);
}
END_TEST

START_TEST(flat_maps_are_refused)
{
    struct geometry g = {0};
    struct affine flat = affine_scaling(vec3(1, 0, 1)), far = affine_translation(vec3_all(1.7e308));
    far.m[0][0] = 1e308;
    geometry_solids(&g);
    ck_assert(!geometry_add_instance(&g, 0, PROTOTYPE_SOLIDS, 0, &flat));
    ck_assert(!geometry_add_instance(&g, 0, PROTOTYPE_SOLIDS, 0, &far));
    ck_assert_uint_eq(g.prims.n, 0);
    ck_assert_uint_eq(g.instances.n, 0);
    geometry_free(&g);
}
END_TEST

Suite *instance_suite(void)
{
    Suite *s = suite_create("instance");
    TCase *c = tcase_create("instance");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, inverses_undo);
    tcase_add_loop_test(c, maps_are_told_apart, 0, COUNT(maps));
    tcase_add_test(c, turns_are_similarities);
    tcase_add_loop_test(c, spawned_rays_leave_instances, 0, 3);
    tcase_add_test(c, far_shapes_come_back);
    tcase_add_test(c, ellipsoid_error_is_bounded);
    tcase_add_test(c, instances_are_like_copies);
    tcase_add_loop_test(c, boxes_are_tight, 0, 3);
    tcase_add_loop_test(c, trees_agree_with_brute_force, 0, 30);
    tcase_add_loop_test(c, shafts_leave_nothing_out, 0, 10);
    tcase_add_loop_test(c, packets_meet_instances, 0, 10);
    tcase_add_test(c, equal_instances_tie_in_file_order);
    tcase_add_test(c, flat_maps_are_refused);
    suite_add_tcase(s, c);
    return s;
}
