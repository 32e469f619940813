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

struct gap gap_at_start(const struct ast *ast)
{
    return (struct gap){.ast = ast, .at = ast->source->base, .separators = ""};
}

static void skip_blanks(struct gap *g)
{
    unsigned run = g->newlines;
    for (; g->at < text_end(g->ast); g->at++) {
        char c = byte_at(g->ast, g->at);
        bool blank = c == ' ' || c == '\t' || c == '\r' || c == '\n';
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

unsigned gap_column(const struct ast *ast, uint32_t offset)
{
    unsigned column = 0;
    for (uint32_t at = offset; at > ast->source->base && byte_at(ast, at - 1) != '\n'; at--)
        column += (byte_at(ast, at - 1) & 0xC0) != 0x80;
    return column;
}
