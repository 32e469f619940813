#include "config.h"

#include "render/adaptive.h"
#include "render/samples.h"

#include "accel/store.h"
#include "base/thread.h"

#include <stdatomic.h>

const struct skip_row skip_rows[SKIPS] = {
#define SKIP(id, name, what) [SKIP_##id] = {name, what},
#include "render/skips.def"
#undef SKIP
};

/* A part of the picture cut into tiles that threads take in turn. */
struct rendering {
    struct tracer tracer;
    struct worker **workers; /* one a thread */
    struct picture *out;
    struct tiling tiling;
    double range[2];      /* distances: of the nearest and the farthest hit */
    double (*ranges)[2];  /* the same by worker, while they are being found */
    const size_t *wanted; /* tiles that are rendered now; NULL: all */
    struct frame *frame;  /* of adaptive sampling, or NULL */
    atomic_size_t done;   /* tiles */
    struct render_stats stats;
};

static void report_progress(struct rendering *r, unsigned worker)
{
    const struct render_options *o = r->tracer.options;
    const struct render_progress *p = &o->progress;
    size_t done = atomic_fetch_add_explicit(&r->done, 1, memory_order_relaxed) + 1;
    size_t all = o->watch.tiles ? o->watch.tiles : r->tiling.n;
    if (worker == 0 && p->report)
        p->report(p->context, (double)done / (double)all);
}

/* Traces this sample of all the tile's pixels. */
static void trace_sample(struct worker *w, const struct tile *tile, struct sample sample,
                         struct vec3_batch *colours)
{
    const struct ray_batch *rays = camera_rays(w, tile, &sample);
    w->stats.primary += rays->n;
    trace_batch(w, 0, rays, NULL, colours);
}

static void add_all(double *sums, const double *x)
{
    for (uint32_t i = 0; i < BATCH; i++)
        sums[i] += x[i];
}

static void divide_all(double *sums, double by)
{
    for (uint32_t i = 0; i < BATCH; i++)
        sums[i] /= by;
}

static void sample_tile(struct worker *w, const struct tile *tile)
{
    uint32_t n = w->tracer->options->grid;
    struct vec3_batch *sums = &w->sums;
    trace_sample(w, tile, sample_at(w->tracer, 0, 0, n), sums);
    for (uint32_t i = 1; i < n * n; i++) {
        trace_sample(w, tile, sample_at(w->tracer, i / n, i % n, n), &w->colours);
        add_all(sums->x, w->colours.x);
        add_all(sums->y, w->colours.y);
        add_all(sums->z, w->colours.z);
    }
    if (n == 1)
        return;
    double samples = (double)n * n;
    divide_all(sums->x, samples);
    divide_all(sums->y, samples);
    divide_all(sums->z, samples);
}

static void store_tile(struct rendering *r, const struct tile *tile,
                       const struct vec3_batch *colours)
{
    struct picture *out = r->out;
    const uint32_t width = tile->x1 - tile->x0, height = tile->y1 - tile->y0;
    const uint32_t x = tile->x0 - r->tiling.whole.x0, y = tile->y0 - r->tiling.whole.y0;
    uint8_t pixels[PACKED_ROOM];
    if (out->bytes) {
        r->tracer.kernels->pack(out, colours, width * height, pixels);
        for (uint32_t row = 0; row < height; row++)
            picture_set_row(out, x, y + row, pixels + 3 * width * row, width);
        return;
    }
    for (uint32_t n = 0; n < width * height; n++)
        picture_set(out, x + n % width, y + n / width, vec3_get(colours, n));
}

static void render_tile(void *context, size_t item, unsigned worker)
{
    struct rendering *r = context;
    struct worker *w = r->workers[worker];
    size_t number = r->wanted ? r->wanted[item] : item;
    struct tile tile = tiling_at(&r->tiling, number);
    if (render_stopped(r->tracer.options))
        return;
    if (r->tracer.options->show == SHOW_PICTURE) {
        sample_tile(w, &tile);
    } else {
        struct sample sample = sample_at(&r->tracer, 0, 0, 1);
        const struct ray_batch *rays = camera_rays(w, &tile, &sample);
        w->stats.primary += rays->n;
        show_batch(w, rays, r->range, !r->out->floats, &w->sums);
    }
    if (w->given_up)
        return;
    store_tile(r, &tile, &w->sums);
    render_tell_finished(r->tracer.options, number);
    report_progress(r, worker);
}

static void find_range_of_tile(void *context, size_t number, unsigned worker)
{
    struct rendering *r = context;
    struct worker *w = r->workers[worker];
    struct tile tile = tiling_at(&r->tiling, number);
    double *range = r->ranges[worker];
    struct sample sample = sample_at(&r->tracer, 0, 0, 1);
    find_points(w, camera_rays(w, &tile, &sample), NULL);
    for (uint32_t k = 0; k < w->points.n; k++) {
        double t = w->points.t[k];
        range[0] = t < range[0] ? t : range[0];
        range[1] = t > range[1] ? t : range[1];
    }
}

/* The distances of the whole picture, also for a crop: its greys are then those of the whole. */
static void find_range(struct rendering *r)
{
    const struct render_options *o = r->tracer.options;
    r->ranges = mem_alloc(o->threads, sizeof *r->ranges);
    for (unsigned i = 0; i < o->threads; i++)
        r->ranges[i][0] = INFINITY, r->ranges[i][1] = -INFINITY;
    r->tiling = tiling_of(0, 0, o->width, o->height);
    thread_share(r->tiling.n, o->threads, find_range_of_tile, r);
    r->range[0] = INFINITY;
    r->range[1] = -INFINITY;
    for (unsigned i = 0; i < o->threads; i++) {
        r->range[0] = fmin(r->range[0], r->ranges[i][0]);
        r->range[1] = fmax(r->range[1], r->ranges[i][1]);
    }
    free(r->ranges);
}

static struct lens lens_for(const struct camera *c, const struct render_options *o)
{
    return o->whole_view ? lens_of(c, c->width, c->height) : lens_of(c, o->width, o->height);
}

/* Classic's may make colours no numbers. */
static uint32_t note_dark_lamps(struct tracer *t)
{
    uint32_t dark = 0;
    for (size_t i = 0; i < t->scene->lights.n && t->modern && tracer_skips(t, SKIP_DARK); i++) {
        t->lamps[i].dark = vec3_is_zero(t->scene->lights.at[i].intensity);
        dark += t->lamps[i].dark;
    }
    return dark;
}

/* Rays that the picture will take, or so. */
static double likely_rays(const struct tracer *t)
{
    const struct render_options *o = t->options;
    struct tiling tiling = tiling_of(o->crop.x0, o->crop.y0, o->crop.x1, o->crop.y1);
    double share = o->watch.tiles ? (double)o->watch.tiles / (double)tiling.n : 1;
    double samples = share * (double)tile_pixels(&tiling.whole) * o->grid * o->grid, shadow = 0;
    bool bounces = false;
    if (o->show != SHOW_PICTURE)
        return samples;
    for (size_t i = 0; i < t->scene->lights.n; i++)
        shadow += fmax(1, (double)(t->lamps[i].samples - t->lamps[i].duplicates));
    for (size_t i = 0; i < t->scene->materials.n; i++)
        bounces |= t->finishes[i].bounces;
    return samples * (1 + shadow) * (bounces && o->depth > 1 ? 2 : 1);
}

static void build_accel(struct tracer *t)
{
    const struct render_options *o = t->options;
    struct accel_options build = {.brute_force = o->brute_force,
                                  .isa = o->isa,
                                  .threads = o->threads,
                                  .store = o->store,
                                  .rays = likely_rays(t)};
    bool *spare = t->skips ? mem_zalloc(t->scene->geometry.prims.n, sizeof *spare) : NULL;
    if (tracer_skips(t, SKIP_TWINS))
        t->twins = find_twins(t, spare);
    if (tracer_skips(t, SKIP_UNSEEN) && !o->store) /* a store keeps trees for other views */
        t->unseen = find_unseen(t, spare);
    if (t->twins > 0 || t->unseen > 0)
        build.spare = spare;
    accel_build_with(&t->accel, &t->scene->geometry, &build);
    free(spare);
}

void tracer_init(struct tracer *t, const struct scene *scene, const struct render_options *options)
{
    *t = (struct tracer){.scene = scene,
                         .options = options,
                         .lens = lens_for(&scene->camera, options),
                         .lamps = mem_alloc(scene->lights.n, sizeof *t->lamps)};
    t->skips = options->brute_force ? 0 : ~options->no_skip & ((UINT32_C(1) << SKIPS) - 1);
    t->bundles = bundle_kernels_of(options->isa);
    t->kernels = render_kernels_of(t->skips ? options->isa : ISA_PLAIN);
    t->modern = scene->model == SCENE_MODERN;
    t->shading = t->modern ? &shading_modern : &shading_classic;
    for (size_t i = 0; i < scene->lights.n; i++)
        lamp_init(&t->lamps[i], &scene->lights.at[i], options->brute_force,
                  tracer_skips(t, SKIP_DUPLICATE));
    t->dark = note_dark_lamps(t);
    t->finishes = mem_alloc(scene->materials.n, sizeof *t->finishes);
    for (size_t i = 0; i < scene->materials.n; i++) {
        t->finishes[i] = finish_of(&scene->materials.at[i]);
        t->any_refractive |= !vec3_is_zero(scene->materials.at[i].refraction);
    }
    t->emissive = mem_alloc(scene->surfaces.n, sizeof *t->emissive);
    for (size_t i = 0; i < scene->surfaces.n; i++) {
        const struct material *m = &scene->materials.at[scene->surfaces.at[i].material];
        t->emissive[i] = m->kind == MATERIAL_EMISSIVE;
        t->any_emissive |= t->emissive[i];
    }
    build_accel(t);
    t->most = options->prune ? most_radiance(t) : NULL;
}

void tracer_free(struct tracer *t)
{
    for (size_t i = 0; i < t->scene->lights.n; i++)
        lamp_free(&t->lamps[i]);
    free(t->lamps);
    free(t->finishes);
    free(t->emissive);
    free(t->most);
    if (t->options->store)
        accel_store_keep(t->options->store, &t->accel);
    else
        accel_free(&t->accel);
}

static void add_stats(struct render_stats *sum, const struct render_stats *more)
{
    sum->primary += more->primary;
    sum->shadow += more->shadow;
    sum->reflection += more->reflection;
    sum->refraction += more->refraction;
    sum->pruned += more->pruned;
    for (int i = 0; i < SKIPS; i++)
        sum->skipped[i] += more->skipped[i];
}

enum picture_encoding render_encoding(const struct scene *scene, enum render_show show)
{
    if (scene->model == SCENE_CLASSIC || show != SHOW_PICTURE)
        return ENCODING_PLAIN;
    return scene->linear ? ENCODING_LINEAR : ENCODING_SRGB;
}

struct rendering *rendering_begin(const struct scene *scene, const struct render_options *options,
                                  struct picture *out)
{
    struct rendering *r = mem_zalloc(1, sizeof *r);
    double started = thread_seconds();
    tracer_init(&r->tracer, scene, options);
    r->stats.build_s = thread_seconds() - started;
    r->out = out;
    r->workers = mem_alloc(options->threads, sizeof *r->workers);
    for (unsigned i = 0; i < options->threads; i++)
        r->workers[i] = camera_worker(&r->tracer);
    if (options->show == SHOW_DEPTH && !out->floats)
        find_range(r);
    for (unsigned i = 0; i < options->threads; i++)
        r->workers[i]->stats = (struct render_stats){0};
    r->tiling = tiling_of(options->crop.x0, options->crop.y0, options->crop.x1, options->crop.y1);
    if (options->adaptive > 0)
        r->frame = adaptive_new(&r->tracer, r->workers, out);
    return r;
}

void rendering_tiles(struct rendering *r, const size_t *tiles, size_t n)
{
    double started = thread_seconds();
    r->wanted = tiles;
    if (r->frame)
        adaptive_tiles(r->frame, tiles, n);
    else
        thread_share(tiles ? n : r->tiling.n, r->tracer.options->threads, render_tile, r);
    r->stats.render_s += thread_seconds() - started;
}

void rendering_end(struct rendering *r, struct render_stats *stats)
{
    *stats = r->stats;
    stats->skipped[SKIP_TWINS] = r->tracer.twins;
    stats->skipped[SKIP_UNSEEN] = r->tracer.unseen;
    stats->skipped[SKIP_DARK] = r->tracer.dark;
    stats->tree = accel_efforts(&r->tracer.accel);
    if (r->frame)
        stats->adaptive = adaptive_end(r->frame);
    for (unsigned i = 0; i < r->tracer.options->threads; i++) {
        add_stats(stats, &r->workers[i]->stats);
        worker_free(r->workers[i]);
    }
    free(r->workers);
    tracer_free(&r->tracer);
    free(r);
}

void render_scene(const struct scene *scene, const struct render_options *options,
                  struct picture *out, struct render_stats *stats)
{
    struct rendering *r = rendering_begin(scene, options, out);
    rendering_tiles(r, NULL, 0);
    rendering_end(r, stats);
}
