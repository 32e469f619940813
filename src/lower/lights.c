/* Lights; an area light gets its object's geometry and sample grid. */
#include "config.h"

#include "lower/lowering.h"

enum { FEWEST_SAMPLES = 3 }; /* along each axis of an area light's grid */

/* `shape` and `size` as geometry: a sphere, or a square in the plane of the light's height. */
static void add_built_in(struct light *light, unsigned shape, double size)
{
    enum { SHAPE_SPHERE, SHAPE_QUAD };
    struct geometry *g = &light->object;
    struct vec3 c = light->position;
    double h = size / 2;
    if (shape == SHAPE_SPHERE) {
        geometry_add_sphere(g, 0, c, h);
        return;
    }
    static const double corners[4][2] = {{-1, -1}, {-1, 1}, {1, 1}, {1, -1}};
    for (int i = 0; i < 4; i++)
        geometry_add_vertex(g, vec3(c.x + h * corners[i][0], c.y, c.z + h * corners[i][1]));
    geometry_add_triangle(g, 0, 0, 1, 2);
    geometry_add_triangle(g, 0, 2, 3, 0);
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

/* The box the original spans its grid over: tight, but for two kinds. */
static struct box grid_box(const struct desc_object *o, const struct geometry *g)
{
    struct box box = geometry_bounds(g);
    bool upright = o->kind == KIND_CYLINDER && desc_number(o, PROP_HEIGHT) != 0;
    if (o->kind == KIND_CYLINDER && !upright)
        return tilted_cylinder_box(&g->cylinders.at[0]);
    return o->kind == KIND_MESH ? box_add(box, vec3_all(0)) : box;
}

static void lower_area(struct lowering *l, const struct desc_object *o, struct light *light)
{
    const struct desc_value *object = desc_get(o, PROP_OBJECT);
    double samples = desc_number(o, PROP_LIGHT_SAMPLES);
    struct box box;
    if (object) {
        uint32_t first_vertex;
        if (!lower_shape(l, object->object, &light->object, 0, &first_vertex))
            return;
        box = grid_box(object->object, &light->object);
    } else {
        add_built_in(light, desc_word(o, PROP_SHAPE), desc_number(o, PROP_LIGHT_SIZE));
        box = geometry_bounds(&light->object);
    }
    if (!light->object.prims.n) {
        diag_report(l->diag, DIAG_DEGENERATE, o->span, "the light's object has no faces");
        return;
    }
    light_sample_grid(light, box, samples < FEWEST_SAMPLES ? FEWEST_SAMPLES : (uint32_t)samples);
}

void lower_light(struct lowering *l, const struct desc_object *o)
{
    struct light light = {
        .kind = o->kind == KIND_AREA_LIGHT ? LIGHT_AREA : LIGHT_POINT,
        .position = desc_vector(o, PROP_LIGHT_POSITION),
        .intensity = desc_vector(o, PROP_INTENSITY),
        .inverse_square = desc_word(o, PROP_FALLOFF) == 1,
        .span = o->span,
    };
    if (light.kind == LIGHT_AREA)
        lower_area(l, o, &light);
    vec_push(&l->scene->lights, light);
}
