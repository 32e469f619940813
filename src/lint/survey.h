/* What the checks of a lowered scene share; each part is made when first asked for. */
#ifndef WRT_LINT_SURVEY_H
#define WRT_LINT_SURVEY_H

#include "accel/bvh.h"
#include "lower/lower.h"

struct survey;

/* Both are borrowed and must not change. */
struct survey *survey_new(const struct desc *desc, const struct lowered *lowered);
void survey_free(struct survey *s);

/* The scene's tree, boxes of its surfaces, and the box of all. */
const struct accel *survey_accel(struct survey *s);
const struct box *survey_boxes(struct survey *s);
struct box survey_bounds(struct survey *s);

/* What the analysis says of a mesh file (its number in struct lowered); NULL when it could not be
 * analysed. */
const struct mesh_report *survey_mesh(struct survey *s, uint32_t number);

/* Without boundary, and with one side that is the outside: what is so analysed has a volume. */
bool survey_is_closed(const struct mesh_report *r);

/* The object of the description that the surface comes from. */
const struct desc_object *survey_object(const struct survey *s, uint32_t surface);
const struct material *survey_material(const struct survey *s, uint32_t surface);

/* Whether nothing is seen through it and no light gets past it. */
bool survey_is_opaque(const struct survey *s, uint32_t surface);
/* Whether rays are reflected or refracted by it. */
bool survey_bounces(const struct survey *s, uint32_t surface);

/* Whether the point is clearly inside the surface: a sphere, cylinder, ellipsoid or closed mesh. */
bool survey_holds(struct survey *s, uint32_t surface, struct vec3 p);

/* The opaque surfaces that the point is inside of, in no order; those behind many others are not
 * looked for.  Returns how many. */
enum { SURVEY_AROUND = 8 };
unsigned survey_around(struct survey *s, struct vec3 p, uint32_t surfaces[SURVEY_AROUND]);

/* The places that light comes from: where it is, and its samples.  NULL: the n-th is none. */
const struct vec3 *survey_light_place(const struct light *light, size_t n);

/* A box around all shadow rays' ends at a light that is no sun. */
struct box survey_light_box(const struct light *light);

#endif
