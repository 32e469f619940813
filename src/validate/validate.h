/* What lowering relies on: required properties, ranges, and the rules between properties. */
#ifndef WRT_VALIDATE_VALIDATE_H
#define WRT_VALIDATE_VALIDATE_H

#include "diag/diag.h"
#include "eval/desc.h"

/* Reports every violation at its place; true when there were none. */
bool validate_scene(const struct desc *d, struct diag *diag);

#endif
