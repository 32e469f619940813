/* The diagnostics in words, for `wrt explain`, `wrt lint --list` and wrt.5. */
#ifndef WRT_LINT_EXPLAIN_H
#define WRT_LINT_EXPLAIN_H

#include "base/buffer.h"
#include "diag/diag.h"

/* Why it matters; NULL when nothing is said of it. */
const char *explain_why(enum diag_code code);

/* What the diagnostic means: why it matters, an example, its thresholds. */
void explain_code(enum diag_code code, struct buffer *out);

/* All rules that can be switched on and off, a line each. */
void explain_list(struct buffer *out);

/* The chapter of wrt.5, in mdoc. */
void explain_manual(struct buffer *out);

#endif
