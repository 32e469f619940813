/* Rays against single primitives: bounds of the rounding errors against 113-bit arithmetic, and
 * rays that start on what they could hit. */
#include "config.h"

#include "unit.h"

#define TRIES_SEED 1
#include "tries.h"

#include "scene/geometry.h"

#define EPS 0x1p-53

struct wide3 {
    __float128 x, y, z;
};

static struct wide3 widen(struct vec3 v)
{
    return (struct wide3){v.x, v.y, v.z};
}

static struct wide3 wide_sub(struct wide3 a, struct wide3 b)
{
    return (struct wide3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static __float128 wide_dot(struct wide3 a, struct wide3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct wide3 wide_mad(struct wide3 a, __float128 s, struct wide3 b)
{
    return (struct wide3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static struct wide3 wide_cross(struct wide3 a, struct wide3 b)
{
    return (struct wide3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* By Newton's method from the double's root; no library is needed. */
static __float128 wide_sqrt(__float128 a)
{
    if (a <= 0)
        return 0;
    __float128 x = sqrt((double)a);
    for (int i = 0; i < 3; i++)
        x = (x + a / x) / 2;
    return x;
}

static struct ray ray_to(struct vec3 origin, struct vec3 target)
{
    return (struct ray){.origin = origin,
                        .direction = vec3_normalize(vec3_sub(target, origin)),
                        .t_max = RAY_UNBOUNDED,
                        .from = PRIM_NONE,
                        .surface = SURFACE_NONE};
}

/* How far the end of the ray is from the surface of the sphere. */
static __float128 off_sphere(const struct sphere *s, const struct ray *ray, __float128 t)
{
    struct wide3 f = wide_sub(widen(ray->origin), widen(s->center));
    f = wide_mad(f, t, widen(ray->direction));
    __float128 d = wide_sqrt(wide_dot(f, f)) - s->radius;
    return d < 0 ? -d : d;
}

/* Distance of the ray's line from a point. */
static __float128 line_distance(const struct ray *ray, struct vec3 p)
{
    struct wide3 f = wide_sub(widen(p), widen(ray->origin)), d = widen(ray->direction);
    struct wide3 c = wide_cross(f, d);
    return wide_sqrt(wide_dot(c, c) / wide_dot(d, d));
}

START_TEST(sphere_error_is_bounded)
{
    for (int i = 0; i < TRIES(200000); i++) {
        struct geometry g = {0};
        double far = pow(10, uniform(0.1, 9)), r = 1;
        geometry_add_sphere(&g, 0, random_vector(10), r);
        const struct sphere *s = &g.spheres.at[0];
        struct vec3 from = vec3_mad(s->center, far, random_direction());
        struct ray ray = ray_to(from, vec3_mad(s->center, uniform(0, 1.2), random_direction()));
        struct hit hit;
        double bound = 8 * EPS * (far + 20);
        __float128 margin = r - line_distance(&ray, s->center);
        if (shoot(&g, &ray, &hit)) {
            ck_assert(off_sphere(s, &ray, hit.t) <= bound);
            ck_assert(margin >= -bound);
            struct vec3 n, p = geometry_hit_point(&g, &ray, &hit, &n);
            struct ray at = {.origin = p};
            ck_assert(off_sphere(s, &at, 0) <= 8 * EPS * 12);
            ck_assert(vec3_dot(n, ray.direction) < 1e-6);
        } else {
            ck_assert(margin <= bound);
        }
        geometry_free(&g);
    }
}
END_TEST

/* Distance of the ray's end from the surface of the cylinder. */
static __float128 off_cylinder(const struct cylinder *c, const struct ray *ray, __float128 t)
{
    struct wide3 e = widen(c->axis);
    struct wide3 p =
        wide_mad(wide_sub(widen(ray->origin), widen(c->base)), t, widen(ray->direction));
    __float128 z = wide_dot(p, e), across = wide_sqrt(wide_dot(p, p) - z * z);
    __float128 side = across - c->radius, below = -z, above = z - c->height;
    __float128 caps = below > above ? below : above, d = side > caps ? side : caps;
    return d < 0 ? -d : d;
}

START_TEST(cylinder_error_is_bounded)
{
    for (int i = 0; i < TRIES(100000); i++) {
        struct geometry g = {0};
        double far = pow(10, uniform(0.5, 9));
        struct vec3 base = random_vector(10),
                    top = vec3_mad(base, uniform(0.1, 3), random_direction());
        geometry_add_cylinder(&g, 0, base, top, uniform(0.1, 1));
        const struct cylinder *c = &g.cylinders.at[0];
        struct ray ray = ray_to(vec3_mad(base, far, random_direction()),
                                vec3_mad(base, uniform(0, 2), random_direction()));
        struct vec3 n = vec3_cross(ray.direction, c->axis);
        double bound = 16 * EPS * (far + 30) / vec3_length(n);
        struct hit hit;
        if (shoot(&g, &ray, &hit))
            ck_assert(off_cylinder(c, &ray, hit.t) <= bound);
        geometry_free(&g);
    }
}
END_TEST

/* Twice the area, with the triangle seen along the ray, on each side of the three edges. */
static void wide_edges(const struct ray *ray, const struct vec3 v[3], __float128 e[3])
{
    struct wide3 d = widen(ray->direction), o = widen(ray->origin);
    for (int i = 0; i < 3; i++) {
        struct wide3 p = wide_sub(widen(v[(i + 1) % 3]), o), q = wide_sub(widen(v[(i + 2) % 3]), o);
        e[i] = wide_dot(d, wide_cross(p, q));
    }
}

START_TEST(triangle_error_is_bounded)
{
    for (int i = 0; i < TRIES(100000); i++) {
        struct geometry g = {0};
        double far = pow(10, uniform(0.5, 6));
        struct vec3 v[3], middle = random_vector(10);
        for (int k = 0; k < 3; k++)
            geometry_add_vertex(&g, v[k] = vec3_add(middle, random_vector(1)));
        geometry_add_triangle(&g, 0, 0, 1, 2);
        struct ray ray =
            ray_to(vec3_mad(middle, far, random_direction()), vec3_add(middle, random_vector(1)));
        struct hit hit;
        __float128 e[3], least = 1, most = -1, error = 64 * EPS * (far + 20) * 4;
        wide_edges(&ray, v, e);
        for (int k = 0; k < 3; k++) {
            least = k == 0 || e[k] < least ? e[k] : least;
            most = k == 0 || e[k] > most ? e[k] : most;
        }
        bool inside = least > 0 || most < 0,
             near_edge = (least < 0 ? -least : least) < error || (most < 0 ? -most : most) < error;
        if (shoot(&g, &ray, &hit)) {
            ck_assert(inside || near_edge);
            struct vec3 n = g.triangles.at[0].normal;
            double cosine = fabs(vec3_dot(n, ray.direction));
            struct wide3 p = wide_mad(widen(ray.origin), hit.t, widen(ray.direction));
            __float128 off = wide_dot(widen(n), wide_sub(widen(v[0]), p));
            if (cosine > 0.25)
                ck_assert((off < 0 ? -off : off) <= 16 * EPS * (far + 30));
        } else {
            ck_assert(!inside || near_edge);
        }
        geometry_free(&g);
    }
}
END_TEST

/* Spawned from the hit, outwards nothing may be hit, towards the middle something must be. */
static void check_spawned(const struct geometry *g, const struct ray *ray, const struct hit *hit,
                          struct vec3 middle)
{
    struct vec3 normal, p = geometry_hit_point(g, ray, hit, &normal);
    ck_assert(geometry_lies_on(g, hit->prim, p, vec3_largest(p)));
    for (int i = 0; i < 4; i++) {
        struct ray out = {.origin = p,
                          .direction = random_direction(),
                          .t_max = RAY_UNBOUNDED,
                          .from = hit->prim,
                          .surface = SURFACE_NONE,
                          .spawned = true};
        double along = vec3_dot(out.direction, normal);
        struct hit other;
        if (fabs(along) < 1e-6)
            continue;
        if (along < 0)
            out.direction = vec3_neg(out.direction);
        ck_assert_msg(!shoot(g, &out, &other), "self-hit at t = %g", other.t);
    }
    struct ray in = {.origin = p,
                     .direction = vec3_sub(middle, p),
                     .t_max = RAY_UNBOUNDED,
                     .from = hit->prim,
                     .surface = SURFACE_NONE,
                     .spawned = true};
    struct hit other;
    ck_assert_msg(shoot(g, &in, &other), "leak");
}

START_TEST(spawned_rays_leave_spheres)
{
    for (int i = 0; i < TRIES(100000); i++) {
        struct geometry g = {0};
        double r = pow(10, uniform(-8, 8));
        geometry_add_sphere(&g, 0, random_vector(r * uniform(0, 100)), r);
        struct vec3 c = g.spheres.at[0].center;
        struct ray ray = ray_to(vec3_mad(c, r * uniform(2, 1000), random_direction()),
                                vec3_mad(c, r * uniform(0, 0.999), random_direction()));
        struct hit hit;
        ck_assert(shoot(&g, &ray, &hit));
        check_spawned(&g, &ray, &hit, c);
        geometry_free(&g);
    }
}
END_TEST

/* Half of the rays are aimed at the rims. */
START_TEST(spawned_rays_leave_cylinders)
{
    for (int i = 0; i < TRIES(100000); i++) {
        struct geometry g = {0};
        double size = pow(10, uniform(-8, 8));
        struct vec3 base = random_vector(size * uniform(0, 100)), axis = random_direction();
        if (i % 3 == 0)
            axis = vec3(0, 1, 0);
        geometry_add_cylinder(&g, 0, base, vec3_mad(base, size * uniform(0.1, 10), axis),
                              size * uniform(0.1, 10));
        const struct cylinder *c = &g.cylinders.at[0];
        struct vec3 out = vec3_normalize(vec3_cross(c->axis, random_direction()));
        double z = i % 2 ? uniform(0, 1) : i % 4 ? 0 : 1, rho = i % 2 ? uniform(0, 0.99) : 1;
        struct vec3 target =
            vec3_mad(vec3_mad(c->base, z * c->height, c->axis), rho * c->radius, out);
        struct ray ray = ray_to(vec3_mad(c->base, 50 * size, random_direction()), target);
        struct hit hit;
        if (shoot(&g, &ray, &hit))
            check_spawned(&g, &ray, &hit, vec3_mad(c->base, 0.5 * c->height, c->axis));
        else
            ck_assert(i % 2 == 0); /* a rim may be missed by a rounding error */
        geometry_free(&g);
    }
}
END_TEST

/* From inside, no ray leaves a cylinder, least of all where side and cap meet. */
START_TEST(cylinder_rims_are_tight)
{
    struct geometry g = {0};
    geometry_add_cylinder(&g, 0, vec3(1, 2, 3), vec3(1.5, 4, 3.25), 0.75);
    const struct cylinder *c = &g.cylinders.at[0];
    for (int i = 0; i < TRIES(300000); i++) {
        struct vec3 out = vec3_normalize(vec3_cross(c->axis, random_direction()));
        struct vec3 rim =
            vec3_mad(vec3_mad(c->base, i % 2 ? c->height : 0, c->axis), c->radius, out);
        struct vec3 inside = vec3_mad(c->base, uniform(0.1, 0.9) * c->height, c->axis);
        struct ray ray = ray_to(inside, rim);
        struct hit hit;
        ck_assert(shoot(&g, &ray, &hit));
    }
    geometry_free(&g);
}
END_TEST

/* The faces of a cube, the rays spawned on edges and corners too. */
START_TEST(spawned_rays_leave_a_cube)
{
    static const uint8_t face[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                        {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                        {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    for (int i = 0; i < TRIES(20000); i++) {
        struct geometry g = {0};
        double size = pow(10, uniform(-8, 8));
        struct vec3 at = random_vector(size * uniform(0, 100));
        for (int k = 0; k < 8; k++)
            geometry_add_vertex(&g, vec3(at.x + (k & 1 ? size : 0), at.y + (k & 2 ? size : 0),
                                         at.z + (k & 4 ? size : 0)));
        for (int k = 0; k < 12; k++)
            geometry_add_triangle(&g, 0, face[k][0], face[k][1], face[k][2]);
        struct vec3 a = g.vertices.at[i % 8], b = g.vertices.at[(i / 8) % 8];
        struct vec3 target = vec3_mad(a, i % 3 ? uniform(0, 1) : 0, vec3_sub(b, a));
        struct vec3 middle = vec3_scale(vec3_add(g.vertices.at[0], g.vertices.at[7]), 0.5);
        struct ray ray = ray_to(vec3_mad(middle, 30 * size, random_direction()), target);
        struct hit hit;
        if (shoot(&g, &ray, &hit)) {
            struct vec3 n, p = geometry_hit_point(&g, &ray, &hit, &n);
            struct ray out = {.origin = p,
                              .t_max = RAY_UNBOUNDED,
                              .from = hit.prim,
                              .surface = SURFACE_NONE,
                              .spawned = true};
            out.direction = vec3_normalize(vec3_sub(p, middle));
            ck_assert(!shoot(&g, &out, &hit));
            out.direction = vec3_neg(out.direction);
            ck_assert(shoot(&g, &out, &hit));
        }
        geometry_free(&g);
    }
}
END_TEST

START_TEST(coplanar_triangles_tie_exactly)
{
    struct geometry g = {0};
    for (int i = 0; i < 20; i++) {
        for (int k = 0; k < 3; k++)
            geometry_add_vertex(&g, vec3(uniform(-50, -20) + 60 * (k == 1), 548.8,
                                         uniform(-50, -20) + 60 * (k == 2)));
        geometry_add_triangle(&g, 0, 3 * i, 3 * i + 1, 3 * i + 2);
    }
    for (int i = 0; i < TRIES(10000); i++) {
        struct ray ray = ray_to(random_vector(500), vec3(uniform(-9, -8), 548.8, uniform(-9, -8)));
        struct hit first, other;
        struct ray_frame frame = ray_frame_of(&ray);
        ck_assert(shoot(&g, &ray, &first));
        for (uint32_t k = 0; k < g.prims.n; k++) {
            other = hit_none(ray.t_max);
            if (geometry_intersect(&g, k, &ray, &frame, &other))
                ck_assert(other.t == first.t && first.prim <= k);
        }
    }
    geometry_free(&g);
}
END_TEST

START_TEST(degenerate_input_hits_nothing)
{
    struct geometry g = {0};
    for (int i = 0; i < 5; i++)
        geometry_add_vertex(&g, vec3(i, 0.1 * i, 0.3 * i));
    geometry_add_triangle(&g, 0, 0, 0, 1);
    geometry_add_triangle(&g, 0, 2, 2, 2);
    geometry_add_sphere(&g, 0, vec3(50, 0, 0), 1);
    geometry_add_cylinder(&g, 0, vec3(-50, 0, 0), vec3(-50, 1, 0), 1);
    struct ray ray = ray_to(vec3(-3, 5, 1), vec3(0, 0, 0));
    struct hit hit;
    ck_assert(!shoot(&g, &ray, &hit));
    static const double odd[] = {0, NAN, INFINITY};
    for (int i = 0; i < 27; i++) {
        ray.direction = vec3(odd[i % 3], odd[i / 3 % 3], odd[i / 9]);
        ck_assert(!shoot(&g, &ray, &hit));
    }
    geometry_free(&g);
}
END_TEST

Suite *geometry_suite(void)
{
    Suite *s = suite_create("geometry");
    TCase *c = tcase_create("geometry");
    tcase_set_timeout(c, 120);
    tcase_add_test(c, sphere_error_is_bounded);
    tcase_add_test(c, cylinder_error_is_bounded);
    tcase_add_test(c, triangle_error_is_bounded);
    tcase_add_test(c, spawned_rays_leave_spheres);
    tcase_add_test(c, spawned_rays_leave_cylinders);
    tcase_add_test(c, cylinder_rims_are_tight);
    tcase_add_test(c, spawned_rays_leave_a_cube);
    tcase_add_test(c, coplanar_triangles_tie_exactly);
    tcase_add_test(c, degenerate_input_hits_nothing);
    suite_add_tcase(s, c);
    return s;
}
