/* Names to pointers: an open-addressing hash table. */
#ifndef WRT_BASE_MAP_H
#define WRT_BASE_MAP_H

#include "base/str.h"

/* Zero-initialise; free with map_free.  Keys and values are borrowed. */
struct map {
    struct map_slot {
        struct str key;
        void *value; /* NULL: empty */
    } *slots;
    size_t n, capacity; /* capacity is a power of two, or 0 */
};

/* The value of the key, or NULL. */
void *map_get(const struct map *m, struct str key);

/* Sets the value (not NULL) of a key. */
void map_set(struct map *m, struct str key, void *value);

void map_free(struct map *m);

#endif
