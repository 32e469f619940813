/* Objects of the description under construction. */
#include "config.h"

#include "eval/context.h"

struct desc_object *object_new(struct eval *e, struct arena *a, enum schema_kind kind,
                               const struct ast_node *node)
{
    struct desc_object *o = arena_zalloc(a, 1, sizeof *o);
    o->kind = kind;
    o->model = (uint8_t)e->out->model;
    o->xml = node->xml;
    o->span = node->name_span;
    o->frame = frame_keep(e);
    o->broken = e->defaults_lost;
    return o;
}

static struct desc_prop *find(struct desc_object *o, enum schema_prop_id id,
                              struct desc_prop ***end)
{
    struct desc_prop **at = &o->props;
    for (; *at; at = &(*at)->next)
        if ((*at)->id == id)
            return *at;
    *end = at;
    return NULL;
}

struct desc_prop *object_prop(struct eval *e, struct arena *a, struct desc_object *o,
                              enum schema_prop_id id, unsigned leaf, struct span name_span)
{
    struct desc_prop **end = NULL, *p = find(o, id, &end);
    if (!p) {
        *end = p = arena_zalloc(a, 1, sizeof *p);
        p->id = (uint8_t)id;
        p->name_span = name_span;
    } else if (p->leaves >> leaf & 1) {
        struct str name = o->xml ? schema_leaf(id, leaf) : schema_prop_name(id, false);
        struct diag_entry *entry = diag_report(e->diag, DIAG_DUPLICATE_PROPERTY, name_span,
                                               "'%.*s' is given twice", STR_ARG(name));
        diag_label(entry, p->name_span, "first given here");
        o->broken = true;
        return NULL;
    }
    p->leaves |= (uint8_t)(1u << leaf);
    return p;
}

enum schema_prop_id object_find_prop(struct eval *e, const struct desc_object *o, struct str name,
                                     struct span name_span, unsigned *leaf)
{
    enum schema_prop_id id = schema_index_find(&e->index[o->xml], o->kind, name, leaf);
    if (id == SCHEMA_PROPS) {
        report_unknown_property(e, o, name, name_span);
    } else if (!(schema_props[id].models >> o->model & 1) && !e->model_unknown) {
        report_property_of_other_model(e, o, name, name_span);
        return SCHEMA_PROPS;
    }
    return id;
}

/* ---- what an object does not say itself ---- */

/* Copies of the properties the object lacks. */
static void take_missing(struct eval *e, struct desc_object *o, const struct desc_object *base,
                         bool material_known)
{
    for (const struct desc_prop *p = base->props; p; p = p->next) {
        struct desc_prop **end;
        enum schema_prop_id id = (enum schema_prop_id)p->id;
        if ((material_known && id == PROP_MATERIAL) || find(o, id, &end))
            continue;
        struct desc_prop *copy = arena_alloc(&e->out->arena, sizeof *copy);
        *copy = *p;
        copy->next = NULL;
        copy->inherited = true;
        *end = copy;
    }
    o->broken |= base->broken;
}

void object_inherit(struct eval *e, struct desc_object *o, const struct desc_object *base)
{
    take_missing(e, o, base, false);
}

static void take_fallbacks(struct eval *e, struct desc_object *o, bool material_known)
{
    if (!(e->fallback_kinds >> o->kind & 1))
        return;
    for (const struct scope *s = e->scope; s; s = s->parent)
        for (const struct fallback *f = s->fallbacks; f; f = f->next)
            if (f->object->kind == o->kind)
                take_missing(e, o, f->object, material_known);
}

void object_complete(struct eval *e, struct desc_object *o)
{
    take_fallbacks(e, o, false);
}

/* ---- into the description ---- */

static void count(struct eval *e, size_t have, const struct desc_object *o, const char *what)
{
    if (have != e->options->max_objects)
        return;
    diag_report(e->diag, DIAG_TOO_MANY_OBJECTS, o->span,
                "more than the %zu %s that --max-objects allows", have, what);
    e->stopped = true;
}

void object_place(struct eval *e, struct desc_object *o)
{
    struct desc *d = e->out;
    struct desc_prop **end;
    if (!o)
        return;
    bool surface = schema_kinds[o->kind].group == SCHEMA_SURFACE;
    bool material = surface && e->group_material && !find(o, PROP_MATERIAL, &end);
    if (!o->xml)
        take_fallbacks(e, o, material);
    if (material && !find(o, PROP_MATERIAL, &end))
        *end = e->group_material; /* shared: always the last */
    o->place = e->place ? &e->place->affine : NULL;
    count(e, d->lights.n + d->surfaces.n, o, "objects");
    if (surface)
        vec_push(&d->surfaces, o);
    else
        vec_push(&d->lights, o);
}

void object_register(struct eval *e, struct desc_object *o)
{
    if (schema_kinds[o->kind].group == SCHEMA_TEXTURE) {
        count(e, e->out->textures.n, o, "textures");
        o->number = (uint32_t)e->out->textures.n;
        vec_push(&e->out->textures, o);
    } else if (schema_kinds[o->kind].group == SCHEMA_MATERIAL) {
        count(e, e->out->materials.n, o, "materials");
        o->number = (uint32_t)e->out->materials.n;
        vec_push(&e->out->materials, o);
    }
}
