#include "config.h"

#include "print/layout.h"

#include <assert.h>

enum item_kind {
    ITEM_TEXT,
    ITEM_COMMENT,
    ITEM_BREAK,
    ITEM_LINE,
    ITEM_INDENT,
    ITEM_OPEN,
    ITEM_CLOSE
};

struct layout_item {
    enum item_kind kind;
    bool fill, blank;   /* break, line */
    bool block, broken; /* open */
    int32_t number;     /* text, comment, break: width; line: extra; indent: by how much */
    unsigned column;    /* comment: where it stood */
    size_t end;         /* open: its close; comment: bytes of its first line */
    struct str text;
};

static unsigned columns_of(struct str s)
{
    unsigned n = 0;
    for (size_t i = 0; i < s.n; i++)
        n += (s.at[i] & 0xC0) != 0x80;
    return n;
}

static struct str without_end_blanks(struct str s)
{
    while (s.n && memchr(" \t\r", s.at[s.n - 1], 3))
        s.n--;
    return s;
}

static void push(struct layout *l, struct layout_item item)
{
    vec_push(&l->items, item);
}

void layout_text(struct layout *l, struct str text)
{
    push(l, (struct layout_item){
                .kind = ITEM_TEXT, .text = text, .number = (int32_t)columns_of(text)});
}

static void break_groups(struct layout *l, bool only_blocks)
{
    for (size_t i = l->groups.n; i > 0; i--) {
        struct layout_item *open = &l->items.at[l->groups.at[i - 1]];
        open->broken |= open->block || !only_blocks;
    }
}

void layout_break_blocks(struct layout *l)
{
    break_groups(l, true);
}

void layout_comment(struct layout *l, struct str text, unsigned column)
{
    const char *newline = memchr(text.at, '\n', text.n);
    struct str first = {text.at, newline ? (size_t)(newline - text.at) : text.n};
    if (newline)
        break_groups(l, false);
    push(l, (struct layout_item){.kind = ITEM_COMMENT,
                                 .text = text,
                                 .column = column,
                                 .end = first.n,
                                 .number = (int32_t)columns_of(without_end_blanks(first))});
}

void layout_break(struct layout *l, struct layout_break b)
{
    push(l, (struct layout_item){
                .kind = ITEM_BREAK, .fill = b.fill, .blank = b.blank, .number = (int32_t)b.width});
}

void layout_line(struct layout *l, bool blank, unsigned extra)
{
    break_groups(l, false);
    push(l, (struct layout_item){.kind = ITEM_LINE, .blank = blank, .number = (int32_t)extra});
}

void layout_indent(struct layout *l, int by)
{
    push(l, (struct layout_item){.kind = ITEM_INDENT, .number = by});
}

void layout_open(struct layout *l, bool block)
{
    vec_push(&l->groups, l->items.n);
    push(l, (struct layout_item){.kind = ITEM_OPEN, .block = block});
}

void layout_close(struct layout *l)
{
    assert(l->groups.n);
    l->items.at[l->groups.at[--l->groups.n]].end = l->items.n;
    push(l, (struct layout_item){.kind = ITEM_CLOSE});
}

/* ---- widths ---- */

/* Columns that the items from the one at `from` on take in one line, up to where it may end: a
 * group (least 1) or what stands between two breaks of one (least 0), and behind that up to the
 * next break of any group.  Counting ends when it is clear that they are too many. */
static unsigned width_to_break(const struct layout *l, size_t from, int least)
{
    unsigned width = 0;
    bool behind = false;
    int depth = 0;
    for (size_t i = from; i < l->items.n && width <= LAYOUT_COLUMNS; i++) {
        const struct layout_item *item = &l->items.at[i];
        if (item->kind == ITEM_LINE || (item->kind == ITEM_BREAK && (behind || depth <= 0)))
            break;
        depth += (item->kind == ITEM_OPEN) - (item->kind == ITEM_CLOSE);
        behind |= depth < least;
        if (item->kind == ITEM_TEXT || item->kind == ITEM_COMMENT || item->kind == ITEM_BREAK)
            width += (unsigned)item->number;
        if (item->kind == ITEM_COMMENT && item->end < item->text.n)
            break;
    }
    return width;
}

static bool fits(const struct layout *l, size_t from)
{
    unsigned column = l->begun ? l->column : l->nest;
    return column + width_to_break(l, from, 1) <= LAYOUT_COLUMNS;
}

/* The line that begins with this break of a filled group, if it does, breaks a group before the
 * next. */
static bool broken_ahead(const struct layout *l, size_t from)
{
    int depth = 0;
    for (size_t i = from; i < l->items.n && depth >= 0; i++) {
        const struct layout_item *item = &l->items.at[i];
        bool line =
            item->kind == ITEM_LINE || (item->kind == ITEM_COMMENT && item->end < item->text.n);
        if (line || (item->kind == ITEM_BREAK && depth == 0))
            return false;
        if (item->kind == ITEM_OPEN && item->broken)
            return true;
        if (item->kind == ITEM_OPEN)
            i = item->end;
        depth -= item->kind == ITEM_CLOSE;
    }
    return false;
}

/* ---- writing ---- */

static void write_text(struct layout *l, struct str text, unsigned width)
{
    if (!text.n)
        return;
    if (!l->begun) {
        buffer_fill(l->out, ' ', l->nest);
        l->column = l->nest;
    }
    l->begun = true;
    buffer_str(l->out, text);
    l->column += width;
    size_t last = text.n; /* where the last line of a text of several begins */
    while (last > 0 && text.at[last - 1] != '\n')
        last--;
    if (last > 0)
        l->column = columns_of((struct str){text.at + last, text.n - last});
}

static void end_line(struct layout *l, bool blank, unsigned extra)
{
    if (!l->out->n)
        return;
    buffer_fill(l->out, '\n', blank ? 2 : 1);
    l->begun = false;
    if (extra) {
        buffer_fill(l->out, ' ', l->nest + extra);
        l->column = l->nest + extra;
        l->begun = true;
    }
}

static void write_comment(struct layout *l, const struct layout_item *item)
{
    struct str rest = item->text;
    rest.n = item->end;
    write_text(l, without_end_blanks(rest), 0);
    int shift = (int)l->column - (int)item->column;
    l->column += (unsigned)item->number;
    for (size_t at = item->end; at < item->text.n;) {
        at++; /* the newline */
        const char *line = item->text.at + at;
        const char *end = memchr(line, '\n', item->text.n - at);
        rest =
            without_end_blanks((struct str){line, end ? (size_t)(end - line) : item->text.n - at});
        at += end ? (size_t)(end - line) : item->text.n - at;
        buffer_fill(l->out, '\n', 1);
        if (rest.n && shift > 0)
            buffer_fill(l->out, ' ', (size_t)shift);
        for (int i = shift; i < 0 && rest.n && (rest.at[0] == ' ' || rest.at[0] == '\t'); i++)
            rest = (struct str){rest.at + 1, rest.n - 1};
        buffer_str(l->out, rest);
        l->column = columns_of(rest) + (shift > 0 ? (unsigned)shift : 0);
    }
}

static void write_break(struct layout *l, size_t i, bool flat)
{
    const struct layout_item *item = &l->items.at[i];
    bool stay = flat || (item->fill && !broken_ahead(l, i + 1) &&
                         l->column + (unsigned)item->number + width_to_break(l, i + 1, 0) <=
                             LAYOUT_COLUMNS);
    if (!stay)
        end_line(l, item->blank, 0);
    else if (l->begun) {
        buffer_fill(l->out, ' ', (size_t)item->number);
        l->column += (unsigned)item->number;
    }
}

void layout_flush(struct layout *l)
{
    size_t flat_until = 0; /* items before this are in a group that fits */
    assert(!l->groups.n);
    for (size_t i = 0; i < l->items.n; i++) {
        const struct layout_item *item = &l->items.at[i];
        bool flat = i < flat_until;
        switch (item->kind) {
        case ITEM_TEXT:
            write_text(l, item->text, (unsigned)item->number);
            break;
        case ITEM_COMMENT:
            write_comment(l, item);
            break;
        case ITEM_BREAK:
            write_break(l, i, flat);
            break;
        case ITEM_LINE:
            end_line(l, item->blank, (unsigned)item->number);
            break;
        case ITEM_INDENT:
            l->nest = (unsigned)((int)l->nest + item->number);
            break;
        case ITEM_OPEN:
            if (!flat && !item->broken && fits(l, i))
                flat_until = item->end;
            break;
        case ITEM_CLOSE:
            break;
        }
    }
    l->items.n = 0;
}

void layout_free(struct layout *l)
{
    vec_free(&l->items);
    vec_free(&l->groups);
}
