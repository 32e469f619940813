#include "config.h"

#include "base/arena.h"

#include "base/mem.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Blocks grow with the arena, from BLOCK_LEAST to BLOCK_MOST with their heads. */
enum { BLOCK_LEAST = 64 << 10, BLOCK_MOST = 16 << 20, ALIGNMENT = 8 };

struct arena_block {
    struct arena_block *next;
    char *end;
    uint64_t data[];
};

static size_t clamp(size_t n, size_t least, size_t most)
{
    return n < least ? least : n > most ? most : n;
}

static struct arena_block *new_block(const struct arena *a, size_t n)
{
    size_t head = sizeof(struct arena_block), size = clamp(a->bytes, BLOCK_LEAST, BLOCK_MOST);
    if (n > SIZE_MAX - head)
        mem_exhausted(SIZE_MAX);
    size = n + head > size ? n + head : size;
    struct arena_block *b = mem_alloc_large(size);
    b->end = (char *)b + size;
    return b;
}

static void add_block(struct arena *a, size_t n)
{
    struct arena_block *b = a->spare;
    if (b && (size_t)(b->end - (char *)b->data) >= n)
        a->spare = NULL;
    else
        b = new_block(a, n);
    b->next = a->blocks;
    a->blocks = b;
    a->at = (char *)b->data;
    a->end = b->end;
}

void *arena_alloc_block(struct arena *a, size_t n)
{
    if (n > PTRDIFF_MAX)
        mem_exhausted(n);
    add_block(a, n + ALIGNMENT);
    return arena_alloc(a, n);
}

void *arena_zalloc(struct arena *a, size_t n, size_t size)
{
    size_t bytes;
    if (!mem_mul(n, size, &bytes))
        mem_exhausted(SIZE_MAX);
    void *p = arena_alloc(a, bytes);
    memset(p, 0, bytes);
    return p;
}

char *arena_copy(struct arena *a, const char *p, size_t n)
{
    char *copy = arena_alloc(a, n + 1);
    memcpy(copy, p, n);
    copy[n] = 0;
    return copy;
}

char *arena_printf(struct arena *a, const char *format, ...)
{
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int n = vsnprintf(NULL, 0, format, args);
    va_end(args);
    char *p = arena_alloc(a, (size_t)(n < 0 ? 0 : n) + 1);
    p[0] = 0;
    vsnprintf(p, (size_t)(n < 0 ? 0 : n) + 1, format, again);
    va_end(again);
    return p;
}

struct arena_mark arena_mark(const struct arena *a)
{
    return (struct arena_mark){a->blocks, a->at, a->bytes};
}

void arena_release(struct arena *a, struct arena_mark m)
{
    while (a->blocks != m.block) {
        struct arena_block *next = a->blocks->next;
        free(a->spare);
        a->spare = a->blocks;
        a->blocks = next;
    }
    a->at = m.at;
    a->end = m.block ? m.block->end : NULL;
    a->bytes = m.bytes;
}

void arena_free(struct arena *a)
{
    arena_release(a, (struct arena_mark){0});
    free(a->spare);
    *a = (struct arena){0};
}
