/* The mean of a colour over the unit square, from few samples where it is even and many where it is
 * not.
 *
 * The square is a tree of square cells, each sampled at its corners and in its middle; cells share
 * corners.  A cell whose middle is the mean of its corners, as that of any plane is, needs no more;
 * of the others, the worst first, the middles of their quarters are sampled, and where that does
 * not do, the quarters become cells.  Across an edge the error of n samples so falls as n^-3/2,
 * that of a grid as n^-3/4. */
#ifndef WRT_RENDER_CUBATURE_H
#define WRT_RENDER_CUBATURE_H

#include "math/vec3.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    CUBATURE_SIDE = 32,                  /* finest cells along a side of the square */
    CUBATURE_PLACES = 2 * CUBATURE_SIDE, /* steps of the lattice of samples along it */
    CUBATURE_SAMPLES = 32 * 32,          /* most of them */
    CUBATURE_FIRST = 5,                  /* samples of a cell: corners and middle */
    CUBATURE_QUARTERED = 9,              /* and the middles of its quarters */
    CUBATURE_CELLS = 1 + 3 * (CUBATURE_SAMPLES / 4),
};

struct cubature_place {
    uint8_t x, y; /* from 0 to CUBATURE_PLACES */
};

/* A mean, and the variance that it is estimated to have. */
struct estimate {
    struct vec3 mean, variance;
};

struct cubature_cell {
    struct cubature_place at; /* the lower left corner */
    uint8_t size;             /* in steps of the lattice */
    bool quartered;           /* the middles of its quarters are sampled, too */
    bool judged;              /* the rest is known */
    struct estimate share;    /* of the cell in the mean of the square */
};

struct cubature {
    bool noisy;
    uint32_t samples, settled; /* those from `settled` on are wanted */
    uint32_t cells;
    uint16_t number[CUBATURE_PLACES + 1][CUBATURE_PLACES + 1]; /* of the sample there, plus 1 */
    struct cubature_place place[CUBATURE_SAMPLES];             /* where each sample is */
    struct vec3 value[CUBATURE_SAMPLES];                       /* to be filled in by the caller */
    struct cubature_cell cell[CUBATURE_CELLS];
    struct estimate whole; /* where nothing is wanted */
};

/* Of a cell with n samples, CUBATURE_FIRST or CUBATURE_QUARTERED: corners, of which the lower ones
 * and then the left ones come first, the middle, and the middles of the quarters in the order of
 * the corners; noisy: samples at one place differ. */
struct estimate cubature_estimate(const struct vec3 *sample, int n, bool noisy);

/* Wants the samples of one cell, the whole square, in that order. */
void cubature_begin(struct cubature *c, bool noisy);
/* Takes the wanted samples, whose values the caller has filled in. */
void cubature_settle(struct cubature *c);
/* Wants the middles of the quarters of every cell. */
void cubature_quarter_all(struct cubature *c);
/* Cuts every cell. */
void cubature_cut_all(struct cubature *c);
/* Wants more samples in the cells that are worst, a channel's variance counting `weight` times;
 * false when none can have more. */
bool cubature_refine(struct cubature *c, struct vec3 weight);

#endif
