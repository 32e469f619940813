/* Batches of rays against lists.
 *
 * Each test is that of scene/intersect.h for a vector of rays, with the same operations in the same
 * order; where that returns early, a mask says which lanes go on. */
#include "accel/bundle.h"
#include "math/lanes.h"

/* Ray by ray what the tests against all targets share; see struct ray_frame. */
struct frame_batch {
    const struct geometry *geometry;
    const struct ray_batch *rays;
    struct hit_batch *hits;
    uint32_t n; /* rounded up to whole vectors */
    int axis;   /* of all rays, or -1 */
    double tolerance;
    alignas(64) double square[BATCH_ROOM];
    alignas(64) double inverse_square[BATCH_ROOM];
    alignas(64) double reach[BATCH_ROOM];
    alignas(64) double axis_of[BATCH_ROOM];
    alignas(64) double shear_x[BATCH_ROOM], shear_y[BATCH_ROOM];
};

/* Rays are culled in parts of so many. */
enum { PART = 8, PARTS = BATCH / PART, ALL_PARTS = (1 << PARTS) - 1 };

/* The next whole vector from i on that belongs to one of the parts, of which the passed ones are
 * taken away; f->n when there is none. */
static inline uint32_t next_lanes(const struct frame_batch *f, unsigned *parts, uint32_t i)
{
    if (i % PART != 0)
        return i;
    *parts = i ? *parts & (*parts - 1) : *parts;
    return *parts ? PART * (uint32_t)__builtin_ctz(*parts) : f->n;
}

/* All that there are. */
static inline unsigned parts_of_rays(const struct frame_batch *f)
{
    return ALL_PARTS >> (PARTS - (f->n + PART - 1) / PART);
}

static void frames_for_spheres(struct frame_batch *f)
{
    for (uint32_t i = 0; i < f->n; i += LANES) {
        vreal square = v_load(f->square + i), inverse = 2 - square;
        vmask unit = v_at_most(v_abs(square - 1), v_all(UNIT_ROUNDING));
        if (v_any(v_not(unit)))
            inverse = v_select(unit, inverse, 1 / square);
        v_store(f->inverse_square + i, inverse);
    }
}

static void frames_for_triangles(struct frame_batch *f)
{
    const struct ray_batch *rays = f->rays;
    unsigned any_x = 0, any_y = 0, any_z = 0;
    for (uint32_t i = 0; i < f->n; i += LANES) {
        struct vvec3 d = v3_load(&rays->direction, i);
        vreal x = v_abs(d.x), y = v_abs(d.y), z = v_abs(d.z);
        vmask along_x = v_less(y, x) & v_less(z, x), along_y = v_less(z, y) & v_not(along_x);
        vreal inverse = 1 / v_select(along_x, d.x, v_select(along_y, d.y, d.z));
        v_store(f->shear_x + i, v_select(along_x, d.y, v_select(along_y, d.z, d.x)) * inverse);
        v_store(f->shear_y + i, v_select(along_x, d.z, v_select(along_y, d.x, d.y)) * inverse);
        v_store(f->axis_of + i, v_select(along_x, v_all(0), v_select(along_y, v_all(1), v_all(2))));
        unsigned used = rays->n - i < LANES ? (1u << (rays->n - i)) - 1 : (1u << LANES) - 1;
        any_x |= used & v_bits(along_x);
        any_y |= used & v_bits(along_y);
        any_z |= used & ~(v_bits(along_x) | v_bits(along_y));
    }
    int axes = (any_x != 0) + (any_y != 0) + (any_z != 0);
    f->axis = axes != 1 ? -1 : any_x ? 0 : any_y ? 1 : 2;
}

/* With the parts for spheres, for triangles, or both. */
static void frames_init(struct frame_batch *f, const struct geometry *g,
                        const struct ray_batch *rays, bool spheres, bool triangles,
                        struct hit_batch *hits)
{
    f->geometry = g;
    f->rays = rays;
    f->hits = hits;
    f->n = (rays->n + LANES - 1) / LANES * LANES;
    f->tolerance = rays->spawned ? SPAWN_TOLERANCE : 0;
    for (uint32_t i = 0; i < f->n; i += LANES) {
        struct vvec3 d = v3_load(&rays->direction, i);
        v_store(f->square + i, v3_dot(d, d));
        v_store(f->reach + i, rays->spawned ? v3_largest(v3_load(&rays->origin, i)) : v_all(0));
        v_store(hits->t + i, v_load(rays->t_max + i));
        v_store(hits->prim + i, v_all(PRIM_NONE));
        v_store(hits->part + i, v_all(0));
    }
    if (spheres)
        frames_for_spheres(f);
    if (triangles)
        frames_for_triangles(f);
}

/* The hits at t, where they come before the best; whether any does. */
static inline bool offer(struct frame_batch *f, uint32_t i, vreal t, uint32_t prim, vreal part)
{
    struct hit_batch *hits = f->hits;
    vreal best = v_load(hits->t + i), of = v_load(hits->prim + i), number = v_all(prim);
    vmask better =
        v_less(v_all(0), t) & (v_less(t, best) | (v_equal(t, best) & v_less(number, of)));
    if (!v_any(better))
        return false;
    v_store(hits->t + i, v_select(better, t, best));
    v_store(hits->prim + i, v_select(better, number, of));
    v_store(hits->part + i, v_select(better, part, v_load(hits->part + i)));
    return true;
}

/* ---- spheres, see sphere_distance -------------------------------------------------------------
 */

/* parts: bit j stands for rays PART j to PART (j + 1) - 1; returns those in which there are hits.
 */
static unsigned meet_sphere(struct frame_batch *f, struct target target, unsigned parts)
{
    const struct sphere *s = &f->geometry->spheres.at[target.index];
    vreal zero = v_all(0), r2 = v_all(s->radius * s->radius);
    struct vvec3 center = v3_all(s->center);
    unsigned met = 0;
    for (uint32_t i = next_lanes(f, &parts, 0); i < f->n; i = next_lanes(f, &parts, i + LANES)) {
        struct vvec3 d = v3_load(&f->rays->direction, i);
        struct vvec3 o = v3_sub(v3_load(&f->rays->origin, i), center);
        vreal b = -v3_dot(o, d), c = v3_dot(o, o) - r2;
        vreal rounding = f->tolerance * 2 * s->radius * (v_load(f->reach + i) + s->reach);
        vmask on = v_at_most(v_abs(c), rounding);
        c = v_select(on, zero, c);
        vmask leaving = v_at_most(zero, c) & v_not(v_less(zero, b));
        vreal inverse = v_load(f->inverse_square + i), ahead = b * inverse;
        struct vvec3 l = v3_mad(o, ahead, d);
        vreal discriminant = r2 - v3_dot(l, l);
        vmask may = (on | v_at_most(zero, discriminant)) & v_not(leaving);
        if (!v_any(may))
            continue;
        vreal q = b + v_copysign(v_sqrt(v_load(f->square + i) * discriminant), b);
        vreal t = v_select(v_less(zero, c) | v_less(q, zero), c / q, q * inverse);
        t = v_select(on, 2 * ahead, t);
        if (offer(f, i, v_select(may, t, zero), target.prim, zero))
            met |= 1u << i / PART;
    }
    return met;
}

/* ---- cylinders, see cylinder_distance ----------------------------------------------------------
 */

struct stretch_lanes {
    vreal t[2], part[2];
};

/* Returns the lanes that meet the endless cylinder; `may` are those to look at. */
static inline vmask clip_to_side(const struct cylinder *c, struct vvec3 w, struct vvec3 d,
                                 vreal off, vreal rounding, struct stretch_lanes *s)
{
    vreal zero = v_all(0), r2 = v_all(c->radius * c->radius);
    struct vvec3 n = v3_cross_plain(d, v3_all(c->axis));
    vreal a = v3_dot(n, n), b = v3_dot(n, w), power = v3_dot(w, w) - r2;
    power = v_select(v_at_most(v_abs(power), 2 * c->radius * rounding), zero, power);
    vmask on = v_equal(power, zero), outside = v_less(zero, power), along = v_equal(a, zero);
    vmask leaving = outside & v_not(v_less(b, zero)) & v_not(along);
    vmask passing = outside & v_less(r2 * a, off * off);
    vreal square = v_select(v_less(power, zero), b * b - a * power, a * (r2 - off * off / a));
    vreal q = -(b + v_copysign(v_sqrt(v_select(v_less(zero, square), square, zero)), b));
    vreal t0 = v_select(on, zero, power / q), t1 = v_select(on, -2 * b / a, q / a);
    vmask ordered = v_less(t0, t1);
    s->t[0] = v_select(along, v_all(-INFINITY), v_select(ordered, t0, t1));
    s->t[1] = v_select(along, v_all(INFINITY), v_select(ordered, t1, t0));
    s->part[0] = s->part[1] = v_all(CYLINDER_SIDE);
    return v_not(passing) & v_not(leaving) & v_not(along & v_not(v_at_most(power, zero)));
}

static inline vmask clip_to_caps(const struct cylinder *c, struct vvec3 m, struct vvec3 d,
                                 vreal rounding, struct stretch_lanes *s)
{
    vreal zero = v_all(0);
    struct vvec3 axis = v3_all(c->axis);
    vreal z = v3_dot(m, axis), speed = v3_dot(d, axis), left = c->height - z;
    vreal to_base = v_select(v_at_most(v_abs(z), rounding), zero, -z);
    vreal to_top = v_select(v_at_most(v_abs(left), rounding), zero, left);
    vmask across = v_equal(speed, zero), up = v_less(zero, speed);
    vreal t_base = to_base / speed, t_top = to_top / speed;
    vreal enter = v_select(up, t_base, t_top), leave = v_select(up, t_top, t_base);
    vmask enters = v_at_most(s->t[0], enter) & v_not(across);
    vmask leaves = v_at_most(leave, s->t[1]) & v_not(across);
    vreal base = v_all(CYLINDER_BASE), top = v_all(CYLINDER_TOP);
    s->t[0] = v_select(enters, enter, s->t[0]);
    s->part[0] = v_select(enters, v_select(up, base, top), s->part[0]);
    s->t[1] = v_select(leaves, leave, s->t[1]);
    s->part[1] = v_select(leaves, v_select(up, top, base), s->part[1]);
    return v_not(across) | (v_at_most(to_base, zero) & v_at_most(zero, to_top));
}

static unsigned meet_cylinder(struct frame_batch *f, struct target target, unsigned parts)
{
    const struct cylinder *c = &f->geometry->cylinders.at[target.index];
    double reach = vec3_largest(c->base) + c->height + c->radius;
    vreal zero = v_all(0), r2 = v_all(c->radius * c->radius);
    struct vvec3 base = v3_all(c->base), axis = v3_all(c->axis);
    unsigned met = 0;
    for (uint32_t i = next_lanes(f, &parts, 0); i < f->n; i = next_lanes(f, &parts, i + LANES)) {
        struct vvec3 d = v3_load(&f->rays->direction, i);
        struct vvec3 m = v3_sub(v3_load(&f->rays->origin, i), base), w = v3_cross_plain(m, axis);
        vreal off = v3_dot(d, w);
        vmask may = v_at_most(off * off, r2 * v_load(f->square + i));
        if (!v_any(may))
            continue;
        struct stretch_lanes s;
        vreal rounding = f->tolerance * (v_load(f->reach + i) + reach);
        may &= clip_to_side(c, w, d, off, rounding, &s);
        may &= clip_to_caps(c, m, d, rounding, &s);
        may &= v_at_most(s.t[0], s.t[1]);
        vmask first = v_less(zero, s.t[0]);
        if (offer(f, i, v_select(may, v_select(first, s.t[0], s.t[1]), zero), target.prim,
                  v_select(first, s.part[0], s.part[1])))
            met |= 1u << i / PART;
    }
    return met;
}

/* ---- triangles, see triangle_meets_axis and triangle_distance ----------------------------------
 */

struct vpoint2 {
    vreal x, y;
};

/* axis: of all rays, or -1. */
static inline struct vpoint2 sheared(const struct frame_batch *f, uint32_t i, struct vvec3 p,
                                     int axis)
{
    vreal shear_x = v_load(f->shear_x + i), shear_y = v_load(f->shear_y + i);
    vreal along = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    vreal x = axis == 0 ? p.y : axis == 1 ? p.z : p.x, y = axis == 0 ? p.z : axis == 1 ? p.x : p.y;
    if (axis < 0) {
        vreal of = v_load(f->axis_of + i);
        vmask along_x = v_equal(of, v_all(0)), along_y = v_equal(of, v_all(1));
        along = v_select(along_x, p.x, v_select(along_y, p.y, p.z));
        x = v_select(along_x, p.y, v_select(along_y, p.z, p.x));
        y = v_select(along_x, p.z, v_select(along_y, p.x, p.y));
    }
    return (struct vpoint2){x - shear_x * along, y - shear_y * along};
}

/* By exact signs. */
static vmask enclosed_exactly(struct vpoint2 a, struct vpoint2 b, struct vpoint2 c)
{
    vreal zero = v_all(0), u = v_difference_of_products(c.x, b.y, c.y, b.x);
    vreal v = v_difference_of_products(a.x, c.y, a.y, c.x);
    vreal w = v_difference_of_products(b.x, a.y, b.y, a.x);
    vmask below = v_less(u, zero) | v_less(v, zero) | v_less(w, zero);
    vmask above = v_less(zero, u) | v_less(zero, v) | v_less(zero, w);
    return v_not(below & above) & v_less(zero, v_abs(u + v + w));
}

/* The least and the most of the edge functions by rounded products, whose signs are never wrong,
 * though one may be 0. */
struct edges {
    vreal least, most;
};

static inline struct edges edges_of(struct vpoint2 a, struct vpoint2 b, struct vpoint2 c)
{
    vreal u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
    return (struct edges){v_min(v_min(u, v), w), v_max(v_max(u, v), w)};
}

static inline vmask edges_surely_pass(struct edges e)
{
    return v_less(e.least, v_all(0)) & v_less(v_all(0), e.most);
}

/* The lanes whose rays the corners, seen from their origins, enclose. */
static inline vmask meets_lines(const struct frame_batch *f, uint32_t i, const struct vvec3 seen[3],
                                int axis)
{
    struct vpoint2 a = sheared(f, i, seen[0], axis), b = sheared(f, i, seen[1], axis);
    struct vpoint2 c = sheared(f, i, seen[2], axis);
    struct edges e = edges_of(a, b, c);
    vmask passes = edges_surely_pass(e);
    vmask meets = v_less(v_all(0), e.least) | v_less(e.most, v_all(0));
    vmask unsure = v_not(passes) & v_not(meets);
    return v_any(unsure) ? meets | (unsure & enclosed_exactly(a, b, c)) : meets;
}

static inline vreal inverses(vreal d, vreal largest)
{
    vreal least = largest * 0x1p-60;
    return 1 / v_select(v_less(v_abs(d), least), v_copysign(least, d), d);
}

/* Between the box's planes across an axis, widened by `pad`. */
static inline void clip_to_planes(double lo, double hi, vreal o, vreal inverse, vreal pad,
                                  vreal *near, vreal *far)
{
    vreal e = pad * v_abs(inverse), t0 = (lo - o) * inverse, t1 = (hi - o) * inverse;
    vmask forwards = v_less(t0, t1);
    *near = v_max(v_select(forwards, t0, t1) - e, *near);
    *far = v_min(v_select(forwards, t1, t0) + e, *far);
}

/* See clamp_to_bounds. */
static vreal clamped_to_bounds(const struct geometry *g, const struct triangle *tri, struct vvec3 o,
                               struct vvec3 d, vreal t)
{
    const struct vec3 *v = g->vertices.at;
    struct vec3 a = v[tri->vertex[0]], b = v[tri->vertex[1]], c = v[tri->vertex[2]];
    struct box box = {vec3_min(vec3_min(a, b), c), vec3_max(vec3_max(a, b), c)};
    vreal pad = 0.5 * BOX_PADDING * (tri->reach + v3_largest(o)), largest = v3_largest(d);
    vreal near = v_all(-INFINITY), far = v_all(INFINITY);
    clip_to_planes(box.lo.x, box.hi.x, o.x, inverses(d.x, largest), pad, &near, &far);
    clip_to_planes(box.lo.y, box.hi.y, o.y, inverses(d.y, largest), pad, &near, &far);
    clip_to_planes(box.lo.z, box.hi.z, o.z, inverses(d.z, largest), pad, &near, &far);
    t = v_select(v_at_most(near, t), t, near);
    return v_select(v_at_most(t, far), t, far);
}

/* The corners are the target's; of a common origin they are seen alike by all rays. */
static inline unsigned meet_triangle_along(struct frame_batch *f, struct target target,
                                           const struct vec3 corner[3], unsigned parts, int axis,
                                           bool common_origin)
{
    const struct triangle *tri = &f->geometry->triangles.at[target.index];
    const struct ray_batch *rays = f->rays;
    const struct vec3 origin = vec3_get(&rays->origin, 0);
    struct vvec3 seen[3], normal = v3_all(tri->normal);
    vreal zero = v_all(0);
    unsigned met = 0;
    for (int k = 0; k < 3; k++)
        seen[k] = v3_all(common_origin ? vec3_sub(corner[k], origin) : corner[k]);
    for (uint32_t i = next_lanes(f, &parts, 0); i < f->n; i = next_lanes(f, &parts, i + LANES)) {
        for (int k = 0; k < 3 && !common_origin; k++)
            seen[k] = v3_sub(v3_all(corner[k]), v3_load(&rays->origin, i));
        vmask may = meets_lines(f, i, seen, axis);
        if (!v_any(may))
            continue;
        struct vvec3 d = v3_load(&rays->direction, i);
        vreal distance = v3_dot(normal, seen[0]), speed = v3_dot(normal, d);
        vreal rounding = f->tolerance * (v_load(f->reach + i) + tri->reach);
        may &= v_not(v_equal(v_load(rays->from + i), v_all(target.prim))) &
               v_not(v_at_most(v_abs(distance), rounding));
        if (!v_any(may))
            continue;
        vreal t = distance / speed;
        vmask steep = v_at_most(0x1p-4 * v_load(f->square + i), speed * speed);
        if (v_any(may & v_not(steep)))
            t = v_select(steep, t,
                         clamped_to_bounds(f->geometry, tri, v3_load(&rays->origin, i), d, t));
        if (offer(f, i, v_select(may, t, zero), target.prim, zero))
            met |= 1u << i / PART;
    }
    return met;
}

static unsigned meet_seen_triangle(struct frame_batch *f, struct target target,
                                   const struct vec3 corner[3], unsigned parts)
{
    switch (f->axis) {
    case 0:
        return meet_triangle_along(f, target, corner, parts, 0, true);
    case 1:
        return meet_triangle_along(f, target, corner, parts, 1, true);
    case 2:
        return meet_triangle_along(f, target, corner, parts, 2, true);
    default:
        return meet_triangle_along(f, target, corner, parts, -1, true);
    }
}

static unsigned meet_triangle(struct frame_batch *f, struct target target,
                              const struct vec3 corner[3], unsigned parts)
{
    if (f->rays->common_origin)
        return meet_seen_triangle(f, target, corner, parts);
    switch (f->axis) {
    case 0:
        return meet_triangle_along(f, target, corner, parts, 0, false);
    case 1:
        return meet_triangle_along(f, target, corner, parts, 1, false);
    case 2:
        return meet_triangle_along(f, target, corner, parts, 2, false);
    default:
        return meet_triangle_along(f, target, corner, parts, -1, false);
    }
}

/* ---- the list -----------------------------------------------------------------------------------
 */

/* Returns the parts in which there are hits. */
static unsigned meet(struct frame_batch *f, struct target target, unsigned parts)
{
    if (target.kind == PRIM_SPHERE)
        return meet_sphere(f, target, parts);
    if (target.kind == PRIM_CYLINDER)
        return meet_cylinder(f, target, parts);
    const uint32_t *vertex = f->geometry->triangles.at[target.index].vertex;
    const struct vec3 *v = f->geometry->vertices.at;
    return meet_triangle(f, target, (struct vec3[]){v[vertex[0]], v[vertex[1]], v[vertex[2]]},
                         parts);
}

static void frames_for_list(struct frame_batch *f, const struct geometry *g,
                            const struct ray_batch *rays, const struct target_list *list,
                            struct hit_batch *hits)
{
    bool has[PRIM_KINDS] = {false};
    for (uint32_t i = 0; i < list->n; i++)
        has[list->at[i].kind] = true;
    frames_init(f, g, rays, has[PRIM_SPHERE], has[PRIM_TRIANGLE], hits);
}

/* That of rays that are none may be larger. */
static double farthest_hit(const struct frame_batch *f)
{
    vreal farthest = v_all(0);
    for (uint32_t i = 0; i < f->n; i += LANES)
        farthest = v_max(v_load(f->hits->t + i), farthest);
    return v_most(farthest);
}

static void closest_in_list(const struct geometry *g, const struct ray_batch *rays,
                            const struct target_list *list, struct hit_batch *hits)
{
    struct frame_batch f;
    frames_for_list(&f, g, rays, list, hits);
    for (uint32_t k = 0; k < list->n; k++) {
        if (list->nearest[k] > 0 && list->nearest[k] > farthest_hit(&f))
            break;
        meet(&f, list->at[k], parts_of_rays(&f));
    }
}

static uint64_t found_hits(const struct hit_batch *hits, uint32_t n)
{
    uint64_t none = 0;
    for (uint32_t i = 0; i < n; i += LANES)
        none |= (uint64_t)v_bits(v_equal(v_load(hits->prim + i), v_all(PRIM_NONE))) << i;
    return ~none & UINT64_MAX >> (BATCH - n);
}

static uint64_t any_in_list(const struct geometry *g, const struct ray_batch *rays,
                            const struct target_list *list)
{
    struct frame_batch f;
    struct hit_batch hits;
    uint64_t found = 0;
    if (rays->n == 0)
        return 0;
    const uint64_t all = UINT64_MAX >> (BATCH - rays->n);
    frames_for_list(&f, g, rays, list, &hits);
    for (uint32_t k = 0; k < list->n && found != all; k++) {
        meet(&f, list->at[k], parts_of_rays(&f));
        found = found_hits(&hits, rays->n);
    }
    return found;
}

const struct bundle_kernels BUNDLE_KERNELS = {closest_in_list, any_in_list, found_hits};
