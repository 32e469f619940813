/* String slices: a pointer and a length, never NUL-terminated by promise, never owned. */
#ifndef WRT_BASE_STR_H
#define WRT_BASE_STR_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

struct str {
    const char *at;
    size_t n;
};

/* For printf's "%.*s". */
#define STR_ARG(s) (int)(s).n, (s).at

static inline struct str str_of(const char *z)
{
    return (struct str){z, strlen(z)};
}

static inline bool str_equal(struct str a, struct str b)
{
    return a.n == b.n && (a.n == 0 || memcmp(a.at, b.at, a.n) == 0);
}

static inline bool str_is(struct str a, const char *z)
{
    return str_equal(a, str_of(z));
}

static inline bool str_begins(struct str s, const char *z)
{
    size_t n = strlen(z);
    return s.n >= n && memcmp(s.at, z, n) == 0;
}

/* ASCII letters compared without case. */
bool str_equal_nocase(struct str a, struct str b);

/* Without leading and trailing space, tab, newline, carriage return. */
struct str str_trim(struct str s);

/* The n-th of the words in a list with a space between them; empty behind the last. */
struct str str_nth_word(const char *list, unsigned n);

/* Edits (insert, delete, replace, swap neighbours) that make a into b, ignoring ASCII case: the
 * optimal string alignment distance.  Names longer than 63 bytes count as far away. */
unsigned str_distance(struct str a, struct str b);

/* Keeps the nearest of many candidates to `wanted`, for "did you mean". */
struct str_nearest {
    struct str wanted, best;
    unsigned distance;
};
struct str_nearest str_nearest_to(struct str wanted);
void str_nearest_try(struct str_nearest *n, struct str candidate);
/* The nearest candidate when it is near enough to be meant (a third of the letters wrong at most,
 * or the same but for case); otherwise an empty slice. */
struct str str_nearest_found(const struct str_nearest *n);

/* The offset of the first byte that is not part of a UTF-8 sequence (RFC 3629: no overlong forms,
 * surrogates, or code points above U+10FFFF), or n. */
size_t str_utf8_valid(const char *p, size_t n);

/* Bytes of the control character at p, which a terminal might obey: 1, or 2 for U+0080 to U+009F;
 * 0 for any other character.  n > 0 bytes follow p. */
size_t str_control_length(const char *p, size_t n);

/* Bytes of the sequence that starts with this (valid) lead byte. */
static inline size_t str_utf8_length(unsigned char lead)
{
    return lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
}

/* Writes the code point (at most U+10FFFF) to out; returns its length of 1 to 4 bytes. */
size_t str_utf8_encode(unsigned long code_point, char out[4]);

#endif
