/* How two texts differ, line by line. */
#ifndef WRT_BASE_LINEDIFF_H
#define WRT_BASE_LINEDIFF_H

#include "base/buffer.h"

/* Adds the difference in the unified format of diff(1), with three lines of context; nothing when
 * the texts are equal.  Names must hold no newline. */
void linediff(const char *name_a, struct str a, const char *name_b, struct str b,
              struct buffer *out);

#endif
