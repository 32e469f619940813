#include "config.h"

#include "schema/schema.h"

#include <assert.h>

const struct schema_kind_row schema_kinds[SCHEMA_KINDS] = {
#define KIND(id, group_, models_, native_, xml_, doc_) \
    [KIND_##id] = {SCHEMA_##group_, IN_##models_, native_, xml_, doc_},
#include "schema/schema.def"
};

static const struct {
    enum schema_kind kind;
    const char *xml;
} aliases[] = {
#define ALIAS(id, xml_) {KIND_##id, xml_},
#include "schema/schema.def"
};

static const struct {
    const char *words, *natives;
} synonyms[] = {
#define SYNONYM(words_, natives_) {words_, natives_},
#include "schema/schema.def"
};

/* Fields of the rows. */
#define K(id) (UINT32_C(1) << KIND_##id)
#define REQUIRED .required = IN_BOTH
#define REQUIRED_IN(model) .required = IN_##model
#define DEFAULT(...) .has_default = IN_BOTH, .value = {{__VA_ARGS__}, {__VA_ARGS__}}
#define DEFAULT_IN(model, ...) .value[SCHEMA_##model] = {__VA_ARGS__}
#define HAS_DEFAULT_IN(models) .has_default = IN_##models
#define RANGE_FROM(x) .has_least = true, .least = (x)
#define RANGE_ABOVE(x) .has_least = true, .above = true, .least = (x)

const struct schema_prop schema_props[SCHEMA_PROPS] = {
#define PROP(id, kinds_, models_, native_, xml_, type_, doc_, ...) \
    [PROP_##id] = {.kinds = (kinds_),                              \
                   .models = IN_##models_,                         \
                   .native = native_,                              \
                   .xml = xml_,                                    \
                   .type = TYPE_##type_,                           \
                   .doc = doc_,                                    \
                   ##__VA_ARGS__},
#include "schema/schema.def"
};

static_assert(SCHEMA_PROPS <= 255, "desc_prop.id is a byte");
static_assert(SCHEMA_KINDS <= 32, "schema_prop.kinds has a bit for each kind");

/* The native (left) or XML (right) half of "native=xml". */
static struct str half_of(struct str pair, bool xml)
{
    const char *equals = pair.n ? memchr(pair.at, '=', pair.n) : NULL;
    if (!equals)
        return pair;
    size_t left = (size_t)(equals - pair.at);
    return xml ? (struct str){equals + 1, pair.n - left - 1} : (struct str){pair.at, left};
}

const char *schema_kind_name(enum schema_kind kind, bool xml)
{
    return xml ? schema_kinds[kind].xml : schema_kinds[kind].native;
}

/* What follows `light` or `class=`: the word that tells the kinds of a group apart. */
static const char *kind_word(enum schema_kind k, bool xml)
{
    const char *native = schema_kinds[k].native, *space = strchr(native, ' ');
    return xml ? schema_kinds[k].xml : space ? space + 1 : native;
}

enum schema_kind schema_find_kind(enum schema_group group, struct str name, bool xml)
{
    for (int k = 0; k < SCHEMA_KINDS; k++)
        if (schema_kinds[k].group == group && str_is(name, kind_word((enum schema_kind)k, xml)))
            return (enum schema_kind)k;
    for (size_t i = 0; xml && i < sizeof aliases / sizeof *aliases; i++)
        if (schema_kinds[aliases[i].kind].group == group && str_is(name, aliases[i].xml))
            return aliases[i].kind;
    return SCHEMA_KINDS;
}

struct str schema_nearest_kind(enum schema_group group, enum schema_model model, struct str name,
                               bool xml)
{
    struct str_nearest nearest = str_nearest_to(name);
    for (int k = 0; k < SCHEMA_KINDS; k++)
        if (schema_kinds[k].group == group && (schema_kinds[k].models >> model & 1))
            str_nearest_try(&nearest, str_of(kind_word((enum schema_kind)k, xml)));
    return str_nearest_found(&nearest);
}

enum schema_prop_id schema_find_prop(enum schema_kind kind, struct str name, bool xml,
                                     unsigned *component)
{
    *component = 0;
    for (int p = 0; p < SCHEMA_PROPS; p++) {
        enum schema_prop_id id = (enum schema_prop_id)p;
        if (!schema_has(kind, id))
            continue;
        if (!xml && str_is(name, schema_props[p].native))
            return id;
        struct str leaf;
        for (unsigned n = 0; xml && (leaf = schema_leaf(id, n)).n; n++) {
            if (str_equal(name, leaf)) {
                *component = n;
                return id;
            }
        }
    }
    return SCHEMA_PROPS;
}

static bool has_word(const char *list, struct str word)
{
    struct str each;
    for (unsigned n = 0; (each = str_nth_word(list, n)).n; n++)
        if (str_equal(each, word))
            return true;
    return false;
}

/* The property by its name in the other format, or by one that it has in other programs. */
static enum schema_prop_id find_synonym(enum schema_kind kind, struct str name, bool xml)
{
    unsigned leaf;
    enum schema_prop_id id = schema_find_prop(kind, name, !xml, &leaf);
    for (size_t i = 0; id == SCHEMA_PROPS && i < sizeof synonyms / sizeof *synonyms; i++) {
        struct str native;
        if (has_word(synonyms[i].words, name))
            for (unsigned n = 0;
                 id == SCHEMA_PROPS && (native = str_nth_word(synonyms[i].natives, n)).n; n++)
                id = schema_find_prop(kind, native, false, &leaf);
    }
    return id;
}

struct str schema_nearest_prop(enum schema_kind kind, enum schema_model model, struct str name,
                               bool xml)
{
    struct str_nearest nearest = str_nearest_to(name);
    enum schema_prop_id meant = find_synonym(kind, name, xml);
    if (meant != SCHEMA_PROPS && schema_props[meant].models >> model & 1 &&
        !(xml && schema_leaf_count(meant) != 1))
        return schema_prop_name(meant, xml);
    for (int p = 0; p < SCHEMA_PROPS; p++) {
        enum schema_prop_id id = (enum schema_prop_id)p;
        struct str leaf;
        if (!schema_has(kind, id) || !(schema_props[id].models >> model & 1))
            continue;
        if (!xml)
            str_nearest_try(&nearest, str_of(schema_props[p].native));
        for (unsigned n = 0; xml && (leaf = schema_leaf(id, n)).n; n++)
            str_nearest_try(&nearest, leaf);
    }
    return str_nearest_found(&nearest);
}

struct str schema_leaf(enum schema_prop_id prop, unsigned n)
{
    return str_nth_word(schema_props[prop].xml, n);
}

unsigned schema_leaf_count(enum schema_prop_id prop)
{
    unsigned n = 0;
    while (schema_leaf(prop, n).n)
        n++;
    return n;
}

struct str schema_prop_name(enum schema_prop_id prop, bool xml)
{
    return xml ? schema_leaf(prop, 0) : str_of(schema_props[prop].native);
}

struct str schema_word(enum schema_prop_id prop, unsigned n, bool xml)
{
    return half_of(str_nth_word(schema_props[prop].words, n), xml);
}

int schema_find_word(enum schema_prop_id prop, struct str word, bool xml)
{
    struct str known;
    for (unsigned n = 0; (known = schema_word(prop, n, xml)).n; n++)
        if (xml ? str_equal_nocase(word, known) : str_equal(word, known))
            return (int)n;
    return -1;
}

const char *schema_model_name(enum schema_model model)
{
    return model == SCHEMA_MODERN ? "modern" : "classic";
}

const char *schema_group_name(enum schema_group group)
{
    static const char *const names[SCHEMA_GROUPS] = {
        [SCHEMA_CAMERA] = "camera",     [SCHEMA_SETTINGS] = "settings", [SCHEMA_LIGHT] = "light",
        [SCHEMA_TEXTURE] = "texture",   [SCHEMA_SURFACE] = "surface",   [SCHEMA_PLACE] = "group",
        [SCHEMA_MATERIAL] = "material",
    };
    return names[group];
}

const char *schema_type_name(enum schema_type type)
{
    static const char *const names[SCHEMA_TYPES] = {
        [TYPE_NUMBER] = "a number",
        [TYPE_INTEGER] = "a whole number",
        [TYPE_ANGLE] = "an angle",
        [TYPE_SWITCH] = "0 or 1",
        [TYPE_NUMBER_OR_SWITCH] = "a number",
        [TYPE_VECTOR] = "three numbers",
        [TYPE_VECTOR_OR_PAIR] = "two or three numbers",
        [TYPE_SCALE] = "three factors",
        [TYPE_COLOUR] = "a colour",
        [TYPE_ROTATION] = "three angles",
        [TYPE_MATRIX] = "a list of twelve numbers",
        [TYPE_SIZE] = "two whole numbers",
        [TYPE_POINTS] = "a list of points",
        [TYPE_WORD] = "a word",
        [TYPE_FILE] = "a file name",
        [TYPE_MATERIAL] = "a material",
        [TYPE_TEXTURE] = "a texture",
        [TYPE_SURFACE] = "a surface",
    };
    return names[type];
}
