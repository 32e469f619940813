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
    return f->deadline < INFINITY && (render_stopped(f->tracer->options) ||
                                      thread_seconds() + f->longest[worker] > f->deadline);
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
        p->report(p->context, fmin((double)done / f->work, 1));
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

struct frame *adaptive_new(const struct tracer *t, struct worker **workers, struct picture *out)
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
    f->refiners = mem_zalloc(o->threads, sizeof(struct refiner *));
    f->longest = mem_zalloc(o->threads, sizeof *f->longest);
    f->started = thread_seconds();
    f->deadline =
        o->deadline > 0 ? o->deadline - PICTURE_S * (double)pixels / o->threads : INFINITY;
    f->work = 3 * (double)(o->watch.tiles ? o->watch.tiles : f->tiling.n);
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

/* ---- a part at a time ------------------------------------------------------------------------ */

/* Whether first samples are wanted of the tile's pixels and those around it: what becomes of the
 * tile depends on them. */
static void want_tile(struct frame *f, const struct tile *tile, bool wanted)
{
    struct tile t = {tile->x0 - (tile->x0 > 0), tile->y0 - (tile->y0 > 0),
                     tile->x1 + (tile->x1 < f->width), tile->y1 + (tile->y1 < f->height)};
    for (uint32_t y = t.y0; y < t.y1; y++)
        for (uint32_t x = t.x0; x < t.x1; x++)
            f->middle[frame_pixel(f, x, y)].wanted = wanted;
    for (uint32_t y = t.y0; y <= t.y1; y++)
        for (uint32_t x = t.x0; x <= t.x1; x++)
            f->corner[(size_t)y * (f->width + 1) + x].wanted = wanted;
    struct tile *a = &f->area;
    *a = (struct tile){t.x0 < a->x0 ? t.x0 : a->x0, t.y0 < a->y0 ? t.y0 : a->y0,
                       t.x1 > a->x1 ? t.x1 : a->x1, t.y1 > a->y1 ? t.y1 : a->y1};
}

static void want_tiles(struct frame *f, const size_t *tiles, size_t n, bool wanted)
{
    f->area = (struct tile){f->width, f->height, 0, 0};
    for (size_t i = 0; i < n; i++) {
        struct tile tile = tiling_at(&f->tiling, tiles[i]);
        want_tile(f, &tile, wanted);
    }
}

/* All that becomes of these tiles but what is known already. */
static void render_tiles(struct frame *f, const size_t *tiles, size_t n)
{
    memcpy(f->order, tiles, n * sizeof *tiles);
    want_tiles(f, tiles, n, true);
    first_middles(f, 1, false);
    first_corners(f);
    first_errors(f);
    refine_tiles(f, f->tracer->options->adaptive, n);
    want_tiles(f, tiles, n, false);
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
        if (t->pixels == 0 || t->unknown > 0 || t->doubt > target)
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
    enum { STEP = 4 };
    double wanted = f->tracer->options->adaptive;
    for (uint32_t stride = COARSEST; stride > 0; stride /= 2)
        first_middles(f, stride, stride < COARSEST);
    first_corners(f);
    first_errors(f);
    refine_tiles(f, INFINITY, order_tiles(f, -1));
    for (double target = 1; target > wanted && !frame_late(f, 0);) {
        target = fmax(target / STEP, wanted);
        refine_tiles(f, target, order_tiles(f, target));
    }
}

static struct adaptive_stats frame_stats(const struct frame *f)
{
    struct adaptive_stats stats = {0};
    double squares = 0, known = 0;
    for (size_t i = 0; i < f->tiling.n; i++) {
        const struct tally *t = &f->tallies[i];
        squares += t->squares;
        known += (double)t->pixels - t->unknown;
        stats.unfinished += t->unknown;
        stats.worst = fmax(stats.worst, t->worst);
        stats.most = t->most > stats.most ? t->most : stats.most;
    }
    stats.error = known > 0 ? sqrt(squares / known) : 1;
    return stats;
}

/* Tiles that nobody waits for are rendered all at once; others so many at a time that threads wait
 * little for each other, and that not much is lost when the work ends early. */
void adaptive_tiles(struct frame *f, const size_t *tiles, size_t n)
{
    enum { TILES_A_THREAD = 64 };
    size_t slice = (size_t)TILES_A_THREAD * f->tracer->options->threads;
    size_t *all = NULL;
    if (!tiles) {
        tiles = all = mem_alloc(f->tiling.n, sizeof *all);
        slice = n = f->tiling.n;
        for (size_t i = 0; i < n; i++)
            all[i] = i;
    }
    if (f->deadline < INFINITY) {
        want_tiles(f, tiles, n, true);
        render_until(f);
    } else {
        for (size_t i = 0; i < n; i += slice)
            render_tiles(f, tiles + i, n - i < slice ? n - i : slice);
    }
    free(all);
}

struct adaptive_stats adaptive_end(struct frame *f)
{
    struct adaptive_stats stats = frame_stats(f);
    frame_free(f);
    return stats;
}
