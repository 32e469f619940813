/* Where the comments of a native scene go in XML, which has sections instead of a sequence of
 * statements (internal to src/convert).
 *
 * Between two statements comments form groups, parted by blank lines.  A group that touches the
 * statement behind it belongs to that one; a group that touches only the one before stays behind
 * it; what is set apart stands before the section that begins next.  Statements that XML does not
 * have hand theirs on. */
#ifndef WRT_CONVERT_PLACES_H
#define WRT_CONVERT_PLACES_H

#include "convert/comments.h"
#include "print/gap.h"

#include <stdbool.h>

enum place_kind {
    PLACE_INSIDE,  /* within a statement */
    PLACE_HEAD,    /* before the root */
    PLACE_SECTION, /* before the section that the owner begins, or before the owner */
    PLACE_BEFORE,  /* before the owner */
    PLACE_BEHIND,  /* behind the owner, on its last line */
    PLACE_AFTER,   /* on lines after the owner, in its section */
    PLACE_TAIL,    /* at the end of the root */
    PLACE_FOOT,    /* behind the root */
};

/* A statement, or a note that holds the place of a section or of the root's end. */
struct stop {
    uint32_t begin, end;
    bool produces;      /* objects, or a section */
    struct str section; /* the section that a note names; empty: a statement */
    size_t next;        /* the first stop that produces, from this one on; SIZE_MAX: none */
    size_t first, last; /* the run of ast->trivia with the comments it owns */
};

struct place {
    enum place_kind kind;
    bool done;    /* written, or a note that was used */
    size_t owner; /* the stop; no meaning inside, and outside of the root */
};

struct places {
    const struct ast *ast;
    VEC(struct stop) stops; /* in the order of the file */
    size_t foot;            /* the stop that ends the root, or SIZE_MAX */
    struct place *comments; /* one for each of ast->trivia */
};

/* The offsets at which the statements begin that produce objects, rising. */
void places_find(struct places *p, const struct ast *ast, const uint32_t *producing, size_t n);
void places_free(struct places *p);

/* The stop that holds the offset, or the last one before it. */
size_t places_stop(const struct places *p, uint32_t offset);

#endif
