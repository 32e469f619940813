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
    return (struct target){ prim, p.kind, p.index };
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

/* The nearest of the cylinder's two possible hits above 0, or 0, and the part hit. */
double cylinder_distance(const struct cylinder *c, const struct ray *ray,
                         const struct ray_frame *frame, uint32_t *part);

struct point2 {
    double x, y;
};

/* The corner seen from the ray: moved to its origin and sheared so that the ray runs along the
 * axis.  Equal corners of two triangles give equal results. */
static inline struct point2 triangle_sheared(struct vec3 v, struct vec3 origin,
                                             const struct ray_frame *f)
{
    struct vec3 p = vec3_sub(v, origin);
    if (f->axis == 0)
        return (struct point2){ p.y - f->shear_x * p.x, p.z - f->shear_y * p.x };
    if (f->axis == 1)
        return (struct point2){ p.z - f->shear_x * p.y, p.x - f->shear_y * p.y };
    return (struct point2){ p.x - f->shear_x * p.z, p.y - f->shear_y * p.z };
}

/* Whether the sheared corners enclose the ray, by exact signs. */
bool triangle_encloses(const struct point2 corner[3]);

/* The distance of a ray that the corners enclose; 0 or not a number when it does not count. */
double triangle_distance(const struct geometry *g, const struct triangle *t, const struct ray *ray,
                         const struct ray_frame *frame);

/* -1 or 1 where the difference of the products is sure to have that sign in spite of rounding. */
static inline int sure_sign(double product, double other)
{
    double sure = 0x1p-50 * (fabs(product) + fabs(other));
    return (product - other > sure) - (product - other < -sure);
}

/* Watertight edge tests (Woop, Benthin, Wald, Watertight ray/triangle intersection, JCGT 2013) in
 * double; plain products decide all but the nearest misses. */
static inline bool triangle_meets_line(const struct geometry *g, const struct triangle *t,
                                       const struct ray *ray, const struct ray_frame *frame)
{
    const struct vec3 *v = g->vertices.at;
    struct point2 corner[3];
    for (int i = 0; i < 3; i++)
        corner[i] = triangle_sheared(v[t->vertex[i]], ray->origin, frame);
    struct point2 a = corner[0], b = corner[1], c = corner[2];
    int u = sure_sign(c.x * b.y, c.y * b.x), v_ = sure_sign(a.x * c.y, a.y * c.x);
    int w = sure_sign(b.x * a.y, b.y * a.x), sum = u + v_ + w;
    if (sum == 3 || sum == -3)
        return true;
    if ((u | v_ | w) < 0 && (u > 0 || v_ > 0 || w > 0))
        return false;
    return triangle_encloses(corner);
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
        t = cylinder_distance(&g->cylinders.at[target.index], ray, frame, &part);
    } else if (target.prim != ray->from) {
        const struct triangle *triangle = &g->triangles.at[target.index];
        if (triangle_meets_line(g, triangle, ray, frame))
            t = triangle_distance(g, triangle, ray, frame);
    }
    if (!hit_before(t, target.prim, best))
        return false;
    best->t = t;
    best->prim = target.prim;
    best->part = part;
    return true;
}

#endif
