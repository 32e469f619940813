/* AST to description. */
#ifndef WRT_EVAL_EVAL_H
#define WRT_EVAL_EVAL_H

#include "ast/ast.h"
#include "diag/diag.h"
#include "eval/desc.h"

/* `-D name=value`: overrides the param of that name.  `value` is an expression's node, or a string
 * node when the text is none. */
struct eval_define {
    struct str name;
    const struct ast_node *value;
    bool optional; /* the scene need not have it */
};

struct eval_options {
    const struct eval_define *defines;
    size_t define_count;
    size_t max_objects;     /* surfaces and lights; likewise materials, textures, items of a list */
    struct srcmap *sources; /* takes the texts of included files */
    const char *const *folders; /* where includes are looked for after the includer's own folder */
    size_t folder_count;
};

/* Evaluates into *out (initialised here; free with desc_free even after errors).  True when there
 * were no errors. */
bool eval_scene(const struct ast *ast, const struct eval_options *options, struct desc *out,
                struct diag *diag);

#endif
