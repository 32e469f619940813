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

/* Of all parts together. */
struct outline {
    float least[2], most[2], way;
};

/* A wedge of the whole packet in the frame of the tree's boxes. */
struct frame_wedge {
    float slope[2], bound[2];
};

struct packet {
    const struct accel *accel;
    struct frame_batch *frames;
    int axis[3];   /* x, y, k */
    bool down;     /* the rays run down k; distances along it are then counted negatively */
    bool converge; /* towards a common end, not from a common origin */
    bool converge_at_apex;
    bool endless;
    double longest;        /* t_max */
    bool any;              /* a ray ends at the first hit found */
    bool parted;           /* `part` or `aspects` are made: once a leaf is reached */
    bool has_apex;         /* all rays start there, or would end there at t = 1 */
    bool ahead;            /* k grows on the way from the apex */
    double apex[3];        /* along x, y and k */
    struct range start[3]; /* of the origins, along x, y and k */
    double padding, near;
    struct pyramid whole, part[PARTS];
    struct aspects aspects; /* of the parts, where there is an apex */
    struct outline outline; /* of all of them */
    struct frame_wedge in_frame[2];
    float near_in_frame, far_in_frame;
    const double *slope[2]; /* x and y over k */
    alignas(64) double own_slope[2][BATCH_ROOM];
    alignas(64) double end[3][BATCH_ROOM]; /* unless endless */
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

static void bound_apex(const struct packet *p, int side, struct wedge *w)
{
    double low = p->apex[side] - w->slope[0] * p->apex[2];
    double high = p->apex[side] - w->slope[1] * p->apex[2];
    w->bound[0] = low < w->bound[0] ? low : w->bound[0];
    w->bound[1] = high > w->bound[1] ? high : w->bound[1];
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
    double low = v_least(least), high = v_most(most);
    struct wedge w = {{float_below(low), float_above(high)}, {INFINITY, -INFINITY}};
    if (p->down != p->converge)
        w = (struct wedge){{w.slope[1], w.slope[0]}, {INFINITY, -INFINITY}};
    if (p->frames->rays->common_origin)
        w = (struct wedge){{w.slope[0], w.slope[1]},
                           {x[0] - w.slope[0] * k[0], x[0] - w.slope[1] * k[0]}};
    else
        bound_points(p, x, k, first, end, &w);
    if (p->converge_at_apex)
        bound_apex(p, side, &w);
    else if (!p->endless)
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

/* Slopes are floats already. */
static struct frame_wedge wedge_in_frame(const struct packet *p, int side)
{
    const struct tree_frame *f = &p->accel->wide->frame;
    const struct wedge *w = &p->whole.side[side];
    double x = f->center[p->axis[side]], k = f->center[p->axis[2]], bound[2];
    for (int i = 0; i < 2; i++)
        bound[i] = (w->bound[i] - (x - w->slope[i] * k)) * f->scale;
    return (struct frame_wedge){{(float)w->slope[0], (float)w->slope[1]},
                                {float_below(bound[0] - F_BOUND_ERROR * fabs(w->slope[0])),
                                 float_above(bound[1] + F_BOUND_ERROR * fabs(w->slope[1]))}};
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
    p->outline.way = -INFINITY;
    for (uint32_t j = 0; PART * j < p->frames->n && p->has_apex; j++)
        p->outline.way = p->aspects.way[j] > p->outline.way ? p->aspects.way[j] : p->outline.way;
    double far = along_in_frame(p, p->whole.far);
    p->far_in_frame = far == -INFINITY ? -INFINITY : float_above(far);
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
    for (int side = 0; side < 2; side++) {
        p->outline.least[side] = f_least(p->aspects.least[side]);
        p->outline.most[side] = f_most(p->aspects.most[side]);
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

/* Where the rays start. */
static void find_starts(struct packet *p)
{
    const struct ray_batch *rays = p->frames->rays;
    double reach = 0;
    for (int side = 0; side < 3; side++) {
        const double *o = along(&rays->origin, p->axis[side]);
        struct range r = {o[0], o[0]};
        if (!rays->common_origin)
            r = range_of(p, o);
        reach = fmax(reach, fmax(fabs(r.lo), fabs(r.hi)));
        p->start[side] = r;
    }
    p->longest = range_of(p, rays->t_max).hi;
    p->endless = !(p->longest <= 0x1p60);
    p->padding = 2 * p->accel->padding * (p->accel->reach + reach);
    p->near = (p->down ? -p->start[2].hi : p->start[2].lo) - p->padding;
}

/* Whether all rays start, or would end, at one point. */
static void find_apex(struct packet *p)
{
    const struct ray_batch *rays = p->frames->rays;
    p->has_apex = rays->common_origin || p->longest <= 1;
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
    p->converge_at_apex = p->has_apex && !rays->common_origin;
    p->converge = p->converge_at_apex;
}

/* Where the rays end. */
static void find_ends(struct packet *p)
{
    const struct ray_batch *rays = p->frames->rays;
    double wider = 0;
    for (int side = 0; side < 3; side++) {
        const double *o = along(&rays->origin, p->axis[side]);
        const double *d = along(&rays->direction, p->axis[side]);
        struct range start = p->start[side];
        for (uint32_t i = 0; i < p->frames->n; i += LANES)
            v_store(p->end[side] + i, v_load(o + i) + v_load(rays->t_max + i) * v_load(d + i));
        struct range end = range_of(p, p->end[side]);
        wider += side < 2 ? (start.hi - start.lo) - (end.hi - end.lo) : 0;
    }
    p->converge = wider > 0;
}

static void find_slopes(struct packet *p)
{
    const struct frame_batch *f = p->frames;
    const struct vec3_batch *d = &f->rays->direction;
    const double *x = along(d, p->axis[0]), *y = along(d, p->axis[1]), *k = along(d, p->axis[2]);
    p->slope[0] = f->shear_x;
    p->slope[1] = f->shear_y;
    if (f->axis == p->axis[2])
        return;
    for (uint32_t i = 0; i < f->n; i += LANES) {
        vreal inverse = 1 / v_load(k + i);
        v_store(p->own_slope[0] + i, v_load(x + i) * inverse);
        v_store(p->own_slope[1] + i, v_load(y + i) * inverse);
    }
    p->slope[0] = p->own_slope[0];
    p->slope[1] = p->own_slope[1];
}

/* Rays that spread more than this, in units of the way along k, are better off alone. */
#define WIDEST_WEDGE 2.5

static bool packet_init(struct packet *p)
{
    const struct frame_batch *f = p->frames;
    if (!find_axis(p))
        return false;
    find_starts(p);
    find_apex(p);
    if (!p->endless && !p->converge_at_apex)
        find_ends(p);
    find_slopes(p);
    for (int side = 0; side < 2; side++) {
        struct wedge *w = &p->whole.side[side];
        *w = wedge_around(p, side, 0, f->n);
        if (!(fabs(w->slope[1] - w->slope[0]) <= WIDEST_WEDGE))
            return false;
        p->in_frame[side] = wedge_in_frame(p, side);
        if (!(fabsf(p->in_frame[side].bound[1] - p->in_frame[side].bound[0]) <= FLT_MAX))
            return false;
    }
    p->near_in_frame = float_below(along_in_frame(p, p->near));
    p->parted = false;
    find_farthest(p, parts_of_rays(f));
    return true;
}

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
        make_aspects(p);
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
        met |= meet_in_block(p, block, i, parts_of[i]);
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
            meet_run(p, at);
            met = parts_of_rays(p->frames);
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
