/* What the evaluation of both formats shares (internal to src/eval). */
#ifndef WRT_EVAL_CONTEXT_H
#define WRT_EVAL_CONTEXT_H

#include "base/map.h"
#include "eval/eval.h"
#include "schema/index.h"

/* ---- values: before it is known what they are for ---- */

enum value_type {
    VALUE_NONE,  /* not given */
    VALUE_ERROR, /* reported already: passes everywhere in silence */
    VALUE_NUMBER,
    VALUE_VECTOR,
    VALUE_BOOL,
    VALUE_STRING,
    VALUE_LIST,
    VALUE_OBJECT, /* material, texture or surface */
};

struct value {
    uint8_t type;   /* enum value_type */
    uint8_t angles; /* numbers: bit i says that number i is an angle, in degrees */
    bool colour;    /* a vector spelt #rrggbb */
    uint32_t n;     /* numbers of a VALUE_NUMBER (1) or VALUE_VECTOR (2 or 3); items of a list */
    struct span span;
    union {
        double number[3];
        bool boolean;
        struct {
            struct str string;
            uint32_t spelt; /* where in a text: file names start there */
        };
        struct {
            const struct value *items; /* NULL: item i is the number first + i * step */
            double first, step;
        };
        struct desc_object *object;
    };
};

/* ---- names ---- */

struct builtin; /* functions.c */

enum binding_kind { BINDING_VALUE, BINDING_FUNCTION, BINDING_TEMPLATE, BINDING_BUILTIN };

/* What a name stands for. */
struct binding {
    struct binding *next; /* the one before it in its scope */
    struct str name;
    struct span span; /* of the name in its definition */
    enum binding_kind kind;
    bool param;          /* -D may give it another value */
    uint32_t parameters; /* functions and templates: how many */
    union {
        struct value value;
        struct {
            const struct ast_node *node; /* AST_FN, AST_DEFINE */
            struct scope *home;          /* where it was defined */
            bool *busy;                  /* templates: in use; shared by imported copies */
        };
        const struct builtin *builtin;
    };
};

/* What `default KIND { ... }` gives. */
struct fallback {
    struct fallback *next; /* the one before it in its scope */
    const struct desc_object *object;
};

struct scope {
    struct scope *parent;
    struct binding *newest;
    size_t n;
    struct map map; /* to struct binding, once there are many */
    struct fallback *fallbacks;
    const struct ast_node *statements; /* all that it is made of, or NULL */
};

/* ---- where evaluation stands ---- */

struct frame {
    struct diag_frame shown; /* for messages; its parent is the outer frame's */
    struct frame *outer;
    const struct diag_frame *kept; /* its copy in the description, once an object needs it */
};

/* The transform of a group.  Objects point to it at once; its own part is known when the group
 * ends, and the product with the outer ones when everything is read. */
struct place {
    struct affine affine; /* first: desc_object.place points to it */
    const struct place *outer;
    struct place *next; /* the one made after it */
    struct span span;
};

/* The bodies around a statement, in its own file. */
enum inside { INSIDE_BRANCH = 1, INSIDE_GROUP = 2, INSIDE_TEMPLATE = 4 };

struct module; /* include.c */

struct eval {
    const struct eval_options *options;
    bool *define_used; /* one for each of options->defines */
    struct desc *out;
    struct diag *diag;

    struct schema_index index[2]; /* names of properties: native, XML */

    struct arena *scratch; /* values and names; what a statement takes is given back at its end */
    struct scope builtins, *scope;
    struct module *modules, *reading; /* all files met; the one that is read */
    struct frame *frame;

    const struct ast_node *model;            /* the statement that names it, or NULL */
    bool model_unknown;                      /* what belongs to either model passes */
    uint32_t fallback_kinds;                 /* bit for each kind that `default` gave to */
    struct place *first_place, **last_place; /* all, outer ones first */
    struct place *place;                     /* of the groups around; NULL: none moves anything */
    struct desc_prop *group_material;        /* of the groups around, or NULL */
    struct arena group_arena;                /* properties of the groups around */
    VEC(struct span) damaged; /* texts that did not parse: what they name is not missed */
    bool defaults_lost;       /* one of them may be a `default` */
    struct map missed;        /* names that are not defined, to where that was told */
    bool names_lost;          /* a file that may define any name was not read */
    unsigned inside;          /* enum inside */
    unsigned groups;          /* groups and uses around, whatever the file */

    size_t steps;   /* calls, rounds and items made so far */
    unsigned depth; /* nested values and statements */
    unsigned calls; /* nested calls */
    bool given_up;  /* the statement met a limit: its rest is passed over in silence */
    bool stopped;   /* so did the scene */

    struct map ids;       /* XML: id to material */
    size_t first_texture; /* XML: the number of the document's texture 0 */
    size_t names_tried;   /* for "did you mean" so far */
};

/* True when going on is of no use. */
bool eval_stopped(const struct eval *e);

/* Takes steps from what a scene may cost; false after reporting that it costs too much. */
bool eval_spend(struct eval *e, size_t steps, struct span span);

/* Memory for a value of any size; NULL after reporting that the scene holds too much. */
void *eval_alloc(struct eval *e, size_t n, struct span span);

/* One level deeper, for what follows input; false after reporting that it is too deep.  Ends with
 * eval_leave in either case. */
bool eval_enter(struct eval *e, struct span span);
void eval_leave(struct eval *e);

/* A frame around what follows, until frame_close. */
void frame_open(struct eval *e, struct frame *f, enum diag_frame_kind kind, struct span at);
void frame_close(struct eval *e, struct frame *f);
/* The next round of a loop: its variable, and how many were before. */
void frame_next(struct frame *f, const struct value *v, uint32_t i);
/* The frames as the description keeps them; NULL outside all. */
const struct diag_frame *frame_keep(struct eval *e);

/* ---- scope.c ---- */

/* Opens a scope inside `parent` and makes it the current one. */
void scope_open(struct eval *e, struct scope *s, struct scope *parent);
/* Closes the current scope; `outer` becomes the current one. */
void scope_close(struct eval *e, struct scope *outer);

/* The innermost binding of a name; NULL: none. */
struct binding *scope_find(const struct eval *e, struct str name);

/* True when it was told that the name at this place is unknown: at another place, or it may stand
 * in what did not parse. */
bool scope_told(struct eval *e, struct str name, struct span at);
/* The same of a name that may be defined in a file that was not read. */
bool scope_lost(struct eval *e, struct str name, struct span at);

/* A new binding in the current scope; NULL after reporting that the scope has the name. */
struct binding *scope_bind(struct eval *e, struct str name, struct span span,
                           enum binding_kind kind);
/* A name that is no duplicate, in memory of the caller. */
void scope_add(struct scope *s, struct binding *b);
/* Brings all names of a file that was read to the current scope. */
void scope_import(struct eval *e, const struct scope *from, struct span span);

/* Counts a name that is looked at for a message's sake; false when there were too many. */
bool scope_may_try(struct eval *e);
/* Offers the names in sight for "did you mean", unless that was asked too often among too many. */
void scope_try_names(struct eval *e, struct str_nearest *nearest, unsigned binding_kinds);
/* Likewise the names of a map. */
void map_try_names(struct eval *e, const struct map *m, struct str_nearest *nearest);

/* ---- object.c ---- */

/* Memory for the object, and for its properties, comes from `a`. */
struct desc_object *object_new(struct eval *e, struct arena *a, enum schema_kind kind,
                               const struct ast_node *node);

/* Where the value of a property goes; NULL after reporting that it was given before.  `leaf` is
 * the number of the XML leaf (0 for native). */
struct desc_prop *object_prop(struct eval *e, struct arena *a, struct desc_object *o,
                              enum schema_prop_id id, unsigned leaf, struct span name_span);

/* The property called `name`; SCHEMA_PROPS after reporting one that is unknown or of the other
 * model. */
enum schema_prop_id object_find_prop(struct eval *e, const struct desc_object *o, struct str name,
                                     struct span name_span, unsigned *leaf);

/* What another object gives and this one does not say itself. */
void object_inherit(struct eval *e, struct desc_object *o, const struct desc_object *base);
/* Likewise what `default` gives. */
void object_complete(struct eval *e, struct desc_object *o);

/* Adds a light or surface to the description, completed, with the place and material of the groups
 * around; NULL is passed over. */
void object_place(struct eval *e, struct desc_object *o);

/* Adds a finished texture or material to the description and numbers it. */
void object_register(struct eval *e, struct desc_object *o);

/* ---- report.c ---- */

void report_unknown_property(struct eval *e, const struct desc_object *o, struct str name,
                             struct span name_span);

void report_property_of_other_model(struct eval *e, const struct desc_object *o, struct str name,
                                    struct span name_span);
/* True when the scene's model has the kind; false after reporting. */
bool kind_exists(struct eval *e, enum schema_kind kind, struct span span, bool xml);

/* Reports a name of no kind of this group; returns the kind that was meant, or SCHEMA_KINDS. */
enum schema_kind report_unknown_kind(struct eval *e, enum schema_group group, struct str name,
                                     struct span span, bool xml);

/* Reports a word that the property does not take. */
void report_unknown_word(struct eval *e, enum schema_prop_id id, struct str word, struct span span,
                         bool xml);

/* Reports a name that has no meaning, as the value of the property or of something else
 * (SCHEMA_PROPS). */
void report_undefined(struct eval *e, enum schema_prop_id id, const struct ast_node *node);
/* Shows where the node's name, which has no meaning here, gets one; otherwise offers what was
 * probably meant, and returns true. */
bool report_meant(struct eval *e, struct diag_entry *entry, const struct ast_node *node,
                  struct str meant);

/* Values that are right and yet look like a mistake; nothing unless findings of this rule are
 * wanted. */
void report_style(struct eval *e, enum schema_prop_id id, const struct ast_node *property,
                  const struct value *v);
void report_float_comparison(struct eval *e, const struct value *a, const struct value *b,
                             struct span span);

/* ---- xml.c, leaf.c ---- */

void eval_xml(struct eval *e, const struct ast_node *root);
/* The surfaces, lights and textures of an included document. */
void eval_xml_parts(struct eval *e, const struct ast_node *root);
/* Reads the text of an XML leaf as the property's type. */
void eval_leaf(struct eval *e, struct desc_object *o, const struct ast_node *leaf);

/* ---- native.c: statements ---- */

void eval_native(struct eval *e, const struct ast_node *statements);
void eval_statement(struct eval *e, const struct ast_node *node);
void eval_statements(struct eval *e, const struct ast_node *first);
/* The list that a loop goes through; an error value after reporting another value. */
struct value eval_sequence(struct eval *e, const struct ast_node *node);
/* Sets the model of this name; after a wrong one, what was probably meant. */
void eval_model(struct eval *e, struct str name, struct span span);
/* Checks that a file that is included names the scene's model. */
void eval_same_model(struct eval *e, struct str name, struct span span);

/* ---- block.c: objects, groups, uses ---- */

/* `camera { ... }`, `light point { ... }`, `sphere ball { ... }`, `group { ... }` */
void eval_object(struct eval *e, const struct ast_node *node);
/* `default sphere { ... }` */
void eval_default(struct eval *e, const struct ast_node *node);
/* An object of the kind with the properties among the members, not complete yet. */
struct desc_object *eval_block(struct eval *e, enum schema_kind kind, const struct ast_node *node);
/* `chair(gold) { ... }` */
void eval_use(struct eval *e, const struct ast_node *node);
/* Multiplies the transforms of groups by those around them. */
void eval_places(struct eval *e);

/* ---- include.c ---- */

void eval_include(struct eval *e, const struct ast_node *node);
/* The scene's own file, which counts as one; opens its scope. */
void modules_begin(struct eval *e, const char *path);
void modules_end(struct eval *e);
/* True in a file that is included. */
bool modules_inside(const struct eval *e);

/* ---- value.c, arith.c, call.c ---- */

struct value eval_value(struct eval *e, const struct ast_node *node);
/* A value that must be true or false; false after reporting another. */
bool eval_condition(struct eval *e, const struct ast_node *node, bool *out);
const char *value_type_name(const struct value *v);

/* Item i of a list. */
struct value value_item(const struct value *list, size_t i);
/* False after reporting that a list may not be so long. */
bool list_allowed(struct eval *e, double n, struct span span);
/* An array for n items; NULL after reporting that they are too many. */
struct value *list_reserve(struct eval *e, size_t n, struct span span);

/* a operator b; everything but && and ||. */
struct value value_combine(struct eval *e, enum ast_operator operator, const struct value * a,
                           const struct value *b, struct span span);
struct value value_prefix(struct eval *e, enum ast_operator operator, const struct value * a,
                          struct span span);

static inline bool value_is_numeric(const struct value *v)
{
    return v->type == VALUE_NUMBER || v->type == VALUE_VECTOR;
}

/* Number i, where a single number stands for all. */
static inline double value_number(const struct value *v, uint32_t i)
{
    return v->number[v->n > 1 ? i : 0];
}

static inline bool value_is_angle(const struct value *v, uint32_t i)
{
    return v->angles >> (v->n > 1 ? i : 0) & 1;
}

static inline struct value value_error(struct span span)
{
    return (struct value){.type = VALUE_ERROR, .span = span};
}

static inline struct value value_of_number(double x)
{
    return (struct value){.type = VALUE_NUMBER, .n = 1, .number = {x}};
}

static inline struct value value_of_angle(double degrees)
{
    return (struct value){.type = VALUE_NUMBER, .angles = 1, .n = 1, .number = {degrees}};
}

static inline struct value value_of_vec3(struct vec3 v)
{
    return (struct value){.type = VALUE_VECTOR, .n = 3, .number = {v.x, v.y, v.z}};
}

/* True when the value holds nothing of the scratch memory. */
static inline bool value_is_flat(const struct value *v)
{
    return v->type != VALUE_LIST && v->type != VALUE_STRING;
}

/* One value for each parameter, VALUE_NONE for those not given. */
struct arguments {
    struct value *at;
    uint32_t n;
};

struct value eval_call(struct eval *e, const struct ast_node *node);

/* Evaluates the arguments of a call or use; false after errors. */
bool eval_arguments(struct eval *e, const struct binding *b, const struct ast_node *use,
                    struct arguments *out);
/* Binds them in the current scope, which is the function's or template's own; false after errors
 * in values that parameters have of themselves. */
bool bind_arguments(struct eval *e, const struct binding *b, const struct arguments *a);

/* ---- functions.c, spell.c ---- */

/* Binds all functions and constants of the language in the current scope. */
void builtins_bind(struct eval *e);
struct value builtin_call(struct eval *e, const struct builtin *f, const struct ast_node *call,
                          const struct arguments *arguments);
struct str builtin_parameter(const struct builtin *f, uint32_t i);
uint32_t builtin_required(const struct builtin *f);
/* True when arguments may follow the last parameter. */
bool builtin_takes_more(const struct builtin *f);

/* Room for a string; NULL after reporting that it is too long. */
char *string_reserve(struct eval *e, size_t n, struct span span);

/* The value in words; digits below 0: the shortest spelling of each number. */
struct value value_text(struct eval *e, const struct value *v, int digits, struct span span);

/* ---- convert.c ---- */

/* The value as the property's type; false after reporting that it does not fit. */
bool value_convert(struct eval *e, enum schema_prop_id id, const struct value *v,
                   struct desc_value *out);

#endif
