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

static bool on_later_line(const struct parser *p, struct span found)
{
    struct str gap = srcmap_text(p->diag->sources, (struct span){p->previous.end, found.begin});
    return p->previous.end > p->source->base && gap.n && memchr(gap.at, '\n', gap.n);
}

/* Where the missing thing belongs: after the previous token, when what was found instead stands
 * on a later line. */
static struct span place_of_error(const struct parser *p, struct span found)
{
    return on_later_line(p, found) ? (struct span){p->previous.end, p->previous.end} : found;
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

static bool is_keyword(struct str word)
{
    static const char *const words[] = {"wrt",     "model",  "include", "param",    "let",    "fn",
                                        "default", "define", "assert",  "for",      "in",     "if",
                                        "else",    "true",   "false",   "material", "texture"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (str_is(word, words[i]))
            return true;
    return false;
}

/* A value or a name, as far as its first character tells. */
static bool begins_item(struct str found)
{
    return found.n &&
           (strchr("([\"#_", found.at[0]) || (found.at[0] >= '0' && found.at[0] <= '9') ||
            ((found.at[0] | 32) >= 'a' && (found.at[0] | 32) <= 'z'));
}

/* A vector in the manner of POV-Ray, if it ends on its line. */
static void add_angle_brackets(const struct parser *p, struct diag_entry *e, struct span span)
{
    native_release(p->scanner);
    const char *text = p->source->text + (span.begin - p->source->base);
    size_t end = strcspn(text + 1, "<>\n") + 1;
    diag_note(e, "vectors are written (x, y, z)");
    if (text[end] != '>')
        return;
    struct span closing = {span.begin + (uint32_t)end, span.begin + (uint32_t)end + 1};
    diag_fix(e, span, DIAG_FIX_MAYBE, "(");
    diag_fix(e, closing, DIAG_FIX_MAYBE, ")");
}

/* How to write what was probably meant. */
static void add_advice(const struct parser *p, struct diag_entry *e, struct span span,
                       const char *const *expected, size_t n)
{
    struct str found = srcmap_text(p->diag->sources, span);
    bool colon = false, name = false, comma = false;
    for (size_t i = 0; i < n; i++) {
        colon |= strcmp(expected[i], "':'") == 0;
        name |= strcmp(expected[i], "name") == 0;
        comma |= strcmp(expected[i], "','") == 0;
    }
    if (colon && str_is(found, "="))
        diag_note(e, "a property is written 'name: value'");
    else if (str_is(found, "<") && n == 1 && strcmp(expected[0], "value") == 0)
        add_angle_brackets(p, e, span);
    else if (comma && begins_item(found) && !on_later_line(p, span))
        diag_note(e, "commas stand between the items of lists, vectors and calls");
    else if (name && is_keyword(found))
        diag_note(e, "'%.*s' is a word of the language, so it cannot be a name", STR_ARG(found));
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
        return vague || p->since <= FEW;
    return str_is(srcmap_text(p->diag->sources, span), "}") &&
           indentation(p, span.begin) == indentation(p, p->astray);
}

void parser_syntax_error(struct parser *p, struct span span, const char *found, bool at_end,
                         const char *const *expected, size_t n)
{
    if (p->stopped || p->feigned)
        return;
    const char *shown[EXPECTED_MOST];
    char words[256], what[80];
    n = summarise(expected, n, shown);
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
    p->astray = span.begin;
    bool something_else = n && strcmp(shown[0], "end of file") != 0;
    struct span place = something_else || at_end ? place_of_error(p, span) : span;
    struct diag_entry *e =
        n ? diag_report(p->diag, DIAG_SYNTAX, place, "expected %s, but found %s", words, what)
        : at_end ? diag_report(p->diag, DIAG_SYNTAX, place, "the text ends too early")
                 : diag_report(p->diag, DIAG_SYNTAX, place, "%s cannot stand here", what);
    add_advice(p, e, span, shown, n);
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

void xml_nameless_tag(struct parser *p, struct span span)
{
    diag_report(p->diag, DIAG_SYNTAX, span, "expected a name behind '</'");
    xml_lose_tag(p);
    p->feigned = true;
}

void xml_declaration(struct parser *p, struct span span)
{
    struct str text = srcmap_text(p->diag->sources, span);
    if (str_is(text, "<!DOCTYPE"))
        parser_stop(p, DIAG_XML_DTD, span,
                    "a document type declaration is never read, so the scene is refused");
    else
        parser_stop(p, DIAG_SYNTAX, span, "a declaration cannot stand here");
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
