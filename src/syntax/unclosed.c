/* Which brace of a native text is not closed, told by how its lines are indented: closing braces
 * that begin a line stand as far in as the line of their opening ones. */
#include "config.h"

#include "syntax/parser.h"

#include "grammar/scene.tab.h"

#include <string.h>

struct opening {
    uint32_t at;     /* offset in the text */
    uint32_t indent; /* of its line */
};

struct reading {
    const struct parser *parser;
    unsigned missing; /* the next one of those known */
    const char *text;
    uint32_t n, at, indent;
    bool line_begins; /* nothing but blanks stands before in the line */
    VEC(struct opening) open;
};

static bool starts(const struct reading *r, const char *mark)
{
    return strncmp(r->text + r->at, mark, strlen(mark)) == 0;
}

static void skip_to(struct reading *r, const char *mark, size_t from)
{
    const char *end = strstr(r->text + r->at + from, mark);
    r->at = end ? (uint32_t)(end - r->text) : r->n;
}

/* Strings end on their line. */
static void skip_string(struct reading *r)
{
    uint32_t begin = r->at++;
    while (r->at < r->n && r->text[r->at] != '"' && r->text[r->at] != '\n')
        r->at += r->text[r->at] == '\\' && r->at + 1 < r->n ? 2 : 1;
    if (r->at < r->n && r->text[r->at] == '"')
        r->at++;
    else
        r->at = begin + (uint32_t)parser_endless_string(r->text + begin, r->at - begin);
}

static void begin_line(struct reading *r)
{
    r->at++;
    r->indent = (uint32_t)strspn(r->text + r->at, " \t");
    r->line_begins = true;
}

/* Closes the innermost brace; false when the indentation says that it cannot be meant. */
static bool close_brace(struct reading *r)
{
    if (!r->open.n)
        return true;
    const struct opening *top = &r->open.at[r->open.n - 1];
    if (r->line_begins && r->indent < top->indent)
        return false;
    r->open.n--;
    return true;
}

/* Closes what is known to miss its closing brace here. */
static void close_missing(struct reading *r)
{
    const struct parser *p = r->parser;
    while (r->missing < p->missing_count &&
           p->missing[r->missing].place <= p->source->base + r->at) {
        r->missing++;
        r->open.n -= r->open.n > 0;
    }
}

/* Reads up to the closing brace that stands too far out, or to the end. */
static void read_braces(struct reading *r)
{
    while (r->at < r->n) {
        char c = r->text[r->at];
        close_missing(r);
        if (c == '\n') {
            begin_line(r);
            continue;
        }
        if (starts(r, "//")) {
            skip_to(r, "\n", 2);
            continue;
        }
        if (starts(r, "/*")) {
            skip_to(r, "*/", 2);
            r->at += r->at < r->n ? 2 : 0;
            continue;
        }
        if (c == '"') {
            skip_string(r);
            continue;
        }
        if (c == '{')
            vec_push(&r->open, (struct opening){r->at, r->indent});
        else if (c == '}' && !close_brace(r))
            return;
        r->line_begins &= c == ' ' || c == '\t' || c == '\r';
        r->at++;
    }
    close_missing(r);
}

static bool is_blank_line(const char *line)
{
    line += strspn(line, " \t\r");
    return *line == '\n' || *line == 0;
}

/* Where the brace's lines end: before the first one that is not indented more than its own. */
static uint32_t end_of_body(const struct reading *r, const struct opening *o)
{
    uint32_t end = o->at + (uint32_t)strcspn(r->text + o->at, "\n");
    for (uint32_t at = end; at < r->n; at += (uint32_t)strcspn(r->text + at, "\n")) {
        const char *line = r->text + ++at;
        if (is_blank_line(line))
            continue;
        if (strspn(line, " \t") <= o->indent)
            break;
        end = at + (uint32_t)strcspn(line, "\n");
    }
    return end;
}

bool parser_find_unclosed(const struct parser *p, struct missing *found)
{
    struct reading r = {.parser = p, .text = p->source->text, .n = p->source->n};
    r.line_begins = true;
    r.indent = (uint32_t)strspn(r.text, " \t");
    read_braces(&r);
    bool any = r.open.n > 0;
    if (any) {
        const struct opening *o = &r.open.at[r.open.n - 1];
        uint32_t base = p->source->base;
        *found = (struct missing){{base + o->at, base + o->at + 1}, base + end_of_body(&r, o)};
    }
    vec_free(&r.open);
    return any;
}

int parser_missing_token(struct parser *p, uint32_t begin)
{
    if (p->missing_next == p->missing_count || p->missing[p->missing_next].place > begin)
        return 0;
    const struct missing *m = &p->missing[p->missing_next++];
    struct span place = {m->place, m->place};
    struct diag_entry *e = diag_report(p->diag, DIAG_SYNTAX, place, "expected '}'");
    diag_label(e, m->opening, "this is not closed");
    diag_fix(e, place, DIAG_FIX_MAYBE, " }");
    parser_unnest(p, '{', m->place);
    return TOKEN_RBRACE;
}
