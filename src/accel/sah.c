#include "config.h"

#include "accel/sah.h"

#include "base/mem.h"
#include "base/thread.h"

#include <float.h>
#include <stdlib.h>

enum {
    BINS = 16,
    FEW_BINS = 8, /* for fewer than BINS primitives */
    ANY_LEAF = 4, /* no more primitives of any kind stay together */
    DEPTH = 60,   /* deeper down runs are halved: at most 30 levels more */
};

/* Cost of visiting a node over that of testing a primitive. */
#define NODE_COST 1.0f

static struct sah_box nothing(void)
{
    return (struct sah_box){four_all(INFINITY), four_all(-INFINITY)};
}

static struct sah_box joined(struct sah_box a, struct sah_box b)
{
    return (struct sah_box){four_min(a.lo, b.lo), four_max(a.hi, b.hi)};
}

static struct sah_box box_of(const struct sah_ref *r)
{
    return (struct sah_box){r->lo.planes, r->hi.planes};
}

/* Twice the center, as a box to join. */
static struct sah_box center_of(const struct sah_ref *r)
{
    vfour sum = r->lo.planes + r->hi.planes;
    return (struct sah_box){sum, sum};
}

/* ---- the primitives' boxes --------------------------------------------------------------------
 */

enum { AT_ONCE = 8192 }; /* primitives */

/* What threads find out of some of the primitives each. */
struct share {
    struct box bounds;
    struct vec3 middle; /* sum of the boxes' centers, each over the number of all */
    struct sah_box box, centers;
};

struct sharing {
    struct sah *sah;
    const struct geometry *geometry;
    const struct target *targets;
    struct share *shares;
};

static void find_bounds(void *context, size_t item, unsigned worker)
{
    struct sharing *w = context;
    struct share *share = &w->shares[item];
    double part = 1.0 / w->sah->n;
    (void)worker;
    *share = (struct share){.bounds = box_empty()};
    for (size_t i = item * AT_ONCE; i < w->sah->n && i < (item + 1) * AT_ONCE; i++) {
        struct box b = geometry_prim_bounds(w->geometry, w->targets[i].prim);
        share->bounds = box_join(share->bounds, b);
        share->middle = vec3_mad(share->middle, part, box_center(b));
    }
}

/* Floats below and above x, which is no larger than 1 or so. */
static float rounded_down(double x)
{
    float f = (float)x;
    if (f > FLT_MAX)
        return FLT_MAX;
    return f - (fabsf(f) * 0x1p-23f + FLT_MIN);
}

static float rounded_up(double x)
{
    return -rounded_down(-x);
}

static inline void set_box(struct sah_ref *r, struct box box)
{
    for (int axis = 0; axis < 3; axis++) {
        r->lo.axis[axis] = rounded_down(vec3_at(box.lo, axis));
        r->hi.axis[axis] = rounded_up(vec3_at(box.hi, axis));
    }
}

void sah_set_box(struct sah_ref *r, struct box box)
{
    set_box(r, box);
}

static void find_boxes(void *context, size_t item, unsigned worker)
{
    struct sharing *w = context;
    struct share *share = &w->shares[item];
    const struct tree_frame *f = &w->sah->frame;
    (void)worker;
    share->box = share->centers = nothing();
    for (size_t i = item * AT_ONCE; i < w->sah->n && i < (item + 1) * AT_ONCE; i++) {
        struct box b = geometry_prim_bounds(w->geometry, w->targets[i].prim);
        struct sah_ref *r = &w->sah->refs[i];
        set_box(r, (struct box){tree_frame_point(f, b.lo), tree_frame_point(f, b.hi)});
        r->lo.tag = w->targets[i].prim + SAH_TAG;
        r->hi.tag = (w->targets[i].kind != PRIM_TRIANGLE) + SAH_TAG;
        share->box = joined(share->box, box_of(r));
        share->centers = joined(share->centers, center_of(r));
    }
}

/* Around what most primitives are near to: floats are finest there. */
static struct tree_frame frame_of(struct box bounds, struct vec3 middle)
{
    struct tree_frame f = {{0, 0, 0}, 1};
    double largest = fmax(vec3_largest(bounds.lo), vec3_largest(bounds.hi)), extent = 0;
    int exponent = 0;
    for (int axis = 0; axis < 3; axis++) {
        f.center[axis] = largest < 0x1p1000 ? vec3_at(middle, axis) : 0;
        extent = fmax(extent, vec3_at(bounds.hi, axis) - f.center[axis]);
        extent = fmax(extent, f.center[axis] - vec3_at(bounds.lo, axis));
    }
    frexp(extent, &exponent);
    f.scale = ldexp(1, exponent > -1000 ? -exponent : 1000);
    return f;
}

struct sah_run sah_init(struct sah *s, const struct geometry *g, const struct target *targets,
                        uint32_t n, uint32_t leaf, unsigned threads)
{
    size_t items = (n + AT_ONCE - 1) / AT_ONCE;
    struct share *shares = mem_alloc_aligned(items + 1, sizeof *shares);
    struct sharing sharing = {s, g, targets, shares};
    *s = (struct sah){.n = n, .bounds = box_empty(), .leaf = leaf};
    s->blocks = leaf > 1 && g->triangles.n >= n - n / 8;
    s->refs = mem_alloc(n, sizeof *s->refs);
    thread_share(items, threads, find_bounds, &sharing);
    struct vec3 middle = vec3_all(0);
    for (size_t i = 0; i < items; i++) {
        s->bounds = box_join(s->bounds, shares[i].bounds);
        middle = vec3_add(middle, shares[i].middle);
    }
    s->frame = frame_of(s->bounds, middle);
    thread_share(items, threads, find_boxes, &sharing);
    struct sah_run all = {0, n, 0, nothing(), nothing()};
    for (size_t i = 0; i < items; i++) {
        all.box = joined(all.box, shares[i].box);
        all.centers = joined(all.centers, shares[i].centers);
    }
    free(shares);
    return all;
}

void sah_free(struct sah *s)
{
    free(s->refs);
    *s = (struct sah){0};
}

/* ---- cutting ----------------------------------------------------------------------------------
 */

struct bin {
    struct sah_box box;
    uint32_t n;
};

struct binning {
    int n;
    vfour first, scale; /* bin = (doubled center - first) scale */
    struct bin bins[3][BINS];
};

/* Before bin `bin` of the axis. */
struct cut {
    float cost; /* of both sides: area times primitives */
    int axis, bin;
};

/* A run whose centers differ too little to be told apart gets a scale of 0 on that axis. */
static void binning_init(struct binning *b, const struct sah_run *run)
{
    vfour extent = run->centers.hi - run->centers.lo;
    b->n = run->end - run->begin < BINS ? FEW_BINS : BINS;
    b->first = run->centers.lo;
    for (int axis = 0; axis < 3; axis++)
        b->scale[axis] = extent[axis] > 0x1p-100f ? (float)b->n * (1 - 0x1p-20f) / extent[axis] : 0;
    b->scale[3] = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < b->n; i++)
            b->bins[axis][i] = (struct bin){nothing(), 0};
}

static inline vfour_int bins_of(const struct binning *b, const struct sah_ref *r)
{
    vfour at = (r->lo.planes + r->hi.planes - b->first) * b->scale;
    at = four_min(four_max(at, four_all(0)), four_all((float)(b->n - 1)));
    return __builtin_convertvector(at, vfour_int);
}

static void fill_bins(const struct sah *s, struct binning *b, const struct sah_run *run)
{
    for (uint32_t i = run->begin; i < run->end; i++) {
        vfour_int at = bins_of(b, &s->refs[i]);
        struct sah_box box = box_of(&s->refs[i]);
        for (int axis = 0; axis < 3; axis++) {
            struct bin *bin = &b->bins[axis][at[axis]];
            bin->box = joined(bin->box, box);
            bin->n++;
        }
    }
}

static inline float cost_of(const struct sah *s, const struct sah_box *box, uint32_t n)
{
    return sah_area(box) * (float)(s->blocks ? (n + s->leaf - 1) / s->leaf : n);
}

/* Sweeps one axis from both ends. */
static void cut_axis(const struct sah *s, const struct binning *b, int axis, struct cut *best)
{
    const struct bin *bins = b->bins[axis];
    float above[BINS];
    struct sah_box box = nothing();
    uint32_t n = 0;
    for (int i = b->n - 1; i > 0; i--) {
        box = joined(box, bins[i].box);
        n += bins[i].n;
        above[i] = n ? cost_of(s, &box, n) : INFINITY;
    }
    box = nothing();
    n = 0;
    for (int i = 1; i < b->n; i++) {
        box = joined(box, bins[i - 1].box);
        n += bins[i - 1].n;
        float cost = n ? cost_of(s, &box, n) + above[i] : INFINITY;
        if (cost < best->cost)
            *best = (struct cut){cost, axis, i};
    }
}

static void take(struct sah_run *run, const struct sah_ref *r)
{
    run->box = joined(run->box, box_of(r));
    run->centers = joined(run->centers, center_of(r));
}

void sah_take(struct sah_run *run, const struct sah_ref *r)
{
    take(run, r);
}

static void halve(struct sah *s, struct sah_run halves[2])
{
    for (int k = 0; k < 2; k++)
        for (uint32_t i = halves[k].begin; i < halves[k].end; i++)
            take(&halves[k], &s->refs[i]);
}

static void partition(struct sah *s, const struct binning *b, struct cut cut,
                      struct sah_run halves[2])
{
    uint32_t begin = halves[0].begin, end = halves[1].end;
    while (begin < end) {
        struct sah_ref *r = &s->refs[begin];
        int above = bins_of(b, r)[cut.axis] >= cut.bin;
        take(&halves[above], r);
        if (above) {
            struct sah_ref other = s->refs[--end];
            s->refs[end] = *r;
            *r = other;
        } else {
            begin++;
        }
    }
    halves[0].end = halves[1].begin = begin;
}

bool sah_all_triangles(const struct sah *s, const struct sah_run *run)
{
    uint32_t others = 0;
    for (uint32_t i = run->begin; i < run->end; i++)
        others |= s->refs[i].hi.tag ^ SAH_TAG;
    return others == 0;
}

bool sah_split(struct sah *s, const struct sah_run *run, struct sah_run halves[2])
{
    uint32_t n = run->end - run->begin, middle = run->begin + n / 2;
    struct binning binning;
    struct cut best = {INFINITY, 0, 0};
    if (n <= 1 || (n <= s->leaf && sah_all_triangles(s, run)) ||
        (run->depth >= DEPTH && n <= ANY_LEAF))
        return false;
    halves[0] = (struct sah_run){run->begin, middle, run->depth + 1, nothing(), nothing()};
    halves[1] = (struct sah_run){middle, run->end, run->depth + 1, nothing(), nothing()};
    if (run->depth < DEPTH) {
        binning_init(&binning, run);
        fill_bins(s, &binning, run);
        for (int axis = 0; axis < 3; axis++)
            cut_axis(s, &binning, axis, &best);
        float area = sah_area(&run->box);
        if (n <= ANY_LEAF && !(best.cost + NODE_COST * area < (float)n * area))
            return false;
    }
    if (best.cost < INFINITY)
        partition(s, &binning, best, halves);
    else
        halve(s, halves);
    return true;
}
