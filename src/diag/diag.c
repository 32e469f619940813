#include "config.h"

#include "diag/policy.h"

#include "base/str.h"

#include <stdarg.h>
#include <stdlib.h>

enum { FIX_LIMIT = 1000 }; /* bytes: longer replacements help nobody */

const struct diag_group_row diag_groups[DIAG_GROUPS] = {
#define GROUP(id, name, summary) [DIAG_##id] = {name, summary},
#include "diag/groups.def"
#undef GROUP
};

const struct diag_rule diag_rules[DIAG_CODES] = {
#define DIAG(id, code, slug, group, level, exit, summary) \
    [DIAG_##id] = {code, slug, summary, DIAG_##group, level, exit},
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
    vec_free(&e->frames);
}

void diag_free(struct diag *d)
{
    for (size_t i = 0; i < d->entries.n; i++)
        entry_free(d->entries.at[i]);
    entry_free(&d->spare);
    vec_free(&d->entries);
    vec_free(&d->allows);
    map_free(&d->framed);
    map_free(&d->crowds);
    arena_free(&d->arena);
}

/* As printf into memory of its own, which the caller frees; *n is its length. */
static char *print_text(const char *format, va_list args, size_t *n)
{
    va_list again;
    va_copy(again, args);
    int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    *n = length < 0 ? 0 : (size_t)length;
    char *text = mem_zalloc(*n + 1, 1);
    vsnprintf(text, *n + 1, format, args);
    return text;
}

static size_t character_start(const char *text, size_t at)
{
    while (at && (text[at] & 0xC0) == 0x80)
        at--;
    return at;
}

/* A text that quotes input: kept short, whatever it quotes, and unable to steer a terminal. */
static const char *format_text(struct diag *d, const char *format, va_list args)
{
    enum { MOST = 600, HEAD = 300, TAIL = 200 };
    size_t n;
    char *text = print_text(format, args, &n);
    for (size_t i = 0; i < n; i++)
        memset(text + i, '?', str_control_length(text + i, n - i));
    const char *kept;
    if (n <= MOST)
        kept = arena_copy(&d->arena, text, n);
    else
        kept = arena_printf(&d->arena, "%.*s...%s", (int)character_start(text, HEAD), text,
                            text + character_start(text, n - TAIL));
    free(text);
    return kept;
}

/* An entry whose details go where nobody reads them. */
static struct diag_entry *spare_entry(struct diag *d)
{
    entry_free(&d->spare);
    d->spare = (struct diag_entry){.owner = d};
    return &d->spare;
}

/* An entry beyond the limit is counted, not kept.  Warnings never take the place of errors. */
static struct diag_entry *take_entry(struct diag *d, enum diag_level level)
{
    size_t *kept = &d->kept[level != DIAG_ERROR];
    if (*kept == DIAG_LIMIT) {
        d->dropped += level == DIAG_ERROR;
        return spare_entry(d);
    }
    ++*kept;
    struct diag_entry *e = arena_zalloc(&d->arena, 1, sizeof *e);
    vec_push(&d->entries, e);
    return e;
}

static void count(struct diag *d, enum diag_code code, enum diag_level level)
{
    enum diag_exit status = diag_rules[code].exit;
    d->errors += level == DIAG_ERROR;
    d->raised += level == DIAG_ERROR && diag_rules[code].level != DIAG_ERROR;
    d->warnings += level == DIAG_WARNING;
    if (level == DIAG_ERROR && status == DIAG_EXIT_OK)
        status = DIAG_EXIT_INPUT;
    if (status == DIAG_EXIT_INPUT || (status == DIAG_EXIT_RESOURCE && !d->exit))
        d->exit = status;
}

/* Code, place and way to it (0: any) as a key; they have no padding. */
struct key {
    uint64_t sites;
    struct span span;
    uint64_t code;
};

static struct diag_entry *get_framed(const struct diag *d, const struct key *k)
{
    return map_get(&d->framed, (struct str){(const char *)k, sizeof *k});
}

static void set_framed(struct diag *d, const struct key *k, struct diag_entry *e)
{
    map_set(&d->framed, (struct str){arena_copy(&d->arena, (const char *)k, sizeof *k), sizeof *k},
            e);
}

/* Wrong as it stands, whatever the way to it. */
static bool is_of_text(uint64_t code)
{
    return code >= DIAG_UNKNOWN_KIND && code <= DIAG_MISPLACED;
}

/* The entry that a finding inside frames only repeats, in another round of a loop or another use;
 * NULL when it is new.  After many at one place the ways are not told apart any more. */
static struct diag_entry *find_repeated(struct diag *d, struct key *k)
{
    enum { MANY = 1000 };
    const struct diag_frame *frame = diag_frame_told(d->frame);
    struct diag_entry *first = frame ? get_framed(d, k) : NULL;
    if (!frame || (first && (is_of_text(k->code) || first->ways++ > MANY)))
        return first;
    k->sites = diag_frame_sites(frame);
    return get_framed(d, k);
}

static void remember_frame(struct diag *d, struct diag_entry *e, struct key *k)
{
    if (!diag_frame_told(d->frame) || e == &d->spare)
        return;
    diag_add_frames(e, d->frame);
    set_framed(d, k, e);
    k->sites = 0;
    if (!get_framed(d, k))
        set_framed(d, k, e);
}

struct diag_entry *diag_report(struct diag *d, enum diag_code code, struct span span,
                               const char *format, ...)
{
    struct key key = {0, span, code};
    enum diag_level level;
    if (!diag_level_here(d, code, span, &level))
        return spare_entry(d);
    count(d, code, level);
    struct diag_entry *first = find_repeated(d, &key);
    if (first) {
        first->repeats++;
        return spare_entry(d);
    }
    if (level != DIAG_ERROR && diag_is_crowded(d, code, span))
        return spare_entry(d);
    struct diag_entry *e = take_entry(d, level);
    va_list args;
    va_start(args, format);
    const char *message = e == &d->spare ? "" : format_text(d, format, args);
    va_end(args);
    *e = (struct diag_entry){.code = code,
                             .level = level,
                             .span = span,
                             .message = message,
                             .owner = d,
                             .order = d->entries.n};
    remember_frame(d, e, &key);
    return e;
}

struct diag_mark diag_mark(const struct diag *d)
{
    return (struct diag_mark){
        d->entries.n, {d->kept[0], d->kept[1]}, d->dropped, d->errors, d->warnings, d->raised,
        d->exit};
}

void diag_rewind(struct diag *d, const struct diag_mark *mark)
{
    while (d->entries.n > mark->entries)
        entry_free(d->entries.at[--d->entries.n]);
    memcpy(d->kept, mark->kept, sizeof d->kept);
    d->dropped = mark->dropped;
    d->errors = mark->errors;
    d->warnings = mark->warnings;
    d->raised = mark->raised;
    d->exit = mark->exit;
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
    size_t n;
    char *text = print_text(format, args, &n);
    va_end(args);
    if (n <= FIX_LIMIT)
        vec_push(&e->fixits,
                 (struct diag_fixit){span, arena_copy(&e->owner->arena, text, n), kind});
    free(text);
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
