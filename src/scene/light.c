#include "config.h"

#include "scene/scene.h"

#include <assert.h>

/* One axis of the grid: its different coordinates and how often each occurs. */
struct grid_axis {
    double *at;
    uint32_t *count;
    uint32_t n;
};

static struct grid_axis grid_axis(double lo, double hi, uint32_t samples)
{
    struct grid_axis a = {mem_alloc(samples, sizeof *a.at), mem_alloc(samples, sizeof *a.count), 0};
    for (uint32_t i = 0; i < samples; i++) {
        double x = i + 1 < samples ? lo + (hi - lo) * (i / (double)(samples - 1)) : hi;
        if (a.n > 0 && a.at[a.n - 1] == x) {
            a.count[a.n - 1]++;
        } else {
            a.at[a.n] = x;
            a.count[a.n++] = 1;
        }
    }
    return a;
}

static void grid_axis_free(struct grid_axis *a)
{
    free(a->at);
    free(a->count);
}

static bool lies_on_object(const struct geometry *object, struct vec3 p)
{
    for (uint32_t i = 0; i < object->prims.n; i++)
        if (geometry_lies_on(object, i, p, vec3_largest(p)))
            return true;
    return false;
}

/* Deep enough inside a sphere that no rounding error lets a ray through p miss it. */
static bool lies_inside(const struct geometry *object, struct vec3 p)
{
    if (object->prims.n != 1 || object->prims.at[0].kind != PRIM_SPHERE)
        return false;
    const struct sphere *s = &object->spheres.at[0];
    double reach = vec3_largest(s->center) + s->radius;
    return vec3_length(vec3_sub(p, s->center)) < s->radius - 1e-9 * reach;
}

void light_sample_grid(struct light *l, struct box box, uint32_t samples)
{
    assert(samples >= 2);
    struct grid_axis x = grid_axis(box.lo.x, box.hi.x, samples);
    struct grid_axis y = grid_axis(box.lo.y, box.hi.y, samples);
    struct grid_axis z = grid_axis(box.lo.z, box.hi.z, samples);
    l->points.n = 0;
    vec_reserve(&l->points, (size_t)x.n * y.n * z.n);
    for (uint32_t i = 0; i < x.n; i++) {
        for (uint32_t j = 0; j < y.n; j++) {
            for (uint32_t k = 0; k < z.n; k++) {
                struct vec3 p = vec3(x.at[i], y.at[j], z.at[k]);
                vec_push(&l->points,
                         (struct light_point){.position = p,
                                              .count = x.count[i] * y.count[j] * z.count[k],
                                              .on_object = lies_on_object(&l->object, p),
                                              .inside = lies_inside(&l->object, p)});
            }
        }
    }
    grid_axis_free(&x);
    grid_axis_free(&y);
    grid_axis_free(&z);
}

/* ---- modern: the light's surface --------------------------------------------------------------
 */

static struct vec3 corner_of(const struct geometry *g, const struct triangle *t, int i)
{
    return g->vertices.at[t->vertex[i]];
}

/* Twice the area, times the unit normal. */
static struct vec3 triangle_span(const struct geometry *g, const struct triangle *t)
{
    struct vec3 a = corner_of(g, t, 0);
    return vec3_cross(vec3_sub(corner_of(g, t, 1), a), vec3_sub(corner_of(g, t, 2), a));
}

/* Where the shape of a primitive is: in an instance, which then holds just one, or in g itself. */
static const struct geometry *shape_of(const struct geometry *g, struct prim *prim)
{
    if (prim->kind != PRIM_INSTANCE)
        return g;
    const struct instance *i = &g->instances.at[prim->index];
    const struct geometry *shapes = &g->prototypes.at[i->prototype]->shapes;
    assert(i->only != PRIM_NONE);
    *prim = shapes->prims.at[i->only];
    return shapes;
}

/* Of an instance before it is placed. */
static double prim_area(const struct geometry *g, struct prim prim)
{
    g = shape_of(g, &prim);
    if (prim.kind == PRIM_SPHERE) {
        double r = g->spheres.at[prim.index].radius;
        return 4 * PI * r * r;
    }
    if (prim.kind == PRIM_CYLINDER) {
        const struct cylinder *c = &g->cylinders.at[prim.index];
        return 2 * PI * c->radius * (c->radius + c->height);
    }
    return vec3_length(triangle_span(g, &g->triangles.at[prim.index])) / 2;
}

/* Archimedes: equal heights of a sphere have equal areas. */
static struct light_sample on_sphere(const struct sphere *s, double a, double b)
{
    double z = 1 - 2 * a, across = sqrt(1 - z * z), turn = 2 * PI * b;
    struct vec3 n = vec3(across * cos(turn), z, across * sin(turn));
    return (struct light_sample){.position = vec3_mad(s->center, s->radius, n), .normal = n};
}

/* a runs over the base, the side and the top. */
static struct light_sample on_cylinder(const struct cylinder *c, double a, double b)
{
    struct vec3 x, y;
    vec3_basis(c->axis, &x, &y);
    double turn = 2 * PI * b, cap = c->radius, at = a * 2 * (c->radius + c->height);
    struct vec3 out = vec3_mad(vec3_scale(x, cos(turn)), sin(turn), y);
    if (at >= cap && at < cap + 2 * c->height) {
        struct vec3 axis_point = vec3_mad(c->base, (at - cap) / 2, c->axis);
        return (struct light_sample){.position = vec3_mad(axis_point, c->radius, out),
                                     .normal = out};
    }
    bool top = at >= cap;
    double share = top ? (at - cap - 2 * c->height) / cap : at / cap;
    struct vec3 center = top ? vec3_mad(c->base, c->height, c->axis) : c->base;
    return (struct light_sample){.position = vec3_mad(center, c->radius * sqrt(share), out),
                                 .normal = top ? c->axis : vec3_neg(c->axis)};
}

/* Turk, Generating random points in triangles, Graphics Gems 1990. */
static struct light_sample on_triangle(const struct geometry *g, const struct triangle *t, double a,
                                       double b)
{
    double root = sqrt(a);
    struct vec3 p = vec3_scale(corner_of(g, t, 0), 1 - root);
    p = vec3_mad(p, root * (1 - b), corner_of(g, t, 1));
    return (struct light_sample){.position = vec3_mad(p, root * b, corner_of(g, t, 2)),
                                 .normal = t->normal};
}

/* The first primitive whose area, with all before it, is more than `area`. */
static size_t prim_at_area(const struct light *l, double area)
{
    size_t lo = 0, hi = l->areas.n - 1;
    while (lo < hi) {
        size_t middle = (lo + hi) / 2;
        if (l->areas.at[middle] > area)
            hi = middle;
        else
            lo = middle + 1;
    }
    return lo;
}

static struct light_sample on_shape(const struct geometry *g, struct prim prim, double a, double b)
{
    g = shape_of(g, &prim);
    if (prim.kind == PRIM_SPHERE)
        return on_sphere(&g->spheres.at[prim.index], a, b);
    if (prim.kind == PRIM_CYLINDER)
        return on_cylinder(&g->cylinders.at[prim.index], a, b);
    return on_triangle(g, &g->triangles.at[prim.index], a, b);
}

/* Puts a sample of an instance's shape in its place; returns how much the area around it grows. */
static double place_sample(const struct instance *i, struct light_sample *s)
{
    struct vec3 n = affine_normal(&i->to_shape, s->normal);
    double length = vec3_length(n);
    s->position = affine_point(&i->to_world, s->position);
    s->normal = vec3_scale(n, 1 / length);
    return length * fabs(affine_determinant(&i->to_world));
}

struct light_sample light_surface_at(const struct light *l, double a, double b)
{
    const struct geometry *g = &l->object;
    double area = a * l->areas.at[l->areas.n - 1];
    size_t i = prim_at_area(l, area);
    double before = i > 0 ? l->areas.at[i - 1] : 0, own = l->areas.at[i] - before;
    double within = own > 0 ? (area - before) / own : 0;
    struct prim prim = g->prims.at[i];
    struct light_sample s = on_shape(g, prim, within < 1 ? within : 0x1.fffffffffffffp-1, b);
    s.share = (l->both_sides ? 1 : 4) / ((double)l->grid * l->grid);
    if (prim.kind == PRIM_INSTANCE)
        s.share *= place_sample(&g->instances.at[prim.index], &s) / l->growth;
    return s;
}

/* Whether the triangles' normals add up to nothing, as those of a closed surface do. */
static bool encloses_space(const struct geometry *g)
{
    struct vec3 sum = vec3_all(0);
    double area = 0;
    if (g->triangles.n == 0)
        return true;
    for (size_t i = 0; i < g->triangles.n; i++) {
        struct vec3 span = triangle_span(g, &g->triangles.at[i]);
        sum = vec3_add(sum, span);
        area += vec3_length(span);
    }
    return vec3_length(sum) < 1e-6 * area;
}

bool light_surface(struct light *l, uint32_t grid)
{
    const struct geometry *g = &l->object;
    double area = 0;
    for (size_t i = 0; i < g->prims.n; i++) {
        area += prim_area(g, g->prims.at[i]);
        vec_push(&l->areas, area);
    }
    if (!(area > 0 && area <= DBL_MAX))
        return false;
    l->grid = grid;
    l->growth = 1;
    l->both_sides = !encloses_space(g);
    double shares = 0;
    for (uint32_t i = 0; i < grid; i++) {
        for (uint32_t j = 0; j < grid; j++) {
            vec_push(&l->samples, light_surface_at(l, (i + 0.5) / grid, (j + 0.5) / grid));
            shares += l->samples.at[l->samples.n - 1].share;
        }
    }
    l->growth = shares / (l->both_sides ? 1 : 4);
    for (size_t i = 0; i < l->samples.n; i++)
        l->samples.at[i].share /= l->growth;
    return true;
}
