/* Messages framed as the protocol's base layer says: a header with Content-Length, an empty line,
 * so many bytes.
 *
 * Where the length is missing or no number nobody can tell where the next message begins, so a
 * broken frame is the end.  A message that is only too long is passed over. */
#ifndef WRT_LSP_TRANSPORT_H
#define WRT_LSP_TRANSPORT_H

#include "base/buffer.h"

#include <jansson.h>
#include <stdbool.h>

/* Bytes of a message, and of the header before it. */
enum { TRANSPORT_MESSAGE_LIMIT = 64 << 20, TRANSPORT_HEADER_LIMIT = 4096 };

struct transport {
    int in, out;         /* file descriptors; borrowed */
    struct buffer input; /* read, from `at` on not yet taken */
    size_t at;
    size_t skip; /* bytes of a message that is passed over */
    bool ended;  /* no more will come */
    int error;   /* of errno: why reading or writing failed; 0: it did not */
};

enum transport_result {
    TRANSPORT_MESSAGE,   /* *body is one; valid until the next transport_read */
    TRANSPORT_NOTHING,   /* nothing is complete yet */
    TRANSPORT_TOO_LARGE, /* a message longer than the limit is passed over */
    TRANSPORT_END,       /* the input ended behind a message */
    TRANSPORT_BROKEN,    /* *problem says how */
};

void transport_init(struct transport *t, int in, int out);
void transport_free(struct transport *t);

/* Reads what is there, or, told to wait, at least something; false when nothing came. */
bool transport_read(struct transport *t, bool wait);

/* The next message of what was read. */
enum transport_result transport_take(struct transport *t, struct str *body, const char **problem);

/* Writes a message; false when nobody reads any more. */
bool transport_send(struct transport *t, const json_t *message);

#endif
