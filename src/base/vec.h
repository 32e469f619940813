/* The one growable array.
 *
 *     VEC(struct light) lights = {0};
 *     vec_push(&lights, light);
 *     for (size_t i = 0; i < lights.n; i++) use(&lights.at[i]);
 *     vec_free(&lights);
 */
#ifndef WRT_BASE_VEC_H
#define WRT_BASE_VEC_H

#include "base/mem.h"

#include <stdint.h>
#include <stdlib.h>

#define VEC(type)                                                                                  \
    struct {                                                                                       \
        type *at;                                                                                  \
        size_t n, capacity;                                                                        \
    }

static inline size_t vec_grown(size_t capacity, size_t wanted)
{
    if (wanted > SIZE_MAX / 2)
        mem_exhausted(SIZE_MAX);
    capacity += capacity / 2 + 8;
    return capacity < wanted ? wanted : capacity;
}

/* Makes room for `more` elements beyond v->n. */
#define vec_reserve(v, more)                                                                       \
    do {                                                                                           \
        size_t vec_wanted_ = (v)->n + (more);                                                      \
        if (vec_wanted_ > (v)->capacity) {                                                         \
            (v)->capacity = vec_grown((v)->capacity, vec_wanted_);                                 \
            (v)->at = mem_realloc((v)->at, (v)->capacity, sizeof *(v)->at);                        \
        }                                                                                          \
    } while (0)

#define vec_push(v, ...)                                                                           \
    do {                                                                                           \
        vec_reserve((v), 1);                                                                       \
        (v)->at[(v)->n++] = (__VA_ARGS__);                                                         \
    } while (0)

#define vec_free(v)                                                                                \
    do {                                                                                           \
        free((v)->at);                                                                             \
        (v)->at = NULL;                                                                            \
        (v)->n = (v)->capacity = 0;                                                                \
    } while (0)

#endif
