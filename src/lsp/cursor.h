/* What may stand at a place of a native text that is being written: told by its tokens alone, since
 * it seldom parses at that moment. */
#ifndef WRT_LSP_CURSOR_H
#define WRT_LSP_CURSOR_H

#include "base/str.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

enum cursor_place {
    CURSOR_NOWHERE,   /* in a comment or string */
    CURSOR_STATEMENT, /* a statement, or in a block a property */
    CURSOR_VALUE,     /* a value, or part of one */
    CURSOR_LIGHT,     /* behind `light` */
    CURSOR_MODEL,     /* behind `model` */
    CURSOR_DEFAULT,   /* behind `default` */
};

/* What opened a block: the words before its brace. */
struct cursor_block {
    struct str first, second; /* `light`, `point`; empty: statements of a file, loop or template */
    bool is_use;              /* behind arguments */
    struct str property;      /* the last one begun in it */
    size_t given;             /* the first of its properties among those given */
    unsigned brackets;        /* open within it */
};

struct cursor {
    enum cursor_place place;
    VEC(struct cursor_block) blocks; /* the open ones, outermost first; the first is the file */
    VEC(struct str) given;           /* properties of the open blocks before the place */
};

/* Free with cursor_free. */
void cursor_find(struct cursor *c, struct str text, uint32_t at);
void cursor_free(struct cursor *c);

#endif
