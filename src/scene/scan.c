#include "config.h"

#include "scene/scan.h"

#include "base/num.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

enum { FOUND_LIMIT = 24 }; /* bytes of a word that a message quotes */

struct scan scan_of(const struct source *source, struct diag *diag)
{
    static const char byte_order_mark[] = "\xEF\xBB\xBF";
    struct scan s = {.source = source, .diag = diag, .at = source->text};
    s.end = s.at + source->n;
    if (source->n >= 3 && memcmp(s.at, byte_order_mark, 3) == 0)
        s.at += 3;
    return s;
}

struct span scan_span(const struct scan *s, const char *begin, const char *end)
{
    return (struct span){s->source->base + (uint32_t)(begin - s->source->text),
                         s->source->base + (uint32_t)(end - s->source->text)};
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

/* Bytes of the backslash and newline at p, or 0. */
static size_t continuation(const struct scan *s, const char *p)
{
    if (!s->continued || *p != '\\')
        return 0;
    if (s->end - p >= 2 && p[1] == '\n')
        return 2;
    return s->end - p >= 3 && p[1] == '\r' && p[2] == '\n' ? 3 : 0;
}

static bool is_comment(const struct scan *s, char c)
{
    return s->comment && c == s->comment;
}

static bool ends_word(const struct scan *s, const char *p)
{
    return p >= s->end || is_blank(*p) || *p == '\n' || is_comment(s, *p) || continuation(s, p);
}

void scan_skip_blanks(struct scan *s)
{
    while (s->at < s->end) {
        size_t n = is_blank(*s->at) ? 1 : continuation(s, s->at);
        if (n == 0)
            return;
        s->at += n;
    }
}

/* A comment ends with its line whatever stands before the newline. */
static void skip_to_newline(struct scan *s)
{
    const char *newline = memchr(s->at, '\n', (size_t)(s->end - s->at));
    s->at = newline ? newline + 1 : s->end;
}

void scan_skip_line(struct scan *s)
{
    while (s->continued && s->at < s->end && *s->at != '\n' && !is_comment(s, *s->at)) {
        size_t n = continuation(s, s->at);
        s->at += n ? n : 1;
    }
    skip_to_newline(s);
}

void scan_skip_space(struct scan *s)
{
    for (scan_skip_blanks(s); s->at < s->end; scan_skip_blanks(s)) {
        if (is_comment(s, *s->at))
            skip_to_newline(s);
        else if (*s->at == '\n')
            s->at++;
        else
            return;
    }
}

bool scan_at_line_end(struct scan *s)
{
    scan_skip_blanks(s);
    return s->at >= s->end || *s->at == '\n' || is_comment(s, *s->at);
}

struct str scan_word(const struct scan *s)
{
    const char *p = s->at;
    while (!ends_word(s, p))
        p++;
    return (struct str){s->at, (size_t)(p - s->at)};
}

bool scan_number(struct scan *s, double *out)
{
    const char *after = num_parse(s->at, s->end, out);
    if (!after || !ends_word(s, after))
        return false;
    s->at = after;
    return true;
}

/* Nearly all are a few digits. */
bool scan_count(struct scan *s, uint64_t *out)
{
    const char *p = s->at;
    uint64_t n = 0;
    while (p < s->end && *p >= '0' && *p <= '9' && p - s->at < 18)
        n = n * 10 + (uint64_t)(*p++ - '0');
    if (p > s->at && ends_word(s, p)) {
        s->at = p;
        *out = n;
        return true;
    }
    const char *begin = s->at;
    double x;
    if (scan_number(s, &x) && x >= 0 && x < 1e18 && x == floor(x)) {
        *out = (uint64_t)x;
        return true;
    }
    s->at = begin;
    return false;
}

bool scan_check_finite(const struct scan *s, const char *begin, double x, const char *what)
{
    if (isfinite(x))
        return true;
    diag_report(s->diag, DIAG_NOT_FINITE, scan_span(s, begin, s->at), "this %s is too large", what);
    return false;
}

bool scan_is_printable(struct str s)
{
    for (size_t i = 0; i < s.n; i++)
        if (s.at[i] <= ' ' || s.at[i] > '~')
            return false;
    return true;
}

struct diag_entry *scan_expected(const struct scan *s, const char *format, ...)
{
    struct str found = scan_word(s);
    struct span span = scan_span(s, s->at, s->at + found.n);
    char what[128];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    if (s->at >= s->end)
        return diag_report(s->diag, DIAG_MESH_SYNTAX, span, "the file ends before %s", what);
    if (found.n == 0)
        return diag_report(s->diag, DIAG_MESH_SYNTAX, span, "the line ends before %s", what);
    if (!scan_is_printable(found))
        return diag_report(s->diag, DIAG_MESH_SYNTAX, span, "expected %s, found no text", what);
    return diag_report(s->diag, DIAG_MESH_SYNTAX, span, "expected %s, found '%.*s%s'", what,
                       (int)(found.n > FOUND_LIMIT ? FOUND_LIMIT : found.n), found.at,
                       found.n > FOUND_LIMIT ? "..." : "");
}
