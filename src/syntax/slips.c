/* Usual slips of those who come from other languages, told and mended between the scanner and the
 * grammar, so that nothing else goes wrong behind them. */
#include "config.h"

#include "syntax/parser.h"

#include "grammar/scene.tab.h"

#include <string.h>

/* The sign that was meant instead of the one written. */
static int mend_sign(struct parser *p, struct span span, int meant, const char *sign,
                     const char *what)
{
    struct diag_entry *e =
        diag_report(p->diag, DIAG_SYNTAX, span, "expected '%s', but found '%.*s'", sign,
                    STR_ARG(srcmap_text(p->diag->sources, span)));
    diag_note(e, "%s", what);
    diag_fix(e, span, DIAG_FIX_SAFE, "%s", sign);
    return meant;
}

static bool names_property(int token)
{
    return token == TOKEN_NAME || token == TOKEN_MATERIAL || token == TOKEN_TEXTURE;
}

static bool defines(int token)
{
    return token == TOKEN_LET || token == TOKEN_PARAM || token == TOKEN_MATERIAL ||
           token == TOKEN_TEXTURE;
}

/* The text is a name, and a colon follows it. */
static bool is_quoted_property(const struct parser *p, struct str text)
{
    native_release(p->scanner);
    const char *at = p->source->text + (p->at - p->source->base);
    for (size_t i = 0; i < text.n; i++) {
        char c = text.at[i];
        bool letter = (c | 32) >= 'a' && (c | 32) <= 'z';
        if (!letter && c != '_' && (i == 0 || c < '0' || c > '9'))
            return false;
    }
    at += strspn(at, " \t\r\n");
    return text.n > 0 && *at == ':';
}

/* Behind these a text in quotes may be a value with a colon behind it. */
static bool needs_value(int token)
{
    return token == TOKEN_QUESTION || token == TOKEN_PLUS || token == TOKEN_EQUAL ||
           token == TOKEN_NOT_EQUAL || token == TOKEN_COLON;
}

static int mend_quotes(struct parser *p, struct span span, struct str name)
{
    struct diag_entry *e =
        diag_report(p->diag, DIAG_SYNTAX, span, "names of properties stand without quotes");
    diag_fix(e, span, DIAG_FIX_SAFE, "%.*s", STR_ARG(name));
    p->astray = span.begin;
    p->since = 0;
    return TOKEN_NAME;
}

int parser_mend_slip(struct parser *p, int token, struct span span, struct str text)
{
    const struct trail *t = &p->trail;
    if (token == TOKEN_EQUALS && names_property(t->last) && !defines(t->before) &&
        parser_bracket(p) == '{')
        return mend_sign(p, span, TOKEN_COLON, ":", "a property is written 'name: value'");
    if (token == TOKEN_COLON && t->last == TOKEN_NAME && defines(t->before))
        return mend_sign(p, span, TOKEN_EQUALS, "=", "a definition is written 'let name = value'");
    if (token == TOKEN_STRING && parser_bracket(p) == '{' && !needs_value(t->last) &&
        is_quoted_property(p, text))
        return mend_quotes(p, span, text);
    return token;
}

void parser_trail(struct parser *p, int token)
{
    p->trail = (struct trail){.before = p->trail.last, .last = token};
}

int parser_walrus(struct parser *p, struct span span)
{
    if (defines(p->trail.before))
        return mend_sign(p, span, TOKEN_EQUALS, "=", "a definition is written 'let name = value'");
    return mend_sign(p, span, TOKEN_COLON, ":", "a property is written 'name: value'");
}

size_t parser_endless_string(const char *at, size_t n)
{
    const char *brace = memchr(at, '}', n);
    n = brace ? (size_t)(brace - at) : n;
    while (n > 1 && strchr(" \t\r)],;", at[n - 1]))
        n--;
    return n;
}

static const char *skip_gap(const char *at)
{
    for (;;) {
        at += strspn(at, " \t\r\n");
        bool block = at[0] == '/' && at[1] == '*';
        if (!block && !(at[0] == '/' && at[1] == '/'))
            return at;
        const char *end = strstr(at + 2, block ? "*/" : "\n");
        if (!end)
            return at;
        at = end + (block ? 2 : 1);
    }
}

static const char *skip_name(const char *at)
{
    while (((*at | 32) >= 'a' && (*at | 32) <= 'z') || (*at >= '0' && *at <= '9') || *at == '_')
        at++;
    return at;
}

/* The word before begins a definition, a property, an object or a use. */
static bool is_name_of_something(const char *behind)
{
    const char *next = skip_gap(behind), *end = skip_name(next);
    if (next == behind && end != next)
        return true; /* it goes on */
    if (end == next)
        return *next && strchr("({:=", *next);
    for (int words = 1; end != next && words < 4; words++) {
        next = skip_gap(end);
        end = skip_name(next);
    }
    return *next == '{';
}

int parser_far_unit(struct parser *p, struct span span, struct str number)
{
    native_release(p->scanner);
    if (is_name_of_something(p->source->text + (p->at - p->source->base)))
        return 0;
    struct str unit = {number.at + number.n, 3};
    struct diag_entry *e =
        diag_report(p->diag, DIAG_SYNTAX, span, "a unit stands right behind its number");
    number = str_trim(number);
    diag_fix(e, span, DIAG_FIX_SAFE, "%.*s%.*s", STR_ARG(number), STR_ARG(unit));
    return str_is(unit, "deg") ? TOKEN_DEGREES : TOKEN_RADIANS;
}

void parser_single_quotes(struct parser *p, struct span span, struct str text)
{
    struct diag_entry *e = diag_report(p->diag, DIAG_SYNTAX, span, "strings have double quotes");
    diag_fix(e, span, DIAG_FIX_SAFE, "\"%.*s\"", STR_ARG(text));
}

void parser_degree_sign(struct parser *p, struct span span)
{
    struct diag_entry *e = diag_report(p->diag, DIAG_SYNTAX, span, "degrees are written 'deg'");
    diag_fix(e, span, DIAG_FIX_SAFE, "deg");
}

void parser_bad_number(struct parser *p, struct span span, struct str text)
{
    if (defines(p->trail.last) || p->trail.last == TOKEN_FN || p->trail.last == TOKEN_DEFINE) {
        diag_report(p->diag, DIAG_SYNTAX, span,
                    "'%.*s' cannot be a name: names begin with a letter", STR_ARG(text));
        return;
    }
    struct diag_entry *e = diag_report(p->diag, DIAG_NUMBER_SYNTAX, span,
                                       "'%.*s' is not a number with a unit", STR_ARG(text));
    size_t digits = 0;
    while (digits < text.n && text.at[digits] >= '0' && text.at[digits] <= '9')
        digits++;
    bool hexadecimal = digits == 1 && *text.at == '0';
    const char *x =
        digits < text.n && text.at[digits] == 'x' && !hexadecimal ? text.at + digits : NULL;
    if (x && digits > 0 && x + 1 < text.at + text.n && x[1] >= '0' && x[1] <= '9') {
        diag_note(e, "a size is written (width, height)");
        diag_fix(e, span, DIAG_FIX_MAYBE, "(%.*s, %.*s)", (int)digits, text.at,
                 (int)(text.at + text.n - x - 1), x + 1);
    } else if (hexadecimal) {
        diag_note(e, "numbers are decimal; a colour is '#' and six hexadecimal digits");
    } else {
        diag_note(e, "the units are 'deg' and 'rad', for angles; lengths have none");
    }
}
