/* The transfer functions of sRGB (IEC 61966-2-1), for values from 0 to 1. */
#ifndef WRT_MATH_SRGB_H
#define WRT_MATH_SRGB_H

#include <math.h>

/* Light of a stored value. */
static inline double srgb_decode(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* The value to store for this much light. */
static inline double srgb_encode(double light)
{
    return light <= 0.0031308 ? light * 12.92 : 1.055 * pow(light, 1 / 2.4) - 0.055;
}

#endif
