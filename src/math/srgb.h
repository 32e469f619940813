/* The transfer function of sRGB (IEC 61966-2-1). */
#ifndef WRT_MATH_SRGB_H
#define WRT_MATH_SRGB_H

#include <math.h>

/* The light that a value from 0 to 1 stands for. */
static inline double srgb_decode(double x)
{
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

#endif
