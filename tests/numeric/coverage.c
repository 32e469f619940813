/* coverage MASK DEPTH | coverage PICTURE PICTURE --colours
 *
 * How alike two programs see a scene.  MASK shows what another one hits in white; DEPTH is wrt's
 * picture of depths.  In classic it is twice as wide and high, so that every other pixel was
 * sampled in the middle of one of MASK's; in modern all are.  Prints the percentage of pixels that
 * agree and of those that hit something. With --colours the pictures have one size, and their root
 * mean square difference is printed. */
#include "config.h"

#include "base/file.h"
#include "image/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct picture *load(const char *path)
{
    char *data, reason[256];
    size_t n;
    const char *problem = file_read(path, &data, &n);
    struct picture *p = problem ? NULL : picture_decode(data, n, reason);
    if (!p) {
        fprintf(stderr, "coverage: %s: %s\n", path, problem ? problem : reason);
        exit(3);
    }
    free(data);
    return p;
}

static void need_size(const struct picture *p, uint32_t width, uint32_t height)
{
    if (p->width == width && p->height == height)
        return;
    fprintf(stderr, "coverage: %ux%u is not %ux%u\n", p->width, p->height, width, height);
    exit(2);
}

/* Classic samples pixels at their lower left corner, and row 0 is the top. */
static size_t middle_of(const struct picture *depth, uint32_t x, uint32_t y, bool doubled)
{
    return doubled ? (size_t)(2 * y) * depth->width + 2 * x + 1 : (size_t)y * depth->width + x;
}

static void compare_masks(const struct picture *mask, const struct picture *depth)
{
    size_t alike = 0, covered = 0;
    double pixels = (double)mask->width * mask->height;
    bool doubled = depth->width != mask->width;
    need_size(depth, (doubled ? 2 : 1) * mask->width, (doubled ? 2 : 1) * mask->height);
    for (uint32_t y = 0; y < mask->height; y++)
        for (uint32_t x = 0; x < mask->width; x++) {
            bool theirs = mask->bytes[3 * ((size_t)y * mask->width + x)] > 127;
            bool ours = depth->bytes[3 * middle_of(depth, x, y, doubled)] > 0;
            alike += theirs == ours;
            covered += ours;
        }
    printf("%.2f %.2f\n", 100 * (double)alike / pixels, 100 * (double)covered / pixels);
}

static void compare_colours(const struct picture *a, const struct picture *b)
{
    size_t channels = 3 * (size_t)a->width * a->height;
    double sum = 0;
    need_size(b, a->width, a->height);
    for (size_t i = 0; i < channels; i++)
        sum += (a->bytes[i] - b->bytes[i]) * (double)(a->bytes[i] - b->bytes[i]);
    printf("%.4f\n", sqrt(sum / (double)channels) / 255);
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fputs("usage: coverage MASK DEPTH | coverage PICTURE PICTURE --colours\n", stderr);
        return 2;
    }
    struct picture *a = load(argv[1]), *b = load(argv[2]);
    (argc > 3 && strcmp(argv[3], "--colours") == 0 ? compare_colours : compare_masks)(a, b);
    picture_free(a);
    picture_free(b);
    return 0;
}
