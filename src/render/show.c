#include "config.h"

#include "render/tracer.h"

/* A colour of 24 bits that no other surface has: an odd factor permutes the numbers below 2^24. */
static struct vec3 number_colour(uint32_t surface)
{
    uint32_t c = (surface + 1) * UINT32_C(0x9e3779b1) & 0xffffff;
    return vec3((c >> 16) / 255.0, (c >> 8 & 255) / 255.0, (c & 255) / 255.0);
}

/* Distances as bytes: 1 for the nearest of the picture falling to 0.1 for the farthest. */
static double distance_grey(double t, const double range[2])
{
    if (!(range[1] > range[0]))
        return 1;
    return 1 - 0.9 * ((t - range[0]) / (range[1] - range[0]));
}

static struct vec3 shown_colour(const struct tracer *t, const struct shade_batch *points,
                                uint32_t k, const double range[2], bool bytes)
{
    if (t->options->show == SHOW_DEPTH)
        return vec3_all(bytes ? distance_grey(points->t[k], range) : points->t[k]);
    if (t->options->show == SHOW_NORMALS)
        return vec3_add(vec3_scale(vec3_get(&points->normal, k), 0.5), vec3_all(0.5));
    return number_colour(points->surface[k]);
}

void show_batch(struct worker *w, const struct ray_batch *rays, const double range[2], bool bytes,
                struct vec3_batch *colours)
{
    vec3_fill(colours, 0, rays->n, vec3_all(0));
    find_points(w, rays, NULL);
    for (uint32_t k = 0; k < w->points.n; k++)
        vec3_put(colours, w->points.ray[k], shown_colour(w->tracer, &w->points, k, range, bytes));
}
