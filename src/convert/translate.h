/* Scenes translated between XML and the native language.
 *
 * What goes one way and back is the same scene: elements and their order, spellings of numbers and
 * file names, and every comment with what it stands before, in or behind.  The result is in
 * canonical layout. */
#ifndef WRT_CONVERT_TRANSLATE_H
#define WRT_CONVERT_TRANSLATE_H

#include "ast/ast.h"
#include "base/buffer.h"
#include "diag/diag.h"
#include "eval/desc.h"

struct translation {
    const struct ast *ast;   /* of the scene's own file */
    const struct desc *desc; /* validated, without errors */
    const struct srcmap *sources;
    struct diag *diag;
    bool expand;        /* to XML: named materials are written out wherever they are used */
    const char *beside; /* the path that relative file names will be relative to */
};

/* Each appends the whole text; false after reporting what the format cannot say. */
bool translate_to_native(const struct translation *t, struct buffer *out);
bool translate_to_xml(const struct translation *t, struct buffer *out);

/* A native scene as it is, but for the names of files, which become relative to `beside`. */
bool translate_native_moved(const struct translation *t, struct buffer *out);

#endif
