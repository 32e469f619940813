/* The description: what a scene text says once names are resolved and values are typed.  Every
 * value keeps its span; nothing is defaulted yet.  Immutable after evaluation. */
#ifndef WRT_EVAL_DESC_H
#define WRT_EVAL_DESC_H

#include "ast/ast.h"
#include "base/arena.h"
#include "base/map.h"
#include "base/vec.h"
#include "diag/diag.h"
#include "math/transform.h"
#include "schema/schema.h"

struct desc_value {
    struct span span;
    uint32_t n; /* numbers or points given */
    union {
        double number[3];    /* numbers, vectors, colours; degrees for angles */
        struct vec3 *points; /* TYPE_POINTS */
        struct {             /* TYPE_FILE */
            struct str string;
            uint32_t spelt; /* a place in the text that spells it: relative paths start there */
        };
        const struct affine *matrix; /* TYPE_MATRIX */
        unsigned word;               /* TYPE_WORD: its number */
        struct desc_object *object;  /* TYPE_MATERIAL, TYPE_TEXTURE, TYPE_SURFACE */
        struct {                     /* TYPE_SIZE */
            double size[2];          /* as number */
            struct span second;      /* XML: of the second leaf */
        };
    };
};

struct desc_prop {
    struct desc_prop *next; /* in the order given */
    struct span name_span;
    uint8_t id;     /* enum schema_prop_id */
    uint8_t leaves; /* XML: bit n for each leaf of the property that is given */
    bool broken;    /* the value was reported already */
    bool inherited; /* from another object, which answers for it */
    struct desc_value value;
};

/* What scenes hold by the million: small. */
struct desc_object {
    enum schema_kind kind;
    uint32_t number;  /* among the description's textures or materials */
    struct span span; /* the words that open it */
    struct str name;  /* label or id; may be empty */
    struct desc_prop *props;
    const struct affine *place;     /* surfaces, lights: of the groups around it; NULL: identity */
    const struct diag_frame *frame; /* how evaluation came to it; NULL: straight */
    uint8_t model;                  /* enum schema_model: of its scene */
    bool xml;                       /* spelt in XML: messages use its names */
    bool broken;                    /* an error was reported inside, so absences mean nothing */
};

struct desc {
    struct arena arena;
    enum schema_model model;
    struct span model_span; /* its name, or the scene's start */
    bool xml;
    bool incomplete;   /* something at the top was not understood, so absences mean nothing */
    struct span start; /* the scene's first bytes, for what is missing altogether */
    struct desc_object *camera, *settings; /* or NULL */
    VEC(struct desc_object *) textures, materials, lights, surfaces;
    VEC(struct desc_object *) defaults; /* what `default` gave: only to be validated */
    VEC(struct ast *) included;         /* trees of the files included; texts point into them */
    struct map brought;          /* the place of an include's string to the tree it brought */
    VEC(struct span) overridden; /* names of params that -D gives */
};

void desc_free(struct desc *d);

/* The tree that an include brought (its node is borrowed); NULL: it was not evaluated. */
void desc_set_brought(struct desc *d, const struct ast_node *include, struct ast *tree);
const struct ast *desc_brought(const struct desc *d, const struct ast_node *include);

/* True of a file of definitions, to be included: it is no scene, and lacks nothing. */
bool desc_is_part(const struct desc *d, const struct ast *ast);

/* The property as it was given, or NULL when it was not. */
const struct desc_prop *desc_find(const struct desc_object *o, enum schema_prop_id id);

/* The property's value, or NULL when it is not given. */
const struct desc_value *desc_get(const struct desc_object *o, enum schema_prop_id id);

/* The property's numbers, or else the default in the object's model (which it must have). */
struct vec3 desc_vector(const struct desc_object *o, enum schema_prop_id id);
double desc_number(const struct desc_object *o, enum schema_prop_id id);
unsigned desc_word(const struct desc_object *o, enum schema_prop_id id);

#endif
