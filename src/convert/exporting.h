/* What the writers share (internal to src/convert). */
#ifndef WRT_CONVERT_EXPORTING_H
#define WRT_CONVERT_EXPORTING_H

#include "base/arena.h"
#include "base/map.h"
#include "convert/export.h"

/* What a format cannot say, in the words of its note. */
#define LOSSES(X)                                                                               \
    X(NORMAL_MAP, "normal maps are left out")                                                   \
    X(TEXTURE, "textures are left out: surfaces have their mean colour")                        \
    X(CYLINDER_UV, "the scale of textures around cylinders is left out")                        \
    X(HIGHLIGHT, "coloured highlights become white ones of the same mean")                      \
    X(REFLECTION, "coloured reflection becomes uncoloured of the same mean")                    \
    X(REFRACTION, "coloured refraction becomes uncoloured of the same mean")                    \
    X(BENDING, "glass is seen through without bending the light")                               \
    X(AREA_GRID, "area lights become flat grids of points")                                     \
    X(AREA_POINT, "area lights become points: their shadows are hard")                          \
    X(SIDEWAYS, "flat lights shine sideways as brightly as ahead")                              \
    X(EMISSIVE_SHADOW, "emissive surfaces cast shadows")                                        \
    X(UNEVEN, "unevenly scaled spheres and cylinders become triangles")                         \
    X(FALLOFF,                                                                                  \
      "reflection and refraction take the strength of falling off lights from the middle "      \
      "of the scene")                                                                           \
    X(SHINE, "highlights take the strength of falling off lights from the middle of the scene") \
    X(AMBIENT, "coloured ambient light becomes uncoloured of the same mean")                    \
    X(ENCODING, "the picture is not encoded as sRGB: its numbers are the light")

enum loss {
#define LOSS(id, words) LOSS_##id,
    LOSSES(LOSS)
#undef LOSS
        LOSS_COUNT
};

/* Texts of materials, each kept once and numbered from 0. */
struct export_names {
    struct arena arena;
    struct map map;
    uint32_t n;
};

struct exporting {
    const struct scene *scene;
    const char *path; /* where the file will be */
    struct buffer *out;
    struct diag *diag;
    struct vec3 light;  /* all lights' together, in the middle of the scene */
    struct vec3 bounce; /* what reflection and refraction are scaled by: in classic that light */
    bool falls_off;     /* a light weakens with distance: elsewhere `light` is another */
    struct export_names materials;
    uint32_t *name_of; /* the number of each of the scene's materials */
    struct {
        size_t times;
        struct span first;
    } losses[LOSS_COUNT];
};

void export_begin(struct exporting *e, const struct scene *scene, const char *path,
                  struct buffer *out, struct diag *diag);
/* Reports what was left out, and frees what the struct owns. */
void export_end(struct exporting *e);
void export_lose(struct exporting *e, enum loss loss, struct span span);

/* What a camera sees: eye + ahead + x across + y upwards, x and y from -1 to 1; parallel rays start
 * all over the picture, and go ahead.  Classic's mirrored directions are in it. */
struct export_view {
    struct vec3 eye, ahead, across, upwards;
    bool parallel;
};
struct export_view export_view(const struct scene *scene);

/* How often a ray may be reflected, with room. */
int export_ray_depth(const struct scene *scene);

/* The middle of all geometry, and how far from it there may be some. */
struct vec3 export_middle(const struct scene *scene, double *reach);

/* How much of a light comes to that middle. */
double export_strength(const struct scene *scene, const struct light *l);

/* An area light as a parallelogram: its middle and its sides. */
struct export_area {
    struct vec3 middle, sides[2];
};
struct export_area export_area(const struct light *l);

/* The numbers of a vector with `between` between them. */
void export_vec3(struct buffer *out, struct vec3 v, const char *between);

double vec3_mean(struct vec3 v);
bool vec3_is_even(struct vec3 v);
/* True when the colour is the base times a number. */
bool export_is_tint(struct vec3 colour, struct vec3 base);

/* A run of a surface's triangles and the vertices they use. */
struct facets {
    const struct triangle *at;
    size_t n, solid; /* all, and those that have an area: the others are never hit */
    const struct vec3 *points;
    uint32_t point_count;
    uint32_t first_vertex; /* the number of points[0] in the geometry */
    uint32_t normal_count; /* 0: flat */
};
struct facets export_facets(const struct scene *scene, const struct surface *s);
/* The numbers of a face's points, and of its normals. */
struct triangle_corners export_corners(const struct facets *f, size_t face);
struct triangle_corners export_normal_corners(const struct facets *f, const struct surface *s,
                                              size_t face);

/* The cylinders or the sphere of a surface, in a space of their own where there is a place. */
const struct cylinder *export_cylinder(const struct scene *scene, uint32_t prim);
const struct sphere *export_sphere(const struct scene *scene, uint32_t prim);

/* The map from that space to the world, or NULL. */
const struct affine *export_place(const struct scene *scene, uint32_t prim);

/* Every material as `write` writes it to e->out, equal ones once: `before`, its number, `between`
 * and the text on a line each. */
void export_materials(struct exporting *e, const char *before, const char *between,
                      void (*write)(struct exporting *e, const struct material *m));

#endif
