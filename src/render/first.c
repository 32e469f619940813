/* The first samples of all pixels: corners and middles. */
#include "config.h"

#include "base/thread.h"
#include "render/frame.h"

/* Corners or middles, of which every stride-th is taken. */
struct points {
    struct frame *frame;
    struct colour *at;
    uint32_t width, stride;
    double offset; /* from the pixel's upper left corner */
    bool may_stop;
    struct tiling tiling; /* of those that are taken */
};

static void sample_points(void *context, size_t number, unsigned worker)
{
    const struct points *p = context;
    struct frame *f = p->frame;
    struct tile tile = tiling_at(&p->tiling, number);
    struct colour *to[BATCH];
    double x[BATCH_ROOM], y[BATCH_ROOM];
    uint32_t n = 0;
    if (p->may_stop && frame_late(f, worker))
        return;
    for (uint32_t j = tile.y0 * p->stride; j < tile.y1 * p->stride; j += p->stride) {
        for (uint32_t i = tile.x0 * p->stride; i < tile.x1 * p->stride; i += p->stride) {
            to[n] = &p->at[(size_t)j * p->width + i];
            x[n] = i + p->offset;
            y[n] = j + p->offset;
            n += to[n]->seen ? 0 : 1;
        }
    }
    if (n > 0)
        frame_trace(f, worker, x, y, n);
    for (uint32_t k = 0; k < n; k++) {
        struct vec3 c = vec3_get(&f->workers[worker]->colours, k);
        *to[k] = (struct colour){(float)c.x, (float)c.y, (float)c.z, true};
    }
    frame_report(f, worker);
}

static void sample_all(struct points *p, uint32_t height)
{
    p->tiling = tiling_of(0, 0, (p->width + p->stride - 1) / p->stride,
                          (height + p->stride - 1) / p->stride);
    thread_share(p->tiling.n, p->frame->tracer->options->threads, sample_points, p);
}

void first_middles(struct frame *f, uint32_t stride, bool may_stop)
{
    struct points p = {f, f->middle, f->width, stride, 0.5, may_stop, {{0}, 0, 0}};
    sample_all(&p, f->height);
}

void first_corners(struct frame *f)
{
    struct points p = {f, f->corner, f->width + 1, 1, 0, true, {{0}, 0, 0}};
    sample_all(&p, f->height + 1);
}

static struct vec3 vec3_of(const struct colour *c)
{
    return vec3(c->r, c->g, c->b);
}

/* The middle that stands for one that is not known: that of its block in the finest stride. */
static const struct colour *nearest_middle(const struct frame *f, uint32_t x, uint32_t y)
{
    const struct colour *c = f->middle + frame_pixel(f, x, y);
    for (uint32_t stride = 2; !c->seen; stride *= 2)
        c = f->middle + frame_pixel(f, x & ~(stride - 1), y & ~(stride - 1));
    return c;
}

bool first_of_pixel(const struct frame *f, uint32_t x, uint32_t y, struct first *first)
{
    const struct colour *upper = f->corner + (size_t)y * (f->width + 1) + x;
    const struct colour *lower = upper + f->width + 1;
    const struct colour *corner[4] = {lower, lower + 1, upper, upper + 1};
    const struct colour *middle = f->middle + frame_pixel(f, x, y);
    bool all = middle->seen;
    first->middle = vec3_of(all ? middle : nearest_middle(f, x, y));
    for (int i = 0; i < 4 && all; i++) {
        first->corner[i] = vec3_of(corner[i]);
        all = corner[i]->seen;
    }
    return all;
}

static void judge_row(void *context, size_t row, unsigned worker)
{
    struct frame *f = context;
    bool noisy = f->tracer->options->jitter;
    uint32_t y = (uint32_t)row;
    (void)worker;
    for (uint32_t x = 0; x < f->width; x++) {
        struct first first;
        double error = INFINITY;
        if (first_of_pixel(f, x, y, &first)) {
            struct estimate e = cubature_estimate(first.corner, first.middle, noisy);
            error = stored_error(f, &e);
        }
        f->first_error[frame_pixel(f, x, y)] = (float)error;
    }
}

void first_errors(struct frame *f)
{
    thread_share(f->height, f->tracer->options->threads, judge_row, f);
}
