/* A text in a source map of its own, and what was said about it. */
#ifndef WRT_TESTS_READING_H
#define WRT_TESTS_READING_H

#include "base/srcmap.h"
#include "base/vec.h"
#include "diag/diag.h"

#define COUNT(a) (int)(sizeof(a) / sizeof *(a))

struct reading {
    struct srcmap map;
    struct source *source;
    struct diag diag;
};

/* `name` tells the format of a mesh where its content does not. */
void reading_init(struct reading *r, const char *name, const void *text, size_t n);
void reading_free(struct reading *r);

/* The one error must have this code and stand at `place`, a part of the text. */
void check_error(const struct reading *r, enum diag_code code, const char *place,
                 const char *message);

/* Binary text under construction; the bytes belong to it. */
struct blob {
    VEC(char) bytes;
    bool big_endian;
};
void blob_put(struct blob *b, uint64_t bits, int size);
void blob_float(struct blob *b, float x);
void blob_double(struct blob *b, double x);
void blob_text(struct blob *b, const char *text);

#endif
