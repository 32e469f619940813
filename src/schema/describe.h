/* Kinds and properties in words, for `wrt doc`, the manual and messages.  All texts are appended to
 * a buffer. */
#ifndef WRT_SCHEMA_DESCRIBE_H
#define WRT_SCHEMA_DESCRIBE_H

#include "base/buffer.h"
#include "schema/schema.h"

/* "above 0 and at most 1"; only for properties with .has_least. */
void describe_range(struct buffer *out, enum schema_prop_id id);

/* What may be given: "a number above 0", "one of sphere, quad". */
void describe_value(struct buffer *out, enum schema_prop_id id, bool xml);

/* "required", "required in classic", "model modern only"; nothing for what is neither. */
void describe_conditions(struct buffer *out, enum schema_prop_id id);

/* The default as native text, that of each model where they differ; only for properties with
 * .has_default. */
void describe_default(struct buffer *out, enum schema_prop_id id);
/* True when the default is the same wherever the property exists. */
bool describe_has_one_default(enum schema_prop_id id);

/* The element or elements that spell it: "<v0> <v1> <v2>", `<surface class="Sphere">`. */
void describe_leaves(struct buffer *out, enum schema_prop_id id);
void describe_element(struct buffer *out, enum schema_kind kind);

/* True when every kind of the group has the property, and there are several. */
bool describe_is_common(enum schema_group group, enum schema_prop_id id);

/* The property tables of wrt(5), in mdoc. */
void describe_manual(struct buffer *out);

#endif
