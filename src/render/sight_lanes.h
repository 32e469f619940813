/* What of a list of targets can stand between points and a lamp; part of kernels_lanes.h.
 *
 * All tests are of planes and cones with their apex at the point.  A target on one side of such a
 * plane and the lamp on the other have nothing to do with each other; a target whose cone holds the
 * lamp hides all of it.  Both only by margins far larger than the rounding errors of these tests
 * and of those by which rays are traced: what is close is left to the rays. */
#include "math/lanes.h"
#include "render/tracer.h"

/* Angles that are told apart, near enough in radians: at round shapes, where roots of differences
 * have half the digits, and at flat ones. */
#define ROUND_MARGIN 1e-6
#define FLAT_MARGIN 1e-10

/* A lamp as a vector of points sees it.  t is 1 at a point of the lamp. */
struct view {
    const struct lamp *lamp;
    struct vvec3 p, to_center;
    vreal near, far;         /* distance of the lamp's points, at least and at most */
    vreal shortest, longest; /* shadow rays */
    vreal least_t, most_t;   /* at which shadow rays end */
};

/* Modern's rays end at the lamp's points, classic's where these are as far as the light's position.
 */
static struct view view_from(const struct lamp *lamp, const struct vec3_batch *from, uint32_t i)
{
    struct view v = {.lamp = lamp, .p = v3_load(from, i)};
    v.to_center = v3_sub(v3_all(lamp->center), v.p);
    struct vvec3 half = v3_all(lamp->half), c = v.to_center, zero = v3_all(vec3_all(0));
    if (lamp->ball) {
        vreal distance = v_sqrt(v3_dot(c, c));
        v.near = distance - lamp->radius;
        v.far = distance + lamp->radius;
    } else {
        struct vvec3 across = {v_abs(c.x), v_abs(c.y), v_abs(c.z)}, gap = v3_sub(across, half);
        gap = (struct vvec3){v_max(gap.x, zero.x), v_max(gap.y, zero.y), v_max(gap.z, zero.z)};
        across = v3_add(across, half);
        v.near = v_sqrt(v3_dot(gap, gap));
        v.far = v_sqrt(v3_dot(across, across));
    }
    v.shortest = v.near;
    v.longest = v.far;
    v.least_t = v.most_t = v_all(1);
    if (lamp->light->samples.n == 0) {
        struct vvec3 way = v3_sub(v3_all(lamp->light->position), v.p);
        v.shortest = v.longest = v_sqrt(v3_dot(way, way));
        v.least_t = v.longest / v.far;
        v.most_t = v.longest / v.near;
    }
    return v;
}

struct vspan {
    vreal lo, hi;
};

/* The range of n . (x - p) over the lamp. */
static inline struct vspan lamp_along(const struct view *v, struct vvec3 n)
{
    const struct lamp *lamp = v->lamp;
    vreal middle = v3_dot(n, v->to_center);
    vreal reach = lamp->ball ? lamp->radius * v_sqrt(v3_dot(n, n))
                             : v_abs(n.x) * lamp->half.x + v_abs(n.y) * lamp->half.y +
                                   v_abs(n.z) * lamp->half.z;
    return (struct vspan){middle - reach, middle + reach};
}

struct verdict {
    vmask none, all; /* the target cannot be in the way; it hides all of the lamp */
};

/* ---- spheres --------------------------------------------------------------------------------- */

/* The normal of a plane through p that touches a ball at g from p, on the lamp's side; `turn` -1:
 * on the other.  Its length is the ball's distance. */
static inline struct vvec3 tangent_plane(struct vvec3 to_lamp, struct vvec3 g, vreal far,
                                         vreal tangent, double r, double turn)
{
    struct vvec3 across = v3_mad(to_lamp, -v3_dot(to_lamp, g) / (far * far), g);
    across = v3_scale(across, turn * tangent / v_sqrt(v3_dot(across, across)));
    return v3_mad(across, -r / far, g);
}

/* Whether the corners of the lamp's box lie in the cone around g; bound: |g|^2 cos^2. */
static inline vmask cone_holds_box(const struct view *v, struct vvec3 g, vreal bound)
{
    vmask holds = v_less(v_all(0), bound);
    for (int i = 0; i < 8 && v_any(holds); i++) {
        struct vec3 h = v->lamp->half;
        h = vec3(i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z);
        struct vvec3 x = v3_add(v->to_center, v3_all(h));
        vreal along = v3_dot(x, g);
        holds &= v_less(v_all(0), along) & v_less(v3_dot(x, x) * bound, along * along);
    }
    return holds;
}

/* The same for its ball: by the cosine of the angle between the centers and that of the difference
 * of both angular radii, times both distances. */
static inline vmask cone_holds_ball(const struct view *v, struct vvec3 g, vreal far, vreal tangent,
                                    double r)
{
    double radius = v->lamp->radius;
    vreal square = v3_dot(v->to_center, v->to_center), distance = v_sqrt(square);
    vreal along = v3_dot(v->to_center, g), lamp_tangent = v_sqrt(square - radius * radius);
    return v_less(radius * far, r * distance) &
           v_less(tangent * lamp_tangent + r * radius + ROUND_MARGIN * far * distance, along);
}

static struct verdict see_sphere(const struct view *v, const struct sphere *s)
{
    double r = s->radius;
    vreal zero = v_all(0);
    struct vvec3 g = v3_sub(v3_all(s->center), v->p);
    vreal square = v3_dot(g, g), far = v_sqrt(square), power = square - r * r;
    vreal rounding = SPAWN_TOLERANCE * 2 * r * (v3_largest(v->p) + s->reach);
    power = v_select(v_at_most(v_abs(power), rounding), zero, power);
    vmask outside = v_at_most(zero, power);
    if (!v_any(outside))
        return (struct verdict){outside, outside};
    vreal tangent = v_sqrt(power);
    struct vvec3 n = tangent_plane(v->to_center, g, far, tangent, r, 1);
    vmask touches = v_at_most(v3_dot(n, g) + r * v_sqrt(v3_dot(n, n)), 0.1 * ROUND_MARGIN * square);
    vmask none = touches & v_less(ROUND_MARGIN * far * v->far, lamp_along(v, n).lo);
    none = outside & (none | v_less((1 + ROUND_MARGIN) * v->longest, far - r));
    /* the first hit from outside is no farther than the tangent; from the sphere, than through it
     */
    vreal farthest = v_select(v_equal(power, zero), v_all(2 * r), tangent);
    vmask all = outside & v_not(none) & v_less(farthest, (1 - ROUND_MARGIN) * v->shortest);
    if (v_any(all) && v->lamp->ball)
        all &= cone_holds_ball(v, g, far, tangent, r);
    else if (v_any(all))
        all &= cone_holds_box(v, g, power + ROUND_MARGIN * ROUND_MARGIN * square);
    return (struct verdict){none, all};
}

/* ---- cylinders ------------------------------------------------------------------------------- */

/* No ray that starts beyond a cap, `height` being measured inwards, comes back. */
static inline vmask stays_beyond(const struct view *v, vreal height, vreal rise, vreal rounding)
{
    vreal margin = ROUND_MARGIN * v->far;
    return v_at_most(height, rounding) &
           (v_less(rise, -margin) | v_less(height + v->most_t * rise, -margin));
}

/* Whether rays to the lamp, all of which meet the endless cylinder, enter between its caps.
 * g: from p to the axis; far, tangent: distances there. */
static inline vmask enter_between_caps(const struct view *v, const struct cylinder *c, vreal z,
                                       struct vspan rise, vreal far, vreal tangent)
{
    struct vvec3 axis = v3_all(c->axis);
    struct vvec3 across = v3_mad(v->to_center, -v3_dot(v->to_center, axis), axis);
    vreal distance = v_sqrt(v3_dot(across, across)), near = distance - v->lamp->radius;
    vreal first = (far - c->radius) / (distance + v->lamp->radius), last = tangent / near;
    vreal lowest = z + v_min(rise.lo * first, rise.lo * last);
    vreal highest = z + v_max(rise.hi * first, rise.hi * last);
    vreal margin = ROUND_MARGIN * (v->far + tangent);
    return v_less(v_all(0), near) & v_less(last, (1 - ROUND_MARGIN) * v->least_t) &
           v_less(margin, lowest) & v_less(highest, c->height - margin);
}

static struct verdict see_cylinder(const struct view *v, const struct cylinder *c)
{
    double r = c->radius, reach = vec3_largest(c->base) + c->height + c->radius;
    vreal zero = v_all(0), rounding = SPAWN_TOLERANCE * (v3_largest(v->p) + reach);
    struct vvec3 axis = v3_all(c->axis), m = v3_sub(v->p, v3_all(c->base));
    vreal z = v3_dot(m, axis);
    struct vspan rise = lamp_along(v, axis);
    vmask none = stays_beyond(v, z, rise.hi, rounding);
    none |= stays_beyond(v, c->height - z, -rise.lo, rounding);

    struct vvec3 g = v3_sub(v3_scale(axis, z), m);
    vreal square = v3_dot(g, g), far = v_sqrt(square), power = square - r * r;
    power = v_select(v_at_most(v_abs(power), 2 * r * rounding), zero, power);
    vmask outside = v_at_most(zero, power), all = none & v_not(none);
    if (!v_any(outside & v_not(none)))
        return (struct verdict){none, all};
    vreal tangent = v_sqrt(power), margin = ROUND_MARGIN * far * v->far;
    struct vvec3 to_lamp = v3_mad(v->to_center, -v3_dot(v->to_center, axis), axis);
    struct vvec3 n = tangent_plane(to_lamp, g, far, tangent, r, 1);
    vreal tilt = v_abs(v3_dot(n, axis)) * c->height;
    vmask touches =
        v_at_most(v3_dot(n, g) + r * v_sqrt(v3_dot(n, n)) + tilt, 0.1 * ROUND_MARGIN * square);
    struct vspan span = lamp_along(v, n);
    none |= outside & ((touches & v_less(margin, span.lo)) |
                       v_less((1 + ROUND_MARGIN) * v->longest, far - r));
    all = v_less(v_all(ROUND_MARGIN * r * r), power) & v_not(none) & v_less(span.hi, -margin);
    if (v_any(all)) {
        n = tangent_plane(to_lamp, g, far, tangent, r, -1);
        all &= v_less(lamp_along(v, n).hi, -margin);
        all &= enter_between_caps(v, c, z, rise, far, tangent);
    }
    return (struct verdict){none, all};
}

/* ---- triangles ------------------------------------------------------------------------------- */

static inline struct vvec3 v3_normal(struct vvec3 a, struct vvec3 b)
{
    return (struct vvec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Such that its normal may be off by more than the margin. */
static bool is_sliver(struct vec3 a, struct vec3 b, struct vec3 c)
{
    struct vec3 ab = vec3_sub(b, a), bc = vec3_sub(c, b), ca = vec3_sub(a, c);
    double longest = fmax(vec3_dot(ab, ab), fmax(vec3_dot(bc, bc), vec3_dot(ca, ca)));
    return !(vec3_length(vec3_cross(ab, ca)) > 1e-5 * longest);
}

static struct verdict see_triangle(const struct view *v, const struct geometry *g,
                                   const struct triangle *t, vmask own)
{
    const struct vec3 *at = g->vertices.at;
    struct vvec3 corner[3], normal = v3_all(t->normal);
    vreal length[3];
    for (int k = 0; k < 3; k++) {
        corner[k] = v3_sub(v3_all(at[t->vertex[k]]), v->p);
        length[k] = v_sqrt(v3_dot(corner[k], corner[k]));
    }
    /* the plane: `normal` made to point away from p */
    vreal distance = v3_dot(normal, corner[0]), side = v_copysign(v_all(1), distance);
    vreal rounding = SPAWN_TOLERANCE * (v3_largest(v->p) + t->reach);
    vmask none = own | v_at_most(v_abs(distance), rounding), all = none & v_not(none);
    if (is_sliver(at[t->vertex[0]], at[t->vertex[1]], at[t->vertex[2]]) || !v_any(v_not(none)))
        return (struct verdict){none, all};
    struct vspan span = lamp_along(v, v3_scale(normal, side));
    distance = v_abs(distance);
    vreal margin = FLAT_MARGIN * (v->far + distance);
    none |= v_less(v->most_t * span.hi + margin, distance);
    all = v_not(none) & v_less(distance + margin, (1 - ROUND_MARGIN) * v->least_t * span.lo);

    /* the planes through p and the edges: their normals made to point inwards */
    struct vvec3 edge[3];
    for (int k = 0; k < 3; k++)
        edge[k] = v3_normal(corner[k], corner[(k + 1) % 3]);
    vreal volume = v3_dot(edge[0], corner[2]);
    side = v_copysign(v_all(1), volume);
    vmask sure = v_less(FLAT_MARGIN * length[0] * length[1] * length[2], v_abs(volume));
    all &= sure;
    for (int k = 0; k < 3; k++) {
        span = lamp_along(v, v3_scale(edge[k], side));
        margin = FLAT_MARGIN * length[k] * length[(k + 1) % 3] * v->far;
        none |= sure & v_less(span.hi, -margin);
        all &= v_less(margin, span.lo);
    }
    return (struct verdict){none, all};
}

/* ---- the list -------------------------------------------------------------------------------- */

static struct verdict see_target(const struct view *v, const struct geometry *g,
                                 struct target target, vreal prims)
{
    if (target.kind == PRIM_SPHERE)
        return see_sphere(v, &g->spheres.at[target.index]);
    if (target.kind == PRIM_CYLINDER)
        return see_cylinder(v, &g->cylinders.at[target.index]);
    return see_triangle(v, g, &g->triangles.at[target.index], v_equal(prims, v_all(target.prim)));
}

static void see(const struct geometry *g, const struct lamp *lamp, uint32_t opaque,
                const struct vec3_batch *from, const uint32_t *prims, uint32_t first, uint32_t end,
                struct sight *sight)
{
    const struct target_list *list = &sight->list;
    memset(sight->near, 0, list->n * sizeof *sight->near);
    sight->hidden = 0;
    for (uint32_t i = first; i < end; i += LANES) {
        struct view v = view_from(lamp, from, i);
        vreal own = v_real(v_load_int32((const int32_t *)prims + i));
        uint64_t left =
            end - i < LANES ? (UINT64_C(1) << (end - i)) - 1 : (UINT64_C(1) << LANES) - 1;
        for (uint32_t k = 0; k < list->n && left; k++) {
            struct verdict verdict = see_target(&v, g, list->at[k], own);
            sight->near[k] |= (left & ~(uint64_t)v_bits(verdict.none)) << i;
            uint64_t hidden = opaque >> k & 1 ? left & v_bits(verdict.all) : 0;
            sight->hidden |= hidden << i;
            left &= ~hidden;
        }
    }
}
