/* Where reading goes on behind a syntax error: at the next member or statement, as the lines and
 * brackets tell.  What stands before it is lost.  A block whose beginning is lost is read for its
 * own mistakes. */
#include "config.h"

#include "syntax/parser.h"

#include "grammar/scene.tab.h"

#include <string.h>

/* What the text holds behind the token under way, blanks skipped. */
static const char *text_behind(const struct parser *p, struct span span)
{
    native_release(p->scanner);
    const char *at = p->source->text + (span.end - p->source->base);
    return at + strspn(at, " \t\r\n");
}

static bool begins_line(const struct parser *p, struct span span)
{
    const char *begin = p->source->text, *at = begin + (span.begin - p->source->base);
    while (at > begin && (at[-1] == ' ' || at[-1] == '\t'))
        at--;
    return at == begin || at[-1] == '\n';
}

static bool in_block(const struct parser *p)
{
    for (unsigned i = 0; i < p->depth; i++)
        if (p->source->text[p->brackets[i].begin - p->source->base] == '{')
            return true;
    return false;
}

static bool is_letter(char c)
{
    return (c | 32) >= 'a' && (c | 32) <= 'z';
}

/* `light: point {` at the very left. */
static bool is_header(const struct parser *p, struct span span, const char *next)
{
    uint32_t at = span.begin - p->source->base;
    return (at == 0 || p->source->text[at - 1] == '\n') && next[strcspn(next, "{\n")] == '{';
}

/* A name goes on as a member of a block; or it begins a line, and nothing that is still open may
 * hold it. */
static bool name_resumes(const struct parser *p, struct span span, bool inside)
{
    const char *next = text_behind(p, span);
    if (*next == ':')
        return in_block(p) || is_header(p, span, next);
    return begins_line(p, span) && (!inside || *next == '{' || is_letter(*next));
}

static bool resumes(const struct parser *p, int token, struct span span)
{
    bool inside = parser_bracket(p) == '(' || parser_bracket(p) == '[';
    switch (token) {
    case TOKEN_END:
    case TOKEN_LBRACE:
    case TOKEN_ORPHAN:
    case TOKEN_MEMBER:
    case TOKEN_OPENING:
        return true;
    case TOKEN_RBRACE:
        return p->unmatched != span.begin;
    case TOKEN_SEMICOLON:
        return !inside;
    case TOKEN_COLOUR: /* `#define` */
    case TOKEN_STRING: /* `"sphere": {` */
        return p->depth == 0 && begins_line(p, span);
    case TOKEN_NAME:
        return name_resumes(p, span, inside);
    case TOKEN_MATERIAL:
    case TOKEN_TEXTURE:
        return *text_behind(p, span) == ':' ? in_block(p) : !inside || begins_line(p, span);
    case TOKEN_FOR:
    case TOKEN_IF:
        return !inside && begins_line(p, span);
    case TOKEN_MODEL:
    case TOKEN_INCLUDE:
    case TOKEN_PARAM:
    case TOKEN_LET:
    case TOKEN_FN:
    case TOKEN_DEFINE:
    case TOKEN_DEFAULT:
    case TOKEN_ASSERT:
        return !inside || begins_line(p, span);
    default:
        return false;
    }
}

/* Brackets left open in the lost text are of no block; *own is that of the token, if it is one. */
static void forget_brackets(struct parser *p, bool own)
{
    unsigned kept = p->depth - own;
    struct span last = p->brackets[own ? kept : 0];
    while (kept && p->source->text[p->brackets[kept - 1].begin - p->source->base] != '{')
        kept--;
    if (own)
        p->brackets[kept++] = last;
    p->depth = kept;
}

bool parser_resume(struct parser *p, struct span *lost)
{
    SCENE_STYPE value;
    struct span span;
    int token;
    for (;;) {
        token = scene_lex(&value, &span, p);
        if (resumes(p, token, span))
            break;
        lost->end = span.end > lost->end ? span.end : lost->end;
    }
    bool brace = token == TOKEN_LBRACE;
    forget_brackets(p, brace || token == TOKEN_OPENING);
    parser_hold(p, brace ? TOKEN_ORPHAN : token, value.text, span);
    bool onwards = token != TOKEN_END && span.begin > p->resumed;
    p->resumed = span.begin;
    p->since = 0;
    p->unsure = brace || token == TOKEN_RBRACE;
    return onwards;
}
