/* What a camera can see directly. */
#ifndef WRT_LINT_FRUSTUM_H
#define WRT_LINT_FRUSTUM_H

#include "math/box.h"
#include "scene/camera.h"

enum frustum_side {
    FRUSTUM_EYE, /* the plane through the eye, across its view */
    FRUSTUM_LEFT,
    FRUSTUM_RIGHT,
    FRUSTUM_BELOW,
    FRUSTUM_ABOVE,
    FRUSTUM_SIDES
};

/* Points on all inner sides can be seen: normal . p >= at. */
struct frustum {
    struct vec3 normal[FRUSTUM_SIDES];
    double at[FRUSTUM_SIDES];
    struct lens lens;
};

/* A pixel wider than the picture, for samples reach over its edges. */
struct frustum frustum_of(const struct camera *c);

/* Bit n: all of the box is clearly beyond side n. */
unsigned frustum_beyond(const struct frustum *f, struct box b);

/* Bit n: all of the box is on the inner side n.  That of a direction: what starts on the inner side
 * stays there. */
unsigned frustum_within(const struct frustum *f, struct box b);
unsigned frustum_keeps(const struct frustum *f, struct vec3 direction);

/* The part of the picture that the box can cover, at most 1. */
double frustum_share(const struct frustum *f, struct box b);

#endif
