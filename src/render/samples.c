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
    fill(x, n, BATCH_ROOM, 0);
    fill(y, n, BATCH_ROOM, 0);
    rays->n = n;
    if (!t->lens.parallel)
        t->kernels->aim(&t->lens, x, y, n, &rays->direction);
    for (uint32_t i = 0; i < n && t->lens.parallel; i++)
        vec3_put(&rays->origin, i, lens_origin(&t->lens, x[i], y[i]));
    return rays;
}

const struct ray_batch *camera_rays(struct worker *w, const struct tile *tile,
                                    const struct sample *sample)
{
    const struct tracer *t = w->tracer;
    const struct render_options *o = t->options;
    const struct camera *camera = &t->scene->camera;
    double x[BATCH_ROOM], y[BATCH_ROOM], columns[TILE];
    uint32_t n = 0;
    for (uint32_t i = tile->x0; i < tile->x1; i++)
        columns[i - tile->x0] = camera_place(camera, i + sample->x, o->width);
    for (uint32_t row = tile->y0; row < tile->y1; row++) {
        uint32_t j = o->height - 1 - row;
        double up = camera_place(camera, j + sample->y, o->height);
        for (uint32_t i = tile->x0; i < tile->x1; i++, n++) {
            /* cppcheck-suppress uninitvar */
            x[n] = columns[i - tile->x0];
            y[n] = up;
            if (o->jitter)
                jitter(t, i, j, sample, &x[n], &y[n]);
        }
    }
    return rays_through(w, x, y, n);
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
