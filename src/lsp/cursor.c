#include "config.h"

#include "lsp/cursor.h"

enum token { TOKEN_BEGIN, TOKEN_WORD, TOKEN_LITERAL, TOKEN_MARK };

/* The last tokens, the newest first. */
enum { REMEMBERED = 4 };

struct scan {
    struct cursor *out;
    const char *at, *end;
    struct {
        enum token kind;
        struct str text;
    } last[REMEMBERED];
    unsigned body_due; /* brackets + 1 where the next brace opens the body of for, if, define */
    bool inside;       /* the place lies in a comment or string */
};

static bool is_word_byte(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

static struct cursor_block *innermost(const struct scan *s)
{
    return &s->out->blocks.at[s->out->blocks.n - 1];
}

static void remember(struct scan *s, enum token kind, struct str text)
{
    memmove(&s->last[1], &s->last[0], (REMEMBERED - 1) * sizeof *s->last);
    s->last[0].kind = kind;
    s->last[0].text = text;
}

static bool is_word(const struct scan *s, int i, const char *word)
{
    return s->last[i].kind == TOKEN_WORD && str_is(s->last[i].text, word);
}

static bool is_mark(const struct scan *s, int i, char mark)
{
    return s->last[i].kind == TOKEN_MARK && *s->last[i].text.at == mark;
}

/* ---- tokens ---------------------------------------------------------------------------------- */

/* Passes what runs to `close`, or to the end; the place is inside when that is not reached. */
static void pass_to(struct scan *s, const char *close, size_t skip)
{
    size_t n = strlen(close), left = (size_t)(s->end - s->at);
    const char *found = left > skip ? memmem(s->at + skip, left - skip, close, n) : NULL;
    s->inside = !found;
    s->at = found ? found + n : s->end;
}

static void pass_string(struct scan *s)
{
    const char *p = s->at + 1;
    while (p < s->end && *p != '"' && *p != '\n')
        p += *p == '\\' && p + 1 < s->end ? 2 : 1;
    s->inside = p >= s->end;
    remember(s, TOKEN_LITERAL, (struct str){s->at, 0});
    s->at = p < s->end ? p + 1 : s->end;
}

static void take_word(struct scan *s)
{
    const char *p = s->at;
    bool number = (*p >= '0' && *p <= '9') || *p == '.';
    while (p < s->end && (is_word_byte(*p) || (number && *p == '.')))
        p++;
    struct str text = {s->at, (size_t)(p - s->at)};
    s->at = p;
    if (p == s->end)
        return; /* it is being written */
    remember(s, number ? TOKEN_LITERAL : TOKEN_WORD, text);
    if (str_is(text, "for") || str_is(text, "if") || str_is(text, "define") || str_is(text, "else"))
        s->body_due = innermost(s)->brackets + 1;
}

/* ---- blocks ---------------------------------------------------------------------------------- */

/* The words before an opening brace; `material gold = metal {` has one, `light point lamp {` two.
 */
static struct cursor_block block_of_words(const struct scan *s)
{
    struct cursor_block b = {.given = s->out->given.n};
    if (s->body_due == innermost(s)->brackets + 1)
        return b;
    b.is_use = is_mark(s, 0, ')');
    if (s->last[0].kind != TOKEN_WORD)
        return b;
    b.first = s->last[0].text;
    if (is_word(s, 1, "light") || is_word(s, 2, "light")) {
        b.second = s->last[is_word(s, 1, "light") ? 0 : 1].text;
        b.first = str_of("light");
    } else if (s->last[1].kind == TOKEN_WORD && !is_word(s, 1, "default")) {
        b.second = b.first;
        b.first = s->last[1].text;
    }
    return b;
}

static void open_block(struct scan *s)
{
    struct cursor_block b = block_of_words(s);
    s->body_due = 0;
    vec_push(&s->out->blocks, b);
}

static void close_block(struct scan *s)
{
    if (s->out->blocks.n == 1)
        return;
    s->out->given.n = innermost(s)->given;
    s->out->blocks.n--;
}

static void take_mark(struct scan *s)
{
    struct cursor_block *b = innermost(s);
    switch (*s->at) {
    case '{':
        open_block(s);
        break;
    case '}':
        close_block(s);
        break;
    case '(':
    case '[':
        b->brackets++;
        break;
    case ')':
    case ']':
        b->brackets -= b->brackets > 0;
        break;
    case ':':
        if (s->last[0].kind == TOKEN_WORD && !b->brackets) {
            b->property = s->last[0].text;
            vec_push(&s->out->given, b->property);
        }
        break;
    default:
        break;
    }
    remember(s, TOKEN_MARK, (struct str){s->at++, 1});
}

static void scan_token(struct scan *s)
{
    size_t left = (size_t)(s->end - s->at);
    if (left >= 2 && memcmp(s->at, "//", 2) == 0)
        pass_to(s, "\n", 2);
    else if (left >= 2 && memcmp(s->at, "/*", 2) == 0)
        pass_to(s, "*/", 2);
    else if (*s->at == '"')
        pass_string(s);
    else if (is_word_byte(*s->at) || *s->at == '.')
        take_word(s);
    else if (memchr(" \t\r\n", *s->at, 4))
        s->at++;
    else
        take_mark(s);
}

/* ---- the place ------------------------------------------------------------------------------- */

static enum cursor_place place_of(const struct scan *s)
{
    static const char continuing[] = ":=+-*/%^?<>!&|";
    const struct cursor_block *b = innermost(s);
    if (s->inside)
        return CURSOR_NOWHERE;
    if (is_word(s, 0, "light"))
        return CURSOR_LIGHT;
    if (is_word(s, 0, "model"))
        return CURSOR_MODEL;
    if (is_word(s, 0, "default"))
        return CURSOR_DEFAULT;
    if (b->brackets || is_word(s, 0, "in") || is_word(s, 0, "if") || is_word(s, 0, "assert"))
        return CURSOR_VALUE;
    if (s->last[0].kind == TOKEN_MARK && strchr(continuing, *s->last[0].text.at))
        return CURSOR_VALUE;
    return CURSOR_STATEMENT;
}

void cursor_find(struct cursor *c, struct str text, uint32_t at)
{
    struct scan s = {.out = c, .at = text.at, .end = text.at + at};
    *c = (struct cursor){0};
    vec_push(&c->blocks, (struct cursor_block){0});
    while (s.at < s.end)
        scan_token(&s);
    c->place = place_of(&s);
}

void cursor_free(struct cursor *c)
{
    vec_free(&c->blocks);
    vec_free(&c->given);
}
