/* compare PICTURE REFERENCE: how many pixels agree.
 *
 * Prints `SHARE MAXIMUM X Y`: the percentage of pixels within 2/255 of the reference in every
 * channel, the largest difference of a channel, and the pixel that has it.  A picture of a k-th of
 * the reference's size is compared with every k-th pixel, counted from the bottom left. */
#include "config.h"

#include "base/file.h"
#include "image/picture.h"

#include <stdio.h>
#include <stdlib.h>

enum { TOLERANCE = 2 };

static struct picture *load(const char *path)
{
    char *data, reason[256];
    size_t n;
    const char *problem = file_read(path, &data, &n);
    if (problem) {
        fprintf(stderr, "compare: %s: %s\n", path, problem);
        exit(3);
    }
    struct picture *p = picture_decode(data, n, reason);
    free(data);
    if (!p) {
        fprintf(stderr, "compare: %s: %s\n", path, reason);
        exit(3);
    }
    return p;
}

/* The largest difference of a channel at pixel (x, y from the bottom) of p. */
static int difference(const struct picture *p, const struct picture *reference, uint32_t k,
                      uint32_t x, uint32_t y)
{
    const uint8_t *a = p->bytes + 3 * ((size_t)(p->height - 1 - y) * p->width + x);
    const uint8_t *b =
        reference->bytes + 3 * ((size_t)(reference->height - 1 - k * y) * reference->width + k * x);
    int most = 0;
    for (int c = 0; c < 3; c++)
        most = abs(a[c] - b[c]) > most ? abs(a[c] - b[c]) : most;
    return most;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fputs("usage: compare PICTURE REFERENCE\n", stderr);
        return 2;
    }
    struct picture *p = load(argv[1]), *reference = load(argv[2]);
    uint32_t k = reference->width / p->width;
    if (k == 0 || (uint64_t)k * p->width != reference->width ||
        (reference->height + k - 1) / k != p->height) {
        fprintf(stderr, "compare: %ux%u is no part of %ux%u\n", p->width, p->height,
                reference->width, reference->height);
        return 2;
    }
    size_t within = 0;
    int most = 0;
    uint32_t at_x = 0, at_y = 0;
    for (uint32_t y = 0; y < p->height; y++) {
        for (uint32_t x = 0; x < p->width; x++) {
            int d = difference(p, reference, k, x, y);
            within += d <= TOLERANCE;
            if (d > most) {
                most = d;
                at_x = x;
                at_y = p->height - 1 - y;
            }
        }
    }
    double pixels = (double)p->width * p->height;
    /* rounded down, so that a printed 99.900 has been reached */
    printf("%.3f %d %u %u\n", (double)(size_t)((double)within / pixels * 1e5) / 1e3, most, at_x,
           at_y);
    picture_free(p);
    picture_free(reference);
    return 0;
}
