#include "config.h"

#include "farm/parts.h"

#include "base/mem.h"

#include <stdlib.h>

/* The squares of a picture. */
struct squares {
    uint32_t side; /* in tiles */
    uint32_t columns, rows;
    uint32_t step; /* how many parts further the first square of a row is than that above */
};

/* Sixteen squares a part even out what they cost; larger ones than 8 x 8 tiles are not needed for
 * anything, and smaller ones cost adaptive sampling more along their borders. */
static struct squares squares_of(const struct tiling *t, uint32_t parts)
{
    enum { LARGEST = 8, A_PART = 16 };
    uint32_t rows = t->columns ? (uint32_t)(t->n / t->columns) : 0;
    struct squares s = {.side = LARGEST};
    for (;; s.side /= 2) {
        s.columns = (t->columns + s.side - 1) / s.side;
        s.rows = (rows + s.side - 1) / s.side;
        if (s.side == 1 || (uint64_t)s.columns * s.rows >= (uint64_t)A_PART * parts)
            break;
    }
    /* Golden section: squares of one part that lie in rows below each other are far apart. */
    s.step = (uint32_t)(parts * 0.618);
    return s;
}

/* Part of the square, from 0.  Below the first row parts go on with an offset, so that no part has
 * columns of its own. */
static uint32_t part_of_square(const struct squares *s, uint32_t parts, uint32_t x, uint32_t y)
{
    return (uint32_t)((x + (uint64_t)y * (s->columns + s->step)) % parts);
}

uint32_t part_of_tile(const struct tiling *t, uint32_t parts, size_t tile)
{
    struct squares s = squares_of(t, parts);
    uint32_t x = (uint32_t)(tile % t->columns), y = (uint32_t)(tile / t->columns);
    return part_of_square(&s, parts, x / s.side, y / s.side) + 1;
}

static void add_square(const struct tiling *t, const struct squares *s, uint32_t x, uint32_t y,
                       size_t *tiles, size_t *n)
{
    size_t rows = t->n / t->columns;
    for (size_t row = (size_t)y * s->side; row < rows && row < ((size_t)y + 1) * s->side; row++)
        for (size_t column = (size_t)x * s->side;
             column < t->columns && column < ((size_t)x + 1) * s->side; column++)
            tiles[(*n)++] = row * t->columns + column;
}

size_t *part_tiles(const struct tiling *t, uint32_t part, uint32_t parts, size_t *n)
{
    struct squares s = squares_of(t, parts);
    size_t *tiles = mem_alloc(t->n, sizeof *tiles);
    *n = 0;
    for (uint32_t y = 0; y < s.rows; y++)
        for (uint32_t x = 0; x < s.columns; x++)
            if (part_of_square(&s, parts, x, y) == part - 1)
                add_square(t, &s, x, y, tiles, n);
    return tiles;
}
