/* Comments that silence rules (used by syntax_parse). */
#ifndef WRT_SYNTAX_ALLOW_H
#define WRT_SYNTAX_ALLOW_H

#include "ast/ast.h"
#include "diag/diag.h"

void syntax_find_allows(const struct ast *ast, struct diag *diag);

#endif
