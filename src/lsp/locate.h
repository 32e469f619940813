/* What of a tree stands at a place, and which kind of the schema it makes. */
#ifndef WRT_LSP_LOCATE_H
#define WRT_LSP_LOCATE_H

#include "lsp/analysis.h"

/* The nodes around a place, outermost first; free with vec_free(&nodes). */
struct locate_path {
    VEC(const struct ast_node *) nodes;
};

void locate(struct locate_path *path, const struct ast *ast, uint32_t at);

/* The kind that node i of the path makes: a block, an element, a value; SCHEMA_KINDS: none. */
enum schema_kind locate_kind(const struct analysis *a, const struct locate_path *path, size_t i);

/* The kind that these words open: `sphere`, `light point`, `phong`; SCHEMA_KINDS: none. */
enum schema_kind locate_kind_by_words(struct str first, struct str second);

/* The kind that an XML element makes by its name, the name of the element around and its class, and
 * what group it belongs to; SCHEMA_KINDS, SCHEMA_GROUPS: none. */
enum schema_kind locate_kind_by_tags(struct str name, struct str around, struct str class);
enum schema_group locate_group_by_tags(struct str name, struct str around);

/* The kind of a material or texture that a definition gives, through those it is made from. */
enum schema_kind locate_kind_of_def(const struct bindings *b, size_t def);

/* The property of a kind as the text spells it, and what it is; SCHEMA_PROPS: none. */
enum schema_prop_id locate_prop(const struct analysis *a, enum schema_kind kind, struct str name);

static inline bool locate_touches(struct span span, uint32_t at)
{
    return at >= span.begin && at <= span.end;
}

#endif
