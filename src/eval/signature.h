/* The functions and statements of the native language in words, for `wrt doc`, the manual and
 * messages.  All texts are appended to a buffer. */
#ifndef WRT_EVAL_SIGNATURE_H
#define WRT_EVAL_SIGNATURE_H

#include "base/buffer.h"
#include "base/str.h"

#include <stdbool.h>
#include <stdint.h>

struct signature {
    const char *name, *parameters; /* separated by spaces */
    const char *types;             /* a letter for each parameter, as in functions.def */
    uint32_t required;
    bool more; /* whether arguments may follow the last parameter */
    const char *doc;
};

/* What a letter of `types` stands for: "a number". */
const char *signature_type(char letter);

/* `clamp(x, low, high)`, `str(x, digits = ...)` */
void signature_write(struct buffer *out, const struct signature *s);

/* Whether the language has a function of this name. */
bool signature_is_function(struct str name);

/* All about the function, or the statement; false when there is none of this name. */
bool signature_describe_function(struct buffer *out, struct str name);
bool signature_describe_statement(struct buffer *out, struct str name);
/* Likewise a param that an option gives its value. */
bool signature_describe_param(struct buffer *out, struct str name);

/* A line or two for each. */
void signature_list_functions(struct buffer *out);
void signature_list_statements(struct buffer *out);

/* The function that has this name in other languages; empty: none. */
struct str signature_meant(struct str name);
/* Offers all names for "did you mean". */
void signature_try_names(struct str_nearest *nearest);

/* The table of functions in wrt(5), in mdoc. */
void signature_manual(struct buffer *out);

#endif
