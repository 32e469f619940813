#include "config.h"

#include "image/flip.h"

#include "base/mem.h"
#include "base/thread.h"
#include "math/srgb.h"

#include <math.h>
#include <stdlib.h>

static const double PIXELS_PER_DEGREE = 3840 * PI / 180;

/* A tile is filtered with what lies REACH pixels around it: the radius of the widest filter, three
 * standard deviations of its wider Gaussian (section 4.1.1). */
enum { TILE = 64, REACH = 10, TAPS = 2 * REACH + 1, PADDED = TILE + 2 * REACH };

/* ---- colours ---- */

/* Linear sRGB to X, Y, Z with white at (1, 1, 1), and back: IEC 61966-2-1, from the chromaticities
 * of its primaries and of D65. */
static const double xyz_of_rgb[3][3] = {{0.433887345566, 0.376224009137, 0.189888645297},
                                        {0.212639005872, 0.715168678768, 0.072192315360},
                                        {0.017750040071, 0.109447620855, 0.872802339074}};
static const double rgb_of_xyz[3][3] = {{3.080399090679, -1.537383177570, -0.543015913109},
                                        {-0.921223358860, 1.875967501508, 0.045255857352},
                                        {0.052873938970, -0.203976958889, 1.151103019919}};

static struct vec3 apply(const double m[3][3], struct vec3 v)
{
    return vec3(m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
                m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z);
}

/* The opponent colours of section 4.1.1: luminance, red against green, yellow against blue.  The
 * factors and the offset of YCxCz are left out: the filters are linear and keep constants. */
static struct vec3 opponent_of_xyz(struct vec3 v)
{
    return vec3(v.y, v.x - v.y, v.y - v.z);
}

static struct vec3 xyz_of_opponent(struct vec3 o)
{
    return vec3(o.x + o.y, o.x, o.x - o.z);
}

/* False comparisons make 0 of what is no number. */
static double clamp01(double c)
{
    return c > 0 ? fmin(c, 1) : 0;
}

static double lab_curve(double t)
{
    const double delta = 6.0 / 29;
    return t > delta * delta * delta ? cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

/* CIELAB, in which dark colours are less colourful: the Hunt effect (section 4.1.2). */
static struct vec3 hunt_lab(struct vec3 rgb)
{
    struct vec3 v = apply(xyz_of_rgb, rgb);
    double x = lab_curve(v.x), y = lab_curve(v.y), z = lab_curve(v.z);
    double lightness = 116 * y - 16;
    return vec3(lightness, 5 * lightness * (x - y), 2 * lightness * (y - z));
}

/* hypot without its care for numbers that have no place in pictures. */
static double length2(double x, double y)
{
    return sqrt(x * x + y * y);
}

/* HyAB, compressed by the exponent q_c (section 4.1.3). */
static double colour_distance(struct vec3 a, struct vec3 b)
{
    return pow(fabs(a.x - b.x) + length2(a.y - b.y, a.z - b.z), 0.7);
}

/* ---- filters ---- */

/* One-dimensional: every filter of FLIP is a product of two of them, or a sum of two products. */
enum kernel {
    LIGHT,
    RED_GREEN,
    BLUE_YELLOW_WIDE,
    BLUE_YELLOW_NARROW,
    SMOOTH,
    SLOPE,
    BEND,
    KERNELS
};

/* What is filtered, and what comes of it; the first three are both. */
enum plane {
    PLANE_Y,
    PLANE_RG,
    PLANE_BY,
    PLANES_IN,
    EDGE_X = PLANES_IN,
    EDGE_Y,
    POINT_X,
    POINT_Y,
    PLANES
};

static const enum plane filtered_along_rows[KERNELS] = {
    [LIGHT] = PLANE_Y,
    [RED_GREEN] = PLANE_RG,
    [BLUE_YELLOW_WIDE] = PLANE_BY,
    [BLUE_YELLOW_NARROW] = PLANE_BY,
    [SMOOTH] = PLANE_Y,
    [SLOPE] = PLANE_Y,
    [BEND] = PLANE_Y,
};

static const struct column_pass {
    enum kernel rows, columns;
    enum plane out;
} column_passes[] = {
    {LIGHT, LIGHT, PLANE_Y},
    {RED_GREEN, RED_GREEN, PLANE_RG},
    {BLUE_YELLOW_WIDE, BLUE_YELLOW_WIDE, PLANE_BY},
    {BLUE_YELLOW_NARROW, BLUE_YELLOW_NARROW, PLANE_BY},
    {SLOPE, SMOOTH, EDGE_X},
    {SMOOTH, SLOPE, EDGE_Y},
    {BEND, SMOOTH, POINT_X},
    {SMOOTH, BEND, POINT_Y},
};
enum { COLUMN_PASSES = sizeof column_passes / sizeof *column_passes };

/* The contrast sensitivity of the eye as Gaussians a sqrt(pi/b) exp(-(pi d)^2/b) of the distance d
 * in degrees (section 4.1.1), `count` of them in kernels that follow each other.  Half of
 * each weight goes to the rows, half to the columns; the whole filter sums to 1. */
static void make_sensitivity(double (*kernels)[TAPS], int count, const double a[], const double b[])
{
    double whole = 0;
    for (int k = 0; k < count; k++) {
        double sum = 0, weight = a[k] * sqrt(PI / b[k]);
        for (int i = 0; i < TAPS; i++) {
            double degrees = (i - REACH) / PIXELS_PER_DEGREE;
            kernels[k][i] = sqrt(weight) * exp(-PI * PI * degrees * degrees / b[k]);
            sum += kernels[k][i];
        }
        whole += sum * sum;
    }
    for (int k = 0; k < count; k++)
        for (int i = 0; i < TAPS; i++)
            kernels[k][i] /= sqrt(whole);
}

/* A Gaussian as wide as what the eye takes for an edge, 0.082 degrees, and its first two
 * derivatives, whose weights above and below 0 sum to 1 and -1 (section 4.2). */
static void make_features(double (*kernels)[TAPS])
{
    const double sd = 0.5 * 0.082 * PIXELS_PER_DEGREE;
    const int radius = (int)ceil(3 * sd);
    for (enum kernel k = SMOOTH; k <= BEND; k++) {
        double above = 0, below = 0;
        for (int x = -radius; x <= radius; x++) {
            double g = exp(-x * x / (2 * sd * sd));
            double w = k == SMOOTH ? g : k == SLOPE ? -x * g : (x * x / (sd * sd) - 1) * g;
            kernels[k][x + REACH] = w;
            *(w > 0 ? &above : &below) += fabs(w);
        }
        for (int i = 0; i < TAPS; i++)
            kernels[k][i] /= kernels[k][i] > 0 ? above : below > 0 ? below : 1;
    }
}

static void make_kernels(float out[KERNELS][TAPS])
{
    double kernels[KERNELS][TAPS] = {0};
    make_sensitivity(&kernels[LIGHT], 1, (const double[]){1}, (const double[]){0.0047});
    make_sensitivity(&kernels[RED_GREEN], 1, (const double[]){1}, (const double[]){0.0053});
    make_sensitivity(&kernels[BLUE_YELLOW_WIDE], 2, (const double[]){34.1, 13.5},
                     (const double[]){0.04, 0.025});
    make_features(kernels);
    for (int k = 0; k < KERNELS; k++)
        for (int i = 0; i < TAPS; i++)
            out[k][i] = (float)kernels[k][i];
}

/* Four floats side by side, anywhere in memory. */
typedef float four __attribute__((vector_size(16), aligned(4), may_alias));

/* Adds the weighted sums of TAPS values `stride` apart, from each of TILE places on; a few places
 * at a time, so that their sums stay in registers. */
static void add_weighted(const float *in, size_t stride, const float taps[TAPS], float *out)
{
    enum { FOURS = 4, STEP = 4 * FOURS };
    for (size_t i = 0; i < TILE; i += STEP) {
        four sums[FOURS] = {{0}}, *to = (four *)(out + i);
        for (size_t k = 0; k < TAPS; k++) {
            const four *from = (const four *)(in + k * stride + i);
            for (int lane = 0; lane < FOURS; lane++)
                sums[lane] += taps[k] * from[lane];
        }
        for (int lane = 0; lane < FOURS; lane++)
            to[lane] += sums[lane];
    }
}

/* ---- tiles ---- */

struct planes {
    float at[PLANES][TILE][TILE];
};

struct tile {
    float opponents[PLANES_IN][PADDED][PADDED];
    float rows[KERNELS][PADDED][TILE];
    struct planes filtered[2]; /* of both pictures */
};

struct job {
    const struct picture *pictures[2];
    float *map;
    size_t tiles_across;
    float kernels[KERNELS][TAPS];
    double light[256];    /* of a byte */
    double most;          /* the largest colour distance on a screen */
    struct tile *scratch; /* one for each thread */
};

static struct vec3 light_at(const struct job *j, const struct picture *p, size_t at)
{
    if (p->bytes)
        return vec3(j->light[p->bytes[at]], j->light[p->bytes[at + 1]], j->light[p->bytes[at + 2]]);
    if (p->words)
        return vec3(srgb_decode(p->words[at] / 65535.0), srgb_decode(p->words[at + 1] / 65535.0),
                    srgb_decode(p->words[at + 2] / 65535.0));
    return vec3(clamp01((double)p->floats[at]), clamp01((double)p->floats[at + 1]),
                clamp01((double)p->floats[at + 2]));
}

/* A place of a padded tile in the picture; pixels at the border go on for ever. */
static size_t place(size_t first, size_t i, uint32_t end)
{
    size_t at = first + i < REACH ? 0 : first + i - REACH;
    return at < end ? at : end - 1;
}

static void load_tile(const struct job *j, const struct picture *p, size_t x0, size_t y0,
                      struct tile *t)
{
    for (size_t y = 0; y < PADDED; y++) {
        size_t row = place(y0, y, p->height) * p->width;
        for (size_t x = 0; x < PADDED; x++) {
            struct vec3 light = light_at(j, p, 3 * (row + place(x0, x, p->width)));
            struct vec3 o = opponent_of_xyz(apply(xyz_of_rgb, light));
            t->opponents[PLANE_Y][y][x] = (float)o.x;
            t->opponents[PLANE_RG][y][x] = (float)o.y;
            t->opponents[PLANE_BY][y][x] = (float)o.z;
        }
    }
}

static void filter_tile(const struct job *j, struct tile *t, struct planes *out)
{
    memset(t->rows, 0, sizeof t->rows);
    for (int k = 0; k < KERNELS; k++)
        for (size_t y = 0; y < PADDED; y++)
            add_weighted(t->opponents[filtered_along_rows[k]][y], 1, j->kernels[k], t->rows[k][y]);
    memset(out, 0, sizeof *out);
    for (int i = 0; i < COLUMN_PASSES; i++) {
        const struct column_pass *c = &column_passes[i];
        for (size_t y = 0; y < TILE; y++)
            add_weighted(t->rows[c->rows][y], TILE, j->kernels[c->columns], out->at[c->out][y]);
    }
}

static struct vec3 lab_at(const struct planes *p, size_t y, size_t x)
{
    struct vec3 o = vec3((double)p->at[PLANE_Y][y][x], (double)p->at[PLANE_RG][y][x],
                         (double)p->at[PLANE_BY][y][x]);
    struct vec3 rgb = apply(rgb_of_xyz, xyz_of_opponent(o));
    return hunt_lab(vec3(clamp01(rgb.x), clamp01(rgb.y), clamp01(rgb.z)));
}

/* Distances up to 0.4 of the largest take 0.95 of the range (section 4.1.3). */
static double colour_error(const struct job *j, struct vec3 a, struct vec3 b)
{
    const double knee = 0.4, share = 0.95;
    double d = colour_distance(a, b) / j->most;
    return d < knee ? d / knee * share : share + (d - knee) / (1 - knee) * (1 - share);
}

static double strength(const struct planes *p, enum plane across, size_t y, size_t x)
{
    return length2((double)p->at[across][y][x], (double)p->at[across + 1][y][x]);
}

/* What one picture has and the other lacks: an edge or a point (section 4.2). */
static double feature_error(const struct planes *a, const struct planes *b, size_t y, size_t x)
{
    double edges = fabs(strength(a, EDGE_X, y, x) - strength(b, EDGE_X, y, x));
    double points = fabs(strength(a, POINT_X, y, x) - strength(b, POINT_X, y, x));
    return sqrt(fmax(edges, points) / sqrt(2));
}

/* The larger the difference of features, the more that of colours counts (section 4.3). */
static double pixel_error(const struct job *j, const struct tile *t, size_t y, size_t x)
{
    const struct planes *a = &t->filtered[0], *b = &t->filtered[1];
    return pow(colour_error(j, lab_at(a, y, x), lab_at(b, y, x)), 1 - feature_error(a, b, y, x));
}

static void measure_tile(void *context, size_t item, unsigned worker)
{
    const struct job *j = context;
    const struct picture *p = j->pictures[0];
    struct tile *t = &j->scratch[worker];
    size_t x0 = item % j->tiles_across * TILE, y0 = item / j->tiles_across * TILE;
    for (int i = 0; i < 2; i++) {
        load_tile(j, j->pictures[i], x0, y0, t);
        filter_tile(j, t, &t->filtered[i]);
    }
    for (size_t y = 0; y < TILE && y0 + y < p->height; y++)
        for (size_t x = 0; x < TILE && x0 + x < p->width; x++)
            j->map[(y0 + y) * p->width + x0 + x] = (float)pixel_error(j, t, y, x);
}

void flip_map(const struct picture *a, const struct picture *b, unsigned threads, float *map)
{
    struct job j = {.pictures = {a, b}, .map = map};
    size_t down = ((size_t)a->height + TILE - 1) / TILE;
    j.tiles_across = ((size_t)a->width + TILE - 1) / TILE;
    j.most = colour_distance(hunt_lab(vec3(0, 1, 0)), hunt_lab(vec3(0, 0, 1)));
    make_kernels(j.kernels);
    for (int i = 0; i < 256; i++)
        j.light[i] = srgb_decode(i / 255.0);
    j.scratch = mem_alloc(threads, sizeof *j.scratch);
    thread_share(j.tiles_across * down, threads, measure_tile, &j);
    free(j.scratch);
}
