/* What `wrt info` tells: gathered here, said as text or JSON (internal to src/cmd). */
#ifndef WRT_CMD_INFO_H
#define WRT_CMD_INFO_H

#include "cmd/needed.h"
#include "lower/lower.h"
#include "render/pixel_probe.h"

#include <jansson.h>

struct info {
    const struct options *options;
    struct frontend frontend;
    struct lowered lowered;
};

/* ---- cmd_info.c ---- */

/* Of longer lists only the beginning is told, unless --verbose is given. */
enum { INFO_LISTED = 100 };

#define INFO_COUNT_LIST(X)    \
    X(SURFACES, "surfaces")   \
    X(INSTANCES, "instances") \
    X(SPHERES, "spheres")     \
    X(CYLINDERS, "cylinders") \
    X(TRIANGLES, "triangles") \
    X(VERTICES, "vertices") X(LIGHTS, "lights") X(MATERIALS, "materials") X(TEXTURES, "textures")

#define INFO_PART_LIST(X)         \
    X(TEXT, "text")               \
    X(TREE, "tree")               \
    X(DESCRIPTION, "description") \
    X(MESHES, "meshes") X(GEOMETRY, "geometry") X(PICTURES, "pictures") X(PEAK, "peak")

#define INFO_ID(id, word) INFO_##id,
enum { INFO_COUNT_LIST(INFO_ID) INFO_COUNTS };
enum { INFO_PART_LIST(INFO_ID) INFO_PARTS };
#undef INFO_ID

extern const char *const info_count_words[INFO_COUNTS], *const info_part_words[INFO_PARTS];
extern const char *const info_frame_words[]; /* by enum diag_frame_kind */

struct info_facts {
    size_t counts[INFO_COUNTS], bytes[INFO_PARTS];
    struct box bounds;
    bool empty; /* nothing to have bounds */
};
struct info_facts info_facts(const struct info *i);

/* Text on the standard output: "  (scene.wrt:3:1)", "(1, 2, 3)", "sphere ball", "for i". */
void info_print_place(const struct info *i, struct span span);
void info_print_vec3(struct vec3 v);
void info_print_object(const struct desc_object *o);
void info_print_frame(const struct info *i, const struct diag_frame *f);

/* ---- info_tree.c: the surfaces, in the loops, templates and files that make them ---- */

/* A surface, or what made some.  What the same words make is one node, counted. */
struct info_node {
    struct info_node *next, *children, *last;
    struct span span;
    const struct desc_object *object; /* the first such surface; NULL: see frame */
    const struct diag_frame *frame;
    size_t count; /* surfaces */
};

/* The root, which stands for the scene, in the arena. */
struct info_node *info_tree(const struct desc *d, struct arena *a);

/* ---- info_pixel.c ---- */

/* A pixel of the picture of one sample a pixel. */
struct info_pixel {
    struct arena arena;
    uint32_t x, y;
    const struct probe_ray *ray;
    uint8_t bytes[3]; /* in a picture of bytes */
};

/* In a picture of this size.  The arena is the caller's to free. */
void info_pixel(const struct info *i, uint32_t width, uint32_t height, struct info_pixel *p);
void info_print_pixel(const struct info *i, const struct info_pixel *p);

/* The description of a surface, and of light k, of the scene. */
const struct desc_object *info_surface(const struct info *i, uint32_t surface);
const struct desc_object *info_light(const struct info *i, size_t k);

/* ---- info_json.c ---- */

json_t *info_json(const struct info *i);
json_t *info_files_json(const struct info *i);
json_t *info_pixel_json(const struct info *i, const struct info_pixel *p);

#endif
