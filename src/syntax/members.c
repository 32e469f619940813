/* Members that are one token.
 *
 * A large scene is made of members with plain values, numbers and vectors of numbers, and of those
 * that open a block.  Token by token they would take most of the time and memory of reading, so
 * the scanner asks here and takes them whole, a plain value as its text.  Whatever might be more,
 * or wrong, is read token by token. */
#include "config.h"

#include "syntax/parser.h"

#include "grammar/scene.tab.h"

#include <string.h>

/* Numbers so short, with exponents of two digits, are finite. */
enum { PLAIN_LIMIT = 200 };

/* Behind a brace, behind another member, and behind separators after these. */
bool parser_member_follows(const struct parser *p, int token)
{
    bool separator = token == TOKEN_COMMA || token == TOKEN_SEMICOLON;
    bool behind = token == TOKEN_LBRACE || token == TOKEN_RBRACE || token == TOKEN_MEMBER ||
                  token == TOKEN_OPENING || (separator && p->member_due);
    return behind && parser_bracket(p) == '{';
}

/* ---- scanning; the text ends with NUL ---- */

static bool is_letter(char c)
{
    return (c | 32) >= 'a' && (c | 32) <= 'z';
}

static const char *skip_blanks(const char *at)
{
    while (*at == ' ' || *at == '\t' || *at == '\r' || *at == '\n')
        at++;
    return at;
}

static const char *skip_digits(const char *at)
{
    while (*at >= '0' && *at <= '9')
        at++;
    return at;
}

/* Behind `e-05`, or at the letter when that is none. */
static const char *skip_exponent(const char *letter)
{
    const char *digits = letter + 1 + (letter[1] == '-' || letter[1] == '+');
    const char *end = skip_digits(digits);
    return end > digits && end <= digits + 2 ? end : letter;
}

/* Behind the number; NULL: there is none. */
static const char *skip_number(const char *at)
{
    const char *digits = *at == '-' ? at + 1 : at, *end = skip_digits(digits);
    ptrdiff_t n = end - digits;
    if (*end == '.') {
        const char *point = end;
        end = skip_digits(point + 1);
        n += end - point - 1;
    }
    return n == 0 ? NULL : (*end | 32) == 'e' ? skip_exponent(end) : end;
}

/* Behind `(1, 2)` or `(1, 2, 3)`; NULL: there is none. */
static const char *skip_vector(const char *at)
{
    int n = 0;
    do {
        at = skip_number(skip_blanks(at + 1));
        at = at ? skip_blanks(at) : NULL;
        n++;
    } while (at && *at == ',');
    return at && *at == ')' && (n == 2 || n == 3) ? at + 1 : NULL;
}

/* A word that may begin the next member or statement; units that stand apart are none. */
static bool begins_statement(const char *word)
{
    static const char *const others[] = {"in", "else", "true", "false", "wrt", "deg", "rad"};
    if (!is_letter(*word) && *word != '_')
        return false;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        size_t n = *word == *others[i] ? strlen(others[i]) : 0;
        if (n && strncmp(word, others[i], n) == 0 && !is_letter(word[n]))
            return false;
    }
    return true;
}

/* True when what stands here is no part of a value that ends at `end`. */
static bool begins_else(const char *here, const char *end)
{
    return *here == '}' || *here == ',' || *here == ';' || (here > end && begins_statement(here));
}

size_t parser_plain_member(struct parser *p, struct span *span, struct str *text)
{
    const char *source = p->source->text - p->source->base, *begin = source + span->begin;
    const char *value = source + span->end - 1;
    const char *end = *value == '(' ? skip_vector(value) : skip_number(value);
    const char *next = end ? skip_blanks(end) : NULL;
    if (!end || end - value >= PLAIN_LIMIT || !begins_else(next, end))
        return 0;
    *text = (struct str){begin, (size_t)(end - begin)};
    span->end = span->begin + (uint32_t)text->n;
    p->at = span->begin + (uint32_t)(next - begin);
    return (size_t)(next - begin);
}

/* ---- nodes ---- */

/* `name: ` and what is behind it, which *rest becomes. */
static struct ast_node *member_node(struct parser *p, struct span span, struct str *rest)
{
    struct str text = *rest;
    size_t name = 0, value;
    while (text.at[name] > ' ' && text.at[name] != ':')
        name++;
    for (value = name; text.at[value] <= ' ' || text.at[value] == ':';)
        value++;
    *rest = (struct str){text.at + value, text.n - value};
    struct span name_span = {span.begin, span.begin + (uint32_t)name};
    return ast_named(p->ast, AST_PROPERTY, span, (struct str){text.at, name}, name_span);
}

struct ast_node *parser_member(struct parser *p, struct span span, struct str text)
{
    struct ast_node *n = member_node(p, span, &text);
    n->text = text;
    return n;
}

struct ast_node *parser_construct(struct parser *p, struct span span, struct str text,
                                  struct ast_list members)
{
    const char *begin = text.at;
    struct ast_node *n = member_node(p, span, &text);
    struct span value = {span.begin + (uint32_t)(text.at - begin), span.end};
    struct str kind = str_trim((struct str){text.at, text.n - 1});
    struct span kind_span = {value.begin, value.begin + (uint32_t)kind.n};
    return ast_with(n,
                    ast_holding(ast_named(p->ast, AST_CONSTRUCT, value, kind, kind_span), members));
}
