/* What a text says besides its layout, as one string to compare. */
#ifndef WRT_TESTS_EVENTS_H
#define WRT_TESTS_EVENTS_H

#include "ast/ast.h"
#include "base/buffer.h"

/* The elements of an XML text with their attributes, words and comments, in order.  Comments in a
 * leaf come before its words; names of the root and of items are the usual ones. */
void xml_events(const struct ast *ast, struct buffer *out);

/* The contents of a text's comments, sorted, without escapes: the same for both formats. */
void comment_events(const struct ast *ast, struct buffer *out);

#endif
