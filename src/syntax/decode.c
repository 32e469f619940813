/* Bytes to UTF-8 text, and back. */
#include "config.h"

#include "syntax/syntax.h"

#include "base/mem.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BYTE_ORDER_MARK "\xEF\xBB\xBF"

enum encoding { ENCODING_UTF8, ENCODING_LATIN1, ENCODING_ASCII };

static bool problem_at(struct encoding_problem *p, enum diag_code code, size_t offset,
                       const char *message)
{
    p->code = code;
    p->offset = offset;
    snprintf(p->message, sizeof p->message, "%s", message);
    return false;
}

static bool starts_with(const char *text, size_t n, const char *prefix, size_t length)
{
    return n >= length && memcmp(text, prefix, length) == 0;
}

/* The value of `encoding` in an XML declaration at the start of the text, or an empty slice. */
static struct str declared_encoding(const char *text, size_t n)
{
    static const char word[] = "encoding";
    static const char start[] = "<?xml";
    bool declares = starts_with(text, n, start, sizeof start - 1) && n > sizeof start - 1 &&
                    strchr(" \t\r\n", text[sizeof start - 1]);
    const char *end = declares ? memchr(text, '>', n) : NULL;
    const char *at = end ? memmem(text, (size_t)(end - text), word, sizeof word - 1) : NULL;
    if (!at)
        return (struct str){0};
    at += sizeof word - 1;
    while (at < end && *at != '"' && *at != '\'')
        at++;
    const char *close = at < end ? memchr(at + 1, *at, (size_t)(end - at - 1)) : NULL;
    return close ? (struct str){at + 1, (size_t)(close - at - 1)} : (struct str){0};
}

static bool encoding_of(struct str name, enum encoding *encoding)
{
    static const struct {
        const char *name;
        enum encoding encoding;
    } known[] = {{"UTF-8", ENCODING_UTF8},        {"UTF8", ENCODING_UTF8},
                 {"ISO-8859-1", ENCODING_LATIN1}, {"ISO8859-1", ENCODING_LATIN1},
                 {"ISO_8859-1", ENCODING_LATIN1}, {"Latin-1", ENCODING_LATIN1},
                 {"Latin1", ENCODING_LATIN1},     {"US-ASCII", ENCODING_ASCII},
                 {"ASCII", ENCODING_ASCII}};
    *encoding = ENCODING_UTF8;
    if (!name.n)
        return true;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (str_equal_nocase(name, str_of(known[i].name))) {
            *encoding = known[i].encoding;
            return true;
        }
    }
    return false;
}

static void latin1_to_utf8(char **text, size_t *n)
{
    size_t high = 0;
    for (size_t i = 0; i < *n; i++)
        high += (unsigned char)(*text)[i] >= 0x80;
    char *out = mem_alloc(*n + high + 2, 1), *to = out;
    for (size_t i = 0; i < *n; i++)
        to += str_utf8_encode((unsigned char)(*text)[i], to);
    free(*text);
    *text = out;
    *n += high;
}

bool syntax_decode(char **text, size_t *n, bool *marked, struct encoding_problem *problem)
{
    *marked = starts_with(*text, *n, BYTE_ORDER_MARK, strlen(BYTE_ORDER_MARK));
    if (starts_with(*text, *n, "\xFF\xFE", 2) || starts_with(*text, *n, "\xFE\xFF", 2))
        return problem_at(problem, DIAG_ENCODING, 0, "UTF-16 is not read; save the scene as UTF-8");
    if (*marked)
        memmove(*text, *text + 3, *n -= 3);
    const char *nul = *n ? memchr(*text, 0, *n) : NULL;
    if (nul)
        return problem_at(problem, DIAG_NOT_TEXT, (size_t)(nul - *text),
                          "the file holds a zero byte, so it is not text");
    enum encoding encoding;
    struct str name = declared_encoding(*text, *n);
    if (!encoding_of(name, &encoding)) {
        problem_at(problem, DIAG_ENCODING, (size_t)(name.at - *text), "");
        snprintf(problem->message, sizeof problem->message,
                 "the encoding '%.*s' is not read; UTF-8, ISO-8859-1 and US-ASCII are",
                 (int)(name.n < 40 ? name.n : 40), name.at);
        return false;
    }
    if (encoding == ENCODING_LATIN1)
        latin1_to_utf8(text, n);
    size_t wrong = str_utf8_valid(*text, *n);
    if (wrong < *n)
        return problem_at(problem, DIAG_ENCODING, wrong, "this byte is not part of UTF-8 text");
    return true;
}

/* Of valid UTF-8; moves *at behind it. */
static uint32_t take_character(const char *text, size_t *at)
{
    size_t n = str_utf8_length((unsigned char)text[*at]);
    uint32_t c = (unsigned char)text[(*at)++];
    c &= n == 1 ? 0x7F : 0xFFu >> (n + 1);
    for (; n > 1; n--)
        c = c << 6 | ((unsigned char)text[(*at)++] & 0x3F);
    return c;
}

/* Characters that the encoding lacks become references: they stand in text and attributes of XML,
 * as native scenes declare no encoding. */
void syntax_encode(struct str text, bool marked, struct buffer *out)
{
    enum encoding encoding;
    buffer_puts(out, marked ? BYTE_ORDER_MARK : "");
    if (!encoding_of(declared_encoding(text.at, text.n), &encoding) || encoding == ENCODING_UTF8) {
        buffer_add(out, text.at, text.n);
        return;
    }
    uint32_t most = encoding == ENCODING_LATIN1 ? 0xFF : 0x7F;
    for (size_t i = 0; i < text.n;) {
        uint32_t c = take_character(text.at, &i);
        char byte = (char)c;
        if (c <= most)
            buffer_add(out, &byte, 1);
        else
            buffer_printf(out, "&#%u;", c);
    }
}

bool syntax_is_xml(struct str text)
{
    text = str_trim(text);
    return text.n && text.at[0] == '<';
}
