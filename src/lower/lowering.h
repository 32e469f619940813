/* What the parts of lowering share (internal to src/lower). */
#ifndef WRT_LOWER_LOWERING_H
#define WRT_LOWER_LOWERING_H

#include "base/map.h"
#include "lower/lower.h"

/* A mesh file in the proportions that surfaces use it in. */
struct mesh_model {
    const struct mesh *mesh;
    uint32_t file;              /* number of the mesh file */
    struct vec3 ratio;          /* of the model's coordinates to the file's */
    size_t uses;                /* by surfaces that may be instances */
    uint32_t prototype;         /* in the scene's geometry; 0: there is none so far */
    const struct vec3 *normals; /* in the model's space, once asked for */
    const struct triangle_corners *normal_corners;
};

struct lower_files {
    struct arena arena;               /* owns paths and UV lists */
    struct map images, meshes, lists; /* by path; UV lists by number of faces and path */
    VEC(struct image *) all_images;
    VEC(struct mesh *) all_meshes;
};

/* A texture or a mesh that is going to be asked for. */
struct lower_ahead {
    const char *path;
    const struct source *source; /* of a mesh */
    struct image *image;         /* NULL: taken, or it could not be decoded */
    struct mesh *mesh;           /* NULL: taken, or there is something to say of it */
};

struct lowering {
    struct lower_files *kept; /* or NULL */
    const struct desc *desc;
    struct srcmap *sources;
    struct lowered *out;
    struct scene *scene; /* &out->scene */
    struct diag *diag;
    bool copied;                      /* every use of a mesh is a copy */
    uint32_t *material_of;            /* scene material of each described one, or UINT32_MAX */
    uint32_t *texture_of;             /* likewise, of textures that are light */
    uint32_t *data_of;                /* of those that are normals */
    const double *decode8, *decode16; /* see struct texture; NULL until needed */
    VEC(struct lower_ahead) ahead;
    struct map ahead_of; /* path to its number there + 1, as a pointer */
    struct map images;   /* path to struct image, decoded once */
    struct map meshes;   /* path to its number in out->meshes + 1, as a pointer */
    struct map models;   /* path and ratio to struct mesh_model */
    struct map uv_lists; /* path and number of faces to struct vec2 */
};

/* ---- ahead.c ---- */

/* Decodes the textures and meshes of all surfaces, if there are several, and several threads for
 * it.
 */
void lower_look_ahead(struct lowering *l, unsigned threads);
/* What is known of the file, or NULL; who takes its image or mesh puts NULL there. */
struct lower_ahead *lower_ahead(struct lowering *l, const char *path);
void lower_ahead_free(struct lowering *l);

/* ---- files.c ---- */

/* The path a property means, in the scene's arena: relative to the file that spells it. */
const char *lower_path_of(struct lowering *l, const struct desc_value *file);

/* The scene's texture for a described one, loaded when first asked for; TEXTURE_NONE for NULL and
 * after errors.  data: what it holds is no light, as a normal map's. */
uint32_t lower_texture(struct lowering *l, const struct desc_object *texture, bool data);

/* The mesh a property names, read when first asked for.  Valid until the next is read. */
const struct lower_mesh *lower_mesh_file(struct lowering *l, const struct desc_value *file);

/* What was found in a file since the first entries also shows who asked for the file. */
void lower_label_request(struct lowering *l, size_t first, const struct desc_value *file);

/* The UV list a property names, in the scene's arena, read once; NULL after errors. */
const struct vec2 *lower_uv_file(struct lowering *l, const struct desc_value *file, size_t faces);

/* ---- surfaces.c ---- */

void lower_surface(struct lowering *l, const struct desc_object *o);

/* The property that asks for texture coordinates, or NULL. */
const struct desc_prop *lower_wants_uvs(const struct desc_object *o);

/* ---- shapes.c ---- */

/* Appends the primitives of the shape, at its place, to g, as those of surface number `surface`.
 * False after errors. */
bool lower_shape(struct lowering *l, const struct desc_object *o, struct geometry *g,
                 uint32_t surface);

/* The same for a ball of these measures before it is placed. */
bool lower_ball(struct lowering *l, const struct desc_object *o, struct geometry *g,
                uint32_t surface, struct vec3 center, double radius);

/* The point at the object's place. */
struct vec3 lower_placed(const struct desc_object *o, struct vec3 p);

/* Each of these reports when the answer is no: whether g can take so much more; whether the
 * object's place leaves it all its dimensions; whether a point of it is finite. */
bool lower_fits(struct lowering *l, const struct desc_object *o, const struct geometry *g,
                size_t more_prims, size_t more_vertices);
bool lower_has_volume(struct lowering *l, const struct desc_object *o);
bool lower_is_finite(struct lowering *l, const struct desc_object *o, struct vec3 p);

/* geometry_add_instance; false after reporting. */
bool lower_add_instance(struct lowering *l, const struct desc_object *o, struct geometry *g,
                        uint32_t surface, uint32_t prototype, uint32_t only,
                        const struct affine *to_world);

/* ---- meshes.c ---- */

/* Finds out how often each mesh is used, and reads them: to be called before any is lowered. */
void lower_count_meshes(struct lowering *l);

/* Lowers a mesh of the scene: its shape, texture coordinates and normals.  False after errors. */
bool lower_mesh(struct lowering *l, const struct desc_object *o, struct surface *s);

/* As lower_shape, for a mesh. */
bool lower_mesh_shape(struct lowering *l, const struct desc_object *o, struct geometry *g,
                      uint32_t surface);

/* A debug view, a surface of its own: a white cylinder along each vertex normal, a tenth of its
 * length in radius. */
void lower_normal_cylinders(struct lowering *l, const struct desc_object *o,
                            const struct surface *mesh);

/* ---- lights.c ---- */

void lower_light(struct lowering *l, const struct desc_object *o);

#endif
