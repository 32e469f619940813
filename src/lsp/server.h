/* What the files of the language server share (internal to src/lsp).
 *
 * A message goes transport.c -> server.c (queue, life cycle) -> the function that methods.def names
 * for it.  Functions that answer return the result, or NULL after server_fail. */
#ifndef WRT_LSP_SERVER_H
#define WRT_LSP_SERVER_H

#include "lsp/analysis.h"
#include "lsp/document.h"
#include "lsp/lsp.h"
#include "lsp/transport.h"

#include <jansson.h>

enum rpc_code {
    RPC_PARSE_ERROR = -32700,
    RPC_INVALID_REQUEST = -32600,
    RPC_METHOD_NOT_FOUND = -32601,
    RPC_INVALID_PARAMS = -32602,
    RPC_NOT_INITIALIZED = -32002,
    RPC_CANCELLED = -32800,
    RPC_FAILED = -32803,
};

enum server_state { SERVER_STARTING, SERVER_RUNNING, SERVER_SHUT_DOWN, SERVER_ENDED };

struct message {
    json_t *json;      /* NULL: it could not be read */
    char problem[200]; /* why */
    size_t bytes;
    bool cancelled;
};

struct server {
    const struct lsp_options *options;
    struct transport transport;
    enum server_state state;
    int status; /* once ended */
    enum position_encoding encoding;
    bool related; /* the client shows places beside a finding's own */
    struct documents documents;
    VEC(struct message) queue;
    size_t head;        /* of the queue: the message under way */
    size_t bytes;       /* of the messages that wait */
    enum rpc_code code; /* why the request under way has no result */
    char reason[200];
};

#define REQUEST(name, function) json_t *function(struct server *s, const json_t *params);
#define NOTIFICATION(name, function) void function(struct server *s, const json_t *params);
#include "lsp/methods.def"

/* The request has no result; returns NULL. */
json_t *server_fail(struct server *s, enum rpc_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

void server_notify(struct server *s, const char *method, json_t *params);

/* ---- publish.c ---- */

/* Tells what was found in a text, or that nothing is shown of one that is closed. */
void publish(struct server *s, struct document *doc);
void publish_nothing(struct server *s, const struct document *doc);

/* One finding as the protocol has it. */
json_t *publish_entry(const struct server *s, const struct document *doc, const struct analysis *a,
                      const struct diag_entry *e);

/* Whether the text of this document shows a finding, and where. */
bool publish_place(const struct server *s, const struct analysis *a, const struct diag_entry *e,
                   struct span *place);

/* ---- wire.c: places and texts as JSON, and back ---- */

json_t *wire_text(struct str text);
json_t *wire_buffer(struct buffer *text); /* frees it */
json_t *wire_range(const struct server *s, const struct line_index *lines, uint32_t begin,
                   uint32_t end);
/* A span of the document's own text. */
json_t *wire_span(const struct server *s, const struct document *doc, const struct analysis *a,
                  struct span span);
/* A span of any text of the analysis. */
json_t *wire_location(const struct server *s, const struct document *doc, const struct analysis *a,
                      struct span span);

/* A list of changes to a document as a WorkspaceEdit; takes the list. */
json_t *wire_workspace_edit(const struct document *doc, json_t *edits);

/* The document that the parameters name; NULL after server_fail. */
struct document *wire_document(struct server *s, const json_t *params);

/* Where a request asks. */
struct wire_place {
    struct document *doc;
    const struct analysis *analysis;
    uint32_t in_text; /* offset in the document */
    uint32_t at;      /* offset among all sources */
};
bool wire_place(struct server *s, const json_t *params, struct wire_place *out);
/* As far as the document; the place is its start. */
bool wire_whole(struct server *s, const json_t *params, struct wire_place *out);

/* Reads {"line", "character"}; false when it is none. */
bool wire_read_position(const struct server *s, const struct line_index *lines, const json_t *json,
                        uint32_t *offset);
bool wire_read_range(const struct server *s, const struct line_index *lines, const json_t *json,
                     uint32_t *begin, uint32_t *end);

#endif
