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

/* Modern: texels at their centres, repeated.  How far `rest` is on the way from texel `at` to the
 * next; without a filter the texel that holds the place. */
static struct texel_place centred_place(double u, uint32_t size, bool linear)
{
    double t = u * size - (linear ? 0.5 : 0), whole = floor(t), at = fmod(whole, size);
    if (!(fabs(t) < 0x1p51)) /* too large to have a fraction, or no number */
        return (struct texel_place){0, 0};
    return (struct texel_place){(uint32_t)(at < 0 ? at + size : at), t - whole};
}

/* From 0 to 255 or 65535, or decoded from 0 to 1; row 0 is the bottom. */
static struct vec3 texel(const struct texture *t, uint32_t column, uint32_t row)
{
    const struct image *image = t->image;
    size_t at = 3 * ((size_t)(image->height - 1 - row) * image->width + column);
    uint16_t c[3];
    for (int i = 0; i < 3; i++)
        c[i] = image->data8 ? image->data8[at + i] : image->data16[at + i];
    if (t->decode)
        return vec3(t->decode[c[0]], t->decode[c[1]], t->decode[c[2]]);
    return vec3(c[0], c[1], c[2]);
}

static struct vec3 mix(struct vec3 a, struct vec3 b, double share_of_b)
{
    return vec3_mad(vec3_scale(a, 1 - share_of_b), share_of_b, b);
}

struct vec3 texture_fetch(const struct texture *t, double u, double v)
{
    const struct image *image = t->image;
    struct texel_place i =
        t->centred ? centred_place(u, image->width, t->linear) : place_on(u, image->width);
    struct texel_place j =
        t->centred ? centred_place(v, image->height, t->linear) : place_on(v, image->height);
    struct vec3 c = texel(t, i.at, j.at);
    if (t->linear) {
        uint32_t right = i.at + 1 < image->width ? i.at + 1 : 0;
        uint32_t above = j.at + 1 < image->height ? j.at + 1 : 0;
        struct vec3 low = mix(c, texel(t, right, j.at), i.rest);
        struct vec3 high = mix(texel(t, i.at, above), texel(t, right, above), i.rest);
        c = mix(low, high, j.rest);
    }
    if (t->decode)
        return c;
    double full = image->data8 ? 255 : 65535;
    return vec3(c.x / full, c.y / full, c.z / full);
}
