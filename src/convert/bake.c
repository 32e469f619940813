#include "config.h"

#include "convert/bake.h"

struct baking {
    struct arena *arena;
    struct diag *diag;
};

/* What a place does to shapes. */
struct effect {
    const struct affine *place;
    bool similar; /* one factor and a turn, perhaps mirrored */
    bool keeps;   /* directions, too: it moves and scales evenly */
    bool mirrors;
    double factor;
};

static struct effect effect_of(const struct affine *place)
{
    struct effect f = {.place = place, .mirrors = affine_determinant(place) < 0};
    f.similar = affine_is_similarity(place, &f.factor);
    f.keeps = affine_keeps_directions(place);
    return f;
}

static bool report(struct baking *b, const struct desc_object *o, const char *how)
{
    b->diag->frame = o->frame;
    diag_report(b->diag, DIAG_UNSAYABLE, o->span,
                "XML cannot say a %s that is %s by the groups around it, so nothing is written",
                schema_kind_name(o->kind, false), how);
    b->diag->frame = NULL;
    return false;
}

/* ---- copies ---- */

/* A copy of the object with properties of its own, and no place. */
static struct desc_object *copy_object(struct baking *b, const struct desc_object *o)
{
    struct desc_object *copy = arena_zalloc(b->arena, 1, sizeof *copy);
    struct desc_prop **end = &copy->props;
    *copy = *o;
    copy->place = NULL;
    for (const struct desc_prop *p = o->props; p; p = p->next) {
        *end = arena_zalloc(b->arena, 1, sizeof **end);
        **end = *p;
        end = &(*end)->next;
    }
    return copy;
}

/* The property of a copy; one that is not given gets its default. */
static struct desc_value *own_value(struct baking *b, struct desc_object *o, enum schema_prop_id id)
{
    struct desc_prop **at = &o->props;
    for (; *at; at = &(*at)->next)
        if ((*at)->id == id)
            return &(*at)->value;
    struct vec3 value = desc_vector(o, id);
    *at = arena_zalloc(b->arena, 1, sizeof **at);
    (*at)->id = (uint8_t)id;
    (*at)->leaves = 1;
    (*at)->value = (struct desc_value){.n = 3, .number = {value.x, value.y, value.z}};
    return &(*at)->value;
}

static void set_vector(struct desc_value *v, struct vec3 x)
{
    v->n = 3;
    v->number[0] = x.x;
    v->number[1] = x.y;
    v->number[2] = x.z;
}

static void move_point(struct baking *b, struct desc_object *o, enum schema_prop_id id,
                       const struct effect *f)
{
    set_vector(own_value(b, o, id), affine_point(f->place, desc_vector(o, id)));
}

/* ---- shapes ---- */

static bool wants_uvs(const struct desc_object *o)
{
    const struct desc_value *material = desc_get(o, PROP_MATERIAL);
    return desc_get(o, PROP_NORMAL_MAP) || (material && desc_get(material->object, PROP_TEXTURE));
}

/* Spheres and cylinders stay what they are under the places that lowering does not make instances
 * of. */
static bool stays_round(struct baking *b, const struct desc_object *o, const struct effect *f)
{
    if (!f->similar)
        return report(b, o, "stretched");
    return f->keeps || !wants_uvs(o) || report(b, o, "turned with its texture");
}

static bool place_sphere(struct baking *b, struct desc_object *o, const struct effect *f)
{
    if (!stays_round(b, o, f))
        return false;
    move_point(b, o, PROP_CENTER, f);
    own_value(b, o, PROP_RADIUS)->number[0] *= f->factor;
    return true;
}

/* A height becomes a top, which is moved like the base. */
static bool place_cylinder(struct baking *b, struct desc_object *o, const struct effect *f)
{
    double height = desc_number(o, PROP_HEIGHT);
    struct vec3 top = desc_vector(o, PROP_TOP);
    if (!stays_round(b, o, f))
        return false;
    if (height != 0)
        top = vec3_add(desc_vector(o, PROP_BASE), vec3(0, height, 0));
    bool given = desc_get(o, PROP_TOP) != NULL;
    for (struct desc_prop **at = &o->props; *at;) {
        if ((*at)->id == PROP_HEIGHT && given) {
            *at = (*at)->next;
            continue;
        }
        if ((*at)->id == PROP_HEIGHT)
            (*at)->id = PROP_TOP;
        at = &(*at)->next;
    }
    set_vector(own_value(b, o, PROP_TOP), affine_point(f->place, top));
    move_point(b, o, PROP_BASE, f);
    own_value(b, o, PROP_RADIUS)->number[0] *= f->factor;
    return true;
}

static bool place_corners(struct baking *b, struct desc_object *o, enum schema_prop_id id,
                          const struct effect *f)
{
    struct desc_value *v = own_value(b, o, id);
    const struct vec3 *from = v->points;
    if (f->mirrors)
        return report(b, o, "mirrored");
    v->points = arena_zalloc(b->arena, v->n, sizeof *v->points);
    for (uint32_t i = 0; i < v->n; i++)
        v->points[i] = affine_point(f->place, from[i]);
    return true;
}

static bool place_mesh(struct baking *b, struct desc_object *o, const struct effect *f)
{
    if (!f->keeps)
        return report(b, o, f->similar ? "turned" : "stretched");
    move_point(b, o, PROP_MESH_POSITION, f);
    struct vec3 scale = vec3_scale(desc_vector(o, PROP_MESH_SCALE), f->factor);
    set_vector(own_value(b, o, PROP_MESH_SCALE), scale);
    return true;
}

static bool place_shape(struct baking *b, struct desc_object *o, const struct effect *f)
{
    switch (o->kind) {
    case KIND_SPHERE:
        return place_sphere(b, o, f);
    case KIND_CYLINDER:
        return place_cylinder(b, o, f);
    case KIND_TRIANGLE:
        return place_corners(b, o, PROP_TRIANGLE_VERTICES, f);
    case KIND_QUAD:
        return place_corners(b, o, PROP_QUAD_VERTICES, f);
    default:
        return place_mesh(b, o, f);
    }
}

/* ---- lights ---- */

/* A cylinder with a height keeps it: the grid of a light spans another box without. */
static bool place_upright(struct baking *b, struct desc_object *o, const struct effect *f)
{
    if (!f->keeps)
        return report(b, o, "turned as a light's object");
    move_point(b, o, PROP_BASE, f);
    own_value(b, o, PROP_RADIUS)->number[0] *= f->factor;
    own_value(b, o, PROP_HEIGHT)->number[0] *= f->factor;
    return true;
}

/* The light's object, at its own place or the light's. */
static bool place_object(struct baking *b, struct desc_value *v, const struct affine *place)
{
    const struct desc_object *o = v->object;
    struct effect f = effect_of(o->place ? o->place : place);
    v->object = copy_object(b, o);
    if (o->kind == KIND_CYLINDER && desc_number(o, PROP_HEIGHT) != 0)
        return place_upright(b, v->object, &f);
    return place_shape(b, v->object, &f);
}

static bool place_area(struct baking *b, struct desc_object *o, const struct effect *f)
{
    enum { SHAPE_SPHERE };
    if (desc_get(o, PROP_OBJECT))
        return place_object(b, own_value(b, o, PROP_OBJECT), f->place);
    if (desc_get(o, PROP_LIGHT_VERTICES))
        return place_corners(b, o, PROP_LIGHT_VERTICES, f);
    bool stays = desc_word(o, PROP_SHAPE) == SHAPE_SPHERE ? f->similar : f->keeps;
    if (!stays)
        return report(b, o, f->similar ? "turned" : "stretched");
    double half = desc_number(o, PROP_LIGHT_SIZE) / 2;
    own_value(b, o, PROP_LIGHT_SIZE)->number[0] = 2 * (half * f->factor);
    return true;
}

static bool place_light(struct baking *b, struct desc_object *o, const struct effect *f)
{
    if (o->kind == KIND_SUN_LIGHT) {
        struct vec3 v = affine_vector(f->place, desc_vector(o, PROP_SUN_DIRECTION));
        set_vector(own_value(b, o, PROP_SUN_DIRECTION), v);
        return true;
    }
    if (o->kind == KIND_AREA_LIGHT && !place_area(b, o, f))
        return false;
    move_point(b, o, PROP_LIGHT_POSITION, f);
    return true;
}

static struct desc_object **placed(struct baking *b, struct desc_object *const *from, size_t n,
                                   bool (*place)(struct baking *b, struct desc_object *o,
                                                 const struct effect *f))
{
    struct desc_object **out = arena_zalloc(b->arena, n, sizeof *out);
    for (size_t i = 0; i < n; i++) {
        out[i] = from[i];
        if (!from[i]->place)
            continue;
        struct effect f = effect_of(from[i]->place);
        out[i] = copy_object(b, from[i]);
        place(b, out[i], &f);
    }
    return out;
}

bool bake_places(const struct desc *d, struct arena *arena, struct diag *diag, struct desc *out)
{
    struct baking b = {arena, diag};
    size_t errors = diag->errors;
    *out = *d;
    out->lights.at = placed(&b, d->lights.at, d->lights.n, place_light);
    out->surfaces.at = placed(&b, d->surfaces.at, d->surfaces.n, place_shape);
    return diag->errors == errors;
}
