#include "config.h"

#include "scene/intersect.h"
#include "scene/shape.h"

static const struct cylinder *cylinder_at(const struct geometry *g, uint32_t prim)
{
    return &g->cylinders.at[g->prims.at[prim].index];
}

/* A disc of unit normal e reaches sqrt(1 - e.x^2) of its radius along x, written without the
 * cancellation. */
struct box cylinder_bounds(const struct geometry *g, uint32_t prim)
{
    const struct cylinder *c = cylinder_at(g, prim);
    struct vec3 e = c->axis, top = vec3_mad(c->base, c->height, e);
    struct vec3 disc =
        vec3(sqrt(e.y * e.y + e.z * e.z), sqrt(e.z * e.z + e.x * e.x), sqrt(e.x * e.x + e.y * e.y));
    disc = vec3_scale(disc, c->radius);
    return (struct box){vec3_sub(vec3_min(c->base, top), disc),
                        vec3_add(vec3_max(c->base, top), disc)};
}

/* The part of a line within a convex solid: from t[0] to t[1], and which part of the surface
 * bounds it there. */
struct stretch {
    double t[2];
    uint32_t part[2];
};

static double reach_of(const struct cylinder *c)
{
    return vec3_largest(c->base) + c->height + c->radius;
}

/* Within the endless cylinder around the axis: |w + t n| <= r.  Lengths below `rounding` are
 * rounding errors. */
static bool clip_to_side(const struct cylinder *c, const struct seen_cylinder *seen,
                         struct vec3 direction, double rounding, struct stretch *s)
{
    struct vec3 n = vec3_cross_plain(direction, c->axis);
    double a = vec3_dot(n, n), off = vec3_dot(direction, seen->w), r2 = c->radius * c->radius;
    double b = vec3_dot(n, seen->w);
    double power = vec3_dot(seen->w, seen->w) - r2; /* of the origin: 0 on the side */
    if (fabs(power) <= 2 * c->radius * rounding)
        power = 0;
    if (power > 0 && off * off > r2 * a)
        return false;
    if (a == 0) {
        *s = (struct stretch){{-INFINITY, INFINITY}, {CYLINDER_SIDE, CYLINDER_SIDE}};
        return power <= 0;
    }
    if (power > 0 && !(b < 0))
        return false; /* outside and leaving */
    double t0, t1;
    if (power == 0) { /* the origin is one root */
        t0 = 0;
        t1 = -2 * b / a;
    } else {
        /* from inside both terms are positive, however nearly the ray follows the axis */
        double square = power < 0 ? b * b - a * power : a * (r2 - off * off / a);
        double q = -(b + copysign(sqrt(square > 0 ? square : 0), b));
        t0 = power / q;
        t1 = q / a;
    }
    *s = (struct stretch){{t0 < t1 ? t0 : t1, t0 < t1 ? t1 : t0}, {CYLINDER_SIDE, CYLINDER_SIDE}};
    return true;
}

/* Between the planes of the caps.  Where a cap bounds the stretch as closely as the side, the cap
 * is hit. */
static bool clip_to_caps(const struct cylinder *c, struct vec3 m, struct vec3 direction,
                         double rounding, struct stretch *s)
{
    double z = vec3_dot(m, c->axis), speed = vec3_dot(direction, c->axis);
    double to_base = fabs(z) <= rounding ? 0 : -z;
    double to_top = fabs(c->height - z) <= rounding ? 0 : c->height - z;
    if (speed == 0)
        return to_base <= 0 && to_top >= 0;
    double t_base = to_base / speed, t_top = to_top / speed;
    bool up = speed > 0;
    double enter = up ? t_base : t_top, leave = up ? t_top : t_base;
    if (enter >= s->t[0]) {
        s->t[0] = enter;
        s->part[0] = up ? CYLINDER_BASE : CYLINDER_TOP;
    }
    if (leave <= s->t[1]) {
        s->t[1] = leave;
        s->part[1] = up ? CYLINDER_TOP : CYLINDER_BASE;
    }
    return true;
}

/* The active bound of the stretch tells side from cap, so nothing leaks at the rims. */
double cylinder_distance(const struct cylinder *c, const struct seen_cylinder *seen,
                         const struct ray *ray, const struct ray_frame *frame, uint32_t *part)
{
    struct vec3 d = ray->direction;
    double rounding = frame->tolerance * (frame->reach + reach_of(c));
    struct stretch s;
    if (!clip_to_side(c, seen, d, rounding, &s) || !clip_to_caps(c, seen->m, d, rounding, &s) ||
        !(s.t[0] <= s.t[1]))
        return 0;
    int end = s.t[0] > 0 ? 0 : 1;
    *part = s.part[end];
    return s.t[end];
}

bool cylinder_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach)
{
    const struct cylinder *c = cylinder_at(g, prim);
    struct vec3 m = vec3_sub(p, c->base), w = vec3_cross_plain(m, c->axis);
    double z = vec3_dot(m, c->axis), r2 = c->radius * c->radius;
    double power = vec3_dot(w, w) - r2;
    double rounding = SPAWN_TOLERANCE * (reach + reach_of(c));
    if (z < -rounding || z > c->height + rounding || power > 2 * c->radius * rounding)
        return false;
    return power >= -2 * c->radius * rounding || z <= rounding || z >= c->height - rounding;
}

struct vec3 cylinder_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit, struct vec3 *normal)
{
    const struct cylinder *c = cylinder_at(g, hit->prim);
    struct vec3 p = vec3_mad(vec3_sub(ray->origin, c->base), hit->t, ray->direction);
    double z = vec3_dot(p, c->axis);
    struct vec3 across = vec3_mad(p, -z, c->axis);
    double length = vec3_length(across);
    struct vec3 outwards = vec3_scale(across, 1 / length);
    if (hit->part == CYLINDER_SIDE || length > c->radius)
        across = vec3_scale(outwards, c->radius);
    if (hit->part == CYLINDER_BASE || z < 0)
        z = 0;
    else if (hit->part == CYLINDER_TOP || z > c->height)
        z = c->height;
    *normal = hit->part == CYLINDER_SIDE  ? outwards
              : hit->part == CYLINDER_TOP ? c->axis
                                          : vec3_neg(c->axis);
    return vec3_add(c->base, vec3_mad(across, z, c->axis));
}
