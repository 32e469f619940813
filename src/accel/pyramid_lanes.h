/* What holds a batch of rays together, made ready for packet_lanes.h.
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
 * outermost rays.  They are floats, outside of the rays', which rays without an end need, so that
 * boxes of floats can be tested by floats.  Everything is widened by `padding`: that of the boxes,
 * which holds the rounding errors of hits, and as much again for those of the planes: some 2^-50 of
 * the coordinates involved, where the padding is 2^-42 of them. */
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
}

static void make_parts(struct packet *p)
{
    for (uint32_t j = 0; PART * j < p->frames->n; j++)
        for (int side = 0; side < 2; side++)
            p->part[j].side[side] = wedge_around(p, side, PART * j, PART * j + PART);
}

/* What leaves need. */
static void make_all_parts(struct packet *p)
{
    if (p->has_apex)
        make_aspects(p);
    else
        make_parts(p);
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
