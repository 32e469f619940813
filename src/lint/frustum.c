#include "config.h"

#include "lint/frustum.h"

/* Boxes count as beyond a plane when they are so by this times the coordinates involved: many times
 * the rounding errors of the planes. */
#define FRUSTUM_TOLERANCE 1e-12

static void set_side(struct frustum *f, enum frustum_side side, struct vec3 p, struct vec3 normal)
{
    f->normal[side] = vec3_normalize(normal);
    f->at[side] = vec3_dot(f->normal[side], p);
}

/* The plane of the rays through two corners, anticlockwise seen from the eye: its inner side is the
 * picture's in every kind of camera. */
static void set_corner_side(struct frustum *f, enum frustum_side side, const double a[2],
                            const double b[2])
{
    const struct lens *l = &f->lens;
    struct vec3 p = lens_origin(l, a[0], a[1]);
    struct vec3 along = lens_direction(l, a[0], a[1]);
    struct vec3 other =
        l->parallel ? vec3_sub(lens_origin(l, b[0], b[1]), p) : lens_direction(l, b[0], b[1]);
    set_side(f, side, p, vec3_cross(along, other));
}

struct frustum frustum_of(const struct camera *c)
{
    struct frustum f = {.lens = lens_of(c, c->width, c->height)};
    double x = 1 + 2.0 / c->width, y = 1 + 2.0 / c->height;
    const double corners[4][2] = {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
    set_side(&f, FRUSTUM_EYE, f.lens.origin, lens_direction(&f.lens, 0, 0));
    set_corner_side(&f, FRUSTUM_BELOW, corners[0], corners[1]);
    set_corner_side(&f, FRUSTUM_RIGHT, corners[1], corners[2]);
    set_corner_side(&f, FRUSTUM_ABOVE, corners[2], corners[3]);
    set_corner_side(&f, FRUSTUM_LEFT, corners[3], corners[0]);
    return f;
}

/* How far along the normal the box's farthest corner is. */
static double farthest(struct vec3 n, struct box b)
{
    return n.x * (n.x > 0 ? b.hi.x : b.lo.x) + n.y * (n.y > 0 ? b.hi.y : b.lo.y) +
           n.z * (n.z > 0 ? b.hi.z : b.lo.z);
}

static double tolerance_at(const struct frustum *f, struct box b)
{
    double reach = fmax(vec3_largest(b.lo), vec3_largest(b.hi));
    return FRUSTUM_TOLERANCE * (reach + vec3_largest(f->lens.origin));
}

unsigned frustum_beyond(const struct frustum *f, struct box b)
{
    unsigned sides = 0;
    double tolerance = tolerance_at(f, b);
    for (unsigned i = 0; i < FRUSTUM_SIDES; i++)
        if (farthest(f->normal[i], b) < f->at[i] - tolerance)
            sides |= 1u << i;
    return sides;
}

unsigned frustum_within(const struct frustum *f, struct box b)
{
    unsigned sides = 0;
    double tolerance = tolerance_at(f, b);
    for (unsigned i = 0; i < FRUSTUM_SIDES; i++)
        if (-farthest(vec3_neg(f->normal[i]), b) > f->at[i] + tolerance)
            sides |= 1u << i;
    return sides;
}

unsigned frustum_keeps(const struct frustum *f, struct vec3 direction)
{
    unsigned sides = 0;
    for (unsigned i = 0; i < FRUSTUM_SIDES; i++)
        if (vec3_dot(f->normal[i], direction) >= 0)
            sides |= 1u << i;
    return sides;
}

/* ---- projection ------------------------------------------------------------------------------ */

/* The place in the picture of a point in front of the eye. */
static struct vec2 place_of(const struct lens *l, struct vec3 p)
{
    struct vec3 d = vec3_sub(p, l->origin);
    if (l->mirrored)
        d.z = -d.z;
    double depth = l->parallel ? 1 : vec3_dot(d, l->ahead);
    return (struct vec2){vec3_dot(d, l->across) / vec3_dot(l->across, l->across) / depth,
                         vec3_dot(d, l->upwards) / vec3_dot(l->upwards, l->upwards) / depth};
}

static struct vec3 corner_of(struct box b, int i)
{
    return vec3(i & 1 ? b.hi.x : b.lo.x, i & 2 ? b.hi.y : b.lo.y, i & 4 ? b.hi.z : b.lo.z);
}

static double overlap(double lo, double hi)
{
    return fmax(fmin(hi, 1) - fmax(lo, -1), 0) / 2;
}

/* A box that reaches behind the eye may be anywhere. */
double frustum_share(const struct frustum *f, struct box b)
{
    struct vec2 lo = {INFINITY, INFINITY}, hi = {-INFINITY, -INFINITY};
    if (frustum_beyond(f, b))
        return 0;
    if (!(frustum_within(f, b) & 1u << FRUSTUM_EYE))
        return 1;
    for (int i = 0; i < 8; i++) {
        struct vec2 p = place_of(&f->lens, corner_of(b, i));
        lo = (struct vec2){fmin(lo.x, p.x), fmin(lo.y, p.y)};
        hi = (struct vec2){fmax(hi.x, p.x), fmax(hi.y, p.y)};
    }
    return overlap(lo.x, hi.x) * overlap(lo.y, hi.y);
}
