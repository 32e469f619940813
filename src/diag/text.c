/* Diagnostics as text, in clang's manner:
 *
 *     scene.wrt:3:5: error: unknown property 'radus' of sphere [E102-unknown-property]
 *         3 |     radus: 1
 *           |     ^~~~~
 *           |     radius
 *     note: ...
 */
#include "config.h"

#include "diag/print.h"

#include <string.h>

enum { TAB = 8, WINDOW = 100, LEAD = 60 }; /* columns */

struct style {
    const char *strong, *level, *caret, *fix, *plain;
};

static struct style style_of(enum diag_level level, bool colour)
{
    static const char *const level_colour[] = {
        [DIAG_NOTE] = "\033[1;36m", [DIAG_WARNING] = "\033[1;35m", [DIAG_ERROR] = "\033[1;31m"};
    if (!colour)
        return (struct style){"", "", "", "", ""};
    return (struct style){"\033[1m", level_colour[level], "\033[1;32m", "\033[32m", "\033[0m"};
}

/* The columns of a line that are shown, as byte offsets, so that a line of any length prints. */
struct window {
    size_t begin, end;
};

static bool continues(char c)
{
    return (c & 0xC0) == 0x80;
}

/* Bytes of the character at `at`: 1 for a byte that is no UTF-8, which files that are not scenes
 * may hold. */
static size_t character_length(struct str line, size_t at)
{
    size_t n = str_utf8_length((unsigned char)line.at[at]);
    return at + n <= line.n && str_utf8_valid(line.at + at, n) == n ? n : 1;
}

/* Moves an offset back to the start of its character. */
static size_t character_start(struct str line, size_t at)
{
    enum { LONGEST = 4 };
    for (size_t i = 1; i < LONGEST && i <= at && at < line.n && continues(line.at[at]); i++)
        if (!continues(line.at[at - i]))
            return character_length(line, at - i) > i ? at - i : at;
    return at;
}

static struct window window_around(struct str line, size_t caret)
{
    size_t begin = caret > LEAD && line.n > WINDOW ? caret - LEAD : 0;
    begin = character_start(line, begin);
    size_t end = begin + WINDOW < line.n ? begin + WINDOW : line.n;
    return (struct window){begin, character_start(line, end)};
}

/* A control character, or a byte that is no UTF-8, is shown as a question mark. */
static void put_character(FILE *out, const char *at, size_t n)
{
    bool byte = n == 1 && (unsigned char)*at >= 0x80;
    if (byte || str_control_length(at, n))
        putc('?', out);
    else
        fprintf(out, "%.*s", (int)n, at);
}

/* Prints bytes [begin, end) of the line with tabs widened, or, when as_blank, as many blanks (or
 * `mark`s) as they take.  Returns the column after them. */
static size_t put_columns(FILE *out, struct str line, size_t begin, size_t end, size_t column,
                          char mark)
{
    for (size_t i = begin, n; i < end; i += n) {
        n = character_length(line, i);
        if (line.at[i] == '\t') {
            do
                putc(mark ? mark : ' ', out);
            while (++column % TAB);
            continue;
        }
        if (mark)
            putc(mark, out);
        else
            put_character(out, line.at + i, n);
        column++;
    }
    return column;
}

static void put_source_line(FILE *out, const struct location *at, struct window w)
{
    fprintf(out, "%5u | %s", at->line, w.begin ? "..." : "");
    put_columns(out, at->line_text, w.begin, w.end, 0, 0);
    fprintf(out, "%s\n", w.end < at->line_text.n ? "..." : "");
}

static void put_caret_line(FILE *out, const struct location *at, struct window w, size_t begin,
                           size_t end, const struct style *s)
{
    fprintf(out, "      | %s", w.begin ? "   " : "");
    size_t column = put_columns(out, at->line_text, w.begin, begin, 0, ' ');
    fprintf(out, "%s^", s->caret);
    size_t first = begin < at->line_text.n ? character_length(at->line_text, begin) : 1;
    if (end > begin + first)
        put_columns(out, at->line_text, begin + first, end < w.end ? end : w.end, column + 1, '~');
    fprintf(out, "%s\n", s->plain);
}

/* The replacements under what they replace, where they fit the line. */
static void put_fixits(FILE *out, const struct diag_entry *e, const struct location *at,
                       struct window w, const struct style *s)
{
    size_t column = 0; /* behind the last one; 0: no line is begun */
    for (size_t i = 0; i < e->fixits.n; i++) {
        const struct diag_fixit *f = &e->fixits.at[i];
        bool shows = strcspn(f->text, "\n") > 0; /* what only goes away does not */
        if (!shows || f->span.begin < at->line_base + w.begin ||
            f->span.begin > at->line_base + w.end)
            continue;
        size_t here = f->span.begin - at->line_base, n = strcspn(f->text, "\n");
        if (n == 0)
            continue;
        bool begins = column == 0 || here < column;
        if (begins)
            fprintf(out, "%s      | %s", column ? "\n" : "", w.begin ? "   " : "");
        put_columns(out, at->line_text, begins ? w.begin : column, here, 0, ' ');
        fprintf(out, "%s%.*s%s", s->fix, (int)n, f->text, s->plain);
        column = here + n;
    }
    if (column)
        putc('\n', out);
}

static void put_snippet(FILE *out, const struct location *at, struct span span,
                        const struct diag_entry *e, const struct style *s)
{
    size_t begin = span.begin - at->line_base, end = span.end - at->line_base;
    if (begin > at->line_text.n)
        begin = at->line_text.n;
    if (end > at->line_text.n)
        end = at->line_text.n;
    struct window w = window_around(at->line_text, begin);
    put_source_line(out, at, w);
    put_caret_line(out, at, w, begin, end, s);
    if (e)
        put_fixits(out, e, at, w, s);
}

/* "file:line:column" */
static void put_position(FILE *out, const struct location *at)
{
    fprintf(out, "%s:%u:%u", at->source->name, at->line, at->column);
}

static void put_place(FILE *out, const struct location *at)
{
    if (!at->source)
        fputs("wrt", out);
    else
        put_position(out, at);
    fputs(": ", out);
}

/* The stack: a line for each frame. */
static void put_frames(FILE *out, const struct diag *d, const struct diag_entry *e,
                       const struct style *note)
{
    for (size_t i = 0; i < e->frames.n; i++) {
        const struct diag_label *f = &e->frames.at[i];
        struct location at = srcmap_locate(d->sources, f->span.begin);
        fprintf(out, "%snote:%s %s", note->level, note->plain, f->text);
        if (at.source) {
            fputs(" at ", out);
            put_position(out, &at);
        }
        putc('\n', out);
    }
    if (e->repeats)
        fprintf(out, "%snote:%s the same was found %zu more time%s\n", note->level, note->plain,
                e->repeats, e->repeats == 1 ? "" : "s");
}

void diag_print_text(const struct diag *d, const struct diag_entry *e, bool colour, FILE *out)
{
    const struct diag_rule *rule = &diag_rules[e->code];
    struct style s = style_of(e->level, colour);
    struct location at = srcmap_locate(d->sources, e->span.begin);
    fputs(s.strong, out);
    put_place(out, &at);
    fprintf(out, "%s%s:%s%s %s%s [%s-%s]\n", s.level, diag_level_name(e->level), s.plain, s.strong,
            e->message, s.plain, rule->code, rule->slug);
    if (at.source)
        put_snippet(out, &at, e->span, e, &s);
    struct style note = style_of(DIAG_NOTE, colour);
    for (size_t i = 0; i < e->labels.n; i++) {
        struct location there = srcmap_locate(d->sources, e->labels.at[i].span.begin);
        put_place(out, &there);
        fprintf(out, "%snote:%s %s\n", note.level, note.plain, e->labels.at[i].text);
        if (there.source)
            put_snippet(out, &there, e->labels.at[i].span, NULL, &note);
    }
    for (size_t i = 0; i < e->notes.n; i++)
        fprintf(out, "%snote:%s %s\n", note.level, note.plain, e->notes.at[i]);
    put_frames(out, d, e, &note);
}
