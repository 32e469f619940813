/* The first samples of all pixels: corners and middles. */
#include "config.h"

#include "base/thread.h"
#include "render/frame.h"

/* Corners or middles, of which every stride-th is taken. */
struct points {
    struct frame *frame;
    struct colour *at;
    struct tile area;
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
    if ((p->may_stop && frame_late(f, worker)) || frame_given_up(f) || f->workers[worker]->given_up)
        return;
    for (uint32_t row = tile.y0; row < tile.y1; row++) {
        for (uint32_t column = tile.x0; column < tile.x1; column++) {
            uint32_t i = p->area.x0 + column * p->stride, j = p->area.y0 + row * p->stride;
            to[n] = &p->at[(size_t)j * p->width + i];
            x[n] = i + p->offset;
            y[n] = j + p->offset;
            n += to[n]->wanted && !to[n]->seen ? 1 : 0;
        }
    }
    if (n == 0)
        return;
    frame_trace(f, worker, x, y, n);
    if (f->workers[worker]->given_up)
        return;
    for (uint32_t k = 0; k < n; k++) {
        struct vec3 c = vec3_get(&f->workers[worker]->colours, k);
        *to[k] = (struct colour){(float)c.x, (float)c.y, (float)c.z, true, true};
    }
    frame_report(f, worker);
}

static void sample_all(struct points *p)
{
    const struct tile *a = &p->area;
    p->tiling = tiling_of(0, 0, (a->x1 - a->x0 + p->stride - 1) / p->stride,
                          (a->y1 - a->y0 + p->stride - 1) / p->stride);
    thread_share(p->tiling.n, p->frame->tracer->options->threads, sample_points, p);
}

void first_middles(struct frame *f, uint32_t stride, bool may_stop)
{
    struct points p = {f, f->middle, f->area, f->width, stride, 0.5, may_stop, {{0}, 0, 0}};
    sample_all(&p);
}

void first_corners(struct frame *f)
{
    const struct tile *a = &f->area;
    struct tile corners = {a->x0, a->y0, a->x1 + 1, a->y1 + 1};
    struct points p = {f, f->corner, corners, f->width + 1, 1, 0, true, {{0}, 0, 0}};
    sample_all(&p);
}

static struct vec3 vec3_of(const struct colour *c)
{
    return vec3(c->r, c->g, c->b);
}

struct vec3 first_nearby(const struct frame *f, uint32_t x, uint32_t y)
{
    const struct colour *c = f->middle + frame_pixel(f, x, y);
    for (uint32_t stride = 2; !c->seen && stride <= COARSEST; stride *= 2)
        c = f->middle + frame_pixel(f, x & ~(stride - 1), y & ~(stride - 1));
    return c->seen ? vec3_of(c) : vec3_all(0);
}

bool first_of_pixel(const struct frame *f, uint32_t x, uint32_t y, struct first *first)
{
    const struct colour *upper = f->corner + (size_t)y * (f->width + 1) + x;
    const struct colour *lower = upper + f->width + 1;
    const struct colour *middle = f->middle + frame_pixel(f, x, y);
    const struct colour *sample[CUBATURE_FIRST] = {lower, lower + 1, upper, upper + 1, middle};
    for (int i = CUBATURE_FIRST - 1; i >= 0; i--) {
        if (!sample[i]->seen)
            return false;
        first->sample[i] = vec3_of(sample[i]);
    }
    return true;
}

struct estimate first_estimate(const struct frame *f, const struct first *first)
{
    return cubature_estimate(first->sample, CUBATURE_FIRST, f->tracer->options->jitter);
}

static void judge_row(void *context, size_t row, unsigned worker)
{
    struct frame *f = context;
    uint32_t y = f->area.y0 + (uint32_t)row;
    (void)worker;
    for (uint32_t x = f->area.x0; x < f->area.x1; x++) {
        struct first first;
        double error = INFINITY;
        if (!f->middle[frame_pixel(f, x, y)].wanted)
            continue;
        if (first_of_pixel(f, x, y, &first)) {
            struct estimate e = first_estimate(f, &first);
            error = stored_error(f, &e);
        }
        f->first_error[frame_pixel(f, x, y)] = (float)error;
    }
}

void first_errors(struct frame *f)
{
    thread_share(f->area.y1 - f->area.y0, f->tracer->options->threads, judge_row, f);
}
