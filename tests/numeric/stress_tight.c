/* Closed things must hold every ray: from inside nothing gets out, from outside nothing gets to a
 * point inside without a hit, wherever it is aimed. */
#include "config.h"

#include "stress.h"

#include "accel/bvh.h"

/* A point of the surface worth aiming at. */
enum aim { AIM_ANYWHERE, AIM_VERTEX, AIM_EDGE, AIMS };

static struct vec3 target_on(struct dice *d, const struct geometry *g, enum aim aim)
{
    const uint32_t *v = g->triangles.at[below(d, (uint32_t)g->triangles.n)].vertex;
    struct vec3 a = g->vertices.at[v[0]], b = g->vertices.at[v[1]], c = g->vertices.at[v[2]];
    if (aim == AIM_ANYWHERE) {
        double s = uniform(d, 0, 1), t = uniform(d, 0, 1 - s);
        return vec3_mad(vec3_mad(a, s, vec3_sub(b, a)), t, vec3_sub(c, a));
    }
    uint32_t k = below(d, 3);
    struct vec3 from = k == 0 ? a : k == 1 ? b : c, to = k == 0 ? b : k == 1 ? c : a;
    return aim == AIM_VERTEX ? from : vec3_mad(from, uniform(d, 0, 1), vec3_sub(to, from));
}

/* Half of the rays start inside, the others end there; `way` is how far outside these start,
 * compared with what lies inside. */
static struct ray ray_through(struct dice *d, struct vec3 inside, struct vec3 target)
{
    if (below(d, 2))
        return ray_between(inside, target);
    double way = magnitude(d, 1.5, 1000);
    struct ray ray = ray_between(vec3_mad(inside, way, vec3_sub(target, inside)), inside);
    ray.t_max = 1;
    return ray;
}

static void try_ray(const struct accel *a, const struct ray *ray, struct tally *tally)
{
    struct hit hit;
    tally->wrong += !accel_closest(a, ray, &hit) || !accel_any(a, ray);
    tally->cases++;
}

/* ---- meshes ---------------------------------------------------------------------------------- */

/* A few rays do not pay for the whole mesh. */
static void aim_at_far_globe(struct dice *d, uint64_t cases, enum aim aim, struct tally *tally)
{
    struct geometry g = {0};
    struct accel a;
    struct vec3 middle = vec3(148376, 1234, -223423);
    add_globe(&g, middle, 2, cases < 10000 ? 50 : 200);
    accel_build(&a, &g, false);
    for (uint64_t i = 0; i < cases; i++) {
        struct vec3 inside = vec3_add(middle, random_vector(d, 0.8));
        struct vec3 target =
            aim == AIM_ANYWHERE ? vec3_add(inside, random_direction(d)) : target_on(d, &g, aim);
        struct ray ray =
            aim == AIM_ANYWHERE ? ray_between(inside, target) : ray_through(d, inside, target);
        try_ray(&a, &ray, tally);
    }
    accel_free(&a);
    geometry_free(&g);
}

static void try_far_globe(struct dice *d, uint64_t cases, struct tally *tally)
{
    aim_at_far_globe(d, cases, AIM_ANYWHERE, tally);
}

static void try_far_vertices(struct dice *d, uint64_t cases, struct tally *tally)
{
    aim_at_far_globe(d, cases, AIM_VERTEX, tally);
}

static void try_far_edges(struct dice *d, uint64_t cases, struct tally *tally)
{
    aim_at_far_globe(d, cases, AIM_EDGE, tally);
}

enum { RAYS_A_SHAPE = 200 };

/* A box of quads or a small globe, of half width `size` around `at`. */
static void try_closed(struct dice *d, struct vec3 at, double size, struct tally *tally)
{
    struct geometry g = {0};
    struct accel a;
    if (below(d, 2))
        add_box(&g, at, size);
    else
        add_globe(&g, at, size, 3 + below(d, 8));
    accel_build(&a, &g, below(d, 2));
    for (int i = 0; i < RAYS_A_SHAPE; i++) {
        struct vec3 inside = vec3_add(at, random_vector(d, size * 0.2));
        struct ray ray = ray_through(d, inside, target_on(d, &g, (enum aim)below(d, AIMS)));
        try_ray(&a, &ray, tally);
    }
    accel_free(&a);
    geometry_free(&g);
}

static void try_quads(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases) {
        double size = magnitude(d, 1e-8, 1e8);
        try_closed(d, random_vector(d, size * magnitude(d, 1e-3, 1e5)), size, tally);
    }
}

static void try_distant_quads(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_closed(d, vec3_scale(random_direction(d), 0x1p24), 1, tally);
}

/* A closed mesh at a turned, uneven and mirrored place: rays are taken into its space. */
static void try_instances(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases) {
        struct geometry g = {0};
        struct accel a;
        double size = magnitude(d, 1e-8, 1e8);
        struct affine map = random_map(d, size, magnitude(d, 1, 1000), magnitude(d, 1, 1e5));
        uint32_t number = geometry_add_prototype(&g);
        struct geometry *shape = &g.prototypes.at[number]->shapes;
        if (below(d, 2))
            add_box(shape, vec3_all(0), 1);
        else
            add_globe(shape, vec3_all(0), 1, 3 + below(d, 8));
        if (!geometry_add_instance(&g, 0, number, PRIM_NONE, &map))
            tally->wrong++;
        accel_build(&a, &g, below(d, 2));
        for (int i = 0; i < RAYS_A_SHAPE && g.prims.n > 0; i++) {
            struct vec3 inside = affine_point(&map, random_vector(d, 0.2));
            struct vec3 target = target_on(d, shape, (enum aim)below(d, AIMS));
            struct ray ray = ray_through(d, inside, affine_point(&map, target));
            try_ray(&a, &ray, tally);
        }
        accel_free(&a);
        geometry_free(&g);
    }
}

/* ---- solids ---------------------------------------------------------------------------------- */

/* On the rim mostly. */
static struct vec3 cylinder_point(struct dice *d, const struct cylinder *c)
{
    struct vec3 out = random_across(d, c->axis);
    double z = below(d, 8) ? below(d, 2) : uniform(d, 0, 1);
    return vec3_mad(vec3_mad(c->base, z * c->height, c->axis), c->radius, out);
}

static void try_rims(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases) {
        struct geometry g = {0};
        double size = magnitude(d, 1e-8, 1e8), height = size * magnitude(d, 0.01, 100);
        struct vec3 base = random_vector(d, size * magnitude(d, 1e-3, 1e5));
        struct vec3 axis = below(d, 3) ? random_direction(d) : vec3(0, 0, -1);
        geometry_add_cylinder(&g, 0, base, vec3_mad(base, height, axis), size);
        const struct cylinder *c = g.cylinders.at;
        struct accel a;
        accel_build(&a, &g, true);
        for (int i = 0; i < RAYS_A_SHAPE; i++) {
            struct vec3 inside = vec3_mad(c->base, uniform(d, 0.3, 0.7) * c->height, c->axis);
            inside = vec3_mad(inside, uniform(d, 0, 0.5) * c->radius, random_across(d, c->axis));
            struct ray ray = ray_through(d, inside, cylinder_point(d, c));
            if (below(d, 16) == 0) { /* along the axis, exactly or nearly */
                ray = ray_between(inside, vec3_mad(inside, c->height, c->axis));
                ray.direction = below(d, 4) ? c->axis : ray.direction;
                if (below(d, 2))
                    ray.direction.x = nextafter(ray.direction.x, below(d, 2) ? 2 : -2);
            }
            try_ray(&a, &ray, tally);
        }
        accel_free(&a);
        geometry_free(&g);
    }
}

/* Balls and cylinders, as they are and as ellipsoids and elliptic cylinders. */
static void try_solids(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases) {
        struct geometry g = {0};
        double size = magnitude(d, 1e-8, 1e8);
        struct affine map = random_map(d, size, magnitude(d, 1, 1000), magnitude(d, 1, 1e5));
        struct geometry *solids = geometry_solids(&g);
        struct vec3 axis = random_direction(d);
        geometry_add_cylinder(solids, 0, vec3_scale(axis, -0.7), axis, 0.6);
        uint32_t only = below(d, 2);
        if (!geometry_add_instance(&g, 0, PROTOTYPE_SOLIDS, only, &map))
            tally->wrong++;
        struct accel a;
        accel_build(&a, &g, true);
        for (int i = 0; i < RAYS_A_SHAPE && g.prims.n > 0; i++) {
            struct vec3 inside = affine_point(&map, random_vector(d, 0.2));
            struct vec3 target =
                only ? cylinder_point(d, solids->cylinders.at) : random_direction(d);
            struct ray ray = ray_through(d, inside, affine_point(&map, target));
            try_ray(&a, &ray, tally);
        }
        accel_free(&a);
        geometry_free(&g);
    }
}

static void try_spheres(struct dice *d, uint64_t cases, struct tally *tally)
{
    for (uint64_t i = 0; i < cases; i++) {
        struct geometry g = {0};
        struct hit hit;
        double size = magnitude(d, 1e-8, 1e8);
        struct vec3 at = random_vector(d, size * magnitude(d, 1e-3, 1e5));
        geometry_add_sphere(&g, 0, at, size);
        struct vec3 inside = vec3_mad(at, uniform(d, 0, 0.5) * size, random_direction(d));
        struct ray ray = ray_through(d, inside, vec3_mad(at, size, random_direction(d)));
        tally->wrong += !shoot(&g, &ray, &hit);
        geometry_free(&g);
    }
    tally->cases += cases;
}

const struct row rows_tight[] = {
    {"closed mesh at (148376, 1234, -223423), any ray", "", 0, 20000, 10000000, try_far_globe,
     false},
    {"  its vertices", "", 0, 20000, 1000000, try_far_vertices, false},
    {"  its edges", "", 0, 20000, 1000000, try_far_edges, false},
    {"boxes of quads and globes, sizes 1e-8 .. 1e8", "", 0, 100000, 10000000, try_quads, false},
    {"  at 2^24", "", 0, 100000, 10000000, try_distant_quads, false},
    {"  as turned, uneven, mirrored instances", "", 0, 100000, 10000000, try_instances, false},
    {"rims of cylinders, sizes 1e-8 .. 1e8", "", 0, 200000, 10000000, try_rims, false},
    {"ellipsoids and elliptic cylinders", "", 0, 100000, 10000000, try_solids, false},
    {"spheres", "", 0, 100000, 10000000, try_spheres, false},
    {0},
};
