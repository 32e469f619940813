/* The tree as written: one for both formats, with a span on every node and the trivia beside it.
 * Immutable after parsing.
 *
 * An XML element becomes the node its native twin would have: a leaf is a property whose value is
 * its text, anything else a block.  Names stay as spelt; src/eval looks them up in the schema. */
#ifndef WRT_AST_AST_H
#define WRT_AST_AST_H

#include "base/arena.h"
#include "base/srcmap.h"
#include "base/str.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

enum ast_kind {
    AST_ERROR, /* stands for text that did not parse; later stages pass it in silence */

    /* Statements.  `name` is the word at the left, `children` what they hold. */
    AST_VERSION,   /* wrt 1                    value: the number */
    AST_MODEL,     /* model classic            name: the model */
    AST_LET,       /* let a = v                name: a; children: v */
    AST_PARAM,     /* param a = v              name: a; children: v */
    AST_MATERIAL,  /* material a = v           name: a; children: v */
    AST_TEXTURE,   /* texture a = v            name: a; children: v */
    AST_BLOCK,     /* sphere ball { ... }      name: sphere; label: ball; children: members */
                   /* <surface class="Sphere"> name: surface; children: attributes, members */
    AST_PROPERTY,  /* radius: v                name: radius; children: v */
                   /* <radius>1</radius>       name: radius; children: one AST_TEXT */
    AST_ATTRIBUTE, /* class="Sphere"           name: class; children: one AST_TEXT */

    /* Values. */
    AST_NUMBER,    /* 1.5                      number */
    AST_ANGLE,     /* 54deg, 1rad              number as spelt; unit */
    AST_STRING,    /* "wood.png"               text: escapes undone */
    AST_BOOL,      /* true                     boolean */
    AST_COLOUR,    /* #c7b852                  rgb: the six digits */
    AST_NAME,      /* gold                     name */
    AST_VECTOR,    /* (x, y, z)                children: components */
    AST_LIST,      /* [a, b]                   children: items */
    AST_CONSTRUCT, /* gold { ... }             name: gold; children: members */
    AST_NEGATE,    /* -v                       children: v */
    AST_TEXT,      /* XML character data       text: entities undone; exact: spelt like that */
};

enum ast_unit { AST_DEGREES, AST_RADIANS };

struct ast_node {
    struct ast_node *next;     /* the next sibling */
    struct ast_node *children; /* the first child */
    struct span span;          /* the whole node */
    struct span name_span;     /* its name, or for a block without one its opening */
    struct str name;           /* borrowed from the source text */
    union {
        struct str label; /* AST_BLOCK: borrowed; empty without one */
        double number;
        struct str text;
        bool boolean;
        uint32_t rgb;
    };
    uint8_t kind; /* enum ast_kind */
    uint8_t unit; /* AST_ANGLE: enum ast_unit */
    bool exact;   /* AST_TEXT: the span's bytes are the text */
    bool xml;     /* AST_BLOCK, AST_PROPERTY: an XML element */
};

/* Comments and blank lines, in file order; a printer finds by their spans what they stand before,
 * in or after. */
enum trivia_kind { TRIVIA_LINE_COMMENT, TRIVIA_BLOCK_COMMENT, TRIVIA_BLANK_LINE, TRIVIA_PI };

struct trivia {
    struct span span;
    uint32_t kind; /* enum trivia_kind */
};

struct ast {
    struct arena arena;
    const struct source *source; /* borrowed */
    bool xml;
    struct ast_node *statements; /* XML: the root element */
    VEC(struct trivia) trivia;
    size_t nodes; /* made so far */
};

/* A list under construction. */
struct ast_list {
    struct ast_node *first, *last;
};

void ast_init(struct ast *a, const struct source *source, bool xml);
void ast_free(struct ast *a);

struct ast_node *ast_node(struct ast *a, enum ast_kind kind, struct span span);
struct ast_node *ast_named(struct ast *a, enum ast_kind kind, struct span span, struct str name,
                           struct span name_span);
struct ast_node *ast_number(struct ast *a, struct span span, double number);
struct ast_node *ast_text(struct ast *a, enum ast_kind kind, struct span span, struct str text);

/* A node with one child. */
struct ast_node *ast_with(struct ast_node *parent, struct ast_node *child);
struct ast_node *ast_holding(struct ast_node *parent, struct ast_list children);

struct ast_list ast_append(struct ast_list list, struct ast_node *node);
/* Appends an AST_ERROR, or widens the one at the end. */
struct ast_list ast_append_error(struct ast *a, struct ast_list list, struct span span);
/* a, then b. */
struct ast_list ast_concat(struct ast_list a, struct ast_list b);

size_t ast_count(const struct ast_node *first);

#endif
