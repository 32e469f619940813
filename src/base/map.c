#include "config.h"

#include "base/map.h"

#include "base/mem.h"

#include <stdint.h>
#include <stdlib.h>

/* FNV-1a, 64 bits (Fowler, Noll, Vo). */
static uint64_t hash(struct str s)
{
    uint64_t h = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < s.n; i++)
        h = (h ^ (unsigned char)s.at[i]) * UINT64_C(0x100000001b3);
    return h ^ h >> 29;
}

/* The key's slot, or the empty one where it would go. */
static struct map_slot *find(const struct map *m, struct str key)
{
    size_t mask = m->capacity - 1;
    for (size_t i = (size_t)hash(key) & mask;; i = (i + 1) & mask)
        if (!m->slots[i].value || str_equal(m->slots[i].key, key))
            return &m->slots[i];
}

void *map_get(const struct map *m, struct str key)
{
    return m->capacity ? find(m, key)->value : NULL;
}

static void grow(struct map *m)
{
    struct map bigger = {.capacity = m->capacity ? m->capacity * 2 : 16, .n = m->n};
    bigger.slots = mem_zalloc(bigger.capacity, sizeof *bigger.slots);
    for (size_t i = 0; i < m->capacity; i++)
        if (m->slots[i].value)
            *find(&bigger, m->slots[i].key) = m->slots[i];
    free(m->slots);
    *m = bigger;
}

void map_set(struct map *m, struct str key, void *value)
{
    if (m->n >= m->capacity / 2)
        grow(m);
    struct map_slot *slot = find(m, key);
    m->n += slot->value == NULL;
    *slot = (struct map_slot){key, value};
}

void map_free(struct map *m)
{
    free(m->slots);
    *m = (struct map){0};
}
