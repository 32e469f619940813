/* Evaluation of the XML format: elements to objects. */
#include "config.h"

#include "eval/context.h"

enum attribute { ATTRIBUTE_CLASS = 1, ATTRIBUTE_ID = 2, ATTRIBUTE_REF = 4, ATTRIBUTE_MODEL = 8 };

static const struct {
    const char *name;
    enum attribute bit;
} attribute_names[] = {{"class", ATTRIBUTE_CLASS},
                       {"id", ATTRIBUTE_ID},
                       {"ref", ATTRIBUTE_REF},
                       {"model", ATTRIBUTE_MODEL}};
enum { ATTRIBUTES = sizeof attribute_names / sizeof *attribute_names };

/* The attributes of an element: the node of each, or NULL. */
struct attributes {
    const struct ast_node *class, *id, *ref, *model;
    bool broken; /* others were reported */
};

static const struct ast_node **attribute_slot(struct attributes *a, enum attribute bit)
{
    return bit == ATTRIBUTE_CLASS ? &a->class
           : bit == ATTRIBUTE_ID  ? &a->id
           : bit == ATTRIBUTE_REF ? &a->ref
                                  : &a->model;
}

static struct str attribute_text(const struct ast_node *attribute)
{
    return str_trim(attribute->children->text);
}

static struct span attribute_span(const struct ast_node *attribute)
{
    return attribute->children->span;
}

static void report_attribute(struct eval *e, const struct ast_node *a, const char *element,
                             unsigned allowed)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_ATTRIBUTE, a->name_span, "unknown attribute '%.*s' of %s",
                    STR_ARG(a->name), element);
    struct str_nearest nearest = str_nearest_to(a->name);
    for (int i = 0; i < ATTRIBUTES; i++)
        if (allowed & attribute_names[i].bit)
            str_nearest_try(&nearest, str_of(attribute_names[i].name));
    diag_did_you_mean(entry, a->name_span, str_nearest_found(&nearest));
}

/* Collects the attributes among the children; those not allowed are reported. */
static struct attributes take_attributes(struct eval *e, const struct ast_node *node,
                                         const char *element, unsigned allowed)
{
    struct attributes out = {0};
    for (const struct ast_node *a = node->children; a; a = a->next) {
        if (a->kind != AST_ATTRIBUTE)
            continue;
        int i = 0;
        while (i < ATTRIBUTES &&
               !(str_is(a->name, attribute_names[i].name) && (allowed & attribute_names[i].bit)))
            i++;
        if (i == ATTRIBUTES) {
            report_attribute(e, a, element, allowed);
            out.broken = true;
            continue;
        }
        const struct ast_node **slot = attribute_slot(&out, attribute_names[i].bit);
        if (*slot)
            diag_report(e->diag, DIAG_DUPLICATE_PROPERTY, a->name_span,
                        "the attribute '%s' is given twice", attribute_names[i].name);
        else
            *slot = a;
    }
    return out;
}

/* The kind that an element's class names; SCHEMA_KINDS after reporting. */
static enum schema_kind take_kind(struct eval *e, const struct ast_node *node,
                                  const struct attributes *a, enum schema_group group)
{
    if (!a->class && a->broken)
        return SCHEMA_KINDS; /* probably misspelt */
    if (!a->class) {
        diag_report(e->diag, DIAG_MISSING_PROPERTY, node->name_span,
                    "'%.*s' needs a 'class' attribute that names the kind of %s",
                    STR_ARG(node->name), schema_group_name(group));
        return SCHEMA_KINDS;
    }
    struct str name = attribute_text(a->class);
    enum schema_kind kind = schema_find_kind(group, name, true);
    if (kind == SCHEMA_KINDS)
        kind = report_unknown_kind(e, group, name, attribute_span(a->class), true);
    else if (!kind_exists(e, kind, attribute_span(a->class), true))
        kind = SCHEMA_KINDS;
    return kind;
}

static struct desc_object *eval_material(struct eval *e, const struct ast_node *node);
static struct desc_object *eval_surface(struct eval *e, const struct ast_node *node, bool labelled);

/* An element inside an object: a material, a light's object, or one that should be a leaf. */
static void eval_inner_element(struct eval *e, struct desc_object *o, const struct ast_node *node)
{
    unsigned leaf;
    enum schema_prop_id id = object_find_prop(e, o, node->name, node->name_span, &leaf);
    struct desc_prop *p =
        id != SCHEMA_PROPS ? object_prop(e, &e->out->arena, o, id, leaf, node->name_span) : NULL;
    if (!p) {
        o->broken = true;
        return;
    }
    p->value.span = node->name_span;
    switch (schema_props[id].type) {
    case TYPE_MATERIAL:
        p->value.object = eval_material(e, node);
        break;
    case TYPE_SURFACE:
        p->value.object = eval_surface(e, node, false);
        break;
    default:
        diag_report(e->diag, DIAG_WRONG_TYPE, node->name_span,
                    "'%.*s' takes %s, without attributes or elements inside", STR_ARG(node->name),
                    schema_type_name(schema_props[id].type));
        p->broken = o->broken = true;
        return;
    }
    p->broken = !p->value.object;
    o->broken |= p->broken;
}

static void eval_members(struct eval *e, struct desc_object *o, const struct ast_node *node)
{
    for (const struct ast_node *m = node->children; m && !eval_stopped(e); m = m->next) {
        if (m->kind == AST_PROPERTY)
            eval_leaf(e, o, m);
        else if (m->kind == AST_BLOCK)
            eval_inner_element(e, o, m);
        else if (m->kind == AST_TEXT && m->text.n)
            diag_report(e->diag, DIAG_MISPLACED, m->span, "text cannot stand between elements");
    }
}

static struct desc_object *new_material(struct eval *e, const struct ast_node *node,
                                        const struct attributes *a)
{
    enum schema_kind kind = take_kind(e, node, a, SCHEMA_MATERIAL);
    if (kind == SCHEMA_KINDS)
        return NULL;
    struct desc_object *o = object_new(e, &e->out->arena, kind, node);
    eval_members(e, o, node);
    object_register(e, o);
    return o;
}

/* A material with an id. */
struct named {
    struct str name;
    struct span span;
    const struct ast_node *node;
    bool asked_for;
    struct desc_object *object; /* evaluated when first asked for; NULL before and after errors */
};

static struct desc_object *named_material(struct eval *e, struct named *m)
{
    if (!m->asked_for) {
        m->asked_for = true;
        struct attributes a =
            take_attributes(e, m->node, "a material", ATTRIBUTE_CLASS | ATTRIBUTE_ID);
        m->object = new_material(e, m->node, &a);
        if (m->object)
            m->object->name = m->name;
    }
    return m->object;
}

static void report_unknown_id(struct eval *e, struct str name, struct span span)
{
    struct diag_entry *entry = diag_report(e->diag, DIAG_UNKNOWN_NAME, span,
                                           "no material has the id '%.*s'", STR_ARG(name));
    struct str_nearest nearest = str_nearest_to(name);
    map_try_names(e, &e->ids, &nearest);
    diag_did_you_mean(entry, span, str_nearest_found(&nearest));
}

static struct desc_object *referenced_material(struct eval *e, const struct ast_node *node,
                                               const struct attributes *a)
{
    struct str name = attribute_text(a->ref);
    struct named *named = map_get(&e->ids, name);
    if (!named)
        report_unknown_id(e, name, attribute_span(a->ref));
    for (const struct ast_node *m = node->children; m; m = m->next)
        if (m->kind != AST_ATTRIBUTE)
            diag_report(e->diag, DIAG_CONFLICT, m->span,
                        "a material with 'ref' takes nothing else");
    return named ? named_material(e, named) : NULL;
}

static struct desc_object *eval_material(struct eval *e, const struct ast_node *node)
{
    for (const struct ast_node *c = node->children; c; c = c->next) {
        if (c->kind != AST_ATTRIBUTE || !str_is(c->name, "id"))
            continue;
        struct named *named = map_get(&e->ids, attribute_text(c));
        if (named && named->node == node)
            return named_material(e, named);
    }
    struct attributes a =
        take_attributes(e, node, "a material", ATTRIBUTE_CLASS | ATTRIBUTE_ID | ATTRIBUTE_REF);
    return a.ref ? referenced_material(e, node, &a) : new_material(e, node, &a);
}

/* Ids may be used before the material they name, so they are collected first. */
static void collect_ids(struct eval *e, const struct ast_node *node)
{
    for (const struct ast_node *c = node->children; c; c = c->next) {
        if (c->kind == AST_BLOCK)
            collect_ids(e, c);
        if (c->kind != AST_ATTRIBUTE || !str_is(c->name, "id") || !str_is(node->name, "material"))
            continue;
        struct str name = attribute_text(c);
        struct named *named = map_get(&e->ids, name);
        if (named) {
            struct diag_entry *entry = diag_report(e->diag, DIAG_DUPLICATE_NAME, attribute_span(c),
                                                   "the id '%.*s' is given twice", STR_ARG(name));
            diag_label(entry, named->span, "first given here");
            continue;
        }
        named = arena_alloc(e->scratch, sizeof *named);
        *named = (struct named){.name = name, .span = attribute_span(c), .node = node};
        map_set(&e->ids, name, named);
    }
}

static struct desc_object *eval_item(struct eval *e, const struct ast_node *node,
                                     enum schema_group group, unsigned allowed)
{
    struct attributes a = take_attributes(e, node, schema_group_name(group), allowed);
    enum schema_kind kind = group == SCHEMA_TEXTURE    ? KIND_IMAGE
                            : group == SCHEMA_CAMERA   ? KIND_CAMERA
                            : group == SCHEMA_SETTINGS ? KIND_SETTINGS
                                                       : take_kind(e, node, &a, group);
    if (kind == SCHEMA_KINDS)
        return NULL;
    struct desc_object *o = object_new(e, &e->out->arena, kind, node);
    if (a.id)
        o->name = attribute_text(a.id);
    eval_members(e, o, node);
    return o;
}

static struct desc_object *eval_surface(struct eval *e, const struct ast_node *node, bool labelled)
{
    unsigned allowed = ATTRIBUTE_CLASS | (labelled ? ATTRIBUTE_ID : 0);
    return eval_item(e, node, SCHEMA_SURFACE, allowed);
}

static void add_camera(struct eval *e, const struct ast_node *node)
{
    e->out->camera = eval_item(e, node, SCHEMA_CAMERA, 0);
}

static void add_settings(struct eval *e, const struct ast_node *node)
{
    if (kind_exists(e, KIND_SETTINGS, node->name_span, true))
        e->out->settings = eval_item(e, node, SCHEMA_SETTINGS, 0);
}

static void add_light(struct eval *e, const struct ast_node *node)
{
    object_place(e, eval_item(e, node, SCHEMA_LIGHT, ATTRIBUTE_CLASS | ATTRIBUTE_ID));
}

/* A texture that is broken keeps its number, so that indexes still mean what they say. */
static void add_texture(struct eval *e, const struct ast_node *node)
{
    object_register(e, eval_item(e, node, SCHEMA_TEXTURE, ATTRIBUTE_ID));
}

static void add_surface(struct eval *e, const struct ast_node *node)
{
    object_place(e, eval_surface(e, node, true));
}

/* The children of the root, in the order they are evaluated: surfaces and lights use textures. */
static const struct section {
    const char *name;
    bool array;
    void (*add)(struct eval *e, const struct ast_node *node);
} sections[] = {{"camera", false, add_camera},
                {"settings", false, add_settings},
                {"textures", true, add_texture},
                {"lights", true, add_light},
                {"surfaces", true, add_surface}};
enum { SECTIONS = sizeof sections / sizeof *sections };

static void eval_section(struct eval *e, const struct section *s, const struct ast_node *node)
{
    if (!s->array) {
        s->add(e, node);
        return;
    }
    if (node->kind == AST_PROPERTY) { /* an element with nothing but text, perhaps none */
        if (node->children->text.n)
            diag_report(e->diag, DIAG_MISPLACED, node->children->span, "text cannot stand in '%s'",
                        s->name);
        return;
    }
    take_attributes(e, node, s->name, 0);
    for (const struct ast_node *item = node->children; item && !eval_stopped(e);
         item = item->next) {
        if (item->kind == AST_BLOCK || item->kind == AST_PROPERTY)
            s->add(e, item);
        else if (item->kind == AST_TEXT)
            diag_report(e->diag, DIAG_MISPLACED, item->span, "text cannot stand in '%s'", s->name);
    }
}

static const struct section *find_section(struct eval *e, const struct ast_node *node)
{
    struct str_nearest nearest = str_nearest_to(node->name);
    for (int i = 0; i < SECTIONS; i++) {
        if (str_is(node->name, sections[i].name))
            return &sections[i];
        str_nearest_try(&nearest, str_of(sections[i].name));
    }
    e->out->incomplete = true;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_PROPERTY, node->name_span,
                    "unknown element '%.*s' of the scene", STR_ARG(node->name));
    diag_did_you_mean(entry, node->name_span, str_nearest_found(&nearest));
    diag_note(entry, "a scene has: camera %slights textures surfaces",
              e->out->model == SCHEMA_MODERN ? "settings " : "");
    return NULL;
}

static void eval_root_attributes(struct eval *e, const struct ast_node *root)
{
    struct attributes a = take_attributes(e, root, "the scene", ATTRIBUTE_MODEL);
    e->out->model = SCHEMA_CLASSIC;
    e->out->model_span = a.model ? attribute_span(a.model) : root->name_span;
    e->model = a.model;
    if (a.model)
        eval_model(e, attribute_text(a.model), attribute_span(a.model));
}

/* The sections among the children of the root, each once. */
static void find_sections(struct eval *e, const struct ast_node *root,
                          const struct ast_node *found[SECTIONS])
{
    for (const struct ast_node *c = root->children; c && !eval_stopped(e); c = c->next) {
        if (c->kind == AST_TEXT && c->text.n)
            diag_report(e->diag, DIAG_MISPLACED, c->span, "text cannot stand between elements");
        if (c->kind != AST_BLOCK && c->kind != AST_PROPERTY)
            continue;
        const struct section *s = find_section(e, c);
        const struct ast_node **slot = s ? &found[s - sections] : NULL;
        if (slot && *slot) {
            struct diag_entry *entry = diag_report(e->diag, DIAG_DUPLICATE_OBJECT, c->name_span,
                                                   "'%s' is given twice", s->name);
            diag_label(entry, (*slot)->name_span, "first given here");
        } else if (slot) {
            *slot = c;
        }
    }
}

void eval_xml(struct eval *e, const struct ast_node *root)
{
    const struct ast_node *found[SECTIONS] = {0};
    if (!root)
        return;
    e->out->start = root->name_span;
    eval_root_attributes(e, root);
    find_sections(e, root, found);
    collect_ids(e, root);
    for (int i = 0; i < SECTIONS; i++)
        if (found[i])
            eval_section(e, &sections[i], found[i]);
}

/* Ids and texture numbers are the document's own. */
void eval_xml_parts(struct eval *e, const struct ast_node *root)
{
    const struct ast_node *found[SECTIONS] = {0};
    struct map ids = e->ids;
    size_t first_texture = e->first_texture;
    struct attributes a = take_attributes(e, root, "the scene", ATTRIBUTE_MODEL);
    if (a.model)
        eval_same_model(e, attribute_text(a.model), attribute_span(a.model));
    e->ids = (struct map){0};
    e->first_texture = e->out->textures.n;
    find_sections(e, root, found);
    collect_ids(e, root);
    for (int i = 0; i < SECTIONS; i++)
        if (found[i] && sections[i].array)
            eval_section(e, &sections[i], found[i]);
    map_free(&e->ids);
    e->ids = ids;
    e->first_texture = first_texture;
}
