#include "config.h"

#include "render/cubature.h"

#include <math.h>
#include <string.h>

/* A cell's values: corners and middle. */
struct five {
    double corner[4], middle;
};

/* Mean over a cell of one channel, and the standard error of that. */
struct judgement {
    double mean, error;
};

static struct judgement judged(const struct five *f, double weight, double error)
{
    double sum = f->corner[0] + f->corner[1] + f->corner[2] + f->corner[3];
    return (struct judgement){weight * f->middle + (1 - weight) * (sum / 4), error};
}

/* By the distance of the middle from the mean of the corners, relative to the spread of all five,
 * two kinds are told apart.  A straight edge between two colours gives a half (it has two corners
 * on each side) or a quarter; over all such edges, the best weight of the middle is 0.4 and the
 * error then 0.12 or 0.10 of the spread.  Anything else is taken for a smooth curve, for which a
 * weight of 2/3 is exact up to cubics. */
static struct judgement judge(const struct five *f)
{
    double low = f->middle, high = f->middle, sum = 0;
    for (int i = 0; i < 4; i++) {
        sum += f->corner[i];
        low = f->corner[i] < low ? f->corner[i] : low;
        high = f->corner[i] > high ? f->corner[i] : high;
    }
    double off = fabs(f->middle - sum / 4), spread = high - low;
    if (off < 0.2 * spread || off > 0.75 * spread)
        return judged(f, 2.0 / 3, 0.2 * off);
    return judged(f, 0.45, 0.19 * sqrt(off * spread));
}

/* Five independent samples; those at the corners belong to four cells, but then to one in each
 * square of them. */
static struct judgement judge_noise(const struct five *f)
{
    double sum = f->middle, squares = 0;
    for (int i = 0; i < 4; i++)
        sum += f->corner[i];
    double mean = sum / 5;
    for (int i = 0; i < 4; i++)
        squares += (f->corner[i] - mean) * (f->corner[i] - mean);
    squares += (f->middle - mean) * (f->middle - mean);
    return judged(f, 0.5, sqrt(squares / 4 * (0.25 + 0.25 / 4)));
}

struct estimate cubature_estimate(const struct vec3 corner[4], struct vec3 middle, bool noisy)
{
    const struct vec3 *k = corner;
    struct five r = {{k[0].x, k[1].x, k[2].x, k[3].x}, middle.x};
    struct five g = {{k[0].y, k[1].y, k[2].y, k[3].y}, middle.y};
    struct five b = {{k[0].z, k[1].z, k[2].z, k[3].z}, middle.z};
    struct judgement (*rule)(const struct five *) = noisy ? judge_noise : judge;
    struct judgement red = rule(&r), green = rule(&g), blue = rule(&b);
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

static void judge_cell(const struct cubature *c, struct cubature_cell *cell)
{
    uint32_t x = cell->at.x, y = cell->at.y, size = cell->size;
    struct vec3 corner[4] = {value_at(c, x, y), value_at(c, x + size, y), value_at(c, x, y + size),
                             value_at(c, x + size, y + size)};
    struct estimate e =
        cubature_estimate(corner, value_at(c, x + size / 2, y + size / 2), c->noisy);
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

/* A cell's quarters, the last of which takes its place. */
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
    enum { MOST_NEW = 8 }; /* samples of one cut */
    uint32_t cells = c->cells;
    double worst = 0;
    for (uint32_t i = 0; i < cells; i++)
        worst = fmax(worst, badness(&c->cell[i], weight));
    for (uint32_t i = 0; i < cells && worst > 0; i++)
        if (badness(&c->cell[i], weight) >= worst / 2 && c->samples + MOST_NEW <= CUBATURE_SAMPLES)
            cut(c, i);
    return c->samples > c->settled;
}
