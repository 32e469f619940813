/* What the parts of lowering share (internal to src/lower). */
#ifndef WRT_LOWER_LOWERING_H
#define WRT_LOWER_LOWERING_H

#include "base/map.h"
#include "lower/lower.h"

struct lowering {
    const struct desc *desc;
    struct srcmap *sources;
    struct lowered *out;
    struct scene *scene; /* &out->scene */
    struct diag *diag;
    uint32_t *material_of; /* scene material of each described one, or UINT32_MAX */
    uint32_t *texture_of;  /* likewise */
    struct map images;     /* path to struct image, decoded once */
    struct map meshes;     /* path to its number in out->meshes + 1, as a pointer */
};

/* ---- files.c ---- */

/* The scene's texture for a described one, loaded when first asked for; TEXTURE_NONE for NULL and
 * after errors. */
uint32_t lower_texture(struct lowering *l, const struct desc_object *texture);

/* The mesh a property names, read when first asked for; NULL after errors.  Borrowed. */
const struct mesh *lower_mesh_file(struct lowering *l, const struct desc_value *file);

/* What was found in a file since the first entries also shows who asked for the file. */
void lower_label_request(struct lowering *l, size_t first, const struct desc_value *file);

/* The UV list a property names, in the scene's arena; NULL after errors. */
const struct vec2 *lower_uv_file(struct lowering *l, const struct desc_value *file, size_t faces);

/* ---- surfaces.c ---- */

void lower_surface(struct lowering *l, const struct desc_object *o);

/* Appends the primitives of the shape to g, as those of surface number `surface`.  *first_vertex
 * is the first vertex it added.  False after errors. */
bool lower_shape(struct lowering *l, const struct desc_object *o, struct geometry *g,
                 uint32_t surface, uint32_t *first_vertex);

/* Whether g can take so much more; reports if not. */
bool lower_fits(struct lowering *l, const struct desc_object *o, const struct geometry *g,
                size_t more_prims, size_t more_vertices);

/* ---- meshes.c ---- */

/* As lower_shape, for a mesh. */
bool lower_mesh_shape(struct lowering *l, const struct desc_object *o, struct geometry *g,
                      uint32_t surface);

/* The texture coordinates of the mesh's faces: of its UV list or else of its file, which owns them
 * then; NULL after errors.  `why` is the property that asks for them. */
const struct vec2 *lower_mesh_uvs(struct lowering *l, const struct desc_object *o,
                                  const struct desc_prop *why);

/* Fills in the vertex normals of a mesh whose shape is lowered: the file's, or else its faces'. */
void lower_mesh_normals(struct lowering *l, const struct desc_object *o, struct surface *s);

/* A debug view, a surface of its own: a white cylinder along each vertex normal, a tenth of its
 * length in radius. */
void lower_normal_cylinders(struct lowering *l, const struct desc_object *o,
                            const struct surface *mesh);

/* ---- lights.c ---- */

void lower_light(struct lowering *l, const struct desc_object *o);

#endif
