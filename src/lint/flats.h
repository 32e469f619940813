/* Triangles and quads as the description has them (internal to src/lint). */
#ifndef WRT_LINT_FLATS_H
#define WRT_LINT_FLATS_H

#include "eval/desc.h"

/* Where the corners of a triangle or quad are spelt. */
struct span flat_span(const struct desc_object *o);

/* The triangles it is made of, where it is placed: 1 or 2; 0 for other kinds. */
int flat_triangles(const struct desc_object *o, struct vec3 out[2][3]);

/* The height over the longest side, by that side; 0 when there is no area. */
double flat_relative_height(const struct vec3 v[3]);

/* Across the triangle, of length 1; it has an area. */
struct vec3 flat_normal(const struct vec3 v[3]);

#endif
