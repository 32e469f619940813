/* Breaking text into lines.
 *
 * A printer hands over texts, places where a line may end, and groups of them.  A group that fits
 * into the rest of the line is kept on it; in one that does not, every break ends a line (or, in a
 * filled group, only those that must).  After Oppen, Prettyprinting, TOPLAS 2(4), 1980. */
#ifndef WRT_PRINT_LAYOUT_H
#define WRT_PRINT_LAYOUT_H

#include "base/buffer.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

enum { LAYOUT_COLUMNS = 100, LAYOUT_INDENT = 2 };

struct layout_item;

/* Initialise with out; free with layout_free. */
struct layout {
    struct buffer *out;            /* borrowed */
    VEC(struct layout_item) items; /* not yet written */
    VEC(size_t) groups;            /* the open ones */
    unsigned nest, column;
    bool begun; /* the current line has text on it */
};

/* Text, of one line where it stands in a group; it must live until layout_flush. */
void layout_text(struct layout *l, struct str text);
/* Text that may have several lines and stood at `column` before: its further lines are moved as far
 * as its first.  Blanks at the ends of lines are left out. */
void layout_comment(struct layout *l, struct str text, unsigned column);

/* A break: `width` spaces, or the end of the line and perhaps a blank one. */
struct layout_break {
    unsigned width;
    bool fill;  /* ends the line only when what follows does not fit */
    bool blank; /* with a blank line, when it ends the line */
};
void layout_break(struct layout *l, struct layout_break b);
/* The end of a line, whatever fits; all open groups are broken.  `extra` spaces are added to the
 * indentation of the next line. */
void layout_line(struct layout *l, bool blank, unsigned extra);

/* Indentation from the next line on. */
void layout_indent(struct layout *l, int by);

/* A block is a group that a comment anywhere inside breaks. */
void layout_open(struct layout *l, bool block);
void layout_close(struct layout *l);
void layout_break_blocks(struct layout *l);

/* Writes what was handed over; no group may be open. */
void layout_flush(struct layout *l);
void layout_free(struct layout *l);

#endif
