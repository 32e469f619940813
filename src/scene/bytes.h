/* Numbers in binary mesh files. */
#ifndef WRT_SCENE_BYTES_H
#define WRT_SCENE_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* An unsigned number of 1 to 8 bytes. */
static inline uint64_t bytes_load(const uint8_t *p, size_t size, bool big_endian)
{
    uint64_t x = 0;
    for (size_t i = 0; i < size; i++)
        x = x << 8 | p[big_endian ? i : size - 1 - i];
    return x;
}

static inline double bytes_load_float(const uint8_t *p, bool big_endian)
{
    uint32_t bits = (uint32_t)bytes_load(p, 4, big_endian);
    float f;
    memcpy(&f, &bits, sizeof f);
    return (double)f;
}

static inline double bytes_load_double(const uint8_t *p, bool big_endian)
{
    uint64_t bits = bytes_load(p, 8, big_endian);
    double d;
    memcpy(&d, &bits, sizeof d);
    return d;
}

#endif
