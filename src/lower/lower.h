/* Validated description to runtime scene, leaving out what the picture does not need: textures and
 * materials that nothing uses are never opened, texture coordinates are read only where a texture
 * or normal map asks for them, normals only where they are interpolated. */
#ifndef WRT_LOWER_LOWER_H
#define WRT_LOWER_LOWER_H

#include "diag/diag.h"
#include "eval/desc.h"
#include "scene/mesh.h"
#include "scene/scene.h"

/* A mesh file of the scene, for whoever wants to say more about it. */
struct lower_mesh {
    const char *path;               /* in the scene's arena */
    struct mesh *mesh;              /* NULL: it could not be read */
    const struct desc_value *asked; /* who named it first */
    const struct diag_frame *frame; /* and how evaluation came to that */
};

/* Textures, meshes and UV lists that are kept from one scene to the next, by their paths: each is
 * read once, when first needed. */
struct lower_files;
struct lower_files *lower_files_new(void);
void lower_files_free(struct lower_files *f);

struct lowered {
    struct scene scene;
    VEC(struct lower_mesh) meshes; /* each file once */
    bool borrowed;                 /* meshes and images belong to a struct lower_files */
};

/* Lowers into *out (initialised here; free with lower_free even after errors).  Mesh files and UV
 * lists become sources of `sources`, so that diagnostics can point into them.  True when there
 * were no errors. */
bool lower_scene(const struct desc *d, struct srcmap *sources, struct lowered *out,
                 struct diag *diag);

/* The same with files that are kept, which must outlive the scene, or NULL; textures are decoded by
 * so many threads. */
bool lower_scene_keeping(const struct desc *d, struct srcmap *sources, struct lower_files *files,
                         unsigned threads, struct lowered *out, struct diag *diag);

/* The same with every use of a mesh a copy: for whoever cannot share one. */
bool lower_scene_copied(const struct desc *d, struct srcmap *sources, struct lowered *out,
                        struct diag *diag);

void lower_free(struct lowered *l);

/* How often rays of the scene are mirrored or refracted. */
uint32_t lower_depth(const struct desc *d);

#endif
