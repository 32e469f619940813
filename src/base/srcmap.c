#include "config.h"

#include "base/srcmap.h"

#include <string.h>

struct source *srcmap_add(struct srcmap *m, const char *name, char *text, size_t n)
{
    uint64_t base = 1;
    if (m->sources.n) {
        const struct source *last = m->sources.at[m->sources.n - 1];
        base = (uint64_t)last->base + last->n + 1; /* each source owns its end offset too */
    }
    if (n >= UINT32_MAX || base + n >= UINT32_MAX) {
        free(text);
        return NULL;
    }
    text[n] = text[n + 1] = 0;
    struct source *s = mem_zalloc(1, sizeof *s);
    size_t length = strlen(name);
    s->name = mem_alloc(length + 1, 1);
    memcpy(s->name, name, length + 1);
    s->text = text;
    s->base = (uint32_t)base;
    s->n = (uint32_t)n;
    vec_push(&m->sources, s);
    return s;
}

static struct source *find(const struct srcmap *m, uint32_t offset)
{
    size_t lo = 0, hi = m->sources.n;
    while (lo < hi) {
        size_t mid = lo + (hi - lo) / 2;
        if (m->sources.at[mid]->base <= offset)
            lo = mid + 1;
        else
            hi = mid;
    }
    if (lo == 0)
        return NULL;
    struct source *s = m->sources.at[lo - 1];
    return offset - s->base <= s->n ? s : NULL;
}

const struct source *srcmap_source(const struct srcmap *m, uint32_t offset)
{
    return find(m, offset);
}

static void index_lines(struct source *s)
{
    vec_push(&s->lines, 0);
    const char *p = s->text, *end = s->text + s->n;
    while ((p = memchr(p, '\n', (size_t)(end - p))))
        vec_push(&s->lines, (uint32_t)(++p - s->text));
}

/* The number of the line (from 0) that holds byte `at`. */
static size_t line_of(const struct source *s, uint32_t at)
{
    size_t lo = 0, hi = s->lines.n;
    while (hi - lo > 1) {
        size_t mid = lo + (hi - lo) / 2;
        if (s->lines.at[mid] <= at)
            lo = mid;
        else
            hi = mid;
    }
    return lo;
}

static uint32_t count_code_points(const char *p, const char *end)
{
    uint32_t n = 0;
    for (; p < end; p++)
        n += (*p & 0xC0) != 0x80;
    return n;
}

/* The column (from 0) of byte `at` in the line that begins at byte `begin`. */
static uint32_t column_of(struct source *s, uint32_t begin, uint32_t at)
{
    if (s->last.line != begin || s->last.at > at) {
        s->last.line = s->last.at = begin;
        s->last.column = 0;
    }
    s->last.column += count_code_points(s->text + s->last.at, s->text + at);
    s->last.at = at;
    return s->last.column;
}

struct location srcmap_locate(const struct srcmap *m, uint32_t offset)
{
    struct source *s = find(m, offset);
    if (!s)
        return (struct location){0};
    if (!s->lines.n)
        index_lines(s);
    uint32_t at = offset - s->base;
    size_t line = line_of(s, at);
    uint32_t begin = s->lines.at[line];
    uint32_t end = line + 1 < s->lines.n ? s->lines.at[line + 1] - 1 : s->n;
    if (end > begin && s->text[end - 1] == '\r')
        end--;
    return (struct location){
        .source = s,
        .line = (uint32_t)line + 1,
        .column = column_of(s, begin, at) + 1,
        .line_text = {s->text + begin, end - begin},
        .line_base = s->base + begin,
    };
}

struct str srcmap_text(const struct srcmap *m, struct span span)
{
    const struct source *s = find(m, span.begin);
    if (!s || span.end < span.begin)
        return (struct str){"", 0};
    uint32_t begin = span.begin - s->base, end = span.end - s->base;
    return (struct str){s->text + begin, (end < s->n ? end : s->n) - begin};
}

void srcmap_free(struct srcmap *m)
{
    for (size_t i = 0; i < m->sources.n; i++) {
        struct source *s = m->sources.at[i];
        free(s->name);
        free(s->text);
        vec_free(&s->lines);
        free(s);
    }
    vec_free(&m->sources);
}
