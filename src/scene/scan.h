/* Scanning the text of mesh files: words, numbers and what is said when they are not there. */
#ifndef WRT_SCENE_SCAN_H
#define WRT_SCENE_SCAN_H

#include "base/srcmap.h"
#include "base/str.h"
#include "diag/diag.h"

#include <stdbool.h>
#include <stdint.h>

struct scan {
    const struct source *source;
    struct diag *diag;
    const char *at, *end; /* what is still to be read */
    char comment;         /* starts a comment that ends with its line; 0: there are none */
    bool continued;       /* a backslash before a newline makes both of them white space */
};

/* At the start of the text, behind its byte order mark. */
struct scan scan_of(const struct source *source, struct diag *diag);

struct span scan_span(const struct scan *s, const char *begin, const char *end);

/* White space within a line. */
void scan_skip_blanks(struct scan *s);

/* White space, newlines and comments. */
void scan_skip_space(struct scan *s);

/* The rest of the line and its newline. */
void scan_skip_line(struct scan *s);

/* Skips blanks; true at the end of a line, comments aside. */
bool scan_at_line_end(struct scan *s);

/* The word at the cursor, which stays before it; empty at the end of a line. */
struct str scan_word(const struct scan *s);

/* The number at the cursor, which moves behind it; false without a report when there is none. */
bool scan_number(struct scan *s, double *out);

/* The same for a whole number that is not negative. */
bool scan_count(struct scan *s, uint64_t *out);

/* Whether the number spelt from `begin` to the cursor is finite; reports `what` it is if not. */
bool scan_check_finite(const struct scan *s, const char *begin, double x, const char *what);

/* Printable ASCII without blanks. */
bool scan_is_printable(struct str s);

/* Reports that something was expected at the cursor and what is there instead. */
struct diag_entry *scan_expected(const struct scan *s, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
