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

static struct vec3 column(const struct affine *a, int j)
{
    return vec3(a->m[0][j], a->m[1][j], a->m[2][j]);
}

/* 2^-k, which brings the largest of the numbers between 1/2 and 1. */
static double to_one(struct vec3 v)
{
    int exponent;
    frexp(vec3_largest(v), &exponent);
    return ldexp(1, -exponent);
}

/* Rows and columns are brought to the order of 1 by powers of two, so that only a map that really
 * flattens has a determinant near 0. */
bool affine_invert(const struct affine *a, struct affine *out)
{
    struct vec3 rows[3], inverse[3];
    double by_column[3], by_row[3];
    for (int j = 0; j < 3; j++)
        by_column[j] = to_one(column(a, j));
    for (int i = 0; i < 3; i++) {
        rows[i] =
            vec3(a->m[i][0] * by_column[0], a->m[i][1] * by_column[1], a->m[i][2] * by_column[2]);
        by_row[i] = to_one(rows[i]);
        rows[i] = vec3_scale(rows[i], by_row[i]);
    }
    for (int i = 0; i < 3; i++)
        inverse[i] = vec3_cross(rows[(i + 1) % 3], rows[(i + 2) % 3]);
    double volume = vec3_dot(rows[0], inverse[0]);
    if (!(fabs(volume) > 0x1p-48))
        return false;
    bool finite = true;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            out->m[i][j] = vec3_at(inverse[j], i) / volume * by_row[j] * by_column[i];
        finite = finite && isfinite(out->m[i][0] + out->m[i][1] + out->m[i][2]);
        out->m[i][3] = 0;
    }
    struct vec3 back = affine_vector(out, column(a, 3));
    out->m[0][3] = -back.x;
    out->m[1][3] = -back.y;
    out->m[2][3] = -back.z;
    return finite && isfinite(back.x + back.y + back.z);
}

/* What products of a few turns may be off by, relative to the factor's square. */
#define TURN_ROUNDING 0x1p-46

bool affine_is_similarity(const struct affine *a, double *factor)
{
    struct vec3 x = column(a, 0), y = column(a, 1), z = column(a, 2);
    double square = vec3_dot(x, x), rounding = TURN_ROUNDING * square;
    *factor = x.y == 0 && x.z == 0 ? fabs(x.x) : sqrt(square);
    return fabs(vec3_dot(y, y) - square) <= rounding && fabs(vec3_dot(z, z) - square) <= rounding &&
           fabs(vec3_dot(x, y)) <= rounding && fabs(vec3_dot(y, z)) <= rounding &&
           fabs(vec3_dot(z, x)) <= rounding;
}

bool affine_keeps_directions(const struct affine *a)
{
    const double(*m)[4] = a->m;
    return m[0][0] > 0 && m[1][1] == m[0][0] && m[2][2] == m[0][0] && m[0][1] == 0 &&
           m[0][2] == 0 && m[1][0] == 0 && m[1][2] == 0 && m[2][0] == 0 && m[2][1] == 0;
}

/* Rodrigues' formula. */
struct vec3 vec3_rotate(struct vec3 v, struct vec3 axis, double degrees)
{
    double s = sin_degrees(degrees), c = cos_degrees(degrees);
    struct vec3 k = vec3_normalize(vec3_scale(axis, 1 / vec3_largest(axis)));
    struct vec3 turned = vec3_mad(vec3_scale(v, c), s, vec3_cross(k, v));
    return vec3_mad(turned, vec3_dot(k, v) * (1 - c), k);
}
