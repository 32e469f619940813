/* The surfaces' primitives: spheres, capped cylinders and triangles, numbered in file order.
 *
 * A surface owns a run of primitives: a sphere or cylinder one, a triangle one, a quad two
 * (v0 v1 v2, v2 v3 v0), a mesh one a face.  Equal distances go to the lower number.  Immutable
 * once a scene is lowered; free of absolute tolerances.  shape.h has what each kind can do.
 *
 * A surface may also own one instance: a shape in space of its own, and the affine map that takes
 * it to its place.  Such are ellipsoids and elliptic cylinders, and meshes that many surfaces
 * share. Rays are taken into the shape's space, with their direction's length, so that distances
 * along them are the same in both. */
#ifndef WRT_SCENE_GEOMETRY_H
#define WRT_SCENE_GEOMETRY_H

#include "base/vec.h"
#include "math/box.h"
#include "math/ray.h"
#include "math/transform.h"

#include <stdbool.h>
#include <stdint.h>

enum prim_kind { PRIM_SPHERE, PRIM_CYLINDER, PRIM_TRIANGLE, PRIM_INSTANCE, PRIM_KINDS };

struct prim {
    uint32_t kind : 2, index : 30; /* into the array of its kind */
    uint32_t surface;              /* the surface it belongs to */
};

struct sphere {
    struct vec3 center;
    double radius; /* > 0 */
    double reach;  /* largest |coordinate| of the center, and the radius */
};

struct cylinder {
    struct vec3 base;      /* centre of the base cap */
    struct vec3 axis;      /* unit, from base to top */
    double height, radius; /* > 0 */
};

struct triangle {
    uint32_t vertex[3];
    double reach;       /* largest |coordinate| of the corners */
    struct vec3 normal; /* unit, (v1 - v0) x (v2 - v0); zero for a triangle without area */
};

struct instance {
    struct affine to_world, to_shape;
    uint32_t prototype; /* the geometry that holds the shape */
    uint32_t only;      /* the primitive that is the shape, or PRIM_NONE: all of them */
    struct box box;     /* in the world */
    /* Points on the shape, taken into its space, have the rounding errors of coordinates as large as
     * growth times the point's largest, plus reach. */
    double growth, reach;
};

struct prototype;

struct geometry {
    VEC(struct prim) prims;
    VEC(struct sphere) spheres;
    VEC(struct cylinder) cylinders;
    VEC(struct triangle) triangles;
    VEC(struct vec3) vertices;
    VEC(struct instance) instances;
    VEC(struct prototype *) prototypes; /* owned */
    double worst_growth; /* of rounding errors on the way through an instance's space; 0: none */
};

/* Shapes of instances; none of them is an instance. */
struct prototype {
    struct geometry shapes;
    struct box box; /* of all of them, once there is an instance of all of them */
};

/* Limit on the primitives of one geometry (prim.index has 30 bits). */
#define GEOMETRY_LIMIT (UINT32_C(1) << 30)

void geometry_free(struct geometry *g);

/* Append a primitive of the surface with this number. */
void geometry_add_sphere(struct geometry *g, uint32_t surface, struct vec3 center, double radius);
void geometry_add_cylinder(struct geometry *g, uint32_t surface, struct vec3 base, struct vec3 top,
                           double radius);
/* The three vertices must have been added before. */
void geometry_add_triangle(struct geometry *g, uint32_t surface, uint32_t v0, uint32_t v1,
                           uint32_t v2);
/* Appends a vertex, returns its number. */
uint32_t geometry_add_vertex(struct geometry *g, struct vec3 p);

/* Appends an empty geometry for the shapes of instances, returns its number.  Number 0 is there for
 * spheres and cylinders, of which the first is a sphere of radius 1 around the origin. */
enum { PROTOTYPE_SOLIDS };
uint32_t geometry_add_prototype(struct geometry *g);
struct geometry *geometry_solids(struct geometry *g);

/* The shape must be complete: the sphere or cylinder `only` of the prototype, or all of it
 * (triangles) for PRIM_NONE.  False, and nothing is added, when the map has no inverse, or the
 * instance reaches beyond all numbers. */
bool geometry_add_instance(struct geometry *g, uint32_t surface, uint32_t prototype, uint32_t only,
                           const struct affine *to_world);

struct box geometry_prim_bounds(const struct geometry *g, uint32_t prim);
struct box geometry_bounds(const struct geometry *g);

/* The nearest hit of the ray with this one primitive that beats *best (see struct hit for the
 * order; start with hit_none(ray->t_max)); updates *best and returns true if so. */
bool geometry_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                        const struct ray_frame *frame, struct hit *best);

/* Whether p lies on the primitive within rounding (its boundary included).  `reach`: how large the
 * coordinates are that p's rounding errors come from. */
bool geometry_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach);

/* What a hit lies on: a primitive of the geometry, or one within an instance. */
struct spot {
    const struct geometry *geometry;
    uint32_t prim, part;
    const struct instance *instance; /* NULL: none */
};
struct spot geometry_spot(const struct geometry *g, const struct hit *hit);

/* The hit point, put back onto the primitive (projected to a sphere, a cylinder or a triangle's
 * plane): within a few ulps of the surface whatever the ray's length.  *normal becomes the unit
 * normal there: outwards for sphere and cylinder, (v1-v0) x (v2-v0) for a triangle. */
struct vec3 geometry_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit, struct vec3 *normal);

/* How far inside of its edges a hit point is kept, in tolerances of rays that start there: off the
 * plane of what meets the triangle there at 4 degrees or more. */
#define EDGE_CLEARANCE 16

/* A hit point on a triangle is not left on an edge, or beyond one by a rounding error: a ray that
 * starts there would leave out the face on the other side, which may stand in its way.  `reach` as
 * for geometry_lies_on.  Points on instances are settled already. */
struct vec3 triangle_settle(const struct geometry *g, uint32_t prim, struct vec3 p, double reach);

/* Works out b1 and b2 of a hit on a triangle. */
void geometry_weights(const struct geometry *g, const struct ray *ray, struct hit *hit);

#endif
