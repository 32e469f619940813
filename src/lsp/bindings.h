/* Which name in a text means which definition, told by the text alone: scopes are lexical. */
#ifndef WRT_LSP_BINDINGS_H
#define WRT_LSP_BINDINGS_H

#include "ast/ast.h"
#include "base/map.h"
#include "eval/desc.h"

#define BINDING_NONE SIZE_MAX

/* A name that is defined: by a statement, as a parameter, by a loop, as an XML id. */
struct name_def {
    struct str name;
    struct span span;            /* of the name */
    struct span seen;            /* the text of its scope */
    uint32_t from;               /* seen from here on; functions and templates see all of a scope */
    const struct ast_node *node; /* what defines it */
    bool foreign;                /* in a file that is included */
    size_t next;                 /* the one of the same name before it, or BINDING_NONE */
};

struct name_use {
    struct str name;
    struct span span;
    struct span function; /* the innermost function or template around; {0, 0}: none */
    size_t callee;        /* the name of an argument: the use that names its function */
    size_t def;           /* or BINDING_NONE */
};

struct bindings {
    VEC(struct name_def) defs;
    VEC(struct name_use) uses;
    struct map last; /* names to the last of their definitions: its number + 1 */
};

/* The trees are borrowed. */
void bindings_build(struct bindings *b, const struct ast *ast, const struct desc *desc);
void bindings_free(struct bindings *b);

/* The definition that a name at this place would mean, or BINDING_NONE. */
size_t bindings_find(const struct bindings *b, struct str name, uint32_t at, struct span function);

/* The innermost function or template around a place. */
struct span bindings_function(const struct bindings *b, uint32_t at);

/* The definition whose name or use stands at a place (its end counts), and where; BINDING_NONE. */
size_t bindings_at(const struct bindings *b, uint32_t at, struct span *place);

#endif
