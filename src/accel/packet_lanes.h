/* A batch of rays through a wide tree together: included once by the file of each instruction set,
 * which sets WIDE_KERNELS and BUNDLE_KERNELS to the names of its tables.
 *
 * Along the axis k on which all rays run the same way, a pyramid of four planes holds every ray:
 *
 *     slope[0] k + bound[0] <= x <= slope[1] k + bound[1]
 *
 * and the same for y.  It is tested against eight boxes at a time, then against the eight triangles
 * of a leaf; so are the smaller pyramids of each part of the batch.  What is left out no ray can
 * meet; for what remains meet_triangle decides.
 *
 * Rays from or to one point, the apex, are held by ranges of slopes x / k and y / k as seen from
 * there; parts of the batch and triangles overlap in these or not.
 *
 * Any slopes will do, as the bounds are taken from the rays' ends; good ones are those of the
 * outermost rays.  Everything is widened by `padding`: that of the boxes, which holds the rounding
 * errors of hits, and as much again for those of the planes: some 2^-50 of the coordinates
 * involved, where the padding is 2^-42 of them. */
#include "accel/wide_lanes.h"

/* Two planes, see above. */
struct wedge {
    double slope[2], bound[2];
};

struct pyramid {
    struct wedge side[2]; /* of x, of y */
    double far;           /* no ray that may still hit goes farther along k */
};

struct range {
    double lo, hi;
};

/* Slopes of rays or triangles side by side, as seen from the apex, and the way from it along k. */
struct aspects {
    alignas(32) float least[2][WIDE], most[2][WIDE]; /* of x and y */
    alignas(32) float way[WIDE]; /* of triangles, their nearest corner's; of rays, the farthest */
};

struct packet {
    const struct accel *accel;
    struct frame_batch *frames;
    int axis[3];   /* x, y, k */
    bool down;     /* the rays run down k; distances along it are then counted negatively */
    bool converge; /* towards a common end, not from a common origin */
    bool endless;
    bool any;              /* a ray ends at the first hit found */
    bool parted;           /* `part` or `aspects` are made: once a leaf is reached */
    bool has_apex;         /* all rays start there, or would end there at t = 1 */
    bool ahead;            /* k grows on the way from the apex */
    double apex[3];        /* along x, y and k */
    struct range start[3]; /* of the origins, along x, y and k */
    double padding, near;
    struct pyramid whole, part[PARTS];
    struct aspects aspects;  /* of the parts, where there is an apex */
    struct pyramid in_frame; /* the whole one in the frame of the tree's boxes */
    double near_in_frame;
    alignas(64) double slope[2][BATCH_ROOM]; /* x and y over k */
    alignas(64) double end[3][BATCH_ROOM];   /* unless endless */
};

/* ---- pyramids -------------------------------------------------------------------------------- */

static inline const double *along(const struct vec3_batch *b, int axis)
{
    return axis == 0 ? b->x : axis == 1 ? b->y : b->z;
}

/* The lanes i to i + LANES of an array, those behind the last ray as the first. */
static inline vreal lanes_of(const struct packet *p, const double *array, uint32_t i)
{
    static const double numbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    uint32_t n = p->frames->rays->n;
    if (i + LANES <= n)
        return v_load(array + i);
    vmask there = v_less(v_load(numbers), v_all((double)n - i));
    return v_select(there, v_load(array + i), v_all(array[0]));
}

static struct range range_of(const struct packet *p, const double *array)
{
    vreal least = v_all(INFINITY), most = v_all(-INFINITY);
    for (uint32_t i = 0; i < p->frames->n; i += LANES) {
        vreal x = lanes_of(p, array, i);
        least = v_min(x, least);
        most = v_max(x, most);
    }
    return (struct range){v_least(least), v_most(most)};
}

/* Moves the bounds out to hold the points. */
static void bound_points(const struct packet *p, const double *x, const double *k, uint32_t first,
                         uint32_t end, struct wedge *w)
{
    vreal low = v_all(w->bound[0]), high = v_all(w->bound[1]);
    for (uint32_t i = first; i < end; i += LANES) {
        vreal at_x = lanes_of(p, x, i), at_k = lanes_of(p, k, i);
        low = v_min(at_x - w->slope[0] * at_k, low);
        high = v_max(at_x - w->slope[1] * at_k, high);
    }
    w->bound[0] = v_least(low);
    w->bound[1] = v_most(high);
}

/* Around the rays first to end. */
static struct wedge wedge_around(const struct packet *p, int side, uint32_t first, uint32_t end)
{
    const struct vec3_batch *origin = &p->frames->rays->origin;
    const double *x = along(origin, p->axis[side]), *k = along(origin, p->axis[2]);
    vreal least = v_all(INFINITY), most = v_all(-INFINITY);
    for (uint32_t i = first; i < end; i += LANES) {
        vreal slope = lanes_of(p, p->slope[side], i);
        least = v_min(slope, least);
        most = v_max(slope, most);
    }
    struct wedge w = {{v_least(least), v_most(most)}, {INFINITY, -INFINITY}};
    if (p->down != p->converge)
        w = (struct wedge){{w.slope[1], w.slope[0]}, {INFINITY, -INFINITY}};
    if (p->frames->rays->common_origin)
        w = (struct wedge){{w.slope[0], w.slope[1]},
                           {x[0] - w.slope[0] * k[0], x[0] - w.slope[1] * k[0]}};
    else
        bound_points(p, x, k, first, end, &w);
    if (!p->endless)
        bound_points(p, p->end[side], p->end[2], first, end, &w);
    w.bound[0] -= p->padding * (1 + fabs(w.slope[0]));
    w.bound[1] += p->padding * (1 + fabs(w.slope[1]));
    return w;
}

/* A distance along k in the tree's frame. */
static double along_in_frame(const struct packet *p, double k)
{
    const struct tree_frame *f = &p->accel->wide->frame;
    double center = f->center[p->axis[2]];
    return (k - (p->down ? -center : center)) * f->scale;
}

static struct wedge wedge_in_frame(const struct packet *p, int side)
{
    const struct tree_frame *f = &p->accel->wide->frame;
    struct wedge w = p->whole.side[side];
    double x = f->center[p->axis[side]], k = f->center[p->axis[2]];
    for (int i = 0; i < 2; i++)
        w.bound[i] = (w.bound[i] - (x - w.slope[i] * k)) * f->scale;
    return w;
}

/* How far along k a part's rays can still hit; those with a hit no more, where any counts. */
static double farthest_along(const struct packet *p, uint32_t first)
{
    const struct frame_batch *f = p->frames;
    const double *o = along(&f->rays->origin, p->axis[2]);
    const double *d = along(&f->rays->direction, p->axis[2]);
    vreal far = v_all(-INFINITY);
    for (uint32_t i = first; i < first + PART && i < f->n; i += LANES) {
        vreal at = lanes_of(p, o, i) + lanes_of(p, f->hits->t, i) * lanes_of(p, d, i);
        at = p->down ? -at : at;
        if (p->any)
            at = v_select(v_less(lanes_of(p, f->hits->prim, i), v_all(PRIM_NONE)), v_all(-INFINITY),
                          at);
        far = v_max(at, far);
    }
    return v_most(far) + p->padding;
}

/* How far from the apex a part's rays can still hit, in the same sense. */
static double farthest_way(const struct packet *p, uint32_t first)
{
    const struct frame_batch *f = p->frames;
    const double *d = along(&f->rays->direction, p->axis[2]);
    vreal far = v_all(-INFINITY);
    for (uint32_t i = first; i < first + PART && i < f->n; i += LANES) {
        vreal way = v_abs(lanes_of(p, d, i));
        if (f->rays->common_origin)
            way *= lanes_of(p, f->hits->t, i);
        if (p->any)
            way = v_select(v_less(lanes_of(p, f->hits->prim, i), v_all(PRIM_NONE)),
                           v_all(-INFINITY), way);
        far = v_max(way, far);
    }
    return v_most(far) + p->padding;
}

static void find_farthest_of_part(struct packet *p, uint32_t j)
{
    if (!p->has_apex) {
        p->part[j].far = farthest_along(p, PART * j);
        return;
    }
    double way = farthest_way(p, PART * j), apex = p->down ? -p->apex[2] : p->apex[2];
    bool over = way == -INFINITY;
    p->aspects.way[j] = over ? -INFINITY : float_above(way * (1 + FLOAT_SLACK));
    p->part[j].far = apex + p->padding;
    if (over || p->frames->rays->common_origin)
        p->part[j].far += way;
}

/* After hits of these parts. */
static void find_farthest(struct packet *p, unsigned parts)
{
    for (; parts; parts &= parts - 1)
        find_farthest_of_part(p, (uint32_t)__builtin_ctz(parts));
    p->whole.far = -INFINITY;
    for (uint32_t j = 0; PART * j < p->frames->n; j++)
        p->whole.far = p->part[j].far > p->whole.far ? p->part[j].far : p->whole.far;
    p->in_frame.far = along_in_frame(p, p->whole.far);
}

/* Slopes are widened by this, and this much of themselves: more than what floats and the padding
 * make of those of triangles that are farther from the apex than so many paddings. */
#define SLOPE_SLACK 0x1p-18f
#define NEAR_APEX 0x1p20

static void make_aspects(struct packet *p)
{
    for (uint32_t j = 0; j < PARTS; j++) {
        for (int side = 0; side < 2; side++) {
            vreal least = v_all(INFINITY), most = v_all(-INFINITY);
            for (uint32_t i = PART * j; i < PART * j + PART && i < p->frames->n; i += LANES) {
                vreal slope = lanes_of(p, p->slope[side], i);
                least = v_min(slope, least);
                most = v_max(slope, most);
            }
            float lo = (float)v_least(least), hi = (float)v_most(most);
            p->aspects.least[side][j] = lo - (fabsf(lo) * SLOPE_SLACK + SLOPE_SLACK);
            p->aspects.most[side][j] = hi + (fabsf(hi) * SLOPE_SLACK + SLOPE_SLACK);
        }
    }
    p->parted = true;
}

static void make_parts(struct packet *p)
{
    for (uint32_t j = 0; PART * j < p->frames->n; j++)
        for (int side = 0; side < 2; side++)
            p->part[j].side[side] = wedge_around(p, side, PART * j, PART * j + PART);
    p->parted = true;
}

/* Picks the axis; false when the rays have too little in common, or a direction is none. */
static bool find_axis(struct packet *p)
{
    const struct vec3_batch *d = &p->frames->rays->direction;
    double best = 0, largest = 0;
    p->axis[2] = 0;
    p->down = false;
    for (int axis = 0; axis < 3; axis++) {
        struct range r = range_of(p, along(d, axis));
        double least = r.lo > 0 ? r.lo : -r.hi, most = r.hi > -r.lo ? r.hi : -r.lo;
        largest = most > largest ? most : largest;
        if (least > best) {
            best = least;
            p->axis[2] = axis;
            p->down = r.hi < 0;
        }
    }
    p->axis[0] = (p->axis[2] + 1) % 3;
    p->axis[1] = (p->axis[2] + 2) % 3;
    for (uint32_t i = 0; i < p->frames->n; i += LANES) {
        vreal sum = lanes_of(p, d->x, i) + lanes_of(p, d->y, i) + lanes_of(p, d->z, i);
        if (v_any(v_not(v_at_most(v_abs(sum), v_all(DBL_MAX)))))
            return false;
    }
    return best > 0 && best * 16 >= largest;
}

/* Whether all rays start, or would end, at one point. */
static void find_apex(struct packet *p)
{
    const struct ray_batch *rays = p->frames->rays;
    p->has_apex = rays->common_origin || range_of(p, rays->t_max).hi <= 1;
    p->ahead = p->down != rays->common_origin;
    for (int side = 0; side < 3 && p->has_apex; side++) {
        const double *o = along(&rays->origin, p->axis[side]);
        const double *d = along(&rays->direction, p->axis[side]);
        p->apex[side] = rays->common_origin ? o[0] : o[0] + d[0];
        if (rays->common_origin)
            continue;
        for (uint32_t i = 0; i < p->frames->n; i += LANES)
            p->has_apex &=
                !v_any(v_less(v_all(0.25 * p->padding),
                              v_abs(lanes_of(p, o, i) + lanes_of(p, d, i) - v_all(p->apex[side]))));
    }
}

/* Where the rays start and end. */
static void find_ends(struct packet *p)
{
    const struct ray_batch *rays = p->frames->rays;
    double reach = 0, wider = 0;
    p->endless = !(range_of(p, rays->t_max).hi <= 0x1p60);
    for (int side = 0; side < 3; side++) {
        const double *o = along(&rays->origin, p->axis[side]);
        const double *d = along(&rays->direction, p->axis[side]);
        struct range r = {o[0], o[0]};
        if (!rays->common_origin)
            r = range_of(p, o);
        reach = fmax(reach, fmax(fabs(r.lo), fabs(r.hi)));
        p->start[side] = r;
        if (p->endless)
            continue;
        for (uint32_t i = 0; i < p->frames->n; i += LANES)
            v_store(p->end[side] + i, v_load(o + i) + v_load(rays->t_max + i) * v_load(d + i));
        struct range end = range_of(p, p->end[side]);
        wider += side < 2 ? (r.hi - r.lo) - (end.hi - end.lo) : 0;
    }
    p->converge = wider > 0;
    p->padding = 2 * p->accel->padding * (p->accel->reach + reach);
    p->near = (p->down ? -p->start[2].hi : p->start[2].lo) - p->padding;
}

static void find_slopes(struct packet *p)
{
    const struct vec3_batch *d = &p->frames->rays->direction;
    const double *x = along(d, p->axis[0]), *y = along(d, p->axis[1]), *k = along(d, p->axis[2]);
    for (uint32_t i = 0; i < p->frames->n; i += LANES) {
        vreal inverse = 1 / v_load(k + i);
        v_store(p->slope[0] + i, v_load(x + i) * inverse);
        v_store(p->slope[1] + i, v_load(y + i) * inverse);
    }
}

/* Rays that spread more than this, in units of the way along k, are better off alone. */
#define WIDEST_WEDGE 2.5

static bool packet_init(struct packet *p)
{
    const struct frame_batch *f = p->frames;
    if (!find_axis(p))
        return false;
    find_ends(p);
    find_apex(p);
    find_slopes(p);
    for (int side = 0; side < 2; side++) {
        struct wedge *w = &p->whole.side[side];
        *w = wedge_around(p, side, 0, f->n);
        if (!(fabs(w->slope[1] - w->slope[0]) <= WIDEST_WEDGE))
            return false;
        p->in_frame.side[side] = wedge_in_frame(p, side);
    }
    p->near_in_frame = along_in_frame(p, p->near);
    p->parted = false;
    find_farthest(p, parts_of_rays(f));
    return true;
}

/* ---- boxes ----------------------------------------------------------------------------------- */

/* The lanes in which the box surely lies outside of the wedge. */
static inline vmask box_outside(const struct wedge *w, const struct wide_node *node, int x, int k,
                                int i)
{
    double low = w->slope[0], high = w->slope[1];
    vreal most = v_bound(v_all(-low), v_load_floats(node->plane[low < 0][k] + i),
                         v_load_floats(node->plane[1][x] + i));
    vreal least = v_bound(v_all(-high), v_load_floats(node->plane[high > 0][k] + i),
                          v_load_floats(node->plane[0][x] + i));
    return v_less(most, v_all(w->bound[0])) | v_less(v_all(w->bound[1]), least);
}

/* The children that the pyramid may touch, and how far along k they begin. */
static inline unsigned touched_children(const struct packet *p, const struct wide_node *node,
                                        float *enter)
{
    unsigned touched = 0;
    for (int i = 0; i < WIDE; i += LANES) {
        int k = p->axis[2];
        vreal lo = v_load_floats(node->plane[0][k] + i), hi = v_load_floats(node->plane[1][k] + i);
        vreal begin = p->down ? -hi : lo, end = p->down ? -lo : hi;
        vmask outside = box_outside(&p->in_frame.side[0], node, p->axis[0], k, i) |
                        box_outside(&p->in_frame.side[1], node, p->axis[1], k, i) |
                        v_less(v_all(p->in_frame.far), begin) |
                        v_less(end, v_all(p->near_in_frame));
        v_store_floats(enter + i, begin);
        touched |= v_bits(v_not(outside)) << i;
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

static void find_aspects(const struct packet *p, const struct triangle_block *block,
                         struct aspects *seen)
{
    for (int i = 0; i < WIDE; i += FLOATS) {
        vfloat way[3], least = f_all(INFINITY), most = f_all(-INFINITY);
        for (int v = 0; v < 3; v++)
            way[v] = f_difference(block->corner[v][p->axis[2]] + i, p->apex[2]);
        for (int v = 0; v < 3; v++) {
            least = f_min(way[v], least);
            most = f_max(way[v], most);
        }
        f_store(seen->way + i, p->ahead ? least : -most);
        for (int side = 0; side < 2; side++) {
            least = f_all(INFINITY), most = f_all(-INFINITY);
            for (int v = 0; v < 3; v++) {
                const double *x = block->corner[v][p->axis[side]] + i;
                vfloat slope = f_difference(x, p->apex[side]) / way[v];
                least = f_min(slope, least);
                most = f_max(slope, most);
            }
            f_store(seen->least[side] + i, least);
            f_store(seen->most[side] + i, most);
        }
    }
}

/* The parts (bit j: part j) that a triangle overlaps. */
static inline unsigned overlapped_parts(const struct packet *p, const struct aspects *seen, int i)
{
    const struct aspects *parts = &p->aspects;
    unsigned overlapped = 0;
    if (seen->way[i] <= (float)(NEAR_APEX * p->padding))
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

/* Returns the parts that met something. */
static unsigned meet_seen_block(struct packet *p, const struct triangle_block *block,
                                unsigned count)
{
    struct aspects seen;
    unsigned met = 0;
    if (!p->parted)
        make_aspects(p);
    find_aspects(p, block, &seen);
    for (unsigned i = 0; i < count; i++) {
        unsigned parts = overlapped_parts(p, &seen, (int)i) & parts_of_rays(p->frames);
        if (parts)
            met |= meet_triangle(p->frames, block->target[i], parts);
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
            make_parts(p);
        for (unsigned j = 0; PART * j < p->frames->n; j++) {
            unsigned of_part = touched_triangles(&p->part[j], &c) << i;
            touched |= of_part;
            for (; of_part; of_part &= of_part - 1)
                parts_of[__builtin_ctz(of_part)] |= 1u << j;
        }
    }
    for (touched &= (1u << count) - 1; touched; touched &= touched - 1) {
        int i = __builtin_ctz(touched);
        met |= meet_triangle(p->frames, block->target[i], parts_of[i]);
    }
    return met;
}

/* A run may hold instances, which take rays one by one. */
static void meet_run(struct packet *p, struct wide_child run)
{
    struct frame_batch *f = p->frames;
    for (uint32_t k = run.first; k < run.first + run.count; k++) {
        struct target target = p->accel->targets[k];
        if (target.kind != PRIM_INSTANCE) {
            meet(f, target);
            continue;
        }
        for (uint32_t i = 0; i < f->rays->n; i++) {
            struct ray ray = ray_get(f->rays, i);
            struct ray_frame frame = ray_frame_of(&ray);
            struct hit hit = hit_get(f->hits, i);
            accel_try_run(p->accel, k, 1, &ray, &frame, p->any, &hit);
            hit_put(f->hits, i, &hit);
        }
    }
}

/* ---- the tree -------------------------------------------------------------------------------- */

/* Rays to a light that meet more leaves together have little in common and are better off alone. */
enum { LEAVES_LIMIT = 48 };

/* False when it is given up. */
static bool walk_packet(struct packet *p)
{
    const struct wide *wide = p->accel->wide;
    int leaves = 0;
    struct wide_pending stack[WIDE_STACK], *top = stack;
    alignas(32) float enter[WIDE];
    *top++ = (struct wide_pending){&WIDE_ROOT, -INFINITY};
    while (top > stack) {
        top--;
        struct wide_child at = *top->child;
        if (top->enter > p->in_frame.far)
            continue;
        if (at.kind == WIDE_NODE) {
            const struct wide_node *node = &wide->nodes[at.first];
            top = push_sorted(top, node, touched_children(p, node, enter), enter);
        } else if (at.kind == WIDE_TRIANGLES) {
            const struct triangle_block *block = &wide->blocks[at.first];
            if (p->any && ++leaves > LEAVES_LIMIT)
                return false;
            unsigned met =
                p->has_apex ? meet_seen_block(p, block, at.count) : meet_block(p, block, at.count);
            if (met)
                find_farthest(p, met);
        } else if (at.count > 0) {
            meet_run(p, at);
            find_farthest(p, parts_of_rays(p->frames));
        }
    }
    return true;
}

static bool packet_in_wide(const struct accel *a, const struct ray_batch *rays, bool any,
                           struct hit_batch *hits)
{
    const struct geometry *g = a->geometry;
    struct frame_batch frames;
    struct packet p;
    p.accel = a;
    p.frames = &frames;
    p.any = any;
    frames_init(&frames, g, rays, g->spheres.n > 0, true, hits);
    return packet_init(&p) && walk_packet(&p);
}

const struct wide_kernels WIDE_KERNELS = {closest_in_wide, any_in_wide, packet_in_wide};
