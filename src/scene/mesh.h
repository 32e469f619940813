/* Mesh files: flat arrays as the file spells them. */
#ifndef WRT_SCENE_MESH_H
#define WRT_SCENE_MESH_H

#include "base/srcmap.h"
#include "base/str.h"
#include "base/vec.h"
#include "diag/diag.h"
#include "math/vec3.h"
#include "scene/openmesh.h"

#include <stdbool.h>
#include <stdint.h>

/* Indexes of the corners of triangles, by face. */
struct corner_list {
    struct triangle_corners *at;
    size_t n, capacity;
};

/* In normal_corners: the face has none in the file, so its vertices' own are taken. */
#define MESH_NO_INDEX UINT32_MAX

struct mesh {
    VEC(struct vec3) points;
    struct corner_list faces; /* file order; larger faces as fans */

    VEC(struct vec2) uvs; /* three a face; empty when the file has none */
    size_t bare_faces;    /* triangles without, where others have some: (0, 0) here */
    struct span bare;     /* the first of these */

    VEC(struct vec3) normals;          /* of length 1 or 0 */
    struct corner_list normal_corners; /* into normals; empty when the file has none */
};

struct mesh *mesh_new(void);
void mesh_free(struct mesh *m);

/* Parses a mesh file: OFF, OBJ, PLY or STL, text or binary.  The content tells the format, and only
 * where it does not the suffix of the source's name.  Coordinates in text are the doubles nearest
 * to the spelling.  Errors go to diag at their place in the mesh file (source is in the srcmap);
 * NULL then.  So does what the file has and nothing here uses.  A file of no faces is a mesh of
 * none. */
struct mesh *mesh_parse(const struct source *source, struct diag *diag);

/* Whether both the name and the bytes of a file are those of a mesh. */
bool mesh_recognised(const char *name, char *bytes, size_t n);

/* ---- the formats, for mesh_parse ---- */

/* OFF, text or binary (`OFF BINARY`, Geomview's layout and OpenMesh's); the rest of the family
 * (COFF, NOFF, STOFF, 4OFF, nOFF) is refused. */
struct mesh *off_parse(const struct source *source, struct diag *diag);

/* Whether the word opens a file of the OFF family; *meaning says what its letters add, or NULL. */
bool off_is_header(struct str word, const char **meaning);

/* The part of off_parse behind the line `OFF BINARY`: appends to m, which is empty.  Returns NULL
 * or a static reason. */
const char *off_parse_binary(const uint8_t *bytes, size_t n, struct mesh *m);

/* Wavefront OBJ: polygons with texture coordinates and normals. */
struct mesh *obj_parse(const struct source *source, struct diag *diag);

/* Whether the word is a statement of OBJ files. */
bool obj_is_statement(struct str word);

/* PLY, text or binary of either byte order: faces and triangle strips. */
struct mesh *ply_parse(const struct source *source, struct diag *diag);

/* STL, text or binary.  Vertices of equal coordinates are one. */
struct mesh *stl_parse(const struct source *source, struct diag *diag);

/* Whether a file is binary STL by the triangles it counts and its length. */
bool stl_is_binary(const struct source *source);

/* ---- beside the mesh ---- */

/* A UV list: one `u v` pair a line, blank lines skipped, 3 pairs a face (of struct mesh, so three
 * for each triangle of a fan).  On success *out holds 3 faces pairs, for the caller to free; false
 * after reporting to diag. */
bool uv_list_parse(const struct source *source, size_t faces, struct vec2 **out, struct diag *diag);

/* The direction of v with length 1, or 0 when it has none; v is finite. */
struct vec3 mesh_direction(struct vec3 v);

/* One unit normal a vertex: the normalised sum of the unit normals of its faces; faces of zero
 * area add nothing.  A vertex without any, or whose faces cancel, gets (0, 0, 0).  Vertices are
 * what the file's indexes say, so spots that are not manifold need no care. */
void mesh_vertex_normals(const struct vec3 *points, size_t point_count,
                         const struct triangle_corners *faces, size_t face_count,
                         struct vec3 *normals);

#endif
