/* What the grammar, the two scanners and their helpers share while one text is parsed (internal to
 * src/syntax and grammar/). */
#ifndef WRT_SYNTAX_PARSER_H
#define WRT_SYNTAX_PARSER_H

#include "ast/ast.h"
#include "diag/diag.h"

/* Brackets, blocks and elements may nest this deep. */
enum { NESTING_LIMIT = 256 };

/* Nodes of one text's tree: bounds its memory (some 5 GB). */
enum { NODE_LIMIT = 1 << 26 };

/* The content of an element while it is read: its children and the pieces of its text. */
struct xml_content {
    struct ast_list children, text;
};

struct open_element {
    struct str name;
    struct span span;  /* `<` and the name */
    uint32_t text_end; /* of its own text; 0: none came yet */
    bool holds_elements;
};

/* The last two native tokens. */
struct trail {
    int before, last;
};

/* Native: a closing brace that the text lacks, as its indentation tells. */
struct missing {
    struct span opening;
    uint32_t place; /* where it belongs */
};

enum { MISSING_LIMIT = 16 };

/* A token that was scanned, but waits. */
struct held {
    int token;
    struct str text;
    struct span span;
};

struct parser {
    struct ast *ast;
    struct diag *diag;
    const struct source *source;
    void *scanner;          /* flex's yyscan_t */
    uint32_t at;            /* offset of the next unread byte */
    int start;              /* the token that chooses what is parsed; 0 once it was given */
    bool stopped;           /* a limit was hit: the end is feigned, errors are silent */
    struct span previous;   /* the token before the one under way */
    struct span now;        /* the one under way */
    uint32_t comment_begin; /* of the comment, string or section being scanned */

    struct ast_list version;               /* native: `wrt 1` */
    struct span brackets[NESTING_LIMIT];   /* native: the open ones */
    unsigned depth;                        /* native: how many */
    bool member_due;                       /* native: a member of a block may begin */
    struct trail trail;                    /* native */
    struct missing missing[MISSING_LIMIT]; /* native: by place, as far as they are known */
    unsigned missing_count, missing_next;
    struct held held[2];   /* tokens to give next, the last one first */
    unsigned held_count;   /* XML: one at most */
    uint32_t astray;       /* native: where the last syntax error was; 0: none yet */
    uint32_t resumed;      /* native: where reading went on behind it; 0: nowhere yet */
    unsigned since;        /* native: tokens read since */
    uint32_t unmatched;    /* native: the last bracket that closes nothing */
    uint32_t bracket_at;   /* native: the last bracket */
    unsigned depth_before; /* native: how many were open before it */
    bool unsure;           /* native: reading went on at what may belong to the lost text */

    struct ast_node *no_text;      /* XML: the text of all empty leaves; NULL: none yet */
    VEC(struct open_element) open; /* XML: elements not yet closed */
    struct str unclosed;           /* XML: the last element told not to be closed */
    size_t closes_due;             /* XML: closing tags to feign */
    uint32_t lost_in;  /* XML: a tag was damaged where so many elements were open; 0: none */
    bool tag_end_due;  /* XML: a `>` to feign */
    bool tag_end_lost; /* XML: a `>` to pass over */
    bool behind_tag;   /* XML: no text came since the last tag */
    bool feigned;      /* XML: the token stands for one whose absence was reported */
};

/* ---- tokens.c: for both scanners ---- */

/* The span of the token that takes the next `length` bytes, and advances over it. */
static inline struct span parser_token(struct parser *p, size_t length)
{
    struct span span = {p->at, p->at + (uint32_t)length};
    p->at = span.end;
    return span;
}
/* Gives back the last n bytes. */
void parser_untake(struct parser *p, size_t n);
void parser_trivia(struct parser *p, enum trivia_kind kind, struct span span);

/* The place of a text without the blanks around it, which lies at `span`. */
struct span span_of_trimmed(struct span span, struct str text);

/* Reports and ends the reading: what follows would only add noise or cost. */
void parser_stop(struct parser *p, enum diag_code code, struct span span, const char *message);

/* Native brackets; parser_nest is false when they are nested too deeply. */
bool parser_nest(struct parser *p, struct span span);
void parser_unnest(struct parser *p, char opening, uint32_t at);
/* The kind of the innermost open bracket; 0: none is open. */
char parser_bracket(const struct parser *p);
/* Gives the token again. */
void parser_hold(struct parser *p, int token, struct str text, struct span span);

/* ---- members.c: members that are one token ---- */

/* True when a member may begin behind this token. */
bool parser_member_follows(const struct parser *p, int token);
/* The span holds `name: ` and the first byte of a value.  When the value is plain, the span becomes
 * the whole member's and *text what it spells; the result is how many bytes to take, those with the
 * blanks behind it.  0: the value may be more than a number or a vector of them. */
size_t parser_plain_member(struct parser *p, struct span *span, struct str *text);
struct ast_node *parser_member(struct parser *p, struct span span, struct str text);
/* `name: kind {` and the members in the braces. */
struct ast_node *parser_construct(struct parser *p, struct span span, struct str opening,
                                  struct ast_list members);

/* ---- build.c: grammar actions longer than a constructor ---- */

void parser_version(struct parser *p, struct span span, struct span number_span, struct str number);
struct ast_node *parser_number(struct parser *p, enum ast_kind kind, struct span span,
                               struct str spelling);
struct ast_node *parser_colour(struct parser *p, struct span span, struct str digits);
struct ast_node *parser_block(struct parser *p, enum ast_kind kind, struct span span,
                              struct str name, struct span name_span, struct str label,
                              struct ast_list members);
/* The string without its escapes; unknown ones are reported. */
struct str parser_unescape(struct parser *p, struct span span, struct str spelling);

struct xml_content xml_add_text(struct parser *p, struct xml_content c, struct span span,
                                struct str text);
struct ast_node *xml_element(struct parser *p, struct span span, struct str name,
                             struct span name_span, struct ast_list attributes,
                             struct xml_content content);
/* The text of a reference (`lt`, `#65`, `#x41`); empty after reporting an unknown one. */
struct str xml_reference(struct parser *p, struct str name, struct span span);
struct str xml_attribute_value(struct parser *p, struct span span, struct str spelling);

/* ---- balance.c: XML tags made a tree, whatever the text holds ---- */

/* Called with each XML token before the grammar sees it; may feign closing tags.  XML_SKIPPED: the
 * grammar does not see it. */
enum { XML_SKIPPED = -1 };
int xml_balance(struct parser *p, int token, struct span span, struct str name);
/* A tag was reported as damaged, so its counterpart may not fit. */
void xml_lose_tag(struct parser *p);
/* A closing tag to feign, if one is due. */
bool xml_close_due(struct parser *p);

/* ---- unclosed.c ---- */

/* A brace that is not closed, and where its closing one belongs, those already known counted; false
 * when all are. */
bool parser_find_unclosed(const struct parser *p, struct missing *found);
/* The token that a missing brace is, due before a token at `begin`; 0: none is.  Reports it. */
int parser_missing_token(struct parser *p, uint32_t begin);

/* ---- resume.c ---- */

/* Passes over what is lost behind a syntax error, which widens *lost; true when errors from here on
 * are others. */
bool parser_resume(struct parser *p, struct span *lost);

/* ---- slips.c: usual slips, told and mended ---- */

/* The token, or the one that was meant. */
int parser_mend_slip(struct parser *p, int token, struct span span, struct str text);
/* Remembers a token for the next ones. */
void parser_trail(struct parser *p, int token);
/* The `=` or `:` that `:=` stands for. */
int parser_walrus(struct parser *p, struct span span);
/* Bytes of a string without end, from its quote on: what closes a bracket is no part of it. */
size_t parser_endless_string(const char *at, size_t n);
/* The token of an angle whose unit stands apart; 0 where the word behind the number is a name. */
int parser_far_unit(struct parser *p, struct span span, struct str number);
void parser_single_quotes(struct parser *p, struct span span, struct str text);
void parser_degree_sign(struct parser *p, struct span span);
/* A number with a unit that is none. */
void parser_bad_number(struct parser *p, struct span span, struct str text);

/* ---- advice.c ---- */

/* Says how to write what was probably meant, beside the error at this token. */
void parser_advise(const struct parser *p, struct diag_entry *e, struct span span,
                   const char *const *expected, size_t n);

/* ---- mistakes.c: what both scanners and the grammar report ---- */

/* Names of tokens that an error may list. */
enum { EXPECTED_MOST = 64 };
void parser_syntax_error(struct parser *p, struct span span, const char *found, bool at_end,
                         const char *const *expected, size_t n);
bool parser_on_later_line(const struct parser *p, struct span found);
/* What began at p->comment_begin never ends; points at its first `mark` bytes. */
void parser_unterminated(struct parser *p, uint32_t mark, const char *message);
void parser_stray(struct parser *p, struct span span, struct str text);
/* A tag without its `>`, which belongs at `end`. */
void xml_unclosed_tag(struct parser *p, uint32_t end);
/* The same, unless the tag was told to be wrong already. */
void xml_damaged_tag(struct parser *p, uint32_t end);
/* `<\radius>` */
void xml_backward_tag(struct parser *p, struct span span);
void xml_nameless_tag(struct parser *p, struct span span);
void xml_declaration(struct parser *p, struct span span);
void xml_stray_less(struct parser *p, struct span span);
void xml_stray_ampersand(struct parser *p, struct span span);

#endif
