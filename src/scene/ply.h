/* What the two halves of the PLY reader share: the header says how the body is to be read. */
#ifndef WRT_SCENE_PLY_H
#define WRT_SCENE_PLY_H

#include "scene/mesh.h"
#include "scene/scan.h"

enum ply_layout { PLY_TEXT, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN };

enum ply_type {
    PLY_NONE,
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64,
    PLY_TYPES
};

extern const uint8_t ply_sizes[PLY_TYPES]; /* in bytes */

/* What a property is to us. */
enum ply_role {
    ROLE_NONE,
    ROLE_X,
    ROLE_Y,
    ROLE_Z,
    ROLE_NX,
    ROLE_NY,
    ROLE_NZ,
    ROLE_U,
    ROLE_V,
    ROLE_CORNERS,    /* list: vertices of a face or strip */
    ROLE_CORNER_UVS, /* list: two numbers a corner */
    PLY_ROLES
};

struct ply_property {
    struct str name;
    enum ply_type type;
    enum ply_type count; /* of a list's length; PLY_NONE: a single value */
    enum ply_role role;
};

enum ply_use { PLY_UNUSED, PLY_VERTICES, PLY_FACES, PLY_STRIPS };

struct ply_element {
    struct str name;
    struct span span; /* its line of the header */
    uint64_t n;       /* rows */
    enum ply_use use;
    uint32_t roles; /* bit r: a property has role r */
    VEC(struct ply_property) properties;
};

struct ply_header {
    enum ply_layout layout;
    VEC(struct ply_element) elements;
    uint64_t vertices;
};

static inline bool ply_has(const struct ply_element *e, enum ply_role role)
{
    return e->roles >> role & 1;
}

/* Reads the header; `in` is then at the start of the body.  False after reporting; free the header
 * in either case. */
bool ply_read_header(struct scan *in, struct ply_header *h);
void ply_free_header(struct ply_header *h);

#endif
