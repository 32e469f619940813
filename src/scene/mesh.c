#include "config.h"

#include "scene/mesh.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* A sum of unit normals shorter than this is what rounding left of faces that cancel (the two
 * sides of a leaf): its direction means nothing. */
#define CANCELLED (64 * DBL_EPSILON)

struct mesh *mesh_new(void)
{
    return mem_zalloc(1, sizeof(struct mesh));
}

void mesh_free(struct mesh *m)
{
    if (!m)
        return;
    vec_free(&m->points);
    vec_free(&m->faces);
    vec_free(&m->uvs);
    vec_free(&m->normals);
    vec_free(&m->normal_corners);
    free(m);
}

/* Scaled by a power of two, which is exact, where products could overflow or vanish. */
static struct vec3 scaled_to_one(struct vec3 v)
{
    int exponent;
    double largest = vec3_largest(v);
    if (!(largest > 0) || isinf(largest) || (largest > 1e-100 && largest < 1e100))
        return v;
    frexp(largest, &exponent);
    return vec3(ldexp(v.x, -exponent), ldexp(v.y, -exponent), ldexp(v.z, -exponent));
}

struct vec3 mesh_direction(struct vec3 v)
{
    v = scaled_to_one(v);
    double length = vec3_length(v);
    return length > 0 ? vec3_scale(v, 1 / length) : vec3_all(0);
}

int mesh_face_normal(struct vec3 a, struct vec3 b, struct vec3 c, struct vec3 *normal)
{
    struct vec3 n = vec3_cross(scaled_to_one(vec3_sub(b, a)), scaled_to_one(vec3_sub(c, a)));
    n = scaled_to_one(n);
    double length = vec3_length(n);
    bool has_area = length > 0 && isfinite(length);
    *normal = has_area ? vec3_scale(n, 1 / length) : vec3_all(0);
    return has_area;
}

void mesh_vertex_normals(const struct vec3 *points, size_t point_count,
                         const struct triangle_corners *faces, size_t face_count,
                         struct vec3 *normals)
{
    for (size_t i = 0; i < point_count; i++)
        normals[i] = vec3_all(0);
    for (size_t i = 0; i < face_count; i++) {
        const uint32_t *v = faces[i].at;
        struct vec3 n;
        if (!mesh_face_normal(points[v[0]], points[v[1]], points[v[2]], &n))
            continue;
        for (int k = 0; k < 3; k++)
            normals[v[k]] = vec3_add(normals[v[k]], n);
    }
    for (size_t i = 0; i < point_count; i++) {
        double length = vec3_length(normals[i]);
        normals[i] = length > CANCELLED ? vec3_scale(normals[i], 1 / length) : vec3_all(0);
    }
}
