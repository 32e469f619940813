/* Where the samples of pixels are, and the camera rays through them. */
#ifndef WRT_RENDER_SAMPLES_H
#define WRT_RENDER_SAMPLES_H

#include "render/tiling.h"
#include "render/tracer.h"

_Static_assert(TILE *TILE == BATCH, "one sample a pixel of a tile makes a batch");

/* Which of the samples of each pixel is traced, and where it is: the offset from the pixel's
 * lower left corner, in pixels. */
struct sample {
    uint32_t k, l;
    double x, y;
};

/* Sample (k, l) of n x n in a pixel, l counted from the bottom. */
struct sample sample_at(const struct tracer *t, uint32_t k, uint32_t l, uint32_t n);

/* A worker that can make camera rays. */
struct worker *camera_worker(const struct tracer *t);
/* The camera rays through this sample of all the tile's pixels, row by row. */
const struct ray_batch *camera_rays(struct worker *w, const struct tile *tile,
                                    const struct sample *sample);
/* The camera rays through n <= BATCH picture coordinates from -1 to 1, of which there must be
 * BATCH_ROOM. */
const struct ray_batch *rays_through(struct worker *w, double *x, double *y, uint32_t n);

#endif
