#include "config.h"

#include "accel/bundle.h"
#include "accel/wide.h"

const struct bundle_kernels *bundle_kernels_of(enum isa isa)
{
    static const struct bundle_kernels *const kernels[ISA_COUNT] = {
        [ISA_PLAIN] = &bundle_plain,
        [ISA_GENERIC] = &bundle_generic,
#ifdef HAVE_X86_KERNELS
        [ISA_AVX2] = &bundle_avx2,
        [ISA_AVX512] = &bundle_avx512,
#endif
    };
    return kernels[isa];
}

/* Of triangles, where a tile of the picture is expected to hold more than a list does. */
enum { MANY_BLOCKS = 32 };

bool bundle_needs_no_lists(const struct accel *a)
{
    return a->wide && a->wide->block_count >= MANY_BLOCKS;
}

static bool as_packet(const struct accel *a, const struct ray_batch *rays, bool any,
                      struct hit_batch *hits)
{
    return wide_takes_packets(a, rays->n) && a->wide->kernels->packet(a, rays, any, hits);
}

void bundle_closest(const struct accel *a, const struct bundle_kernels *kernels,
                    const struct ray_batch *rays, const struct target_list *list,
                    struct hit_batch *hits)
{
    if (list->usable) {
        kernels->closest(a->geometry, rays, list, hits);
        return;
    }
    if (as_packet(a, rays, false, hits))
        return;
    for (uint32_t i = 0; i < rays->n; i++) {
        struct ray ray = ray_get(rays, i);
        struct hit hit;
        accel_closest(a, &ray, &hit);
        hit_put(hits, i, &hit);
    }
}

uint64_t bundle_any(const struct accel *a, const struct bundle_kernels *kernels,
                    const struct ray_batch *rays, const struct target_list *list)
{
    struct hit_batch hits;
    uint64_t found = 0;
    if (list->usable)
        return list->n > 0 ? kernels->any(a->geometry, rays, list) : 0;
    if (as_packet(a, rays, true, &hits))
        return kernels->found(&hits, rays->n);
    for (uint32_t i = 0; i < rays->n; i++) {
        struct ray ray = ray_get(rays, i);
        found |= (uint64_t)accel_any(a, &ray) << i;
    }
    return found;
}

/* ---- the reference: one ray after another ---------------------------------------------------- */

static void closest_one_by_one(const struct geometry *g, const struct ray_batch *rays,
                               const struct target_list *list, struct hit_batch *hits)
{
    for (uint32_t i = 0; i < rays->n; i++) {
        struct ray ray = ray_get(rays, i);
        struct ray_frame frame = ray_frame_of(&ray);
        struct hit hit = hit_none(ray.t_max);
        for (uint32_t k = 0; k < list->n && ray_has_direction(&ray); k++)
            target_intersect(g, list->at[k], &ray, &frame, &hit);
        hit_put(hits, i, &hit);
    }
}

static uint64_t found_one_by_one(const struct hit_batch *hits, uint32_t n)
{
    uint64_t found = 0;
    for (uint32_t i = 0; i < n; i++)
        found |= (uint64_t)(hits->prim[i] != PRIM_NONE) << i;
    return found;
}

static uint64_t any_one_by_one(const struct geometry *g, const struct ray_batch *rays,
                               const struct target_list *list)
{
    struct hit_batch hits;
    closest_one_by_one(g, rays, list, &hits);
    return found_one_by_one(&hits, rays->n);
}

const struct bundle_kernels bundle_plain = {closest_one_by_one, any_one_by_one, found_one_by_one};
