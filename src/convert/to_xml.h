/* A description becoming XML (internal to src/convert). */
#ifndef WRT_CONVERT_TO_XML_H
#define WRT_CONVERT_TO_XML_H

#include "base/vec.h"
#include "convert/comments.h"
#include "convert/places.h"
#include "convert/translating.h"

/* A tree node that objects, properties and values are looked up by, by its offset. */
struct entry {
    uint32_t begin;
    const struct ast_node *node;
};

/* How a material with an id is written. */
struct shared {
    struct str
        id; /* as XML spells it in quotes; empty: it has none and is written wherever it is used */
    uint32_t place; /* offset of the value that a note calls its definition; 0: the first use */
    bool written;
};

struct xml_writer {
    const struct translation *t;
    const struct ast *ast;
    const struct desc *desc;
    struct buffer *out;
    struct arena arena;
    struct places places;
    VEC(struct entry) nodes; /* rising */
    struct shared *shared;   /* one for each material */
    struct str *texture_ids; /* one for each texture; empty: none */
    bool *begun;             /* one for each stop: its comments are written */
};

/* ---- xml_parts.c: the tree's nodes, and the comments around them ---- */

/* Lets nodes be found by their offsets. */
void xml_index_nodes(struct xml_writer *w, const struct ast_node *n);
/* The node that begins there in the scene's own text, or NULL. */
const struct ast_node *xml_node_at(const struct xml_writer *w, struct span span);
/* The property as written; NULL when it comes from elsewhere. */
const struct ast_node *xml_property_at(const struct xml_writer *w, const struct desc_prop *p);
/* True within the scene's own text. */
bool xml_is_own(const struct xml_writer *w, uint32_t offset);
/* Where the token behind some comments begins. */
uint32_t xml_next_token(const struct xml_writer *w, uint32_t at);

void xml_put(struct xml_writer *w, const char *text);
/* Each is written once. */
void xml_put_comment(struct xml_writer *w, size_t i, enum comment_place place);
/* All comments that are left between two offsets. */
void xml_put_between(struct xml_writer *w, uint32_t begin, uint32_t end, enum comment_place place);
/* Those before a member of a block: what is left since the member before, or the brace. */
void xml_put_lead(struct xml_writer *w, uint32_t begin);
/* Those on the line on which something ends, when nothing else follows there. */
void xml_put_behind(struct xml_writer *w, uint32_t end);
/* The value of a note between two offsets, which is used up. */
struct str xml_take_note(struct xml_writer *w, uint32_t begin, uint32_t end, const char *name);

/* ---- xml_object.c ---- */

/* An object as an element; id: as XML spells it in quotes, or empty. */
void xml_put_element(struct xml_writer *w, const struct desc_object *o, const char *tag,
                     struct str id);
/* An object's label, or the id that a note keeps. */
struct str xml_label_of(struct xml_writer *w, const struct desc_object *o);

#endif
