/* File names as URIs. */
#ifndef WRT_LSP_URI_H
#define WRT_LSP_URI_H

#include "base/buffer.h"

/* The path that a "file:" URI names; what is no such URI is taken as a name itself.  Caller frees.
 */
char *uri_to_path(const char *uri);

/* "file:" and the absolute path, made from the current folder where it is none. */
void uri_add(struct buffer *out, const char *path);

#endif
