/* Text under construction. */
#ifndef WRT_BASE_BUFFER_H
#define WRT_BASE_BUFFER_H

#include "base/str.h"

/* Zero-initialise; free with buffer_free.  The text is not NUL-terminated. */
struct buffer {
    char *at;
    size_t n, capacity;
};

void buffer_free(struct buffer *b);

/* The bytes may be the buffer's own. */
void buffer_add(struct buffer *b, const char *p, size_t n);
void buffer_str(struct buffer *b, struct str s);
void buffer_puts(struct buffer *b, const char *z);
/* The same byte n times. */
void buffer_fill(struct buffer *b, char c, size_t n);
void buffer_printf(struct buffer *b, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The shortest decimal spelling that reads back as x. */
void buffer_number(struct buffer *b, double x);

#endif
