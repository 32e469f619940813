/* The checks, their numbers, and what they share (internal to src/lint). */
#ifndef WRT_LINT_CHECKS_H
#define WRT_LINT_CHECKS_H

#include "lint/lint.h"

/* LINT_NAME for each threshold. */
enum lint_threshold_number {
#define THRESHOLD(name, code, value, meaning) LINT_NUMBER_##name,
#include "lint/thresholds.def"
#undef THRESHOLD
    LINT_THRESHOLDS
};
extern const struct lint_threshold lint_thresholds[LINT_THRESHOLDS];

/* LINT(NAME) is the threshold's value. */
#define LINT(name) (lint_thresholds[LINT_NUMBER_##name].value)

#define CHECK(stage, function, ...) void function(const struct lint *l);
#include "lint/checks.def"
#undef CHECK

/* ---- common.c ---- */

typedef void lint_look(const struct lint *l, const struct desc_object *o);

/* Looks at each object, in the frame in which it was made. */
void lint_each_surface(const struct lint *l, lint_look *look);
void lint_each_light(const struct lint *l, lint_look *look);
void lint_each_material(const struct lint *l, lint_look *look);

/* The object's own value of the property: NULL when it is not given, or by another object, which is
 * looked at itself. */
const struct desc_value *lint_own(const struct desc_object *o, enum schema_prop_id id);

/* The value's place; that of the object when it is not given. */
struct span lint_place(const struct desc_object *o, enum schema_prop_id id);

/* All that spells a value: in XML that may be several elements. */
struct span lint_extent(const struct desc_object *o, const struct desc_prop *p);

/* The property as the object's format spells it. */
struct str lint_name(const struct desc_object *o, enum schema_prop_id id);

/* Whether two materials without texture are the same in all they say. */
bool lint_same_material(const struct desc_object *a, const struct desc_object *b);

/* Text of numbers and signs only, with no name that may mean something else elsewhere. */
bool lint_is_spelt_out(struct str text);

/* True in the file itself, not in one that it includes. */
bool lint_is_here(const struct lint *l, struct span span);

/* The statement or element of a surface that stands in the file for itself; NULL when a loop, a
 * template, a group or a condition makes it, or something in it has an id, to which others may
 * refer. */
const struct ast_node *lint_surface_node(const struct lint *l, const struct desc_object *o);

/* Proposes that the text goes away, and with it its line when nothing else stands there, the
 * comment behind it on that line, and comments before it that allow something in it.  Other
 * comments are left alone; with a comment that is lost it is no safe change. */
void lint_remove(const struct lint *l, struct diag_entry *e, struct span span,
                 enum diag_fix_kind kind);

#endif
