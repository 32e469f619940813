#include "config.h"

#include "render/cubature.h"

#include <math.h>
#include <string.h>

/* Mean over a cell of one channel, and the standard error of that. */
struct judgement {
    double mean, error;
};

static double mean_of(const double *v, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += v[i];
    return sum / n;
}

/* By the distance of the middle from the mean of the corners, relative to the spread of all five,
 * two kinds are told apart.  A straight edge between two colours gives a half (it has two corners
 * on each side) or a quarter; over all such edges, the best weight of the middle is 0.43 and the
 * error then 0.13 or 0.11 of the spread.  Anything else is a smooth curve, for which a weight of
 * 2/3 is exact up to cubics, or may be noise, for which 0.4 is best. */
static struct judgement judge_five(const double *v)
{
    double middle = v[4], around = mean_of(v, 4), low = middle, high = middle;
    for (int i = 0; i < 4; i++) {
        low = v[i] < low ? v[i] : low;
        high = v[i] > high ? v[i] : high;
    }
    double off = fabs(middle - around), spread = high - low;
    bool edge = off >= 0.2 * spread && off <= 0.75 * spread;
    double weight = edge ? 0.45 : 0.55;
    return (struct judgement){weight * middle + (1 - weight) * around,
                              edge ? 0.19 * sqrt(off * spread) : 0.2 * off};
}

/* Corners, middle and quarters as 1 : 1 : 4 are exact up to cubics and, too, as good as any weights
 * for straight edges, for which the error is 0.062 of the step. */
static double mean_of_nine(const double *v)
{
    return (mean_of(v, 4) + v[4] + 4 * mean_of(v + 5, 4)) / 6;
}

/* The error is that part of the quarters' distance from the lines between middle and corners that
 * it is for straight edges; of noise it is 0.31. */
static struct judgement judge_nine(const double *v)
{
    double squares = 0;
    for (int i = 0; i < 4; i++) {
        double off = v[5 + i] - 0.5 * (v[4] + v[i]);
        squares += off * off;
    }
    return (struct judgement){mean_of_nine(v), 0.22 * sqrt(squares / 4)};
}

/* Independent samples, all of one weight; those at the corners belong to four cells, but then to
 * one in each square of them. */
static struct judgement judge_noise(const double *v, int n)
{
    double own = n - 4, mean = mean_of(v, n), squares = 0;
    double corners = n == CUBATURE_QUARTERED ? 1 / (own + 1) : 0.5; /* their weight */
    for (int i = 0; i < n; i++)
        squares += (v[i] - mean) * (v[i] - mean);
    double share = (1 - corners) * (1 - corners) / own + corners * corners / 4;
    return (struct judgement){corners * mean_of(v, 4) + (1 - corners) * mean_of(v + 4, n - 4),
                              sqrt(squares / (n - 1) * share)};
}

static struct judgement judge(const double *v, int n, bool noisy)
{
    if (noisy)
        return judge_noise(v, n);
    return n == CUBATURE_QUARTERED ? judge_nine(v) : judge_five(v);
}

struct estimate cubature_estimate(const struct vec3 *sample, int n, bool noisy)
{
    double r[CUBATURE_QUARTERED], g[CUBATURE_QUARTERED], b[CUBATURE_QUARTERED];
    for (int i = 0; i < n; i++) {
        r[i] = sample[i].x;
        g[i] = sample[i].y;
        b[i] = sample[i].z;
    }
    struct judgement red = judge(r, n, noisy), green = judge(g, n, noisy),
                     blue = judge(b, n, noisy);
    struct vec3 error = vec3(red.error, green.error, blue.error);
    return (struct estimate){vec3(red.mean, green.mean, blue.mean), vec3_mul(error, error)};
}

static void want(struct cubature *c, uint32_t x, uint32_t y)
{
    if (c->number[y][x])
        return;
    c->place[c->samples] = (struct cubature_place){(uint8_t)x, (uint8_t)y};
    c->number[y][x] = (uint16_t)++c->samples;
}

static void add_cell(struct cubature *c, uint32_t x, uint32_t y, uint32_t size)
{
    c->cell[c->cells++] =
        (struct cubature_cell){.at = {(uint8_t)x, (uint8_t)y}, .size = (uint8_t)size};
    want(c, x, y);
    want(c, x + size, y);
    want(c, x, y + size);
    want(c, x + size, y + size);
    want(c, x + size / 2, y + size / 2);
}

void cubature_begin(struct cubature *c, bool noisy)
{
    c->noisy = noisy;
    c->samples = c->settled = c->cells = 0;
    memset(c->number, 0, sizeof c->number);
    add_cell(c, 0, 0, CUBATURE_PLACES);
}

static struct vec3 value_at(const struct cubature *c, uint32_t x, uint32_t y)
{
    return c->value[c->number[y][x] - 1];
}

/* In the order of cubature_estimate(). */
static void take_corners(const struct cubature *c, uint32_t x, uint32_t y, uint32_t size,
                         struct vec3 value[4])
{
    for (uint32_t i = 0; i < 4; i++)
        value[i] = value_at(c, x + (i & 1) * size, y + (i >> 1) * size);
}

static void judge_cell(const struct cubature *c, struct cubature_cell *cell)
{
    uint32_t x = cell->at.x, y = cell->at.y, size = cell->size;
    struct vec3 sample[CUBATURE_QUARTERED];
    take_corners(c, x, y, size, sample);
    sample[4] = value_at(c, x + size / 2, y + size / 2);
    if (cell->quartered)
        take_corners(c, x + size / 4, y + size / 4, size / 2, sample + 5);
    struct estimate e =
        cubature_estimate(sample, cell->quartered ? CUBATURE_QUARTERED : CUBATURE_FIRST, c->noisy);
    double side = (double)size / CUBATURE_PLACES, part = side * side;
    cell->share.mean = vec3_scale(e.mean, part);
    cell->share.variance = vec3_scale(e.variance, part * part);
    cell->judged = true;
}

void cubature_settle(struct cubature *c)
{
    struct estimate sum = {vec3_all(0), vec3_all(0)};
    c->settled = c->samples;
    for (uint32_t i = 0; i < c->cells; i++) {
        if (!c->cell[i].judged)
            judge_cell(c, &c->cell[i]);
        sum.mean = vec3_add(sum.mean, c->cell[i].share.mean);
        sum.variance = vec3_add(sum.variance, c->cell[i].share.variance);
    }
    c->whole = sum;
}

static void quarter(struct cubature *c, uint32_t number)
{
    struct cubature_cell *cell = &c->cell[number];
    uint32_t x = cell->at.x, y = cell->at.y, step = cell->size / 4;
    for (uint32_t i = 0; i < 4; i++)
        want(c, x + (i & 1 ? 3 : 1) * step, y + (i >> 1 ? 3 : 1) * step);
    cell->quartered = true;
    cell->judged = false;
}

/* Makes a cell of each quarter; the last of them takes its place. */
static void cut(struct cubature *c, uint32_t number)
{
    struct cubature_cell whole = c->cell[number];
    uint32_t x = whole.at.x, y = whole.at.y, half = whole.size / 2;
    add_cell(c, x, y, half);
    add_cell(c, x + half, y, half);
    add_cell(c, x, y + half, half);
    add_cell(c, x + half, y + half, half);
    c->cell[number] = c->cell[--c->cells];
}

void cubature_quarter_all(struct cubature *c)
{
    for (uint32_t i = 0; i < c->cells; i++)
        quarter(c, i);
}

void cubature_cut_all(struct cubature *c)
{
    for (uint32_t i = 0, cells = c->cells; i < cells; i++)
        cut(c, i);
}

static double badness(const struct cubature_cell *cell, struct vec3 weight)
{
    if (cell->size <= CUBATURE_PLACES / CUBATURE_SIDE)
        return 0;
    struct vec3 v = vec3_mul(cell->share.variance, weight);
    return fmax(v.x, fmax(v.y, v.z));
}

bool cubature_refine(struct cubature *c, struct vec3 weight)
{
    enum { MOST_NEW = 4 }; /* samples of one step */
    uint32_t cells = c->cells;
    double worst = 0;
    for (uint32_t i = 0; i < cells; i++)
        worst = fmax(worst, badness(&c->cell[i], weight));
    for (uint32_t i = 0; i < cells && worst > 0; i++)
        if (badness(&c->cell[i], weight) >= worst / 2 && c->samples + MOST_NEW <= CUBATURE_SAMPLES)
            (c->cell[i].quartered ? cut : quarter)(c, i);
    return c->samples > c->settled;
}
