/* Where text came from.
 *
 * All texts of a run share one space of 32-bit offsets, so a span is eight bytes and needs no file
 * number.  Lines and columns are worked out only when something is printed. */
#ifndef WRT_BASE_SRCMAP_H
#define WRT_BASE_SRCMAP_H

#include "base/str.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

/* Bytes [begin, end).  {0, 0} is "no place": offset 0 belongs to no text. */
struct span {
    uint32_t begin, end;
};

static inline struct span span_join(struct span a, struct span b)
{
    return (struct span){a.begin, b.end};
}

static inline bool span_known(struct span s)
{
    return s.begin != 0;
}

struct source {
    char *name;    /* as messages show it; owned */
    char *text;    /* UTF-8 with two NULs behind it (flex scans it in place); owned */
    uint32_t base; /* offset of text[0] */
    uint32_t n;    /* bytes, without the NULs */
    bool marked;   /* the file has a byte order mark before the text */
    VEC(uint32_t) lines; /* start of each line within text; made when first asked for */
    struct {
        uint32_t line, at, column; /* the last column told, from 0; places mostly come in order */
    } last;
};

struct srcmap {
    VEC(struct source *) sources; /* by rising base */
    /* Around the files of the run; borrowed.  NULL: they may lie anywhere. */
    const struct file_fence *fence;
};

struct location {
    const struct source *source; /* NULL: no place */
    uint32_t line, column;       /* from 1; columns count code points */
    struct str line_text;        /* without its newline */
    uint32_t line_base;          /* offset of line_text[0] */
};

/* Takes text (from malloc, with room for two more bytes behind its n).  NULL when the shared
 * offset space is full (4 GiB in all); text is freed then. */
struct source *srcmap_add(struct srcmap *m, const char *name, char *text, size_t n);

struct location srcmap_locate(const struct srcmap *m, uint32_t offset);
const struct source *srcmap_source(const struct srcmap *m, uint32_t offset);

/* The text of a span that lies within one source. */
struct str srcmap_text(const struct srcmap *m, struct span s);

void srcmap_free(struct srcmap *m);

#endif
