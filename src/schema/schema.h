/* What scenes are made of: kinds and their properties, from schema.def. */
#ifndef WRT_SCHEMA_SCHEMA_H
#define WRT_SCHEMA_SCHEMA_H

#include "base/str.h"

#include <stdbool.h>
#include <stdint.h>

enum schema_group {
    SCHEMA_CAMERA,
    SCHEMA_SETTINGS,
    SCHEMA_LIGHT,
    SCHEMA_TEXTURE,
    SCHEMA_SURFACE,
    SCHEMA_PLACE,
    SCHEMA_MATERIAL,
    SCHEMA_GROUPS
};

enum schema_kind {
#define KIND(id, ...) KIND_##id,
#include "schema/schema.def"
    SCHEMA_KINDS
};

enum schema_prop_id {
#define PROP(id, ...) PROP_##id,
#include "schema/schema.def"
    SCHEMA_PROPS
};

enum schema_type {
    TYPE_NUMBER,
    TYPE_INTEGER,
    TYPE_ANGLE,  /* plain numbers are degrees */
    TYPE_SWITCH, /* 0 or 1, true or false */
    TYPE_NUMBER_OR_SWITCH,
    TYPE_VECTOR,         /* three numbers */
    TYPE_VECTOR_OR_PAIR, /* the third may be left out in native text */
    TYPE_SCALE,          /* three factors, or one for all */
    TYPE_COLOUR,         /* three numbers, one for all, or #rrggbb */
    TYPE_ROTATION,       /* three angles */
    TYPE_MATRIX,         /* a list of twelve numbers */
    TYPE_SIZE,           /* two whole numbers */
    TYPE_POINTS,         /* as many vectors as there are XML leaves */
    TYPE_WORD,           /* one of .words */
    TYPE_FILE,
    TYPE_MATERIAL,
    TYPE_TEXTURE,
    TYPE_SURFACE,
    SCHEMA_TYPES
};

enum schema_model { SCHEMA_CLASSIC, SCHEMA_MODERN, SCHEMA_MODELS };

/* The models something exists in. */
enum {
    IN_CLASSIC = 1 << SCHEMA_CLASSIC,
    IN_MODERN = 1 << SCHEMA_MODERN,
    IN_BOTH = IN_CLASSIC | IN_MODERN
};

struct schema_kind_row {
    enum schema_group group;
    unsigned models;    /* IN_... */
    const char *native; /* the word that makes one, lights: `light` and the word */
    const char *xml;    /* class */
    const char *doc;
};
extern const struct schema_kind_row schema_kinds[SCHEMA_KINDS];

struct schema_prop {
    uint32_t kinds;  /* bit 1 << kind for each that has it */
    unsigned models; /* IN_... */
    const char *native;
    const char *xml; /* leaves, separated by spaces */
    enum schema_type type;
    const char *doc;
    unsigned required;              /* models where it must be given */
    unsigned has_default;           /* models where it has a default */
    double value[SCHEMA_MODELS][3]; /* the defaults; a word's number */
    bool has_least, above;          /* numbers are >= least, or > least */
    double least, most;             /* most: 0 for no limit */
    const char *words;              /* native=xml, separated by spaces; numbered from 0 */
};
extern const struct schema_prop schema_props[SCHEMA_PROPS];

static inline bool schema_has(enum schema_kind kind, enum schema_prop_id prop)
{
    return schema_props[prop].kinds >> kind & 1;
}

/* True when the property must be given in scenes of the model. */
static inline bool schema_required(enum schema_prop_id prop, enum schema_model model)
{
    return (schema_props[prop].required & schema_props[prop].models) >> model & 1;
}

/* The kind as a user of the format spells it. */
const char *schema_kind_name(enum schema_kind kind, bool xml);

/* The kind by its last native word (or XML class) in a group; SCHEMA_KINDS: none. */
enum schema_kind schema_find_kind(enum schema_group group, struct str name, bool xml);
/* The nearest name that exists in the model, for "did you mean"; empty when none is near. */
struct str schema_nearest_kind(enum schema_group group, enum schema_model model, struct str name,
                               bool xml);

/* The property of a kind by its native name, or by an XML leaf; *component is the leaf's number
 * among the property's leaves.  SCHEMA_PROPS: none. */
enum schema_prop_id schema_find_prop(enum schema_kind kind, struct str name, bool xml,
                                     unsigned *component);
/* What was probably meant, in the model: the name's twin in the other format, a usual synonym, or
 * the nearest name. */
struct str schema_nearest_prop(enum schema_kind kind, enum schema_model model, struct str name,
                               bool xml);

/* How many XML leaves make the property, and the n-th one's name. */
unsigned schema_leaf_count(enum schema_prop_id prop);
struct str schema_leaf(enum schema_prop_id prop, unsigned n);
/* The property as a user of the format spells it. */
struct str schema_prop_name(enum schema_prop_id prop, bool xml);

/* The number of a word of a TYPE_WORD property (XML: any case); -1: none. */
int schema_find_word(enum schema_prop_id prop, struct str word, bool xml);
/* The n-th word, empty behind the last. */
struct str schema_word(enum schema_prop_id prop, unsigned n, bool xml);

const char *schema_model_name(enum schema_model model);

/* "camera", "a light", ... as messages call members of a group, and "number", "colour", ... */
const char *schema_group_name(enum schema_group group);
const char *schema_type_name(enum schema_type type);

#endif
