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
