/* One text through the front end, as far as that goes without opening textures and meshes. */
#ifndef WRT_LSP_ANALYSIS_H
#define WRT_LSP_ANALYSIS_H

#include "ast/ast.h"
#include "diag/diag.h"
#include "eval/desc.h"
#include "lsp/bindings.h"
#include "lsp/document.h"
#include "lsp/lsp.h"

struct analysis {
    struct srcmap sources;
    struct diag diag; /* sorted */
    struct ast ast;
    struct desc desc;
    struct bindings bindings;
    bool parsed;                 /* without syntax errors */
    const struct source *source; /* the text itself; the others are of files it includes */
};

/* That of the text as it is now; NULL when it is too large to be read. */
const struct analysis *analysis_of(struct document *doc, const struct lsp_options *options);
void analysis_free(struct analysis *a); /* NULL is fine */

/* Offsets of the text, and those of all sources together. */
static inline uint32_t analysis_offset(const struct analysis *a, uint32_t in_text)
{
    return a->source->base + in_text;
}

static inline bool analysis_owns(const struct analysis *a, struct span span)
{
    return span.begin >= a->source->base && span.end <= a->source->base + a->source->n;
}

#endif
