#include "config.h"

#include "render/tiling.h"

struct tiling tiling_of(uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1)
{
    uint32_t columns = (x1 - x0 + TILE - 1) / TILE, rows = (y1 - y0 + TILE - 1) / TILE;
    return (struct tiling){{x0, y0, x1, y1}, columns, (size_t)columns * rows};
}

struct tile tiling_at(const struct tiling *tiling, size_t number)
{
    const struct tile *whole = &tiling->whole;
    uint32_t x = whole->x0 + (uint32_t)(number % tiling->columns) * TILE;
    uint32_t y = whole->y0 + (uint32_t)(number / tiling->columns) * TILE;
    return (struct tile){x, y, whole->x1 - x < TILE ? whole->x1 : x + TILE,
                         whole->y1 - y < TILE ? whole->y1 : y + TILE};
}
