/* What the checks share. */
#include "config.h"

#include "lint/checks.h"

static void look_at(const struct lint *l, struct desc_object *const *objects, size_t n,
                    lint_look *look)
{
    for (size_t i = 0; i < n; i++) {
        l->diag->frame = objects[i]->frame;
        look(l, objects[i]);
    }
    l->diag->frame = NULL;
}

void lint_each_surface(const struct lint *l, lint_look *look)
{
    look_at(l, l->desc->surfaces.at, l->desc->surfaces.n, look);
}

void lint_each_light(const struct lint *l, lint_look *look)
{
    look_at(l, l->desc->lights.at, l->desc->lights.n, look);
}

void lint_each_material(const struct lint *l, lint_look *look)
{
    look_at(l, l->desc->materials.at, l->desc->materials.n, look);
}

const struct desc_value *lint_own(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_prop *p = desc_find(o, id);
    return p && !p->inherited ? &p->value : NULL;
}

struct span lint_place(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_value *v = desc_get(o, id);
    return v ? v->span : o->span;
}

struct span lint_extent(const struct desc_object *o, const struct desc_prop *p)
{
    bool elements = o->xml && schema_leaf_count((enum schema_prop_id)p->id) > 1;
    return elements ? span_join(p->name_span, p->value.span) : p->value.span;
}

struct str lint_name(const struct desc_object *o, enum schema_prop_id id)
{
    return schema_prop_name(id, o->xml);
}

bool lint_is_here(const struct lint *l, struct span span)
{
    const struct source *s = l->ast->source;
    return span.begin >= s->base && span.end <= s->base + s->n;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* The text with its separator, the blanks behind it, and its line when that holds nothing else. */
static struct span removal(const struct source *s, struct span span)
{
    const char *text = s->text;
    uint32_t begin = span.begin - s->base, end = span.end - s->base, first = begin;
    while (is_blank(text[end]))
        end++;
    if (text[end] == ',' || text[end] == ';')
        for (end++; is_blank(text[end]);)
            end++;
    while (first > 0 && is_blank(text[first - 1]))
        first--;
    bool alone = (first == 0 || text[first - 1] == '\n') && (text[end] == '\n' || end == s->n);
    if (alone) {
        begin = first;
        end += end < s->n;
    }
    return (struct span){s->base + begin, s->base + end};
}

void lint_remove(const struct lint *l, struct diag_entry *e, struct span span,
                 enum diag_fix_kind kind)
{
    const struct source *s = srcmap_source(l->sources, span.begin);
    diag_fix(e, removal(s, span), kind, "%s", "");
}
