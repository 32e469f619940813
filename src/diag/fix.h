/* Changes that findings propose, made in a text. */
#ifndef WRT_DIAG_FIX_H
#define WRT_DIAG_FIX_H

#include "base/buffer.h"
#include "diag/diag.h"

/* Adds the source's text to *out with what the findings propose for it: what is safe, or all.
 * Fix-its of one finding are made together or not at all, and of those that overlap the first
 * finding's only, so that another round is needed; misspelt names in allow comments have a round of
 * their own.  Returns how many findings were mended. */
size_t diag_fix_text(struct diag *d, const struct source *source, bool all, struct buffer *out);

/* How many findings that would mend, but for those that overlap. */
size_t diag_fixable(const struct diag *d, const struct source *source, bool all);

#endif
