/* What both directions share (internal to src/convert). */
#ifndef WRT_CONVERT_TRANSLATING_H
#define WRT_CONVERT_TRANSLATING_H

#include "base/arena.h"
#include "convert/translate.h"
#include "print/gap.h"

/* The text of a span of the scene's own file. */
struct str translate_text(const struct translation *t, struct span span);

/* The name of a file as spelt at a place, for where it will be looked up. */
struct str translate_file(const struct translation *t, struct str name, uint32_t spelt,
                          struct arena *arena);

/* A text that means the scene in the other format, or with files named from elsewhere, in no
 * particular layout. */
void translate_xml(const struct translation *t, struct buffer *out);
void translate_files(const struct translation *t, struct buffer *out);
bool translate_description(const struct translation *t, struct buffer *out);

#endif
