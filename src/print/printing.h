/* What the printers of both formats share (internal to src/print): the tree says which token comes
 * next, the text between it and the token before which comments stand there. */
#ifndef WRT_PRINT_PRINTING_H
#define WRT_PRINT_PRINTING_H

#include "print/gap.h"
#include "print/layout.h"
#include "print/printer.h"

enum joint_kind { JOINT_NONE, JOINT_SPACE, JOINT_BREAK, JOINT_LINE };

/* How the next token is joined to the one before. */
struct joint {
    enum joint_kind kind;
    unsigned width;         /* JOINT_BREAK: spaces on one line */
    bool fill;              /* JOINT_BREAK: see struct layout_break */
    bool blank;             /* a blank line may stay */
    bool closing;           /* the token ends what it stands in */
    int outdent;            /* closing: by how much the indentation shrinks */
    const char *separators; /* left out before it; NULL: none */
};

struct printing {
    const struct ast *ast;
    struct gap gap;
    struct layout layout;
    struct arena texts; /* texts that differ from their spelling, nodes of plain values */
    struct joint joint;
    bool opened;         /* the last token opened what follows: no blank line */
    unsigned groups_due; /* begin with the next token */
    bool block_due;
};

/* Sets how the next token is joined; it is not, unless said. */
void print_joint(struct printing *p, struct joint joint);

/* A group of the layout begins with the next token; it ends with layout_close. */
void print_group(struct printing *p, bool block);

/* The next n bytes of the text are a token. */
void print_token(struct printing *p, size_t n);
/* The next token, known to be this word. */
void print_word(struct printing *p, const char *word);
/* A token of n bytes that opens what follows, up to a closing one. */
void print_open(struct printing *p, size_t n);
/* The next token ends at `end`. */
void print_to(struct printing *p, uint32_t end);
/* The next token ends at `end` and is written as `text`. */
void print_as(struct printing *p, uint32_t end, struct str text);
/* The comments at the end of the text. */
void print_end(struct printing *p);

/* What was handed over so far; no group may be open. */
void print_flush(struct printing *p);

struct str print_source(const struct printing *p, uint32_t begin, uint32_t end);

void print_native(struct printing *p);
void print_xml(struct printing *p);

#endif
