/* Triangles and quads one by one. */
#include "config.h"

#include "lint/flats.h"

#include "lint/checks.h"

#include <math.h>

static const struct desc_prop *flat_vertices(const struct desc_object *o)
{
    return o->kind == KIND_TRIANGLE ? desc_find(o, PROP_TRIANGLE_VERTICES)
           : o->kind == KIND_QUAD   ? desc_find(o, PROP_QUAD_VERTICES)
                                    : NULL;
}

struct span flat_span(const struct desc_object *o)
{
    const struct desc_prop *p = flat_vertices(o);
    return !p ? o->span : o->xml ? span_join(p->name_span, p->value.span) : p->value.span;
}

int flat_triangles(const struct desc_object *o, struct vec3 out[2][3])
{
    static const uint8_t order[2][3] = {{0, 1, 2}, {2, 3, 0}};
    const struct desc_prop *p = flat_vertices(o);
    int n = !p ? 0 : o->kind == KIND_QUAD ? 2 : 1;
    for (int t = 0; t < n; t++)
        for (int i = 0; i < 3; i++) {
            struct vec3 v = p->value.points[order[t][i]];
            out[t][i] = o->place ? affine_point(o->place, v) : v;
        }
    return n;
}

/* The sides from the first corner, made about as long as 1 so that no product overflows; *longest
 * is the square of the longest side. */
static void sides(const struct vec3 v[3], struct vec3 *a, struct vec3 *b, double *longest)
{
    *a = vec3_sub(v[1], v[0]);
    *b = vec3_sub(v[2], v[0]);
    double scale = fmax(vec3_largest(*a), vec3_largest(*b));
    if (scale > 0) {
        *a = vec3_scale(*a, 1 / scale);
        *b = vec3_scale(*b, 1 / scale);
    }
    struct vec3 c = vec3_sub(*b, *a);
    *longest = fmax(vec3_dot(*a, *a), fmax(vec3_dot(*b, *b), vec3_dot(c, c)));
}

double flat_relative_height(const struct vec3 v[3])
{
    struct vec3 a, b;
    double longest;
    sides(v, &a, &b, &longest);
    return longest > 0 ? vec3_length(vec3_cross(a, b)) / longest : 0;
}

struct vec3 flat_normal(const struct vec3 v[3])
{
    struct vec3 a, b;
    double longest;
    sides(v, &a, &b, &longest);
    return vec3_normalize(vec3_cross(a, b));
}

/* ---- checks ---- */

static void check_area(const struct lint *l, const struct desc_object *o)
{
    struct vec3 t[2][3];
    int n = flat_triangles(o, t), flat = 0;
    for (int i = 0; i < n; i++)
        flat += flat_relative_height(t[i]) < LINT(LEAST_HEIGHT);
    if (flat)
        diag_report(l->diag, DIAG_DEGENERATE_TRIANGLE, flat_span(o),
                    flat < n ? "one half of this %s has no area" : "this %s has no area",
                    schema_kind_name(o->kind, o->xml));
}

void lint_areas(const struct lint *l)
{
    lint_each_surface(l, check_area);
}

static void check_plane(const struct lint *l, const struct desc_object *o)
{
    struct vec3 t[2][3];
    if (o->kind != KIND_QUAD)
        return;
    flat_triangles(o, t);
    if (flat_relative_height(t[0]) < LINT(LEAST_HEIGHT))
        return;
    struct vec3 to_fourth = vec3_sub(t[1][1], t[0][0]), diagonal = vec3_sub(t[0][2], t[0][0]);
    struct vec3 side = vec3_sub(t[0][1], t[0][0]);
    double size = fmax(vec3_largest(to_fourth), fmax(vec3_largest(diagonal), vec3_largest(side)));
    double off = fabs(vec3_dot(vec3_scale(to_fourth, 1 / size), flat_normal(t[0])));
    if (off > LINT(MOST_OFF_PLANE))
        diag_report(l->diag, DIAG_NON_PLANAR_QUAD, flat_span(o),
                    "the fourth corner is off the plane of the others by %.3g of the size: the "
                    "quad is bent along a diagonal",
                    off);
}

void lint_planes(const struct lint *l)
{
    lint_each_surface(l, check_plane);
}

/* The halves are v0 v1 v2 and v2 v3 v0: with v1 and v3 on one side of the diagonal they cover each
 * other.  A dart whose inner corner is v0 or v2 is right. */
static void check_fold(const struct lint *l, const struct desc_object *o)
{
    struct vec3 t[2][3];
    if (flat_triangles(o, t) < 2 || flat_relative_height(t[0]) < LINT(LEAST_HEIGHT) ||
        flat_relative_height(t[1]) < LINT(LEAST_HEIGHT) ||
        vec3_dot(flat_normal(t[0]), flat_normal(t[1])) >= 0)
        return;
    struct diag_entry *e = diag_report(l->diag, DIAG_FOLDED_QUAD, flat_span(o),
                                       "the two halves of this quad lie on each other");
    diag_note(e, "it is the triangles v0 v1 v2 and v2 v3 v0: give the corners in the order around "
                 "it, beginning at the inner one if it has one");
}

void lint_folds(const struct lint *l)
{
    lint_each_surface(l, check_fold);
}
