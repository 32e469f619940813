/* Diagnostics: collected while stages run, printed together in file order.
 *
 *     struct diag_entry *e = diag_report(diag, DIAG_UNKNOWN_PROPERTY, span, "unknown property
 * '%.*s'", ...); diag_note(e, "a sphere has: ..."); diag_fix(e, span, DIAG_FIX_SAFE, "radius", "did
 * you mean 'radius'?");
 *
 * Message style: lower case, no full stop, names in single quotes, the reason and what was done;
 * "cannot" (never will) or "could not" (this time). */
#ifndef WRT_DIAG_DIAG_H
#define WRT_DIAG_DIAG_H

#include "base/arena.h"
#include "base/buffer.h"
#include "base/map.h"
#include "base/srcmap.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdio.h>

enum diag_level { DIAG_NOTE, DIAG_WARNING, DIAG_ERROR };

/* Exit statuses of the program (see wrt.1). */
enum diag_exit { DIAG_EXIT_OK = 0, DIAG_EXIT_INPUT = 1, DIAG_EXIT_RESOURCE = 3 };

enum diag_code {
#define DIAG(id, code, slug, group, level, exit, summary) DIAG_##id,
#include "diag/diag.def"
#undef DIAG
    DIAG_CODES
};

/* Rules that are switched on and off together.  What is in none is always on. */
enum diag_group {
#define GROUP(id, name, summary) DIAG_##id,
#include "diag/groups.def"
#undef GROUP
    DIAG_GROUPS
};

struct diag_group_row {
    const char *name, *summary;
};
extern const struct diag_group_row diag_groups[DIAG_GROUPS];

struct diag_rule {
    const char *code, *slug, *summary;
    enum diag_group group;
    enum diag_level level;
    enum diag_exit exit;
};
extern const struct diag_rule diag_rules[DIAG_CODES];

/* Notes that are off unless asked for: those of a group. */
static inline bool diag_is_optional(enum diag_code code)
{
    return diag_rules[code].level == DIAG_NOTE && diag_rules[code].group != DIAG_NONE;
}

/* What only `wrt lint` looks for. */
static inline bool diag_is_lint(enum diag_code code)
{
    return diag_rules[code].code[1] >= '5';
}

/* What a name stands for: a code, a slug, "E102-unknown-property", a group, or "all". */
struct diag_selection {
    bool has[DIAG_CODES];
};

/* False when nothing is called so. */
bool diag_select(struct str name, struct diag_selection *out);
/* The nearest of the names that diag_select knows, or empty. */
struct str diag_nearest_name(struct str name);

/* What becomes of warnings and notes.  Errors stay errors. */
enum diag_setting { DIAG_AS_USUAL, DIAG_OFF, DIAG_ON, DIAG_AS_ERROR };

struct diag_policy {
    uint8_t of[DIAG_CODES]; /* enum diag_setting */
    bool warnings_are_errors;
    bool lint; /* what only `wrt lint` looks for is told, too */
};

void diag_policy_set(struct diag_policy *p, const struct diag_selection *which,
                     enum diag_setting setting);

/* A comment of the text that silences rules. */
struct diag_allow {
    struct span where; /* what it covers; {0, 0}: nothing */
    struct span name;  /* of the rule in the comment */
    struct diag_selection selection;
    bool used;
};

/* Findings of one rule in one file that are told; further ones are counted. */
enum { DIAG_RULE_LIMIT = 20 };

struct diag_crowd {
    struct diag_crowd *next;
    const struct source *source;
    enum diag_code code;
    size_t n;
};

enum diag_fix_kind { DIAG_FIX_SAFE, DIAG_FIX_MAYBE };

struct diag_label {
    struct span span;
    const char *text;
};

struct diag_fixit {
    struct span span; /* replaced; empty: an insertion */
    const char *text;
    enum diag_fix_kind kind;
};

/* How evaluation came to where it stands: includes, calls, uses of templates, rounds of loops,
 * groups. */
enum diag_frame_kind {
    DIAG_FRAME_INCLUDE, /* at: the path as written */
    DIAG_FRAME_CALL,    /* at: the function's name in the call */
    DIAG_FRAME_USE,     /* at: the template's name in its use */
    DIAG_FRAME_ROUND,   /* at: the variable of the loop, which is a number */
    DIAG_FRAME_ITEM,    /* at: the variable of the loop, which is something else */
    DIAG_FRAME_GROUP,   /* at: 'group' and its label; findings do not tell it */
};

struct diag_frame {
    const struct diag_frame *parent; /* the next outer one, or NULL */
    struct span at;
    enum diag_frame_kind kind;
    double
        number; /* DIAG_FRAME_ROUND: the variable's value, or the round's number when it is none */
};

struct diag_entry {
    enum diag_code code;
    enum diag_level level;
    struct span span;
    const char *message;
    VEC(struct diag_label) labels; /* secondary places */
    VEC(const char *) notes;
    VEC(struct diag_fixit) fixits;
    VEC(struct diag_label) frames; /* the stack it was found in, innermost first */
    size_t repeats;                /* how often it was found again in other rounds or uses */
    size_t ways;                   /* how often anything was found at its place inside frames */
    struct diag *owner;
    size_t order; /* of report, to keep sorting stable */
};

/* Errors kept; further ones are counted only.  Likewise of warnings and notes together. */
enum { DIAG_LIMIT = 1000 };

struct diag {
    const struct srcmap *sources; /* borrowed */
    struct arena arena;
    const struct diag_frame *frame; /* borrowed: set by whoever evaluates, kept in words */
    VEC(struct diag_entry *) entries;
    struct map framed; /* code, place and way to it to the first entry found there inside a frame */
    const struct diag_policy *policy; /* borrowed; NULL: everything as usual */
    VEC(struct diag_allow) allows;    /* in the order of what they cover, for each text */
    struct map crowds;                /* rule and file to how many there are */
    struct diag_crowd *crowded;       /* the same as a list, the last one first */
    size_t kept[2];                   /* entries: errors, others */
    size_t dropped;                   /* errors */
    size_t errors, warnings;          /* all, dropped ones too */
    size_t raised; /* warnings and notes told as errors: they keep nothing from being looked for */
    enum diag_exit exit;     /* what the errors so far ask for: INPUT wins over RESOURCE */
    struct diag_entry spare; /* takes what is dropped */
};

void diag_init(struct diag *d, const struct srcmap *sources);
void diag_free(struct diag *d);

/* Reports; the entry returned is valid until diag_free and takes labels, notes and fix-its.  An
 * unknown span ({0, 0}) means no place in a text.  Inside a frame the same finding at the same
 * place, whatever the rounds of the loops around, is kept once and counted. */
struct diag_entry *diag_report(struct diag *d, enum diag_code code, struct span span,
                               const char *format, ...) __attribute__((format(printf, 4, 5)));

/* What was reported so far. */
struct diag_mark {
    size_t entries, kept[2], dropped, errors, warnings, raised;
    enum diag_exit exit;
};
struct diag_mark diag_mark(const struct diag *d);
/* Takes back what was reported since; none of it inside a frame. */
void diag_rewind(struct diag *d, const struct diag_mark *mark);

void diag_label(struct diag_entry *e, struct span span, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void diag_note(struct diag_entry *e, const char *format, ...) __attribute__((format(printf, 2, 3)));
void diag_fix(struct diag_entry *e, struct span span, enum diag_fix_kind kind, const char *format,
              ...) __attribute__((format(printf, 4, 5)));

/* Whether findings of this rule are told at all: finding them may cost much. */
bool diag_wants(const struct diag *d, enum diag_code code);

/* A comment that silences the rules called `name` (a span in a text) within `where`. */
void diag_allow(struct diag *d, struct span where, struct span name);
/* Reports the comments that silenced nothing so far. */
void diag_report_unused_allows(struct diag *d);

/* Errors by nature: a warning that is told as one keeps nothing from going on. */
static inline size_t diag_failures(const struct diag *d)
{
    return d->errors - d->raised;
}

/* True when further errors would only be counted: looking for more is of no use. */
static inline bool diag_full(const struct diag *d)
{
    return d->dropped > 0;
}

/* A number for the places of the frames, whatever their order and rounds (used by diag_report). */
uint64_t diag_frame_sites(const struct diag_frame *innermost);
/* The innermost that findings tell: one text has one way into its groups. */
const struct diag_frame *diag_frame_told(const struct diag_frame *innermost);
/* Tells the frames in words (likewise). */
void diag_add_frames(struct diag_entry *e, const struct diag_frame *innermost);

/* A label for something else that is concerned, and one for each of the nearest frames it was made
 * in. */
void diag_label_made(struct diag_entry *e, struct span span, const struct diag_frame *innermost,
                     const char *text);

/* Adds the note "did you mean 'x'?" and a fix-it when `meant` is not empty. */
void diag_did_you_mean(struct diag_entry *e, struct span span, struct str meant);

/* Sorts by place: entries without one first, then by source and offset. */
void diag_sort(struct diag *d);

enum diag_format { DIAG_FORMAT_TEXT, DIAG_FORMAT_JSON, DIAG_FORMAT_SARIF };

/* What is printed of rules themselves: why they matter, and all that is known. */
struct diag_book {
    const char *(*why)(enum diag_code code); /* NULL: nothing */
    void (*explain)(enum diag_code code, struct buffer *out);
};

struct diag_print_options {
    enum diag_format format;
    const struct diag_book *book; /* of SARIF; may be NULL */
    size_t *printed;              /* SARIF: results of this log so far */
    bool colour;
    enum diag_level least; /* lower levels are not printed */
    bool begun, goes_on;   /* SARIF: one log for what is printed before and after, too */
};

/* How many findings of each level are printed, with those of which there are too many. */
void diag_count_shown(const struct diag *d, enum diag_level least, size_t of[DIAG_ERROR + 1]);

/* Prints all entries in order. */
void diag_print(struct diag *d, const struct diag_print_options *o, FILE *out);

#endif
