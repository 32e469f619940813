/* What lies between two tokens of a text: white space, comments, separators without meaning. */
#ifndef WRT_PRINT_GAP_H
#define WRT_PRINT_GAP_H

#include "ast/ast.h"

/* A place in a text that moves from token to token. */
struct gap {
    const struct ast *ast;
    uint32_t at;            /* offset of the next unread byte */
    size_t comment;         /* the first of ast->trivia not before it */
    const char *separators; /* bytes passed over like blanks */
    unsigned newlines;      /* in a row since the last comment or token: two make a blank line */
};

/* Comments that stand on one line. */
struct gap_unit {
    size_t first, n;   /* in ast->trivia */
    unsigned newlines; /* before it, since the token or unit before */
    bool ends_line;    /* nothing but comments follows on its line */
};

/* At the start of a token or behind its end. */
struct gap gap_at(const struct ast *ast, uint32_t offset);

/* The next comments before the next token; false when there are none, then g->at is the token. */
bool gap_next(struct gap *g, struct gap_unit *out);

/* Goes behind a token, and behind any comments within it. */
void gap_move(struct gap *g, uint32_t to);

/* True when a blank line stands before a place. */
bool gap_blank_before(const struct ast *ast, uint32_t offset);

/* Where the content of an XML element begins: behind the `>` that follows its name or attributes. */
uint32_t gap_content(const struct ast *ast, const struct ast_node *element);

/* The column a place stands in, in code points from 0. */
unsigned gap_column(const struct ast *ast, uint32_t offset);

#endif
