/* Mesh files: flat arrays as the file spells them. */
#ifndef WRT_SCENE_MESH_H
#define WRT_SCENE_MESH_H

#include "base/srcmap.h"
#include "base/vec.h"
#include "diag/diag.h"
#include "math/vec3.h"
#include "scene/openmesh.h"

#include <stdbool.h>
#include <stdint.h>

struct mesh {
    VEC(struct vec3) points;
    VEC(struct triangle_corners) faces; /* file order; larger faces as fans */
};

struct mesh *mesh_new(void);
void mesh_free(struct mesh *m);

/* Parses an OFF file, text or binary (`OFF BINARY`, Geomview's layout and OpenMesh's).
 * Coordinates are the doubles nearest to the spelling.  Errors (counts, indexes, numbers,
 * non-finite coordinates, truncation, COFF, NOFF, STOFF, 4OFF, nOFF) go to diag at their place in
 * the mesh file (source is in the srcmap); NULL then.  A file of no faces is a mesh of none. */
struct mesh *off_parse(const struct source *source, struct diag *diag);

/* The part of off_parse behind the line `OFF BINARY`: appends to m, which is empty.  Returns NULL
 * or a static reason. */
const char *off_parse_binary(const uint8_t *bytes, size_t n, struct mesh *m);

/* A UV list: one `u v` pair a line, blank lines skipped, 3 pairs a face (of struct mesh, so three
 * for each triangle of a fan).  On success *out holds 3 faces pairs, for the caller to free; false
 * after reporting to diag. */
bool uv_list_parse(const struct source *source, size_t faces, struct vec2 **out, struct diag *diag);

/* One unit normal a vertex: the normalised sum of the unit normals of its faces; faces of zero
 * area add nothing.  A vertex without any, or whose faces cancel, gets (0, 0, 0).  Vertices are
 * what the file's indexes say, so spots that are not manifold need no care. */
void mesh_vertex_normals(const struct vec3 *points, size_t point_count,
                         const struct triangle_corners *faces, size_t face_count,
                         struct vec3 *normals);

#endif
