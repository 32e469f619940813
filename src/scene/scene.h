/* The runtime scene: what lowering leaves of a description, ready to trace.
 *
 * Built by src/lower, immutable afterwards.  Indexes are into the arrays of the same scene. */
#ifndef WRT_SCENE_SCENE_H
#define WRT_SCENE_SCENE_H

#include "base/arena.h"
#include "base/srcmap.h"
#include "image/picture.h"
#include "scene/geometry.h"
#include "scene/openmesh.h"

#include <stdbool.h>
#include <stdint.h>

#define TEXTURE_NONE UINT32_MAX

struct camera {
    struct vec3 origin;
    struct vec3 back; /* from the scene to the eye, any length */
    struct vec3 up;
    double yfov;              /* degrees; half the field of view once times the aspect ratio */
    uint32_t width, height;   /* the scene's own resolution */
    bool compatible;          /* compatMode 1; 0 negates the world z of directions */
};

struct texture {
    const struct image *image; /* one of the scene's */
    bool linear;         /* bilinear filter, else nearest */
    const char *file;    /* relative to the current folder */
};

/* uv * scale + offset */
struct uv_map {
    struct vec2 offset, scale;
};

enum material_kind {
    MATERIAL_LAMBERT,
    MATERIAL_PHONG,
    MATERIAL_SHINY,
    MATERIAL_METAL,
    MATERIAL_GLASS,
    MATERIAL_EMISSIVE,
};

struct material {
    enum material_kind kind;
    struct vec3 diffuse, specular, reflection, refraction; /* metal: already tinted by diffuse */
    double exponent, ior;
    uint32_t texture; /* or TEXTURE_NONE */
    struct uv_map uv;
};

enum surface_kind {
    SURFACE_SPHERE,
    SURFACE_CYLINDER,
    SURFACE_TRIANGLE,
    SURFACE_QUAD,
    SURFACE_MESH,
};

struct surface {
    enum surface_kind kind;
    uint32_t material;
    uint32_t first_prim, prim_count;
    uint32_t first_vertex;  /* triangle, quad, mesh */
    uint32_t normal_map;    /* texture, or TEXTURE_NONE */
    struct uv_map uv;       /* of the normal map */
    bool needs_uv;          /* its material has a texture or it has a normal map */
    bool flip;              /* mesh: normals negated */
    const struct vec3 *normals; /* smooth mesh: one a vertex, from first_vertex on; or NULL */
    const struct triangle_corners *normal_corners; /* normals by face instead; or NULL */
    const struct vec2 *uvs;     /* three a primitive, or NULL */
    struct span span;           /* where the scene text says it */
    uint32_t described;         /* its number among the description's surfaces */
};

enum light_kind { LIGHT_POINT, LIGHT_AREA };

/* A point of an area light's sample grid; equal points are merged. */
struct light_point {
    struct vec3 position;
    uint32_t count;   /* how many grid points lie here */
    bool on_object;   /* lies on the light's object: always counts */
    bool inside;      /* clearly inside a sphere: every ray through it meets the object */
};

struct light {
    enum light_kind kind;
    struct vec3 position, intensity;
    bool inverse_square;
    /* area lights: */
    struct geometry object; /* not part of the scene's geometry */
    VEC(struct light_point) points;
    struct span span; /* where the scene text says it */
};

struct scene {
    struct arena arena; /* owns normals, uvs and names */
    struct camera camera;
    struct geometry geometry;
    VEC(struct surface) surfaces;
    VEC(struct material) materials;
    VEC(struct texture) textures;
    VEC(struct image *) images; /* owned; several textures may show one */
    VEC(struct light) lights;
    VEC(const char *) skipped; /* names of what the scene did not need, for --stats */
};

void scene_free(struct scene *s);

/* The sample grid of an area light as the original spans it: samples^3 points spanning `box`,
 * corners included, merged where equal and marked where they lie on or in l->object, which must be
 * complete.  samples >= 2. */
void light_sample_grid(struct light *l, struct box box, uint32_t samples);

/* Texel fetch at (u, v), by the original's rule: row 0 of the coordinates is the bottom.  Any u
 * and v will do; what is not a finite number fetches texel 0. */
struct vec3 texture_fetch(const struct texture *t, double u, double v);

/* Texture coordinates of a hit with unit sphere/cylinder/triangle parametrisation (surface.c);
 * p is the hit point.  Only for surfaces with needs_uv. */
struct vec2 surface_uv(const struct scene *s, const struct surface *surface, const struct hit *hit,
                       struct vec3 p);

/* Shading normal before any normal map, made of the geometric one: interpolated for smooth meshes,
 * flipped where asked. */
struct vec3 surface_normal(const struct scene *s, const struct surface *surface,
                           const struct hit *hit, struct vec3 geometric);

#endif
