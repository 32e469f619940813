/* As many samples as each pixel needs.
 *
 * First the corners and middles of all pixels are sampled, and kept; then every pixel whose
 * estimated error is too large is cut into cells (see cubature.h).  A pixel asks nothing of its
 * neighbours but the shared corners, so neither tiles nor threads nor crops matter. */
#include "config.h"

#include "base/thread.h"
#include "render/adaptive.h"
#include "render/cubature.h"
#include "render/samples.h"

#include <stdatomic.h>

/* What is kept of the samples that all pixels have. */
struct colour {
    float r, g, b;
};

/* What is found out of one pixel. */
struct finding {
    struct vec3 mean;
    double error; /* the largest channel's standard error, as the picture stores it */
    uint32_t samples;
};

/* What is found out of a tile's pixels. */
struct tally {
    double squares, worst; /* of the pixels' errors: sum of squares, and the largest */
    uint32_t most;         /* samples */
};

/* A pixel under way. */
struct task {
    struct cubature *cells;
    uint32_t pixel; /* of the tile, row by row */
};

/* What a thread works with. */
struct refiner {
    struct worker *w;
    struct cubature *cells[BATCH]; /* made when first needed */
    struct task active[BATCH];
    uint32_t n;
    struct finding found[BATCH];
    /* Samples to be traced together: */
    struct vec3 *to[BATCH];
    double x[BATCH_ROOM], y[BATCH_ROOM];
    uint32_t queued;
};

struct frame {
    const struct tracer *tracer;
    struct worker **workers;
    struct refiner *refiners; /* one a thread */
    struct picture *out;
    enum picture_encoding encoding; /* of light, whatever is shown */
    struct tiling corners, pixels;
    struct colour *corner, *middle; /* by row */
    struct tally *tallies;          /* by tile of pixels */
    atomic_size_t done;
};

static void report_progress(struct frame *f, unsigned worker)
{
    const struct render_progress *p = &f->tracer->options->progress;
    size_t done = atomic_fetch_add_explicit(&f->done, 1, memory_order_relaxed) + 1;
    if (worker == 0 && p->report)
        p->report(p->context, (double)done / (double)(f->corners.n + 2 * f->pixels.n));
}

/* ---- the samples of all pixels --------------------------------------------------------------- */

/* Samples points of the tile: those (x, y) from each pixel's upper left corner, downwards. */
static void sample_points(struct worker *w, const struct tile *tile, double x, double y)
{
    const struct render_options *o = w->tracer->options;
    const struct camera *camera = &w->tracer->scene->camera;
    double across[BATCH_ROOM], up[BATCH_ROOM];
    uint32_t n = 0;
    for (uint32_t j = tile->y0; j < tile->y1; j++) {
        for (uint32_t i = tile->x0; i < tile->x1; i++, n++) {
            across[n] = camera_place(camera, i + x, o->width);
            up[n] = camera_place(camera, o->height - (j + y), o->height);
        }
    }
    w->stats.primary += n;
    trace_batch(w, 0, rays_through(w, across, up, n), NULL, &w->colours);
}

static void keep_points(const struct worker *w, const struct tile *tile, const struct tile *whole,
                        struct colour *kept)
{
    size_t columns = whole->x1 - whole->x0;
    uint32_t n = 0;
    for (uint32_t y = tile->y0; y < tile->y1; y++) {
        struct colour *row = kept + (y - whole->y0) * columns;
        for (uint32_t x = tile->x0; x < tile->x1; x++, n++)
            row[x - whole->x0] = (struct colour){(float)w->colours.x[n], (float)w->colours.y[n],
                                                 (float)w->colours.z[n]};
    }
}

static void sample_corners(void *context, size_t number, unsigned worker)
{
    struct frame *f = context;
    struct tile tile = tiling_at(&f->corners, number);
    sample_points(f->workers[worker], &tile, 0, 0);
    keep_points(f->workers[worker], &tile, &f->corners.whole, f->corner);
    report_progress(f, worker);
}

static void sample_middles(void *context, size_t number, unsigned worker)
{
    struct frame *f = context;
    struct tile tile = tiling_at(&f->pixels, number);
    sample_points(f->workers[worker], &tile, 0.5, 0.5);
    keep_points(f->workers[worker], &tile, &f->pixels.whole, f->middle);
    report_progress(f, worker);
}

/* ---- one pixel ------------------------------------------------------------------------------- */

/* Half the way from a standard error below the mean to one above, as the picture stores channels.
 */
static double stored_error(const struct frame *f, double mean, double variance)
{
    double error = variance > 0 ? sqrt(variance) : 0;
    if (f->out->floats)
        return error;
    enum picture_encoding e = f->encoding;
    return 0.5 * (picture_channel(e, mean + error) - picture_channel(e, mean - error));
}

static struct vec3 stored_errors(const struct frame *f, const struct cubature *c)
{
    return vec3(stored_error(f, c->mean.x, c->variance.x),
                stored_error(f, c->mean.y, c->variance.y),
                stored_error(f, c->mean.z, c->variance.z));
}

/* By how much the picture stretches errors of a channel, squared. */
static double stretch(double stored, double variance)
{
    return variance > 0 ? stored * stored / variance : 0;
}

/* Cuts a pixel in as many cells as all have at least, and then the worst of it while its error is
 * too large; false when it is done. */
static bool refine(const struct frame *f, struct cubature *c)
{
    uint32_t grid = f->tracer->options->grid;
    if (c->cells < grid * grid) {
        cubature_cut_all(c);
        return true;
    }
    struct vec3 e = stored_errors(f, c);
    if (!(fmax(e.x, fmax(e.y, e.z)) > f->tracer->options->adaptive))
        return false;
    struct vec3 weight =
        vec3(stretch(e.x, c->variance.x), stretch(e.y, c->variance.y), stretch(e.z, c->variance.z));
    return cubature_refine(c, weight);
}

static struct vec3 kept(const struct colour *c)
{
    return vec3(c->r, c->g, c->b);
}

/* Gives the pixel its first samples. */
static void start_pixel(const struct frame *f, uint32_t x, uint32_t y, struct cubature *c)
{
    const struct tile *whole = &f->pixels.whole;
    size_t columns = whole->x1 - whole->x0, column = x - whole->x0, row = y - whole->y0;
    const struct colour *upper = f->corner + row * (columns + 1) + column;
    const struct colour *lower = upper + columns + 1;
    cubature_begin(c, f->tracer->options->jitter);
    c->value[0] = kept(lower);
    c->value[1] = kept(lower + 1);
    c->value[2] = kept(upper);
    c->value[3] = kept(upper + 1);
    c->value[4] = kept(f->middle + row * columns + column);
    cubature_settle(c);
}

/* ---- the pixels of a tile -------------------------------------------------------------------- */

static void trace_queued(struct refiner *r)
{
    struct worker *w = r->w;
    if (r->queued == 0)
        return;
    w->stats.primary += r->queued;
    trace_batch(w, 0, rays_through(w, r->x, r->y, r->queued), NULL, &w->colours);
    for (uint32_t i = 0; i < r->queued; i++)
        *r->to[i] = vec3_get(&w->colours, i);
    r->queued = 0;
}

/* Puts all that is wanted of the pixel (x, y from the top) into the queue. */
static void queue_wanted(struct refiner *r, struct cubature *c, uint32_t x, uint32_t y)
{
    const struct render_options *o = r->w->tracer->options;
    const struct camera *camera = &r->w->tracer->scene->camera;
    for (uint32_t k = c->settled; k < c->samples; k++) {
        uint32_t i = r->queued++;
        double across = (double)c->place[k].x / CUBATURE_PLACES;
        double up = (double)c->place[k].y / CUBATURE_PLACES;
        r->x[i] = camera_place(camera, x + across, o->width);
        r->y[i] = camera_place(camera, o->height - 1 - y + up, o->height);
        r->to[i] = &c->value[k];
        if (r->queued == BATCH)
            trace_queued(r);
    }
}

static void note_finding(const struct frame *f, struct refiner *r, const struct task *task)
{
    const struct cubature *c = task->cells;
    struct vec3 e = stored_errors(f, c);
    r->found[task->pixel] = (struct finding){c->mean, fmax(e.x, fmax(e.y, e.z)), c->samples};
}

/* One more round of cuts; pixels that need none are done. */
static void refine_active(struct frame *f, struct refiner *r, const struct tile *tile)
{
    uint32_t left = 0, columns = tile->x1 - tile->x0;
    for (uint32_t i = 0; i < r->n; i++) {
        struct task task = r->active[i];
        if (!refine(f, task.cells)) {
            note_finding(f, r, &task);
            continue;
        }
        queue_wanted(r, task.cells, tile->x0 + task.pixel % columns,
                     tile->y0 + task.pixel / columns);
        r->active[i] = r->active[left];
        r->active[left++] = task;
    }
    trace_queued(r);
    r->n = left;
    for (uint32_t i = 0; i < left; i++)
        cubature_settle(r->active[i].cells);
}

static void refine_pixels(struct frame *f, struct refiner *r, const struct tile *tile)
{
    r->n = 0;
    for (uint32_t y = tile->y0, pixel = 0; y < tile->y1; y++) {
        for (uint32_t x = tile->x0; x < tile->x1; x++, pixel++) {
            if (!r->cells[pixel])
                r->cells[pixel] = mem_alloc(1, sizeof **r->cells);
            start_pixel(f, x, y, r->cells[pixel]);
            r->active[r->n++] = (struct task){r->cells[pixel], pixel};
        }
    }
    while (r->n > 0)
        refine_active(f, r, tile);
}

/* How many samples a pixel took, by the logarithm: from 5, dark blue, over cyan, yellow and red to
 * the most, white; as floats the number itself. */
static struct vec3 heat(uint32_t samples, bool bytes)
{
    enum { FEWEST = 5, STEPS = 4 };
    static const struct vec3 colour[STEPS + 1] = {
        {0, 0, 0.4}, {0, 0.7, 0.9}, {1, 0.9, 0}, {0.9, 0, 0}, {1, 1, 1}};
    if (!bytes)
        return vec3_all(samples);
    double t = STEPS * log((double)samples / FEWEST) / log((double)CUBATURE_SAMPLES / FEWEST);
    int i = t < STEPS - 1 ? (int)t : STEPS - 1;
    return vec3_mad(colour[i], t - i, vec3_sub(colour[i + 1], colour[i]));
}

static struct vec3 shown(const struct frame *f, const struct finding *found)
{
    bool samples = f->tracer->options->show == SHOW_SAMPLES;
    return samples ? heat(found->samples, f->out->bytes != NULL) : found->mean;
}

static void refine_tile(void *context, size_t number, unsigned worker)
{
    struct frame *f = context;
    struct refiner *r = &f->refiners[worker];
    struct tile tile = tiling_at(&f->pixels, number);
    struct tally *tally = &f->tallies[number];
    uint32_t n = 0;
    refine_pixels(f, r, &tile);
    *tally = (struct tally){0};
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++) {
            const struct finding *found = &r->found[n++];
            picture_set(f->out, x - f->pixels.whole.x0, y - f->pixels.whole.y0, shown(f, found));
            tally->squares += found->error * found->error;
            tally->worst = fmax(tally->worst, found->error);
            tally->most = found->samples > tally->most ? found->samples : tally->most;
        }
    }
    report_progress(f, worker);
}

void render_adaptive(const struct tracer *t, struct worker **workers, struct picture *out,
                     struct adaptive_stats *stats)
{
    const struct render_options *o = t->options;
    struct frame f = {.tracer = t, .workers = workers, .out = out};
    f.encoding = render_encoding(t->scene, SHOW_PICTURE);
    f.corners = tiling_of(o->crop.x0, o->crop.y0, o->crop.x1 + 1, o->crop.y1 + 1);
    f.pixels = tiling_of(o->crop.x0, o->crop.y0, o->crop.x1, o->crop.y1);
    size_t width = o->crop.x1 - o->crop.x0, height = o->crop.y1 - o->crop.y0;
    f.corner = mem_alloc((width + 1) * (height + 1), sizeof *f.corner);
    f.middle = mem_alloc(width * height, sizeof *f.middle);
    f.tallies = mem_alloc(f.pixels.n, sizeof *f.tallies);
    f.refiners = mem_zalloc(o->threads, sizeof *f.refiners);
    for (unsigned i = 0; i < o->threads; i++)
        f.refiners[i].w = workers[i];
    thread_share(f.corners.n, o->threads, sample_corners, &f);
    thread_share(f.pixels.n, o->threads, sample_middles, &f);
    thread_share(f.pixels.n, o->threads, refine_tile, &f);
    *stats = (struct adaptive_stats){0};
    double squares = 0;
    for (size_t i = 0; i < f.pixels.n; i++) {
        squares += f.tallies[i].squares;
        stats->worst = fmax(stats->worst, f.tallies[i].worst);
        stats->most = f.tallies[i].most > stats->most ? f.tallies[i].most : stats->most;
    }
    stats->error = sqrt(squares / ((double)width * (double)height));
    for (unsigned i = 0; i < o->threads; i++)
        for (unsigned k = 0; k < BATCH; k++)
            free(f.refiners[i].cells[k]);
    free(f.refiners);
    free(f.tallies);
    free(f.middle);
    free(f.corner);
}
