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
    struct worker *workers;
    struct picture *out;
    uint32_t x0, y0, x1, y1; /* of the whole picture, top left origin */
    uint32_t columns;        /* tiles in a row */
    double range[2];         /* distances: of the nearest and the farthest hit */
    double (*ranges)[2];     /* the same by worker, while they are being found */
    atomic_size_t done;      /* tiles */
    size_t tiles;
};

static struct ray camera_ray(const struct tracer *t, struct vec3 direction)
{
    return (struct ray){.origin = t->lens.origin,
                        .direction = direction,
                        .t_max = RAY_UNBOUNDED,
                        .from = PRIM_NONE,
                        .surface = SURFACE_NONE};
}

/* Which of the samples of each pixel is traced, and where it is: the offset from the pixel's
 * corner, in pixels. */
struct sample {
    uint32_t k, l;
    double x, y;
};

/* The original's rule: sample (k, l) of pixel (i, j), j counted from the bottom.  One sample is
 * at the pixel's corner, n x n are spread around it.  move_x and move_y jitter it, from 0 to 1. */
static void place_sample(struct sample *s, double n, double move_x, double move_y)
{
    if (n == 1) {
        s->x = move_x;
        s->y = move_y;
    } else {
        s->x = (s->k + move_x) / n - 1 / (2 * n);
        s->y = (s->l + move_y) / n - 1 / (2 * n);
    }
}

static struct vec3 sample_direction(const struct tracer *t, uint32_t i, uint32_t j, struct sample s)
{
    const struct render_options *o = t->options;
    if (o->jitter) {
        uint64_t pixel = (uint64_t)j * o->width + i, number = (uint64_t)s.l * o->grid + s.k;
        place_sample(&s, o->grid, rng_uniform(o->seed, pixel, number, 0),
                     rng_uniform(o->seed, pixel, number, 1));
    }
    return lens_direction(&t->lens, (i + s.x) / o->width, (j + s.y) / o->height);
}

/* The one ray of pixel (x, y), top left origin, of pictures that show something else. */
static struct ray corner_ray(const struct tracer *t, uint32_t x, uint32_t y)
{
    const struct render_options *o = t->options;
    uint32_t j = o->height - 1 - y;
    return camera_ray(t, lens_direction(&t->lens, x / (double)o->width, j / (double)o->height));
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

/* Adds this sample of all the tile's pixels to their sums, row by row. */
static void add_samples(struct worker *w, const struct tile *tile, struct sample sample,
                        struct vec3 *sums)
{
    struct ray rays[BATCH];
    struct vec3 colours[BATCH];
    const struct tracer *t = w->tracer;
    uint32_t n = 0;
    for (uint32_t y = tile->y0; y < tile->y1; y++) {
        for (uint32_t x = tile->x0; x < tile->x1; x++) {
            uint32_t j = t->options->height - 1 - y;
            rays[n++] = camera_ray(t, sample_direction(t, x, j, sample));
        }
    }
    w->stats.primary += n;
    trace_batch(w, 0, rays, NULL, n, colours);
    for (uint32_t i = 0; i < n; i++)
        sums[i] = vec3_add(sums[i], colours[i]);
}

static void sample_tile(struct worker *w, const struct tile *tile, struct vec3 *colours)
{
    uint32_t n = w->tracer->options->grid;
    for (uint32_t i = 0; i < BATCH; i++)
        colours[i] = vec3_all(0);
    for (uint32_t k = 0; k < n; k++) {
        for (uint32_t l = 0; l < n; l++) {
            struct sample sample = {.k = k, .l = l};
            place_sample(&sample, n, 0, 0);
            add_samples(w, tile, sample, colours);
        }
    }
    double samples = (double)n * n;
    for (uint32_t i = 0; i < BATCH && n > 1; i++)
        colours[i] = vec3(colours[i].x / samples, colours[i].y / samples, colours[i].z / samples);
}

static void show_tile(struct job *job, struct worker *w, const struct tile *tile,
                      struct vec3 *colours)
{
    const struct tracer *t = w->tracer;
    uint32_t n = 0;
    for (uint32_t y = tile->y0; y < tile->y1; y++) {
        for (uint32_t x = tile->x0; x < tile->x1; x++) {
            struct ray ray = corner_ray(t, x, y);
            colours[n++] = show_colour(t, &ray, job->range, job->out->bytes != NULL);
        }
    }
    w->stats.primary += n;
}

static void render_tile(void *context, size_t number, unsigned worker)
{
    struct job *job = context;
    struct tile tile = tile_of(job, number);
    struct vec3 colours[BATCH];
    if (job->tracer->options->show == SHOW_PICTURE)
        sample_tile(&job->workers[worker], &tile, colours);
    else
        show_tile(job, &job->workers[worker], &tile, colours);
    uint32_t n = 0;
    for (uint32_t y = tile.y0; y < tile.y1; y++)
        for (uint32_t x = tile.x0; x < tile.x1; x++)
            picture_set(job->out, x - job->x0, y - job->y0, colours[n++]);
    report_progress(job, worker);
}

static void find_range_of_tile(void *context, size_t number, unsigned worker)
{
    struct job *job = context;
    const struct tracer *t = job->tracer;
    struct tile tile = tile_of(job, number);
    double *range = job->ranges[worker];
    for (uint32_t y = tile.y0; y < tile.y1; y++) {
        for (uint32_t x = tile.x0; x < tile.x1; x++) {
            struct ray ray = corner_ray(t, x, y);
            struct hit hit;
            if (!accel_closest(&t->accel, &ray, &hit))
                continue;
            range[0] = hit.t < range[0] ? hit.t : range[0];
            range[1] = hit.t > range[1] ? hit.t : range[1];
        }
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

static void tracer_init(struct tracer *t, const struct scene *scene,
                        const struct render_options *options)
{
    *t = (struct tracer){.scene = scene,
                         .options = options,
                         .lens = lens_of(&scene->camera, options->width, options->height),
                         .lamps = mem_alloc(scene->lights.n, sizeof *t->lamps)};
    t->skips = !options->no_skip && !options->brute_force;
    accel_build(&t->accel, &scene->geometry, options->brute_force);
    for (size_t i = 0; i < scene->lights.n; i++)
        lamp_init(&t->lamps[i], &scene->lights.at[i], options->brute_force);
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
    sum->shadow_skipped += more->shadow_skipped;
}

void render_scene(const struct scene *scene, const struct render_options *options,
                  struct picture *out, struct render_stats *stats)
{
    struct tracer tracer;
    double started = thread_seconds();
    tracer_init(&tracer, scene, options);
    double built = thread_seconds();
    struct job job = {.tracer = &tracer, .out = out};
    job.workers = mem_zalloc(options->threads, sizeof *job.workers);
    for (unsigned i = 0; i < options->threads; i++)
        worker_init(&job.workers[i], &tracer);
    if (options->show == SHOW_DEPTH && out->bytes)
        find_range(&job);
    cut_tiles(&job, options->crop.x0, options->crop.y0, options->crop.x1, options->crop.y1);
    thread_share(job.tiles, options->threads, render_tile, &job);
    *stats =
        (struct render_stats){.build_s = built - started, .render_s = thread_seconds() - built};
    for (unsigned i = 0; i < options->threads; i++) {
        add_stats(stats, &job.workers[i].stats);
        worker_free(&job.workers[i]);
    }
    free(job.workers);
    tracer_free(&tracer);
}
