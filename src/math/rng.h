/* Uniform random numbers by counter: a number depends on what it is for, not on when it is drawn,
 * so pictures are the same on any thread count.
 *
 * The mixing step is SplitMix64's (Steele, Lea, Flood, Fast splittable pseudorandom number
 * generators, OOPSLA 2014; constants: Stafford's variant 13). */
#ifndef WRT_MATH_RNG_H
#define WRT_MATH_RNG_H

#include <stdint.h>

static inline uint64_t rng_mix(uint64_t x)
{
    x += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

/* In [0, 1): number `dimension` of the sample of the pixel. */
static inline double rng_uniform(uint64_t seed, uint64_t pixel, uint64_t sample, uint64_t dimension)
{
    uint64_t x = rng_mix(rng_mix(rng_mix(rng_mix(seed) ^ pixel) ^ sample) ^ dimension);
    return (double)(x >> 11) * 0x1p-53;
}

#endif
