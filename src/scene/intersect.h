/* Rays against single primitives, inlined into the loops that try many. */
#ifndef WRT_SCENE_INTERSECT_H
#define WRT_SCENE_INTERSECT_H

#include "scene/geometry.h"

/* A primitive and where its shape is. */
struct target {
    uint32_t prim;
    uint32_t kind : 2, index : 30;
};

static inline struct target target_of(const struct geometry *g, uint32_t prim)
{
    struct prim p = g->prims.at[prim];
    return (struct target){prim, p.kind, p.index};
}

/* As geometry_prim_bounds, for spheres without a detour. */
static inline struct box target_bounds(const struct geometry *g, struct target target)
{
    if (target.kind != PRIM_SPHERE)
        return geometry_prim_bounds(g, target.prim);
    const struct sphere *s = &g->spheres.at[target.index];
    return (struct box){vec3_sub(s->center, vec3_all(s->radius)),
                        vec3_add(s->center, vec3_all(s->radius))};
}

/* |p - center|^2 - radius^2 of a point with f = p - center and largest coordinate `reach`; exactly
 * 0 when it lies on the sphere within the tolerance. */
static inline double sphere_power(const struct sphere *s, struct vec3 f, double reach,
                                  double tolerance)
{
    double c = vec3_dot(f, f) - s->radius * s->radius;
    return fabs(c) <= tolerance * 2 * s->radius * (reach + s->reach) ? 0 : c;
}

/* The nearest root above 0; 0 or not a number when there is none.
 *
 * The discriminant from the ray's point nearest to the center keeps its digits however far the
 * origin is (Haines, Guenther, Akenine-Moeller, Precision improvements for ray/sphere intersection,
 * Ray Tracing Gems 2019, ch. 7). */
static inline double sphere_distance(const struct sphere *s, const struct ray *ray,
                                     const struct ray_frame *frame)
{
    struct vec3 d = ray->direction, f = vec3_sub(ray->origin, s->center);
    double b = -vec3_dot(f, d), c = sphere_power(s, f, frame->reach, frame->tolerance);
    if (c >= 0 && !(b > 0))
        return 0; /* outside and leaving */
    double ahead = b * frame->inverse_square;
    if (c == 0)
        return 2 * ahead; /* the origin is one root, the chord's other end the other */
    struct vec3 l = vec3_mad(f, ahead, d);
    double discriminant = s->radius * s->radius - vec3_dot(l, l);
    if (!(discriminant >= 0))
        return 0;
    double q = b + copysign(sqrt(frame->square * discriminant), b);
    return c > 0 || q < 0 ? c / q : q * frame->inverse_square;
}

/* A cylinder seen from a ray's origin. */
struct seen_cylinder {
    struct vec3 m; /* from the base to the origin */
    struct vec3 w; /* m x axis */
};

/* Plain products: their error is within what the angle to the axis costs anyway. */
static inline struct seen_cylinder cylinder_seen(const struct cylinder *c, struct vec3 origin)
{
    struct vec3 m = vec3_sub(origin, c->base);
    return (struct seen_cylinder){m, vec3_cross_plain(m, c->axis)};
}

/* False when the ray's line passes the axis too far off; most rays end here. */
static inline bool cylinder_is_near(const struct cylinder *c, const struct seen_cylinder *seen,
                                    const struct ray *ray, const struct ray_frame *frame)
{
    double off = vec3_dot(ray->direction, seen->w); /* distance times |direction x axis| */
    return off * off <= c->radius * c->radius * frame->square;
}

/* The nearest of the two possible hits above 0, or 0, and the part hit. */
double cylinder_distance(const struct cylinder *c, const struct seen_cylinder *seen,
                         const struct ray *ray, const struct ray_frame *frame, uint32_t *part);

struct point2 {
    double x, y;
};

/* The corners seen from a ray's origin. */
struct seen_triangle {
    struct vec3 a, b, c;
};

static inline struct seen_triangle triangle_seen(const struct geometry *g, const struct triangle *t,
                                                 struct vec3 origin)
{
    const struct vec3 *v = g->vertices.at;
    return (struct seen_triangle){vec3_sub(v[t->vertex[0]], origin),
                                  vec3_sub(v[t->vertex[1]], origin),
                                  vec3_sub(v[t->vertex[2]], origin)};
}

/* A corner sheared so that the ray runs along the axis.  Equal corners of two triangles give equal
 * results. */
static inline struct point2 triangle_sheared(struct vec3 p, const struct ray_frame *f, int axis)
{
    if (axis == 0)
        return (struct point2){p.y - f->shear_x * p.x, p.z - f->shear_y * p.x};
    if (axis == 1)
        return (struct point2){p.z - f->shear_x * p.y, p.x - f->shear_y * p.y};
    return (struct point2){p.x - f->shear_x * p.z, p.y - f->shear_y * p.z};
}

/* Whether the sheared corners enclose the ray, by exact signs. */
bool triangle_encloses(struct point2 a, struct point2 b, struct point2 c);

/* The distance of a ray at a small angle to the triangle's plane, the quotient of the other two. */
double triangle_distance_at_grazing(const struct geometry *g, const struct triangle *t,
                                    const struct ray *ray, double distance, double speed);

/* The distance of a ray that the corners enclose, of which the first is seen at `corner`; 0 or not
 * a number when it does not count.
 *
 * It comes from the plane, not from the corners' distances: it is then the same for all triangles
 * of one axis-aligned plane.  Above an angle of about 15 degrees to the plane its error stays
 * within a box's padding. */
static inline double triangle_distance(const struct geometry *g, const struct triangle *t,
                                       struct vec3 corner, const struct ray *ray,
                                       const struct ray_frame *frame)
{
    double distance = vec3_dot(t->normal, corner), speed = vec3_dot(t->normal, ray->direction);
    double rounding = frame->tolerance * (frame->reach + t->reach);
    if (fabs(distance) <= rounding)
        return 0; /* the origin is on the plane */
    if (speed * speed >= 0x1p-4 * frame->square)
        return distance / speed;
    return triangle_distance_at_grazing(g, t, ray, distance, speed);
}

static inline double least_of_3(double a, double b, double c)
{
    double m = a < b ? a : b;
    return m < c ? m : c;
}

static inline double most_of_3(double a, double b, double c)
{
    double m = a > b ? a : b;
    return m > c ? m : c;
}

/* Watertight edge tests (Woop, Benthin, Wald, Watertight ray/triangle intersection, JCGT 2013) in
 * double.  Rounding keeps order: the difference of two rounded products is never of the wrong sign,
 * and only where one is 0 have exact signs to decide. */
static inline bool triangle_meets_axis(const struct seen_triangle *seen, const struct ray_frame *f,
                                       int axis)
{
    struct point2 a = triangle_sheared(seen->a, f, axis), b = triangle_sheared(seen->b, f, axis);
    struct point2 c = triangle_sheared(seen->c, f, axis);
    double u = c.x * b.y - c.y * b.x, v_ = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
    double least = least_of_3(u, v_, w), most = most_of_3(u, v_, w);
    if (least < 0 && most > 0)
        return false;
    return least > 0 || most < 0 || triangle_encloses(a, b, c);
}

static inline bool triangle_meets_line(const struct seen_triangle *seen, const struct ray_frame *f)
{
    if (f->axis == 0)
        return triangle_meets_axis(seen, f, 0);
    if (f->axis == 1)
        return triangle_meets_axis(seen, f, 1);
    return triangle_meets_axis(seen, f, 2);
}

/* The hit at t, if it comes before *best. */
static inline bool target_offer(double t, uint32_t prim, uint32_t part, struct hit *best)
{
    if (!hit_before(t, prim, best))
        return false;
    best->t = t;
    best->prim = prim;
    best->part = part;
    return true;
}

/* See geometry_intersect. */
static inline bool target_intersect(const struct geometry *g, struct target target,
                                    const struct ray *ray, const struct ray_frame *frame,
                                    struct hit *best)
{
    uint32_t part = 0;
    double t = 0;
    if (target.kind == PRIM_SPHERE) {
        t = sphere_distance(&g->spheres.at[target.index], ray, frame);
    } else if (target.kind == PRIM_CYLINDER) {
        const struct cylinder *cylinder = &g->cylinders.at[target.index];
        struct seen_cylinder seen = cylinder_seen(cylinder, ray->origin);
        if (cylinder_is_near(cylinder, &seen, ray, frame))
            t = cylinder_distance(cylinder, &seen, ray, frame, &part);
    } else if (target.prim != ray->from) {
        const struct triangle *triangle = &g->triangles.at[target.index];
        struct seen_triangle seen = triangle_seen(g, triangle, ray->origin);
        if (triangle_meets_line(&seen, frame))
            t = triangle_distance(g, triangle, seen.a, ray, frame);
    }
    return target_offer(t, target.prim, part, best);
}

#endif
