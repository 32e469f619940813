#include "config.h"

#include "base/arena.h"

#include "base/mem.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK_BYTES = 64 * 1024, ALIGNMENT = _Alignof(max_align_t) };

struct arena_block {
    struct arena_block *next;
    char *end;
    max_align_t data[];
};

static void add_block(struct arena *a, size_t n)
{
    size_t room = n > BLOCK_BYTES ? n : BLOCK_BYTES;
    if (room > SIZE_MAX - sizeof(struct arena_block))
        mem_exhausted(SIZE_MAX);
    struct arena_block *b = mem_alloc(1, sizeof *b + room);
    b->next = a->blocks;
    a->blocks = b;
    a->at = (char *)b->data;
    a->end = b->end = a->at + room;
}

void *arena_alloc(struct arena *a, size_t n)
{
    if (n > PTRDIFF_MAX)
        mem_exhausted(n);
    n = (n + !n + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    if (n > (size_t)(a->end - a->at))
        add_block(a, n);
    void *p = a->at;
    a->at += n;
    a->bytes += n;
    return p;
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
        free(a->blocks);
        a->blocks = next;
    }
    a->at = m.at;
    a->end = m.block ? m.block->end : NULL;
    a->bytes = m.bytes;
}

void arena_free(struct arena *a)
{
    while (a->blocks) {
        struct arena_block *next = a->blocks->next;
        free(a->blocks);
        a->blocks = next;
    }
    *a = (struct arena){0};
}
