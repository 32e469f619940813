/* Arena: allocations that live and die together, one arena per stage result. */
#ifndef WRT_BASE_ARENA_H
#define WRT_BASE_ARENA_H

#include <stddef.h>

struct arena_block;

/* Zero-initialise; free with arena_free. */
struct arena {
    struct arena_block *blocks; /* newest first */
    struct arena_block *spare;  /* the last one released, or NULL */
    char *at, *end;             /* the free rest of the newest block */
    size_t bytes;               /* handed out and not released */
};

/* What arena_alloc does when the newest block is full. */
void *arena_alloc_block(struct arena *a, size_t n);

/* n bytes aligned for pointers and numbers up to 64 bits, not zeroed; never NULL (see mem.h). */
static inline void *arena_alloc(struct arena *a, size_t n)
{
    enum { ALIGNMENT = 8 };
    size_t rounded = (n + !n + ALIGNMENT - 1) & ~(size_t)(ALIGNMENT - 1);
    if (rounded < n || rounded > (size_t)(a->end - a->at))
        return arena_alloc_block(a, n);
    void *p = a->at;
    a->at += rounded;
    a->bytes += rounded;
    return p;
}

/* A zeroed array of n objects of `size` bytes; the product is checked. */
void *arena_zalloc(struct arena *a, size_t n, size_t size);

/* A NUL-terminated copy of the n bytes at p. */
char *arena_copy(struct arena *a, const char *p, size_t n);

/* printf into the arena. */
char *arena_printf(struct arena *a, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A place to go back to: arena_release frees what was handed out since. */
struct arena_mark {
    struct arena_block *block;
    char *at;
    size_t bytes;
};
struct arena_mark arena_mark(const struct arena *a);
void arena_release(struct arena *a, struct arena_mark m);

void arena_free(struct arena *a);

#endif
