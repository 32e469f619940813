/* What the parts of the renderer share: one tracer a picture, read by all threads, and one worker
 * a thread.
 *
 * Rays are traced in batches of one depth, so that what they have in common is found out only once:
 * what they can hit at all, and what can stand between their hits and each light. */
#ifndef WRT_RENDER_TRACER_H
#define WRT_RENDER_TRACER_H

#include "accel/shaft.h"
#include "scene/camera.h"
#include "render/render.h"

enum { BATCH = BUNDLE_LIMIT };

/* A light made ready. */
struct lamp {
    const struct light *light;
    struct accel object; /* area lights: the light's own surface */
    struct box box;      /* of the sample points, or of the position */
    struct vec3 center;  /* of a ball that the rays through all counted samples meet */
    double radius;
    bool always_counts; /* some sample point counts seen from anywhere */
};

/* What is known of a material beforehand. */
struct finish {
    const struct material *material;
    bool bounces;     /* it reflects or refracts */
    bool dull;        /* no highlight, or 0 times a power that is a number */
    bool squared;     /* the exponent is whole and small: `power`, multiplied out */
    unsigned power;
};

struct tracer {
    const struct scene *scene;
    const struct render_options *options;
    struct accel accel;
    struct lens lens;
    struct lamp *lamps;      /* one a light of the scene */
    struct finish *finishes; /* one a material */
    bool *emissive;          /* by surface: it does not block light */
    bool any_emissive;
    bool skips; /* work whose outcome is known beforehand is left out */
};

/* Where a ray comes from. */
struct path {
    double index;       /* of refraction, carried by the ray */
    uint32_t crossed;   /* surface it was refracted at and meets first, or SURFACE_NONE */
    uint32_t parent;    /* place in its batch of the ray that gave rise to it */
    struct vec3 weight; /* of its colour in its parent's */
};

/* A hit and what shading needs of it. */
struct shade_point {
    struct vec3 incoming; /* unit, direction of travel */
    struct vec3 p, normal;
    struct vec3 diffuse; /* the material's, times its texel */
    double facing;       /* cosine between normal and incoming */
    uint32_t prim, surface;
    uint32_t ray; /* place in the batch */
    bool inside;  /* refracted into the surface it meets: the far side of what it crossed */
    const struct finish *finish;
};

/* Light that arrives at a shade point. */
struct shade_light {
    struct vec3 direct;    /* reflected towards the eye */
    struct vec3 intensity; /* where it bounces: sum over all lights, shadowed or not */
};

/* Rays of the next depth. */
struct offspring {
    VEC(struct ray) rays;
    VEC(struct path) paths;
};

/* What one depth needs while deeper ones are traced. */
struct level {
    struct offspring reflected, refracted;
    struct vec3 colours[BATCH]; /* of the deeper batch */
};

struct worker {
    const struct tracer *tracer;
    struct render_stats stats;
    VEC(struct level *) levels;       /* by depth, made when first needed */
    struct shade_point points[BATCH]; /* hits of the batch being shaded */
    struct shade_light light[BATCH];
};

void lamp_init(struct lamp *lamp, const struct light *light, bool brute_force);
void lamp_free(struct lamp *lamp);

/* shadow.c: the share of the lamp's light that reaches each of the first n of w->points, which lie
 * in the box. */
void lamp_shares(struct worker *w, const struct lamp *lamp, struct box box, uint32_t n,
                 double *shares);

/* shade.c */
struct finish finish_of(const struct material *m);
void shade_point_init(struct shade_point *s, const struct tracer *t, const struct ray *ray,
                      struct hit *hit);
/* Fills in w->light for the first n of w->points. */
void shade_points(struct worker *w, uint32_t n);

/* trace.c: the colours seen along n <= BATCH rays; paths is NULL for camera rays. */
void trace_batch(struct worker *w, uint32_t depth, const struct ray *rays, const struct path *paths,
                 uint32_t n, struct vec3 *colours);
void worker_init(struct worker *w, const struct tracer *tracer);
void worker_free(struct worker *w);

/* show.c: what the camera ray shows instead of its colour.  `range` holds the smallest and the
 * largest distance in the whole picture. */
struct vec3 show_colour(const struct tracer *t, const struct ray *ray, const double range[2],
                        bool bytes);

#endif
