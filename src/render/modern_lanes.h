/* Light of `model modern` on vectors of points, or of samples; part of kernels_lanes.h.  The same
 * operations in the same order as in modern.c. */
#include "math/lanes.h"
#include "render/tracer.h"

/* How far behind a point a lamp must be, over its distance, to surely give it no light: far more
 * than rounding errors. */
#define FRONT_MARGIN -1e-12

/* Points as their eyes see them, see struct seen_point. */
struct vseen {
    struct vvec3 p, incoming, normal, smooth, diffuse, specular;
    vint power;
    const struct finish *const *finish; /* of lane k: finish[step * k] */
    uint32_t step, lanes;               /* lanes that are points */
    bool squared;                       /* all highlights are multiplied out */
    bool alike;                         /* to the same power */
};

static inline void turn_to_eye(struct vseen *s, struct vvec3 geometric)
{
    vmask behind = v_less(v_all(0), v3_dot(geometric, s->incoming));
    s->normal = v3_select(behind, v3_neg(s->normal), s->normal);
    s->smooth = v3_select(behind, v3_neg(s->smooth), s->smooth);
}

static inline struct vseen seen_points(const struct shade_batch *b, uint32_t i)
{
    struct vseen s = {.p = v3_load(&b->p, i),
                      .incoming = v3_load(b->incoming, i),
                      .normal = v3_load(&b->normal, i),
                      .smooth = v3_load(smooth_normals(b), i),
                      .diffuse = v3_load(&b->diffuse, i),
                      .specular = v3_load(&b->specular, i),
                      .power = v_load_int(b->power + i),
                      .finish = b->finish + i,
                      .step = 1,
                      .lanes = b->n - i < LANES ? b->n - i : LANES,
                      .squared = !b->any_uneven,
                      .alike = b->one_surface};
    turn_to_eye(&s, v3_load(geometric_normals(b), i));
    return s;
}

/* Point k in all lanes. */
static inline struct vseen seen_point(const struct shade_batch *b, uint32_t k)
{
    struct vseen s = {.p = v3_all(vec3_get(&b->p, k)),
                      .incoming = v3_all(vec3_get(b->incoming, k)),
                      .normal = v3_all(vec3_get(&b->normal, k)),
                      .smooth = v3_all(vec3_get(smooth_normals(b), k)),
                      .diffuse = v3_all(vec3_get(&b->diffuse, k)),
                      .specular = v3_all(vec3_get(&b->specular, k)),
                      .power = (vint){0} + b->power[k],
                      .finish = b->finish + k,
                      .lanes = LANES,
                      .squared = b->finish[k]->squared,
                      .alike = true};
    turn_to_eye(&s, v3_all(vec3_get(geometric_normals(b), k)));
    return s;
}

/* See terminator(). */
static inline vreal terminators(vreal cosine, vreal smooth_cosine, vreal between)
{
    vreal g = smooth_cosine / (cosine * between), one = v_all(1);
    return v_select(v_less(g, one) & v_less(v_all(0), between), g * (1 + g * (1 - g)), one);
}

static vreal highlights(const struct vseen *s, vreal mirrored, vmask wanted)
{
    vreal highlight = whole_powers(mirrored, s->power, s->alike);
    unsigned lanes = s->squared ? 0 : v_bits(wanted) & ((1u << s->lanes) - 1);
    for (; lanes; lanes &= lanes - 1) {
        int k = __builtin_ctz(lanes);
        highlight[k] = finish_highlight(s->finish[s->step * (uint32_t)k], mirrored[k]);
    }
    return highlight;
}

/* What is reflected of light of strength 1, lanes that get none from behind set to 0. */
static struct vvec3 lights_reflected(const struct vseen *s, struct vvec3 to_light)
{
    vreal zero = v_all(0), cosine = v3_dot(s->normal, to_light);
    vreal smooth_cosine = v3_dot(s->smooth, to_light);
    vmask front = v_less(zero, cosine) & v_less(zero, smooth_cosine);
    struct vvec3 none = {zero, zero, zero};
    if (!v_any(front))
        return none;
    vreal mirrored = v3_dot(s->incoming, to_light) - 2 * cosine * v3_dot(s->normal, s->incoming);
    vmask shines = front & v_less(zero, mirrored);
    struct vvec3 light = v3_scale(s->diffuse, cosine);
    if (v_any(shines))
        light =
            v3_select(shines, v3_mad(light, highlights(s, mirrored, shines), s->specular), light);
    light = v3_scale(light, terminators(cosine, smooth_cosine, v3_dot(s->normal, s->smooth)));
    return v3_select(front, light, none);
}

static void add_modern(const struct shade_batch *points, const struct light *light,
                       const double *shares, struct light_batch *sums)
{
    struct vvec3 position = v3_all(light->position), intensity = v3_all(light->intensity);
    for (uint32_t i = 0; i < points->n; i += LANES) {
        vmask lit = v_not(v_equal(v_load(shares + i), v_all(0)));
        if (points->any_glowing)
            lit &= v_not(glowing_lanes(points, i));
        if (!v_any(lit))
            continue;
        struct vseen s = seen_points(points, i);
        struct vvec3 to_light = position, sum = v3_load(sums->direct, i);
        vreal strength = v_all(1);
        if (light->kind == LIGHT_POINT) {
            struct vvec3 way = v3_sub(position, s.p);
            vreal square = v3_dot(way, way);
            to_light = v3_scale(way, 1 / v_sqrt(square));
            strength = light->inverse_square ? 1 / square : strength;
        }
        struct vvec3 reflected = v3_mul(lights_reflected(&s, to_light), intensity);
        v3_store(sums->direct, i, v3_select(lit, v3_mad(sum, strength, reflected), sum));
    }
}

/* The most that n . (x - p) can be for a place x of the lamp that shines, and the largest |x - p|.
 */
static inline vmask may_face(struct vvec3 n, struct vvec3 to_center, vreal distance, double radius)
{
    vreal most = v3_dot(n, to_center) + radius * v_sqrt(v3_dot(n, n));
    return v_not(v_less(most, FRONT_MARGIN * (distance + radius)));
}

/* Of point lights and suns by the very cosines that decide what is reflected, of others by a ball
 * around them. */
static uint64_t front(const struct shade_batch *points, const struct lamp *lamp)
{
    struct vvec3 position = v3_all(lamp->light->position);
    uint64_t bits = 0;
    for (uint32_t i = 0; i < points->n; i += LANES) {
        struct vseen s = seen_points(points, i);
        struct vvec3 way = position;
        vmask faces;
        if (lamp->light->kind == LIGHT_AREA) {
            way = v3_sub(v3_all(lamp->center), s.p);
            vreal distance = v_sqrt(v3_dot(way, way));
            faces = may_face(s.normal, way, distance, lamp->radius) &
                    may_face(s.smooth, way, distance, lamp->radius);
        } else {
            if (lamp->light->kind == LIGHT_POINT) {
                way = v3_sub(position, s.p);
                way = v3_scale(way, 1 / v_sqrt(v3_dot(way, way)));
            }
            faces =
                v_less(v_all(0), v3_dot(s.normal, way)) & v_less(v_all(0), v3_dot(s.smooth, way));
        }
        bits |= (uint64_t)v_bits(faces) << i;
    }
    return bits;
}

static void give(const struct shade_batch *points, uint32_t k, const struct light *light,
                 const struct sample_batch *samples, struct vec3_batch *gives)
{
    struct vseen s = seen_point(points, k);
    struct vvec3 intensity = v3_all(light->intensity);
    vreal zero = v_all(0);
    for (uint32_t i = 0; i < samples->n; i += LANES) {
        struct vvec3 way = v3_sub(v3_load(&samples->position, i), s.p);
        vreal square = v3_dot(way, way);
        struct vvec3 to_light = v3_scale(way, 1 / v_sqrt(square));
        vreal cosine = -v3_dot(v3_load(&samples->normal, i), to_light);
        if (light->both_sides)
            cosine = v_abs(cosine);
        vmask front = v_less(zero, cosine);
        vreal strength = v_load(samples->share + i) * cosine;
        if (light->inverse_square)
            strength /= square;
        struct vvec3 lit = v3_mul(lights_reflected(&s, to_light), intensity);
        lit = v3_scale(lit, strength);
        v3_store(gives, i, v3_select(front, lit, (struct vvec3){zero, zero, zero}));
    }
}
