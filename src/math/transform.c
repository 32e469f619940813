#include "config.h"

#include "math/transform.h"

/* The angle less the nearest whole number of quarter turns, in radians; *quarter says how many,
 * modulo 4. Both steps before the last product are exact. */
static double reduce(double degrees, int *quarter)
{
    double rest = fmod(degrees, 360), turns = nearbyint(rest / 90);
    *quarter = (int)turns & 3;
    return (rest - 90 * turns) * (PI / 180);
}

double sin_degrees(double angle)
{
    int quarter;
    double x = reduce(angle, &quarter);
    double s = quarter & 1 ? cos(x) : sin(x);
    return quarter & 2 ? -s : s;
}

double cos_degrees(double angle)
{
    int quarter;
    double x = reduce(angle, &quarter);
    double c = quarter & 1 ? sin(x) : cos(x);
    return quarter == 1 || quarter == 2 ? -c : c;
}

struct affine affine_translation(struct vec3 t)
{
    return (struct affine){{{1, 0, 0, t.x}, {0, 1, 0, t.y}, {0, 0, 1, t.z}}};
}

struct affine affine_scaling(struct vec3 s)
{
    return (struct affine){{{s.x, 0, 0, 0}, {0, s.y, 0, 0}, {0, 0, s.z, 0}}};
}

struct affine affine_rotation(struct vec3 degrees)
{
    double sx = sin_degrees(degrees.x), cx = cos_degrees(degrees.x);
    double sy = sin_degrees(degrees.y), cy = cos_degrees(degrees.y);
    double sz = sin_degrees(degrees.z), cz = cos_degrees(degrees.z);
    struct affine x = {{{1, 0, 0, 0}, {0, cx, -sx, 0}, {0, sx, cx, 0}}};
    struct affine y = {{{cy, 0, sy, 0}, {0, 1, 0, 0}, {-sy, 0, cy, 0}}};
    struct affine z = {{{cz, -sz, 0, 0}, {sz, cz, 0, 0}, {0, 0, 1, 0}}};
    struct affine yx = affine_times(&y, &x);
    return affine_times(&z, &yx);
}

struct affine affine_times(const struct affine *a, const struct affine *b)
{
    struct affine out;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++)
            out.m[i][j] =
                a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
        out.m[i][3] += a->m[i][3];
    }
    return out;
}

double affine_determinant(const struct affine *a)
{
    const double(*m)[4] = a->m;
    struct vec3 rows[3];
    for (int i = 0; i < 3; i++)
        rows[i] = vec3(m[i][0], m[i][1], m[i][2]);
    return vec3_dot(rows[0], vec3_cross(rows[1], rows[2]));
}

/* Rodrigues' formula. */
struct vec3 vec3_rotate(struct vec3 v, struct vec3 axis, double degrees)
{
    double s = sin_degrees(degrees), c = cos_degrees(degrees);
    struct vec3 k = vec3_normalize(vec3_scale(axis, 1 / vec3_largest(axis)));
    struct vec3 turned = vec3_mad(vec3_scale(v, c), s, vec3_cross(k, v));
    return vec3_mad(turned, vec3_dot(k, v) * (1 - c), k);
}
