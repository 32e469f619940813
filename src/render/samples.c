/* Where the samples of pixels are, and the camera rays through them. */
#include "config.h"

#include "render/samples.h"

#include "math/rng.h"

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

struct sample sample_at(const struct tracer *t, uint32_t k, uint32_t l, uint32_t n)
{
    double move = camera_sample(&t->scene->camera);
    return t->modern ? modern_sample(k, l, n, move, move) : classic_sample(k, l, n, move, move);
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

const struct ray_batch *rays_through(struct worker *w, double *x, double *y, uint32_t n)
{
    const struct tracer *t = w->tracer;
    struct ray_batch *rays = &w->camera_rays;
    fill_rest(x, n, 0);
    fill_rest(y, n, 0);
    rays->n = n;
    w->lookout.known = false;
    if (!t->lens.parallel)
        t->kernels->aim(&t->lens, x, y, n, &rays->direction);
    for (uint32_t i = 0; i < n && t->lens.parallel; i++)
        vec3_put(&rays->origin, i, lens_origin(&t->lens, x[i], y[i]));
    return rays;
}

/* ---- what they can meet ---------------------------------------------------------------------- */

/* A row of so many pixels' tiles has one list in common. */
enum { VIEW_WIDTH = 8 * TILE };

/* Bounds of origin + x across + y upwards for x and y between the ends. */
static struct box parallelogram(const struct vec3 origin, struct vec3 across, const double x[2],
                                struct vec3 upwards, const double y[2])
{
    struct vec3 left = vec3_scale(across, x[0]), right = vec3_scale(across, x[1]);
    struct vec3 low = vec3_scale(upwards, y[0]), high = vec3_scale(upwards, y[1]);
    double reach = vec3_largest(origin) + vec3_largest(across) + vec3_largest(upwards);
    struct vec3 rounding = vec3_all(0x1p-40 * reach);
    struct vec3 lo = vec3_add(vec3_min(left, right), vec3_min(low, high));
    struct vec3 hi = vec3_add(vec3_max(left, right), vec3_max(low, high));
    return (struct box){vec3_sub(vec3_add(origin, lo), rounding),
                        vec3_add(vec3_add(origin, hi), rounding)};
}

/* Lists what camera rays anywhere in the row of tiles around this one can meet, if it is another
 * row than the last one.  Samples lie less than a pixel outside of theirs. */
static void look(struct worker *w, const struct tile *tile)
{
    const struct tracer *t = w->tracer;
    const struct lens *lens = &t->lens;
    const struct camera *camera = &t->scene->camera;
    const struct render_options *o = t->options;
    uint32_t from = tile->x0 / VIEW_WIDTH, first = from * VIEW_WIDTH;
    struct lookout *ahead = &w->lookout;
    ahead->known = t->skips && !bundle_needs_no_lists(&t->accel);
    if (!ahead->known || (ahead->x == from && ahead->y == tile->y1))
        return;
    double x[2], y[2], low = o->height - tile->y1;
    x[0] = camera_place(camera, first - 1.0, o->width);
    x[1] = camera_place(camera, first + VIEW_WIDTH + TILE, o->width);
    y[0] = camera_place(camera, low - 1, o->height);
    y[1] = camera_place(camera, low + TILE + 1, o->height);
    struct box origins = {lens->origin, lens->origin}, directions = {lens->ahead, lens->ahead};
    if (lens->parallel)
        origins = parallelogram(lens->origin, lens->across, x, lens->upwards, y);
    else
        directions = parallelogram(lens->ahead, lens->across, x, lens->upwards, y);
    if (lens->mirrored) {
        double z = directions.lo.z;
        directions.lo.z = -directions.hi.z;
        directions.hi.z = -z;
    }
    struct shaft shaft = shaft_of_rays(&t->accel, origins, directions);
    shaft_list(&t->accel, &shaft, &ahead->list);
    if (ahead->list.usable)
        shaft_sort(&t->accel, &shaft, &ahead->list);
    ahead->x = from;
    ahead->y = tile->y1;
}

/* Those through columns x of rows y of the tile, or jittered. */
static void rays_one_by_one(struct worker *w, const struct tile *tile, const struct sample *sample,
                            const double *columns, const double *rows)
{
    const struct tracer *t = w->tracer;
    double x[BATCH_ROOM], y[BATCH_ROOM];
    uint32_t n = 0;
    for (uint32_t row = tile->y0; row < tile->y1; row++) {
        for (uint32_t column = tile->x0; column < tile->x1; column++, n++) {
            x[n] = columns[column - tile->x0];
            y[n] = rows[row - tile->y0];
            if (t->options->jitter)
                jitter(t, column, t->options->height - 1 - row, sample, &x[n], &y[n]);
        }
    }
    rays_through(w, x, y, n);
}

const struct ray_batch *camera_rays(struct worker *w, const struct tile *tile,
                                    const struct sample *sample)
{
    const struct tracer *t = w->tracer;
    const struct render_options *o = t->options;
    const struct camera *camera = &t->scene->camera;
    double columns[TILE + BATCH_ROOM - BATCH], rows[TILE], upwards[TILE];
    uint32_t width = tile->x1 - tile->x0, height = tile->y1 - tile->y0;
    camera_places(camera, tile->x0, width, sample->x, o->width, columns);
    fill_rest(columns, width, 0);
    camera_places(camera, o->height - tile->y1, height, sample->y, o->height, upwards);
    for (uint32_t j = 0; j < height; j++)
        rows[j] = upwards[height - 1 - j];
    if (o->jitter || t->lens.parallel) {
        rays_one_by_one(w, tile, sample, columns, rows);
    } else {
        t->kernels->aim_grid(&t->lens, columns, width, rows, height, &w->camera_rays.direction);
        w->camera_rays.n = width * height;
    }
    look(w, tile);
    return &w->camera_rays;
}

/* A worker whose camera rays lack nothing but their directions, or origins where they are parallel.
 */
struct worker *camera_worker(const struct tracer *t)
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
