/* Spheres, cylinders and triangles against 113-bit arithmetic.
 *
 * A hit is measured by how far it is from the surface.  Which root it is, and whether there must be
 * one at all, is told by the solid made smaller by the bound: a ray that meets this one must hit,
 * not behind where it enters it.  A hit where there is none is far from the surface. */
#include "config.h"

#include "stress.h"

#include "scene/intersect.h"

#ifdef HAVE___FLOAT128
#include "wide.h"

/* The part of a ray's line within a solid. */
struct span {
    wide enter, leave;
};

#define SPAN_NONE ((struct span){1, 0})

/* L is the distance that rounding errors are measured by, `bound` what a hit may be off by. */
struct case_of_solid {
    struct geometry g;
    struct ray ray;
    double length, bound;
    bool inside; /* the origin is */
};

static bool is_right(const struct case_of_solid *c, struct span smaller, const struct hit *hit)
{
    bool hits = hit->prim != PRIM_NONE;
    if (!(smaller.enter <= smaller.leave) || smaller.leave <= 0)
        return true;
    if (c->inside)
        return hits && hit->t >= smaller.leave;
    return hits && hit->t <= smaller.enter;
}

/* ---- spheres --------------------------------------------------------------------------------- */

static double off_sphere(const struct sphere *s, struct wide3 from_center)
{
    wide square = wide_dot(from_center, from_center), r = s->radius;
    return fabs((double)(square - r * r) / (sqrt((double)square) + s->radius));
}

static struct span sphere_span(const struct sphere *s, const struct ray *ray, double smaller)
{
    struct wide3 f = wide_seen(ray->origin, s->center), d = widen(ray->direction);
    wide dd = wide_dot(d, d), ahead = -wide_dot(f, d) / dd, r = (wide)s->radius - smaller;
    wide half = r * r - wide_dot(f, f) + ahead * ahead * dd;
    if (!(half >= 0))
        return SPAN_NONE;
    half = wide_sqrt(half / dd);
    return (struct span){ahead - half, ahead + half};
}

/* A third of the rays passes the surface by no more than rounding errors. */
static struct case_of_solid sphere_case(struct dice *d, double size, double offset)
{
    struct case_of_solid c = {.inside = below(d, 8) == 0};
    double far = size * (c.inside ? uniform(d, 0, 0.9) : magnitude(d, 1.5, 1e9));
    struct vec3 center = random_vector(d, offset), away = random_direction(d);
    geometry_add_sphere(&c.g, 0, center, size);
    c.length = far + size;
    c.bound = 8 * EPS * c.length;
    struct vec3 origin = vec3_mad(center, far, away);
    double off = size * uniform(d, 0, 1.2);
    if (below(d, 3) == 0)
        off = size + c.bound * uniform(d, -3, 3);
    c.ray = ray_between(origin, vec3_mad(center, off, random_across(d, away)));
    if (below(d, 2))
        c.ray.direction = vec3_scale(c.ray.direction, magnitude(d, 1e-3, 1e3) / c.length);
    return c;
}

static void try_spheres(struct dice *d, uint64_t cases, struct tally *tally)
{
    for (uint64_t i = 0; i < cases; i++) {
        double size = magnitude(d, 1e-8, 1e8);
        struct case_of_solid c = sphere_case(d, size, size * uniform(d, 0, 10));
        const struct sphere *s = &c.g.spheres.at[0];
        struct hit hit;
        if (shoot(&c.g, &c.ray, &hit)) {
            struct wide3 f = wide_seen(c.ray.origin, s->center);
            double off = off_sphere(s, wide_mad(f, hit.t, widen(c.ray.direction)));
            tally_measure(tally, off / (EPS * c.length));
        }
        tally->wrong += !is_right(&c, sphere_span(s, &c.ray, c.bound), &hit);
        geometry_free(&c.g);
    }
    tally->cases += cases;
}

/* ---- cylinders ------------------------------------------------------------------------------- */

/* The axis is a unit vector but for its rounding. */
static struct wide3 wide_axis(const struct cylinder *c)
{
    struct wide3 e = widen(c->axis), zero = {0, 0, 0};
    return wide_mad(zero, (3 - wide_dot(e, e)) / 2, e);
}

static double off_cylinder(const struct cylinder *c, struct wide3 from_base)
{
    struct wide3 e = wide_axis(c), w = wide_cross(from_base, e);
    wide z = wide_dot(from_base, e), square = wide_dot(w, w), r = c->radius;
    double side = (double)(square - r * r) / (sqrt((double)square) + c->radius);
    double below_base = (double)-z, above_top = (double)(z - c->height);
    double caps = fmax(below_base, above_top);
    if (side > 0 && caps > 0)
        return hypot(side, caps);
    return fabs(fmax(side, caps));
}

static struct span cylinder_span(const struct cylinder *c, const struct ray *ray, double smaller)
{
    struct wide3 m = wide_seen(ray->origin, c->base), d = widen(ray->direction), e = wide_axis(c);
    struct wide3 w = wide_cross(m, e), n = wide_cross(d, e);
    wide nn = wide_dot(n, n), nw = wide_dot(n, w), r = (wide)c->radius - smaller;
    wide power = wide_dot(w, w) - r * r, root = nw * nw - nn * power;
    struct span s = {-1e300, 1e300};
    if (nn > 0) {
        if (!(root >= 0))
            return SPAN_NONE;
        root = wide_sqrt(root);
        s = (struct span){(-nw - root) / nn, (-nw + root) / nn};
    } else if (power > 0) {
        return SPAN_NONE;
    }
    wide z = wide_dot(m, e), speed = wide_dot(d, e), to_base = smaller - z;
    wide to_top = (wide)c->height - smaller - z;
    if (speed == 0)
        return to_base <= 0 && to_top >= 0 ? s : SPAN_NONE;
    wide first = (speed > 0 ? to_base : to_top) / speed;
    wide last = (speed > 0 ? to_top : to_base) / speed;
    s.enter = first > s.enter ? first : s.enter;
    s.leave = last < s.leave ? last : s.leave;
    return s;
}

/* A point to aim at: within, on a rim, or on the side's outline, all but for `off`. */
static struct vec3 cylinder_target(struct dice *d, const struct cylinder *c, struct vec3 view,
                                   double off)
{
    struct vec3 axis = c->axis, outline = vec3_cross(axis, view), out = random_across(d, axis);
    double z = uniform(d, -0.1, 1.1) * c->height, rho = uniform(d, 0, 1.2) * c->radius;
    uint32_t kind = below(d, 4);
    if (kind == 0) {
        z = below(d, 2) ? c->height + off : off;
        rho = c->radius + off * uniform(d, -1, 1);
    } else if (kind == 1 && vec3_length(outline) > 0) {
        out = vec3_normalize(outline);
        rho = c->radius + off;
    }
    return vec3_mad(vec3_mad(c->base, z, axis), rho, out);
}

static struct case_of_solid cylinder_case(struct dice *d, double radius, double offset)
{
    struct case_of_solid c = {.inside = below(d, 8) == 0};
    double height = radius * magnitude(d, 0.01, 100), reach = radius + height;
    struct vec3 base = random_vector(d, offset), away = random_direction(d);
    struct vec3 axis = below(d, 3) ? random_direction(d) : vec3(0, 1, 0);
    geometry_add_cylinder(&c.g, 0, base, vec3_mad(base, height, axis), radius);
    const struct cylinder *cylinder = &c.g.cylinders.at[0];
    double far = fmax(radius * magnitude(d, 1, 1e9), 2 * reach);
    if (below(d, 6) == 0) /* nearly along the axis */
        away = vec3_normalize(
            vec3_mad(cylinder->axis, magnitude(d, 1e-6, 1), random_across(d, cylinder->axis)));
    struct vec3 origin = vec3_mad(base, far, away);
    if (c.inside)
        origin = vec3_mad(vec3_mad(base, uniform(d, 0.4, 0.6) * cylinder->height, cylinder->axis),
                          uniform(d, 0, 0.5) * radius, random_across(d, cylinder->axis));
    c.length = vec3_length(vec3_sub(origin, base)) + reach;
    c.ray = ray_between(
        origin, cylinder_target(d, cylinder, away, 16 * EPS * c.length * uniform(d, -3, 3)));
    if (below(d, 16) == 0)
        c.ray.direction = vec3_scale(cylinder->axis, below(d, 2) ? -1 : 1);
    struct vec3 along = vec3_normalize(c.ray.direction);
    double sine = vec3_length(vec3_cross(along, cylinder->axis));
    c.bound = 16 * EPS * c.length / (sine > 0 ? sine : 1);
    return c;
}

/* Left out are rays so far along the axis that the bound is no smaller than the cylinder. */
static void try_cylinders(struct dice *d, uint64_t cases, struct tally *tally)
{
    for (uint64_t i = 0; i < cases; i++) {
        double size = magnitude(d, 1e-8, 1e8);
        struct case_of_solid c = cylinder_case(d, size, size * uniform(d, 0, 10));
        const struct cylinder *s = &c.g.cylinders.at[0];
        struct hit hit;
        if (c.bound < 0.1 * fmin(s->radius, s->height)) {
            if (shoot(&c.g, &c.ray, &hit)) {
                struct wide3 m = wide_seen(c.ray.origin, s->base);
                double off = off_cylinder(s, wide_mad(m, hit.t, widen(c.ray.direction)));
                tally_measure(tally, 16 * off / c.bound);
            }
            tally->wrong += !is_right(&c, cylinder_span(s, &c.ray, c.bound), &hit);
            tally->cases++;
        }
        geometry_free(&c.g);
    }
}

/* ---- triangles ------------------------------------------------------------------------------- */

struct triangle_case {
    struct geometry g;
    struct vec3 v[3];
    struct ray ray;
    double length, size, aspect; /* longest edge; that over the height above it */
};

/* Half of the rays pass an edge by no more than rounding errors. */
static struct triangle_case triangle_case(struct dice *d, double size, double offset)
{
    struct triangle_case c = {.size = size};
    struct vec3 at = random_vector(d, offset), along = random_direction(d);
    double thin = below(d, 2) ? 1 : magnitude(d, 1e-4, 1);
    c.v[0] = vec3_mad(at, -size / 2, along);
    c.v[1] = vec3_mad(at, size / 2, along);
    c.v[2] = vec3_mad(vec3_mad(at, size * uniform(d, -0.5, 0.5), along),
                      size * thin * uniform(d, 0.5, 0.9), random_across(d, along));
    for (int i = 0; i < 3; i++)
        geometry_add_vertex(&c.g, c.v[i]);
    geometry_add_triangle(&c.g, 0, 0, 1, 2);
    c.aspect = 2 / thin;
    double far = size * magnitude(d, 2, 1e9), a = uniform(d, -0.2, 1.2), b = uniform(d, 0, 1 - a);
    struct vec3 away = random_direction(d), origin = vec3_mad(at, far, away);
    c.length = far + size;
    struct vec3 to =
        vec3_mad(vec3_mad(c.v[0], a, vec3_sub(c.v[1], c.v[0])), b, vec3_sub(c.v[2], c.v[0]));
    if (below(d, 2)) {
        int k = (int)below(d, 3);
        to = vec3_mad(c.v[k], uniform(d, -0.1, 1.1), vec3_sub(c.v[(k + 1) % 3], c.v[k]));
        to = vec3_add(to, random_vector(d, 8 * EPS * c.length));
    }
    c.ray = ray_between(origin, to);
    if (below(d, 2))
        c.ray.direction = vec3_scale(c.ray.direction, magnitude(d, 1e-3, 1e3) / c.length);
    return c;
}

/* Signs of the ray's sides of the three edges: 1 or -1 when it passes through, else 0. */
static int true_side(const struct triangle_case *c)
{
    struct wide3 p[3], d = widen(c->ray.direction);
    int above = 0, under = 0;
    for (int i = 0; i < 3; i++)
        p[i] = wide_seen(c->v[i], c->ray.origin);
    for (int i = 0; i < 3; i++) {
        wide side = wide_dot(d, wide_cross(p[i], p[(i + 1) % 3]));
        above += side > 0;
        under += side < 0;
    }
    return above == 3 ? 1 : under == 3 ? -1 : 0;
}

/* The distance of the ray's line from the nearest point of an edge, seen along the line. */
static double line_to_edges(const struct triangle_case *c)
{
    struct wide3 p[3], d = widen(c->ray.direction);
    wide dd = wide_dot(d, d), least = 1e300;
    for (int i = 0; i < 3; i++) {
        p[i] = wide_seen(c->v[i], c->ray.origin);
        p[i] = wide_mad(p[i], -wide_dot(p[i], d) / dd, d);
    }
    for (int i = 0; i < 3; i++) {
        struct wide3 edge = wide_sub(p[(i + 1) % 3], p[i]);
        wide length = wide_dot(edge, edge), at = length > 0 ? -wide_dot(p[i], edge) / length : 0;
        struct wide3 nearest = wide_mad(p[i], at < 0 ? 0 : at > 1 ? 1 : at, edge);
        wide square = wide_dot(nearest, nearest);
        least = square < least ? square : least;
    }
    return sqrt((double)least);
}

/* a b - c d: both products are exact. */
static int sign_of_difference(double a, double b, double c, double d)
{
    wide ab = (wide)a * b, cd = (wide)c * d;
    return (ab > cd) - (ab < cd);
}

/* Three corners in the plane across the ray, each nearly on a line with another and the ray, often
 * exactly so. */
static void try_edge_signs(struct dice *d, uint64_t cases, struct tally *tally)
{
    static const struct ray_frame frame = {.axis = 2};
    for (uint64_t i = 0; i < cases; i++) {
        struct vec3 v[3];
        v[0] = random_vector(d, magnitude(d, 1e-8, 1e8));
        for (int k = 1; k < 3; k++) {
            double by = uniform(d, -2, 2) * magnitude(d, 1e-3, 1e3);
            v[k] = below(d, 4) ? vec3_scale(v[k - 1], by) : random_vector(d, fabs(by));
            if (below(d, 2))
                v[k].x *= 1 + ((int)below(d, 9) - 4) * 2 * EPS;
        }
        int above = 0, under = 0;
        for (int k = 0; k < 3; k++) {
            struct vec3 p = v[k], q = v[(k + 1) % 3];
            int sign = sign_of_difference(q.x, p.y, q.y, p.x);
            above += sign > 0;
            under += sign < 0;
        }
        struct seen_triangle seen = {v[0], v[1], v[2]};
        bool encloses = !(above && under) && (above || under);
        tally->wrong += triangle_meets_axis(&seen, &frame, 2) != encloses;
    }
    tally->cases += cases;
}

static void try_triangle_edges(struct dice *d, uint64_t cases, struct tally *tally)
{
    for (uint64_t i = 0; i < cases; i++) {
        double size = magnitude(d, 1e-8, 1e8);
        struct triangle_case c = triangle_case(d, size, size * uniform(d, 0, 10));
        struct hit hit;
        bool hits = shoot(&c.g, &c.ray, &hit);
        if (hits != (true_side(&c) != 0))
            tally_measure(tally, line_to_edges(&c) / (EPS * c.length));
        geometry_free(&c.g);
    }
    tally->cases += cases;
}

/* A sliver's plane is known no better than its corners, across it. */
static void try_triangle_planes(struct dice *d, uint64_t cases, struct tally *tally)
{
    for (uint64_t i = 0; i < cases; i++) {
        double size = magnitude(d, 1e-8, 1e8);
        struct triangle_case c = triangle_case(d, size, size * uniform(d, 0, 10));
        struct hit hit;
        if (shoot(&c.g, &c.ray, &hit)) {
            struct wide3 e = wide_seen(c.v[1], c.v[0]), f = wide_seen(c.v[2], c.v[0]);
            struct wide3 n = wide_cross(e, f), o = wide_seen(c.ray.origin, c.v[0]);
            wide off = wide_dot(n, wide_mad(o, hit.t, widen(c.ray.direction)));
            double length = c.length + c.aspect * c.size;
            off = wide_abs(off) / wide_sqrt(wide_dot(n, n));
            tally_measure(tally, (double)off / (EPS * length));
            tally->cases++;
        }
        geometry_free(&c.g);
    }
}

/* ---- hit points ------------------------------------------------------------------------------ */

static double off_triangle(const struct triangle_case *c, struct vec3 p)
{
    struct wide3 n = wide_cross(wide_seen(c->v[1], c->v[0]), wide_seen(c->v[2], c->v[0]));
    wide off = wide_dot(n, wide_seen(p, c->v[0]));
    return (double)(wide_abs(off) / wide_sqrt(wide_dot(n, n)));
}

/* A point of a surface, and how well it can be known. */
struct hit_point {
    struct ray ray;
    struct vec3 p;
    double off;    /* its distance from the surface */
    double extent; /* its largest coordinate or that of what the surface is told by: a long
                    * cylinder's far end is told by its base */
};

/* Of any kind.  False: nothing was hit. */
static bool any_hit_point(struct dice *d, double size, double offset, double farthest,
                          struct hit_point *h)
{
    struct hit hit;
    struct vec3 normal;
    uint32_t kind = below(d, 3);
    if (kind == PRIM_TRIANGLE) {
        struct triangle_case c = triangle_case(d, size, offset);
        bool hits = c.length <= farthest && c.aspect < 10 && shoot(&c.g, &c.ray, &hit);
        h->ray = c.ray;
        if (hits) {
            h->p = geometry_hit_point(&c.g, &c.ray, &hit, &normal);
            h->off = off_triangle(&c, h->p);
            h->extent = vec3_largest(h->p);
        }
        geometry_free(&c.g);
        return hits;
    }
    struct case_of_solid c =
        kind == PRIM_SPHERE ? sphere_case(d, size, offset) : cylinder_case(d, size, offset);
    bool hits = c.length <= farthest && shoot(&c.g, &c.ray, &hit);
    h->ray = c.ray;
    if (hits) {
        bool round = kind == PRIM_SPHERE;
        struct vec3 told = round ? c.g.spheres.at[0].center : c.g.cylinders.at[0].base;
        h->p = geometry_hit_point(&c.g, &c.ray, &hit, &normal);
        h->off = round ? off_sphere(c.g.spheres.at, wide_seen(h->p, told))
                       : off_cylinder(c.g.cylinders.at, wide_seen(h->p, told));
        h->extent = fmax(vec3_largest(h->p), vec3_largest(told));
    }
    geometry_free(&c.g);
    return hits;
}

static void try_hit_points(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases) {
        double size = magnitude(d, 1e-8, 1e8), offset = size * uniform(d, 0, 100);
        struct hit_point h;
        if (any_hit_point(d, size, offset, 1e9 * size, &h)) {
            tally_measure(tally, h.off / (EPS * (h.extent + size)));
            tally->cases++;
        }
    }
}

static double off_line(const struct ray *ray, struct vec3 p)
{
    struct wide3 d = widen(ray->direction), c = wide_cross(wide_seen(p, ray->origin), d);
    return (double)wide_sqrt(wide_dot(c, c) / wide_dot(d, d));
}

static struct wide3 wide_image(const struct affine *map, struct vec3 p)
{
    wide out[3];
    for (int i = 0; i < 3; i++)
        out[i] = (wide)map->m[i][0] * p.x + (wide)map->m[i][1] * p.y + (wide)map->m[i][2] * p.z +
                 map->m[i][3];
    return (struct wide3){out[0], out[1], out[2]};
}

/* The distance of a hit on an instance from the plane of the exact image of its triangle. */
static double off_image(const struct geometry *g, const struct hit *hit, struct vec3 p)
{
    struct spot spot = geometry_spot(g, hit);
    const struct triangle *t = &spot.geometry->triangles.at[spot.prim];
    struct wide3 v[3];
    for (int k = 0; k < 3; k++)
        v[k] = wide_image(&spot.instance->to_world, spot.geometry->vertices.at[t->vertex[k]]);
    struct wide3 n = wide_cross(wide_sub(v[1], v[0]), wide_sub(v[2], v[0]));
    wide off = wide_dot(n, wide_sub(widen(p), v[0]));
    return (double)(wide_abs(off) / wide_sqrt(wide_dot(n, n)));
}

/* Against baked geometry: what rounding errors grow by on the way there and back is known. */
static void try_instances(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases) {
        struct geometry g = {0};
        struct hit hit;
        struct vec3 normal;
        double size = magnitude(d, 1e-8, 1e8), uneven = magnitude(d, 1, 1000);
        struct affine map = random_map(d, size, uneven, magnitude(d, 1, 1000));
        uint32_t number = geometry_add_prototype(&g);
        add_box(&g.prototypes.at[number]->shapes, vec3_all(0), 1);
        tally->wrong += !geometry_add_instance(&g, 0, number, PRIM_NONE, &map);
        struct vec3 middle = affine_point(&map, vec3_all(0));
        struct vec3 from = vec3_mad(middle, size * magnitude(d, 3, 1e6), random_direction(d));
        struct ray ray = ray_between(from, affine_point(&map, random_vector(d, 0.9)));
        if (shoot(&g, &ray, &hit)) {
            struct vec3 p = geometry_hit_point(&g, &ray, &hit, &normal);
            double length = vec3_largest(p) + size;
            tally_measure(tally, off_image(&g, &hit, p) / (EPS * g.worst_growth * length));
            tally->cases++;
        }
        geometry_free(&g);
    }
}

/* Things of size 1, seen from no farther than 100 sizes, moved far away as a whole. */
static void try_translations(struct dice *d, uint64_t cases, struct tally *tally)
{
    while (tally->cases < cases) {
        double far = ldexp(1, 20 + (int)below(d, 11));
        struct hit_point h;
        if (any_hit_point(d, 1, far, 100, &h)) {
            double length = fmax(vec3_largest(h.p), 0x1p20);
            tally_measure(tally, h.off / (EPS * length));
            tally_measure(tally, off_line(&h.ray, h.p) / (EPS * length));
            tally->cases++;
        }
    }
}

#else /* the rows are skipped */
#define try_spheres NULL
#define try_cylinders NULL
#define try_edge_signs NULL
#define try_triangle_edges NULL
#define try_triangle_planes NULL
#define try_hit_points NULL
#define try_instances NULL
#define try_translations NULL
#endif

const struct row rows_exact[] = {
    {"sphere: off its surface; root, hit or miss", "eps L", 8, 100000, 100000000, try_spheres,
     true},
    {"cylinder: off its surface; root, hit or miss", "eps L / sin angle", 16, 100000, 100000000,
     try_cylinders, true},
    {"triangle: a wrong hit or miss is this near an edge", "eps L", 8, 100000, 100000000,
     try_triangle_edges, true},
    {"triangle: exact signs of nearly degenerate corners", "", 0, 100000, 100000000, try_edge_signs,
     true},
    {"triangle: off its plane", "eps (L + sliver)", 8, 50000, 10000000, try_triangle_planes, true},
    {"hit points: off the surface", "eps coordinates", 8, 50000, 10000000, try_hit_points, true},
    {"instances: off the image of the mesh", "eps coordinates growth", 4, 20000, 10000000,
     try_instances, true},
    {"moved by 2^20 .. 2^30: off surface and ray", "eps translation", 8, 50000, 10000000,
     try_translations, true},
    {0},
};
