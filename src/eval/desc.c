#include "config.h"

#include "eval/desc.h"

#include <assert.h>

static_assert(sizeof(struct desc_prop) == 64 && sizeof(struct desc_object) <= 64,
              "scenes hold them by the million");

void desc_free(struct desc *d)
{
    vec_free(&d->textures);
    vec_free(&d->materials);
    vec_free(&d->lights);
    vec_free(&d->surfaces);
    vec_free(&d->defaults);
    for (size_t i = 0; i < d->included.n; i++) {
        ast_free(d->included.at[i]);
        free(d->included.at[i]);
    }
    vec_free(&d->included);
    vec_free(&d->overridden);
    map_free(&d->brought);
    arena_free(&d->arena);
}

static struct str key_of(const struct ast_node *include)
{
    const struct span *place = &include->children->span;
    return (struct str){(const char *)place, sizeof *place};
}

void desc_set_brought(struct desc *d, const struct ast_node *include, struct ast *tree)
{
    map_set(&d->brought, key_of(include), tree);
}

const struct ast *desc_brought(const struct desc *d, const struct ast_node *include)
{
    return map_get(&d->brought, key_of(include));
}

bool desc_is_part(const struct desc *d, const struct ast *ast)
{
    static const bool defines[AST_KINDS] = {
        [AST_LET] = true, [AST_PARAM] = true,  [AST_MATERIAL] = true, [AST_TEXTURE] = true,
        [AST_FN] = true,  [AST_DEFINE] = true, [AST_DEFAULT] = true};
    const struct ast_node *n = ast->xml ? NULL : ast->statements;
    while (n && !defines[n->kind])
        n = n->next;
    return n && !d->camera && !d->settings && !d->lights.n && !d->surfaces.n;
}

const struct desc_prop *desc_find(const struct desc_object *o, enum schema_prop_id id)
{
    for (const struct desc_prop *p = o->props; p; p = p->next)
        if (p->id == id)
            return p;
    return NULL;
}

const struct desc_value *desc_get(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_prop *p = desc_find(o, id);
    return p ? &p->value : NULL;
}

struct vec3 desc_vector(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_value *v = desc_get(o, id);
    const double *x = v ? v->number : schema_props[id].value[o->model];
    return vec3(x[0], x[1], x[2]);
}

double desc_number(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_value *v = desc_get(o, id);
    return v ? v->number[0] : schema_props[id].value[o->model][0];
}

unsigned desc_word(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_value *v = desc_get(o, id);
    return v ? v->word : (unsigned)schema_props[id].value[o->model][0];
}
