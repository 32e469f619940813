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

/* Whose arithmetic makes the picture: the original program's, or ours (wrt(5)). */
enum scene_model { SCENE_CLASSIC, SCENE_MODERN };

struct camera {
    struct vec3 origin;
    struct vec3 back; /* from the scene to the eye, any length */
    struct vec3 up;
    double yfov;            /* degrees; classic: half the field of view once times the aspect
                               ratio; modern: the full vertical one, or 0: parallel rays */
    double view_height;     /* of a picture by parallel rays */
    uint32_t width, height; /* the scene's own resolution */
    bool compatible;        /* classic: compatMode 1; 0 negates the world z of directions */
    bool modern;
};

struct texture {
    const struct image *image; /* one of the scene's */
    bool linear;               /* bilinear filter, else nearest */
    bool centred;              /* modern: texels are at their centres */
    const double *decode; /* modern: a sample's light, from 0 to 1; NULL: it over the largest */
    const char *file;     /* relative to the current folder */
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
    uint32_t first_vertex;      /* triangle, quad, mesh */
    uint32_t normal_map;        /* texture, or TEXTURE_NONE */
    struct uv_map uv;           /* of the normal map */
    bool needs_uv;              /* its material has a texture or it has a normal map */
    bool flip;                  /* mesh: normals negated */
    const struct vec3 *normals; /* smooth mesh: one a vertex, from first_vertex on; or NULL */
    const struct triangle_corners *normal_corners; /* normals by face instead; or NULL */
    const struct vec2 *uvs;                        /* three a primitive, or NULL */
    struct span span;                              /* where the scene text says it */
    uint32_t described;                            /* its number among the description's surfaces */
    uint32_t mesh_file;                            /* mesh: its number in struct lowered */
};

enum light_kind { LIGHT_POINT, LIGHT_AREA, LIGHT_SUN };

/* A point of an area light's sample grid; equal points are merged. */
struct light_point {
    struct vec3 position;
    uint32_t count; /* how many grid points lie here */
    bool on_object; /* lies on the light's object: always counts */
    bool inside;    /* clearly inside a sphere: every ray through it meets the object */
};

/* A place on an area light's surface, modern. */
struct light_sample {
    struct vec3 position, normal;
    double share; /* of the light's intensity, along the normal */
};

struct light {
    enum light_kind kind;
    struct vec3 position; /* sun: the unit direction to it */
    struct vec3 intensity;
    bool inverse_square;
    /* area lights: */
    struct geometry object;           /* not part of the scene's geometry */
    VEC(struct light_point) points;   /* classic */
    VEC(struct light_sample) samples; /* modern: `grid` x `grid`, at their strata's centres */
    VEC(double) areas;                /* modern: of the object's primitives and all before them */
    uint32_t grid;
    double growth;    /* modern: of the samples' areas, on average, when an instance is placed */
    bool both_sides;  /* modern: its normals have no outside */
    struct span span; /* where the scene text says it */
};

struct scene {
    struct arena arena; /* owns normals, uvs, decoding tables and names */
    enum scene_model model;
    struct vec3 background, ambient; /* modern */
    uint32_t depth, grid; /* of rays, and samples along a pixel, unless asked otherwise */
    bool linear;          /* modern: pictures hold light as it is, not sRGB */
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

/* Makes ready the surface of an area light of `grid` x `grid` samples for modern, once l->object is
 * complete.  False when it has no area. */
bool light_surface(struct light *l, uint32_t grid);

/* The place on the light's surface at (a, b), both from 0 to below 1: equal areas of one get equal
 * areas of the other. */
struct light_sample light_surface_at(const struct light *l, double a, double b);

/* Texel fetch at (u, v): row 0 of the coordinates is the bottom; classic by the original's rule,
 * modern with texels at their centres and repeated.  Any u and v will do; what is not a finite
 * number fetches texel 0. */
struct vec3 texture_fetch(const struct texture *t, double u, double v);

/* Texture coordinates of a hit with unit sphere/cylinder/triangle parametrisation (surface.c);
 * p is the hit point.  Only for surfaces with needs_uv. */
/* A sphere's: longitude from +x over +z, and latitude counted down from the north pole. */
struct vec2 sphere_uv(const struct sphere *s, struct vec3 p);
struct vec2 surface_uv(const struct scene *s, const struct surface *surface, const struct hit *hit,
                       struct vec3 p);

/* That of a hit on a triangle with these coordinates at its corners, and weights of the second and
 * the third. */
static inline struct vec2 triangle_uv(const struct vec2 corner[3], double b1, double b2)
{
    double b0 = 1 - b1 - b2;
    return (struct vec2){b0 * corner[0].x + b1 * corner[1].x + b2 * corner[2].x,
                         b0 * corner[0].y + b1 * corner[1].y + b2 * corner[2].y};
}

/* Whether something is interpolated between a triangle's corners. */
static inline bool surface_interpolates(const struct surface *s)
{
    return s->normals || s->uvs;
}

/* Shading normal before any normal map, made of the geometric one: interpolated for smooth meshes,
 * flipped where asked. */
struct vec3 surface_normal(const struct scene *s, const struct surface *surface,
                           const struct hit *hit, struct vec3 geometric);

/* The triangle's number within its surface, to which normals and texture coordinates belong. */
size_t surface_face(const struct surface *surface, const struct spot *spot);

/* The triangles that a surface's normals and texture coordinates belong to, those of an instance in
 * the space of its shapes. */
struct surface_faces {
    const struct geometry *geometry;
    uint32_t first_prim, n, first_vertex;
};
struct surface_faces surface_faces(const struct scene *s, const struct surface *surface);

/* The normal of corner i of a smooth mesh's triangle, of length 1 or 0. */
struct vec3 surface_corner_normal(const struct surface *surface, const struct spot *spot, int i);

/* Where shadow rays from the point p of a smooth mesh start: raised, on the side that `outwards`
 * shows to, onto the surface that the normals suggest, so that the flat faces do not shadow it
 * (Hanika, Hacking the shadow terminator, Ray Tracing Gems II, 2021, ch. 4). */
struct vec3 surface_lift(const struct scene *s, const struct surface *surface,
                         const struct hit *hit, struct vec3 p, struct vec3 outwards);

/* Unit vectors along which the texture coordinates u and v grow, across the normal. */
void surface_frame(const struct scene *s, const struct surface *surface, const struct hit *hit,
                   struct vec3 p, struct vec3 normal, struct vec3 *x, struct vec3 *y);

#endif
