/* Shapes at their places.
 *
 * Corners are simply moved.  Spheres and cylinders stay what they are when their place only moves,
 * turns and scales them evenly; otherwise they become instances, and also when they are turned and
 * have texture coordinates, which turn with them. */
#include "config.h"

#include "lower/lowering.h"

#include <assert.h>
#include <float.h>
#include <math.h>

bool lower_fits(struct lowering *l, const struct desc_object *o, const struct geometry *g,
                size_t more_prims, size_t more_vertices)
{
    if (more_prims < GEOMETRY_LIMIT - g->prims.n && more_vertices < GEOMETRY_LIMIT - g->vertices.n)
        return true;
    diag_report(l->diag, DIAG_SCENE_TOO_LARGE, o->span,
                "the scene has more triangles or vertices than can be held (limit %u)",
                GEOMETRY_LIMIT);
    return false;
}

bool lower_add_instance(struct lowering *l, const struct desc_object *o, struct geometry *g,
                        uint32_t surface, uint32_t prototype, uint32_t only,
                        const struct affine *to_world)
{
    if (geometry_add_instance(g, surface, prototype, only, to_world))
        return true;
    diag_report(l->diag, DIAG_DEGENERATE, o->span,
                "with all its scales, this %s is too thin, too small or too large to be placed",
                schema_kind_name(o->kind, o->xml));
    return false;
}

static bool is_finite(struct vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

bool lower_is_finite(struct lowering *l, const struct desc_object *o, struct vec3 p)
{
    if (!is_finite(p))
        diag_report(l->diag, DIAG_NOT_FINITE, o->span,
                    "this %s is too large where the groups around it place it",
                    schema_kind_name(o->kind, o->xml));
    return is_finite(p);
}

/* Whether the place leaves a sphere or cylinder one; *factor is what it does to lengths. */
static bool keeps_round(const struct desc_object *o, double *factor)
{
    *factor = 1;
    if (!o->place)
        return true;
    return affine_is_similarity(o->place, factor) &&
           (!lower_wants_uvs(o) || affine_keeps_directions(o->place));
}

/* The place of a shape that is `center` and as large as 1 times `radius` in its own space. */
static struct affine place_of(const struct desc_object *o, struct vec3 center, double radius)
{
    struct affine own = {
        {{radius, 0, 0, center.x}, {0, radius, 0, center.y}, {0, 0, radius, center.z}}};
    return affine_times(o->place, &own);
}

struct vec3 lower_placed(const struct desc_object *o, struct vec3 p)
{
    return o->place ? affine_point(o->place, p) : p;
}

/* Whether something is left of a length after scaling. */
static bool has_length(struct lowering *l, const struct desc_object *o, double x)
{
    bool right = x > 0 && x <= DBL_MAX;
    if (!right)
        diag_report(l->diag, DIAG_DEGENERATE, o->span,
                    "this %s is too %s where the groups around it place it",
                    schema_kind_name(o->kind, o->xml), x > 0 ? "large" : "small");
    return right;
}

bool lower_ball(struct lowering *l, const struct desc_object *o, struct geometry *g,
                uint32_t surface, struct vec3 center, double radius)
{
    double factor;
    if (!keeps_round(o, &factor)) {
        struct affine place = place_of(o, center, radius);
        geometry_solids(g);
        return lower_add_instance(l, o, g, surface, PROTOTYPE_SOLIDS, 0, &place);
    }
    center = lower_placed(o, center);
    if (!lower_is_finite(l, o, center) || !has_length(l, o, radius * factor))
        return false;
    geometry_add_sphere(g, surface, center, radius * factor);
    return true;
}

static bool add_sphere(struct lowering *l, const struct desc_object *o, struct geometry *g,
                       uint32_t surface)
{
    return lower_ball(l, o, g, surface, desc_vector(o, PROP_CENTER), desc_number(o, PROP_RADIUS));
}

/* Base and top in units of the radius, from the base. */
static bool add_elliptic_cylinder(struct lowering *l, const struct desc_object *o,
                                  struct geometry *g, uint32_t surface, struct vec3 base,
                                  struct vec3 top)
{
    struct geometry *solids = geometry_solids(g);
    double radius = desc_number(o, PROP_RADIUS);
    struct affine place = place_of(o, base, radius);
    struct vec3 along = vec3_sub(top, base);
    along = vec3(along.x / radius, along.y / radius, along.z / radius);
    if (!lower_is_finite(l, o, along) || !has_length(l, o, vec3_length(along)))
        return false;
    uint32_t number = (uint32_t)solids->prims.n;
    geometry_add_cylinder(solids, 0, vec3_all(0), along, 1);
    return lower_add_instance(l, o, g, surface, PROTOTYPE_SOLIDS, number, &place);
}

/* A height that is not 0 wins over the top; a negative one puts the base above. */
static bool add_cylinder(struct lowering *l, const struct desc_object *o, struct geometry *g,
                         uint32_t surface)
{
    struct vec3 base = desc_vector(o, PROP_BASE), top = desc_vector(o, PROP_TOP);
    double height = desc_number(o, PROP_HEIGHT), radius = desc_number(o, PROP_RADIUS), factor;
    if (height != 0)
        top = vec3_add(base, vec3(0, height, 0));
    bool round = keeps_round(o, &factor);
    if (round) {
        base = lower_placed(o, base);
        top = lower_placed(o, top);
    }
    if (!lower_is_finite(l, o, base) || !lower_is_finite(l, o, top))
        return false;
    if (base.x == top.x && base.y == top.y && base.z == top.z) {
        diag_report(l->diag, DIAG_DEGENERATE, o->span,
                    "the cylinder's height is lost in rounding at these coordinates");
        return false;
    }
    if (!round)
        return add_elliptic_cylinder(l, o, g, surface, base, top);
    if (!has_length(l, o, radius * factor))
        return false;
    geometry_add_cylinder(g, surface, base, top, radius * factor);
    return true;
}

static bool add_polygon(struct lowering *l, const struct desc_object *o, struct geometry *g,
                        uint32_t surface, const struct desc_value *corners)
{
    uint32_t v = (uint32_t)g->vertices.n;
    for (uint32_t i = 0; i < corners->n; i++) {
        struct vec3 p = lower_placed(o, corners->points[i]);
        if (!lower_is_finite(l, o, p))
            return false;
        geometry_add_vertex(g, p);
    }
    geometry_add_triangle(g, surface, v, v + 1, v + 2);
    if (corners->n == 4)
        geometry_add_triangle(g, surface, v + 2, v + 3, v);
    return true;
}

static bool add_triangle(struct lowering *l, const struct desc_object *o, struct geometry *g,
                         uint32_t surface)
{
    return add_polygon(l, o, g, surface, desc_get(o, PROP_TRIANGLE_VERTICES));
}

static bool add_quad(struct lowering *l, const struct desc_object *o, struct geometry *g,
                     uint32_t surface)
{
    return add_polygon(l, o, g, surface, desc_get(o, PROP_QUAD_VERTICES));
}

bool lower_has_volume(struct lowering *l, const struct desc_object *o)
{
    struct affine inverse;
    if (!o->place || affine_invert(o->place, &inverse))
        return true;
    struct diag_entry *e =
        diag_report(l->diag, DIAG_DEGENERATE, o->span, "the groups around this %s flatten it",
                    schema_kind_name(o->kind, o->xml));
    diag_note(e, "their transforms together leave nothing in some direction; a factor of 0, or "
                 "rows of a matrix that depend on each other");
    return false;
}

bool lower_shape(struct lowering *l, const struct desc_object *o, struct geometry *g,
                 uint32_t surface)
{
    static bool (*const add[SCHEMA_KINDS])(struct lowering * l, const struct desc_object *o,
                                           struct geometry *g, uint32_t surface) = {
        [KIND_SPHERE] = add_sphere, [KIND_CYLINDER] = add_cylinder, [KIND_TRIANGLE] = add_triangle,
        [KIND_QUAD] = add_quad,     [KIND_MESH] = lower_mesh_shape,
    };
    enum { MOST = 4 }; /* prims and vertices of any shape but a mesh, which asks for itself */
    assert(add[o->kind]);
    return lower_has_volume(l, o) && lower_fits(l, o, g, MOST, MOST) &&
           add[o->kind](l, o, g, surface);
}
