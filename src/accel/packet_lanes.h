/* A batch of rays through a wide tree together: included once by the file of each instruction set,
 * which sets WIDE_KERNELS and BUNDLE_KERNELS to the names of its tables.  What may be met
 * is told by the pyramids of pyramid_lanes.h. */
#include "accel/pyramid_lanes.h"

/* ---- boxes ----------------------------------------------------------------------------------- */

/* The boxes (bit j: box i + j) that the wedge may touch.  What rounds to a bound's wrong side was
 * there before: bounds are floats, and a sum is rounded once. */
static inline unsigned boxes_touched(const struct frame_wedge *w, const struct wide_node *node,
                                     int x, int k, int i)
{
    float low = w->slope[0], high = w->slope[1];
    vfloat most =
        f_bound(f_load(node->plane[low < 0][k] + i), f_all(-low), f_load(node->plane[1][x] + i));
    vfloat least =
        f_bound(f_load(node->plane[high > 0][k] + i), f_all(-high), f_load(node->plane[0][x] + i));
    return f_at_most(f_all(w->bound[0]), most) & f_at_most(least, f_all(w->bound[1]));
}

/* The children that the pyramid may touch, and how far along k they begin. */
static inline unsigned touched_children(const struct packet *p, const struct wide_node *node,
                                        float *enter)
{
    unsigned touched = 0;
    int k = p->axis[2];
    float sign = p->down ? -1 : 1;
    for (int i = 0; i < WIDE; i += FLOATS) {
        vfloat begin = sign * f_load(node->plane[p->down][k] + i);
        vfloat end = sign * f_load(node->plane[!p->down][k] + i);
        f_store(enter + i, begin);
        touched |=
            (boxes_touched(&p->in_frame[0], node, p->axis[0], k, i) &
             boxes_touched(&p->in_frame[1], node, p->axis[1], k, i) &
             f_at_most(begin, f_all(p->far_in_frame)) & f_at_most(f_all(p->near_in_frame), end))
            << i;
    }
    return touched;
}

/* ---- leaves ---------------------------------------------------------------------------------- */

/* Corners of LANES triangles in the packet's axes. */
struct vcorners {
    vreal x[2][3], k[3];
    vreal begin; /* along k */
};

static inline struct vcorners corners_at(const struct packet *p, const struct triangle_block *block,
                                         int i)
{
    struct vcorners c;
    for (int v = 0; v < 3; v++) {
        c.x[0][v] = v_load(block->corner[v][p->axis[0]] + i);
        c.x[1][v] = v_load(block->corner[v][p->axis[1]] + i);
        c.k[v] = v_load(block->corner[v][p->axis[2]] + i);
    }
    vreal least = v_min(v_min(c.k[0], c.k[1]), c.k[2]), most = v_max(v_max(c.k[0], c.k[1]), c.k[2]);
    c.begin = p->down ? -most : least;
    return c;
}

static inline vmask corners_outside(const struct wedge *w, const struct vcorners *c, int side)
{
    vreal low = v_all(-w->slope[0]), high = v_all(-w->slope[1]);
    vreal most = v_bound(low, c->k[0], c->x[side][0]),
          least = v_bound(high, c->k[0], c->x[side][0]);
    for (int v = 1; v < 3; v++) {
        most = v_max(v_bound(low, c->k[v], c->x[side][v]), most);
        least = v_min(v_bound(high, c->k[v], c->x[side][v]), least);
    }
    return v_less(most, v_all(w->bound[0])) | v_less(v_all(w->bound[1]), least);
}

static inline unsigned touched_triangles(const struct pyramid *y, const struct vcorners *c)
{
    vmask outside = corners_outside(&y->side[0], c, 0) | corners_outside(&y->side[1], c, 1) |
                    v_less(v_all(y->far), c->begin);
    return v_bits(v_not(outside));
}

/* Triangles that begin less far from the apex than this are met by all parts. */
static inline float near_apex(const struct packet *p)
{
    return (float)(NEAR_APEX * p->padding);
}

/* Returns the triangles that any part may overlap. */
static inline unsigned find_aspects(const struct packet *p, const struct triangle_block *block,
                                    struct aspects *seen)
{
    unsigned overlapping = 0;
    for (int i = 0; i < WIDE; i += FLOATS) {
        vfloat way[3];
        for (int v = 0; v < 3; v++)
            way[v] = f_difference(block->corner[v][p->axis[2]] + i, p->apex[2]);
        vfloat nearest =
            p->ahead ? f_min(f_min(way[0], way[1]), way[2]) : -f_max(f_max(way[0], way[1]), way[2]);
        f_store(seen->way + i, nearest);
        unsigned over = f_at_most(nearest, f_all(p->outline.way));
        for (int side = 0; side < 2; side++) {
            vfloat slope[3];
            for (int v = 0; v < 3; v++)
                slope[v] =
                    f_difference(block->corner[v][p->axis[side]] + i, p->apex[side]) / way[v];
            vfloat least = f_min(f_min(slope[0], slope[1]), slope[2]);
            vfloat most = f_max(f_max(slope[0], slope[1]), slope[2]);
            f_store(seen->least[side] + i, least);
            f_store(seen->most[side] + i, most);
            over &= f_at_most(least, f_all(p->outline.most[side])) &
                    f_at_most(f_all(p->outline.least[side]), most);
        }
        overlapping |= (over | f_at_most(nearest, f_all(near_apex(p)))) << i;
    }
    return overlapping;
}

/* The parts (bit j: part j) that a triangle overlaps. */
static inline unsigned overlapped_parts(const struct packet *p, const struct aspects *seen, int i)
{
    const struct aspects *parts = &p->aspects;
    unsigned overlapped = 0;
    if (seen->way[i] <= near_apex(p))
        return ALL_PARTS;
    for (int j = 0; j < PARTS; j += FLOATS) {
        unsigned part = f_at_most(f_all(seen->way[i]), f_load(parts->way + j));
        for (int side = 0; side < 2; side++)
            part &= f_at_most(f_all(seen->least[side][i]), f_load(parts->most[side] + j)) &
                    f_at_most(f_load(parts->least[side] + j), f_all(seen->most[side][i]));
        overlapped |= part << j;
    }
    return overlapped;
}

/* A block's triangle against parts of the rays; returns those that met it. */
static inline unsigned meet_in_block(struct packet *p, const struct triangle_block *block, int i,
                                     unsigned parts)
{
    struct vec3 corner[3];
    for (int v = 0; v < 3; v++)
        corner[v] = vec3(block->corner[v][0][i], block->corner[v][1][i], block->corner[v][2][i]);
    return meet_triangle(p->frames, block->target[i], corner, parts);
}

/* Returns the parts that met something. */
static unsigned meet_seen_block(struct packet *p, const struct triangle_block *block,
                                unsigned count)
{
    struct aspects seen;
    unsigned met = 0;
    if (!p->parted)
        make_all_parts(p);
    unsigned overlapping = find_aspects(p, block, &seen) & ((1u << count) - 1);
    for (; overlapping; overlapping &= overlapping - 1) {
        int i = __builtin_ctz(overlapping);
        unsigned parts = overlapped_parts(p, &seen, i) & parts_of_rays(p->frames);
        if (parts)
            met |= meet_in_block(p, block, i, parts);
    }
    return met;
}

/* Returns the parts that met something. */
static unsigned meet_block(struct packet *p, const struct triangle_block *block, unsigned count)
{
    unsigned parts_of[WIDE] = {0}, touched = 0, met = 0;
    for (int i = 0; i < WIDE; i += LANES) {
        struct vcorners c = corners_at(p, block, i);
        if (!touched_triangles(&p->whole, &c))
            continue;
        if (!p->parted)
            make_all_parts(p);
        for (unsigned j = 0; PART * j < p->frames->n; j++) {
            unsigned of_part = touched_triangles(&p->part[j], &c) << i;
            touched |= of_part;
            for (; of_part; of_part &= of_part - 1)
                parts_of[__builtin_ctz(of_part)] |= 1u << j;
        }
    }
    for (touched &= (1u << count) - 1; touched; touched &= touched - 1) {
        int i = __builtin_ctz(touched);
        met |= meet_in_block(p, block, i, parts_of[i]);
    }
    return met;
}

/* ---- primitives of any kind, by their boxes ---------------------------------------------------
 */

static inline bool box_outside(const struct wedge *w, const struct range *x, const struct range *k)
{
    double low = fmax(-w->slope[0] * k->lo, -w->slope[0] * k->hi);
    double high = fmin(-w->slope[1] * k->lo, -w->slope[1] * k->hi);
    return x->hi + low < w->bound[0] || x->lo + high > w->bound[1];
}

/* b: along the packet's axes. */
static inline bool box_touched(const struct pyramid *y, const struct range b[3], bool down)
{
    return !((down ? -b[2].hi : b[2].lo) > y->far || box_outside(&y->side[0], &b[0], &b[2]) ||
             box_outside(&y->side[1], &b[1], &b[2]));
}

/* What the box is as a triangle is by find_aspects, of which this is the first. */
static inline void find_aspect_of_box(const struct packet *p, const struct range b[3],
                                      struct aspects *seen)
{
    float near = (float)(b[2].lo - p->apex[2]), far = (float)(b[2].hi - p->apex[2]);
    seen->way[0] = p->ahead ? near : -far;
    for (int side = 0; side < 2; side++) {
        float lo = (float)(b[side].lo - p->apex[side]), hi = (float)(b[side].hi - p->apex[side]);
        float slope[4] = {lo / near, lo / far, hi / near, hi / far};
        seen->least[side][0] = fminf(fminf(slope[0], slope[1]), fminf(slope[2], slope[3]));
        seen->most[side][0] = fmaxf(fmaxf(slope[0], slope[1]), fmaxf(slope[2], slope[3]));
    }
}

/* The parts of the rays that may touch the box, which is seen like that where there is an apex. */
static unsigned parts_near(struct packet *p, const struct box *box, struct aspects *seen)
{
    struct range b[3];
    unsigned near = 0;
    for (int side = 0; side < 3; side++)
        b[side] = (struct range){vec3_at(box->lo, p->axis[side]), vec3_at(box->hi, p->axis[side])};
    if (!box_touched(&p->whole, b, p->down))
        return 0;
    if (!p->parted)
        make_all_parts(p);
    if (p->has_apex) {
        find_aspect_of_box(p, b, seen);
        return overlapped_parts(p, seen, 0) & parts_of_rays(p->frames);
    }
    for (unsigned j = 0; PART * j < p->frames->n; j++)
        near |= (unsigned)box_touched(&p->part[j], b, p->down) << j;
    return near;
}

/* ---- instances ------------------------------------------------------------------------------- */

/* Rays that meet more leaves of an instance's shapes are faster one after another. */
#define LEAVES_SHARED 100

/* Rays as an instance's shapes see them, and what they hit there. */
struct inner_batch {
    struct ray_batch rays;
    struct hit_batch hits;
    alignas(64) double reach[BATCH_ROOM];
};

static void trace_inner(const struct accel *a, struct inner_batch *inner, bool any, bool together);

static void frames_inside(struct frame_batch *f, const struct geometry *g,
                          struct inner_batch *inner)
{
    frames_init(f, g, &inner->rays, true, true, &inner->hits);
    memcpy(f->reach, inner->reach, f->n * sizeof *f->reach);
}

/* See affine_vector. */
static inline struct vvec3 v3_mapped(const struct affine *a, struct vvec3 v)
{
    const double(*m)[4] = a->m;
    return (struct vvec3){m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
                          m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

/* instance_ray for the rays of the parts, which move together. */
static void enter_instance(const struct frame_batch *f, const struct instance *i, unsigned parts,
                           struct inner_batch *inner)
{
    const struct ray_batch *rays = f->rays;
    struct vvec3 offset =
        v3_all(vec3(i->to_shape.m[0][3], i->to_shape.m[1][3], i->to_shape.m[2][3]));
    uint32_t to = 0;
    inner->rays.n = 0;
    for (uint32_t from = next_lanes(f, &parts, 0); from < f->n;
         from = next_lanes(f, &parts, from + LANES), to += LANES) {
        struct vvec3 origin = v3_load(&rays->origin, from);
        v3_store(&inner->rays.origin, to, v3_add(v3_mapped(&i->to_shape, origin), offset));
        v3_store(&inner->rays.direction, to,
                 v3_mapped(&i->to_shape, v3_load(&rays->direction, from)));
        v_store(inner->rays.t_max + to, v_load(f->hits->t + from));
        v_store(inner->rays.from + to, v_all(PRIM_NONE));
        v_store(inner->reach + to,
                rays->spawned ? i->growth * v3_largest(origin) + i->reach : v_all(0));
        inner->rays.n += rays->n - from < LANES ? rays->n - from : LANES;
    }
    inner->rays.common_origin = rays->common_origin;
    inner->rays.common_from = true;
    inner->rays.spawned = rays->spawned;
}

/* instance_offer for those rays; returns the parts that met something. */
static unsigned leave_instance(struct frame_batch *f, const struct instance *i, uint32_t prim,
                               unsigned parts, const struct inner_batch *inner)
{
    const double *part = i->only == PRIM_NONE ? inner->hits.prim : inner->hits.part;
    unsigned met = 0;
    uint32_t from = 0;
    for (uint32_t to = next_lanes(f, &parts, 0); to < f->n;
         to = next_lanes(f, &parts, to + LANES), from += LANES) {
        vmask none = v_equal(v_load(inner->hits.prim + from), v_all(PRIM_NONE));
        vreal t = v_select(none, v_all(0), v_load(inner->hits.t + from));
        if (offer(f, to, t, prim, v_load(part + from)))
            met |= 1u << to / PART;
    }
    return met;
}

static void trace_only(const struct geometry *g, uint32_t prim, struct inner_batch *inner)
{
    struct frame_batch frames;
    frames_inside(&frames, g, inner);
    meet(&frames, target_of(g, prim), parts_of_rays(&frames));
}

/* Whether the rays are to share their way through the instance: the leaves that the part of its box
 * behind all of them may hold are few. */
static bool shares_leaves(const struct packet *p, const struct accel *a, const struct aspects *box)
{
    double part = 1;
    if (!p->has_apex || !a->wide || box->way[0] <= near_apex(p))
        return true;
    for (int side = 0; side < 2; side++) {
        double least = fmax(box->least[side][0], p->outline.least[side]);
        double most = fmin(box->most[side][0], p->outline.most[side]);
        part *= (most - least) / (box->most[side][0] - box->least[side][0]);
    }
    return part * a->wide->block_count <= LEAVES_SHARED;
}

static unsigned meet_instance(struct packet *p, struct target target, unsigned parts,
                              const struct aspects *box)
{
    const struct geometry *g = p->accel->geometry;
    const struct instance *i = &g->instances.at[target.index];
    const struct accel *shapes = &p->accel->prototypes[i->prototype];
    struct inner_batch inner;
    enter_instance(p->frames, i, parts, &inner);
    if (i->only == PRIM_NONE)
        trace_inner(shapes, &inner, p->any, shares_leaves(p, shapes, box));
    else
        trace_only(&g->prototypes.at[i->prototype]->shapes, i->only, &inner);
    return leave_instance(p->frames, i, target.prim, parts, &inner);
}

/* Returns the parts that met something. */
static unsigned meet_run(struct packet *p, struct wide_child run)
{
    const struct geometry *g = p->accel->geometry;
    unsigned met = 0;
    for (uint32_t k = run.first; k < run.first + run.count; k++) {
        struct target target = p->accel->targets[k];
        struct box box = target_bounds(g, target);
        struct aspects seen;
        unsigned parts = parts_near(p, &box, &seen);
        if (parts)
            met |= target.kind == PRIM_INSTANCE ? meet_instance(p, target, parts, &seen)
                                                : meet(p->frames, target, parts);
    }
    return met;
}

/* ---- the tree -------------------------------------------------------------------------------- */

/* Rays to a light that meet more leaves together have little in common and are better off alone,
 * and so are any that meet more primitives of other kinds than triangles. */
enum { LEAVES_LIMIT = 48, OTHERS_LIMIT = 24 };

/* False when it is given up. */
static bool walk_packet(struct packet *p)
{
    const struct wide *wide = p->accel->wide;
    uint32_t leaves = 0, others = 0;
    struct wide_pending stack[WIDE_STACK], *top = stack;
    alignas(32) float enter[WIDE];
    *top++ = (struct wide_pending){&WIDE_ROOT, -INFINITY};
    unsigned met = 0; /* parts that know not yet how far they go */
    while (top > stack) {
        if (met)
            find_farthest(p, met);
        met = 0;
        top--;
        struct wide_child at = *top->child;
        if (top->enter > p->far_in_frame)
            continue;
        if (at.kind == WIDE_NODE) {
            const struct wide_node *node = &wide->nodes[at.first];
            top = push_sorted(top, node, touched_children(p, node, enter), enter);
        } else if (at.kind == WIDE_TRIANGLES) {
            const struct triangle_block *block = &wide->blocks[at.first];
            if (p->any && ++leaves > LEAVES_LIMIT)
                return false;
            met =
                p->has_apex ? meet_seen_block(p, block, at.count) : meet_block(p, block, at.count);
        } else if (at.count > 0) {
            others += at.count;
            if (others > OTHERS_LIMIT)
                return false;
            met = meet_run(p, at);
        }
    }
    return true;
}

static bool trace_packet(const struct accel *a, struct frame_batch *frames, bool any)
{
    struct packet p;
    p.accel = a;
    p.frames = frames;
    p.any = any;
    return packet_init(&p) && walk_packet(&p);
}

static bool packet_in_wide(const struct accel *a, const struct ray_batch *rays, bool any,
                           struct hit_batch *hits)
{
    struct frame_batch frames;
    frames_init(&frames, a->geometry, rays, a->has[PRIM_SPHERE], true, hits);
    return trace_packet(a, &frames, any);
}

/* One after another. */
static void trace_inner_rays(const struct accel *a, struct inner_batch *inner, bool any)
{
    for (uint32_t i = 0; i < inner->rays.n; i++) {
        struct ray ray = ray_get(&inner->rays, i);
        struct ray_frame frame = ray_frame_of(&ray);
        struct hit hit = hit_none(ray.t_max);
        frame.reach = inner->reach[i];
        if (any)
            any_in_wide(a, &ray, &frame, &hit);
        else
            closest_in_wide(a, &ray, &frame, &hit);
        hit_put(&inner->hits, i, &hit);
    }
}

/* What find of traverse.c finds for each of them. */
static void trace_inner(const struct accel *a, struct inner_batch *inner, bool any, bool together)
{
    struct frame_batch frames;
    frames_inside(&frames, a->geometry, inner);
    for (uint32_t k = 0; !a->wide && k < a->target_count; k++)
        meet(&frames, a->targets[k], parts_of_rays(&frames));
    together &= wide_takes_packets(a, inner->rays.n);
    if (a->wide && !(together && trace_packet(a, &frames, any)))
        trace_inner_rays(a, inner, any);
}

const struct wide_kernels WIDE_KERNELS = {closest_in_wide, any_in_wide, packet_in_wide};
