/* Which findings are told, and at which level (used by diag_report). */
#ifndef WRT_DIAG_POLICY_H
#define WRT_DIAG_POLICY_H

#include "diag/diag.h"

/* False when the rule is off here: by the policy, or by a comment of the text. */
bool diag_level_here(struct diag *d, enum diag_code code, struct span span, enum diag_level *level);

/* Counts a finding; true when its file has had enough of its rule. */
bool diag_is_crowded(struct diag *d, enum diag_code code, struct span span);

#endif
