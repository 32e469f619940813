/* Runs of primitives cut in two by the binned surface area heuristic (Wald, On fast construction of
 * SAH-based bounding volume hierarchies, 2007), all three axes at once: what trees are built with.
 *
 * Boxes are of floats, in a frame whose origin is amid the primitives and in which no coordinate is
 * larger than 1, rounded outwards. */
#ifndef WRT_ACCEL_SAH_H
#define WRT_ACCEL_SAH_H

#include "math/floats.h"
#include "scene/intersect.h"

#include <stdbool.h>

/* Coordinates of a tree: (p - center) scale. */
struct tree_frame {
    double center[3];
    double scale; /* a power of two */
};

/* A primitive: its box, of which only the first three of each four count. */
union sah_corner {
    vfour planes;
    struct {
        float axis[3];
        uint32_t tag; /* of lo: the primitive; of hi: 1 when it is no triangle */
    };
};

struct sah_ref {
    union sah_corner lo, hi;
};

/* Added to tags, so that they are no denormal floats, which are slow to add. */
enum { SAH_TAG = 1 << 30 };

static inline struct vec3 tree_frame_point(const struct tree_frame *f, struct vec3 p)
{
    return vec3((p.x - f->center[0]) * f->scale, (p.y - f->center[1]) * f->scale,
                (p.z - f->center[2]) * f->scale);
}

static inline bool sah_is_triangle(const struct sah_ref *r)
{
    return r->hi.tag == SAH_TAG;
}

static inline uint32_t sah_prim(const struct sah_ref *r)
{
    return r->lo.tag - SAH_TAG;
}

struct sah_box {
    vfour lo, hi;
};

/* Primitives begin to end of the order, around which there is a box; so there is around their
 * centers, doubled. */
struct sah_run {
    uint32_t begin, end;
    int depth;
    struct sah_box box, centers;
};

struct sah {
    struct sah_ref *refs; /* in the order of the runs */
    uint32_t n;           /* some primitives may be there several times, in pieces */
    struct tree_frame frame;
    struct box bounds; /* of all of them */
    uint32_t leaf;     /* so many triangles stay together */
    bool blocks;       /* and cost as much as one */
};

/* The n targets, in leaves of up to `leaf` triangles or a few of anything. */
struct sah_run sah_init(struct sah *s, const struct geometry *g, const struct target *targets,
                        uint32_t n, uint32_t leaf, unsigned threads);
void sah_free(struct sah *s);

/* Bounds a primitive by a box in the frame. */
void sah_set_box(struct sah_ref *r, struct box box);
/* Makes the run's boxes large enough for a primitive. */
void sah_take(struct sah_run *run, const struct sah_ref *r);

/* False when the run had better be a leaf. */
bool sah_split(struct sah *s, const struct sah_run *run, struct sah_run halves[2]);

bool sah_all_triangles(const struct sah *s, const struct sah_run *run);

/* Half the surface area. */
static inline float sah_area(const struct sah_box *b)
{
    vfour d = b->hi - b->lo;
    return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

#endif
