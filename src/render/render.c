#include "config.h"

#include "render/adaptive.h"
#include "render/samples.h"

#include "base/thread.h"

#include <stdatomic.h>

/* A part of the picture cut into tiles that threads take in turn. */
struct job {
    const struct tracer *tracer;
    struct worker **workers; /* one a thread */
    struct picture *out;
    struct tiling tiling;
    double range[2];     /* distances: of the nearest and the farthest hit */
    double (*ranges)[2]; /* the same by worker, while they are being found */
    atomic_size_t done;  /* tiles */
};

static void report_progress(struct job *job, unsigned worker)
{
    const struct render_progress *p = &job->tracer->options->progress;
    size_t done = atomic_fetch_add_explicit(&job->done, 1, memory_order_relaxed) + 1;
    if (worker == 0 && p->report)
        p->report(p->context, (double)done / (double)job->tiling.n);
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
    struct tile tile = tiling_at(&job->tiling, number);
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
            picture_set(job->out, x - job->tiling.whole.x0, y - job->tiling.whole.y0,
                        vec3_get(&colours, n++));
    report_progress(job, worker);
}

static void find_range_of_tile(void *context, size_t number, unsigned worker)
{
    struct job *job = context;
    struct worker *w = job->workers[worker];
    struct tile tile = tiling_at(&job->tiling, number);
    double *range = job->ranges[worker];
    struct sample sample = sample_at(job->tracer, 0, 0, 1);
    find_points(w, camera_rays(w, &tile, &sample), NULL);
    for (uint32_t k = 0; k < w->points.n; k++) {
        double t = w->points.t[k];
        range[0] = t < range[0] ? t : range[0];
        range[1] = t > range[1] ? t : range[1];
    }
}

/* The distances of the whole picture, also for a crop: its greys are then those of the whole. */
static void find_range(struct job *job)
{
    const struct render_options *o = job->tracer->options;
    job->ranges = mem_alloc(o->threads, sizeof *job->ranges);
    for (unsigned i = 0; i < o->threads; i++)
        job->ranges[i][0] = INFINITY, job->ranges[i][1] = -INFINITY;
    job->tiling = tiling_of(0, 0, o->width, o->height);
    thread_share(job->tiling.n, o->threads, find_range_of_tile, job);
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

void tracer_init(struct tracer *t, const struct scene *scene, const struct render_options *options)
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

void tracer_free(struct tracer *t)
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

enum picture_encoding render_encoding(const struct scene *scene, enum render_show show)
{
    if (scene->model == SCENE_CLASSIC || show != SHOW_PICTURE)
        return ENCODING_PLAIN;
    return scene->linear ? ENCODING_LINEAR : ENCODING_SRGB;
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
    *stats = (struct render_stats){.build_s = built - started};
    job.tiling = tiling_of(options->crop.x0, options->crop.y0, options->crop.x1, options->crop.y1);
    if (options->adaptive > 0)
        stats->adaptive = render_adaptive(&tracer, job.workers, out);
    else
        thread_share(job.tiling.n, options->threads, render_tile, &job);
    stats->render_s = thread_seconds() - built;
    for (unsigned i = 0; i < options->threads; i++) {
        add_stats(stats, &job.workers[i]->stats);
        worker_free(job.workers[i]);
    }
    free(job.workers);
    tracer_free(&tracer);
}
