/* Members that the scanner takes whole, against the same members token by token. */
#ifndef WRT_TESTS_APART_H
#define WRT_TESTS_APART_H

#include "../unit/load.h"
#include "base/buffer.h"

/* Changes a few places of a text so that it may be wrong. */
void damage(uint64_t seed, struct buffer *text);

/* The text with room behind each colon: blanks, or a comment that keeps the scanner from seeing
 * more than a name.  Both are of the same length. */
void put_colons(struct str text, bool comments, struct buffer *out);

/* As far as a text goes: mistakes do not end it. */
void read_all(struct load *l, const char *text);

/* True when both say the same of the same places, in the tree, in the description and in what was
 * reported. */
bool same_reading(const struct load *a, const struct load *b);

/* The same trees, but for where things stand. */
bool same_trees(const struct load *la, const struct ast_node *a, const struct load *lb,
                const struct ast_node *b);

#endif
