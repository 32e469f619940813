/* What may be written at a place, in the making. */
#ifndef WRT_LSP_COMPLETION_H
#define WRT_LSP_COMPLETION_H

#include "lsp/cursor.h"
#include "lsp/server.h"

#include "schema/describe.h"

/* CompletionItemKind. */
enum item_kind {
    ITEM_FUNCTION = 3,
    ITEM_VARIABLE = 6,
    ITEM_CLASS = 7,
    ITEM_PROPERTY = 10,
    ITEM_VALUE = 12,
    ITEM_KEYWORD = 14,
    ITEM_CONSTANT = 21,
};

struct completion {
    const struct wire_place *where;
    enum schema_model model;
    json_t *items;
    struct cursor cursor; /* native texts */
};

/* The new item, borrowed; an empty detail is left out. */
json_t *completion_add(struct completion *c, struct str label, enum item_kind kind,
                       const char *detail);
void completion_add_words(struct completion *c, const char *words, enum item_kind kind,
                          const char *detail);
/* A property by its name or that of a leaf, and what is written before and behind it.  Those that
 * must be given come first. */
void completion_add_prop(struct completion *c, enum schema_prop_id id, struct str name,
                         const char *before, const char *behind);

static inline bool completion_has(const struct completion *c, unsigned models)
{
    return models >> c->model & 1;
}

/* completion_xml.c: at a place of an XML text. */
void complete_xml(struct completion *c, struct str text, uint32_t at);

#endif
