/* What is said of a lamp beforehand against every ray to it. */
#include "config.h"

#include "unit.h"

#define TRIES_SEED 11
#include "tries.h"

#include "render/tracer.h"

#include <string.h>

static void add_triangle(struct geometry *g, struct vec3 a, struct vec3 b, struct vec3 c)
{
    uint32_t v = geometry_add_vertex(g, a);
    geometry_add_vertex(g, b);
    geometry_add_vertex(g, c);
    geometry_add_triangle(g, 0, v, v + 1, v + 2);
}

/* Around `at`, about as large as `size`. */
static void add_blocker(struct geometry *g, struct vec3 at, double size)
{
    struct vec3 a = vec3_add(at, random_vector(size)), b = vec3_add(at, random_vector(size));
    switch (below(6)) {
    case 0:
    case 1:
        geometry_add_sphere(g, 0, at, size * uniform(0.1, 1));
        break;
    case 2:
        geometry_add_cylinder(g, 0, a, b, size * uniform(0.01, 1));
        break;
    case 3:
        geometry_add_cylinder(g, 0, at, vec3(at.x, at.y + size, at.z), size);
        break;
    case 4:
        add_triangle(g, a, b, vec3_mad(a, 1e-7, random_vector(size)));
        break;
    default:
        add_triangle(g, a, b, vec3_add(at, random_vector(size)));
        add_triangle(g, b, a, vec3_mad(at, -1, random_vector(size)));
    }
}

/* Kinds: a flat square, a sphere, slanting triangles, a cylinder; modern or not. */
static void make_light(struct light *l, struct vec3 at, double size, bool modern)
{
    struct vec3 x = vec3(size, 0, 0), z = vec3(0, 0, size);
    *l = (struct light){.kind = LIGHT_AREA, .position = at};
    switch (below(4)) {
    case 0:
        add_triangle(&l->object, vec3_sub(at, x), vec3_add(at, x), vec3_sub(at, z));
        add_triangle(&l->object, vec3_sub(at, x), vec3_add(at, x), vec3_add(at, z));
        break;
    case 1:
        geometry_add_sphere(&l->object, 0, at, size);
        break;
    case 2:
        for (int i = 0; i < 5; i++)
            add_triangle(&l->object, vec3_add(at, random_vector(size)),
                         vec3_add(at, random_vector(size)), vec3_add(at, random_vector(size)));
        break;
    default:
        geometry_add_cylinder(&l->object, 0, at, vec3_add(at, random_vector(size)), size);
    }
    if (modern)
        ck_assert(light_surface(l, 1 + below(5)));
    else
        light_sample_grid(l, geometry_bounds(&l->object), 2 + below(4));
}

static void free_light(struct light *l)
{
    geometry_free(&l->object);
    vec_free(&l->points);
    vec_free(&l->samples);
    vec_free(&l->areas);
}

/* The ray to sample i; false when it does not count. */
static bool ray_to_sample(const struct lamp *lamp, size_t i, struct vec3 p, uint32_t prim,
                          struct ray *ray)
{
    const struct light *l = lamp->light;
    *ray = (struct ray){.origin = p, .from = prim, .surface = SURFACE_NONE, .spawned = true};
    if (l->samples.n > 0) {
        struct light_sample sample = light_surface_at(l, uniform(0, 1), uniform(0, 1));
        ray->direction = vec3_sub(i % 2 ? sample.position : l->samples.at[i].position, p);
        ray->t_max = 1 - 0x1p-32;
        return true;
    }
    const struct light_point *point = &l->points.at[i];
    ray->direction = vec3_sub(point->position, p);
    ray->t_max = RAY_UNBOUNDED;
    ray->from = PRIM_NONE;
    bool counts = point->on_object || accel_any(&lamp->object, ray);
    double t_max = vec3_length(vec3_sub(l->position, p)) / vec3_length(ray->direction);
    ray->t_max = t_max <= RAY_UNBOUNDED ? t_max : RAY_UNBOUNDED;
    ray->from = prim;
    return counts;
}

struct tally {
    unsigned pairs, none, points, hidden;
};

static void check_point(const struct tracer *t, const struct lamp *lamp, const struct sight *sight,
                        uint32_t k, struct vec3 p, uint32_t prim, struct tally *tally)
{
    const struct geometry *g = &t->scene->geometry;
    const struct light *l = lamp->light;
    bool hidden = sight->hidden >> k & 1;
    tally->points++;
    tally->hidden += hidden;
    tally->pairs += sight->list.n;
    for (uint32_t i = 0; i < sight->list.n; i++)
        tally->none += !(sight->near[i] >> k & 1);
    for (size_t n = l->samples.n + l->points.n, i = 0; i < n; i++) {
        struct ray ray;
        struct hit hit;
        if (!ray_to_sample(lamp, i, p, prim, &ray))
            continue;
        ck_assert(!hidden || accel_any(&t->accel, &ray));
        for (uint32_t m = 0; m < sight->list.n && !hidden; m++) {
            struct ray_frame frame = ray_frame_of(&ray);
            hit = hit_none(ray.t_max);
            if (!(sight->near[m] >> k & 1))
                ck_assert(!geometry_intersect(g, sight->list.at[m].prim, &ray, &frame, &hit));
        }
        for (uint32_t m = 0; m < g->prims.n && !hidden; m++) {
            bool listed = false;
            for (uint32_t j = 0; j < sight->list.n; j++)
                listed |= sight->list.at[j].prim == m;
            struct ray_frame frame = ray_frame_of(&ray);
            hit = hit_none(ray.t_max);
            if (!listed)
                ck_assert(!geometry_intersect(g, m, &ray, &frame, &hit));
        }
    }
}

/* Points on the blockers, and some on nothing. */
static uint32_t make_points(const struct tracer *t, struct vec3 middle, double size,
                            struct vec3_batch *points, uint32_t *prims)
{
    uint32_t n = 1 + below(BATCH);
    struct vec3 eye = vec3_add(middle, random_vector(20 * size));
    struct vec3 aim = vec3_add(middle, random_vector(5 * size));
    for (uint32_t k = 0; k < n; k++) {
        struct ray ray = {
            .origin = eye, .t_max = RAY_UNBOUNDED, .from = PRIM_NONE, .surface = SURFACE_NONE};
        struct hit hit;
        struct vec3 normal, to = vec3_add(aim, random_vector(2 * size));
        ray.direction = vec3_sub(to, eye);
        bool found = accel_closest(&t->accel, &ray, &hit);
        vec3_put(points, k,
                 found ? geometry_hit_point(&t->scene->geometry, &ray, &hit, &normal) : to);
        prims[k] = found ? hit.prim : PRIM_NONE;
    }
    return n;
}

static void check_round(struct tracer *t, double size, struct tally *tally)
{
    struct scene scene = {0};
    struct light light;
    struct lamp lamp;
    struct vec3_batch points;
    uint32_t prims[BATCH_ROOM] = {0};
    struct vec3 middle = random_vector(below(2) ? 0 : 1e4 * size);
    struct vec3 at = vec3_add(middle, random_vector(9 * size));
    for (uint32_t i = 0, n = 1 + below(12); i < n; i++)
        add_blocker(&scene.geometry, vec3_add(middle, random_vector(5 * size)),
                    2 * size * (below(2) ? 1 : uniform(0.01, 1)));
    for (uint32_t n = below(3); n > 0; n--) /* near the light, small or large */
        add_blocker(&scene.geometry, vec3_add(at, random_vector(size)),
                    size * (below(2) ? 10 : 0.3));
    make_light(&light, at, size * uniform(0.01, 2), t->modern);
    lamp_init(&lamp, &light, false, true);
    t->scene = &scene;
    accel_build(&t->accel, &scene.geometry, false);
    memset(&points, 0, sizeof points);
    uint32_t n = make_points(t, middle, size, &points, prims);
    struct box box = render_plain.bounds(&points, n);
    for (uint32_t k = 0, end; k < n; k = end) {
        struct sight sight;
        end = see_lamp(t, &lamp, &points, prims, box, k, n, &sight);
        ck_assert_uint_gt(end, k);
        for (uint32_t j = k; j < end && sight.list.usable; j++)
            check_point(t, &lamp, &sight, j, vec3_get(&points, j), prims[j], tally);
    }
    accel_free(&t->accel);
    lamp_free(&lamp);
    free_light(&light);
    geometry_free(&scene.geometry);
}

/* By instruction set and model. */
START_TEST(sight_is_what_rays_find)
{
    static const double sizes[] = {1, 1e-8, 1e8};
    enum isa isa = (enum isa)(_i / 2);
    struct tally tally = {0};
    if (!isa_available(isa))
        return;
    counter = (uint64_t)_i << 40;
    struct tracer t = {.kernels = render_kernels_of(isa), .modern = _i % 2, .skips = true};
    for (int round = 0; round < TRIES(160); round++)
        check_round(&t, sizes[round % 3], &tally);
    ck_assert_uint_gt(tally.points, TRIES(1600));
    if (isa != ISA_PLAIN) {
        ck_assert_uint_gt(tally.none, tally.pairs / 4);
        ck_assert_uint_gt(tally.hidden, tally.points / 50);
    }
}
END_TEST

Suite *sight_suite(void)
{
    Suite *s = suite_create("sight");
    TCase *c = tcase_create("sight");
    tcase_set_timeout(c, 120);
    tcase_add_loop_test(c, sight_is_what_rays_find, 0, 2 * ISA_COUNT);
    suite_add_tcase(s, c);
    return s;
}
