/* Mistakes in the text, in user words. */
#include "config.h"

#include "syntax/parser.h"

#include "grammar/scene.tab.h"

#include <stdio.h>
#include <string.h>

/* "a", "a or b", "a, b or c" */
static void list_words(char *out, size_t room, const char *const *words, size_t n)
{
    size_t at = 0;
    out[0] = 0;
    for (size_t i = 0; i < n && at < room; i++) {
        const char *joint = i == 0 ? "" : i + 1 == n ? " or " : ", ";
        int put = snprintf(out + at, room - at, "%s%s", joint, words[i]);
        at += put > 0 ? (size_t)put : 0;
    }
}

bool parser_on_later_line(const struct parser *p, struct span found)
{
    struct str gap = srcmap_text(p->diag->sources, (struct span){p->previous.end, found.begin});
    return p->previous.end > p->source->base && gap.n && memchr(gap.at, '\n', gap.n);
}

/* Where the missing thing belongs: after the previous token, when what was found instead stands
 * on a later line. */
static struct span place_of_error(const struct parser *p, struct span found)
{
    return parser_on_later_line(p, found) ? (struct span){p->previous.end, p->previous.end} : found;
}

/* What may follow any value: expected in so many places that naming it helps nobody. */
static bool continues_value(const char *token)
{
    static const char *const tokens[] = {
        "'?'",  "'||'", "'&&'", "'=='", "'!='", "'<'", "'<='", "'>' of a comparison",
        "'>='", "'+'",  "'-'",  "'*'",  "'/'",  "'%'", "'^'",  "'.'",
        "'['",  "'('"};
    for (size_t i = 0; i < sizeof tokens / sizeof *tokens; i++)
        if (strcmp(token, tokens[i]) == 0)
            return true;
    return false;
}

/* Many things are expected in few places: where a value may begin, or a statement or member. */
static size_t summarise(const char *const *expected, size_t n, const char **out)
{
    enum { MOST = 6 };
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        if (strcmp(expected[i], "string") == 0 && n > MOST) {
            out[0] = "value";
            return 1;
        }
        if (n <= MOST || !continues_value(expected[i]))
            out[kept++] = expected[i];
    }
    return kept <= MOST ? kept : 0;
}

/* A value follows the name of a member at once. */
static bool lacks_colon(const struct parser *p, struct span span, const char *const *expected,
                        size_t n)
{
    struct str found = srcmap_text(p->diag->sources, span);
    bool value = found.n && (strchr("#\"", *found.at) || (*found.at >= '0' && *found.at <= '9'));
    for (size_t i = 0; i < n && value; i++)
        if (strcmp(expected[i], "':'") == 0)
            return strcmp(expected[0], "name") == 0;
    return false;
}

static size_t only_colon(const char **out)
{
    out[0] = "':'";
    return 1;
}

/* The text ends inside brackets. */
static void report_unclosed(struct parser *p)
{
    struct span opening = p->brackets[p->depth - 1];
    char c = *srcmap_text(p->diag->sources, opening).at;
    diag_report(p->diag, DIAG_SYNTAX, opening, "this is not closed; '%c' is missing",
                c == '{'   ? '}'
                : c == '(' ? ')'
                           : ']');
    p->astray = opening.begin;
}

/* Bytes of blanks before the first word of the line. */
static size_t indentation(const struct parser *p, uint32_t offset)
{
    struct str line = srcmap_locate(p->diag->sources, offset).line_text;
    size_t n = 0;
    while (n < line.n && (line.at[n] == ' ' || line.at[n] == '\t'))
        n++;
    return n;
}

/* Whether this token only follows from the last error: it is left over from the same line, or
 * closes what could not be opened there. */
static bool is_left_over(const struct parser *p, struct span span, bool vague)
{
    enum { FEW = 3 }; /* tokens that a line needs to be understood again */
    if (!p->astray || p->ast->xml)
        return false;
    struct str between = srcmap_text(p->diag->sources, (struct span){p->astray, span.begin});
    if (!between.n || !memchr(between.at, '\n', between.n))
        return vague || p->unsure || p->since <= FEW;
    return vague && str_is(srcmap_text(p->diag->sources, span), "}") &&
           indentation(p, span.begin) == indentation(p, p->astray);
}

void parser_syntax_error(struct parser *p, struct span span, const char *found, bool at_end,
                         const char *const *expected, size_t n)
{
    if (p->stopped || p->feigned)
        return;
    if (p->trail.last == TOKEN_BAD_VALUE && !p->ast->xml) {
        p->astray = span.begin;
        return; /* the token was reported already */
    }
    if (!p->ast->xml)
        native_release(p->scanner); /* the text is read here */
    const char *shown[EXPECTED_MOST];
    char words[256], what[80];
    n = lacks_colon(p, span, expected, n) ? only_colon(shown) : summarise(expected, n, shown);
    if (is_left_over(p, span, !n))
        return;
    bool value = n == 1 && strcmp(shown[0], "value") == 0;
    if (at_end && p->depth > 0 && !p->ast->xml && !value) {
        report_unclosed(p);
        return;
    }
    list_words(words, sizeof words, shown, n);
    struct str text = srcmap_text(p->diag->sources, span);
    bool quote = !at_end && text.n && text.n < 40 && !memchr(text.at, '\n', text.n);
    if (quote)
        snprintf(what, sizeof what, "'%.*s'", STR_ARG(text));
    else
        snprintf(what, sizeof what, "the %s", found);
    bool something_else = n && strcmp(shown[0], "end of file") != 0;
    struct span place = something_else || at_end ? place_of_error(p, span) : span;
    p->astray = place.begin;
    struct diag_entry *e =
        n ? diag_report(p->diag, DIAG_SYNTAX, place, "expected %s, but found %s", words, what)
        : at_end ? diag_report(p->diag, DIAG_SYNTAX, place, "the text ends too early")
                 : diag_report(p->diag, DIAG_SYNTAX, place, "%s cannot stand here", what);
    parser_advise(p, e, span, shown, n);
}

void parser_unterminated(struct parser *p, uint32_t mark, const char *message)
{
    struct span opening = {p->comment_begin, p->comment_begin + mark};
    diag_report(p->diag, DIAG_UNTERMINATED, opening, "%s", message);
}

/* `&` and `|` are operators only when doubled. */
static void add_double(struct diag_entry *e, struct span span, struct str text)
{
    if (text.n == 1 && (*text.at == '&' || *text.at == '|'))
        diag_did_you_mean(e, span, *text.at == '&' ? str_of("&&") : str_of("||"));
}

void parser_stray(struct parser *p, struct span span, struct str text)
{
    p->astray = span.begin;
    p->since = 0;
    if (text.n == 1 && ((unsigned char)text.at[0] < 32 || text.at[0] == 127))
        diag_report(p->diag, DIAG_SYNTAX, span, "a control character (U+%04X) cannot stand here",
                    (unsigned)(unsigned char)text.at[0]);
    else
        add_double(
            diag_report(p->diag, DIAG_SYNTAX, span, "'%.*s' cannot stand here", STR_ARG(text)),
            span, text);
}

void xml_unclosed_tag(struct parser *p, uint32_t end)
{
    if (!p->stopped) {
        struct span place = {end, end};
        struct diag_entry *e =
            diag_report(p->diag, DIAG_SYNTAX, place, "expected '>' to end the tag");
        diag_fix(e, place, DIAG_FIX_MAYBE, ">");
    }
    xml_lose_tag(p);
    p->feigned = true;
}

void xml_damaged_tag(struct parser *p, uint32_t end)
{
    if (p->open.n && p->astray > p->open.at[p->open.n - 1].span.begin) {
        xml_lose_tag(p);
        p->feigned = true;
    } else {
        xml_unclosed_tag(p, end);
    }
}

void xml_backward_tag(struct parser *p, struct span span)
{
    struct diag_entry *e =
        diag_report(p->diag, DIAG_SYNTAX, span, "a closing tag begins with '</'");
    diag_fix(e, (struct span){span.begin, span.begin + 2}, DIAG_FIX_MAYBE, "</");
}

void xml_nameless_tag(struct parser *p, struct span span)
{
    diag_report(p->diag, DIAG_SYNTAX, span, "expected a name behind '</'");
    xml_lose_tag(p);
    p->feigned = true;
}

void xml_declaration(struct parser *p, struct span span)
{
    static const char doctype[] = "<!DOCTYPE";
    if (str_begins(srcmap_text(p->diag->sources, span), doctype)) {
        span.end = span.begin + sizeof doctype - 1;
        parser_stop(p, DIAG_XML_DTD, span,
                    "a document type declaration is never read, so the scene is refused");
        return;
    }
    struct str text = srcmap_text(p->diag->sources, span);
    size_t n = 2;
    while (n < text.n && (text.at[n] | 32) >= 'a' && (text.at[n] | 32) <= 'z')
        n++;
    span.end = span.begin + (uint32_t)n;
    xml_lose_tag(p);
    struct diag_entry *e =
        diag_report(p->diag, DIAG_SYNTAX, span, "a declaration cannot stand here");
    if (n == 2)
        diag_note(e, "comments stand between '<!--' and '-->'");
}

void xml_stray_less(struct parser *p, struct span span)
{
    struct diag_entry *e = diag_report(p->diag, DIAG_SYNTAX, span, "'<' begins no tag here");
    xml_lose_tag(p);
    diag_fix(e, span, DIAG_FIX_MAYBE, "&lt;");
}

void xml_stray_ampersand(struct parser *p, struct span span)
{
    struct diag_entry *e =
        diag_report(p->diag, DIAG_XML_ENTITY, span, "'&' begins no reference here");
    diag_fix(e, span, DIAG_FIX_SAFE, "&amp;");
}
