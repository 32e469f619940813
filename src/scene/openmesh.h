/* What the C side and the OpenMesh shim (openmesh.cc) share; readable as C and as C++. */
#ifndef WRT_SCENE_OPENMESH_H
#define WRT_SCENE_OPENMESH_H

#include "math/vec3.h"

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

struct triangle_corners {
    uint32_t at[3];
};

/* What the half-edge structure says of a mesh. */
struct mesh_report {
    size_t boundary_edges;     /* edges of a single face; 0: closed */
    size_t non_manifold_faces; /* refused by the half-edge structure, added in file order */
    size_t degenerate_faces;   /* repeated corner or zero area */
    size_t unused_vertices;    /* in no face */
    double volume;             /* signed; negative: inside out (closed meshes) */
    /* Of the first of each, where there are any: */
    size_t first_non_manifold, first_degenerate; /* faces */
    size_t first_unused;                         /* vertex */
    uint32_t first_boundary[2];                  /* vertices of the edge, the lower one first */
};

/* mesh_face_normal, as the shim is told of it. */
typedef int openmesh_normal(struct vec3 a, struct vec3 b, struct vec3 c, struct vec3 *normal);

enum openmesh_result { OPENMESH_DONE, OPENMESH_TOO_LARGE, OPENMESH_NO_MEMORY, OPENMESH_FAILED };

/* The shim's: as openmesh_analyse, but returns an openmesh_result. */
int openmesh_module_analyse(const struct vec3 *points, size_t point_count,
                            const struct triangle_corners *faces, size_t face_count,
                            openmesh_normal *face_normal, struct mesh_report *report);

/* Returns NULL or a static reason; prints nothing, throws nothing.  Every corner must be below
 * point_count.  Without OpenMesh or its module (openmesh_load.c) there is only the reason. */
const char *openmesh_analyse(const struct vec3 *points, size_t point_count,
                             const struct triangle_corners *faces, size_t face_count,
                             struct mesh_report *report);

/* The unit normal along (b - a) x (c - a); false and (0, 0, 0) when the area is zero. */
int mesh_face_normal(struct vec3 a, struct vec3 b, struct vec3 c, struct vec3 *normal);

#ifdef __cplusplus
}
#endif

#endif
