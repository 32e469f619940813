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
    AST_INCLUDE,   /* include "a.wrt"          children: the string */
    AST_LET,       /* let a = v                name: a; children: v */
    AST_PARAM,     /* param a = v              name: a; children: v */
    AST_MATERIAL,  /* material a = v           name: a; children: v */
    AST_TEXTURE,   /* texture a = v            name: a; children: v */
    AST_FN,        /* fn f(a, b = 1) = v       name: f; children: parameters, v */
    AST_DEFINE,    /* define d(a) { ... }      name: d; children: parameters, body */
    AST_DEFAULT,   /* default light point { }  name: light; label: point; children: members */
    AST_ASSERT,    /* assert c, "m"            children: c, m */
    AST_FOR,       /* for i in s { ... }       name: i; children: s, body */
    AST_IF,        /* if c { } else { }        children: c, body, perhaps another body or AST_IF */
    AST_USE,       /* chair(a, b = 1) { ... }  name: chair; children: arguments, perhaps a body */
    AST_BLOCK,     /* sphere ball { ... }      name: sphere; label: ball; children: members */
                   /* <surface class="Sphere"> name: surface; children: attributes, members */
    AST_PROPERTY,  /* radius: v                name: radius; children: v; or none and text: v, */
                   /*                          when v is a plain number or vector: see ast_value */
                   /* <radius>1</radius>       name: radius; children: one AST_TEXT */
    AST_ATTRIBUTE, /* class="Sphere"           name: class; children: one AST_TEXT */

    /* Parts of statements and values. */
    AST_BODY,      /* { ... }                  children: members */
    AST_LABEL,     /* lamp                     name; first child of `light point lamp { ... }` */
    AST_PARAMETER, /* a, b = 1                 name; children: the default, if there is one */
    AST_ARGUMENT,  /* b = 1                    name; children: the value; one without a name is */
                   /*                          the value itself */
    AST_MEMBER,    /* .x                       name: x */
    AST_INDEX,     /* [i]                      children: i */

    /* Values. */
    AST_NUMBER,        /* 1.5                  number */
    AST_ANGLE,         /* 54deg, 1rad          number as spelt; unit */
    AST_STRING,        /* "wood.png"           text: escapes undone */
    AST_BOOL,          /* true                 boolean */
    AST_COLOUR,        /* #c7b852              rgb: the six digits */
    AST_NAME,          /* gold                 name */
    AST_VECTOR,        /* (x, y, z)            children: components */
    AST_LIST,          /* [a, b]               children: items */
    AST_COMPREHENSION, /* [v for i in s]       name: i; children: v, s */
    AST_CONSTRUCT,     /* gold { ... }         name: gold; children: members */
    AST_CALL,          /* f(a, b = 1)          name: f; children: arguments */
    AST_SELECT,        /* v[1].x               children: v, then AST_MEMBERs and AST_INDEXes */
    AST_PREFIX,        /* -v, +v, !v           children: v, with its operator */
    AST_CHAIN,         /* a + b - c            children: operands, all but the first with the */
                       /*                      operator before them; all of one precedence */
    AST_CONDITIONAL,   /* c ? a : b            children: c, a, b */
    AST_PARENTHESES,   /* (v)                  children: v */
    AST_TEXT,          /* XML character data   text: entities undone; exact: spelt like that */
    AST_KINDS
};

enum ast_unit { AST_DEGREES, AST_RADIANS };

enum ast_operator {
    AST_NO_OPERATOR,
    AST_OR,
    AST_AND,
    AST_EQUAL,
    AST_NOT_EQUAL,
    AST_LESS,
    AST_LESS_EQUAL,
    AST_GREATER,
    AST_GREATER_EQUAL,
    AST_ADD,
    AST_SUBTRACT,
    AST_MULTIPLY,
    AST_DIVIDE,
    AST_MODULO,
    AST_POWER,
    AST_PLUS,
    AST_NEGATE,
    AST_NOT,
    AST_OPERATORS
};

struct ast_operator_row {
    const char *text; /* as written */
    int level;        /* how tightly it binds; the operators of a chain share theirs */
};
extern const struct ast_operator_row ast_operators[AST_OPERATORS];

struct ast_node {
    struct ast_node *next;     /* the next sibling */
    struct ast_node *children; /* the first child */
    struct span span;          /* the whole node */
    struct span name_span;     /* its name, or for a block without one its opening */
    struct str name;           /* borrowed from the source text */
    union {
        struct str label; /* AST_BLOCK, AST_DEFAULT: borrowed; empty without one */
        double number;
        struct str text;
        bool boolean;
        uint32_t rgb;
        struct ast_node *last; /* AST_CHAIN, AST_SELECT: the last child */
    };
    uint8_t kind;     /* enum ast_kind */
    uint8_t unit;     /* AST_ANGLE: enum ast_unit */
    uint8_t operator; /* enum ast_operator: the one written before it, in a chain or a prefix */
    bool exact;       /* AST_TEXT: the span's bytes are the text */
    bool xml;         /* AST_BLOCK, AST_PROPERTY: an XML element */
};

/* Comments, in file order; a printer finds by their spans what they stand before, in or after. */
enum trivia_kind { TRIVIA_LINE_COMMENT, TRIVIA_BLOCK_COMMENT, TRIVIA_PI };

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

/* left operator right: a longer chain when left is one of the same level, so that no length of it
 * nests. */
struct ast_node *ast_chain(struct ast *a, struct span span, struct ast_node *left,
                           enum ast_operator operator, struct ast_node * right);
struct ast_node *ast_prefix(struct ast *a, struct span span, enum ast_operator operator,
                            struct ast_node * operand);
/* A base and its AST_MEMBER or AST_INDEX: one more when the base is an AST_SELECT. */
struct ast_node *ast_select(struct ast *a, struct span span, struct ast_node *base,
                            struct ast_node *selector);

struct ast_list ast_pair(struct ast_node *first, struct ast_node *second);
struct ast_list ast_append(struct ast_list list, struct ast_node *node);
/* Appends an AST_ERROR, or widens the one at the end. */
struct ast_list ast_append_error(struct ast *a, struct ast_list list, struct span span);
/* a, then b. */
struct ast_list ast_concat(struct ast_list a, struct ast_list b);

/* The value of a native property.  A plain one, a number or a vector of numbers, is kept as text,
 * since large scenes hold little else; its nodes are made here, in the caller's memory. */
const struct ast_node *ast_value(const struct ast_node *property, struct arena *memory);
/* Its numbers without nodes, and how many: 1, or 2 or 3 of a vector; 0 when it is not plain. */
unsigned ast_plain_value(const struct ast_node *property, double numbers[3]);
struct span ast_value_span(const struct ast_node *property);

size_t ast_count(const struct ast_node *first);

/* The number of the first comment that begins there or later. */
size_t ast_trivia_from(const struct ast *ast, uint32_t at);

/* True when some of the node did not parse: what follows may belong to it. */
bool ast_is_damaged(const struct ast_node *node);

#endif
