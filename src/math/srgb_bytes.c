#include "config.h"

#include "math/srgb_bytes.h"

#include "math/srgb.h"

static int nearest_byte(double light)
{
    return (int)(srgb_encode(light) * 255 + 0.5);
}

/* The least light whose nearest byte is this one, from a guess some roundings off. */
static double least_light(int byte)
{
    double light = srgb_decode((byte - 0.5) / 255);
    while (nearest_byte(light) < byte)
        light = nextafter(light, 1);
    for (double less = light; nearest_byte(less) >= byte; less = nextafter(less, 0))
        light = less;
    return light;
}

void srgb_bytes_init(struct srgb_bytes *s)
{
    s->from[0] = 0;
    s->from[256] = INFINITY;
    for (int byte = 1; byte < 256; byte++)
        s->from[byte] = least_light(byte);
    for (uint32_t i = 0, byte = 0; i < SRGB_SLOTS; i++) {
        double steps = 1 << SRGB_DIGITS, digits = i % (1 << SRGB_DIGITS) / steps;
        double light = ldexp(1 + digits, (int)(i >> SRGB_DIGITS) - SRGB_OCTAVES);
        while (light >= s->from[byte + 1])
            byte++;
        s->first[i] = byte;
    }
}
