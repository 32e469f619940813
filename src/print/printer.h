/* A tree back to text, in canonical layout: the same tokens in the same order and spelling, the
 * same comments between them. */
#ifndef WRT_PRINT_PRINTER_H
#define WRT_PRINT_PRINTER_H

#include "ast/ast.h"
#include "base/buffer.h"

/* The tree of a text that parsed without errors, in its own format. */
void print_scene(const struct ast *ast, struct buffer *out);

#endif
