/* Points on primitives by vectors, which may lie on as many of these; part of kernels_lanes.h.  The
 * same operations in the same order as for single points, see place_point. */
#include "math/lanes.h"
#include "render/tracer.h"

static inline struct vvec3 v3_neg(struct vvec3 a)
{
    return (struct vvec3){-a.x, -a.y, -a.z};
}

/* Doubles from one element of an array to the next. */
#define STEP_OF(type) ((int)(sizeof(type) / sizeof(double)))

/* Where the shapes of points i to `end` are in their array, the lanes behind as the first. */
static inline vint shapes_at(const struct hit_shapes *h, uint32_t i, uint32_t end)
{
    vint at = v_long(v_load_int32((const int32_t *)h->index + i));
    return v_select_int(v_first(end - i), at, (vint){0} + h->index[i]);
}

/* On the points' rays, as far as these go. */
static inline struct vvec3 places_along(const struct shade_batch *points, uint32_t i,
                                        struct vvec3 from)
{
    return v3_mad(from, v_load(points->t + i), v3_load(points->incoming, i));
}

struct vsphere {
    struct vvec3 center;
    vreal radius;
};

static inline struct vsphere spheres_at(const struct geometry *g, vint at)
{
    const struct sphere *all = g->spheres.at;
    return (struct vsphere){v3_gather(&all->center, at, STEP_OF(struct sphere)),
                            v_gather(&all->radius, at * STEP_OF(struct sphere))};
}

static inline void sphere_points(const struct vsphere *s, const struct hit_shapes *h, uint32_t i,
                                 struct shade_batch *points)
{
    struct vvec3 normal = places_along(points, i, v3_sub(v3_load(h->origin, i), s->center));
    normal = v3_normalize(normal);
    v3_store(&points->normal, i, normal);
    v3_store(&points->p, i, v3_mad(s->center, s->radius, normal));
}

struct vcylinder {
    struct vvec3 base, axis;
    vreal height, radius;
};

static inline struct vcylinder cylinders_at(const struct geometry *g, vint at)
{
    const struct cylinder *all = g->cylinders.at;
    return (struct vcylinder){v3_gather(&all->base, at, STEP_OF(struct cylinder)),
                              v3_gather(&all->axis, at, STEP_OF(struct cylinder)),
                              v_gather(&all->height, at * STEP_OF(struct cylinder)),
                              v_gather(&all->radius, at * STEP_OF(struct cylinder))};
}

static inline void cylinder_points(const struct vcylinder *c, const struct hit_shapes *h,
                                   uint32_t i, struct shade_batch *points)
{
    vreal zero = v_all(0), part = v_load(h->part + i);
    vmask side = v_equal(part, v_all(CYLINDER_SIDE)), top = v_equal(part, v_all(CYLINDER_TOP));
    struct vvec3 p = places_along(points, i, v3_sub(v3_load(h->origin, i), c->base));
    vreal z = v3_dot(p, c->axis);
    struct vvec3 across = v3_mad(p, -z, c->axis);
    vreal length = v_sqrt(v3_dot(across, across));
    struct vvec3 outwards = v3_scale(across, 1 / length);
    across = v3_select(side | v_less(c->radius, length), v3_scale(outwards, c->radius), across);
    vmask low = v_equal(part, v_all(CYLINDER_BASE)) | v_less(z, zero);
    z = v_select(low, zero, v_select(top | v_less(c->height, z), c->height, z));
    struct vvec3 cap = v3_select(top, c->axis, v3_neg(c->axis));
    v3_store(&points->normal, i, v3_select(side, outwards, cap));
    v3_store(&points->p, i, v3_add(c->base, v3_mad(across, z, c->axis)));
}

/* ---- triangles ------------------------------------------------------------------------------- */

struct vtriangle {
    vint vertex[3];
    struct vvec3 corner[3], normal;
    /* Planes across its sides, as far inside as triangle_settle moves points and a tenth more,
     * which is far more than rounding errors; of points with larger coordinates they tell nothing.
     */
    struct vvec3 inwards[3];
    vreal least[3], largest;
};

/* No side is longer than the sum of its parts along the axes. */
static inline void fence_in(const struct geometry *g, vint at, struct vtriangle *t)
{
    vreal reach = v_gather(&g->triangles.at->reach, at * STEP_OF(struct triangle));
    vreal clear = 2.5 * EDGE_CLEARANCE * SPAWN_TOLERANCE * reach;
    t->largest = 1.25 * reach;
    for (int k = 0; k < 3; k++) {
        struct vvec3 from = t->corner[k], along = v3_sub(t->corner[(k + 1) % 3], from);
        vreal length = v_abs(along.x) + v_abs(along.y) + v_abs(along.z);
        t->inwards[k] = v3_cross_plain(t->normal, along);
        t->least[k] = v3_dot(t->inwards[k], from) + clear * length;
    }
}

static inline struct vtriangle triangles_at(const struct geometry *g, vint at)
{
    const struct triangle *all = g->triangles.at;
    struct vtriangle t = {.normal = v3_gather(&all->normal, at, STEP_OF(struct triangle))};
    for (int k = 0; k < 3; k++) {
        t.vertex[k] = v_gather_uint32(&all->vertex[k], at * (2 * STEP_OF(struct triangle)));
        t.corner[k] = v3_gather(g->vertices.at, t.vertex[k], STEP_OF(struct vec3));
    }
    fence_in(g, at, &t);
    return t;
}

/* Those that may have to be moved are looked at one by one. */
static inline struct vvec3 settled(const struct geometry *g, const struct vtriangle *t,
                                   const uint32_t *prims, uint32_t n, struct vvec3 p)
{
    vmask inside = v_at_most(v3_largest(p), t->largest);
    for (int k = 0; k < 3; k++)
        inside &= v_at_most(t->least[k], v3_dot(t->inwards[k], p));
    for (unsigned left = v_bits(v_first(n) & v_not(inside)); left; left &= left - 1) {
        int k = __builtin_ctz(left);
        struct vec3 at = vec3(p.x[k], p.y[k], p.z[k]);
        struct vec3 moved = triangle_settle(g, prims[k], at, vec3_largest(at));
        p.x[k] = moved.x;
        p.y[k] = moved.y;
        p.z[k] = moved.z;
    }
    return p;
}

struct vpoint2 {
    vreal x, y;
};

/* The lanes whose ray runs along x most, and along y. */
struct shear {
    vmask along_x, along_y;
    vreal x, y;
};

static inline struct shear shear_of(struct vvec3 d)
{
    vreal x = v_abs(d.x), y = v_abs(d.y), z = v_abs(d.z);
    vmask along_x = v_less(y, x) & v_less(z, x), along_y = v_less(z, y) & v_not(along_x);
    vreal inverse = 1 / v_select(along_x, d.x, v_select(along_y, d.y, d.z));
    return (struct shear){along_x, along_y,
                          v_select(along_x, d.y, v_select(along_y, d.z, d.x)) * inverse,
                          v_select(along_x, d.z, v_select(along_y, d.x, d.y)) * inverse};
}

static inline struct vpoint2 sheared(struct vvec3 p, const struct shear *s)
{
    vreal along = v_select(s->along_x, p.x, v_select(s->along_y, p.y, p.z));
    vreal x = v_select(s->along_x, p.y, v_select(s->along_y, p.z, p.x));
    vreal y = v_select(s->along_x, p.z, v_select(s->along_y, p.x, p.y));
    return (struct vpoint2){x - s->x * along, y - s->y * along};
}

static inline vreal largest_of_3(vreal a, vreal b, vreal c)
{
    return v_max(v_max(v_abs(a), v_abs(b)), v_abs(c));
}

/* Fills in b1 and b2 of points i to `end`; where plain products are not enough, one by one. */
static inline void weigh_corners(const struct geometry *g, const struct hit_shapes *h,
                                 const struct vtriangle *t, uint32_t i, uint32_t end,
                                 struct shade_batch *points)
{
    struct vvec3 o = v3_load(h->origin, i);
    struct shear shear = shear_of(v3_load(points->incoming, i));
    struct vpoint2 a = sheared(v3_sub(t->corner[0], o), &shear);
    struct vpoint2 b = sheared(v3_sub(t->corner[1], o), &shear);
    struct vpoint2 c = sheared(v3_sub(t->corner[2], o), &shear);
    vreal u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
    vreal sum = u + v + w, largest = largest_of_3(a.x, b.x, c.x) * largest_of_3(a.y, b.y, c.y);
    v_store(points->b1 + i, v / sum);
    v_store(points->b2 + i, w / sum);
    vmask unsure = v_first(end - i) & v_not(v_at_most(largest, 16 * v_abs(sum)));
    for (unsigned left = v_bits(unsure); left; left &= left - 1) {
        uint32_t k = i + (uint32_t)__builtin_ctz(left);
        struct hit hit = {.prim = points->prim[k]};
        struct ray ray = {.origin = vec3_get(h->origin, k),
                          .direction = vec3_get(points->incoming, k)};
        geometry_weights(g, &ray, &hit);
        points->b1[k] = hit.b1;
        points->b2[k] = hit.b2;
    }
}

/* The lanes on smooth surfaces, with the normals at their corners, and on flipped ones. */
struct bends {
    vmask smooth, flipped;
    struct vvec3 normal[3];
};

/* Normals of the lanes `own` of one smooth surface. */
static inline void gather_normals(const struct surface *surface, const struct vtriangle *t,
                                  vint prim, vmask own, struct bends *b)
{
    const struct triangle_corners *corners = surface->normal_corners;
    vint zero = {0}, face = v_select_int(own, prim - surface->first_prim, zero);
    for (int k = 0; k < 3; k++) {
        vint at = t->vertex[k] - surface->first_vertex;
        at = corners ? v_gather_uint32(&corners->at[k], 3 * face) : v_select_int(own, at, zero);
        struct vvec3 normal = v3_gather(surface->normals, at, STEP_OF(struct vec3));
        b->normal[k] = v3_select(own, normal, b->normal[k]);
    }
}

static inline struct bends bends_of(const struct scene *scene, const struct vtriangle *t,
                                    uint32_t i, uint32_t end, const struct shade_batch *points)
{
    vmask used = v_first(end - i), none = used & v_not(used);
    vint prim = v_long(v_load_int32((const int32_t *)points->prim + i));
    vreal of = v_real(v_load_int32((const int32_t *)points->surface + i)), zero = v_all(0);
    struct vvec3 no = {zero, zero, zero};
    struct bends b = {none, none, {no, no, no}};
    for (unsigned left = v_bits(used); left;) {
        uint32_t number = points->surface[i + (uint32_t)__builtin_ctz(left)];
        const struct surface *surface = &scene->surfaces.at[number];
        vmask own = used & v_equal(of, v_all(number));
        left &= ~v_bits(own);
        if (surface->flip)
            b.flipped |= own;
        if (!surface->normals)
            continue;
        b.smooth |= own;
        gather_normals(surface, t, prim, own, &b);
    }
    return b;
}

/* See surface_lift. */
static inline struct vvec3 lifted(const struct vtriangle *t, const struct bends *b,
                                  const vreal weight[3], struct vvec3 p, struct vvec3 outwards)
{
    struct vvec3 up = p;
    vreal zero = v_all(0);
    for (int k = 0; k < 3; k++) {
        struct vvec3 n = b->normal[k];
        n = v3_select(v_less(v3_dot(n, outwards), zero), v3_neg(n), n);
        vreal above = v3_dot(v3_sub(p, t->corner[k]), n);
        up = v3_select(v_less(above, zero), v3_mad(up, -weight[k] * above, n), up);
    }
    return v3_select(b->smooth, up, p);
}

/* Fills in the normals of points i to `end`, and what curved points need. */
static inline void bend_lanes(const struct scene *scene, const struct vtriangle *t, uint32_t i,
                              uint32_t end, struct shade_batch *points)
{
    struct bends b = bends_of(scene, t, i, end, points);
    vreal b1 = v_load(points->b1 + i), b2 = v_load(points->b2 + i);
    vreal weight[3] = {1 - b1 - b2, b1, b2}, zero = v_all(0);
    struct vvec3 face = t->normal, p = v3_load(&points->p, i);
    struct vvec3 n = v3_scale(b.normal[0], weight[0]);
    n = v3_mad(n, b1, b.normal[1]);
    n = v3_mad(n, b2, b.normal[2]);
    n = v3_select(b.smooth & v_less(zero, v3_largest(n)), v3_normalize(n), face);
    v3_store(&points->normal, i, v3_select(b.flipped, v3_neg(n), n));
    if (!points->curved)
        return;
    vmask behind = v_less(zero, v3_dot(face, v3_load(points->incoming, i)));
    struct vvec3 outwards = v3_select(behind, v3_neg(face), face);
    v3_store(&points->lifted, i, lifted(t, &b, weight, p, outwards));
    v3_store(&points->geometric, i, v3_select(b.flipped, v3_neg(face), face));
}

static inline void triangle_points(const struct scene *scene, const struct hit_shapes *h,
                                   const struct vtriangle *t, uint32_t i, uint32_t end,
                                   struct shade_batch *points)
{
    const struct geometry *g = &scene->geometry;
    struct vvec3 p = places_along(points, i, v3_load(h->origin, i));
    p = v3_mad(p, v3_dot(t->normal, v3_sub(t->corner[0], p)), t->normal);
    p = settled(g, t, points->prim + i, end - i, p);
    v3_store(&points->p, i, p);
    v3_store(&points->normal, i, t->normal);
    if (h->weighted)
        weigh_corners(g, h, t, i, end, points);
    if (h->bent)
        bend_lanes(scene, t, i, end, points);
}

/* ---- all of them ----------------------------------------------------------------------------- */

static bool one_shape(const struct hit_shapes *h, uint32_t first, uint32_t end)
{
    uint32_t differing = 0;
    for (uint32_t i = first; i < end; i++)
        differing |= h->index[i] ^ h->index[first];
    return differing == 0;
}

/* What all points of a kind lie on is read once.  The last vector reaches into the next kind's
 * points, which come later. */
static void points_on_spheres(const struct geometry *g, const struct hit_shapes *h,
                              struct shade_batch *points)
{
    uint32_t first = h->first[PRIM_SPHERE], end = h->first[PRIM_SPHERE + 1];
    bool same = one_shape(h, first, end);
    struct vsphere s;
    for (uint32_t i = first; i < end; i += LANES) {
        if (!same || i == first)
            s = spheres_at(g, shapes_at(h, i, end));
        sphere_points(&s, h, i, points);
    }
}

static void points_on_cylinders(const struct geometry *g, const struct hit_shapes *h,
                                struct shade_batch *points)
{
    uint32_t first = h->first[PRIM_CYLINDER], end = h->first[PRIM_CYLINDER + 1];
    bool same = one_shape(h, first, end);
    struct vcylinder c;
    for (uint32_t i = first; i < end; i += LANES) {
        if (!same || i == first)
            c = cylinders_at(g, shapes_at(h, i, end));
        cylinder_points(&c, h, i, points);
    }
}

static void points_on_triangles(const struct scene *scene, const struct hit_shapes *h,
                                struct shade_batch *points)
{
    const struct geometry *g = &scene->geometry;
    uint32_t first = h->first[PRIM_TRIANGLE], end = h->first[PRIM_TRIANGLE + 1];
    bool same = one_shape(h, first, end);
    struct vtriangle t;
    for (uint32_t i = first; i < end; i += LANES) {
        if (!same || i == first)
            t = triangles_at(g, shapes_at(h, i, end));
        triangle_points(scene, h, &t, i, end, points);
    }
}

static void hit_points(const struct scene *scene, const struct hit_shapes *h,
                       struct shade_batch *points)
{
    points_on_spheres(&scene->geometry, h, points);
    points_on_cylinders(&scene->geometry, h, points);
    for (uint32_t i = 0; i < h->first[PRIM_TRIANGLE] && points->curved; i += LANES) {
        v3_store(&points->geometric, i, v3_load(&points->normal, i));
        v3_store(&points->lifted, i, v3_load(&points->p, i));
    }
    points_on_triangles(scene, h, points);
    for (uint32_t i = h->first[PRIM_INSTANCE]; i < h->first[PRIM_INSTANCE + 1]; i++)
        place_point(scene, h, i, points);
}
