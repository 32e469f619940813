/* Many rays against a short list of primitives, list by list instead of ray by ray. */
#ifndef WRT_ACCEL_BUNDLE_H
#define WRT_ACCEL_BUNDLE_H

#include "accel/bvh.h"

enum { TARGET_LIST_LIMIT = 32, BUNDLE_LIMIT = 64 };

/* All that some rays can hit. */
struct target_list {
    bool usable; /* false: too many targets; the list says nothing */
    uint32_t n;
    struct target at[TARGET_LIST_LIMIT];
    double nearest[TARGET_LIST_LIMIT]; /* no ray of unit length is shorter to the target */
};

/* Rays to trace together. */
struct bundle {
    const struct ray *rays;
    uint32_t n;                     /* at most BUNDLE_LIMIT */
    bool common_origin;             /* all have the same */
    const struct target_list *list; /* they can hit nothing else */
};

/* accel_closest for all of them. */
void bundle_closest(const struct accel *a, const struct bundle *b, struct hit *hits);

/* accel_any for all of them. */
void bundle_any(const struct accel *a, const struct bundle *b, bool *blocked);

#endif
