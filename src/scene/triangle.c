#include "config.h"

#include "scene/shape.h"

static const struct triangle *triangle_at(const struct geometry *g, uint32_t prim)
{
    return &g->triangles.at[g->prims.at[prim].index];
}

static struct vec3 corner(const struct geometry *g, const struct triangle *t, int i)
{
    return g->vertices.at[t->vertex[i]];
}

static struct box corner_bounds(const struct geometry *g, const struct triangle *t)
{
    struct vec3 a = corner(g, t, 0), b = corner(g, t, 1), c = corner(g, t, 2);
    return (struct box){ vec3_min(vec3_min(a, b), c), vec3_max(vec3_max(a, b), c) };
}

struct box triangle_bounds(const struct geometry *g, uint32_t prim)
{
    return corner_bounds(g, triangle_at(g, prim));
}

/* The edges are brought to the order of 1 by a power of two, so that no product under- or
 * overflows; divided by its length, a normal along a coordinate is exactly that, whatever the
 * triangle: coplanar triangles then meet a ray at equal distances. */
struct vec3 triangle_unit_normal(struct vec3 v0, struct vec3 v1, struct vec3 v2)
{
    struct vec3 e1 = vec3_sub(v1, v0), e2 = vec3_sub(v2, v0);
    int x1, x2;
    frexp(vec3_largest(e1), &x1);
    frexp(vec3_largest(e2), &x2);
    struct vec3 n = vec3_cross(vec3_scale(e1, ldexp(1, -x1)), vec3_scale(e2, ldexp(1, -x2)));
    double length = vec3_length(n);
    if (!(length > 0 && length <= DBL_MAX))
        return vec3_all(0);
    return vec3(n.x / length, n.y / length, n.z / length);
}

bool triangle_plane_holds(const struct geometry *g, const struct triangle *t, struct vec3 p,
                          double distance)
{
    struct box b = corner_bounds(g, t);
    double low = vec3_largest(b.lo), high = vec3_largest(b.hi);
    double reach = vec3_largest(p) + (low > high ? low : high);
    return fabs(distance) <= SPAWN_TOLERANCE * reach;
}

struct point2 {
    double x, y;
};

/* The corner seen from the ray: moved to its origin and sheared so that the ray runs along the
 * axis.  Equal corners of two triangles give equal results. */
static struct point2 sheared(struct vec3 v, struct vec3 origin, const struct ray_frame *f)
{
    struct vec3 p = vec3_sub(v, origin);
    if (f->axis == 0)
        return (struct point2){ p.y - f->shear_x * p.x, p.z - f->shear_y * p.x };
    if (f->axis == 1)
        return (struct point2){ p.z - f->shear_x * p.y, p.x - f->shear_y * p.y };
    return (struct point2){ p.x - f->shear_x * p.z, p.y - f->shear_y * p.z };
}

/* Twice the signed area of (0, p, q).  Never of the wrong sign, though it may be 0. */
static double edge(struct point2 p, struct point2 q)
{
    return difference_of_products(p.x, q.y, p.y, q.x);
}

/* The sign of edge(p, q) where plain products are sure of it, else 0. */
static int edge_sign(struct point2 p, struct point2 q)
{
    double a = p.x * q.y, b = p.y * q.x, e = a - b, sure = 0x1p-50 * (fabs(a) + fabs(b));
    return (e > sure) - (e < -sure);
}

/* Keeps t within the triangle's box: at grazing angles the plane's t is off by more than a box's
 * padding, and a box tree would then lose what a search of all triangles finds. */
static double clamp_to_bounds(const struct geometry *g, const struct triangle *tri,
                              const struct ray *ray, const struct ray_frame *f, double t)
{
    struct box b = corner_bounds(g, tri);
    struct vec3 o = ray->origin;
    double low = vec3_largest(b.lo), high = vec3_largest(b.hi);
    double pad = 0.5 * BOX_PADDING * ((low > high ? low : high) + vec3_largest(o));
    double near = -INFINITY, far = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double inverse = vec3_at(f->inverse, axis);
        double t0 = (vec3_at(b.lo, axis) - vec3_at(o, axis)) * inverse;
        double t1 = (vec3_at(b.hi, axis) - vec3_at(o, axis)) * inverse;
        double e = pad * fabs(inverse);
        double enter = (t0 < t1 ? t0 : t1) - e, leave = (t0 < t1 ? t1 : t0) + e;
        near = enter > near ? enter : near;
        far = leave < far ? leave : far;
    }
    if (!(t >= near))
        t = near;
    return t <= far ? t : far;
}

/* Watertight edge tests (Woop, Benthin, Wald, Watertight ray/triangle intersection, JCGT 2013) in
 * double.  t comes from the plane, not from the corners' distances: it is then the same for all
 * triangles of one axis-aligned plane. */
bool triangle_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                        const struct ray_frame *frame, struct hit *best)
{
    if (prim == ray->from)
        return false;
    const struct triangle *tri = triangle_at(g, prim);
    struct vec3 v0 = corner(g, tri, 0);
    struct point2 a = sheared(v0, ray->origin, frame);
    struct point2 b = sheared(corner(g, tri, 1), ray->origin, frame);
    struct point2 c = sheared(corner(g, tri, 2), ray->origin, frame);
    int su = edge_sign(c, b), sv = edge_sign(a, c), sw = edge_sign(b, a);
    if ((su | sv | sw) == -1 && (su > 0 || sv > 0 || sw > 0))
        return false; /* sure of two signs that differ */
    double u = edge(c, b), v = edge(a, c), w = edge(b, a);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0))
        return false;
    double det = u + v + w;
    struct vec3 n = tri->normal;
    if (!(fabs(det) > 0) || vec3_largest(n) == 0)
        return false;
    double distance = vec3_dot(n, vec3_sub(v0, ray->origin));
    if (ray->spawned && triangle_plane_holds(g, tri, ray->origin, distance))
        return false;
    double t = clamp_to_bounds(g, tri, ray, frame, distance / vec3_dot(n, ray->direction));
    if (!hit_before(t, prim, best))
        return false;
    *best = (struct hit){ .t = t, .prim = prim, .b1 = v / det, .b2 = w / det };
    return true;
}

/* On the plane, and inside of each edge or as near to it as rounding errors reach. */
bool triangle_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p)
{
    const struct triangle *t = triangle_at(g, prim);
    if (!triangle_plane_holds(g, t, p, vec3_dot(t->normal, vec3_sub(corner(g, t, 0), p))))
        return false;
    for (int i = 0; i < 3; i++) {
        struct vec3 from = corner(g, t, i), along = vec3_sub(corner(g, t, (i + 1) % 3), from);
        struct vec3 inwards = vec3_cross(t->normal, along);
        double depth = vec3_dot(inwards, vec3_sub(p, from)) / vec3_length(along);
        if (depth < 0 && !triangle_plane_holds(g, t, p, depth))
            return false;
    }
    return vec3_largest(t->normal) > 0;
}

struct vec3 triangle_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit)
{
    const struct triangle *t = triangle_at(g, hit->prim);
    struct vec3 p = vec3_scale(corner(g, t, 0), 1 - hit->b1 - hit->b2);
    (void)ray;
    p = vec3_mad(p, hit->b1, corner(g, t, 1));
    return vec3_mad(p, hit->b2, corner(g, t, 2));
}

struct vec3 triangle_normal(const struct geometry *g, const struct hit *hit, struct vec3 p)
{
    (void)p;
    return triangle_at(g, hit->prim)->normal;
}
