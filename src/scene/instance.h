/* Instances: rays taken into the space of their shapes. */
#ifndef WRT_SCENE_INSTANCE_H
#define WRT_SCENE_INSTANCE_H

#include "scene/geometry.h"

/* A ray as the shape sees it. */
struct inner_ray {
    struct ray ray;
    struct ray_frame frame;
};

/* Hits beyond t_max do not count. */
struct inner_ray instance_ray(const struct instance *i, const struct ray *ray, double t_max);

/* The inner hit, if there is one, as a hit of the instance, which is primitive `prim`. */
bool instance_offer(const struct instance *i, uint32_t prim, const struct hit *inner,
                    struct hit *best);

#endif
