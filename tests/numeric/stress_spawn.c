/* Rays that start on a surface: none meets where it starts, none gets through; and the directions
 * of mirrored and refracted ones, bounce after bounce. */
#include "config.h"

#include "stress.h"

#include "math/optics.h"
#include "render/tracer.h"

#include <string.h>

/* ---- self-hits and leaks --------------------------------------------------------------------- */

enum solid { SOLID_SPHERE, SOLID_CYLINDER, SOLID_BOX, SOLID_GLOBE };

/* Convex, about as large as 1, with the origin inside. */
static void add_solid(struct dice *d, struct geometry *g, enum solid solid)
{
    struct vec3 axis = below(d, 3) ? random_direction(d) : vec3(0, 1, 0);
    if (solid == SOLID_SPHERE)
        geometry_add_sphere(g, 0, vec3_all(0), 1);
    else if (solid == SOLID_CYLINDER)
        geometry_add_cylinder(g, 0, vec3_scale(axis, -uniform(d, 0.1, 3)),
                              vec3_scale(axis, uniform(d, 0.1, 3)), uniform(d, 0.1, 3));
    else if (solid == SOLID_BOX)
        add_box(g, vec3_all(0), 1);
    else
        add_globe(g, vec3_all(0), 1, 3 + below(d, 8));
}

/* The same scaled and moved, as a copy: what is not an instance. */
static void copy_solid(struct geometry *to, const struct geometry *from, double size,
                       struct vec3 at)
{
    for (size_t i = 0; i < from->vertices.n; i++)
        geometry_add_vertex(to, vec3_mad(at, size, from->vertices.at[i]));
    for (size_t i = 0; i < from->prims.n; i++) {
        struct prim p = from->prims.at[i];
        if (p.kind == PRIM_SPHERE) {
            geometry_add_sphere(to, 0, at, size);
        } else if (p.kind == PRIM_CYLINDER) {
            const struct cylinder *c = &from->cylinders.at[p.index];
            struct vec3 base = vec3_mad(at, size, c->base);
            geometry_add_cylinder(to, 0, base, vec3_mad(base, size * c->height, c->axis),
                                  size * c->radius);
        } else {
            const uint32_t *v = from->triangles.at[p.index].vertex;
            geometry_add_triangle(to, 0, v[0], v[1], v[2]);
        }
    }
}

/* On an edge, a corner or a rim, every other time, if it has such; else inside. */
static struct vec3 spot_on(struct dice *d, const struct geometry *g)
{
    struct prim p = g->prims.at[below(d, (uint32_t)g->prims.n)];
    if (p.kind == PRIM_CYLINDER && below(d, 2)) {
        const struct cylinder *c = &g->cylinders.at[p.index];
        struct vec3 rim = vec3_mad(c->base, below(d, 2) ? c->height : 0, c->axis);
        return vec3_mad(rim, c->radius, random_across(d, c->axis));
    }
    if (p.kind == PRIM_TRIANGLE && below(d, 2)) {
        const uint32_t *v = g->triangles.at[p.index].vertex;
        struct vec3 a = g->vertices.at[v[0]], b = g->vertices.at[v[1]];
        return vec3_mad(a, below(d, 3) ? uniform(d, 0, 1) : 0, vec3_sub(b, a));
    }
    return random_vector(d, 0.05);
}

static struct ray spawned(const struct hit *hit, struct vec3 p, struct vec3 direction)
{
    return (struct ray){.origin = p,
                        .direction = direction,
                        .t_max = RAY_UNBOUNDED,
                        .from = hit->prim,
                        .surface = SURFACE_NONE,
                        .spawned = true};
}

/* `clearance`: cosines to the normal that rounding errors cannot turn. */
static void try_spawned(struct dice *d, const struct geometry *g, const struct ray *ray,
                        const struct hit *hit, struct vec3 middle, double clearance,
                        struct tally *tally)
{
    struct vec3 normal, p = geometry_hit_point(g, ray, hit, &normal);
    struct hit other;
    if (g->prims.at[hit->prim].kind == PRIM_TRIANGLE)
        p = triangle_settle(g, hit->prim, p, vec3_largest(p));
    /* seen from afar, or almost along its plane, a point may lie beyond the edge of a face */
    double length = vec3_length(ray->direction), reach = vec3_largest(p);
    if (fabs(vec3_dot(normal, ray->direction)) > 0.01 * length && hit->t * length < 100 * reach)
        tally->wrong += !geometry_lies_on(g, hit->prim, p, vec3_largest(p));
    for (int i = 0; i < 4; i++) {
        struct vec3 out = i == 0 ? normal : random_direction(d);
        if (i > 1) /* just above the surface */
            out = vec3_mad(random_across(d, normal), magnitude(d, clearance, 1), normal);
        double along = vec3_dot(out, normal) / vec3_length(out);
        if (!(fabs(along) >= clearance))
            continue;
        struct ray away = spawned(hit, p, along < 0 ? vec3_neg(out) : out);
        tally->wrong += shoot(g, &away, &other);
        tally->cases++;
    }
    struct ray in = spawned(hit, p, vec3_sub(middle, p));
    tally->wrong += !shoot(g, &in, &other);
    tally->cases++;
}

/* From within, where an inner corner is: every ray inwards meets another face. */
static void try_room(struct dice *d, const struct geometry *g, const struct ray *ray,
                     const struct hit *hit, double clearance, struct tally *tally)
{
    struct vec3 normal, p = geometry_hit_point(g, ray, hit, &normal);
    struct hit other;
    if (g->prims.at[hit->prim].kind == PRIM_TRIANGLE)
        p = triangle_settle(g, hit->prim, p, vec3_largest(p));
    if (vec3_dot(normal, ray->direction) > 0)
        normal = vec3_neg(normal);
    for (int i = 0; i < 4; i++) {
        double rise = magnitude(d, 2 * clearance, 2);
        struct vec3 direction = vec3_mad(random_across(d, normal), rise, normal);
        struct ray next = spawned(hit, p, direction);
        tally->wrong += !shoot(g, &next, &other);
        tally->cases++;
    }
}

enum { RAYS_A_SOLID = 20 };

/* Errors of the point and of the normal, as an angle seen from inside the solid; beside an edge, of
 * the point as seen from where the next face's plane is first told apart. */
static double clearance_of(bool flat, struct vec3 middle, double size, double uneven)
{
    double solid = 32 * SPAWN_TOLERANCE * uneven * uneven * (vec3_largest(middle) + size) / size;
    return flat ? fmax(solid, 16 * EPS / SPAWN_TOLERANCE) : solid;
}

/* Seen from outside, or from within. */
static void try_start(struct dice *d, enum solid solid, bool instance, bool within,
                      struct tally *tally)
{
    struct geometry g = {0}, shape = {0};
    double size = magnitude(d, 1e-8, 1e8), uneven = instance ? magnitude(d, 1, 100) : 1;
    struct affine map = random_map(d, size, uneven, magnitude(d, 1, 1000));
    if (!instance)
        map = affine_times(
            &(struct affine){
                {{1, 0, 0, map.m[0][3]}, {0, 1, 0, map.m[1][3]}, {0, 0, 1, map.m[2][3]}}},
            &(struct affine){{{size, 0, 0, 0}, {0, size, 0, 0}, {0, 0, size, 0}}});
    struct vec3 middle = vec3(map.m[0][3], map.m[1][3], map.m[2][3]);
    add_solid(d, &shape, solid);
    if (instance) {
        uint32_t number = geometry_add_prototype(&g);
        copy_solid(&g.prototypes.at[number]->shapes, &shape, 1, vec3_all(0));
        uint32_t only = shape.triangles.n > 0 ? PRIM_NONE : 0;
        tally->wrong += !geometry_add_instance(&g, 0, number, only, &map);
    } else {
        copy_solid(&g, &shape, size, middle);
    }
    for (int i = 0; i < RAYS_A_SOLID && g.prims.n > 0; i++) {
        double far = size * magnitude(d, 5, 1e6);
        struct vec3 from = vec3_mad(middle, far, random_direction(d));
        struct vec3 inside = affine_point(&map, random_vector(d, 0.05));
        struct ray ray =
            ray_between(within ? inside : from, affine_point(&map, spot_on(d, &shape)));
        struct hit hit;
        if (!shoot(&g, &ray, &hit))
            continue;
        double clearance = clearance_of(shape.triangles.n > 0, middle, size, uneven);
        if (within)
            try_room(d, &g, &ray, &hit, clearance, tally);
        else
            try_spawned(d, &g, &ray, &hit, middle, clearance, tally);
    }
    geometry_free(&shape);
    geometry_free(&g);
}

static void try_leaving_spheres(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_start(d, SOLID_SPHERE, false, false, tally);
}

static void try_leaving_cylinders(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_start(d, SOLID_CYLINDER, false, false, tally);
}

static void try_leaving_meshes(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_start(d, below(d, 2) ? SOLID_BOX : SOLID_GLOBE, false, false, tally);
}

static void try_leaving_instances(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_start(d, (enum solid)below(d, 4), true, false, tally);
}

static void try_rooms(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases)
        try_start(d, below(d, 2) ? SOLID_BOX : SOLID_GLOBE, below(d, 2), true, tally);
}

/* ---- bounces, against wide numbers ------------------------------------------------------------
 */

#ifdef HAVE___FLOAT128
#include "wide.h"

enum { BOUNCES = 1000 };

/* The original's way to mirror: the direction is made a unit vector by its length. */
static struct vec3 mirrored_classic(struct vec3 d, struct vec3 normal)
{
    struct shade_batch points;
    struct vec3_batch incoming;
    struct ray_batch rays;
    memset(&points, 0, sizeof points);
    points.n = 1;
    points.incoming = &incoming;
    vec3_put(&incoming, 0, d);
    vec3_put(&points.normal, 0, normal);
    points.facing[0] = vec3_dot(normal, d);
    render_plain.reflect(&points, &rays);
    return vec3_get(&rays.direction, 0);
}

static struct vec3 mirrored_modern(struct vec3 d, struct vec3 normal)
{
    return vec3_renormalized(vec3_mirrored(d, vec3_neg(normal)));
}

/* From one point of the unit sphere to the next, exactly. */
static void wide_bounce(struct wide3 *p, struct wide3 *d)
{
    wide dd = wide_dot(*d, *d);
    *p = wide_mad(*p, -2 * wide_dot(*p, *d) / dd, *d);
    *d = wide_mad(*d, -2 * wide_dot(*p, *d) / wide_dot(*p, *p), *p);
}

/* Within a mirror of radius 1: the largest distance from the exact path, over bounces squared. */
static void try_mirrors(struct dice *d, uint64_t cases, struct tally *tally)
{
    struct geometry g = {0};
    geometry_add_sphere(&g, 0, vec3_all(0), 1);
    for (; cases > 0; cases--) {
        bool modern = below(d, 2);
        struct vec3 start = random_direction(d), normal, p;
        struct vec3 to = vec3_sub(vec3_scale(random_direction(d), uniform(d, 0, 0.95)), start);
        struct ray ray = spawned(&(struct hit){.prim = 0}, start, vec3_normalize(to));
        struct wide3 q = widen(start), direction = widen(ray.direction);
        /* the exact path starts on the sphere, too */
        q = wide_mad(q, (1 - wide_dot(q, q)) / 2, q);
        for (int n = 1; n <= BOUNCES; n++) {
            struct hit hit;
            if (!shoot(&g, &ray, &hit)) {
                tally->wrong++;
                break;
            }
            p = geometry_hit_point(&g, &ray, &hit, &normal);
            struct vec3 next = modern ? mirrored_modern(ray.direction, normal)
                                      : mirrored_classic(ray.direction, normal);
            tally->wrong += !(fabs(vec3_dot(next, next) - 1) <= 16 * EPS);
            ray = spawned(&hit, p, next);
            wide_bounce(&q, &direction);
            struct wide3 off = wide_sub(widen(p), q);
            double distance = sqrt((double)wide_dot(off, off));
            if (n >= 10)
                tally_measure(tally, distance / (1e-15 * n * n));
        }
        tally->cases++;
    }
    geometry_free(&g);
}

/* Cosine and sine squared of a direction to a normal, whatever their lengths. */
static wide wide_cosine(struct vec3 d, struct vec3 n)
{
    struct wide3 a = widen(d), b = widen(n);
    return wide_dot(a, b) / wide_sqrt(wide_dot(a, a) * wide_dot(b, b));
}

static wide wide_sine_squared(struct vec3 d, struct vec3 n)
{
    struct wide3 a = widen(d), b = widen(n), c = wide_cross(a, b);
    return wide_dot(c, c) / (wide_dot(a, a) * wide_dot(b, b));
}

/* A unit direction that meets the normal at this sine. */
static struct vec3 direction_at(struct dice *d, struct vec3 n, double sine)
{
    struct vec3 across = random_across(d, n);
    return vec3_normalize(vec3_mad(vec3_scale(across, sine), -sqrt(1 - sine * sine), n));
}

/* Total reflection may be told wrongly only where the exact cosine is below rounding. */
static void try_critical(struct dice *d, uint64_t cases, struct tally *tally)
{
    for (uint64_t i = 0; i < cases; i++) {
        struct vec3 n = random_direction(d), out;
        double eta = uniform(d, 1.0001, 2.5), off = magnitude(d, 1e-17, 0.1);
        double sine = 1 / eta * (1 + (below(d, 2) ? off : -off));
        struct vec3 in = direction_at(d, n, sine < 1 ? sine : 1 / eta);
        wide square = 1 - (wide)eta * eta * wide_sine_squared(in, n);
        if (vec3_refracted(in, n, eta, &out) != (square >= 0))
            tally_measure(tally,
                          (double)wide_abs(square) / 2 / DBL_EPSILON); /* the cosine's, times it */
        else if (square >= 0) {
            wide cosine = wide_sqrt(square), off_by = wide_abs(-wide_cosine(out, n) - cosine);
            tally_measure(tally, (double)(off_by * cosine) / DBL_EPSILON);
        }
    }
    tally->cases += cases;
}

/* Into a slab and out again: as it came, but for what a flat angle costs where it leaves. */
static void try_slabs(struct dice *d, uint64_t cases, struct tally *tally)
{
    for (uint64_t i = 0; i < cases; i++) {
        struct vec3 n = random_direction(d), inside = n, out = n;
        double ior = uniform(d, 1.0001, 2.5);
        struct vec3 in = direction_at(d, n, uniform(d, 0, 0.99));
        tally->wrong +=
            !vec3_refracted(in, n, 1 / ior, &inside) || !vec3_refracted(inside, n, ior, &out);
        double cosine = fabs(vec3_dot(in, n));
        tally_measure(tally, vec3_length(vec3_sub(out, in)) * cosine / DBL_EPSILON);
    }
    tally->cases += cases;
}

#else /* the rows are skipped */
#define try_mirrors NULL
#define try_critical NULL
#define try_slabs NULL
#endif

const struct row rows_spawn[] = {
    {"rays that leave spheres, sizes 1e-8 .. 1e8", "", 0, 100000, 10000000, try_leaving_spheres,
     false},
    {"rays that leave cylinders and their rims", "", 0, 100000, 10000000, try_leaving_cylinders,
     false},
    {"rays that leave meshes, their edges and corners", "", 0, 100000, 10000000, try_leaving_meshes,
     false},
    {"rays that leave instances of all these", "", 0, 100000, 10000000, try_leaving_instances,
     false},
    {"rays within rooms, from their inner corners", "", 0, 100000, 10000000, try_rooms, false},
    {"mirror sphere, 1000 bounces: off the path", "x 1e-15 bounces^2", 1, 40, 10000, try_mirrors,
     true},
    {"refraction near the critical angle: cosine", "DBL_EPSILON / cos", 8, 50000, 10000000,
     try_critical, true},
    {"slab: exit direction", "DBL_EPSILON / cos", 8, 50000, 10000000, try_slabs, true},
    {0},
};
