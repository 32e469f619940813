/* The texts that are open in the editor: what is there, not what the disk holds. */
#ifndef WRT_LSP_DOCUMENT_H
#define WRT_LSP_DOCUMENT_H

#include "base/buffer.h"
#include "lsp/position.h"

#include <jansson.h>

struct analysis;

struct document {
    char *uri, *path; /* owned */
    struct buffer text;
    struct line_index lines;   /* of the text */
    struct analysis *analysis; /* of the text, made when first asked for; NULL: not yet */
    json_int_t version;
    bool has_version;
    bool due; /* its findings were not told since it changed */
};

struct documents {
    VEC(struct document *) list;
};

void documents_free(struct documents *d);

/* NULL: not open. */
struct document *documents_find(const struct documents *d, const char *uri);
/* Likewise, of a file by any name. */
struct document *documents_find_file(const struct documents *d, const char *path);

/* Opens a text, or replaces it where it is open already. */
struct document *documents_open(struct documents *d, const char *uri, struct str text);
void documents_close(struct documents *d, struct document *doc);

/* Replaces the bytes [begin, end). */
void document_edit(struct document *doc, uint32_t begin, uint32_t end, struct str text);

/* Forgets what was found out about the text. */
void document_changed(struct document *doc);

#endif
