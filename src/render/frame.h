/* What the parts of adaptive sampling share: the first samples of all pixels, and what is found out
 * of each. */
#ifndef WRT_RENDER_FRAME_H
#define WRT_RENDER_FRAME_H

#include "render/cubature.h"
#include "render/samples.h"

#include <stdatomic.h>

/* A first sample. */
struct colour {
    float r, g, b;
    bool seen;   /* it has been taken */
    bool wanted; /* it is to be */
};

/* What is found out of a tile's pixels. */
struct tally {
    double squares, worst;    /* of the known errors: sum of squares, and the largest */
    double doubt;             /* the largest (see refine.c) */
    uint32_t most;            /* samples */
    uint32_t pixels, unknown; /* those of the tile; those without all first samples */
};

/* What a thread works with (refine.c). */
struct refiner;

/* Pixels are counted from the upper left corner of the halo: the crop and a row of pixels around
 * it, as far as the picture has them. */
struct frame {
    const struct tracer *tracer;
    struct worker **workers;   /* one a thread */
    struct refiner **refiners; /* one a thread, made when first needed */
    struct picture *out;
    enum picture_encoding encoding; /* of light, whatever is shown */
    uint32_t x0, y0;                /* of the halo, in the picture */
    uint32_t width, height;         /* of the halo */
    struct tile crop;               /* in the halo */
    struct tiling tiling;           /* of the crop */
    struct tile area;               /* all that is wanted lies in it; in the halo */
    struct colour *corner, *middle; /* by row from the top; a row has one corner more */
    float *first_error;             /* of each pixel, by its first samples; infinite without them */
    float *error;                   /* by all samples so far */
    bool *refined;                  /* there are more than the first */
    struct tally *tallies;          /* by tile */
    size_t *order;                  /* of the tiles */
    double target;                  /* the standard error that is wanted now */
    double started, deadline; /* of thread_seconds(); the latter is infinite without a budget */
    double *longest;          /* seconds a thread took for one batch; with a budget */
    double work;              /* items in all, for the progress; without a budget */
    atomic_size_t done;
};

/* Whether another batch could end too late. */
bool frame_late(const struct frame *f, unsigned worker);
void frame_report(struct frame *f, unsigned worker);
/* The colours at n <= BATCH places, in pixels, come into the worker's `colours`; they are none
 * where it has given up. */
void frame_trace(struct frame *f, unsigned worker, double *x, double *y, uint32_t n);

/* Whether nothing more is begun; in a limited time that only makes it late. */
static inline bool frame_given_up(const struct frame *f)
{
    return f->deadline == INFINITY && render_stopped(f->tracer->options);
}

static inline size_t frame_pixel(const struct frame *f, uint32_t x, uint32_t y)
{
    return (size_t)y * f->width + x;
}

/* ---- first.c ---- */

/* Pixels between those that are sampled first in a limited time. */
enum { COARSEST = 64 };

/* The middles of every stride-th pixel of every stride-th row, and all corners, where they are
 * wanted and not known yet; stops when it is late, if it may. */
void first_middles(struct frame *f, uint32_t stride, bool may_stop);
void first_corners(struct frame *f);
/* What these say of the errors of pixels whose middles are wanted. */
void first_errors(struct frame *f);

/* The first samples of a pixel, in the order of cubature_begin(). */
struct first {
    struct vec3 sample[CUBATURE_FIRST];
};
/* false when they are not all known. */
bool first_of_pixel(const struct frame *f, uint32_t x, uint32_t y, struct first *first);
/* What stands for such a pixel: the middle of its block in the finest stride that is known, or
 * black. */
struct vec3 first_nearby(const struct frame *f, uint32_t x, uint32_t y);
struct estimate first_estimate(const struct frame *f, const struct first *first);

/* ---- refine.c ---- */

/* The standard errors of an estimate as the picture stores it, and the largest of them. */
struct vec3 stored_errors(const struct frame *f, const struct estimate *e);
double stored_error(const struct frame *f, const struct estimate *e);

/* Brings the errors of the pixels of tile order[item] down to the target. */
void refine_tile(void *frame, size_t item, unsigned worker);
void refiner_free(struct refiner *r);

#endif
