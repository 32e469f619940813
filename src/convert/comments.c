#include "config.h"

#include "convert/comments.h"

#include "print/gap.h"

#include <stdlib.h>

/* ---- content ---- */

static struct str text_of(const struct ast *ast, struct span span)
{
    return (struct str){ast->source->text + (span.begin - ast->source->base),
                        span.end - span.begin};
}

static struct str without(struct str s, size_t front, size_t back)
{
    return (struct str){s.at + front, s.n - front - back};
}

/* The length without blanks at the end; with them when they are a line of their own. */
static size_t length_without_blanks(struct str s)
{
    size_t n = s.n;
    while (n && memchr(" \t\r", s.at[n - 1], 3))
        n--;
    return n && s.at[n - 1] == '\n' ? s.n : n;
}

/* Blanks next to the marks are the marks' own: one in front, and all behind. */
static struct str content_of(const struct ast *ast, const struct trivia *c)
{
    struct str s = text_of(ast, c->span);
    if (ast->xml)
        s = without(s, 4, 3);
    else
        s = without(s, 2, c->kind == TRIVIA_BLOCK_COMMENT ? 2 : 0);
    s.n = length_without_blanks(s);
    return s.n && s.at[0] == ' ' ? without(s, 1, 0) : s;
}

static bool spans_lines(struct str s)
{
    return s.n && memchr(s.at, '\n', s.n);
}

/* Backslashes at the start. */
static size_t backslashes(struct str s)
{
    size_t n = 0;
    while (n < s.n && s.at[n] == '\\')
        n++;
    return n;
}

static bool parse_note(struct str s, struct note *out)
{
    static const char head[] = "xml: ";
    size_t start = sizeof head - 1;
    if (s.n < start || memcmp(s.at, head, start) != 0)
        return false;
    s = without(s, start, 0);
    size_t n = 0;
    while (n < s.n && ((s.at[n] | 32) >= 'a' && (s.at[n] | 32) <= 'z'))
        n++;
    bool quoted = n > 0 && s.n >= n + 3 && s.at[n] == '=' && s.at[n + 1] == '"' &&
                  s.at[s.n - 1] == '"' && !memchr(s.at + n + 2, '"', s.n - n - 3);
    if (!quoted)
        return false;
    *out = (struct note){{s.at, n}, without(s, n + 2, 1)};
    return true;
}

/* ---- escapes ---- */

/* Characters that XML texts may not hold, whatever their spelling. */
static size_t forbidden_length(struct str s)
{
    unsigned char c = (unsigned char)s.at[0];
    if (c < 0x20)
        return c != '\t' && c != '\n' && c != '\r';
    bool noncharacter =
        s.n >= 3 && c == 0xEF && (unsigned char)s.at[1] == 0xBF && (unsigned char)s.at[2] >= 0xBE;
    return noncharacter ? 3 : 0;
}

bool xml_can_say(struct str text)
{
    for (size_t i = 0; i < text.n; i++)
        if (forbidden_length(without(text, i, 0)))
            return false;
    return true;
}

/* The length of `\u{1}` with its backslashes when it names a character that XML forbids; *c is the
 * character. */
static size_t escaped_length(struct str s, char c[4], size_t *length)
{
    size_t n = backslashes(s);
    char digits[8] = "", *end;
    const char *close = n && n + 2 < s.n ? memchr(s.at + n + 2, '}', s.n - n - 2) : NULL;
    size_t count = close ? (size_t)(close - s.at) - n - 2 : 0;
    if (!close || s.at[n] != 'u' || s.at[n + 1] != '{' || count == 0 || count > 4)
        return 0;
    memcpy(digits, s.at + n + 2, count);
    unsigned long code = strtoul(digits, &end, 16);
    if (*end || digits[0] == '-' || digits[0] == '+')
        return 0;
    *length = str_utf8_encode(code, c);
    return forbidden_length((struct str){c, *length}) ? (size_t)(close + 1 - s.at) : 0;
}

/* The second of two characters that must not meet stands at s[at], perhaps behind backslashes. */
static bool meets(struct str s, size_t at, char second, size_t *between)
{
    *between = backslashes(without(s, at, 0));
    return at + *between < s.n && s.at[at + *between] == second;
}

/* Copies text in which `first` and `second` may meet (unless), with one more backslash between
 * them, or with one less. */
static void copy_apart(struct str s, char first, char second, bool more, struct buffer *out)
{
    for (size_t i = 0; i < s.n; i++) {
        size_t n;
        buffer_add(out, s.at + i, 1);
        if (s.at[i] != first || !meets(s, i + 1, second, &n))
            continue;
        if (more || n)
            buffer_fill(out, '\\', more ? n + 1 : n - 1);
        i += n;
    }
}

static void copy_for_xml(struct str s, struct buffer *out)
{
    struct buffer visible = {0};
    for (size_t i = 0; i < s.n;) {
        struct str rest = without(s, i, 0);
        char c[4];
        size_t n, forbidden = forbidden_length(rest), escaped = escaped_length(rest, c, &n);
        if (forbidden == 3)
            buffer_printf(&visible, "\\u{FFF%c}", (unsigned char)rest.at[2] == 0xBE ? 'E' : 'F');
        else if (forbidden)
            buffer_printf(&visible, "\\u{%X}", (unsigned)(unsigned char)rest.at[0]);
        else if (escaped)
            buffer_printf(&visible, "\\%.*s", (int)escaped, rest.at);
        else
            buffer_add(&visible, rest.at, 1);
        i += forbidden ? forbidden : escaped ? escaped : 1;
    }
    copy_apart((struct str){visible.at, visible.n}, '-', '-', true, out);
    buffer_free(&visible);
}

static void copy_from_xml(struct str s, struct buffer *out)
{
    struct buffer joined = {0};
    copy_apart(s, '-', '-', false, &joined);
    s = (struct str){joined.at, joined.n};
    for (size_t i = 0; i < s.n;) {
        struct str rest = without(s, i, 0);
        char c[4];
        size_t n, escaped = escaped_length(rest, c, &n);
        if (escaped && backslashes(rest) == 1)
            buffer_add(out, c, n);
        else if (escaped)
            buffer_add(out, rest.at + 1, escaped - 1);
        else
            buffer_add(out, rest.at, 1);
        i += escaped ? escaped : 1;
    }
    buffer_free(&joined);
}

/* A note, or a note behind backslashes. */
static bool looks_like_note(struct str s)
{
    struct note note;
    return parse_note(without(s, backslashes(s), 0), &note);
}

/* ---- writing ---- */

void begin_line(struct buffer *out, bool blank)
{
    size_t newlines = 0, wanted = blank ? 2 : 1;
    while (newlines < out->n && newlines < wanted && out->at[out->n - 1 - newlines] == '\n')
        newlines++;
    if (out->n)
        buffer_fill(out, '\n', wanted - newlines);
}

/* Spaces up to a column of the current line. */
static void fill_to(struct buffer *out, unsigned column)
{
    unsigned now = 0;
    for (size_t i = out->n; i > 0 && out->at[i - 1] != '\n'; i--)
        now += (out->at[i - 1] & 0xC0) != 0x80;
    buffer_fill(out, ' ', now < column ? column - now : 0);
}

/* Writes a comment that began at `column`.  Its further lines keep their place under the first
 * one's content, though the marks of the formats differ by two columns: the printer moves all lines
 * as far as the first. */
static void put_marked(struct str content, const char *open, const char *close, unsigned column,
                       struct buffer *out)
{
    const char *newline = content.n ? memchr(content.at, '\n', content.n) : NULL;
    bool to_xml = open[0] == '<';
    unsigned more = to_xml && column < 2 ? 2 - column : 0; /* where there is no room to the left */
    if (newline)
        fill_to(out, to_xml ? column + more - 2 : column + 2);
    buffer_puts(out, open);
    if (content.n && content.at[0] != '\n')
        buffer_puts(out, " ");
    for (; newline; newline = content.n ? memchr(content.at, '\n', content.n) : NULL) {
        buffer_add(out, content.at, (size_t)(newline + 1 - content.at));
        buffer_fill(out, ' ', more);
        content = without(content, (size_t)(newline + 1 - content.at), 0);
    }
    buffer_str(out, content);
    if (str_trim(content).n || out->at[out->n - 1] == open[strlen(open) - 1])
        buffer_puts(out, " ");
    buffer_puts(out, close);
}

static void put_native(struct str content, enum comment_place place, unsigned column,
                       struct buffer *out)
{
    bool line = (place == COMMENT_OWN_LINE || place == COMMENT_BEHIND) && !spans_lines(content);
    if (place == COMMENT_OWN_LINE || (place == COMMENT_INSIDE && spans_lines(content)))
        begin_line(out, false);
    if (place == COMMENT_BEHIND || place == COMMENT_BEHIND_MORE)
        buffer_puts(out, " ");
    if (line) {
        buffer_printf(out, content.n ? "// %.*s" : "//", (int)content.n, content.at);
    } else {
        struct buffer apart = {0};
        copy_apart(content, '*', '/', true, &apart);
        put_marked((struct str){apart.at, apart.n}, "/*", "*/", column, out);
        buffer_free(&apart);
    }
    buffer_puts(out, place == COMMENT_INSIDE ? " " : place == COMMENT_BEHIND_MORE ? "" : "\n");
}

void comment_to_native(const struct ast *ast, const struct trivia *c, enum comment_place place,
                       struct buffer *out)
{
    struct str content = content_of(ast, c);
    struct buffer text = {0};
    if (looks_like_note(content))
        buffer_puts(&text, "\\");
    copy_from_xml(content, &text);
    put_native((struct str){text.at, text.n}, place, gap_column(ast, c->span.begin), out);
    buffer_free(&text);
}

void note_write(const char *name, struct str value, enum comment_place place, struct buffer *out)
{
    struct buffer text = {0};
    buffer_printf(&text, "xml: %s=\"", name);
    xml_escape(value, true, &text);
    buffer_puts(&text, "\"");
    put_native((struct str){text.at, text.n}, place, 0, out);
    buffer_free(&text);
}

/* The content of a native comment with the escapes undone that its marks need. */
static struct str native_content(const struct ast *ast, const struct trivia *c, struct buffer *own)
{
    struct str content = content_of(ast, c);
    if (c->kind == TRIVIA_BLOCK_COMMENT) {
        copy_apart(content, '*', '/', false, own);
        content = (struct str){own->at, own->n};
    }
    return content;
}

void comment_to_xml(const struct ast *ast, const struct trivia *c, enum comment_place place,
                    struct buffer *out)
{
    struct buffer own = {0}, text = {0};
    struct str content = native_content(ast, c, &own);
    if (looks_like_note(content) && backslashes(content))
        content = without(content, 1, 0);
    copy_for_xml(content, &text);
    if (place == COMMENT_OWN_LINE)
        begin_line(out, false);
    if (place == COMMENT_BEHIND)
        buffer_puts(out, " ");
    put_marked((struct str){text.at, text.n}, "<!--", "-->", gap_column(ast, c->span.begin), out);
    if (place == COMMENT_OWN_LINE)
        buffer_puts(out, "\n");
    buffer_free(&own);
    buffer_free(&text);
}

bool note_read(const struct ast *ast, const struct trivia *c, struct note *out)
{
    return parse_note(content_of(ast, c), out);
}

void xml_escape(struct str text, bool quoted, struct buffer *out)
{
    for (size_t i = 0; i < text.n; i++) {
        char c = text.at[i];
        if (c == '<')
            buffer_puts(out, "&lt;");
        else if (c == '&')
            buffer_puts(out, "&amp;");
        else if (c == '>')
            buffer_puts(out, "&gt;");
        else if (c == '"' && quoted)
            buffer_puts(out, "&quot;");
        else if (c == '\n' || c == '\r' || c == '\t' || (c == '*' && quoted)) /* ends a note */
            buffer_printf(out, "&#%d;", c);
        else
            buffer_add(out, &c, 1);
    }
}

void native_escape(struct str text, struct buffer *out)
{
    for (size_t i = 0; i < text.n; i++) {
        char c = text.at[i];
        if (c == '"' || c == '\\')
            buffer_printf(out, "\\%c", c);
        else if (c == '\n' || c == '\t')
            buffer_printf(out, "\\%c", c == '\n' ? 'n' : 't');
        else if ((unsigned char)c < 32)
            buffer_printf(out, "\\u{%X}", (unsigned)(unsigned char)c);
        else
            buffer_add(out, &c, 1);
    }
}
