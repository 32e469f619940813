#include "config.h"

#include "scene/camera.h"

struct lens lens_of(const struct camera *c, uint32_t width, uint32_t height)
{
    double w = c->width, h = c->height;
    if ((uint64_t)width * c->height != (uint64_t)height * c->width) {
        w = width;
        h = height;
    }
    struct vec3 z = vec3_normalize(c->back);
    struct vec3 y = vec3_normalize(vec3_mad(c->up, -vec3_dot(c->up, z), z));
    struct vec3 x = vec3_cross(z, y);
    double tx = tan(c->yfov * (PI / 180) * w / h), ty = tx * h / w;
    return (struct lens){.origin = c->origin,
                         .across = vec3_scale(x, tx),
                         .upwards = vec3_scale(y, ty),
                         .ahead = c->compatible ? vec3_neg(z) : z,
                         .mirrored = !c->compatible};
}

struct vec3 lens_direction(const struct lens *l, double u, double v)
{
    struct vec3 d = vec3_mad(vec3_scale(l->across, 2 * u - 1), 2 * v - 1, l->upwards);
    d = vec3_add(d, l->ahead);
    if (l->mirrored)
        d.z = -d.z;
    return vec3_normalize(d);
}
