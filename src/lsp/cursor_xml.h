/* What may stand at a place of an XML text that is being written: told by its tags alone. */
#ifndef WRT_LSP_CURSOR_XML_H
#define WRT_LSP_CURSOR_XML_H

#include "base/str.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stdint.h>

enum tag_place {
    TAG_NOWHERE,   /* in a comment or the like */
    TAG_CONTENT,   /* between tags */
    TAG_NAME,      /* behind `<` */
    TAG_CLOSING,   /* behind `</` */
    TAG_ATTRIBUTE, /* in an opening tag */
    TAG_VALUE,     /* in the quotes of an attribute */
};

struct tag_open {
    struct str name, class;
    size_t given; /* the first of the elements in it among those given */
};

struct tag_cursor {
    enum tag_place place;
    VEC(struct tag_open)
    open;                  /* outermost first; TAG_ATTRIBUTE, TAG_VALUE: the last is the tag's */
    VEC(struct str) given; /* elements that stand in open ones before the place */
    VEC(struct str)
    attributes;       /* of the tag, before the place; TAG_VALUE: the last is the value's */
    struct str model; /* of the scene */
    bool text;        /* TAG_CONTENT: something else than blanks stands before the place */
};

/* Free with tag_cursor_free. */
void tag_cursor_find(struct tag_cursor *c, struct str text, uint32_t at);
void tag_cursor_free(struct tag_cursor *c);

#endif
