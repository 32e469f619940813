#include "config.h"

#include "render/tracer.h"

#include "base/thread.h"
#include "math/rng.h"

#include <stdatomic.h>

enum { TILE = 8 };
_Static_assert(TILE *TILE == BATCH, "one sample a pixel of a tile makes a batch");

/* A part of the picture cut into tiles that threads take in turn. */
struct job {
    const struct tracer *tracer;
    struct worker **workers; /* one a thread */
    struct picture *out;
    uint32_t x0, y0, x1, y1; /* of the whole picture, top left origin */
    uint32_t columns;        /* tiles in a row */
    double range[2];         /* distances: of the nearest and the farthest hit */
    double (*ranges)[2];     /* the same by worker, while they are being found */
    atomic_size_t done;      /* tiles */
    size_t tiles;
};

/* Which of the samples of each pixel is traced, and where it is: the offset from the pixel's
 * corner, in pixels. */
struct sample {
    uint32_t k, l;
    double x, y;
};

/* Sample (k, l) of a pixel, l counted from the bottom; move_x and move_y jitter it, from 0 to 1.
 * The original's rule: one sample is at the pixel's corner, n x n are spread around it. */
static struct sample classic_sample(uint32_t k, uint32_t l, double n, double move_x, double move_y)
{
    if (n == 1)
        return (struct sample){k, l, move_x, move_y};
    return (struct sample){k, l, (k + move_x) / n - 1 / (2 * n), (l + move_y) / n - 1 / (2 * n)};
}

/* Ours: in the middle of its part of the pixel. */
static struct sample modern_sample(uint32_t k, uint32_t l, double n, double move_x, double move_y)
{
    return (struct sample){k, l, (k + move_x) / n, (l + move_y) / n};
}

static struct sample sample_at(const struct tracer *t, uint32_t k, uint32_t l, uint32_t n)
{
    double move = camera_sample(&t->scene->camera);
    return t->modern ? modern_sample(k, l, n, move, move) : classic_sample(k, l, n, move, move);
}

struct tile {
    uint32_t x0, y0, x1, y1;
};

static struct tile tile_of(const struct job *job, size_t number)
{
    uint32_t x = job->x0 + (uint32_t)(number % job->columns) * TILE;
    uint32_t y = job->y0 + (uint32_t)(number / job->columns) * TILE;
    return (struct tile){x, y, job->x1 - x < TILE ? job->x1 : x + TILE,
                         job->y1 - y < TILE ? job->y1 : y + TILE};
}

static void report_progress(struct job *job, unsigned worker)
{
    const struct render_progress *p = &job->tracer->options->progress;
    size_t done = atomic_fetch_add_explicit(&job->done, 1, memory_order_relaxed) + 1;
    if (worker == 0 && p->report)
        p->report(p->context, (double)done / (double)job->tiles);
}

/* The sample's place in pixel (i, j), j counted from the bottom: jittered anew for each pixel. */
static void jitter(const struct tracer *t, uint32_t i, uint32_t j, const struct sample *s,
                   double *x, double *y)
{
    const struct render_options *o = t->options;
    uint64_t pixel = (uint64_t)j * o->width + i, number = (uint64_t)s->l * o->grid + s->k;
    double u = rng_uniform(o->seed, pixel, number, 0), v = rng_uniform(o->seed, pixel, number, 1);
    struct sample at = t->modern ? modern_sample(s->k, s->l, o->grid, u, v)
                                 : classic_sample(s->k, s->l, o->grid, u, v);
    *x = camera_place(&t->scene->camera, i + at.x, o->width);
    *y = camera_place(&t->scene->camera, j + at.y, o->height);
}

/* The camera rays through this sample of all the tile's pixels, row by row. */
static const struct ray_batch *camera_rays(struct worker *w, const struct tile *tile,
                                           const struct sample *sample)
{
    const struct tracer *t = w->tracer;
    const struct render_options *o = t->options;
    const struct camera *camera = &t->scene->camera;
    struct ray_batch *rays = &w->camera_rays;
    double x[BATCH_ROOM], y[BATCH_ROOM], columns[TILE];
    uint32_t n = 0;
    for (uint32_t i = tile->x0; i < tile->x1; i++)
        columns[i - tile->x0] = camera_place(camera, i + sample->x, o->width);
    for (uint32_t row = tile->y0; row < tile->y1; row++) {
        uint32_t j = o->height - 1 - row;
        double up = camera_place(camera, j + sample->y, o->height);
        for (uint32_t i = tile->x0; i < tile->x1; i++, n++) {
            x[n] = columns[i - tile->x0];
            y[n] = up;
            if (o->jitter)
                jitter(t, i, j, sample, &x[n], &y[n]);
        }
    }
    fill(x, n, BATCH_ROOM, 0);
    fill(y, n, BATCH_ROOM, 0);
    rays->n = n;
    if (!t->lens.parallel)
        t->kernels->aim(&t->lens, x, y, n, &rays->direction);
    for (uint32_t i = 0; i < n && t->lens.parallel; i++)
        vec3_put(&rays->origin, i, lens_origin(&t->lens, x[i], y[i]));
    return rays;
}

/* Adds this sample of all the tile's pixels to their sums. */
static void add_samples(struct worker *w, const struct tile *tile, const struct sample *sample,
                        struct vec3_batch *sums)
{
    const struct ray_batch *rays = camera_rays(w, tile, sample);
    w->stats.primary += rays->n;
    trace_batch(w, 0, rays, NULL, &w->colours);
    for (uint32_t i = 0; i < rays->n; i++)
        vec3_put(sums, i, vec3_add(vec3_get(sums, i), vec3_get(&w->colours, i)));
}

static void sample_tile(struct worker *w, const struct tile *tile, struct vec3_batch *colours)
{
    uint32_t n = w->tracer->options->grid;
    vec3_fill(colours, 0, BATCH, vec3_all(0));
    for (uint32_t k = 0; k < n; k++) {
        for (uint32_t l = 0; l < n; l++) {
            struct sample sample = sample_at(w->tracer, k, l, n);
            add_samples(w, tile, &sample, colours);
        }
    }
    double samples = (double)n * n;
    for (uint32_t i = 0; i < BATCH && n > 1; i++)
        vec3_put(colours, i,
                 vec3(colours->x[i] / samples, colours->y[i] / samples, colours->z[i] / samples));
}

static void render_tile(void *context, size_t number, unsigned worker)
{
    struct job *job = context;
    struct worker *w = job->workers[worker];
    struct tile tile = tile_of(job, number);
    struct vec3_batch colours;
    if (job->tracer->options->show == SHOW_PICTURE) {
        sample_tile(w, &tile, &colours);
    } else {
        struct sample sample = sample_at(job->tracer, 0, 0, 1);
        const struct ray_batch *rays = camera_rays(w, &tile, &sample);
        w->stats.primary += rays->n;
        show_batch(w, rays, job->range, job->out->bytes != NULL, &colours);
    }
    uint32_t n = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++)
        for (uint32_t x = tile.x0; x < tile.x1; x++)
            picture_set(job->out, x - job->x0, y - job->y0, vec3_get(&colours, n++));
    report_progress(job, worker);
}

static void find_range_of_tile(void *context, size_t number, unsigned worker)
{
    struct job *job = context;
    struct worker *w = job->workers[worker];
    struct tile tile = tile_of(job, number);
    double *range = job->ranges[worker];
    struct sample sample = sample_at(job->tracer, 0, 0, 1);
    find_points(w, camera_rays(w, &tile, &sample), NULL);
    for (uint32_t k = 0; k < w->points.n; k++) {
        double t = w->points.t[k];
        range[0] = t < range[0] ? t : range[0];
        range[1] = t > range[1] ? t : range[1];
    }
}

static void cut_tiles(struct job *job, uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1)
{
    job->x0 = x0;
    job->y0 = y0;
    job->x1 = x1;
    job->y1 = y1;
    job->columns = (x1 - x0 + TILE - 1) / TILE;
    job->tiles = (size_t)job->columns * ((y1 - y0 + TILE - 1) / TILE);
}

/* The distances of the whole picture, also for a crop: its greys are then those of the whole. */
static void find_range(struct job *job)
{
    const struct render_options *o = job->tracer->options;
    job->ranges = mem_alloc(o->threads, sizeof *job->ranges);
    for (unsigned i = 0; i < o->threads; i++)
        job->ranges[i][0] = INFINITY, job->ranges[i][1] = -INFINITY;
    cut_tiles(job, 0, 0, o->width, o->height);
    thread_share(job->tiles, o->threads, find_range_of_tile, job);
    job->range[0] = INFINITY;
    job->range[1] = -INFINITY;
    for (unsigned i = 0; i < o->threads; i++) {
        job->range[0] = fmin(job->range[0], job->ranges[i][0]);
        job->range[1] = fmax(job->range[1], job->ranges[i][1]);
    }
    free(job->ranges);
}

static struct lens lens_for(const struct camera *c, const struct render_options *o)
{
    return o->whole_view ? lens_of(c, c->width, c->height) : lens_of(c, o->width, o->height);
}

static void tracer_init(struct tracer *t, const struct scene *scene,
                        const struct render_options *options)
{
    *t = (struct tracer){.scene = scene,
                         .options = options,
                         .lens = lens_for(&scene->camera, options),
                         .lamps = mem_alloc(scene->lights.n, sizeof *t->lamps)};
    t->skips = !options->no_skip && !options->brute_force;
    t->bundles = bundle_kernels_of(options->isa);
    t->kernels = render_kernels_of(t->skips ? options->isa : ISA_PLAIN);
    t->modern = scene->model == SCENE_MODERN;
    t->shading = t->modern ? &shading_modern : &shading_classic;
    struct accel_options build = {options->brute_force, options->isa, options->threads};
    accel_build_with(&t->accel, &scene->geometry, &build);
    for (size_t i = 0; i < scene->lights.n; i++)
        lamp_init(&t->lamps[i], &scene->lights.at[i], options->brute_force, t->skips);
    t->finishes = mem_alloc(scene->materials.n, sizeof *t->finishes);
    for (size_t i = 0; i < scene->materials.n; i++)
        t->finishes[i] = finish_of(&scene->materials.at[i]);
    t->emissive = mem_alloc(scene->surfaces.n, sizeof *t->emissive);
    for (size_t i = 0; i < scene->surfaces.n; i++) {
        const struct material *m = &scene->materials.at[scene->surfaces.at[i].material];
        t->emissive[i] = m->kind == MATERIAL_EMISSIVE;
        t->any_emissive |= t->emissive[i];
    }
}

static void tracer_free(struct tracer *t)
{
    for (size_t i = 0; i < t->scene->lights.n; i++)
        lamp_free(&t->lamps[i]);
    free(t->lamps);
    free(t->finishes);
    free(t->emissive);
    accel_free(&t->accel);
}

static void add_stats(struct render_stats *sum, const struct render_stats *more)
{
    sum->primary += more->primary;
    sum->shadow += more->shadow;
    sum->reflection += more->reflection;
    sum->refraction += more->refraction;
    for (int i = 0; i < SKIP_REASONS; i++)
        sum->skipped[i] += more->skipped[i];
}

/* A worker whose camera rays lack nothing but their directions, or origins where they are parallel.
 */
static struct worker *camera_worker(const struct tracer *t)
{
    struct worker *w = worker_new(t);
    struct ray_batch *rays = &w->camera_rays;
    rays->common_origin = !t->lens.parallel;
    for (uint32_t i = 0; i < BATCH_ROOM; i++) {
        vec3_put(&rays->origin, i, t->lens.origin);
        vec3_put(&rays->direction, i, t->lens.ahead);
        rays->t_max[i] = RAY_UNBOUNDED;
        rays->from[i] = PRIM_NONE;
    }
    w->shadow_rays.spawned = true;
    return w;
}

void render_scene(const struct scene *scene, const struct render_options *options,
                  struct picture *out, struct render_stats *stats)
{
    struct tracer tracer;
    double started = thread_seconds();
    tracer_init(&tracer, scene, options);
    double built = thread_seconds();
    struct job job = {.tracer = &tracer, .out = out};
    job.workers = mem_alloc(options->threads, sizeof *job.workers);
    for (unsigned i = 0; i < options->threads; i++)
        job.workers[i] = camera_worker(&tracer);
    if (options->show == SHOW_DEPTH && out->bytes)
        find_range(&job);
    cut_tiles(&job, options->crop.x0, options->crop.y0, options->crop.x1, options->crop.y1);
    thread_share(job.tiles, options->threads, render_tile, &job);
    *stats =
        (struct render_stats){.build_s = built - started, .render_s = thread_seconds() - built};
    for (unsigned i = 0; i < options->threads; i++) {
        add_stats(stats, &job.workers[i]->stats);
        worker_free(job.workers[i]);
    }
    free(job.workers);
    tracer_free(&tracer);
}
