/* How evaluation came to the place of a finding, in words. */
#include "config.h"

#include "diag/diag.h"

#include "base/num.h"

/* The frames that are told of a deep stack: its innermost and its outermost. */
enum { INNERMOST = 3, OUTERMOST = 2 };

static const char *words_of(struct diag *d, const struct diag_frame *f)
{
    struct str name = srcmap_text(d->sources, f->at);
    switch (f->kind) {
    case DIAG_FRAME_INCLUDE:
        return arena_printf(&d->arena, "in %.*s included", STR_ARG(name));
    case DIAG_FRAME_CALL:
        return arena_printf(&d->arena, "in %.*s(...) called", STR_ARG(name));
    case DIAG_FRAME_USE:
        return arena_printf(&d->arena, "in %.*s(...) used", STR_ARG(name));
    case DIAG_FRAME_ITEM:
        return arena_printf(&d->arena, "in 'for' with item %.0f as %.*s", f->number, STR_ARG(name));
    case DIAG_FRAME_ROUND:
    case DIAG_FRAME_GROUP:
        break;
    }
    char number[NUM_PRINT_BYTES];
    num_print(f->number, number);
    return arena_printf(&d->arena, "in 'for' with %.*s = %s", STR_ARG(name), number);
}

const struct diag_frame *diag_frame_told(const struct diag_frame *innermost)
{
    while (innermost && innermost->kind == DIAG_FRAME_GROUP)
        innermost = innermost->parent;
    return innermost;
}

static const struct diag_frame *next_told(const struct diag_frame *f)
{
    return diag_frame_told(f->parent);
}

/* Mistakes found by two ways are two, but not the many ways through a recursion, which differ only
 * in how often they pass the same places. */
uint64_t diag_frame_sites(const struct diag_frame *innermost)
{
    enum { MOST = 64 };
    uint32_t seen[MOST];
    uint64_t sum = 0;
    int n = 0;
    for (const struct diag_frame *f = diag_frame_told(innermost); f && n < MOST; f = next_told(f)) {
        int i = 0;
        while (i < n && seen[i] != f->at.begin)
            i++;
        if (i < n)
            continue;
        seen[n++] = f->at.begin;
        sum += f->at.begin * UINT64_C(0x9e3779b97f4a7c15) ^ (uint64_t)f->at.begin << 32;
    }
    return sum;
}

static void add(struct diag_entry *e, struct span at, const char *text)
{
    vec_push(&e->frames, (struct diag_label){at, text});
}

void diag_add_frames(struct diag_entry *e, const struct diag_frame *innermost)
{
    size_t n = 0, i = 0;
    innermost = diag_frame_told(innermost);
    for (const struct diag_frame *f = innermost; f; f = next_told(f))
        n++;
    size_t hidden = n > INNERMOST + OUTERMOST + 1 ? n - INNERMOST - OUTERMOST : 0;
    for (const struct diag_frame *f = innermost; f; f = next_told(f), i++)
        if (hidden && i == INNERMOST)
            add(e, (struct span){0}, arena_printf(&e->owner->arena, "... %zu more ...", hidden));
        else if (!hidden || i < INNERMOST || i >= INNERMOST + hidden)
            add(e, f->at, words_of(e->owner, f));
}

void diag_label_made(struct diag_entry *e, struct span span, const struct diag_frame *innermost,
                     const char *text)
{
    enum { MOST = 4 };
    int n = 0;
    diag_label(e, span, "%s", text);
    for (const struct diag_frame *f = diag_frame_told(innermost); f && n < MOST;
         f = next_told(f), n++)
        diag_label(e, f->at, "that one is made %s here", words_of(e->owner, f));
}
