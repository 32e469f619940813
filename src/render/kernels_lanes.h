/* The body of a vector kernel: included once by the file of each instruction set, which sets
 * RENDER_KERNELS to the name of its table.
 *
 * The same operations in the same order as the reference in kernels_plain.c. */
#include "math/srgb_bytes.h"
#include "render/hit_lanes.h"
#include "render/sight_lanes.h"

/* across: as far as the ray's column is. */
static inline struct vvec3 direction_at(const struct lens *lens, struct vvec3 across, vreal y)
{
    struct vvec3 d = v3_mad(across, y, v3_all(lens->upwards));
    d = v3_add(d, v3_all(lens->ahead));
    if (lens->mirrored)
        d.z = -d.z;
    return v3_normalize(d);
}

static void aim(const struct lens *lens, const double *x, const double *y, uint32_t n,
                struct vec3_batch *directions)
{
    struct vvec3 across = v3_all(lens->across);
    for (uint32_t i = 0; i < n; i += LANES)
        v3_store(directions, i, direction_at(lens, v3_scale(across, v_load(x + i)), v_load(y + i)));
}

static void aim_grid(const struct lens *lens, const double *x, uint32_t width, const double *y,
                     uint32_t height, struct vec3_batch *directions)
{
    for (uint32_t row = 0; row < height; row++)
        for (uint32_t i = 0; i < width; i += LANES)
            v3_store(
                directions, row * width + i,
                direction_at(lens, v3_scale(v3_all(lens->across), v_load(x + i)), v_all(y[row])));
}

static void fill_vectors(struct vec3_batch *to, uint32_t first, uint32_t end, struct vec3 value)
{
    struct vvec3 all = v3_all(value);
    for (uint32_t i = first; i < end; i += LANES)
        v3_store(to, i, all);
}

/* ---- texture coordinates ----------------------------------------------------------------------
 */

static void spheres_uv(const struct sphere *sphere, const struct vec3_batch *points, uint32_t first,
                       uint32_t end, double *u, double *v)
{
    struct vvec3 center = v3_all(sphere->center);
    vreal zero = v_all(0);
    for (uint32_t i = first; i < end; i += LANES) {
        struct vvec3 d = v3_sub(v3_load(points, i), center);
        vreal q = v_sqrt(d.x * d.x + d.z * d.z);
        vreal longitude = v_select(v_equal(q, zero), zero, v_angle(d.x, d.z));
        v_store(u + i - first, longitude * (1 / (2 * PI)));
        v_store(v + i - first, v_angle(d.y, q) * (-1 / PI));
    }
}

/* ---- textures, see texture_fetch ---------------------------------------------------------------
 */

struct texel_places {
    vreal at, rest;
};

/* Whole numbers less multiples of the size, with their sign. */
static inline vreal remainders(vreal at, double size)
{
    vmask outside = v_less(at, v_all(0)) | v_at_most(v_all(size), at);
    return v_any(outside) ? v_select(outside, at - size * v_truncate(at / size), at) : at;
}

/* See centred_place. */
static inline struct texel_places centred_places(vreal t, double size)
{
    vreal down = v_truncate(t), whole = v_select(v_less(t, down), down - 1, down);
    vreal at = remainders(whole, size);
    return (struct texel_places){v_select(v_less(at, v_all(0)), at + size, at), t - whole};
}

/* Lanes that are too large to have a fraction, or no numbers, are added to *strange. */
static inline struct texel_places places_on(const struct texture *texture, vreal u, double size,
                                            vmask *strange)
{
    vreal zero = v_all(0), one = v_all(1), t = u * size, at = v_truncate(t), rest = v_abs(t - at);
    if (texture->centred)
        t -= texture->linear ? 0.5 : 0;
    *strange |= v_not(v_less(v_abs(t), v_all(0x1p51)));
    if (texture->centred)
        return centred_places(t, size);
    vmask end = v_equal(u, one);
    at = remainders(at, size);
    vmask below = v_less(at, zero);
    at = v_select(below, at + size, at);
    rest = v_select(below, 1 - rest, rest);
    return (struct texel_places){v_select(end, v_all(size - 1), at), v_select(end, one, rest)};
}

/* The four texels around each place: two in its row, two in the one above. */
struct texel_corners {
    alignas(64) int32_t at[2][BATCH_ROOM]; /* the left one's number */
    uint64_t wraps;                        /* a bit: the right one is column 0 */
    alignas(64) double across[BATCH_ROOM], upwards[BATCH_ROOM]; /* the place between them */
    alignas(64) int64_t pair8[2][BATCH_ROOM];                   /* see image_texels8 */
    struct vec3_batch texel16[2][2];                            /* decoded, if they are to be */
};

static void load_pairs(const struct image *image, const int32_t *at, uint32_t n, uint64_t wraps,
                       int64_t *pair)
{
    for (uint32_t i = 0; i < n; i++)
        pair[i] = image_texels8(image, (size_t)at[i]);
    for (; wraps; wraps &= wraps - 1) {
        int i = __builtin_ctzll(wraps);
        int64_t first = image_texels8(image, (size_t)at[i] + 1 - image->width);
        pair[i] = (pair[i] & 0xffffff) | (first & 0xffffff) << 24;
    }
}

static void load_texels16(const struct texture *texture, const int32_t *at, uint32_t n,
                          uint64_t wraps, struct vec3_batch pair[2])
{
    const struct image *image = texture->image;
    const double *light = texture->decode;
    for (uint32_t i = 0; i < n; i++) {
        size_t left = (size_t)at[i], right = left + 1 - (wraps >> i & 1 ? image->width : 0);
        for (int k = 0; k < 1 + texture->linear; k++) {
            const uint16_t *p = image->data16 + 3 * (k ? right : left);
            vec3_put(&pair[k], i,
                     light ? vec3(light[p[0]], light[p[1]], light[p[2]]) : vec3(p[0], p[1], p[2]));
        }
    }
}

/* Of whole vectors; without a filter only the left ones below are used. */
static void load_texels(const struct texture *texture, uint32_t n, struct texel_corners *c)
{
    for (int row = 0; row < 1 + texture->linear; row++) {
        if (texture->image->data8)
            load_pairs(texture->image, c->at[row], n, c->wraps, c->pair8[row]);
        else
            load_texels16(texture, c->at[row], n, c->wraps, c->texel16[row]);
    }
}

static inline struct vvec3 corner(const struct texture *texture, const struct texel_corners *c,
                                  int row, int right, uint32_t i)
{
    const double *light = texture->decode;
    if (texture->image->data16)
        return v3_load(&c->texel16[row][right], i);
    vint texel = v_load_int(c->pair8[row] + i) >> (right ? 24 : 0);
    vint x = texel & 255, y = texel >> 8 & 255, z = texel >> 16 & 255;
    if (light)
        return (struct vvec3){v_gather(light, x), v_gather(light, y), v_gather(light, z)};
    return (struct vvec3){v_real_of_long(x), v_real_of_long(y), v_real_of_long(z)};
}

static inline struct vvec3 v3_mix(struct vvec3 a, struct vvec3 b, vreal share_of_b)
{
    return v3_mad(v3_scale(a, 1 - share_of_b), share_of_b, b);
}

/* Returns a bit for each place that is none. */
static uint64_t place_corners(const struct texture *texture, const double *u, const double *v,
                              uint32_t n, struct texel_corners *c)
{
    const struct image *image = texture->image;
    double width = image->width, height = image->height;
    vreal zero = v_all(0);
    uint64_t strange = 0;
    c->wraps = 0;
    for (uint32_t i = 0; i < n; i += LANES) {
        vmask none = v_less(zero, zero);
        struct texel_places x = places_on(texture, v_load(u + i), width, &none);
        struct texel_places y = places_on(texture, v_load(v + i), height, &none);
        strange |= (uint64_t)v_bits(none) << i;
        x.at = v_select(none, zero, x.at);
        y.at = v_select(none, zero, y.at);
        v_store_int32(c->at[0] + i, v_int32((height - 1 - y.at) * width + x.at));
        if (!texture->linear)
            continue;
        vreal above = v_select(v_less(y.at + 1, v_all(height)), y.at + 1, zero);
        v_store_int32(c->at[1] + i, v_int32((height - 1 - above) * width + x.at));
        c->wraps |= (uint64_t)v_bits(v_at_most(v_all(width), x.at + 1)) << i;
        v_store(c->across + i, x.rest);
        v_store(c->upwards + i, y.rest);
    }
    return n < BATCH ? strange & ((UINT64_C(1) << n) - 1) : strange;
}

static void texels(const struct texture *texture, const double *u, const double *v, uint32_t first,
                   uint32_t end, struct vec3_batch *out)
{
    const struct image *image = texture->image;
    double full = image->data8 ? 255 : 65535;
    uint32_t n = end - first;
    struct texel_corners c;
    uint64_t strange = place_corners(texture, u + first, v + first, n, &c);
    load_texels(texture, (n + LANES - 1) / LANES * LANES, &c);
    for (uint32_t i = 0; i < n; i += LANES) {
        struct vvec3 t = corner(texture, &c, 0, 0, i);
        if (texture->linear) {
            vreal x = v_load(c.across + i);
            struct vvec3 low = v3_mix(t, corner(texture, &c, 0, 1, i), x);
            struct vvec3 left = corner(texture, &c, 1, 0, i), right = corner(texture, &c, 1, 1, i);
            t = v3_mix(low, v3_mix(left, right, x), v_load(c.upwards + i));
        }
        if (!texture->decode)
            t = (struct vvec3){v_quotient(t.x, full, 1 / full), v_quotient(t.y, full, 1 / full),
                               v_quotient(t.z, full, 1 / full)};
        v3_store(out, first + i, t);
    }
    for (; strange; strange &= strange - 1) {
        uint32_t k = first + (uint32_t)__builtin_ctzll(strange);
        vec3_put(out, k, texture_fetch(texture, u[k], v[k]));
    }
}

static void bend(const struct vec3_batch *texels, const double *bent, struct shade_batch *points)
{
    for (uint32_t i = 0; i < points->n; i += LANES) {
        struct vvec3 texel = v3_load(texels, i), n = v3_load(&points->normal, i);
        struct vvec3 b = {2 * (texel.x - 0.5), -2 * (texel.y - 0.5), v_all(1)};
        b = v3_normalize(b);
        b = v3_normalize((struct vvec3){n.x + b.x, n.y - b.y, n.z});
        v3_store(&points->normal, i, v3_select(v_less(v_all(0), v_load(bent + i)), b, n));
    }
}

/* ---- between points and lights -----------------------------------------------------------------
 */

static void face(struct shade_batch *points)
{
    for (uint32_t i = 0; i < points->n; i += LANES)
        v_store(points->facing + i,
                v3_dot(v3_load(&points->normal, i), v3_load(points->incoming, i)));
}

static void aim_at(const struct light *light, const struct vec3_batch *from, const uint32_t *prims,
                   double t_max, uint32_t n, struct ray_batch *rays)
{
    struct vvec3 position = v3_all(light->position);
    bool sun = light->kind == LIGHT_SUN;
    for (uint32_t i = 0; i < n; i += LANES) {
        struct vvec3 p = v3_load(from, i);
        v3_store(&rays->origin, i, p);
        v3_store(&rays->direction, i, sun ? position : v3_sub(position, p));
        v_store(rays->from + i, v_real(v_load_int32((const int32_t *)prims + i)));
        v_store(rays->t_max + i, v_all(t_max));
    }
}

/* ---- classic light --------------------------------------------------------------------------- */

/* same: n is the same in all lanes. */
static inline vreal whole_powers(vreal x, vint n, bool same)
{
    uint64_t power = (uint64_t)n[0];
    if (same) {
        vreal product = power & 1 ? x : v_all(1);
        while (power >>= 1) {
            x *= x;
            product = power & 1 ? product * x : product;
        }
        return product;
    }
    vreal result = v_select(v_odd(n), x, v_all(1));
    while (v_any_int(n >>= 1)) {
        x *= x;
        result = v_select(v_odd(n), result * x, result);
    }
    return result;
}

/* Where a power is not multiplied out or a metal is textured: one by one. */
static void uneven_lanes(const struct shade_batch *points, uint32_t i, vreal cosine, vreal mirrored,
                         struct vvec3 *lit, vreal *highlight)
{
    for (uint32_t k = 0; k < LANES && i + k < points->n; k++) {
        const struct finish *f = points->finish[i + k];
        if (!f->uneven)
            continue;
        struct vec3 spread = finish_diffuse(f, vec3_get(&points->diffuse, i + k), cosine[k]);
        lit->x[k] = spread.x;
        lit->y[k] = spread.y;
        lit->z[k] = spread.z;
        (*highlight)[k] = finish_highlight(f, mirrored[k]);
    }
}

static vmask glowing_lanes(const struct shade_batch *points, uint32_t i)
{
    alignas(64) double glows[LANES] = {0};
    for (uint32_t k = 0; k < LANES && i + k < points->n; k++)
        glows[k] = points->finish[i + k]->glows;
    return v_less(v_all(0), v_load(glows));
}

/* The material's colours. */
static inline struct vvec3 colours_at(const struct shade_batch *points,
                                      const struct vec3_batch *colours, uint32_t i)
{
    return points->plain ? v3_all(vec3_get(colours, 0)) : v3_load(colours, i);
}

/* What is reflected of light that comes from to_light. */
static struct vvec3 direct_light(const struct shade_batch *points, uint32_t i,
                                 struct vvec3 to_light)
{
    vreal cosine = v3_dot(v3_load(&points->normal, i), to_light);
    vreal mirrored =
        v3_dot(v3_load(points->incoming, i), to_light) - 2 * cosine * v_load(points->facing + i);
    struct vvec3 lit = v3_scale(colours_at(points, &points->diffuse, i), cosine);
    vreal highlight = whole_powers(mirrored, v_load_int(points->power + i), points->one_surface);
    if (points->any_uneven)
        uneven_lanes(points, i, cosine, mirrored, &lit, &highlight);
    return v3_mad(lit, highlight, colours_at(points, &points->specular, i));
}

static void add_light(const struct shade_batch *points, const struct light *light,
                      const double *shares, struct light_batch *sums)
{
    struct vvec3 position = v3_all(light->position), intensity = v3_all(light->intensity);
    for (uint32_t i = 0; i < points->n; i += LANES) {
        vreal share = v_load(shares + i);
        vmask lit = v_not(v_equal(share, v_all(0)));
        struct vvec3 way = v3_sub(position, v3_load(&points->p, i)), arriving = intensity;
        vreal square = v3_dot(way, way);
        if (light->inverse_square)
            arriving =
                (struct vvec3){intensity.x / square, intensity.y / square, intensity.z / square};
        if (points->any_bounces)
            v3_store(&sums->intensity, i, v3_add(v3_load(&sums->intensity, i), arriving));
        if (!v_any(lit))
            continue;
        struct vvec3 direct = direct_light(points, i, v3_scale(way, 1 / v_sqrt(square)));
        direct = v3_scale(direct, share);
        if (points->any_glowing)
            direct = v3_select(glowing_lanes(points, i), v3_load(&points->diffuse, i), direct);
        struct vvec3 sum = v3_load(sums->direct, i);
        v3_store(sums->direct, i, v3_select(lit, v3_add(sum, v3_mul(arriving, direct)), sum));
    }
}

#include "render/modern_lanes.h"

/* ---- the rest -------------------------------------------------------------------------------- */

static void reflect(const struct shade_batch *points, struct ray_batch *rays)
{
    for (uint32_t i = 0; i < points->n; i += LANES) {
        struct vvec3 d = v3_load(points->incoming, i), normal = v3_load(&points->normal, i);
        d = v3_mad(d, -2 * v_load(points->facing + i), normal);
        v3_store(&rays->direction, i, v3_normalize(d));
        v3_store(&rays->origin, i, v3_load(&points->p, i));
        v_store(rays->from + i, v_real(v_load_int32((const int32_t *)points->prim + i)));
    }
}

static uint64_t weigh(const struct vec3_batch *intensity, struct vec3 mirrored, uint32_t n,
                      struct vec3_batch *weight)
{
    vreal zero = v_all(0);
    uint64_t nothing = 0;
    for (uint32_t i = 0; i < n; i += LANES) {
        struct vvec3 w = v3_mul(v3_load(intensity, i), v3_all(mirrored));
        v3_store(weight, i, w);
        vmask none = v_equal(w.x, zero) & v_equal(w.y, zero) & v_equal(w.z, zero);
        nothing |= (uint64_t)v_bits(none) << i;
    }
    return ~nothing & UINT64_MAX >> (BATCH - n);
}

static void add_shares(const struct vec3_batch *weights, const struct vec3_batch *colours,
                       uint32_t n, struct vec3_batch *sums)
{
    for (uint32_t i = 0; i < n; i += LANES)
        v3_store(sums, i,
                 v3_add(v3_load(sums, i), v3_mul(v3_load(weights, i), v3_load(colours, i))));
}

/* The last vector ends at the last element, over what another has seen. */
static void bounds_along(const double *x, uint32_t n, double *least, double *most)
{
    vreal lo = v_all(INFINITY), hi = v_all(-INFINITY);
    for (uint32_t i = 0; i + LANES < n; i += LANES) {
        lo = v_min(v_load(x + i), lo);
        hi = v_max(v_load(x + i), hi);
    }
    lo = v_min(v_load(x + n - LANES), lo);
    hi = v_max(v_load(x + n - LANES), hi);
    *least = v_least(lo);
    *most = v_most(hi);
}

static struct box bounds(const struct vec3_batch *points, uint32_t n)
{
    struct box b;
    if (n < LANES)
        return render_plain.bounds(points, n);
    bounds_along(points->x, n, &b.lo.x, &b.hi.x);
    bounds_along(points->y, n, &b.lo.y, &b.hi.y);
    bounds_along(points->z, n, &b.lo.z, &b.hi.z);
    return b;
}

/* ---- pictures -------------------------------------------------------------------------------- */

static inline vint32 plain_bytes(double rounding, vreal c)
{
    vreal zero = v_all(0), byte = c * 255 + rounding;
    byte = v_select(v_less(c, v_all(1)), byte, v_all(255));
    return v_int32(v_select(v_less(zero, c), byte, zero));
}

/* See srgb_byte. */
static inline vint32 srgb_bytes(const struct srgb_bytes *s, vreal light)
{
    vreal least = v_all(s->from[1]), one = v_all(1);
    vmask some = v_at_most(least, light), full = v_at_most(one, light);
    vint bits = (vint)v_select(v_less(light, one), v_select(some, light, least), least);
    vint byte = v_gather_uint32(s->first, (bits >> (52 - SRGB_DIGITS)) - SRGB_FIRST);
    byte = v_select_int(v_at_most(v_gather(s->from + 1, byte), light), byte + 1, byte);
    byte = v_select_int(full, (vint){0} + 255, v_select_int(some, byte, (vint){0}));
    return __builtin_convertvector(byte, vint32);
}

static inline vint32 bytes_of(const struct picture *out, double rounding, vreal c)
{
    return out->srgb ? srgb_bytes(out->srgb, c) : plain_bytes(rounding, c);
}

static void pack(const struct picture *out, const struct vec3_batch *colours, uint32_t n,
                 uint8_t pixels[PACKED_ROOM])
{
    double rounding = picture_rounding(out);
    for (uint32_t i = 0; i < n; i += LANES) {
        struct vvec3 c = v3_scale(v3_load(colours, i), v_all(out->gain));
        vint32 red = bytes_of(out, rounding, c.x), green = bytes_of(out, rounding, c.y);
        vint32 blue = bytes_of(out, rounding, c.z);
        v_store_triples(pixels + 3 * i, red | green << 8 | blue << 16);
    }
}

const struct render_kernels RENDER_KERNELS = {
    .aim = aim,
    .aim_grid = aim_grid,
    .fill = fill_vectors,
    .hit_points = hit_points,
    .sphere_uv = spheres_uv,
    .texels = texels,
    .bend = bend,
    .face = face,
    .aim_at = aim_at,
    .add_light = add_light,
    .add_modern = add_modern,
    .front = front,
    .give = give,
    .reflect = reflect,
    .weigh = weigh,
    .add_shares = add_shares,
    .bounds = bounds,
    .pack = pack,
    .see = see,
};
