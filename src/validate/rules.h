/* Rules between the properties of a kind, for objects that have all they need (internal to
 * src/validate). */
#ifndef WRT_VALIDATE_RULES_H
#define WRT_VALIDATE_RULES_H

#include "diag/diag.h"
#include "eval/desc.h"

typedef void rule_check(const struct desc_object *o, struct diag *diag);

/* The check of each kind; NULL: it has none. */
extern rule_check *const rules_of_kind[SCHEMA_KINDS];

/* What a surface of the scene needs beyond its shape. */
rule_check rules_uvs;

#endif
