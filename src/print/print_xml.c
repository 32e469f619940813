/* The XML format in canonical layout: an element a line, leaves with their text. */
#include "config.h"

#include "print/printing.h"

#include "base/num.h"

static const struct joint line = {.kind = JOINT_LINE, .blank = true};

static char byte_at(const struct printing *p, uint32_t offset)
{
    return p->ast->source->text[offset - p->ast->source->base];
}

/* Where the closing tag of an element begins; its end for one that has none. */
static uint32_t closing_tag(const struct printing *p, const struct ast_node *n)
{
    uint32_t at = n->span.end - 1;
    if (byte_at(p, at - 1) == '/')
        return n->span.end;
    while (byte_at(p, at) != '<')
        at--;
    return at;
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/* Numbers with single spaces between them; anything else as it is. */
static void put_content(struct buffer *out, struct str text)
{
    size_t start = out->n;
    const char *at = text.at, *end = text.at + text.n;
    while (at < end) {
        double x;
        const char *after = num_parse(at, end, &x);
        if (!after || (after < end && !is_space(*after))) {
            out->n = start;
            buffer_str(out, text);
            return;
        }
        if (out->n > start)
            buffer_puts(out, " ");
        buffer_str(out, (struct str){at, (size_t)(after - at)});
        for (at = after; at < end && is_space(*at); at++)
            ;
    }
}

static void put_start(struct printing *p, struct buffer *out, const struct ast_node *n)
{
    buffer_printf(out, "<%.*s", STR_ARG(n->name));
    for (const struct ast_node *a = n->children; a && a->kind == AST_ATTRIBUTE; a = a->next) {
        struct span value = a->children->span;
        buffer_printf(out, " %.*s=", STR_ARG(a->name));
        buffer_str(out, print_source(p, value.begin, value.end));
    }
}

/* What was built, kept until it is written. */
static struct str keep(struct printing *p, struct buffer *text)
{
    const char *copy = arena_copy(&p->texts, text->at, text->n);
    struct str kept = {copy, text->n};
    buffer_free(text);
    return kept;
}

/* An element with its text, or with nothing inside. */
static void print_leaf(struct printing *p, const struct ast_node *n)
{
    struct buffer text = {0};
    uint32_t begin = gap_content(p->ast, n), end = closing_tag(p, n);
    struct str content = begin < end ? str_trim(print_source(p, begin, end)) : (struct str){0};
    put_start(p, &text, n);
    if (content.n) {
        buffer_puts(&text, ">");
        put_content(&text, content);
        buffer_printf(&text, "</%.*s>", STR_ARG(n->name));
    } else {
        buffer_puts(&text, "/>");
    }
    print_as(p, n->span.end, keep(p, &text));
}

static bool holds_comment(const struct printing *p, const struct ast_node *n)
{
    struct gap g = p->gap;
    gap_move(&g, n->span.begin);
    return g.comment < p->ast->trivia.n && p->ast->trivia.at[g.comment].span.begin < n->span.end;
}

static bool is_element(const struct ast_node *n)
{
    return n->kind == AST_BLOCK || n->kind == AST_PROPERTY;
}

static bool holds_text(const struct ast_node *n)
{
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (c->kind == AST_TEXT && c->text.n)
            return true;
    return false;
}

static bool holds_element(const struct ast_node *n)
{
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (is_element(c))
            return true;
    return false;
}

static void print_element(struct printing *p, const struct ast_node *n)
{
    struct buffer text = {0};
    print_joint(p, line);
    if (holds_text(n) || (!holds_element(n) && !holds_comment(p, n))) {
        print_leaf(p, n);
        print_flush(p);
        return;
    }
    put_start(p, &text, n);
    buffer_puts(&text, ">");
    print_as(p, gap_content(p->ast, n), keep(p, &text));
    layout_indent(&p->layout, LAYOUT_INDENT);
    p->opened = true;
    print_flush(p);
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (is_element(c))
            print_element(p, c);
    print_joint(p,
                (struct joint){
                    .kind = JOINT_LINE, .blank = true, .closing = true, .outdent = LAYOUT_INDENT});
    buffer_printf(&text, "</%.*s>", STR_ARG(n->name));
    print_as(p, n->span.end, keep(p, &text));
    print_flush(p);
}

void print_xml(struct printing *p)
{
    print_element(p, p->ast->statements);
    print_joint(p, (struct joint){0});
    print_end(p);
}
