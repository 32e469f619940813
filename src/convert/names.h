/* Names of the native language for what XML calls by other texts, or not at all. */
#ifndef WRT_CONVERT_NAMES_H
#define WRT_CONVERT_NAMES_H

#include "base/arena.h"
#include "base/map.h"

/* Names in use.  Initialise with an arena that lives as long. */
struct names {
    struct arena *arena; /* borrowed */
    struct map taken;
};

void names_free(struct names *n);

/* A name like `wanted` that is not taken, and takes it: the text itself when it can be a name, else
 * letters and digits of it, and a number where that is needed. */
struct str names_take(struct names *n, struct str wanted);

/* The name of a texture without one: its file's, without folder and suffix.  It is not taken yet.
 */
struct str names_of_file(struct names *n, struct str file);

/* True when the text can stand as a name where no other has it. */
bool name_is_free(struct str text);

#endif
