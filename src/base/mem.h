/* Checked allocation.
 *
 * Running out of memory ends the process: no caller could do better, and no output file is open
 * then (pictures are encoded in memory before their file is created).  This is the one place
 * outside src/cmd that prints and exits; exit status 3. */
#ifndef WRT_BASE_MEM_H
#define WRT_BASE_MEM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* n * size bytes, overflow checked; zeroed by mem_zalloc.  Never NULL.  Free with free(). */
void *mem_alloc(size_t n, size_t size);
void *mem_zalloc(size_t n, size_t size);
void *mem_realloc(void *p, size_t n, size_t size);

/* A copy of a string. */
char *mem_string(const char *string);

/* n bytes that will be filled from their start on: many of them lie on large pages, where the
 * system has some, which come sooner than as many small ones. */
void *mem_alloc_large(size_t n);

/* As mem_alloc for a multiple of 64 bytes, aligned to a cache line. */
void *mem_alloc_aligned(size_t n, size_t size);

/* Says on stderr that `wanted` bytes could not be had, and exits with status 3. */
void mem_exhausted(size_t wanted) __attribute__((noreturn));

/* From now on more than this cannot be had.  Where the system counts what is really there, that is
 * meant, and else all that is mapped.  False when the system refuses. */
bool mem_limit(uint64_t bytes);

/* *out = a * b; false when that overflows. */
static inline int mem_mul(size_t a, size_t b, size_t *out)
{
    return !__builtin_mul_overflow(a, b, out);
}

#endif
