#include "config.h"

#include "lsp/cursor_xml.h"

struct scan {
    struct tag_cursor *out;
    const char *at, *end;
};

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static bool is_mark(char c)
{
    return c == '<' || c == '>' || c == '/' || c == '=' || c == '"' || c == '\'';
}

static bool starts(const struct scan *s, const char *with)
{
    size_t n = strlen(with);
    return (size_t)(s->end - s->at) >= n && memcmp(s->at, with, n) == 0;
}

static void pass_blanks(struct scan *s)
{
    while (s->at < s->end && is_blank(*s->at))
        s->at++;
}

/* A name runs to what cannot be in one. */
static struct str take_name(struct scan *s)
{
    const char *begin = s->at;
    while (s->at < s->end && !is_blank(*s->at) && !is_mark(*s->at))
        s->at++;
    return (struct str){begin, (size_t)(s->at - begin)};
}

/* Passes what runs to `close`; false when the place lies in it. */
static bool pass_to(struct scan *s, const char *close)
{
    size_t n = strlen(close);
    const char *found = memmem(s->at, (size_t)(s->end - s->at), close, n);
    s->at = found ? found + n : s->end;
    return found != NULL;
}

static void close_element(struct tag_cursor *c)
{
    if (c->open.n == 0)
        return;
    c->given.n = c->open.at[c->open.n - 1].given;
    c->open.n--;
}

/* A closing tag ends the innermost element of its name, and what is open in it. */
static void close_named(struct tag_cursor *c, struct str name)
{
    for (size_t i = c->open.n; i-- > 0;) {
        if (!str_equal(c->open.at[i].name, name))
            continue;
        while (c->open.n > i)
            close_element(c);
        return;
    }
}

/* The value behind `name=`; false when the place lies in it. */
static bool pass_value(struct scan *s, struct str name)
{
    char quote = *s->at++;
    const char *begin = s->at, *found = memchr(begin, quote, (size_t)(s->end - begin));
    if (!found)
        return false;
    struct str value = {begin, (size_t)(found - begin)};
    if (str_is(name, "class"))
        s->out->open.at[s->out->open.n - 1].class = value;
    else if (str_is(name, "model") && s->out->open.n == 1)
        s->out->model = value;
    s->at = found + 1;
    return true;
}

/* One attribute; where the cursor is, when it lies within: else TAG_CONTENT. */
static enum tag_place pass_attribute(struct scan *s)
{
    struct str name = take_name(s);
    if (s->at == s->end)
        return TAG_ATTRIBUTE;
    if (name.n)
        vec_push(&s->out->attributes, name);
    pass_blanks(s);
    bool given = s->at < s->end && *s->at == '=';
    s->at += given;
    pass_blanks(s);
    if (s->at == s->end)
        return given ? TAG_NOWHERE : TAG_ATTRIBUTE;
    if (given && (*s->at == '"' || *s->at == '\''))
        return pass_value(s, name) ? TAG_CONTENT : TAG_VALUE;
    if (!name.n && !given)
        s->at++; /* what has no business here */
    return TAG_CONTENT;
}

/* From behind the name of an opening tag to behind its end; where the cursor is, when it lies
 * within, else TAG_CONTENT. */
static enum tag_place pass_tag(struct scan *s)
{
    enum tag_place place = TAG_CONTENT;
    s->out->attributes.n = 0;
    while (place == TAG_CONTENT) {
        pass_blanks(s);
        if (s->at == s->end)
            return TAG_ATTRIBUTE;
        if (starts(s, "/>"))
            close_element(s->out);
        if (*s->at == '>' || starts(s, "/>")) {
            s->at += *s->at == '/' ? 2 : 1;
            return TAG_CONTENT;
        }
        if (*s->at == '<') /* the tag was not ended */
            return TAG_CONTENT;
        place = pass_attribute(s);
    }
    s->at = s->end;
    return place;
}

/* The markup that begins at the place; where the cursor is, when it lies within. */
static enum tag_place pass_markup(struct scan *s)
{
    static const struct {
        const char *open, *close;
    } others[] = {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}, {"<!", ">"}};
    struct tag_cursor *c = s->out;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (starts(s, others[i].open))
            return pass_to(s, others[i].close) ? TAG_CONTENT : TAG_NOWHERE;
    bool closing = starts(s, "</");
    s->at += closing ? 2 : 1;
    struct str name = take_name(s);
    if (s->at == s->end)
        return closing ? TAG_CLOSING : TAG_NAME;
    if (closing) {
        close_named(c, name);
        return pass_to(s, ">") ? TAG_CONTENT : TAG_NOWHERE;
    }
    vec_push(&c->given, name);
    vec_push(&c->open, (struct tag_open){.name = name, .given = c->given.n});
    return pass_tag(s);
}

void tag_cursor_find(struct tag_cursor *c, struct str text, uint32_t at)
{
    struct scan s = {.out = c, .at = text.at, .end = text.at + at};
    *c = (struct tag_cursor){.place = TAG_CONTENT};
    while (s.at < s.end) {
        if (*s.at == '<') {
            c->text = false;
            c->place = pass_markup(&s);
        } else {
            c->text |= !is_blank(*s.at++);
        }
    }
}

void tag_cursor_free(struct tag_cursor *c)
{
    vec_free(&c->open);
    vec_free(&c->given);
    vec_free(&c->attributes);
}
