#include "config.h"

#include "print/printing.h"

#include <assert.h>

struct str print_source(const struct printing *p, uint32_t begin, uint32_t end)
{
    const struct source *s = p->ast->source;
    return (struct str){s->text + (begin - s->base), end - begin};
}

void print_joint(struct printing *p, struct joint joint)
{
    p->joint = joint;
}

/* ---- comments ---- */

/* Texts are written as UTF-8, whatever they were read from. */
static struct str declaration(struct str text)
{
    static const char utf8[] = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>";
    bool declares = text.n > 6 && memcmp(text.at, "<?xml", 5) == 0 && strchr(" \t\r\n", text.at[5]);
    return declares ? str_of(utf8) : text;
}

static void put_unit(struct printing *p, const struct gap_unit *u)
{
    for (size_t i = 0; i < u->n; i++) {
        const struct trivia *c = &p->ast->trivia.at[u->first + i];
        struct str text = print_source(p, c->span.begin, c->span.end);
        if (c->kind == TRIVIA_PI)
            text = declaration(text);
        if (i > 0)
            layout_text(&p->layout, str_of(" "));
        layout_comment(&p->layout, text,
                       memchr(text.at, '\n', text.n) ? gap_column(p->ast, c->span.begin) : 0);
    }
    layout_break_blocks(&p->layout);
}

enum { CONTINUATION = 2 }; /* spaces before the rest of what a comment interrupts */

static void put_line(struct printing *p, bool blank)
{
    bool inside = p->joint.kind == JOINT_NONE || p->joint.kind == JOINT_SPACE;
    layout_line(&p->layout, blank, inside ? CONTINUATION : 0);
}

static void put_joint(struct printing *p, bool blank)
{
    const struct joint *j = &p->joint;
    if (j->kind == JOINT_SPACE)
        layout_text(&p->layout, str_of(" "));
    else if (j->kind == JOINT_BREAK)
        layout_break(&p->layout, (struct layout_break){j->width, j->fill, blank});
    else if (j->kind == JOINT_LINE)
        layout_line(&p->layout, blank, 0);
}

/* A comment between two tokens of a line. */
static void put_inline(struct printing *p, const struct gap_unit *u, bool line_due, bool blank)
{
    struct joint *j = &p->joint;
    bool glued = j->kind == JOINT_NONE || j->closing;
    if (line_due)
        put_line(p, blank);
    else if (!glued)
        put_joint(p, blank);
    else if (!p->opened)
        layout_text(&p->layout, str_of(" "));
    put_unit(p, u);
    if (j->closing)
        return;
    *j = (struct joint){.kind = glued && !p->opened ? JOINT_NONE : JOINT_SPACE};
}

static void open_groups(struct printing *p)
{
    for (; p->groups_due; p->groups_due--)
        layout_open(&p->layout, false);
    if (p->block_due)
        layout_open(&p->layout, true);
    p->block_due = false;
}

/* Puts the comments before the next token, each where it stood: behind the token before, on lines
 * of their own, or before the next token on its line. */
static void put_comments(struct printing *p)
{
    struct gap_unit u;
    struct joint *j = &p->joint;
    bool line_due = false, behind = p->gap.at != p->ast->source->base;
    p->gap.separators = j->separators ? j->separators : "";
    for (; gap_next(&p->gap, &u); behind = p->opened = false) {
        bool blank = j->blank && u.newlines > 1 && !p->opened;
        bool own_line = u.ends_line || (j->closing && (u.newlines > 0 || p->opened));
        if (own_line && behind && u.ends_line && u.newlines == 0)
            layout_text(&p->layout, str_of(" "));
        else if (own_line)
            put_line(p, blank);
        else
            put_inline(p, &u, line_due, blank);
        if (own_line)
            put_unit(p, &u);
        line_due = own_line;
    }
    bool blank = j->blank && p->gap.newlines > 1 && !p->opened && !j->closing;
    layout_indent(&p->layout, -j->outdent);
    if (line_due)
        put_line(p, blank);
    else
        put_joint(p, blank);
    open_groups(p);
}

/* ---- tokens ---- */

void print_group(struct printing *p, bool block)
{
    if (block)
        p->block_due = true;
    else
        p->groups_due++;
}

static void put_token(struct printing *p, uint32_t end, struct str text)
{
    layout_text(&p->layout, text);
    gap_move(&p->gap, end);
    p->joint = (struct joint){0};
    p->opened = false;
}

void print_token(struct printing *p, size_t n)
{
    put_comments(p);
    uint32_t begin = p->gap.at, end = begin + (uint32_t)n;
    put_token(p, end, print_source(p, begin, end));
}

void print_as(struct printing *p, uint32_t end, struct str text)
{
    put_comments(p);
    put_token(p, end, text);
}

void print_to(struct printing *p, uint32_t end)
{
    put_comments(p);
    put_token(p, end, print_source(p, p->gap.at, end));
}

void print_word(struct printing *p, const char *word)
{
    print_token(p, strlen(word));
}

void print_open(struct printing *p, size_t n)
{
    print_token(p, n);
    layout_indent(&p->layout, LAYOUT_INDENT);
    p->opened = true;
}

void print_end(struct printing *p)
{
    p->joint.kind = JOINT_LINE;
    p->joint.blank = p->joint.closing = true;
    put_comments(p);
}

void print_flush(struct printing *p)
{
    layout_flush(&p->layout);
    arena_free(&p->texts);
}

void print_scene(const struct ast *ast, struct buffer *out)
{
    struct printing p = {.ast = ast, .gap = gap_at(ast, ast->source->base), .layout = {.out = out}};
    (ast->xml ? print_xml : print_native)(&p);
    print_flush(&p);
    layout_free(&p.layout);
}
