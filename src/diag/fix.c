/* Changes that findings propose, made in a text. */
#include "config.h"

#include "diag/fix.h"

#include <stdlib.h>

static bool lies_in(struct span s, const struct source *source)
{
    return s.begin >= source->base && s.end <= source->base + source->n && s.begin <= s.end;
}

/* Whether all that the finding proposes may be done to this text: half of it may be wrong. */
static bool is_ready(const struct diag_entry *e, const struct source *source, bool all)
{
    for (size_t i = 0; i < e->fixits.n; i++) {
        const struct diag_fixit *f = &e->fixits.at[i];
        if (!lies_in(f->span, source) || (f->kind != DIAG_FIX_SAFE && !all))
            return false;
    }
    return e->fixits.n > 0;
}

struct edits {
    VEC(struct diag_fixit) list;
};

/* Two insertions at one place are not told apart, so they meet, too. */
static bool meets(const struct diag_fixit *a, const struct diag_fixit *b)
{
    if (a->span.begin == b->span.begin)
        return true;
    return a->span.begin < b->span.end && b->span.begin < a->span.end;
}

static bool meets_any(const struct edits *edits, const struct diag_entry *e)
{
    for (size_t i = 0; i < edits->list.n; i++)
        for (size_t k = 0; k < e->fixits.n; k++)
            if (meets(&edits->list.at[i], &e->fixits.at[k]))
                return true;
    return false;
}

/* What a finding proposes for one place are alternatives: the first is taken. */
static void take(struct edits *edits, const struct diag_entry *e)
{
    size_t first = edits->list.n;
    for (size_t i = 0; i < e->fixits.n; i++) {
        size_t k = first;
        while (k < edits->list.n && !meets(&edits->list.at[k], &e->fixits.at[i]))
            k++;
        if (k == edits->list.n)
            vec_push(&edits->list, e->fixits.at[i]);
    }
}

static int compare(const void *a, const void *b)
{
    const struct diag_fixit *x = a, *y = b;
    return x->span.begin < y->span.begin ? -1 : x->span.begin > y->span.begin;
}

/* A name in an allow comment that is misspelt is mended before anything else: what the comment
 * allows is then let be. */
static bool is_misspelt_allow(const struct diag_entry *e)
{
    return e->code == DIAG_UNUSED_ALLOW && e->fixits.n > 0;
}

static bool any_misspelt_allow(const struct diag *d, const struct source *source, bool all)
{
    for (size_t i = 0; i < d->entries.n; i++)
        if (is_misspelt_allow(d->entries.at[i]) && is_ready(d->entries.at[i], source, all))
            return true;
    return false;
}

size_t diag_fixable(const struct diag *d, const struct source *source, bool all)
{
    size_t n = 0;
    for (size_t i = 0; i < d->entries.n; i++)
        n += is_ready(d->entries.at[i], source, all);
    return n;
}

size_t diag_fix_text(struct diag *d, const struct source *source, bool all, struct buffer *out)
{
    struct edits edits = {0};
    size_t findings = 0, at = 0;
    bool allows_only = any_misspelt_allow(d, source, all);
    diag_sort(d);
    for (size_t i = 0; i < d->entries.n; i++) {
        const struct diag_entry *e = d->entries.at[i];
        if (!is_ready(e, source, all) || meets_any(&edits, e) ||
            (allows_only && !is_misspelt_allow(e)))
            continue;
        findings++;
        take(&edits, e);
    }
    if (edits.list.n)
        qsort(edits.list.at, edits.list.n, sizeof *edits.list.at, compare);
    for (size_t i = 0; i < edits.list.n; i++) {
        const struct diag_fixit *f = &edits.list.at[i];
        buffer_add(out, source->text + at, f->span.begin - source->base - at);
        buffer_puts(out, f->text);
        at = f->span.end - source->base;
    }
    buffer_add(out, source->text + at, source->n - at);
    vec_free(&edits.list);
    return findings;
}
