/* Light to the nearest sRGB byte without a power for each. */
#ifndef WRT_MATH_SRGB_BYTES_H
#define WRT_MATH_SRGB_BYTES_H

#include <stdint.h>
#include <string.h>

/* What is less than 2^-13 is black.  Light from there to 1 is told apart by exponent and upper
 * digits, so finely that no two bytes begin in one slot. */
enum { SRGB_OCTAVES = 13, SRGB_DIGITS = 7, SRGB_SLOTS = SRGB_OCTAVES << SRGB_DIGITS };
enum { SRGB_FIRST = (1023 - SRGB_OCTAVES) << SRGB_DIGITS }; /* exponent and digits of slot 0 */

struct srgb_bytes {
    double from[257];           /* the least light of each byte; at the end, that of none */
    uint32_t first[SRGB_SLOTS]; /* byte of the slot's least light */
};

void srgb_bytes_init(struct srgb_bytes *s);

/* Not-a-number gives 0. */
static inline uint8_t srgb_byte(const struct srgb_bytes *s, double light)
{
    uint64_t bits;
    if (!(light >= s->from[1]))
        return 0;
    if (light >= 1)
        return 255;
    memcpy(&bits, &light, sizeof bits);
    uint32_t byte = s->first[(bits >> (52 - SRGB_DIGITS)) - SRGB_FIRST];
    return (uint8_t)(byte + (light >= s->from[byte + 1]));
}

#endif
