/* Random texts for the property tests: the same seed makes the same text on every machine. */
#ifndef WRT_TESTS_RANDOM_H
#define WRT_TESTS_RANDOM_H

#include "base/buffer.h"

#include <stdbool.h>
#include <stdint.h>

struct random {
    uint64_t state;
};

/* A number in [0, n). */
unsigned random_below(struct random *r, unsigned n);
/* True once in n times. */
bool random_once_in(struct random *r, unsigned n);
/* One of the words, separated by spaces. */
struct str random_word(struct random *r, const char *words);

/* A native text over the whole grammar: it parses, but means nothing. */
void random_native(uint64_t seed, struct buffer *out);

#endif
