#include "config.h"

#include "lsp/position.h"

const char *const position_encoding_names[POSITION_ENCODINGS] = {
    [POSITION_UTF16] = "utf-16", [POSITION_UTF8] = "utf-8", [POSITION_UTF32] = "utf-32"};

void line_index_build(struct line_index *index, struct str text)
{
    index->text = text;
    index->starts.n = 0;
    vec_push(&index->starts, 0);
    for (size_t i = 0; i < text.n; i++) {
        bool pair = text.at[i] == '\r' && i + 1 < text.n && text.at[i + 1] == '\n';
        if (text.at[i] == '\n' || (text.at[i] == '\r' && !pair))
            vec_push(&index->starts, (uint32_t)(i + 1));
    }
}

void line_index_free(struct line_index *index)
{
    vec_free(&index->starts);
}

/* What the character with this lead byte counts. */
static uint32_t units_of(unsigned char lead, enum position_encoding encoding)
{
    size_t bytes = str_utf8_length(lead);
    switch (encoding) {
    case POSITION_UTF8:
        return (uint32_t)bytes;
    case POSITION_UTF16:
        return bytes == 4 ? 2 : 1;
    case POSITION_UTF32:
    case POSITION_ENCODINGS:
        break;
    }
    return 1;
}

/* The end of a line without what ends it. */
static uint32_t line_end(const struct line_index *index, size_t line)
{
    const char *text = index->text.at;
    if (line + 1 == index->starts.n)
        return (uint32_t)index->text.n;
    uint32_t end = index->starts.at[line + 1] - 1;
    bool pair = text[end] == '\n' && end > index->starts.at[line] && text[end - 1] == '\r';
    return pair ? end - 1 : end;
}

struct position position_of(const struct line_index *index, uint32_t offset,
                            enum position_encoding encoding)
{
    size_t lo = 0, hi = index->starts.n;
    while (hi - lo > 1) {
        size_t mid = lo + (hi - lo) / 2;
        if (index->starts.at[mid] <= offset)
            lo = mid;
        else
            hi = mid;
    }
    uint32_t at = index->starts.at[lo], end = line_end(index, lo), units = 0;
    end = offset < end ? offset : end;
    while (at < end) {
        units += units_of((unsigned char)index->text.at[at], encoding);
        at += (uint32_t)str_utf8_length((unsigned char)index->text.at[at]);
    }
    return (struct position){(uint32_t)lo, units};
}

uint32_t position_offset(const struct line_index *index, struct position p,
                         enum position_encoding encoding)
{
    if (p.line >= index->starts.n)
        return (uint32_t)index->text.n;
    uint32_t at = index->starts.at[p.line], end = line_end(index, p.line), left = p.character;
    while (at < end) {
        uint32_t units = units_of((unsigned char)index->text.at[at], encoding);
        if (units > left)
            break;
        left -= units;
        at += (uint32_t)str_utf8_length((unsigned char)index->text.at[at]);
    }
    return at;
}
