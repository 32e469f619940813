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

/* accel_closest for n <= BUNDLE_LIMIT rays that can hit nothing but the list. */
void bundle_closest(const struct accel *a, const struct target_list *list, const struct ray *rays,
                    uint32_t n, struct hit *hits);

/* Likewise accel_any. */
void bundle_any(const struct accel *a, const struct target_list *list, const struct ray *rays,
                uint32_t n, bool *blocked);

#endif
