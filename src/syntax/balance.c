/* XML tags made a tree: the grammar sees every element closed once, in order, whatever the text
 * holds.  Each mistake is reported here, once, at the tag that is likely to be wrong. */
#include "config.h"

#include "syntax/parser.h"

#include "grammar/scene.tab.h"
#include "schema/schema.h"

#include <stdio.h>
#include <string.h>

/* Returned for a token that is passed over. */
enum { SKIPPED = XML_SKIPPED };

static void open_tag(struct parser *p, struct str name, struct span span)
{
    if (p->open.n)
        p->open.at[p->open.n - 1].holds_elements = true;
    vec_push(&p->open, (struct open_element){.name = name, .span = span});
    if (p->open.n > NESTING_LIMIT)
        parser_stop(p, DIAG_TOO_DEEP, span,
                    "elements nested deeper than 256 levels, so the rest is not read");
}

static struct open_element *top_of(struct parser *p)
{
    return p->open.n ? &p->open.at[p->open.n - 1] : NULL;
}

/* Of elements of which there is one. */
static const struct open_element *innermost(const struct parser *p)
{
    return &p->open.at[p->open.n - 1];
}

/* Takes the innermost element off the open ones. */
static void pop(struct parser *p)
{
    p->open.n--;
    if (p->open.n < p->lost_in)
        p->lost_in = 0;
}

void xml_lose_tag(struct parser *p)
{
    p->lost_in = (uint32_t)p->open.n;
}

/* Whether a tag that does not fit follows from one that was reported as damaged; only once. */
static bool follows_from_loss(struct parser *p)
{
    bool follows = p->lost_in != 0 && p->lost_in == p->open.n;
    if (follows)
        p->lost_in = 0;
    return follows || p->feigned;
}

/* How many elements a closing tag of this name closes; 0: none has the name. */
static size_t closed_by(const struct parser *p, struct str name)
{
    for (size_t i = p->open.n; i > 0; i--)
        if (str_equal(p->open.at[i - 1].name, name))
            return p->open.n - i + 1;
    return 0;
}

/* ---- what the text says around ---- */

static bool in_name(char c)
{
    return c && !strchr(" \t\r\n<>/=\"'", c);
}

static const char *text_at(const struct parser *p, uint32_t offset)
{
    return p->source->text + (offset - p->source->base);
}

/* Behind a comment, section or processing instruction at `at`, or at itself when it is none. */
static const char *skip_other(const char *at)
{
    static const char *const marks[][2] = {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}};
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        if (strncmp(at, marks[i][0], strlen(marks[i][0])) != 0)
            continue;
        const char *end = strstr(at, marks[i][1]);
        return end ? end + strlen(marks[i][1]) : at + strlen(at);
    }
    return at;
}

/* The name of the next closing tag that the text ahead does not open itself; empty when none is
 * near. */
static struct str next_closing(const struct parser *p)
{
    enum { AHEAD = 1 << 18, TAGS = 4096 };
    xml_release(p->scanner);
    const char *at = text_at(p, p->at), *end = p->source->text + p->source->n;
    size_t depth = 0;
    if ((size_t)(end - at) > AHEAD)
        end = at + AHEAD;
    for (int tags = 0; tags < TAGS; tags++) {
        const char *tag = at < end ? memchr(at, '<', (size_t)(end - at)) : NULL;
        if (!tag)
            break;
        at = skip_other(tag);
        if (at > tag)
            continue;
        bool closing = tag[1] == '/';
        const char *name = tag + 1 + closing;
        for (at = name; at < end && in_name(*at);)
            at++;
        if (closing && depth-- == 0)
            return (struct str){name, (size_t)(at - name)};
        at += strcspn(at, "<>");
        depth += !closing && at[-1] != '/';
    }
    return (struct str){0};
}

/* The last place before the closing tag where its opening stands without the `<`; unknown when
 * there is none in the element around. */
static struct span find_bare_opening(struct parser *p, struct span closing, struct str name)
{
    const struct open_element *around = top_of(p);
    const char *least = text_at(p, around ? around->span.end : p->source->base);
    for (const char *at = text_at(p, closing.begin); name.n && at-- > least;) {
        if (memcmp(at, name.at, name.n) != 0 || in_name(at[name.n]) || in_name(at[-1]) ||
            at[-1] == '<' || at[-1] == '/')
            continue;
        const char *end = at + strcspn(at, "<>");
        if (*end != '>')
            continue;
        uint32_t begin = p->source->base + (uint32_t)(at - p->source->text);
        return (struct span){begin, begin + (uint32_t)name.n};
    }
    return (struct span){0, 0};
}

/* Whether some element of a scene is called so. */
static bool is_known(struct str name)
{
    static const char names[] = "scene camera lights light textures texture surfaces surface "
                                "materials material object";
    for (unsigned i = 0; str_nth_word(names, i).n; i++)
        if (str_equal_nocase(name, str_nth_word(names, i)))
            return true;
    for (int i = 0; i < SCHEMA_PROPS; i++)
        for (unsigned k = 0; k < schema_leaf_count((enum schema_prop_id)i); k++)
            if (str_equal(name, schema_leaf((enum schema_prop_id)i, k)))
                return true;
    return false;
}

/* ---- what is reported ---- */

static void label_opening(struct diag_entry *e, const struct open_element *o)
{
    diag_label(e, o->span, "'%.*s' is opened here", STR_ARG(o->name));
}

/* An element among the innermost n that holds text of its own misses its closing tag right behind
 * that; of the others the innermost one misses it here, before what `closes`. */
static void report_unclosed(struct parser *p, struct span span, size_t n, const char *closes)
{
    const struct open_element *missing = innermost(p);
    struct span place = span, insertion = {span.begin, span.begin};
    for (size_t i = n; i > 0; i--) {
        const struct open_element *o = &p->open.at[p->open.n - i];
        if (!o->text_end)
            continue;
        missing = o;
        place = insertion = (struct span){o->text_end, o->text_end};
        break;
    }
    p->unclosed = missing->name;
    struct diag_entry *e =
        diag_report(p->diag, DIAG_XML_CLOSING_TAG, place, "'%.*s' is not closed before %s",
                    STR_ARG(missing->name), closes);
    label_opening(e, missing);
    diag_fix(e, insertion, DIAG_FIX_MAYBE, "</%.*s>", STR_ARG(missing->name));
}

/* Opening and closing tag have different names: the one that no element of scenes has is wrong. */
static void report_wrong_name(struct parser *p, struct span span, struct str closing)
{
    const struct open_element *top = innermost(p);
    if (is_known(closing) && !is_known(top->name)) {
        struct diag_entry *e =
            diag_report(p->diag, DIAG_XML_CLOSING_TAG, top->span, "'<%.*s>' is closed as '</%.*s>'",
                        STR_ARG(top->name), STR_ARG(closing));
        diag_label(e, span, "here");
        diag_fix(e, top->span, DIAG_FIX_MAYBE, "<%.*s", STR_ARG(closing));
        return;
    }
    struct diag_entry *e = diag_report(p->diag, DIAG_XML_CLOSING_TAG, span,
                                       "'</%.*s>' closes nothing; the element to close is '%.*s'",
                                       STR_ARG(closing), STR_ARG(top->name));
    label_opening(e, top);
    diag_fix(e, span, DIAG_FIX_MAYBE, "</%.*s>", STR_ARG(top->name));
}

static void report_unopened(struct parser *p, struct span span, struct str closing)
{
    struct span bare = find_bare_opening(p, span, closing);
    if (!span_known(bare)) {
        diag_report(p->diag, DIAG_XML_CLOSING_TAG, span, "'</%.*s>' closes nothing",
                    STR_ARG(closing));
        return;
    }
    struct diag_entry *e =
        diag_report(p->diag, DIAG_XML_CLOSING_TAG, bare, "expected '<' before the tag's name");
    diag_label(e, span, "'%.*s' is closed here", STR_ARG(closing));
    diag_fix(e, (struct span){bare.begin, bare.begin}, DIAG_FIX_MAYBE, "<");
}

/* `<radius>1<radius>` or `<radius>1<radius/>` */
static void report_second_opening(struct parser *p, const struct open_element *top,
                                  struct span span)
{
    span.end += *text_at(p, span.end) == '/';
    struct diag_entry *e = diag_report(p->diag, DIAG_XML_CLOSING_TAG, span,
                                       "expected '</%.*s>', the closing tag", STR_ARG(top->name));
    label_opening(e, top);
    diag_fix(e, span, DIAG_FIX_MAYBE, "</%.*s", STR_ARG(top->name));
}

/* ---- the tokens ---- */

/* The opening tag of an element that holds text already has its name, and nothing else. */
static bool is_second_opening(const struct parser *p, const struct open_element *top,
                              struct str name, struct span span)
{
    if (!top->text_end || !str_equal(top->name, name))
        return false;
    xml_release(p->scanner);
    const char *end = text_at(p, span.end);
    return *end == '>' || (*end == '/' && end[1] == '>');
}

static bool is_section(struct str name)
{
    static const char *const sections[] = {"camera", "lights", "textures", "surfaces"};
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++)
        if (str_is(name, sections[i]))
            return true;
    return false;
}

/* How many open elements cannot hold one of this name: sections of the scene hold no sections,
 * surfaces no surfaces and lights no lights. */
static size_t closed_by_opening(const struct parser *p, struct str name)
{
    enum { SECTION = 1, ITEM = 2 }; /* where they stand among the open ones */
    if (p->open.n > ITEM && str_equal(name, p->open.at[ITEM].name) &&
        (str_is(name, "surface") || str_is(name, "light")))
        return p->open.n - ITEM;
    if (p->open.n > SECTION && is_section(name) && is_section(p->open.at[SECTION].name))
        return p->open.n - SECTION;
    return 0;
}

/* The tag shows that the innermost n elements miss their closing tags; it waits behind those. */
static int close_before(struct parser *p, struct str name, struct span span, size_t n)
{
    char closes[80];
    snprintf(closes, sizeof closes, "'<%.*s>'", STR_ARG(name));
    if (!follows_from_loss(p))
        report_unclosed(p, (struct span){span.begin, span.begin}, n, closes);
    p->held[p->held_count++] = (struct held){TOKEN_XML_OPEN, name, span};
    p->closes_due = n - 1;
    pop(p);
    return TOKEN_XML_CLOSE;
}

/* The end of a tag that was taken for a closing one is passed over. */
static int end_tag(struct parser *p, int token)
{
    bool lost = p->tag_end_lost;
    p->tag_end_lost = false;
    return lost ? XML_SKIPPED : token;
}

static int open_element(struct parser *p, struct str name, struct span span)
{
    size_t n = closed_by_opening(p, name);
    if (n)
        return close_before(p, name, span, n);
    const struct open_element *top = top_of(p);
    if (!top || !is_second_opening(p, top, name, span)) {
        open_tag(p, name, span);
        return TOKEN_XML_OPEN;
    }
    report_second_opening(p, top, span);
    p->tag_end_lost = true;
    pop(p);
    return TOKEN_XML_CLOSE;
}

/* A closing tag of a name that no open element has.  It closes the innermost one under a wrong
 * name, unless that one's own closing tag is still to come. */
static int close_unknown(struct parser *p, struct str name, struct span span)
{
    if (str_equal(name, p->unclosed)) { /* it comes too late */
        p->unclosed = (struct str){0};
        return SKIPPED;
    }
    bool stray = str_equal(next_closing(p), innermost(p)->name) ||
                 span_known(find_bare_opening(p, span, name));
    if (!follows_from_loss(p)) {
        if (stray)
            report_unopened(p, span, name);
        else
            report_wrong_name(p, span, name);
    }
    if (stray)
        return SKIPPED;
    pop(p);
    return TOKEN_XML_CLOSE;
}

static int close_tag(struct parser *p, struct str name, struct span span)
{
    if (!p->open.n)
        return TOKEN_XML_CLOSE; /* a syntax error behind the root */
    name = str_trim(name);
    size_t n = name.n ? closed_by(p, name) : 1;
    if (n == 0)
        return close_unknown(p, name, span);
    if (n == 2 && str_equal(next_closing(p), name) && !follows_from_loss(p)) {
        report_wrong_name(p, span, name); /* the element around is closed later */
        pop(p);
        return TOKEN_XML_CLOSE;
    }
    if (n > 1 && !follows_from_loss(p)) {
        char closes[80];
        snprintf(closes, sizeof closes, "'</%.*s>'", name.n < 60 ? (int)name.n : 60, name.at);
        report_unclosed(p, span, n - 1, closes);
    }
    p->closes_due = n - 1;
    pop(p);
    return TOKEN_XML_CLOSE;
}

static int end_of_text(struct parser *p, struct span span)
{
    if (!p->open.n || p->stopped)
        return TOKEN_END;
    if (!follows_from_loss(p))
        report_unclosed(p, span, p->open.n, "the text ends");
    p->closes_due = p->open.n - 1;
    pop(p);
    p->feigned = true;
    return TOKEN_XML_CLOSE;
}

/* Remembers where the first text of an element ends, or what may be its damaged closing tag. */
static void note_text(struct parser *p, struct span span, struct str text)
{
    struct open_element *top = top_of(p);
    if (!top || top->text_end || !str_trim(text).n)
        return;
    if (!top->holds_elements || memmem(text.at, text.n, top->name.at, top->name.n))
        top->text_end = span_of_trimmed(span, text).end;
}

int xml_balance(struct parser *p, int token, struct span span, struct str name)
{
    switch (token) {
    case TOKEN_XML_OPEN:
        return open_element(p, name, span);
    case TOKEN_XML_TAG_END:
        return end_tag(p, token);
    case TOKEN_XML_TEXT:
        note_text(p, span, name);
        return token;
    case TOKEN_XML_EMPTY_END:
        if (p->tag_end_lost)
            return end_tag(p, token);
        p->open.n -= p->open.n > 0;
        return token;
    case TOKEN_XML_CLOSE:
        return close_tag(p, name, span);
    case TOKEN_END:
        return end_of_text(p, span);
    default:
        return token;
    }
}

bool xml_close_due(struct parser *p)
{
    if (!p->closes_due)
        return false;
    p->closes_due--;
    pop(p);
    return true;
}
