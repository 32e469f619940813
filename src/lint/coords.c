/* Texture coordinates. */
#include "config.h"

#include "lint/checks.h"

static const struct desc_prop *own_uvs(const struct desc_object *o)
{
    static const enum schema_prop_id props[] = {PROP_TRIANGLE_UVS, PROP_QUAD_UVS, PROP_UV_FILE};
    for (int i = 0; i < 3; i++) {
        const struct desc_prop *p = desc_find(o, props[i]);
        if (p)
            return p->inherited ? NULL : p;
    }
    return NULL;
}

static bool are_equal(const struct desc_value *v)
{
    for (uint32_t i = 1; i < v->n; i++)
        if (v->points[i].x != v->points->x || v->points[i].y != v->points->y)
            return false;
    return true;
}

static void check_uvs(const struct lint *l, const struct desc_object *o)
{
    const struct desc_prop *uvs = own_uvs(o);
    const struct desc_value *material = desc_get(o, PROP_MATERIAL);
    if (!uvs)
        return;
    bool used = desc_get(o, PROP_NORMAL_MAP) || desc_get(material->object, PROP_TEXTURE);
    enum schema_prop_id id = (enum schema_prop_id)uvs->id;
    if (!used) {
        struct diag_entry *e = diag_report(
            l->diag, DIAG_UV_UNUSED, lint_extent(o, uvs),
            "nothing uses these coordinates: there is neither a texture nor a normal map");
        if (!o->xml)
            lint_remove(l, e, span_join(uvs->name_span, uvs->value.span), DIAG_FIX_MAYBE);
    } else if (id != PROP_UV_FILE && are_equal(&uvs->value)) {
        diag_report(l->diag, DIAG_DEGENERATE_UV, lint_extent(o, uvs),
                    "all corners have the same coordinates, so all of this %s has one colour",
                    schema_kind_name(o->kind, o->xml));
    }
}

void lint_uvs(const struct lint *l)
{
    lint_each_surface(l, check_uvs);
}

static void check_scale(const struct lint *l, const struct desc_object *o)
{
    static const enum schema_prop_id props[] = {PROP_UV_SCALE, PROP_UV_OFFSET};
    const struct desc_value *scale = lint_own(o, PROP_UV_SCALE);
    bool textured = desc_get(o, PROP_TEXTURE);
    for (int i = 0; i < 2 && !textured; i++) {
        const struct desc_prop *p = desc_find(o, props[i]);
        if (!p || p->inherited)
            continue;
        struct diag_entry *e = diag_report(l->diag, DIAG_UV_UNUSED, p->value.span,
                                           "nothing uses '%.*s': the material has no texture",
                                           STR_ARG(lint_name(o, props[i])));
        if (!o->xml)
            lint_remove(l, e, span_join(p->name_span, p->value.span), DIAG_FIX_MAYBE);
    }
    if (textured && scale && (scale->number[0] == 0 || scale->number[1] == 0))
        diag_report(l->diag, DIAG_UV_SCALE_ZERO, scale->span,
                    "a factor of 0 shows one %s of the texture everywhere",
                    scale->number[0] != 0 || scale->number[1] != 0 ? "row" : "texel");
}

void lint_uv_scales(const struct lint *l)
{
    lint_each_material(l, check_scale);
}
