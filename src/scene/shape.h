/* What each kind of primitive can do: the rows of geometry.c's table.  The tests against rays are
 * in intersect.h. */
#ifndef WRT_SCENE_SHAPE_H
#define WRT_SCENE_SHAPE_H

#include "scene/geometry.h"

struct box sphere_bounds(const struct geometry *g, uint32_t prim);
bool sphere_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach);
struct vec3 sphere_hit_point(const struct geometry *g, const struct ray *ray, const struct hit *hit,
                             struct vec3 *normal);

struct box cylinder_bounds(const struct geometry *g, uint32_t prim);
bool cylinder_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach);
struct vec3 cylinder_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit, struct vec3 *normal);

struct box triangle_bounds(const struct geometry *g, uint32_t prim);
bool triangle_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach);
struct vec3 triangle_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit, struct vec3 *normal);

struct box instance_bounds(const struct geometry *g, uint32_t prim);
bool instance_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach);
struct vec3 instance_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit, struct vec3 *normal);
/* As geometry_intersect: tries every primitive of the shape. */
bool instance_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                        struct hit *best);

/* index: into the array of the kind. */
void geometry_add_prim(struct geometry *g, enum prim_kind kind, size_t index, uint32_t surface);

/* The unit normal of three corners, zero when they span no area. */
struct vec3 triangle_unit_normal(struct vec3 v0, struct vec3 v1, struct vec3 v2);

#endif
