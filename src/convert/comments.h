/* Comments carried from one format to the other.
 *
 * What a comment says is its content: the text between its marks, without the blanks next to them.
 * Content that the other format cannot spell is escaped with backslashes, so that it comes back:
 * `*` and `/` in a native block comment, two dashes in XML, characters that XML forbids.
 *
 * What only XML says is kept in notes, native comments of the form  xml: name="value"  with the
 * value spelt as in XML.  They are consumed on the way back; a comment that only looks like one
 * gets a backslash. */
#ifndef WRT_CONVERT_COMMENTS_H
#define WRT_CONVERT_COMMENTS_H

#include "ast/ast.h"
#include "base/buffer.h"

enum comment_place {
    COMMENT_OWN_LINE,
    COMMENT_BEHIND,      /* what it belongs to, at the end of its line */
    COMMENT_BEHIND_MORE, /* likewise, and others follow on the line */
    COMMENT_INSIDE,      /* a line */
};

/* Writes an XML comment as a native one. */
void comment_to_native(const struct ast *ast, const struct trivia *comment,
                       enum comment_place place, struct buffer *out);
/* Writes a native comment as an XML one. */
void comment_to_xml(const struct ast *ast, const struct trivia *comment, enum comment_place place,
                    struct buffer *out);

struct note {
    struct str name, value;
};

/* Writes a note.  The value is plain text. */
void note_write(const char *name, struct str value, enum comment_place place, struct buffer *out);
/* Reads one; false when the native comment is none.  The value is as XML spells it in quotes. */
bool note_read(const struct ast *ast, const struct trivia *comment, struct note *out);

/* Begins a line, with a blank one before it, unless the text stands there already. */
void begin_line(struct buffer *out, bool blank);

/* The text as XML spells it in content or in double quotes. */
void xml_escape(struct str text, bool quoted, struct buffer *out);
/* The text as the native language spells it in double quotes. */
void native_escape(struct str text, struct buffer *out);
/* True when XML can say the text at all. */
bool xml_can_say(struct str text);

#endif
