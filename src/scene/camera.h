/* From a place in the picture to a ray. */
#ifndef WRT_SCENE_CAMERA_H
#define WRT_SCENE_CAMERA_H

#include "scene/scene.h"

/* Classic: direction(u, v) = across (2u - 1) + upwards (2v - 1) + ahead. */
struct lens {
    struct vec3 origin, across, upwards, ahead;
    bool mirrored; /* compatMode 0 */
};

/* For a picture of this size; the scene's own aspect arithmetic holds when it has the scene's
 * proportions. */
struct lens lens_of(const struct camera *c, uint32_t width, uint32_t height);

/* The unit direction to (u, v), which run from 0 to 1, v upwards. */
struct vec3 lens_direction(const struct lens *l, double u, double v);

#endif
