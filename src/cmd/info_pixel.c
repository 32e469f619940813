#include "config.h"

#include "cmd/info.h"

#include "scene/camera.h"

/* Of one sample a pixel. */
static struct ray ray_of(const struct camera *c, const struct options *o, uint32_t x, uint32_t y)
{
    uint32_t width = o->width ? o->width : c->width, height = o->width ? o->height : c->height;
    struct lens lens = lens_of(c, width, height);
    double in_pixel = camera_sample(c);
    double across = camera_place(c, x + in_pixel, width);
    double up = camera_place(c, height - 1 - y + in_pixel, height);
    return (struct ray){.origin = lens_origin(&lens, across, up),
                        .direction = lens_direction(&lens, across, up),
                        .t_max = RAY_UNBOUNDED,
                        .from = PRIM_NONE,
                        .surface = SURFACE_NONE};
}

struct info_pixel info_pixel(const struct info *i)
{
    const struct scene *s = &i->lowered.scene;
    const struct geometry *g = &s->geometry;
    uint32_t x = i->options->pixel[0], y = i->options->pixel[1];
    struct ray ray = ray_of(&s->camera, i->options, x, y);
    struct ray_frame frame = ray_frame_of(&ray);
    struct hit hit = hit_none(ray.t_max);
    struct vec3 none = vec3_all(0); /* adding it takes the sign off zeros */
    struct info_pixel p = {.x = x,
                           .y = y,
                           .origin = vec3_add(ray.origin, none),
                           .direction = vec3_add(ray.direction, none),
                           .parallel = s->camera.modern && !(s->camera.yfov > 0)};
    for (uint32_t k = 0; k < g->prims.n; k++) /* one ray does not pay for a tree of boxes */
        geometry_intersect(g, k, &ray, &frame, &hit);
    if (hit.prim == PRIM_NONE)
        return p;
    p.hit = true;
    p.distance = hit.t;
    p.surface = &s->surfaces.at[g->prims.at[hit.prim].surface];
    p.object = i->frontend.desc.surfaces.at[p.surface->described];
    p.point = geometry_hit_point(g, &ray, &hit, &p.normal);
    if (p.surface->normals)
        geometry_weights(g, &ray, &hit);
    p.normal = surface_normal(s, p.surface, &hit, p.normal);
    return p;
}
