/* Scene texts through the front end, for tests. */
#ifndef WRT_TESTS_LOAD_H
#define WRT_TESTS_LOAD_H

#include "ast/ast.h"
#include "diag/diag.h"
#include "eval/desc.h"
#include "lower/lower.h"

#define COUNT(a) (int)(sizeof(a) / sizeof *(a))

struct load {
    struct srcmap sources;
    struct diag diag;
    struct source *source;
    struct ast ast;
    struct desc desc;
    struct lowered lowered;
};

/* The text as a source called `name`; something stands before it, so that offsets of the map and of
 * the text differ. */
void load_text(struct load *l, const char *name, const char *text);

/* Each goes as far as its name says and stops at errors; true when there were none. */
bool load_parse(struct load *l, const char *text);
bool load_eval(struct load *l, const char *text);
bool load_validate(struct load *l, const char *text);
/* Files are relative to the folder of `name`. */
bool load_lower(struct load *l, const char *name, const char *text);

/* The same with all surfaces and lights at the place. */
bool load_lower_placed(struct load *l, const char *name, const char *text,
                       const struct affine *place);

void load_free(struct load *l);

/* Every finding as "E104:the text it stands at|", in the order of the text. */
void load_findings(struct load *l, char *out, size_t room);

/* The first finding's code and message; "" when there is none. */
const char *load_first(const struct load *l);

#endif
