/* As many samples as each pixel needs.
 *
 * First the corners and middles of all pixels are sampled, and kept; then every pixel whose
 * estimated error, or that of its neighbours, is too large is cut into cells (see cubature.h). What
 * becomes of a pixel depends on the first samples within a row of pixels around it and on its own
 * others, so neither tiles nor threads nor crops matter. */
#include "config.h"

#include "render/adaptive.h"

#include "base/thread.h"
#include "render/frame.h"

/* ---- rays and time --------------------------------------------------------------------------- */

bool frame_late(const struct frame *f, unsigned worker)
{
    return f->deadline < INFINITY && thread_seconds() + f->longest[worker] > f->deadline;
}

void frame_report(struct frame *f, unsigned worker)
{
    const struct render_progress *p = &f->tracer->options->progress;
    size_t done = atomic_fetch_add_explicit(&f->done, 1, memory_order_relaxed) + 1;
    if (worker != 0 || !p->report)
        return;
    if (f->deadline < INFINITY)
        p->report(p->context, (thread_seconds() - f->started) / (f->deadline - f->started));
    else
        p->report(p->context, (double)done / f->work);
}

void frame_trace(struct frame *f, unsigned worker, double *x, double *y, uint32_t n)
{
    const struct render_options *o = f->tracer->options;
    const struct camera *camera = &f->tracer->scene->camera;
    struct worker *w = f->workers[worker];
    double before = f->deadline < INFINITY ? thread_seconds() : 0;
    for (uint32_t i = 0; i < n; i++) {
        x[i] = camera_place(camera, f->x0 + x[i], o->width);
        y[i] = camera_place(camera, o->height - (f->y0 + y[i]), o->height);
    }
    w->stats.primary += n;
    trace_batch(w, 0, rays_through(w, x, y, n), NULL, &w->colours);
    if (f->deadline < INFINITY)
        f->longest[worker] = fmax(f->longest[worker], thread_seconds() - before);
}

/* Seconds that one thread takes for a pixel of the picture that the first samples give. */
#define PICTURE_S 180e-9

/* ---- the whole picture ----------------------------------------------------------------------- */

/* The crop and a row of pixels around it, as far as there are any. */
static void place_halo(struct frame *f)
{
    const struct render_options *o = f->tracer->options;
    uint32_t x1 = o->crop.x1 + (o->crop.x1 < o->width), y1 = o->crop.y1 + (o->crop.y1 < o->height);
    f->x0 = o->crop.x0 - (o->crop.x0 > 0);
    f->y0 = o->crop.y0 - (o->crop.y0 > 0);
    f->width = x1 - f->x0;
    f->height = y1 - f->y0;
    f->crop = (struct tile){o->crop.x0 - f->x0, o->crop.y0 - f->y0, o->crop.x1 - f->x0,
                            o->crop.y1 - f->y0};
    f->tiling = tiling_of(f->crop.x0, f->crop.y0, f->crop.x1, f->crop.y1);
}

static struct frame *frame_new(const struct tracer *t, struct worker **workers, struct picture *out)
{
    const struct render_options *o = t->options;
    struct frame *f = mem_zalloc(1, sizeof *f);
    *f = (struct frame){.tracer = t, .workers = workers, .out = out};
    f->encoding = render_encoding(t->scene, SHOW_PICTURE);
    place_halo(f);
    size_t pixels = (size_t)f->width * f->height;
    f->middle = mem_zalloc(pixels, sizeof *f->middle);
    f->corner = mem_zalloc(((size_t)f->width + 1) * ((size_t)f->height + 1), sizeof *f->corner);
    f->first_error = mem_alloc(pixels, sizeof *f->first_error);
    f->error = mem_alloc(pixels, sizeof *f->error);
    f->refined = mem_zalloc(pixels, sizeof *f->refined);
    for (size_t i = 0; i < pixels; i++)
        f->error[i] = INFINITY;
    f->tallies = mem_zalloc(f->tiling.n, sizeof *f->tallies);
    f->order = mem_alloc(f->tiling.n, sizeof *f->order);
    for (size_t i = 0; i < f->tiling.n; i++)
        f->order[i] = i;
    f->refiners = mem_zalloc(o->threads, sizeof(struct refiner *));
    f->longest = mem_zalloc(o->threads, sizeof *f->longest);
    f->started = thread_seconds();
    f->deadline =
        o->deadline > 0 ? o->deadline - PICTURE_S * (double)pixels / o->threads : INFINITY;
    f->work = (double)f->tiling.n * 3;
    return f;
}

static void frame_free(struct frame *f)
{
    for (unsigned i = 0; i < f->tracer->options->threads; i++)
        refiner_free(f->refiners[i]);
    free(f->refiners);
    free(f->longest);
    free(f->order);
    free(f->tallies);
    free(f->refined);
    free(f->error);
    free(f->first_error);
    free(f->corner);
    free(f->middle);
    free(f);
}

static void refine_tiles(struct frame *f, double target, size_t tiles)
{
    f->target = target;
    thread_share(tiles, f->tracer->options->threads, refine_tile, f);
}

/* ---- in a limited time ----------------------------------------------------------------------- */

/* How much there is to gain by a tile; more than of any known where not all of it is known. */
struct rank {
    size_t tile;
    double gain;
};

static int compare_ranks(const void *a, const void *b)
{
    const struct rank *p = a, *q = b;
    if (p->gain != q->gain)
        return p->gain < q->gain ? 1 : -1;
    return p->tile < q->tile ? -1 : p->tile > q->tile;
}

/* Orders the tiles that have errors above the target, the worst first; returns their number. */
static size_t order_tiles(struct frame *f, double target)
{
    struct rank *ranks = mem_alloc(f->tiling.n, sizeof *ranks);
    size_t n = 0;
    for (size_t i = 0; i < f->tiling.n; i++) {
        const struct tally *t = &f->tallies[i];
        if (t->unknown > 0 || t->doubt > target)
            ranks[n++] = (struct rank){i, t->unknown > 0 ? INFINITY : t->squares};
    }
    qsort(ranks, n, sizeof *ranks, compare_ranks);
    for (size_t i = 0; i < n; i++)
        f->order[i] = ranks[i].tile;
    free(ranks);
    return n;
}

/* Ever more of the picture, until the time is over: a pixel of each block, all of them, their
 * corners, and then lower and lower errors, so that what is unfinished lies about evenly.  What is
 * done over again at each step costs less than the step itself. */
static void render_until(struct frame *f)
{
    enum { COARSEST = 64, STEP = 4 };
    double wanted = f->tracer->options->adaptive;
    for (uint32_t stride = COARSEST; stride > 0; stride /= 2)
        first_middles(f, stride, stride < COARSEST);
    first_corners(f);
    first_errors(f);
    refine_tiles(f, INFINITY, f->tiling.n);
    for (double target = 1.0 / STEP;; target = fmax(target / STEP, wanted)) {
        refine_tiles(f, target, order_tiles(f, target));
        if (target <= wanted || frame_late(f, 0))
            break;
    }
}

static struct adaptive_stats frame_stats(const struct frame *f)
{
    struct adaptive_stats stats = {0};
    double squares = 0, known = (double)f->out->width * f->out->height;
    for (size_t i = 0; i < f->tiling.n; i++) {
        const struct tally *t = &f->tallies[i];
        squares += t->squares;
        known -= t->unknown;
        stats.unfinished += t->unknown;
        stats.worst = fmax(stats.worst, t->worst);
        stats.most = t->most > stats.most ? t->most : stats.most;
    }
    stats.error = known > 0 ? sqrt(squares / known) : 1;
    return stats;
}

struct adaptive_stats render_adaptive(const struct tracer *t, struct worker **workers,
                                      struct picture *out)
{
    struct frame *f = frame_new(t, workers, out);
    if (f->deadline < INFINITY) {
        render_until(f);
    } else {
        first_middles(f, 1, false);
        first_corners(f);
        first_errors(f);
        refine_tiles(f, t->options->adaptive, f->tiling.n);
    }
    struct adaptive_stats stats = frame_stats(f);
    frame_free(f);
    return stats;
}
