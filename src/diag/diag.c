#include "config.h"

#include "diag/diag.h"

#include <stdarg.h>
#include <stdlib.h>

const struct diag_rule diag_rules[DIAG_CODES] = {
#define DIAG(id, code, slug, level, exit, summary) [DIAG_##id] = {code, slug, summary, level, exit},
#include "diag/diag.def"
#undef DIAG
};

void diag_init(struct diag *d, const struct srcmap *sources)
{
    *d = (struct diag){.sources = sources};
}

static void entry_free(struct diag_entry *e)
{
    vec_free(&e->labels);
    vec_free(&e->notes);
    vec_free(&e->fixits);
}

void diag_free(struct diag *d)
{
    for (size_t i = 0; i < d->entries.n; i++)
        entry_free(d->entries.at[i]);
    entry_free(&d->spare);
    vec_free(&d->entries);
    arena_free(&d->arena);
}

static const char *format_text(struct diag *d, const char *format, va_list args)
{
    va_list again;
    va_copy(again, args);
    int n = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = arena_alloc(&d->arena, (size_t)(n < 0 ? 0 : n) + 1);
    text[0] = 0;
    vsnprintf(text, (size_t)(n < 0 ? 0 : n) + 1, format, args);
    for (char *c = text; *c; c++) /* quoted input must not steer a terminal */
        if ((unsigned char)*c < 32 || *c == 127)
            *c = '?';
    return text;
}

/* An entry beyond the limit is counted, not kept: its details go where nobody reads them. */
static struct diag_entry *take_entry(struct diag *d)
{
    if (d->entries.n < DIAG_LIMIT) {
        struct diag_entry *e = arena_zalloc(&d->arena, 1, sizeof *e);
        vec_push(&d->entries, e);
        return e;
    }
    d->dropped++;
    entry_free(&d->spare);
    return &d->spare;
}

static void count(struct diag *d, const struct diag_rule *rule)
{
    d->errors += rule->level == DIAG_ERROR;
    d->warnings += rule->level == DIAG_WARNING;
    if (rule->exit == DIAG_EXIT_INPUT || (rule->exit == DIAG_EXIT_RESOURCE && !d->exit))
        d->exit = rule->exit;
}

struct diag_entry *diag_report(struct diag *d, enum diag_code code, struct span span,
                               const char *format, ...)
{
    struct diag_entry *e = take_entry(d);
    va_list args;
    va_start(args, format);
    const char *message = e == &d->spare ? "" : format_text(d, format, args);
    va_end(args);
    *e = (struct diag_entry){.code = code,
                             .level = diag_rules[code].level,
                             .span = span,
                             .message = message,
                             .owner = d,
                             .order = d->entries.n};
    count(d, &diag_rules[code]);
    return e;
}

void diag_label(struct diag_entry *e, struct span span, const char *format, ...)
{
    if (e == &e->owner->spare)
        return;
    va_list args;
    va_start(args, format);
    vec_push(&e->labels, (struct diag_label){span, format_text(e->owner, format, args)});
    va_end(args);
}

void diag_note(struct diag_entry *e, const char *format, ...)
{
    if (e == &e->owner->spare)
        return;
    va_list args;
    va_start(args, format);
    vec_push(&e->notes, format_text(e->owner, format, args));
    va_end(args);
}

void diag_fix(struct diag_entry *e, struct span span, enum diag_fix_kind kind, const char *format,
              ...)
{
    if (e == &e->owner->spare)
        return;
    va_list args;
    va_start(args, format);
    vec_push(&e->fixits, (struct diag_fixit){span, format_text(e->owner, format, args), kind});
    va_end(args);
}

void diag_did_you_mean(struct diag_entry *e, struct span span, struct str meant)
{
    if (!meant.n)
        return;
    diag_note(e, "did you mean '%.*s'?", STR_ARG(meant));
    diag_fix(e, span, DIAG_FIX_MAYBE, "%.*s", STR_ARG(meant));
}

static int compare_entries(const void *pa, const void *pb)
{
    const struct diag_entry *a = *(struct diag_entry *const *)pa;
    const struct diag_entry *b = *(struct diag_entry *const *)pb;
    if (a->span.begin != b->span.begin)
        return a->span.begin < b->span.begin ? -1 : 1;
    return a->order < b->order ? -1 : a->order > b->order;
}

void diag_sort(struct diag *d)
{
    if (d->entries.n)
        qsort(d->entries.at, d->entries.n, sizeof *d->entries.at, compare_entries);
}
