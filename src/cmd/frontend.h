/* A scene file through all that comes before lowering: read, decode, parse, evaluate, validate. */
#ifndef WRT_CMD_FRONTEND_H
#define WRT_CMD_FRONTEND_H

#include "ast/ast.h"
#include "base/buffer.h"
#include "cmd/options.h"
#include "diag/diag.h"
#include "eval/desc.h"

struct frontend {
    struct srcmap sources;
    struct diag diag;
    struct ast ast;
    struct desc desc;
    VEC(struct ast) defines; /* the values of -D */
    double seconds;
    unsigned unlooked; /* rules of lint that were not looked at because of errors */
};

void frontend_init(struct frontend *f, const struct options *options);

/* A file that is no scene as a source, byte by byte; NULL after reporting. */
const struct source *frontend_read(struct frontend *f, const char *path);

/* Initialises f and reads the scene's text into f->ast; true when it has no syntax errors. */
bool frontend_parse(struct frontend *f, const char *path, const struct options *options);

/* As frontend_load with a text that was not read from a file; files it names are looked up beside
 * `path`. */
bool frontend_load_text(struct frontend *f, const char *path, struct str text,
                        const struct options *options);

/* Adds the text in canonical layout to *out; false when it has syntax errors. */
bool frontend_lay_out(struct str text, struct buffer *out);

/* Initialises f and loads the scene; true when it may be lowered.  Everything found is in f->diag;
 * free with frontend_free in any case. */
bool frontend_load(struct frontend *f, const char *path, const struct options *options);
/* As frontend_load of a file whose bytes have been read, which are f's from now on; they have room
 * for two more. */
bool frontend_load_bytes(struct frontend *f, const char *path, char *bytes, size_t n,
                         const struct options *options);
void frontend_free(struct frontend *f);

/* Prints what was found as the options say; returns the exit status it asks for. */
int frontend_report(struct frontend *f, const struct options *options, enum diag_level least);

/* The exit status of two parts of a run: wrong input tells more than a missing file. */
int status_worse(int a, int b);

#endif
