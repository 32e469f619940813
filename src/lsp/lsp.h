/* A language server (LSP 3.17): what an editor asks about scenes while they are written. */
#ifndef WRT_LSP_LSP_H
#define WRT_LSP_LSP_H

#include "base/buffer.h"
#include "diag/diag.h"

struct lsp_options {
    const struct diag_policy *policy;
    const char *const *folders; /* of includes */
    size_t folder_count;
    size_t max_objects;
    const struct file_fence *fence; /* around included files; NULL: they may lie anywhere */
};

/* Talks until the client ends it; returns the exit status of the program.  What the user should
 * know of the end is added to *problem. */
int lsp_serve(int in, int out, const struct lsp_options *options, struct buffer *problem);

#endif
