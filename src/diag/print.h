/* Writers of one entry, one for each format (used by diag_print). */
#ifndef WRT_DIAG_PRINT_H
#define WRT_DIAG_PRINT_H

#include "diag/diag.h"

void diag_print_text(const struct diag *d, const struct diag_entry *e, bool colour, FILE *out);
void diag_print_json(const struct diag *d, const struct diag_entry *e, FILE *out);

/* All entries as a run of a SARIF log; they are sorted. */
void diag_print_sarif(const struct diag *d, const struct diag_print_options *o, FILE *out);

/* At least that level, or asked for by name. */
bool diag_is_shown(const struct diag_entry *e, enum diag_level least);

const char *diag_level_name(enum diag_level level);

#endif
