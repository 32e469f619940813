/* Which primitives are near a point. */
#ifndef WRT_LINT_NEARBY_H
#define WRT_LINT_NEARBY_H

#include "accel/bvh.h"
#include "math/box.h"

/* How far the point is from the box. */
double nearby_gap(struct box b, struct vec3 p);

/* The lowest primitive at most so far from the point, or PRIM_NONE; of this surface, or of any for
 * SURFACE_NONE.  Within an instance distances are as its largest stretch makes them. */
uint32_t nearby_prim(const struct accel *a, struct vec3 p, double distance, uint32_t surface);

/* Whether the box of any primitive is that near. */
bool nearby_box(const struct accel *a, struct vec3 p, double distance);

#endif
