/* XML becoming native text (internal to src/convert). */
#ifndef WRT_CONVERT_TO_NATIVE_H
#define WRT_CONVERT_TO_NATIVE_H

#include "base/map.h"
#include "convert/comments.h"
#include "convert/names.h"
#include "convert/translating.h"

/* An element among its siblings, with its comments: those before it, and those behind it on its
 * line. */
struct member {
    const struct ast_node *node;
    size_t lead, leads, behind, behinds; /* runs of ast->trivia */
};

struct members {
    VEC(struct member) v;
    size_t tail, tails; /* comments before the closing tag */
};

/* A material with an id. */
struct shared {
    struct str id, name;
    const struct ast_node *node; /* its definition */
    bool written;
    bool late; /* used before its definition */
};

struct native_writer {
    const struct translation *t;
    const struct ast *ast;
    struct buffer *out;
    struct arena arena;
    struct names names;
    struct str *textures; /* their names, by index */
    bool *texture_notes;  /* which have an id that their name does not tell of */
    size_t texture_count;
    struct map shared; /* id to struct shared */
};

/* ---- native_parts.c: elements of the tree, and the comments around them ---- */

bool element_is(const struct ast_node *n);
/* Trimmed; without a text when there is none. */
struct str element_attribute(const struct ast_node *n, const char *name);
/* The section of the scene, or NULL. */
const struct ast_node *native_section(const struct native_writer *w, const char *name);
/* The element's children with their comments; the caller frees out->v. */
void native_members(const struct native_writer *w, const struct ast_node *element,
                    struct members *out);

void native_put(struct native_writer *w, const char *text);
void native_put_comments(struct native_writer *w, size_t first, size_t n, enum comment_place place);
/* On lines of their own, with the blank lines that stood before them if `blanks`. */
void native_put_lead(struct native_writer *w, const struct member *m, bool blanks);
void native_put_behind(struct native_writer *w, const struct member *m);
/* All comments inside a leaf, as they come. */
void native_put_inside(struct native_writer *w, const struct ast_node *n);
void native_put_note(struct native_writer *w, const char *name, struct str value);

/* ---- native_block.c: what stands between braces ---- */

void native_put_block(struct native_writer *w, const struct ast_node *n, enum schema_kind kind);
/* A note when the class has another name than the schema's. */
void native_put_class(struct native_writer *w, const struct ast_node *n, enum schema_kind kind);

/* Names the materials that have an id. */
void native_find_shared(struct native_writer *w, const struct ast_node *n);
/* Writes the shared materials that an object uses, those that are not written yet. */
void native_put_shared(struct native_writer *w, const struct ast_node *object);

#endif
