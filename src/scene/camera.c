#include "config.h"

#include "scene/camera.h"

/* Half the picture's extent at distance 1, or of parallel rays at all. */
static struct vec2 half_extent(const struct camera *c, double w, double h)
{
    struct vec2 half;
    if (!c->modern) {
        half.x = tan(c->yfov * (PI / 180) * w / h);
        half.y = half.x * h / w;
        return half;
    }
    half.y = c->yfov > 0 ? tan(c->yfov * (PI / 360)) : c->view_height / 2;
    half.x = half.y * w / h;
    return half;
}

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
    struct vec2 half = half_extent(c, w, h);
    return (struct lens){.origin = c->origin,
                         .across = vec3_scale(x, half.x),
                         .upwards = vec3_scale(y, half.y),
                         .ahead = c->modern || c->compatible ? vec3_neg(z) : z,
                         .mirrored = !c->modern && !c->compatible,
                         .parallel = c->modern && !(c->yfov > 0)};
}

/* Modern's form gives opposite places opposite numbers. */
double camera_place(const struct camera *c, double place, uint32_t pixels)
{
    return c->modern ? (2 * place - pixels) / pixels : 2 * (place / pixels) - 1;
}

void camera_places(const struct camera *c, uint32_t first, uint32_t n, double more, uint32_t pixels,
                   double *places)
{
    double all = pixels;
    for (uint32_t i = 0; i < n && c->modern; i++)
        places[i] = (2 * ((int)(first + i) + more) - all) / all;
    for (uint32_t i = 0; i < n && !c->modern; i++)
        places[i] = 2 * (((int)(first + i) + more) / all) - 1;
}

double camera_sample(const struct camera *c)
{
    return c->modern ? 0.5 : 0;
}

struct vec3 lens_origin(const struct lens *l, double x, double y)
{
    if (!l->parallel)
        return l->origin;
    return vec3_mad(vec3_mad(l->origin, x, l->across), y, l->upwards);
}

struct vec3 lens_direction(const struct lens *l, double x, double y)
{
    if (l->parallel)
        return l->ahead;
    struct vec3 d = vec3_mad(vec3_scale(l->across, x), y, l->upwards);
    d = vec3_add(d, l->ahead);
    if (l->mirrored)
        d.z = -d.z;
    return vec3_normalize(d);
}
