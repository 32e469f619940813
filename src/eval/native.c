/* Evaluation of the native language: statements, blocks, names. */
#include "config.h"

#include "eval/context.h"

static void bind(struct eval *e, const struct ast_node *node, struct value v)
{
    struct binding *old = map_get(&e->names, node->name);
    if (old) {
        struct diag_entry *entry = diag_report(e->diag, DIAG_DUPLICATE_NAME, node->name_span,
                                               "'%.*s' is defined twice", STR_ARG(node->name));
        diag_label(entry, old->span, "first defined here");
        return;
    }
    struct binding *b = arena_zalloc(&e->out->arena, 1, sizeof *b);
    *b = (struct binding){.name = node->name, .span = node->name_span, .value = v};
    map_set(&e->names, node->name, b);
}

static void eval_let(struct eval *e, const struct ast_node *node)
{
    bind(e, node, eval_value(e, node->children));
}

static void eval_param(struct eval *e, const struct ast_node *node)
{
    struct value v = eval_value(e, node->children);
    for (size_t i = 0; i < e->options->define_count; i++) {
        if (!str_equal(e->options->defines[i].name, node->name))
            continue;
        v = eval_value(e, e->options->defines[i].value);
        e->define_used[i] = true;
    }
    bind(e, node, v);
}

/* `material a = v` and `texture a = v`: a let that says what v is. */
static void eval_named(struct eval *e, const struct ast_node *node, enum schema_group group)
{
    struct value v = eval_value(e, node->children);
    bool fits = v.type == VALUE_OBJECT && schema_kinds[v.object->kind].group == group;
    if (v.type != VALUE_ERROR && !fits) {
        diag_report(e->diag, DIAG_WRONG_TYPE, v.span, "expected a %s, but found %s",
                    schema_group_name(group), value_type_name(&v));
        v.type = VALUE_ERROR;
    }
    if (fits && !v.object->name.n)
        v.object->name = node->name;
    bind(e, node, v);
}

static void eval_model(struct eval *e, const struct ast_node *node)
{
    if (str_is(node->name, "classic"))
        e->out->model = MODEL_CLASSIC;
    else if (str_is(node->name, "modern"))
        e->out->model = MODEL_MODERN;
    else {
        struct diag_entry *entry = diag_report(e->diag, DIAG_MODEL, node->name_span,
                                               "there is no model '%.*s'", STR_ARG(node->name));
        struct str_nearest nearest = str_nearest_to(node->name);
        str_nearest_try(&nearest, str_of("classic"));
        str_nearest_try(&nearest, str_of("modern"));
        diag_did_you_mean(entry, node->name_span, str_nearest_found(&nearest));
        e->out->model = MODEL_CLASSIC;
    }
}

/* The value of a property whose values are words: `shape: sphere`. */
static bool eval_word(struct eval *e, enum schema_prop_id id, const struct ast_node *node,
                      struct desc_value *out)
{
    int word = schema_find_word(id, node->name, false);
    if (word >= 0)
        out->word = (unsigned)word;
    else
        report_unknown_word(e, id, node->name, node->span, false);
    return word >= 0;
}

static void eval_property(struct eval *e, struct desc_object *o, const struct ast_node *node)
{
    const struct ast_node *value = node->children;
    unsigned leaf;
    enum schema_prop_id id = object_find_prop(e, o, node->name, node->name_span, &leaf);
    struct desc_prop *p = id != SCHEMA_PROPS ? object_prop(e, o, id, leaf, node->name_span) : NULL;
    bool fits = false;
    if (p && schema_props[id].type == TYPE_WORD && value->kind == AST_NAME &&
        !map_get(&e->names, value->name)) {
        fits = eval_word(e, id, value, &p->value);
    } else {
        struct value v = eval_value(e, value);
        fits = p && value_convert(e, id, &v, &p->value);
    }
    if (p) {
        p->value.span = value->span;
        p->broken = !fits;
    }
    o->broken |= !fits;
}

/* What the base gives and the new object does not say itself. */
static void inherit(struct eval *e, struct desc_object *o, const struct desc_object *base)
{
    for (const struct desc_prop *p = base->props; p; p = p->next) {
        if (desc_get(o, (enum schema_prop_id)p->id))
            continue;
        struct desc_prop *copy = object_prop(e, o, (enum schema_prop_id)p->id, 0, p->name_span);
        struct desc_prop *next = copy->next;
        *copy = *p;
        copy->next = next;
        copy->inherited = true;
    }
    o->broken |= base->broken;
}

struct desc_object *eval_block(struct eval *e, enum schema_kind kind, const struct ast_node *node,
                               const struct desc_object *base)
{
    struct desc_object *o = object_new(e, kind, node);
    for (const struct ast_node *m = node->children; m; m = m->next) {
        if (m->kind == AST_PROPERTY) {
            eval_property(e, o, m);
        } else if (m->kind != AST_ERROR) {
            diag_report(e->diag, DIAG_MISPLACED, m->name_span,
                        "a statement cannot stand in a block of '%s'", schema_kinds[kind].native);
        } else {
            o->broken = true;
        }
    }
    if (base)
        inherit(e, o, base);
    return o;
}

static void set_camera(struct eval *e, const struct ast_node *node)
{
    struct desc_object *o = eval_block(e, KIND_CAMERA, node, NULL);
    if (e->out->camera) {
        struct diag_entry *entry = diag_report(e->diag, DIAG_DUPLICATE_OBJECT, node->name_span,
                                               "the scene has two cameras");
        diag_label(entry, e->out->camera->span, "the first is here");
        return;
    }
    e->out->camera = o;
}

/* `light point { ... }`: the label is the kind. */
static void add_light(struct eval *e, const struct ast_node *node)
{
    if (!node->label.n) {
        diag_report(e->diag, DIAG_MISSING_PROPERTY, node->name_span,
                    "'light' needs a kind: 'light point' or 'light area'");
        return;
    }
    enum schema_kind kind = schema_find_kind(SCHEMA_LIGHT, node->label, false);
    if (kind == SCHEMA_KINDS) {
        struct str head = srcmap_text(e->diag->sources, node->span);
        uint32_t skip = (uint32_t)(node->label.at - head.at);
        uint32_t begin = node->span.begin + skip;
        report_unknown_kind(e, SCHEMA_LIGHT, node->label,
                            (struct span){begin, begin + (uint32_t)node->label.n}, false);
        return;
    }
    struct desc_object *o = eval_block(e, kind, node, NULL);
    o->name = (struct str){0};
    object_place(e, o);
}

static void report_unknown_statement(struct eval *e, const struct ast_node *node)
{
    e->out->incomplete = true;
    struct diag_entry *entry = diag_report(e->diag, DIAG_UNKNOWN_KIND, node->name_span,
                                           "unknown kind '%.*s'", STR_ARG(node->name));
    struct str_nearest nearest = str_nearest_to(node->name);
    str_nearest_try(&nearest, str_of("camera"));
    str_nearest_try(&nearest, str_of("light"));
    for (int k = 0; k < SCHEMA_KINDS; k++)
        if (schema_kinds[k].group == SCHEMA_SURFACE)
            str_nearest_try(&nearest, str_of(schema_kinds[k].native));
    diag_did_you_mean(entry, node->name_span, str_nearest_found(&nearest));
    diag_note(entry, "there are: camera light sphere cylinder triangle quad mesh");
}

static void eval_object(struct eval *e, const struct ast_node *node)
{
    enum schema_kind kind = schema_find_kind(SCHEMA_SURFACE, node->name, false);
    if (str_is(node->name, "camera"))
        set_camera(e, node);
    else if (str_is(node->name, "light"))
        add_light(e, node);
    else if (kind == SCHEMA_KINDS)
        report_unknown_statement(e, node);
    else
        object_place(e, eval_block(e, kind, node, NULL));
}

static void eval_statement(struct eval *e, const struct ast_node *node)
{
    switch (node->kind) {
    case AST_MODEL:
        eval_model(e, node);
        break;
    case AST_LET:
        eval_let(e, node);
        break;
    case AST_PARAM:
        eval_param(e, node);
        break;
    case AST_MATERIAL:
        eval_named(e, node, SCHEMA_MATERIAL);
        break;
    case AST_TEXTURE:
        eval_named(e, node, SCHEMA_TEXTURE);
        break;
    case AST_BLOCK:
        eval_object(e, node);
        break;
    case AST_VERSION:
    case AST_ERROR:
        break;
    default:
        diag_report(e->diag, DIAG_MISPLACED, node->span,
                    "this statement is not evaluated by this version");
        break;
    }
}

static void require_classic(struct eval *e, const struct ast_node *model)
{
    if (e->out->model == MODEL_CLASSIC)
        return;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_MODEL, model ? model->name_span : e->out->start,
                    "the model 'modern' is not available; this version renders 'classic'");
    diag_note(entry, model ? "write 'model classic'"
                           : "a scene that names no model is modern; add the line 'model classic'");
}

void eval_native(struct eval *e, const struct ast_node *statements)
{
    const struct ast_node *model = NULL;
    bool damaged = false;
    e->out->model = MODEL_MODERN;
    for (const struct ast_node *s = statements; s && !diag_full(e->diag); s = s->next) {
        damaged |= s->kind == AST_ERROR;
        if (s->kind == AST_MODEL && model) {
            struct diag_entry *entry = diag_report(e->diag, DIAG_DUPLICATE_OBJECT, s->name_span,
                                                   "the model is given twice");
            diag_label(entry, model->name_span, "first given here");
            continue;
        }
        if (s->kind == AST_MODEL)
            model = s;
        eval_statement(e, s);
    }
    if (model || !damaged) /* else the model may stand in what did not parse */
        require_classic(e, model);
}
