/* What the parts of the renderer share: one tracer a picture, read by all threads, and one worker
 * a thread. */
#ifndef WRT_RENDER_TRACER_H
#define WRT_RENDER_TRACER_H

#include "accel/bvh.h"
#include "render/camera.h"
#include "render/render.h"

/* A light made ready. */
struct lamp {
    const struct light *light;
    struct accel object; /* area lights: the light's own surface */
    struct box box;      /* of the sample points */
    bool always_counts;  /* some point counts seen from anywhere */
};

struct tracer {
    const struct scene *scene;
    const struct render_options *options;
    struct accel accel;
    struct lens lens;
    struct lamp *lamps; /* one a light of the scene */
    bool emissive;      /* the scene holds a surface that does not block light */
};

/* A ray to be traced, and what its colour is multiplied with. */
struct path {
    struct ray ray;
    struct vec3 weight;
    double index;      /* of refraction, carried by the ray */
    uint32_t depth;
    uint32_t crossed;  /* surface it was refracted at and meets first, or SURFACE_NONE */
};

struct worker {
    const struct tracer *tracer;
    struct render_stats stats;
    VEC(struct path) paths; /* still to be traced */
};

/* A hit and what shading needs of it. */
struct shade_point {
    struct vec3 incoming; /* unit, direction of travel */
    struct vec3 p, normal;
    uint32_t prim;
    const struct surface *surface;
    const struct material *material;
    struct vec2 uv;
};

/* shadow.c: the share of the light that reaches the point. */
double lamp_share(struct worker *w, const struct lamp *lamp, const struct shade_point *s);
void lamp_init(struct lamp *lamp, const struct light *light, bool brute_force);
void lamp_free(struct lamp *lamp);

/* shade.c */
struct shade_point shade_point_of(const struct scene *scene, const struct ray *ray,
                                  struct hit *hit);
/* Light that arrives directly, summed over all lights; *intensity becomes the sum of their
 * intensities at the point. */
struct vec3 shade_direct(struct worker *w, const struct shade_point *s, struct vec3 *intensity);

/* trace.c: the colour seen along a camera ray. */
struct vec3 trace_colour(struct worker *w, const struct ray *ray);

/* show.c: what the camera ray shows instead of its colour.  `nearest` and `farthest` are the
 * distances in the whole picture. */
struct vec3 show_colour(const struct tracer *t, const struct ray *ray, const double range[2],
                        bool bytes);

#endif
