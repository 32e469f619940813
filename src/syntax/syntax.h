/* Text to AST, both formats. */
#ifndef WRT_SYNTAX_SYNTAX_H
#define WRT_SYNTAX_SYNTAX_H

#include "ast/ast.h"
#include "base/buffer.h"
#include "diag/diag.h"

/* Checks that the text is text, in an encoding that is read, and makes it UTF-8 without a byte
 * order mark: *text and *n are replaced as needed, and *marked tells of the mark.  A problem is
 * described in *problem (its offset in the text as it then is); true when there is none. */
struct encoding_problem {
    enum diag_code code;
    size_t offset;
    char message[160];
};
bool syntax_decode(char **text, size_t *n, bool *marked, struct encoding_problem *problem);

/* The opposite: adds the bytes of a file with this text, in the encoding that the text declares. */
void syntax_encode(struct str text, bool marked, struct buffer *out);

/* The file's text, decoded, as a source; NULL after reporting.  A file that cannot be read is a
 * `code` at `span`. */
const struct source *syntax_load(struct srcmap *sources, const char *path, enum diag_code code,
                                 struct span span, struct diag *diag);

/* As syntax_load of a file whose bytes have been read: they become the source's, and have room for
 * two more. */
const struct source *syntax_take(struct srcmap *sources, const char *path, char *text, size_t n,
                                 enum diag_code code, struct span span, struct diag *diag);

/* True when the text is an XML document: its first character is `<`. */
bool syntax_is_xml(struct str text);

/* True for words that native text cannot have as names. */
bool syntax_is_keyword(struct str word);

/* Parses a source into *out (initialised here; free with ast_free even after errors).  All
 * independent errors are reported; true when there were none. */
bool syntax_parse(const struct source *source, struct ast *out, struct diag *diag);

/* Parses the value of a `-D`: out->statements is one expression, or a string node with the whole
 * text when it is no expression. */
void syntax_parse_value(const struct srcmap *sources, const struct source *source, struct ast *out);

#endif
