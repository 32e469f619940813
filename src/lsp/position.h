/* Places in a text as editors count them: lines and columns from 0, columns in UTF-16 units unless
 * something else was agreed. */
#ifndef WRT_LSP_POSITION_H
#define WRT_LSP_POSITION_H

#include "base/str.h"
#include "base/vec.h"

#include <stdint.h>

enum position_encoding { POSITION_UTF16, POSITION_UTF8, POSITION_UTF32, POSITION_ENCODINGS };

/* As the protocol calls them. */
extern const char *const position_encoding_names[POSITION_ENCODINGS];

struct position {
    uint32_t line, character;
};

/* Where the lines of a text begin; a line ends with "\n", "\r\n" or "\r". */
struct line_index {
    struct str text;      /* borrowed; UTF-8 */
    VEC(uint32_t) starts; /* at least one */
};

/* Zero-initialise before the first time; free with line_index_free. */
void line_index_build(struct line_index *index, struct str text);
void line_index_free(struct line_index *index);

struct position position_of(const struct line_index *index, uint32_t offset,
                            enum position_encoding encoding);

/* The byte there.  What lies behind the end of a line or of the text is that end; what lies within
 * a character is its start. */
uint32_t position_offset(const struct line_index *index, struct position p,
                         enum position_encoding encoding);

#endif
