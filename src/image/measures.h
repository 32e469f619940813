/* How far two pictures are apart, in numbers and as a picture. */
#ifndef WRT_IMAGE_MEASURES_H
#define WRT_IMAGE_MEASURES_H

#include "image/picture.h"

/* The difference of a pixel is the largest of its three channels; bytes and words count from 0 to
 * 1, floats as they are.  What is no number differs by infinity from all that is. */
enum measure {
    MEASURE_MAX,   /* the largest difference of a pixel */
    MEASURE_RMSE,  /* over all channels: root of the mean square, */
    MEASURE_MAE,   /* mean, */
    MEASURE_PSNR,  /* -20 log10 RMSE; infinite for equal pictures */
    MEASURE_P999,  /* what 99.9 % of the pixels do not exceed */
    MEASURE_ABOVE, /* per cent of the pixels that differ by more than 1/255 */
    MEASURE_FLIP,  /* mean of flip.h */
    MEASURES
};

/* As they are written and read: max, rmse, mae, psnr, p99.9, above, flip. */
extern const char *const measure_names[MEASURES];

struct measures {
    double at[MEASURES];
    uint32_t x, y; /* the first pixel that differs by MEASURE_MAX */
};

/* The pictures have one size and both hold floats or neither does.  `flip` has room for a float a
 * pixel and takes flip_map. */
void measure_pictures(const struct picture *a, const struct picture *b, unsigned threads,
                      float *flip, struct measures *out);

/* A picture of floats: each channel's difference, as it is. */
struct picture *difference_floats(const struct picture *a, const struct picture *b);

/* A picture of bytes: values from 0 to 1 as colours from black by purple and orange to pale yellow,
 * which get lighter all the way. */
struct picture *difference_heat(const float *values, uint32_t width, uint32_t height);

#endif
