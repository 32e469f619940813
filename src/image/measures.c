#include "config.h"

#include "image/measures.h"

#include "base/mem.h"
#include "image/flip.h"

#include <math.h>
#include <stdlib.h>

const char *const measure_names[MEASURES] = {
    [MEASURE_MAX] = "max",   [MEASURE_RMSE] = "rmse",  [MEASURE_MAE] = "mae",
    [MEASURE_PSNR] = "psnr", [MEASURE_P999] = "p99.9", [MEASURE_ABOVE] = "above",
    [MEASURE_FLIP] = "flip",
};

/* What is stored of a channel, in 16 bits. */
static int word_at(const struct picture *p, size_t at)
{
    return p->words ? p->words[at] : 0x101 * p->bytes[at];
}

/* Bytes and words are subtracted as whole numbers: a step of one is 1/255 or 1/65535, not more. */
static double channel_difference(const struct picture *a, const struct picture *b, size_t at)
{
    if (a->bytes && b->bytes)
        return abs(a->bytes[at] - b->bytes[at]) / 255.0;
    if (!a->floats)
        return abs(word_at(a, at) - word_at(b, at)) / 65535.0;
    double x = (double)a->floats[at], y = (double)b->floats[at];
    if (x == y || (isnan(x) && isnan(y)))
        return 0;
    double d = fabs(x - y);
    return isnan(d) ? INFINITY : d;
}

static double pixel_difference(const struct picture *a, const struct picture *b, size_t pixel)
{
    double d = 0;
    for (size_t c = 0; c < 3; c++)
        d = fmax(d, channel_difference(a, b, 3 * pixel + c));
    return d;
}

/* Floats from 0 up are in the order of their bits. */
static uint32_t bits_of(double d)
{
    float f = (float)d;
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    return bits;
}

static double value_of(uint32_t bits)
{
    float f;
    memcpy(&f, &bits, sizeof f);
    return (double)f;
}

/* Where the count reaches `rank`, which becomes what is left of it there. */
static uint32_t find_rank(const size_t counts[1 << 16], size_t *rank)
{
    uint32_t i = 0;
    for (; counts[i] < *rank; i++)
        *rank -= counts[i];
    return i;
}

/* What 99.9 % of the pixels do not exceed, as a float: counted by the upper half of the bits, then
 * by the lower half of those that share the upper one. */
static double most_of_them(const struct picture *a, const struct picture *b)
{
    size_t pixels = (size_t)a->width * a->height, rank = pixels - pixels / 1000;
    size_t *counts = mem_zalloc(1 << 16, sizeof *counts);
    for (size_t i = 0; i < pixels; i++)
        counts[bits_of(pixel_difference(a, b, i)) >> 16]++;
    uint32_t upper = find_rank(counts, &rank);
    memset(counts, 0, (1 << 16) * sizeof *counts);
    for (size_t i = 0; i < pixels; i++) {
        uint32_t bits = bits_of(pixel_difference(a, b, i));
        if (bits >> 16 == upper)
            counts[bits & 0xffff]++;
    }
    uint32_t lower = find_rank(counts, &rank);
    free(counts);
    return value_of(upper << 16 | lower);
}

/* Row by row, so that small terms are not lost in large sums. */
static double mean_of(const float *values, uint32_t width, uint32_t height)
{
    double sum = 0;
    for (size_t y = 0; y < height; y++) {
        double row = 0;
        for (size_t x = 0; x < width; x++)
            row += (double)values[y * width + x];
        sum += row;
    }
    return sum / width / height;
}

static void measure_row(const struct picture *a, const struct picture *b, uint32_t y,
                        struct measures *m)
{
    double sum = 0, squares = 0;
    for (uint32_t x = 0; x < a->width; x++) {
        size_t pixel = (size_t)y * a->width + x;
        double largest = 0;
        for (size_t c = 0; c < 3; c++) {
            double d = channel_difference(a, b, 3 * pixel + c);
            largest = fmax(largest, d);
            sum += d;
            squares += d * d;
        }
        if (largest > m->at[MEASURE_MAX]) {
            m->at[MEASURE_MAX] = largest;
            m->x = x;
            m->y = y;
        }
        m->at[MEASURE_ABOVE] += largest > 1 / 255.0;
    }
    m->at[MEASURE_MAE] += sum;
    m->at[MEASURE_RMSE] += squares;
}

void measure_pictures(const struct picture *a, const struct picture *b, unsigned threads,
                      float *flip, struct measures *m)
{
    double pixels = (double)a->width * a->height;
    *m = (struct measures){0};
    for (uint32_t y = 0; y < a->height; y++)
        measure_row(a, b, y, m);
    m->at[MEASURE_MAE] /= 3 * pixels;
    m->at[MEASURE_RMSE] = sqrt(m->at[MEASURE_RMSE] / (3 * pixels));
    m->at[MEASURE_PSNR] = -20 * log10(m->at[MEASURE_RMSE]);
    m->at[MEASURE_ABOVE] *= 100 / pixels;
    m->at[MEASURE_P999] = fmin(most_of_them(a, b), m->at[MEASURE_MAX]);
    flip_map(a, b, threads, flip);
    m->at[MEASURE_FLIP] = mean_of(flip, a->width, a->height);
}

struct picture *difference_floats(const struct picture *a, const struct picture *b)
{
    struct picture *p = picture_new(a->width, a->height, PICTURE_FLOATS);
    for (size_t i = 0, n = (size_t)3 * a->width * a->height; i < n; i++)
        p->floats[i] = (float)channel_difference(a, b, i);
    return p;
}

/* Nine colours of the map magma by Smith and van der Walt, straight lines between them. */
struct picture *difference_heat(const float *values, uint32_t width, uint32_t height)
{
    static const uint8_t stops[][3] = {{0, 0, 4},      {28, 16, 68},    {79, 18, 123},
                                       {129, 37, 129}, {181, 54, 122},  {229, 80, 100},
                                       {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};
    enum { STEPS = sizeof stops / sizeof *stops - 1 };
    struct picture *p = picture_new(width, height, PICTURE_BYTES);
    for (size_t i = 0, n = (size_t)width * height; i < n; i++) {
        double at = (double)values[i] * STEPS;
        int stop = at < STEPS ? (int)at : STEPS - 1;
        for (size_t c = 0; c < 3; c++) {
            double low = stops[stop][c], high = stops[stop + 1][c];
            p->bytes[3 * i + c] = (uint8_t)(low + (high - low) * (at - stop) + 0.5);
        }
    }
    return p;
}
