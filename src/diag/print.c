#include "config.h"

#include "diag/print.h"

#include <string.h>

const char *diag_level_name(enum diag_level level)
{
    static const char *const names[] = {
        [DIAG_NOTE] = "note", [DIAG_WARNING] = "warning", [DIAG_ERROR] = "error"};
    return names[level];
}

bool diag_is_shown(const struct diag_entry *e, enum diag_level least)
{
    return e->level >= least || (least < DIAG_ERROR && diag_is_optional(e->code));
}

void diag_count_shown(const struct diag *d, enum diag_level least, size_t of[DIAG_ERROR + 1])
{
    memset(of, 0, (DIAG_ERROR + 1) * sizeof *of);
    for (size_t i = 0; i < d->entries.n; i++)
        of[d->entries.at[i]->level] += diag_is_shown(d->entries.at[i], least);
    for (const struct diag_crowd *c = d->crowded; c; c = c->next)
        if (c->n > DIAG_RULE_LIMIT && diag_rules[c->code].level >= least)
            of[diag_rules[c->code].level] += c->n - DIAG_RULE_LIMIT;
    of[DIAG_ERROR] += d->dropped;
}

/* What was counted only. */
static void print_crowds(const struct diag *d, const struct diag_print_options *o, FILE *out)
{
    for (const struct diag_crowd *c = d->crowded; c; c = c->next)
        if (c->n > DIAG_RULE_LIMIT && diag_rules[c->code].level >= o->least)
            fprintf(out, "%s: note: %zu more findings of '%s'\n",
                    c->source ? c->source->name : "wrt", c->n - DIAG_RULE_LIMIT,
                    diag_rules[c->code].slug);
    if (d->dropped)
        fprintf(out, "wrt: note: there are more findings than the %d shown\n", DIAG_LIMIT);
}

void diag_print(struct diag *d, const struct diag_print_options *o, FILE *out)
{
    diag_sort(d);
    if (o->format == DIAG_FORMAT_SARIF) {
        diag_print_sarif(d, o, out);
        return;
    }
    for (size_t i = 0; i < d->entries.n; i++) {
        const struct diag_entry *e = d->entries.at[i];
        if (!diag_is_shown(e, o->least))
            continue;
        if (o->format == DIAG_FORMAT_JSON)
            diag_print_json(d, e, out);
        else
            diag_print_text(d, e, o->colour, out);
    }
    if (o->format == DIAG_FORMAT_TEXT)
        print_crowds(d, o, out);
}
