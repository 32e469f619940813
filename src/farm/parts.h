/* A picture cut into parts for as many machines. */
#ifndef WRT_FARM_PARTS_H
#define WRT_FARM_PARTS_H

#include "render/tiling.h"

enum { PARTS_MOST = 1000000 };

/* Which of `parts` a tile belongs to, from 1.  Parts are made of squares of tiles that lie all over
 * the picture, so that each costs about as much as the others; of more parts than tiles some have
 * none. */
uint32_t part_of_tile(const struct tiling *t, uint32_t parts, size_t tile);

/* The numbers of a part's tiles, square by square, to be freed; *n says how many. */
size_t *part_tiles(const struct tiling *t, uint32_t part, uint32_t parts, size_t *n);

#endif
