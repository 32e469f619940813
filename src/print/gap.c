#include "config.h"

#include "print/gap.h"

static uint32_t text_end(const struct ast *ast)
{
    return ast->source->base + ast->source->n;
}

static char byte_at(const struct ast *ast, uint32_t offset)
{
    return ast->source->text[offset - ast->source->base];
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

struct gap gap_at(const struct ast *ast, uint32_t offset)
{
    return (struct gap){
        .ast = ast, .at = offset, .comment = ast_trivia_from(ast, offset), .separators = ""};
}

static void skip_blanks(struct gap *g)
{
    unsigned run = g->newlines;
    for (; g->at < text_end(g->ast); g->at++) {
        char c = byte_at(g->ast, g->at);
        bool blank = is_blank(c);
        if (!blank && !memchr(g->separators, c, strlen(g->separators)))
            break;
        run = blank ? run + (c == '\n') : 0;
        g->newlines = run > g->newlines ? run : g->newlines;
    }
}

/* The comment that begins here, if one does. */
static const struct trivia *comment_here(const struct gap *g)
{
    const struct ast *ast = g->ast;
    bool here = g->comment < ast->trivia.n && ast->trivia.at[g->comment].span.begin == g->at;
    return here ? &ast->trivia.at[g->comment] : NULL;
}

bool gap_next(struct gap *g, struct gap_unit *out)
{
    skip_blanks(g);
    *out = (struct gap_unit){.first = g->comment, .newlines = g->newlines};
    const struct trivia *c = comment_here(g);
    for (; c; c = g->newlines ? NULL : comment_here(g)) {
        g->at = c->span.end;
        g->comment++;
        g->newlines = 0;
        skip_blanks(g);
    }
    out->n = g->comment - out->first;
    out->ends_line = g->newlines > 0 || g->at == text_end(g->ast);
    return out->n > 0;
}

void gap_move(struct gap *g, uint32_t to)
{
    const struct ast *ast = g->ast;
    g->at = to;
    g->newlines = 0;
    while (g->comment < ast->trivia.n && ast->trivia.at[g->comment].span.begin < to)
        g->comment++;
}

bool gap_blank_before(const struct ast *ast, uint32_t offset)
{
    unsigned newlines = 0;
    for (; offset > ast->source->base && is_blank(byte_at(ast, offset - 1)); offset--)
        newlines += byte_at(ast, offset - 1) == '\n';
    return newlines > 1;
}

uint32_t gap_content(const struct ast *ast, const struct ast_node *element)
{
    uint32_t at = element->name_span.end;
    for (const struct ast_node *c = element->children; c && c->kind == AST_ATTRIBUTE; c = c->next)
        at = c->span.end;
    while (byte_at(ast, at) != '>')
        at++;
    return at + 1;
}

unsigned gap_column(const struct ast *ast, uint32_t offset)
{
    unsigned column = 0;
    for (uint32_t at = offset; at > ast->source->base && byte_at(ast, at - 1) != '\n'; at--)
        column += (byte_at(ast, at - 1) & 0xC0) != 0x80;
    return column;
}
