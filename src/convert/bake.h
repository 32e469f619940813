/* Places of objects made part of what they say themselves, for formats without groups. */
#ifndef WRT_CONVERT_BAKE_H
#define WRT_CONVERT_BAKE_H

#include "diag/diag.h"
#include "eval/desc.h"

/* Makes *out the same description without places; both share what did not change, and `arena` holds
 * the rest.  False after reporting what cannot be said without a place: an object that it turns or
 * stretches into something its kind has no properties for. */
bool bake_places(const struct desc *d, struct arena *arena, struct diag *diag, struct desc *out);

#endif
