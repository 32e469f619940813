/* From a place in the picture to a ray. */
#ifndef WRT_SCENE_CAMERA_H
#define WRT_SCENE_CAMERA_H

#include "scene/scene.h"

/* direction(x, y) = across x + upwards y + ahead from the origin; for parallel rays it is `ahead`,
 * from origin + across x + upwards y.
 *
 * x is to the right of somebody who looks along z with y up, in both models. */
struct lens {
    struct vec3 origin, across, upwards, ahead;
    bool mirrored; /* compatMode 0 */
    bool parallel;
};

/* For a picture of this size; in classic the scene's own aspect arithmetic holds when it has the
 * scene's proportions. */
struct lens lens_of(const struct camera *c, uint32_t width, uint32_t height);

/* Where in the picture, from -1 to 1, a place along a row or column of so many pixels is. */
double camera_place(const struct camera *c, double place, uint32_t pixels);
/* The same of `more` in n pixels from `first` on. */
void camera_places(const struct camera *c, uint32_t first, uint32_t n, double more, uint32_t pixels,
                   double *places);

/* Where in a pixel its only sample is, from 0 to 1: in classic at the lower left, in modern in the
 * middle. */
double camera_sample(const struct camera *c);

/* Where the ray through (x, y) starts, and its unit direction; x and y run from -1 to 1, y upwards.
 */
struct vec3 lens_origin(const struct lens *l, double x, double y);
struct vec3 lens_direction(const struct lens *l, double x, double y);

#endif
