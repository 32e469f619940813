/* Differences of pictures: against numbers worked out by hand, and FLIP against its formulas
 * written down plainly: whole filters over whole pictures, in doubles. */
#include "config.h"

#include "base/mem.h"
#include "image/flip.h"
#include "image/measures.h"
#include "math/rng.h"
#include "math/srgb.h"

#include "unit.h"

#include <math.h>
#include <stdlib.h>

/* Twice the size of a tile of flip.c and some more, across and down. */
enum { WIDTH = 71, HEIGHT = 67, PIXELS = WIDTH * HEIGHT };

static struct picture *plain_picture(uint32_t width, uint32_t height, uint8_t r, uint8_t g,
                                     uint8_t b)
{
    struct picture *p = picture_new(width, height, PICTURE_BYTES);
    for (size_t i = 0; i < (size_t)width * height; i++) {
        p->bytes[3 * i] = r;
        p->bytes[3 * i + 1] = g;
        p->bytes[3 * i + 2] = b;
    }
    return p;
}

/* Patches of colour with noise on them. */
static struct picture *random_picture(uint64_t seed)
{
    struct picture *p = picture_new(WIDTH, HEIGHT, PICTURE_BYTES);
    for (size_t i = 0; i < 3 * PIXELS; i++) {
        size_t x = i / 3 % WIDTH, y = i / 3 / WIDTH;
        double patch = rng_uniform(seed, x / 12 + 100 * (y / 9), i % 3, 0);
        p->bytes[i] = (uint8_t)(200 * patch + 55 * rng_uniform(seed, i, 0, 1));
    }
    return p;
}

static double flip_of(const struct picture *a, const struct picture *b, float *map)
{
    struct measures m;
    measure_pictures(a, b, 2, map, &m);
    return m.at[MEASURE_FLIP];
}

/* ---- FLIP by its formulas ----------------------------------------------------------------------
 */

static const double PPD = 67.02064327658226; /* 3840 pi / 180 */

struct plain {
    double at[PIXELS][3];
};

/* X, Y, Z of the primaries of sRGB at full strength, and of their white. */
static const double red[3] = {0.4124, 0.2126, 0.0193}, green[3] = {0.3576, 0.7152, 0.1192},
                    blue[3] = {0.1805, 0.0722, 0.9505}, white[3] = {0.9505, 1, 1.089};

static void to_xyz(const double rgb[3], double xyz[3])
{
    for (int i = 0; i < 3; i++)
        xyz[i] = red[i] * rgb[0] + green[i] * rgb[1] + blue[i] * rgb[2];
}

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
           c[0] * (a[1] * b[2] - a[2] * b[1]);
}

static void to_rgb(const double xyz[3], double rgb[3])
{
    double whole = determinant(red, green, blue);
    rgb[0] = determinant(xyz, green, blue) / whole;
    rgb[1] = determinant(red, xyz, blue) / whole;
    rgb[2] = determinant(red, green, xyz) / whole;
}

static void to_ycxcz(const double xyz[3], double o[3])
{
    o[0] = 116 * xyz[1] / white[1] - 16;
    o[1] = 500 * (xyz[0] / white[0] - xyz[1] / white[1]);
    o[2] = 200 * (xyz[1] / white[1] - xyz[2] / white[2]);
}

static void from_ycxcz(const double o[3], double xyz[3])
{
    double y = (o[0] + 16) / 116;
    xyz[1] = y * white[1];
    xyz[0] = (y + o[1] / 500) * white[0];
    xyz[2] = (y - o[2] / 200) * white[2];
}

static double lab_root(double t)
{
    return t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

static void to_hunt(const double rgb[3], double lab[3])
{
    double xyz[3], f[3];
    to_xyz(rgb, xyz);
    for (int i = 0; i < 3; i++)
        f[i] = lab_root(xyz[i] / white[i]);
    lab[0] = 116 * f[1] - 16;
    lab[1] = 0.01 * lab[0] * 500 * (f[0] - f[1]);
    lab[2] = 0.01 * lab[0] * 200 * (f[1] - f[2]);
}

static double hyab(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

/* Of the distance in pixels, for a channel of YCxCz. */
static double sensitivity(int channel, int x, int y)
{
    static const double a1[] = {1, 1, 34.1}, b1[] = {0.0047, 0.0053, 0.04};
    double d2 = (x * x + y * y) / (PPD * PPD);
    double s = a1[channel] * sqrt(M_PI / b1[channel]) * exp(-M_PI * M_PI * d2 / b1[channel]);
    if (channel == 2)
        s += 13.5 * sqrt(M_PI / 0.025) * exp(-M_PI * M_PI * d2 / 0.025);
    return s;
}

/* Edges when bend is false, points otherwise; along x. */
static double feature(bool bend, int x, int y)
{
    const double sd = 0.5 * 0.082 * PPD;
    double g = exp(-(x * x + y * y) / (2 * sd * sd));
    return bend ? (x * x / (sd * sd) - 1) * g : -x * g;
}

static size_t clamped(int at, int end)
{
    return (size_t)(at < 0 ? 0 : at < end ? at : end - 1);
}

static double pixel_of(const struct plain *p, int x, int y, int channel)
{
    return p->at[clamped(y, HEIGHT) * WIDTH + clamped(x, WIDTH)][channel];
}

static double see(const struct plain *p, int x, int y, int channel)
{
    double sum = 0, weights = 0;
    for (int v = -10; v <= 10; v++) {
        for (int u = -10; u <= 10; u++) {
            sum += sensitivity(channel, u, v) * pixel_of(p, x + u, y + v, channel);
            weights += sensitivity(channel, u, v);
        }
    }
    return sum / weights;
}

static double detect(const struct plain *p, int x, int y, bool bend)
{
    double above = 0, along[2][2] = {{0}};
    for (int v = -9; v <= 9; v++) {
        for (int u = -9; u <= 9; u++) {
            double w = feature(bend, u, v),
                   luminance[2] = {pixel_of(p, x + u, y + v, 0), pixel_of(p, x + v, y + u, 0)};
            above += fmax(w, 0);
            for (int i = 0; i < 2; i++)
                along[i][w > 0] += w * (luminance[i] + 16) / 116;
        }
    }
    double below = 0;
    for (int v = -9; v <= 9; v++)
        for (int u = -9; u <= 9; u++)
            below -= fmin(feature(bend, u, v), 0);
    return hypot(along[0][1] / above + along[0][0] / below,
                 along[1][1] / above + along[1][0] / below);
}

static void load_plain(const struct picture *p, struct plain *out)
{
    for (size_t i = 0; i < PIXELS; i++) {
        double rgb[3], xyz[3];
        for (size_t c = 0; c < 3; c++)
            rgb[c] = srgb_decode(p->bytes[3 * i + c] / 255.0);
        to_xyz(rgb, xyz);
        to_ycxcz(xyz, out->at[i]);
    }
}

static void seen_lab(const struct plain *p, int x, int y, double lab[3])
{
    double o[3], xyz[3], rgb[3];
    for (int c = 0; c < 3; c++)
        o[c] = see(p, x, y, c);
    from_ycxcz(o, xyz);
    to_rgb(xyz, rgb);
    for (int c = 0; c < 3; c++)
        rgb[c] = fmin(fmax(rgb[c], 0), 1);
    to_hunt(rgb, lab);
}

static double flip_plainly(const struct plain *a, const struct plain *b, int x, int y)
{
    double lab_a[3], lab_b[3], lab_green[3], lab_blue[3];
    seen_lab(a, x, y, lab_a);
    seen_lab(b, x, y, lab_b);
    to_hunt((const double[]){0, 1, 0}, lab_green);
    to_hunt((const double[]){0, 0, 1}, lab_blue);
    double most = pow(hyab(lab_green, lab_blue), 0.7), d = pow(hyab(lab_a, lab_b), 0.7);
    double colour = d < 0.4 * most ? 0.95 * d / (0.4 * most)
                                   : 0.95 + 0.05 * (d - 0.4 * most) / (most - 0.4 * most);
    double edges = fabs(detect(a, x, y, false) - detect(b, x, y, false));
    double points = fabs(detect(a, x, y, true) - detect(b, x, y, true));
    return pow(colour, 1 - pow(fmax(edges, points) / sqrt(2), 0.5));
}

/* The matrices differ in the fifth digit: four decimals for these, more for those of flip.c. */
START_TEST(flip_is_its_formulas)
{
    struct picture *p = random_picture(1), *q = random_picture(2);
    struct plain *a = mem_alloc(1, sizeof *a), *b = mem_alloc(1, sizeof *b);
    float map[PIXELS];
    /* equal in a part, so that small differences occur beside its border */
    memcpy(q->bytes, p->bytes, (size_t)3 * WIDTH * 30);
    load_plain(p, a);
    load_plain(q, b);
    flip_map(p, q, 2, map);
    for (int y = 0; y < HEIGHT; y += y < HEIGHT - 3 ? 3 : 1) {
        for (int x = y % 5; x < WIDTH; x += 5) {
            double wanted = flip_plainly(a, b, x, y), got = (double)map[y * WIDTH + x];
            ck_assert_msg(fabs(got - wanted) < 2e-4, "%d,%d: %.6f, not %.6f", x, y, got, wanted);
            ck_assert(got >= 0 && got <= 1);
        }
    }
    picture_free(p);
    picture_free(q);
    free(a);
    free(b);
}
END_TEST

/* ---- FLIP of simple pictures -------------------------------------------------------------------
 */

/* Pictures of one colour have no features, and every filter keeps them: black and white are 100
 * apart in lightness alone, green and blue are the colours farthest apart. */
static const struct {
    uint8_t a[3], b[3];
    double flip;
} colours[] = {
    {{0, 0, 0}, {0, 0, 0}, 0},
    {{17, 200, 99}, {17, 200, 99}, 0},
    {{0, 0, 0}, {255, 255, 255}, 0.967379},
    {{0, 255, 0}, {0, 0, 255}, 1},
};

START_TEST(flip_of_single_colours)
{
    const uint8_t *a = colours[_i].a, *b = colours[_i].b;
    struct picture *p = plain_picture(WIDTH, HEIGHT, a[0], a[1], a[2]);
    struct picture *q = plain_picture(WIDTH, HEIGHT, b[0], b[1], b[2]);
    float map[PIXELS];
    ck_assert_double_eq_tol(flip_of(p, q, map), colours[_i].flip, 2e-5);
    ck_assert_double_eq_tol(flip_of(q, p, map), colours[_i].flip, 2e-5);
    picture_free(p);
    picture_free(q);
}
END_TEST

/* Half of one picture is white.  Where the filters do not reach its edge it is as in pictures of
 * one colour; at the edge the detector sees one of height 1: then f = sqrt(1/sqrt 2). */
START_TEST(flip_of_an_edge)
{
    struct picture *p = plain_picture(WIDTH, HEIGHT, 0, 0, 0);
    struct picture *q = plain_picture(WIDTH, HEIGHT, 0, 0, 0);
    float map[PIXELS];
    for (size_t y = 0; y < HEIGHT; y++)
        memset(q->bytes + 3 * (y * WIDTH + 40), 255, (size_t)3 * (WIDTH - 40));
    flip_map(p, q, 1, map);
    for (size_t y = 0; y < HEIGHT; y++) {
        const float *row = map + y * WIDTH;
        ck_assert(row[0] == 0 && row[29] == 0 && row[36] > 0);
        ck_assert_double_eq_tol((double)row[50], 0.967379, 2e-5);
        ck_assert(row[40] > row[50] && row[40] <= 1);
    }
    picture_free(p);
    picture_free(q);
}
END_TEST

START_TEST(flip_is_symmetric_and_the_same_on_any_thread)
{
    struct picture *p = random_picture(3), *q = random_picture(4);
    float once[PIXELS], again[PIXELS];
    flip_map(p, q, 1, once);
    flip_map(q, p, 3, again);
    ck_assert_mem_eq(once, again, sizeof once);
    flip_map(p, p, 1, once);
    for (size_t i = 0; i < PIXELS; i++)
        ck_assert(once[i] == 0);
    picture_free(p);
    picture_free(q);
}
END_TEST

/* Floats are light: as bytes are after decoding; what lies outside of [0, 1] is cut. */
START_TEST(flip_of_floats)
{
    struct picture *p = random_picture(5), *q = random_picture(6), *pf, *qf;
    float bytes[PIXELS], floats[PIXELS];
    pf = picture_new(WIDTH, HEIGHT, PICTURE_FLOATS);
    qf = picture_new(WIDTH, HEIGHT, PICTURE_FLOATS);
    p->bytes[0] = 0;
    q->bytes[0] = 255;
    for (size_t i = 0; i < 3 * PIXELS; i++) {
        pf->floats[i] = (float)srgb_decode(p->bytes[i] / 255.0);
        qf->floats[i] = (float)srgb_decode(q->bytes[i] / 255.0);
    }
    pf->floats[0] = -7;
    qf->floats[0] = INFINITY;
    flip_map(p, q, 1, bytes);
    flip_map(pf, qf, 1, floats);
    for (size_t i = 0; i < PIXELS; i++)
        ck_assert_double_eq_tol((double)bytes[i], (double)floats[i], 1e-5);
    pf->floats[0] = NAN;
    flip_map(pf, qf, 1, floats);
    ck_assert_double_eq_tol((double)bytes[0], (double)floats[0], 1e-5);
    picture_free(p);
    picture_free(q);
    picture_free(pf);
    picture_free(qf);
}
END_TEST

/* ---- the other measures ------------------------------------------------------------------------
 */

START_TEST(measures_by_hand)
{
    struct picture *a = plain_picture(2, 1, 10, 20, 30), *b = plain_picture(2, 1, 10, 20, 30);
    struct measures m;
    float map[2];
    b->bytes[3] = 13; /* the second pixel: 3, 0, -4 */
    b->bytes[5] = 26;
    measure_pictures(a, b, 1, map, &m);
    ck_assert_double_eq_tol(m.at[MEASURE_MAX], 4 / 255.0, 1e-15);
    ck_assert(m.x == 1 && m.y == 0);
    ck_assert_double_eq_tol(m.at[MEASURE_RMSE], sqrt(25 / 6.0) / 255, 1e-15);
    ck_assert_double_eq_tol(m.at[MEASURE_MAE], 7 / 6.0 / 255, 1e-15);
    ck_assert_double_eq_tol(m.at[MEASURE_PSNR], 20 * log10(255 / sqrt(25 / 6.0)), 1e-12);
    ck_assert_double_eq_tol(m.at[MEASURE_P999], 4 / 255.0, 1e-8);
    ck_assert_double_eq(m.at[MEASURE_ABOVE], 50);
    measure_pictures(a, a, 1, map, &m);
    for (int i = 0; i < MEASURES; i++)
        ck_assert(i == MEASURE_PSNR ? m.at[i] == INFINITY : m.at[i] == 0);
    picture_free(a);
    picture_free(b);
}
END_TEST

/* A step of one byte is not above 1/255, whichever; one of two is. */
START_TEST(steps_of_bytes)
{
    struct picture *a = picture_new(253, 1, PICTURE_BYTES), *b = picture_new(253, 1, PICTURE_BYTES);
    struct measures m;
    float map[253];
    for (uint8_t i = 0; i < 253; i++) {
        a->bytes[3 * i] = i;
        b->bytes[3 * i] = i + 1;
    }
    measure_pictures(a, b, 1, map, &m);
    ck_assert(m.at[MEASURE_ABOVE] == 0 && m.at[MEASURE_MAX] == 1 / 255.0);
    for (uint8_t i = 0; i < 253; i++)
        b->bytes[3 * i]++;
    measure_pictures(a, b, 1, map, &m);
    ck_assert_double_eq(m.at[MEASURE_ABOVE], 100);
    picture_free(a);
    picture_free(b);
}
END_TEST

/* Of `pixels`, `far` differ by 0.5 and the others by 0.25 or, as floats, a bit more. */
static const struct {
    uint32_t pixels, far;
    bool is_far;
} percentiles[] = {
    {999, 1, true},  {1000, 1, false}, {1000, 2, true},
    {1999, 2, true}, {2000, 2, false}, {1, 0, false},
};

START_TEST(percentile_leaves_out_one_in_a_thousand)
{
    uint32_t n = percentiles[_i].pixels;
    struct picture *a = picture_new(n, 1, PICTURE_FLOATS), *b = picture_new(n, 1, PICTURE_FLOATS);
    float near = nextafterf(0.25F, 1);
    for (uint32_t i = 0; i < n; i++)
        b->floats[3 * i + i % 3] = i < percentiles[_i].far ? -0.5F : i % 2 ? 0.25F : near;
    struct measures m;
    float *map = mem_alloc(n, sizeof *map);
    measure_pictures(a, b, 1, map, &m);
    ck_assert_double_eq(m.at[MEASURE_P999], percentiles[_i].is_far ? 0.5 : (double)near);
    free(map);
    picture_free(a);
    picture_free(b);
}
END_TEST

START_TEST(floats_that_are_no_numbers)
{
    static const float left[] = {NAN, INFINITY, -INFINITY, NAN, INFINITY, 0, -0.0F},
                       right[] = {NAN, INFINITY, -INFINITY, 1, 1, INFINITY, 0};
    static const bool differs[] = {false, false, false, true, true, true, false};
    for (int i = 0; i < 7; i++) {
        struct picture *a = picture_new(1, 1, PICTURE_FLOATS), *b = picture_new(1, 1, PICTURE_FLOATS);
        struct measures m;
        float map;
        a->floats[1] = left[i];
        b->floats[1] = right[i];
        measure_pictures(a, b, 1, &map, &m);
        for (int k = 0; k <= MEASURE_P999; k++)
            if (k != MEASURE_PSNR)
                ck_assert_msg(m.at[k] == (differs[i] ? INFINITY : 0), "%d %d: %g", i, k, m.at[k]);
        picture_free(a);
        picture_free(b);
    }
}
END_TEST

START_TEST(differences_as_pictures)
{
    struct picture *a = plain_picture(1, 1, 10, 20, 30), *b = plain_picture(1, 1, 10, 71, 13);
    struct picture *d = difference_floats(a, b);
    ck_assert(d->floats[0] == 0 && d->floats[1] == 0.2F && d->floats[2] == (float)(17 / 255.0));
    static const float values[] = {0, 0.0625F, 0.5F, 1};
    struct picture *heat = difference_heat(values, 2, 2);
    static const uint8_t wanted[] = {0, 0, 4, 14, 8, 36, 181, 54, 122, 252, 253, 191};
    ck_assert_mem_eq(heat->bytes, wanted, sizeof wanted);
    picture_free(a);
    picture_free(b);
    picture_free(d);
    picture_free(heat);
}
END_TEST

Suite *measures_suite(void)
{
    Suite *s = suite_create("measures");
    TCase *c = tcase_create("measures");
    enum { COLOURS = sizeof colours / sizeof *colours };
    enum { PERCENTILES = sizeof percentiles / sizeof *percentiles };
    tcase_add_test(c, flip_is_its_formulas);
    tcase_add_loop_test(c, flip_of_single_colours, 0, COLOURS);
    tcase_add_test(c, flip_of_an_edge);
    tcase_add_test(c, flip_is_symmetric_and_the_same_on_any_thread);
    tcase_add_test(c, flip_of_floats);
    tcase_add_test(c, measures_by_hand);
    tcase_add_test(c, steps_of_bytes);
    tcase_add_loop_test(c, percentile_leaves_out_one_in_a_thousand, 0, SANITIZED(1, PERCENTILES));
    tcase_add_test(c, floats_that_are_no_numbers);
    tcase_add_test(c, differences_as_pictures);
    suite_add_tcase(s, c);
    return s;
}
