/* Grammar actions longer than a constructor: literals and XML elements. */
#include "config.h"

#include "syntax/parser.h"

#include "base/num.h"

#include <math.h>
#include <string.h>

/* ---- native ---- */

void parser_version(struct parser *p, struct span span, struct span number_span, struct str number)
{
    struct ast_node *n = ast_node(p->ast, AST_VERSION, span);
    n->number = 1;
    num_parse(number.at, number.at + number.n, &n->number);
    p->version = ast_append((struct ast_list){0}, n);
    if (n->number != 1)
        diag_report(p->diag, DIAG_VERSION, number_span,
                    "version %.*s of the language is not read; this program reads version 1",
                    STR_ARG(number));
}

struct ast_node *parser_number(struct parser *p, enum ast_kind kind, struct span span,
                               struct str spelling)
{
    struct ast_node *n = ast_node(p->ast, kind, span);
    num_parse(spelling.at, spelling.at + spelling.n, &n->number);
    if (!isfinite(n->number))
        diag_report(p->diag, DIAG_NOT_FINITE, span, "the number is too large");
    return n;
}

struct ast_node *parser_colour(struct parser *p, struct span span, struct str digits)
{
    struct ast_node *n = ast_node(p->ast, AST_COLOUR, span);
    bool right = digits.n == 6;
    for (size_t i = 0; i < digits.n && right; i++) {
        static const char hex[] = "0123456789abcdef";
        const char *at = memchr(hex, digits.at[i] | 32, sizeof hex - 1);
        right = at != NULL;
        n->rgb = n->rgb * 16 + (right ? (uint32_t)(at - hex) : 0);
    }
    if (right)
        return n;
    diag_report(p->diag, DIAG_NUMBER_SYNTAX, span, "a colour is '#' and six hexadecimal digits");
    return ast_node(p->ast, AST_ERROR, span);
}

struct ast_node *parser_block(struct parser *p, enum ast_kind kind, struct span span,
                              struct str name, struct span name_span, struct str label,
                              struct ast_list members)
{
    struct ast_node *n = ast_named(p->ast, kind, span, name, name_span);
    n->label = label;
    return ast_holding(n, members);
}

/* Reads `{41}` after `\u`; returns the bytes it takes, or 0. */
static size_t read_code_point(const char *at, const char *end, unsigned long *c)
{
    const char *q = at;
    *c = 0;
    if (q == end || *q++ != '{')
        return 0;
    for (; q < end && *q != '}' && *c <= 0x10FFFF; q++) {
        char d = (char)(*q | 32);
        if (!(*q >= '0' && *q <= '9') && !(d >= 'a' && d <= 'f'))
            return 0;
        *c = *c * 16 + (unsigned long)(*q <= '9' ? *q - '0' : d - 'a' + 10);
    }
    bool surrogate = *c >= 0xD800 && *c <= 0xDFFF;
    if (q == end || *q != '}' || *c == 0 || *c > 0x10FFFF || surrogate)
        return 0;
    return (size_t)(q + 1 - at);
}

/* Undoes one escape at `at` (behind the backslash) into *out; returns the bytes read, or 0. */
static size_t unescape_one(const char *at, const char *end, char **out)
{
    static const char from[] = "\"\\nt", to[] = "\"\\\n\t";
    const char *simple = memchr(from, *at, sizeof from - 1);
    if (simple) {
        *(*out)++ = to[simple - from];
        return 1;
    }
    unsigned long c;
    size_t n = *at == 'u' ? read_code_point(at + 1, end, &c) : 0;
    if (!n)
        return 0;
    *out += str_utf8_encode(c, *out);
    return n + 1;
}

struct str parser_unescape(struct parser *p, struct span span, struct str s)
{
    if (!s.n || !memchr(s.at, '\\', s.n))
        return s;
    char *buffer = arena_alloc(&p->ast->arena, s.n), *out = buffer;
    const char *end = s.at + s.n;
    for (const char *at = s.at; at < end;) {
        if (*at != '\\') {
            *out++ = *at++;
            continue;
        }
        size_t n = unescape_one(at + 1, end, &out);
        if (!n) {
            uint32_t place = span.begin + 1 + (uint32_t)(at - s.at);
            struct diag_entry *e =
                diag_report(p->diag, DIAG_STRING_ESCAPE, (struct span){place, place + 2},
                            "'\\%c' is no escape", at[1]);
            diag_note(e, "the escapes are \\\" \\\\ \\n \\t \\u{...}");
            n = 1;
        }
        at += 1 + n;
    }
    return (struct str){buffer, (size_t)(out - buffer)};
}

/* ---- XML ---- */

static bool is_blank(struct str s)
{
    return str_trim(s).n == 0;
}

/* True when the piece ends where the text begins, and both are the source's own bytes. */
static bool continues_text(const struct parser *p, const struct ast_node *piece, struct span span,
                           struct str text)
{
    const char *source = p->source->text;
    return piece->span.end == span.begin && text.at == source + (span.begin - p->source->base) &&
           piece->text.at == source + (piece->span.begin - p->source->base);
}

struct xml_content xml_add_text(struct parser *p, struct xml_content c, struct span span,
                                struct str text)
{
    if (!text.n || (!c.text.first && is_blank(text)))
        return c; /* leading blanks would be trimmed anyway */
    if (c.text.last && continues_text(p, c.text.last, span, text)) {
        c.text.last->text.n += text.n;
        c.text.last->span.end = span.end;
        return c;
    }
    c.text = ast_append(c.text, ast_text(p->ast, AST_TEXT, span, text));
    return c;
}

/* The text of a leaf: one piece as it lies in the source, several joined. */
static struct ast_node *join_text(struct parser *p, struct ast_list pieces, struct span inner)
{
    struct ast_node *first = pieces.first;
    if (!first) {
        if (!p->no_text)
            p->no_text = ast_text(p->ast, AST_TEXT, inner, (struct str){"", 0});
        return p->no_text;
    }
    struct str source = srcmap_text(p->diag->sources, first->span);
    if (!first->next && source.at == first->text.at) {
        struct str trimmed = str_trim(first->text);
        first->span.begin += (uint32_t)(trimmed.at - first->text.at);
        first->span.end = first->span.begin + (uint32_t)trimmed.n;
        first->text = trimmed;
        first->exact = true;
        return first;
    }
    size_t n = 0;
    for (struct ast_node *t = first; t; t = t->next)
        n += t->text.n;
    char *joined = arena_alloc(&p->ast->arena, n), *out = joined;
    for (struct ast_node *t = first; t; t = t->next)
        out = (char *)memcpy(out, t->text.at, t->text.n) + t->text.n;
    struct span span = span_join(first->span, pieces.last->span);
    return ast_text(p->ast, AST_TEXT, span, str_trim((struct str){joined, n}));
}

/* The pieces that are not blank, to be refused where only elements may stand. */
static struct ast_list visible_text(const struct parser *p, struct ast_list pieces)
{
    struct ast_list kept = {0};
    for (struct ast_node *t = pieces.first, *next; t; t = next) {
        next = t->next;
        t->next = NULL;
        if (is_blank(t->text))
            continue;
        if (t->text.at == srcmap_text(p->diag->sources, t->span).at) {
            t->span = span_of_trimmed(t->span, t->text);
            t->text = str_trim(t->text);
        }
        kept = ast_append(kept, t);
    }
    return kept;
}

struct ast_node *xml_element(struct parser *p, struct span span, struct str name,
                             struct span name_span, struct ast_list attributes,
                             struct xml_content content)
{
    struct span inner = {name_span.end, span.end};
    name_span.begin++; /* the `<` */
    if (!attributes.first && !content.children.first) {
        struct ast_node *leaf = ast_named(p->ast, AST_PROPERTY, span, name, name_span);
        return ast_with(leaf, join_text(p, content.text, inner));
    }
    struct ast_list members = ast_concat(attributes, content.children);
    members = ast_concat(members, visible_text(p, content.text));
    return ast_holding(ast_named(p->ast, AST_BLOCK, span, name, name_span), members);
}

static bool character_reference(struct str name, unsigned long *c)
{
    bool hexadecimal = name.n > 2 && name.at[1] == 'x';
    size_t i = hexadecimal ? 2 : 1;
    if (i >= name.n)
        return false;
    for (*c = 0; i < name.n && *c <= 0x10FFFF; i++) {
        int d = name.at[i] >= '0' && name.at[i] <= '9' ? name.at[i] - '0'
                : hexadecimal && (name.at[i] | 32) >= 'a' && (name.at[i] | 32) <= 'f'
                    ? (name.at[i] | 32) - 'a' + 10
                    : -1;
        if (d < 0)
            return false;
        *c = *c * (hexadecimal ? 16 : 10) + (unsigned long)d;
    }
    bool control = *c < 32 && *c != '\t' && *c != '\n' && *c != '\r';
    return !control && *c <= 0x10FFFF && !(*c >= 0xD800 && *c <= 0xDFFF);
}

struct str xml_reference(struct parser *p, struct str name, struct span span)
{
    static const struct {
        const char *name, *text;
    } predefined[] = {{"lt", "<"}, {"gt", ">"}, {"amp", "&"}, {"quot", "\""}, {"apos", "'"}};
    for (size_t i = 0; i < sizeof predefined / sizeof *predefined; i++)
        if (str_is(name, predefined[i].name))
            return str_of(predefined[i].text);
    unsigned long c;
    if (name.n && name.at[0] == '#' && character_reference(name, &c)) {
        char *bytes = arena_alloc(&p->ast->arena, 4);
        return (struct str){bytes, str_utf8_encode(c, bytes)};
    }
    struct diag_entry *e = diag_report(p->diag, DIAG_XML_ENTITY, span,
                                       "'&%.*s;' is no reference of XML", STR_ARG(name));
    diag_note(e, "only &lt; &gt; &amp; &quot; &apos; and character references such as &#65; are "
                 "read; entities are never expanded");
    return (struct str){0};
}

/* Bytes of the reference at `at`, from `&` to `;`, as the scanner takes one; 0: none. */
static size_t reference_length(const char *at, const char *end)
{
    static const char letters[] =
        "#ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
    const char *q = at + 1;
    while (q < end && memchr(letters, *q, sizeof letters - 1))
        q++;
    return q < end && *q == ';' ? (size_t)(q + 1 - at) : 0;
}

struct str xml_attribute_value(struct parser *p, struct span span, struct str s)
{
    if (!s.n || !memchr(s.at, '&', s.n))
        return s;
    char *buffer = arena_alloc(&p->ast->arena, s.n), *out = buffer;
    const char *end = s.at + s.n;
    for (const char *at = s.at; at < end;) {
        uint32_t place = span.begin + 1 + (uint32_t)(at - s.at);
        size_t n = *at == '&' ? reference_length(at, end) : 0;
        if (*at == '&' && !n)
            xml_stray_ampersand(p, (struct span){place, place + 1});
        if (!n) {
            *out++ = *at++;
            continue;
        }
        struct span whole = {place, place + (uint32_t)n};
        struct str text = xml_reference(p, (struct str){at + 1, n - 2}, whole);
        out = text.n ? (char *)memcpy(out, text.at, text.n) + text.n : out;
        at += n;
    }
    return (struct str){buffer, (size_t)(out - buffer)};
}
