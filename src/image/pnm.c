/* Binary PPM (P6) and PFM. */
#include "config.h"

#include "image/codec.h"

#include "base/mem.h"
#include "base/num.h"

#include <stdio.h>
#include <string.h>

enum { HEADER_BYTES = 64 };

void *ppm_file_encode(const struct picture *p, size_t *n)
{
    char header[HEADER_BYTES];
    size_t length =
        (size_t)snprintf(header, sizeof header, "P6\n%u %u\n255\n", p->width, p->height);
    size_t samples = (size_t)3 * p->width * p->height;
    uint8_t *out = mem_alloc(length + samples, 1);
    memcpy(out, header, length);
    memcpy(out + length, p->bytes, samples);
    *n = length + samples;
    return out;
}

/* Little-endian whatever the machine. */
static uint8_t *put_float(uint8_t *out, float f)
{
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    for (int i = 0; i < 4; i++)
        *out++ = (uint8_t)(bits >> 8 * i);
    return out;
}

/* The negative scale says little-endian; the bottom row comes first (Paul Debevec's format). */
void *pfm_file_encode(const struct picture *p, size_t *n)
{
    char header[HEADER_BYTES];
    size_t length =
        (size_t)snprintf(header, sizeof header, "PF\n%u %u\n-1.0\n", p->width, p->height);
    size_t row = (size_t)3 * p->width;
    *n = length + row * p->height * sizeof(float);
    uint8_t *out = mem_alloc(*n, 1), *at = out + length;
    memcpy(out, header, length);
    for (uint32_t y = p->height; y-- > 0;)
        for (size_t i = 0; i < row; i++)
            at = put_float(at, p->floats[y * row + i]);
    return out;
}

static bool is_space(uint8_t c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Skips white space and comments, then reads a number of at most 7 digits, which is beyond
 * every limit; NULL if there is none. */
static const uint8_t *read_field(const uint8_t *p, const uint8_t *end, uint32_t *out)
{
    while (p < end && (is_space(*p) || *p == '#')) {
        if (*p == '#')
            while (p < end && *p != '\n')
                p++;
        else
            p++;
    }
    const uint8_t *digits = p;
    *out = 0;
    for (; p < end && *p >= '0' && *p <= '9' && p - digits < 7; p++)
        *out = *out * 10 + (uint32_t)(*p - '0');
    bool longer = p < end && *p >= '0' && *p <= '9';
    return p > digits && !longer ? p : NULL;
}

/* Exactly `wanted` bytes must follow the header. */
static bool size_check(size_t have, size_t wanted, char reason[IMAGE_REASON_BYTES])
{
    if (have != wanted)
        image_reason(reason,
                     have < wanted ? "the picture ends early" : "more bytes follow the picture");
    return have == wanted;
}

struct image *ppm_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES])
{
    uint32_t width, height, largest;
    const uint8_t *end = bytes + n, *p = bytes + 2;
    if (!(p = read_field(p, end, &width)) || !(p = read_field(p, end, &height)) ||
        !(p = read_field(p, end, &largest)) || p == end || !is_space(*p)) {
        image_reason(reason, "the PPM header is damaged");
        return NULL;
    }
    p++;
    if (largest != 255) {
        image_reason(reason, "a PPM with a largest value of %u is not read; one with 255 is",
                     largest);
        return NULL;
    }
    if (!image_size_check(width, height, reason))
        return NULL;
    size_t samples = (size_t)3 * width * height;
    if (!size_check((size_t)(end - p), samples, reason))
        return NULL;
    struct image *i = image_new(width, height, 8);
    memcpy(i->data8, p, samples);
    return i;
}

/* Little-endian, or the other way round. */
static float get_float(const uint8_t *in, bool little)
{
    uint32_t bits = 0;
    for (int i = 0; i < 4; i++)
        bits = bits << 8 | in[little ? 3 - i : i];
    float f;
    memcpy(&f, &bits, sizeof f);
    return f;
}

struct picture *pfm_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES])
{
    uint32_t width, height;
    double scale = 0;
    const uint8_t *end = bytes + n, *p = bytes + 2;
    if ((p = read_field(p, end, &width)) && (p = read_field(p, end, &height))) {
        while (p < end && is_space(*p))
            p++;
        p = (const uint8_t *)num_parse((const char *)p, (const char *)end, &scale);
    }
    if (!p || p == end || !is_space(*p)) {
        image_reason(reason, "the PFM header is damaged");
        return NULL;
    }
    p++;
    if (scale != 1 && scale != -1) {
        image_reason(reason, "a PFM with a scale of %g is not read; one with 1 or -1 is", scale);
        return NULL;
    }
    if (!image_size_check(width, height, reason))
        return NULL;
    size_t row = (size_t)3 * width;
    if (!size_check((size_t)(end - p), row * height * sizeof(float), reason))
        return NULL;
    struct picture *out = picture_new(width, height, PICTURE_FLOATS);
    for (uint32_t y = height; y-- > 0;)
        for (size_t i = 0; i < row; i++, p += sizeof(float))
            out->floats[y * row + i] = get_float(p, scale < 0);
    return out;
}
