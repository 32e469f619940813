/* Many rays against a short list of primitives, list by list instead of ray by ray. */
#ifndef WRT_ACCEL_BUNDLE_H
#define WRT_ACCEL_BUNDLE_H

#include "accel/bvh.h"
#include "base/isa.h"
#include "math/batch.h"

enum { TARGET_LIST_LIMIT = 32 };

/* All that some rays can hit. */
struct target_list {
    bool usable; /* false: too many targets, or an instance; the list says nothing */
    uint32_t n;
    struct target at[TARGET_LIST_LIMIT];
    double nearest[TARGET_LIST_LIMIT]; /* no ray of unit length is shorter to the target */
};

/* What an instruction set has its own code for.  The rays of a batch against a usable list. */
struct bundle_kernels {
    /* Nearest hits; a hit's prim is PRIM_NONE where there is none. */
    void (*closest)(const struct geometry *g, const struct ray_batch *rays,
                    const struct target_list *list, struct hit_batch *hits);
    /* Bit i: ray i hits something. */
    uint64_t (*any)(const struct geometry *g, const struct ray_batch *rays,
                    const struct target_list *list);
    /* Bit i: hit i is one, of the first n > 0. */
    uint64_t (*found)(const struct hit_batch *hits, uint32_t n);
};

extern const struct bundle_kernels bundle_plain, bundle_generic, bundle_avx2, bundle_avx512;

/* Those of an available instruction set. */
const struct bundle_kernels *bundle_kernels_of(enum isa isa);

/* Whether lists are hardly ever short, so that batches had better be traced without. */
bool bundle_needs_no_lists(const struct accel *a);

/* accel_closest for all rays, which can hit nothing but the list's targets. */
void bundle_closest(const struct accel *a, const struct bundle_kernels *kernels,
                    const struct ray_batch *rays, const struct target_list *list,
                    struct hit_batch *hits);

/* accel_any for all of them; bit i: ray i hits something. */
uint64_t bundle_any(const struct accel *a, const struct bundle_kernels *kernels,
                    const struct ray_batch *rays, const struct target_list *list);

#endif
