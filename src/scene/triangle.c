#include "config.h"

#include "scene/instance.h"
#include "scene/intersect.h"
#include "scene/shape.h"

static const struct triangle *triangle_at(const struct geometry *g, uint32_t prim)
{
    return &g->triangles.at[g->prims.at[prim].index];
}

static struct vec3 corner_at(const struct geometry *g, const struct triangle *t, int i)
{
    return g->vertices.at[t->vertex[i]];
}

static struct box corner_bounds(const struct geometry *g, const struct triangle *t)
{
    struct vec3 a = corner_at(g, t, 0), b = corner_at(g, t, 1), c = corner_at(g, t, 2);
    return (struct box){vec3_min(vec3_min(a, b), c), vec3_max(vec3_max(a, b), c)};
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
    e1 = vec3_scale(e1, ldexp(1, -x1));
    e2 = vec3_scale(e2, ldexp(1, -x2));
    struct vec3 n = vec3_cross(e1, e2);
    double length = vec3_length(n);
    if (!(length > 0 && length <= DBL_MAX))
        return vec3_all(0);
    return vec3(n.x / length, n.y / length, n.z / length);
}

/* Twice the signed area of (0, p, q).  Never of the wrong sign, though it may be 0. */
static double edge(struct point2 p, struct point2 q)
{
    return difference_of_products(p.x, q.y, p.y, q.x);
}

bool triangle_encloses(struct point2 a, struct point2 b, struct point2 c)
{
    double u = edge(c, b), v = edge(a, c), w = edge(b, a);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0))
        return false;
    return fabs(u + v + w) > 0;
}

/* Keeps t within the triangle's box, of which the line is known to meet the triangle: where the
 * plane's t is off by more than a box's padding, a box tree would lose what a search of all
 * triangles finds. */
static double clamp_to_bounds(const struct geometry *g, const struct triangle *tri,
                              const struct ray *ray, double t)
{
    struct box b = corner_bounds(g, tri);
    struct vec3 o = ray->origin, d = ray->direction;
    double pad = 0.5 * BOX_PADDING * (tri->reach + vec3_largest(o));
    double near = -INFINITY, far = INFINITY, largest = vec3_largest(d);
    for (int axis = 0; axis < 3; axis++) {
        double inverse = ray_inverse(vec3_at(d, axis), largest), e = pad * fabs(inverse);
        double t0 = (vec3_at(b.lo, axis) - vec3_at(o, axis)) * inverse;
        double t1 = (vec3_at(b.hi, axis) - vec3_at(o, axis)) * inverse;
        double enter = (t0 < t1 ? t0 : t1) - e, leave = (t0 < t1 ? t1 : t0) + e;
        near = enter > near ? enter : near;
        far = leave < far ? leave : far;
    }
    if (!(t >= near))
        t = near;
    return t <= far ? t : far;
}

double triangle_distance_at_grazing(const struct geometry *g, const struct triangle *t,
                                    const struct ray *ray, double distance, double speed)
{
    return vec3_largest(t->normal) > 0 ? clamp_to_bounds(g, t, ray, distance / speed) : 0;
}

/* On the plane, and inside of each edge or as near to it as rounding errors reach. */
bool triangle_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach)
{
    const struct triangle *t = triangle_at(g, prim);
    double rounding = SPAWN_TOLERANCE * (reach + t->reach);
    if (fabs(vec3_dot(t->normal, vec3_sub(corner_at(g, t, 0), p))) > rounding)
        return false;
    for (int i = 0; i < 3; i++) {
        struct vec3 from = corner_at(g, t, i), along = vec3_sub(corner_at(g, t, (i + 1) % 3), from);
        struct vec3 inwards = vec3_cross(t->normal, along);
        if (vec3_dot(inwards, vec3_sub(p, from)) < -rounding * vec3_length(along))
            return false;
    }
    return vec3_largest(t->normal) > 0;
}

/* From plain products, unless these are so much larger than the area that rounding would show. */
void geometry_weights(const struct geometry *g, const struct ray *ray, struct hit *hit)
{
    struct spot spot = geometry_spot(g, hit);
    const struct triangle *t = triangle_at(spot.geometry, spot.prim);
    struct ray own = spot.instance ? instance_ray(spot.instance, ray, hit->t).ray : *ray;
    struct ray_frame f;
    ray_frame_init(&f, &own, false, true);
    struct seen_triangle seen = triangle_seen(spot.geometry, t, own.origin);
    struct point2 a = triangle_sheared(seen.a, &f, f.axis),
                  b = triangle_sheared(seen.b, &f, f.axis);
    struct point2 c = triangle_sheared(seen.c, &f, f.axis);
    double u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
    double largest =
        most_of_3(fabs(a.x), fabs(b.x), fabs(c.x)) * most_of_3(fabs(a.y), fabs(b.y), fabs(c.y));
    if (!(largest <= 16 * fabs(u + v + w))) {
        u = edge(c, b);
        v = edge(a, c);
        w = edge(b, a);
    }
    hit->b1 = v / (u + v + w);
    hit->b2 = w / (u + v + w);
}

/* Moved along the normal onto the plane: exactly onto it when the plane lies along two axes. */
struct vec3 triangle_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit, struct vec3 *normal)
{
    const struct triangle *t = triangle_at(g, hit->prim);
    struct vec3 p = vec3_mad(ray->origin, hit->t, ray->direction);
    *normal = t->normal;
    return vec3_mad(p, vec3_dot(t->normal, vec3_sub(corner_at(g, t, 0), p)), t->normal);
}

/* ---- edges ----------------------------------------------------------------------------------- */

/* A sliver's point may be no farther inside than this part of its height. */
#define EDGE_SHARE 0x1p-4

/* Towards the middle, until it is clear of all edges. */
struct vec3 triangle_settle(const struct geometry *g, uint32_t prim, struct vec3 p, double reach)
{
    const struct triangle *t = triangle_at(g, prim);
    struct vec3 middle = vec3_all(0);
    double clear = EDGE_CLEARANCE * SPAWN_TOLERANCE * (reach + t->reach), part = 0;
    for (int i = 0; i < 3; i++) {
        struct vec3 from = corner_at(g, t, i), along = vec3_sub(corner_at(g, t, (i + 1) % 3), from);
        struct vec3 inwards = vec3_cross_plain(t->normal, along), seen = vec3_sub(p, from);
        /* all times the edge's length */
        double inside = vec3_dot(inwards, seen);
        double height = vec3_dot(inwards, vec3_sub(corner_at(g, t, (i + 2) % 3), from));
        double wanted = fmin(clear * vec3_length(along), EDGE_SHARE * height);
        middle = vec3_mad(middle, -1.0 / 3, seen);
        if (inside < wanted)
            part = fmax(part, (wanted - inside) / (height / 3 - inside));
    }
    return part > 0 ? vec3_mad(p, part, middle) : p;
}
