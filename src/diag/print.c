#include "config.h"

#include "diag/print.h"

const char *diag_level_name(enum diag_level level)
{
    static const char *const names[] = {
        [DIAG_NOTE] = "note", [DIAG_WARNING] = "warning", [DIAG_ERROR] = "error"};
    return names[level];
}

void diag_print(struct diag *d, const struct diag_print_options *o, FILE *out)
{
    diag_sort(d);
    for (size_t i = 0; i < d->entries.n; i++) {
        const struct diag_entry *e = d->entries.at[i];
        if (e->level < o->least)
            continue;
        if (o->format == DIAG_FORMAT_JSON)
            diag_print_json(d, e, out);
        else
            diag_print_text(d, e, o->colour, out);
    }
    if (d->dropped && o->format == DIAG_FORMAT_TEXT)
        fprintf(out, "wrt: note: there are more findings than the %d shown\n", DIAG_LIMIT);
}
