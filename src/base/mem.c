#include "config.h"

#include "base/mem.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>

#ifdef __linux__
static const int LIMITED = RLIMIT_DATA; /* since 4.7 of all private memory */
#else
static const int LIMITED = RLIMIT_AS;
#endif

/* A limit of this process alone is that of mem_limit: those of shells hold for good. */
void mem_exhausted(size_t wanted)
{
    struct rlimit limit;
    bool own = getrlimit(LIMITED, &limit) == 0 && limit.rlim_cur < limit.rlim_max;
    fprintf(stderr, "wrt: error: out of memory (%zu bytes wanted", wanted);
    if (own)
        fprintf(stderr, " beyond the %llu that --max-memory allows",
                (unsigned long long)limit.rlim_cur);
    fputs(")\n", stderr);
    exit(3);
}

static size_t checked_size(size_t n, size_t size)
{
    size_t bytes;
    if (!mem_mul(n, size, &bytes) || bytes > PTRDIFF_MAX)
        mem_exhausted(SIZE_MAX);
    return bytes ? bytes : 1;
}

void *mem_alloc(size_t n, size_t size)
{
    size_t bytes = checked_size(n, size);
    void *p = malloc(bytes);
    if (!p)
        mem_exhausted(bytes);
    return p;
}

void *mem_zalloc(size_t n, size_t size)
{
    void *p = calloc(1, checked_size(n, size));
    if (!p)
        mem_exhausted(n * size);
    return p;
}

void *mem_realloc(void *old, size_t n, size_t size)
{
    size_t bytes = checked_size(n, size);
    void *p = realloc(old, bytes);
    if (!p)
        mem_exhausted(bytes);
    return p;
}

char *mem_string(const char *string)
{
    size_t n = strlen(string) + 1;
    return memcpy(mem_alloc(n, 1), string, n);
}

void *mem_alloc_large(size_t n)
{
    enum { PAGE = 2 << 20 };
    void *p = NULL;
    if (n < PAGE)
        return mem_alloc(n, 1);
    if (n > PTRDIFF_MAX || posix_memalign(&p, PAGE, n) != 0)
        mem_exhausted(n);
#ifdef MADV_HUGEPAGE
    madvise(p, n, MADV_HUGEPAGE); /* no is an answer, too */
#endif
    return p;
}

void *mem_alloc_aligned(size_t n, size_t size)
{
    enum { LINE = 64 };
    size_t bytes = checked_size(n, size);
    bytes = (bytes + LINE - 1) / LINE * LINE;
    void *p = aligned_alloc(LINE, bytes);
    if (!p)
        mem_exhausted(bytes);
    return p;
}

bool mem_limit(uint64_t bytes)
{
    struct rlimit limit;
    if (getrlimit(LIMITED, &limit) != 0)
        return false;
    if (bytes < limit.rlim_cur) /* RLIM_INFINITY is the greatest */
        limit.rlim_cur = (rlim_t)bytes;
    return setrlimit(LIMITED, &limit) == 0;
}
