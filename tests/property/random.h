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

/* A text made token by token, with random gaps between them. */
struct writer {
    struct random random;
    struct buffer *out;
    bool xml;
    unsigned comments;     /* so far; each has its number in it */
    unsigned comment_rate; /* a comment once in so many gaps */
};

struct writer writer_begin(uint64_t seed, bool xml, struct buffer *out);

unsigned below(struct writer *w, unsigned n);
bool once_in(struct writer *w, unsigned n);

/* White space and comments; `needed`: some of them at least. */
void put_gap(struct writer *w, bool needed);

/* A native token, after a gap that keeps it from the one before. */
void put(struct writer *w, const char *token);
void put_str(struct writer *w, struct str token);
void put_one_of(struct writer *w, const char *words);

/* A native text over the whole grammar: it parses, but means nothing. */
void random_native(uint64_t seed, struct buffer *out);

/* A native scene that is right, with loops, functions, templates, groups. */
void random_scene(uint64_t seed, struct buffer *out);

/* An XML scene that is right.  Both name the files t.png, m.off and m.txt. */
void random_xml(uint64_t seed, struct buffer *out);

#endif
