#include "config.h"

#include "scene/scene.h"

/* Where a coordinate falls: texel `at`, and how far on the way to the next. */
struct texel_place {
    uint32_t at;
    double rest;
};

/* The original's rule: 1 itself is the last texel's end; elsewhere the coordinate wraps, its
 * fraction taken from the distance to 0. */
static struct texel_place place_on(double u, uint32_t size)
{
    if (u == 1)
        return (struct texel_place){size - 1, 1};
    double t = u * size;
    if (!(fabs(t) < 0x1p62)) { /* too large to have a fraction, or no number */
        double at = fmod(t, size);
        return (struct texel_place){at >= 0  ? (uint32_t)at
                                    : at < 0 ? (uint32_t)(at + size)
                                             : 0,
                                    at < 0 ? 1 : 0};
    }
    int64_t at = (int64_t)t;
    double rest = fabs(t - (double)at);
    if (at < 0 || at >= size)
        at %= (int64_t)size;
    if (at < 0)
        return (struct texel_place){(uint32_t)(at + size), 1 - rest};
    return (struct texel_place){(uint32_t)at, rest};
}

/* From 0 to 255, or 65535; row 0 is the bottom. */
static struct vec3 texel(const struct image *image, uint32_t column, uint32_t row)
{
    size_t at = 3 * ((size_t)(image->height - 1 - row) * image->width + column);
    if (image->data8) {
        const uint8_t *p = image->data8 + at;
        return vec3(p[0], p[1], p[2]);
    }
    const uint16_t *p = image->data16 + at;
    return vec3(p[0], p[1], p[2]);
}

static struct vec3 mix(struct vec3 a, struct vec3 b, double share_of_b)
{
    return vec3_mad(vec3_scale(a, 1 - share_of_b), share_of_b, b);
}

struct vec3 texture_fetch(const struct texture *t, double u, double v)
{
    const struct image *image = t->image;
    struct texel_place i = place_on(u, image->width), j = place_on(v, image->height);
    struct vec3 c = texel(image, i.at, j.at);
    if (t->linear) {
        uint32_t right = i.at + 1 < image->width ? i.at + 1 : 0;
        uint32_t above = j.at + 1 < image->height ? j.at + 1 : 0;
        struct vec3 low = mix(c, texel(image, right, j.at), i.rest);
        struct vec3 high = mix(texel(image, i.at, above), texel(image, right, above), i.rest);
        c = mix(low, high, j.rest);
    }
    double full = image->data8 ? 255 : 65535;
    return vec3(c.x / full, c.y / full, c.z / full);
}
