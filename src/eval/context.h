/* What the evaluation of both formats shares (internal to src/eval). */
#ifndef WRT_EVAL_CONTEXT_H
#define WRT_EVAL_CONTEXT_H

#include "base/map.h"
#include "eval/eval.h"

/* A native value before it is known what it is for. */
enum value_type {
    VALUE_ERROR, /* reported already: passes everywhere in silence */
    VALUE_NUMBER,
    VALUE_ANGLE, /* degrees */
    VALUE_BOOL,
    VALUE_STRING,
    VALUE_VECTOR, /* two or three numbers */
    VALUE_COLOUR, /* spelt #rrggbb */
    VALUE_LIST,
    VALUE_OBJECT, /* material, texture or surface */
};

struct value {
    enum value_type type;
    struct span span;
    uint32_t n; /* numbers of a vector, items of a list */
    union {
        double number[3];
        bool boolean;
        struct str string;
        struct value *items;
        struct desc_object *object;
    };
};

/* What a name stands for. */
struct binding {
    struct str name;
    struct span span; /* of the name in its definition */
    struct value value;
    bool busy; /* XML: under evaluation */
    const struct ast_node *node; /* XML: the material, evaluated when first used */
};

struct eval {
    const struct eval_options *options;
    bool *define_used; /* one for each of options->defines */
    struct desc *out;
    struct diag *diag;
    struct map names; /* to struct binding */
    size_t names_tried; /* for "did you mean" so far */
};

/* ---- object.c ---- */

struct desc_object *object_new(struct eval *e, enum schema_kind kind, const struct ast_node *node);

/* Where the value of a property goes; NULL after reporting that it was given before.  `leaf` is
 * the number of the XML leaf (0 for native). */
struct desc_prop *object_prop(struct eval *e, struct desc_object *o, enum schema_prop_id id,
                              unsigned leaf, struct span name_span);

/* The property called `name`; SCHEMA_PROPS after reporting an unknown one. */
enum schema_prop_id object_find_prop(struct eval *e, const struct desc_object *o, struct str name,
                                     struct span name_span, unsigned *leaf);

/* Adds a light or surface to the description; NULL is passed over. */
void object_place(struct eval *e, struct desc_object *o);

/* Adds a finished texture or material to the description and numbers it. */
void object_register(struct eval *e, struct desc_object *o);

/* Offers all defined names for "did you mean", unless that was asked too often among too many. */
void try_defined_names(struct eval *e, struct str_nearest *nearest);

/* Reports a name of no kind of this group. */
void report_unknown_kind(struct eval *e, enum schema_group group, struct str name,
                         struct span span, bool xml);

/* Reports a word that the property does not take. */
void report_unknown_word(struct eval *e, enum schema_prop_id id, struct str word, struct span span,
                         bool xml);

/* ---- xml.c, leaf.c ---- */

void eval_xml(struct eval *e, const struct ast_node *root);
/* Reads the text of an XML leaf as the property's type. */
void eval_leaf(struct eval *e, struct desc_object *o, const struct ast_node *leaf);

/* ---- native.c, value.c, convert.c ---- */

void eval_native(struct eval *e, const struct ast_node *statements);
struct value eval_value(struct eval *e, const struct ast_node *node);
/* An object of the kind with the properties among the members. */
struct desc_object *eval_block(struct eval *e, enum schema_kind kind, const struct ast_node *node,
                               const struct desc_object *base);
/* The value as the property's type; false after reporting that it does not fit. */
bool value_convert(struct eval *e, enum schema_prop_id id, const struct value *v,
                   struct desc_value *out);
const char *value_type_name(const struct value *v);

#endif
