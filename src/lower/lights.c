/* Lights; an area light gets its object's geometry and sample grid. */
#include "config.h"

#include "lower/lowering.h"

enum { FEWEST_SAMPLES = 3 }; /* along each axis of an area light's grid */

/* `shape` and `size` as geometry: a sphere, or a square in the plane of the light's height. */
static bool add_built_in(struct lowering *l, const struct desc_object *o, struct geometry *g)
{
    enum { SHAPE_SPHERE, SHAPE_QUAD };
    const struct desc_value *given = desc_get(o, PROP_LIGHT_VERTICES);
    if (given) {
        for (int i = 0; i < 4; i++)
            geometry_add_vertex(g, lower_placed(o, given->points[i]));
        geometry_add_triangle(g, 0, 0, 1, 2);
        geometry_add_triangle(g, 0, 2, 3, 0);
        return true;
    }
    struct vec3 c = desc_vector(o, PROP_LIGHT_POSITION);
    double h = desc_number(o, PROP_LIGHT_SIZE) / 2;
    if (desc_word(o, PROP_SHAPE) == SHAPE_SPHERE)
        return lower_ball(l, o, g, 0, c, h);
    static const double corners[4][2] = {{-1, -1}, {-1, 1}, {1, 1}, {1, -1}};
    for (int i = 0; i < 4; i++) {
        struct vec3 p = vec3(c.x + h * corners[i][0], c.y, c.z + h * corners[i][1]);
        geometry_add_vertex(g, lower_placed(o, p));
    }
    geometry_add_triangle(g, 0, 0, 1, 2);
    geometry_add_triangle(g, 0, 2, 3, 0);
    return true;
}

/* A light's object is where the light is. */
static bool add_object(struct lowering *l, const struct desc_object *o, struct geometry *g)
{
    struct desc_object shape = *desc_get(o, PROP_OBJECT)->object;
    if (!shape.place)
        shape.place = o->place;
    return lower_shape(l, &shape, g, 0);
}

/* The original's box of a tilted cylinder: widened by the radius, but by the height along y at the
 * upper end. */
static struct box tilted_cylinder_box(const struct cylinder *c)
{
    struct vec3 top = vec3_mad(c->base, c->height, c->axis);
    struct vec3 r = vec3_all(c->radius);
    return (struct box){vec3_sub(vec3_min(c->base, top), r),
                        vec3_add(vec3_max(c->base, top), vec3(r.x, c->height, r.z))};
}

/* The box the original spans its grid over: tight, but for two kinds.  o: the light's object, or
 * NULL. */
static struct box grid_box(const struct desc_object *o, const struct geometry *g)
{
    struct box box = geometry_bounds(g);
    if (!o)
        return box;
    bool plain = g->prims.n == 1 && g->prims.at[0].kind == PRIM_CYLINDER;
    if (plain && desc_number(o, PROP_HEIGHT) == 0)
        return tilted_cylinder_box(&g->cylinders.at[0]);
    return o->kind == KIND_MESH ? box_add(box, vec3_all(0)) : box;
}

static void lower_area(struct lowering *l, const struct desc_object *o, struct light *light)
{
    const struct desc_value *object = desc_get(o, PROP_OBJECT);
    struct geometry *g = &light->object;
    double samples = desc_number(o, PROP_LIGHT_SAMPLES);
    if (!(object ? add_object(l, o, g) : add_built_in(l, o, g)))
        return;
    if (!g->prims.n) {
        diag_report(l->diag, DIAG_DEGENERATE, o->span, "the light's object has no faces");
        return;
    }
    if (l->scene->model == SCENE_CLASSIC)
        light_sample_grid(light, grid_box(object ? object->object : NULL, g),
                          samples < FEWEST_SAMPLES ? FEWEST_SAMPLES : (uint32_t)samples);
    else if (!light_surface(light, (uint32_t)samples))
        diag_report(l->diag, DIAG_DEGENERATE, o->span, "the light has no area");
}

/* The direction to the sun, wherever its groups turn it; false after reporting. */
static bool lower_sun(struct lowering *l, const struct desc_object *o, struct vec3 *to_sun)
{
    struct vec3 d = vec3_neg(desc_vector(o, PROP_SUN_DIRECTION));
    if (o->place)
        d = affine_vector(o->place, d);
    double largest = vec3_largest(d);
    *to_sun = vec3_normalize(vec3_scale(d, 1 / largest));
    bool points = largest > 0 && vec3_largest(*to_sun) <= 1;
    if (!points)
        diag_report(l->diag, DIAG_DEGENERATE, o->span, "the light has no direction");
    return points;
}

void lower_light(struct lowering *l, const struct desc_object *o)
{
    static const enum light_kind kinds[SCHEMA_KINDS] = {[KIND_POINT_LIGHT] = LIGHT_POINT,
                                                        [KIND_AREA_LIGHT] = LIGHT_AREA,
                                                        [KIND_SUN_LIGHT] = LIGHT_SUN};
    struct light light = {
        .kind = kinds[o->kind], .intensity = desc_vector(o, PROP_INTENSITY), .span = o->span};
    if (!lower_has_volume(l, o))
        return;
    if (light.kind == LIGHT_SUN) {
        if (!lower_sun(l, o, &light.position))
            return;
    } else {
        light.position = lower_placed(o, desc_vector(o, PROP_LIGHT_POSITION));
        light.inverse_square = desc_word(o, PROP_FALLOFF) == 1;
        if (!lower_is_finite(l, o, light.position))
            return;
    }
    if (light.kind == LIGHT_AREA)
        lower_area(l, o, &light);
    vec_push(&l->scene->lights, light);
}
