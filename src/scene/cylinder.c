#include "config.h"

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
    struct vec3 disc = vec3(sqrt(e.y * e.y + e.z * e.z), sqrt(e.z * e.z + e.x * e.x),
                            sqrt(e.x * e.x + e.y * e.y));
    disc = vec3_scale(disc, c->radius);
    return (struct box){ vec3_sub(vec3_min(c->base, top), disc),
                         vec3_add(vec3_max(c->base, top), disc) };
}

/* The part of a line within a convex solid: from t[0] to t[1], and which part of the surface
 * bounds it there. */
struct stretch {
    double t[2];
    uint32_t part[2];
};

/* Lengths below this are rounding errors at p. */
static double rounding_at(const struct cylinder *c, struct vec3 p)
{
    return SPAWN_TOLERANCE *
           (vec3_largest(p) + vec3_largest(c->base) + c->height + c->radius);
}

/* Within the endless cylinder around the axis: |w + t n| <= r. */
static bool clip_to_side(const struct cylinder *c, const struct ray *ray, struct stretch *s)
{
    struct vec3 m = vec3_sub(ray->origin, c->base);
    struct vec3 n = vec3_cross(ray->direction, c->axis), w = vec3_cross(m, c->axis);
    double a = vec3_dot(n, n), b = vec3_dot(n, w), r2 = c->radius * c->radius;
    double power = vec3_dot(w, w) - r2; /* of the origin: 0 on the side */
    if (ray->spawned && fabs(power) <= 2 * c->radius * rounding_at(c, ray->origin))
        power = 0;
    if (a == 0) {
        *s = (struct stretch){ { -INFINITY, INFINITY }, { CYLINDER_SIDE, CYLINDER_SIDE } };
        return power <= 0;
    }
    double t0, t1;
    if (power == 0) {
        t0 = 0;
        t1 = -2 * b / a;
    } else {
        double mn = vec3_dot(m, n), discriminant = r2 - mn * mn / a;
        if (!(discriminant >= 0))
            return false;
        double q = -(b + copysign(sqrt(a * discriminant), b));
        t0 = power / q;
        t1 = q / a;
    }
    *s = (struct stretch){ { t0 < t1 ? t0 : t1, t0 < t1 ? t1 : t0 },
                           { CYLINDER_SIDE, CYLINDER_SIDE } };
    return true;
}

/* Between the planes of the caps.  Where a cap bounds the stretch as closely as the side, the cap
 * is hit. */
static bool clip_to_caps(const struct cylinder *c, const struct ray *ray, struct stretch *s)
{
    double z = vec3_dot(vec3_sub(ray->origin, c->base), c->axis);
    double speed = vec3_dot(ray->direction, c->axis);
    double to_base = -z, to_top = c->height - z;
    if (ray->spawned) {
        double rounding = rounding_at(c, ray->origin);
        to_base = fabs(to_base) <= rounding ? 0 : to_base;
        to_top = fabs(to_top) <= rounding ? 0 : to_top;
    }
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
bool cylinder_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                        const struct ray_frame *frame, struct hit *best)
{
    const struct cylinder *c = cylinder_at(g, prim);
    struct stretch s;
    (void)frame;
    if (!clip_to_side(c, ray, &s) || !clip_to_caps(c, ray, &s) || !(s.t[0] <= s.t[1]))
        return false;
    int end = s.t[0] > 0 ? 0 : 1;
    if (!hit_before(s.t[end], prim, best))
        return false;
    *best = (struct hit){ .t = s.t[end], .prim = prim, .part = s.part[end] };
    return true;
}

bool cylinder_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p)
{
    const struct cylinder *c = cylinder_at(g, prim);
    struct vec3 m = vec3_sub(p, c->base), w = vec3_cross(m, c->axis);
    double z = vec3_dot(m, c->axis), r2 = c->radius * c->radius;
    double power = vec3_dot(w, w) - r2, rounding = rounding_at(c, p);
    if (z < -rounding || z > c->height + rounding || power > 2 * c->radius * rounding)
        return false;
    return power >= -2 * c->radius * rounding || z <= rounding || z >= c->height - rounding;
}

struct vec3 cylinder_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit)
{
    const struct cylinder *c = cylinder_at(g, hit->prim);
    struct vec3 p = vec3_mad(vec3_sub(ray->origin, c->base), hit->t, ray->direction);
    double z = vec3_dot(p, c->axis);
    struct vec3 across = vec3_mad(p, -z, c->axis);
    double length = vec3_length(across);
    if (hit->part == CYLINDER_SIDE || length > c->radius)
        across = vec3_scale(across, c->radius / length);
    if (hit->part == CYLINDER_BASE || z < 0)
        z = 0;
    else if (hit->part == CYLINDER_TOP || z > c->height)
        z = c->height;
    return vec3_add(c->base, vec3_mad(across, z, c->axis));
}

struct vec3 cylinder_normal(const struct geometry *g, const struct hit *hit, struct vec3 p)
{
    const struct cylinder *c = cylinder_at(g, hit->prim);
    if (hit->part == CYLINDER_BASE)
        return vec3_neg(c->axis);
    if (hit->part == CYLINDER_TOP)
        return c->axis;
    struct vec3 m = vec3_sub(p, c->base);
    return vec3_normalize(vec3_mad(m, -vec3_dot(m, c->axis), c->axis));
}
