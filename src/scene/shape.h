/* What each kind of primitive can do; geometry.h calls these by kind. */
#ifndef WRT_SCENE_SHAPE_H
#define WRT_SCENE_SHAPE_H

#include "scene/geometry.h"

struct box sphere_bounds(const struct geometry *g, uint32_t prim);
bool sphere_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                      const struct ray_frame *frame, struct hit *best);
bool sphere_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p);
struct vec3 sphere_hit_point(const struct geometry *g, const struct ray *ray,
                             const struct hit *hit);
struct vec3 sphere_normal(const struct geometry *g, const struct hit *hit, struct vec3 p);

struct box cylinder_bounds(const struct geometry *g, uint32_t prim);
bool cylinder_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                        const struct ray_frame *frame, struct hit *best);
bool cylinder_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p);
struct vec3 cylinder_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit);
struct vec3 cylinder_normal(const struct geometry *g, const struct hit *hit, struct vec3 p);

struct box triangle_bounds(const struct geometry *g, uint32_t prim);
bool triangle_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                        const struct ray_frame *frame, struct hit *best);
bool triangle_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p);
struct vec3 triangle_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit);
struct vec3 triangle_normal(const struct geometry *g, const struct hit *hit, struct vec3 p);

/* The unit normal of three corners; zero when they span no area. */
struct vec3 triangle_unit_normal(struct vec3 v0, struct vec3 v1, struct vec3 v2);

/* Whether the triangle's plane goes through p within rounding; `distance` is normal . (v0 - p). */
bool triangle_plane_holds(const struct geometry *g, const struct triangle *t, struct vec3 p,
                          double distance);

/* c = |p - center|^2 - radius^2, or exactly 0 when p lies on the sphere within rounding. */
double sphere_power(const struct sphere *s, struct vec3 p);

#endif
