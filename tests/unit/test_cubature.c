/* Means over the square by samples where they are needed. */
#include "config.h"

#include "unit.h"

#include "math/rng.h"
#include "render/cubature.h"

#include <math.h>
#include <stdlib.h>

/* A function on the unit square: three channels. */
struct integrand {
    struct vec3 (*at)(const double *parameters, double x, double y);
    double parameters[3];
};

static void answer(struct cubature *c, const struct integrand *f)
{
    for (uint32_t k = c->settled; k < c->samples; k++)
        c->value[k] = f->at(f->parameters, (double)c->place[k].x / CUBATURE_PLACES,
                            (double)c->place[k].y / CUBATURE_PLACES);
    cubature_settle(c);
}

static void begin(struct cubature *c, const struct integrand *f, bool noisy)
{
    cubature_begin(c, noisy);
    answer(c, f);
}

/* Cuts until the error of red is small enough. */
static void integrate(struct cubature *c, const struct integrand *f, double error)
{
    begin(c, f, false);
    while (c->whole.variance.x > error * error && cubature_refine(c, vec3(1, 0, 0)))
        answer(c, f);
}

static struct vec3 plane(const double *p, double x, double y)
{
    double z = p[0] + p[1] * x + p[2] * y;
    return vec3(z, 2 * z, -z);
}

/* Steep enough to be told from an edge. */
static struct vec3 cubic(const double *p, double x, double y)
{
    double u = x - p[0];
    return vec3(4 * x + u * u * u + y * y, 5 * y - x * x * y, 9 * x + y * y * y);
}

/* 1 on one side of a line at angle p[0], p[1] from the middle. */
static struct vec3 edge(const double *p, double x, double y)
{
    return vec3_all((x - 0.5) * cos(p[0]) + (y - 0.5) * sin(p[0]) < p[1]);
}

/* An edge in red only. */
static struct vec3 red_edge(const double *p, double x, double y)
{
    return vec3(edge(p, x, y).x, 0.25, x);
}

static struct vec3 noise(const double *p, double x, double y)
{
    return vec3_all(rng_uniform((uint64_t)p[0], (uint64_t)(x * CUBATURE_PLACES),
                                (uint64_t)(y * CUBATURE_PLACES), 0));
}

START_TEST(planes_need_five_samples)
{
    struct cubature *c = malloc(sizeof *c);
    struct integrand f = {plane, {0.25, -0.75, 0.5}};
    integrate(c, &f, 1e-9);
    ck_assert_uint_eq(c->samples, 5);
    ck_assert(vec3_length(vec3_sub(c->whole.mean, vec3(0.125, 0.25, -0.125))) < 1e-15);
    free(c);
}
END_TEST

/* With corners, middle and quarters; without the quarters the error is within twice its estimate.
 */
START_TEST(cubics_are_exact)
{
    struct cubature *c = malloc(sizeof *c);
    struct integrand f = {cubic, {0.25}};
    begin(c, &f, false);
    double u = (0.75 * 0.75 * 0.75 * 0.75 - 0.25 * 0.25 * 0.25 * 0.25) / 4;
    struct vec3 mean = vec3(2 + u + 1.0 / 3, 2.5 - 1.0 / 6, 4.5 + 0.25);
    ck_assert_uint_eq(c->samples, CUBATURE_FIRST);
    ck_assert(fabs(c->whole.mean.x - mean.x) <= 2 * sqrt(c->whole.variance.x));
    cubature_quarter_all(c);
    answer(c, &f);
    ck_assert_uint_eq(c->samples, CUBATURE_QUARTERED);
    ck_assert(vec3_length(vec3_sub(c->whole.mean, mean)) < 1e-14);
    free(c);
}
END_TEST

/* The share of the square on the edge's side, by very many columns. */
static double edge_share(const double *p)
{
    enum { COLUMNS = 2000 };
    double sum = 0;
    for (int i = 0; i < COLUMNS; i++) {
        double along = ((i + 0.5) / COLUMNS - 0.5) * cos(p[0]),
               y = (p[1] - along) / sin(p[0]) + 0.5;
        double below = y < 0 ? 0 : y > 1 ? 1 : y;
        sum += sin(p[0]) > 0 ? below : 1 - below;
    }
    return sum / COLUMNS;
}

/* What the weights and the estimates of five and of nine samples were chosen for. */
START_TEST(edges_within_one_cell)
{
    enum { EDGES = 3000 };
    static const double most[] = {0.125, 0.065}; /* root mean square of the errors */
    struct cubature *c = malloc(sizeof *c);
    double squares = 0, estimated = 0;
    int met = 0;
    for (int i = 0; i < EDGES; i++) {
        struct integrand f = {edge, {0}};
        f.parameters[0] = 2 * PI * rng_uniform(2, (uint64_t)i, 0, 0);
        f.parameters[1] = 1.5 * (rng_uniform(2, (uint64_t)i, 0, 1) - 0.5);
        double share = edge_share(f.parameters);
        if (share <= 0 || share >= 1)
            continue;
        begin(c, &f, false);
        if (_i > 0) {
            cubature_quarter_all(c);
            answer(c, &f);
        }
        squares += (c->whole.mean.x - share) * (c->whole.mean.x - share);
        estimated += c->whole.variance.x;
        met++;
    }
    double error = sqrt(squares / met), ratio = sqrt(squares / estimated);
    ck_assert_msg(error < most[_i], "error %g", error);
    ck_assert_msg(ratio > 0.8 && ratio < 1.25, "%g of the estimate", ratio);
    free(c);
}
END_TEST

/* Edges at all angles: the mean square of the true errors is that of the estimated ones, within a
 * factor of two of the errors, and falls far faster than that of a grid. */
START_TEST(edges_are_estimated)
{
    static const double wanted[] = {0.2, 0.05, 0.01, 0.004};
    static const double samples[] = {6, 15, 58, 115};
    enum { EDGES = 300 };
    struct cubature *c = malloc(sizeof *c);
    double squares = 0, estimated = 0, taken = 0;
    for (int i = 0; i < EDGES; i++) {
        struct integrand f = {edge, {0}};
        f.parameters[0] = 2 * PI * rng_uniform(1, (uint64_t)i, 0, 0);
        f.parameters[1] = rng_uniform(1, (uint64_t)i, 0, 1) - 0.5;
        integrate(c, &f, wanted[_i]);
        double error = c->whole.mean.x - edge_share(f.parameters);
        ck_assert(sqrt(c->whole.variance.x) <= wanted[_i]);
        squares += error * error;
        estimated += c->whole.variance.x;
        taken += c->samples;
    }
    double ratio = sqrt(squares / estimated);
    ck_assert_msg(ratio > 0.5 && ratio < 2, "wanted %g: %g of the estimate", wanted[_i], ratio);
    ck_assert_msg(taken / EDGES < samples[_i], "wanted %g: %g samples", wanted[_i], taken / EDGES);
    free(c);
}
END_TEST

/* Each place is sampled once, on the lattice, and no more than allowed. */
START_TEST(noise_ends)
{
    struct cubature *c = malloc(sizeof *c);
    struct integrand f = {noise, {1}};
    static bool seen[CUBATURE_PLACES + 1][CUBATURE_PLACES + 1];
    integrate(c, &f, 0);
    ck_assert_uint_le(c->samples, CUBATURE_SAMPLES);
    ck_assert_uint_gt(c->samples, CUBATURE_SAMPLES / 2);
    ck_assert_uint_le(c->cells, CUBATURE_CELLS);
    for (uint32_t k = 0; k < c->samples; k++) {
        struct cubature_place p = c->place[k];
        ck_assert(p.x <= CUBATURE_PLACES && p.y <= CUBATURE_PLACES && !seen[p.y][p.x]);
        seen[p.y][p.x] = true;
    }
    free(c);
}
END_TEST

/* Noise is estimated within a factor of two when it is said to be noise. */
START_TEST(noise_is_estimated)
{
    enum { TRIES = 400 };
    struct cubature *c = malloc(sizeof *c);
    double squares = 0, estimated = 0;
    for (int i = 0; i < TRIES; i++) {
        struct integrand f = {noise, {i}};
        begin(c, &f, true);
        for (int step = 0; step < _i; step++) {
            (step % 2 ? cubature_cut_all : cubature_quarter_all)(c);
            answer(c, &f);
        }
        squares += (c->whole.mean.x - 0.5) * (c->whole.mean.x - 0.5);
        estimated += c->whole.variance.x;
    }
    double ratio = sqrt(squares / estimated);
    ck_assert_msg(ratio > 0.5 && ratio < 2, "%d steps: %g of the estimate", _i, ratio);
    free(c);
}
END_TEST

START_TEST(all_cells_are_cut)
{
    struct cubature *c = malloc(sizeof *c);
    struct integrand f = {plane, {0.25, -0.75, 0.5}};
    begin(c, &f, false);
    for (uint32_t side = 2; side <= 16; side *= 2) {
        cubature_cut_all(c);
        answer(c, &f);
        ck_assert_uint_eq(c->cells, side * side);
        ck_assert_uint_eq(c->samples, side * side + (side + 1) * (side + 1));
        ck_assert(vec3_length(vec3_sub(c->whole.mean, vec3(0.125, 0.25, -0.125))) < 1e-14);
    }
    free(c);
}
END_TEST

START_TEST(what_has_no_weight_is_not_cut)
{
    struct cubature *c = malloc(sizeof *c);
    struct integrand f = {red_edge, {1, 0.2}};
    begin(c, &f, false);
    ck_assert(c->whole.variance.x > 0 && c->whole.variance.y == 0);
    ck_assert(!cubature_refine(c, vec3(0, 1, 1)));
    ck_assert(cubature_refine(c, vec3(1, 1, 1)));
    free(c);
}
END_TEST

Suite *cubature_suite(void)
{
    Suite *s = suite_create("cubature");
    TCase *t = tcase_create("cubature");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, planes_need_five_samples);
    tcase_add_test(t, cubics_are_exact);
    tcase_add_loop_test(t, edges_within_one_cell, 0, SANITIZED(1, 2));
    tcase_add_loop_test(t, edges_are_estimated, 0, SANITIZED(1, 4));
    tcase_add_test(t, noise_ends);
    tcase_add_loop_test(t, noise_is_estimated, 0, 6);
    tcase_add_test(t, all_cells_are_cut);
    tcase_add_test(t, what_has_no_weight_is_not_cut);
    suite_add_tcase(s, t);
    return s;
}
