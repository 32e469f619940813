#include "config.h"

#include "base/buffer.h"

#include "base/num.h"
#include "base/vec.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>

void buffer_free(struct buffer *b)
{
    vec_free(b);
}

void buffer_add(struct buffer *b, const char *p, size_t n)
{
    size_t inside = (uintptr_t)p - (uintptr_t)b->at; /* beyond b->n: the bytes are another's */
    vec_reserve(b, n);
    if (n)
        memcpy(b->at + b->n, inside < b->n ? b->at + inside : p, n);
    b->n += n;
}

void buffer_str(struct buffer *b, struct str s)
{
    buffer_add(b, s.at, s.n);
}

void buffer_puts(struct buffer *b, const char *z)
{
    buffer_add(b, z, strlen(z));
}

void buffer_fill(struct buffer *b, char c, size_t n)
{
    vec_reserve(b, n);
    if (n)
        memset(b->at + b->n, c, n);
    b->n += n;
}

void buffer_printf(struct buffer *b, const char *format, ...)
{
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int n = vsnprintf(NULL, 0, format, args);
    va_end(args);
    if (n > 0) {
        vec_reserve(b, (size_t)n + 1); /* vsnprintf ends with a NUL */
        vsnprintf(b->at + b->n, (size_t)n + 1, format, again);
        b->n += (size_t)n;
    }
    va_end(again);
}

void buffer_number(struct buffer *b, double x)
{
    char text[NUM_PRINT_BYTES];
    buffer_add(b, text, num_print(x, text));
}
