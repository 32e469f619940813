/* Parts of pictures cut into tiles, by which work is shared. */
#ifndef WRT_RENDER_TILING_H
#define WRT_RENDER_TILING_H

#include <stddef.h>
#include <stdint.h>

enum { TILE = 8 }; /* pixels along each side */

/* A part of the picture: pixels, top left origin, x1 and y1 outside. */
struct tile {
    uint32_t x0, y0, x1, y1;
};

/* A part cut into tiles, which are numbered row by row. */
struct tiling {
    struct tile whole;
    uint32_t columns; /* tiles in a row */
    size_t n;
};

struct tiling tiling_of(uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1);
struct tile tiling_at(const struct tiling *tiling, size_t number);

static inline size_t tile_pixels(const struct tile *t)
{
    return (size_t)(t->x1 - t->x0) * (t->y1 - t->y0);
}

#endif
