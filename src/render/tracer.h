/* What the parts of the renderer share: one tracer a picture, read by all threads, and one worker
 * a thread.
 *
 * Rays are traced in batches of one depth, so that what they have in common is found out only once:
 * what they can hit at all, and what can stand between their hits and each light. */
#ifndef WRT_RENDER_TRACER_H
#define WRT_RENDER_TRACER_H

#include "accel/shaft.h"
#include "render/render.h"
#include "scene/camera.h"

/* Points of an area light's grid, classic. */
struct lamp_points {
    uint32_t n;
    struct vec3_batch at;
    uint32_t count[BATCH];
    bool counts[BATCH]; /* seen from anywhere */
    bool all_count;
};

/* Places on an area light's surface, modern; see struct light_sample. */
struct sample_batch {
    uint32_t n;
    struct vec3_batch position, normal;
    alignas(64) double share[BATCH_ROOM];
};

static inline void sample_batch_put(struct sample_batch *b, uint32_t i,
                                    const struct light_sample *sample)
{
    vec3_put(&b->position, i, sample->position);
    vec3_put(&b->normal, i, sample->normal);
    b->share[i] = sample->share;
}

/* A light made ready. */
struct lamp {
    const struct light *light;
    struct box box; /* of the sample points, or of the position */
    /* Area lights.  The rays through all counted samples meet the ball, and the box: */
    struct vec3 center;
    double radius;
    struct vec3 half;           /* of the box, from its center */
    bool ball;                  /* the ball is the closer of the two */
    struct accel object;        /* the light's own surface */
    struct target_list targets; /* all of it */
    struct lamp_points *points;
    size_t point_batches;
    struct sample_batch *places;  /* modern: BATCH of them, and so on */
    bool dark;                    /* it gives no light; modern */
    uint64_t samples, duplicates; /* points of the grid, and how many of them are there before */
    bool always_counts;           /* some sample point counts seen from anywhere */
};

/* What is known of a material beforehand. */
struct finish {
    const struct material *material;
    struct vec3 specular; /* of direct light; 0 where it has no highlight */
    unsigned power;       /* of the highlight, where the exponent is whole and small */
    bool squared;         /* `power` counts: it is multiplied out */
    bool uneven;          /* neither that nor a plain diffuse term */
    bool bounces;         /* it reflects or refracts */
    bool glows;           /* emissive */
};

struct worker;
struct level;
struct path;

/* A model's arithmetic. */
struct shading {
    /* Sets w->light for w->points, of which there are some, to what is there without lights;
     * returns the box that shadow rays start in. */
    struct box (*begin)(struct worker *w);
    /* Adds light k of the scene to w->light.direct, and what the model's spawn() needs. */
    void (*add)(struct worker *w, size_t k, struct box box);
    /* Notes the rays that the points give rise to. */
    void (*spawn)(struct worker *w, struct level *level, const struct path *paths);
};

extern const struct shading shading_classic, shading_modern;

struct tracer {
    const struct scene *scene;
    const struct render_options *options;
    struct accel accel;
    const struct bundle_kernels *bundles;
    const struct render_kernels *kernels;
    const struct shading *shading;
    bool modern;
    struct lens lens;
    struct lamp *lamps;      /* one a light of the scene */
    struct finish *finishes; /* one a material */
    bool *emissive;          /* by surface: it does not block light */
    bool any_emissive;
    bool any_refractive;
    struct vec3 *most; /* that can come back along a ray, by how much deeper others go; or NULL */
    uint32_t twins, unseen, dark; /* primitives, surfaces and lights that are left out for that */
    uint32_t skips;       /* bit k: skip k is on; 0: nothing clever is done at all */
};

static inline bool tracer_skips(const struct tracer *t, enum skip skip)
{
    return t->skips >> skip & 1;
}

/* The surfaces that a ray is inside of, the one entered last at the end; modern.  What is nested
 * deeper than the limit does not refract. */
enum { MEDIA_LIMIT = 8 };

struct media {
    uint32_t n;
    uint32_t surface[MEDIA_LIMIT];
};

/* Where a ray comes from. */
struct path {
    struct vec3 total; /* weight of its colour in its pixel's, where tracer.most is there */
    union {
        struct {              /* classic */
            uint32_t crossed; /* surface it was refracted at and meets first, or SURFACE_NONE */
            double index;     /* of refraction, carried by the ray */
        };
        struct media media; /* modern */
    };
};

/* Hits and what shading needs of them. */
struct shade_batch {
    uint32_t n;
    const struct vec3_batch *incoming; /* unit, direction of travel: the rays' own or picked */
    struct vec3_batch p, normal;
    /* Modern: some surface is smooth or has a normal map.  Where not, the next are normal and p. */
    bool curved;
    struct vec3_batch geometric; /* the primitive's normal */
    struct vec3_batch smooth;    /* interpolated, before a normal map bends it */
    struct vec3_batch lifted;    /* where shadow rays start */
    struct vec3_batch diffuse;   /* the material's, times its texel */
    struct vec3_batch specular;
    alignas(64) double facing[BATCH_ROOM]; /* cosine between normal and incoming */
    alignas(64) int64_t power[BATCH_ROOM]; /* of the highlight, where it is multiplied out */
    alignas(64) double b1[BATCH_ROOM], b2[BATCH_ROOM]; /* see struct hit; where shapes.weighted */
    uint32_t prim[BATCH_ROOM], surface[BATCH_ROOM];
    uint32_t ray[BATCH]; /* place in the batch of rays */
    uint32_t noted;      /* so many are still noted to be the rays' own, on prim[0] */
    bool in_order;       /* point k is ray k's, for all rays */
    bool one_surface;    /* all lie on one */
    bool plain;          /* and none has a texture: all colours are the first's */
    const double *t;     /* distance along it: the hits' own or picked */
    bool inside[BATCH];  /* refracted into the surface it meets: the far side of what it crossed */
    const struct finish *finish[BATCH];
    /* What `finish`, `power`, `diffuse` and `specular` of so many points are still filled with. */
    const struct finish *filled_with;
    uint32_t filled;
    bool painted; /* but for `diffuse`, which textures have changed */
    bool any_uneven;  /* some highlight is not multiplied out, some metal is textured */
    bool any_glowing; /* some is emissive */
    bool any_bounces;
};

static inline const struct vec3_batch *geometric_normals(const struct shade_batch *b)
{
    return b->curved ? &b->geometric : &b->normal;
}

static inline const struct vec3_batch *smooth_normals(const struct shade_batch *b)
{
    return b->curved ? &b->smooth : &b->normal;
}

static inline const struct vec3_batch *shadow_origins(const struct shade_batch *b)
{
    return b->curved ? &b->lifted : &b->p;
}

/* One of them. */
struct shade_point {
    struct vec3 incoming, p, normal, diffuse;
    double facing;
    uint32_t prim, surface;
    const struct finish *finish;
};

static inline struct shade_point shade_point_get(const struct shade_batch *b, uint32_t i)
{
    return (struct shade_point){vec3_get(b->incoming, i),
                                vec3_get(&b->p, i),
                                vec3_get(&b->normal, i),
                                vec3_get(&b->diffuse, i),
                                b->facing[i],
                                b->prim[i],
                                b->surface[i],
                                b->finish[i]};
}

/* Light that arrives at shade points. */
struct light_batch {
    struct vec3_batch *direct;   /* reflected towards the eye */
    struct vec3_batch intensity; /* where it bounces: sum over all lights, shadowed or not */
};

/* Neighbouring points that take their colour or normal from one texture. */
struct texture_run {
    uint32_t first, end;
    uint32_t texture;
};

/* All that do, in order. */
struct textured {
    uint32_t runs;
    struct texture_run run[BATCH];
    double u[BATCH_ROOM], v[BATCH_ROOM]; /* by point */
};

/* What points lie on, by kind: from first[kind] to first[kind + 1]. */
struct hit_shapes {
    uint32_t first[PRIM_KINDS + 1];
    alignas(64) uint32_t index[BATCH_ROOM]; /* of the shape, in the array of its kind */
    const double *part;                     /* of it: the hits' own or picked */
    const struct vec3_batch *origin;        /* of the ray: likewise */
    bool weighted; /* some surface has something to interpolate between corners */
    bool bent;     /* the normals of some are not the primitives': smooth, flipped */
};

/* What some of a batch's rays and hits, in another order, say of the points. */
struct picked {
    struct vec3_batch origin, incoming;
    alignas(64) double t[BATCH_ROOM], part[BATCH_ROOM];
};

/* What camera rays through a part of the picture can meet. */
struct lookout {
    bool known;
    uint32_t x, y; /* which part */
    struct target_list list;
};

/* What some points see of a lamp, and what can stand in its way. */
struct sight {
    struct target_list list;          /* of any of them */
    uint64_t near[TARGET_LIST_LIMIT]; /* by target; bit k: it may be in the way of point k */
    uint64_t hidden;                  /* bit k: one target hides all of the lamp from point k */
};

/* Bytes of packed pixels, and what a vector reaches behind them. */
enum { PACKED_ROOM = 4 * BATCH_ROOM };

/* What an instruction set has its own code for. */
struct render_kernels {
    /* The directions of camera rays through picture coordinates x and y, from -1 to 1; no parallel
     * ones. */
    void (*aim)(const struct lens *lens, const double *x, const double *y, uint32_t n,
                struct vec3_batch *directions);
    /* The same of all columns x of all rows y, row by row; elements up to the next whole vector may
     * be filled, too. */
    void (*aim_grid)(const struct lens *lens, const double *x, uint32_t width, const double *y,
                     uint32_t height, struct vec3_batch *directions);
    /* As vec3_fill, but elements up to the next whole vector may be filled, too. */
    void (*fill)(struct vec3_batch *to, uint32_t first, uint32_t end, struct vec3 value);
    /* Fills in p and normal of the points; b1 and b2, where shapes->weighted; geometric and lifted,
     * where they are curved. */
    void (*hit_points)(const struct scene *scene, const struct hit_shapes *shapes,
                       struct shade_batch *points);
    /* See sphere_uv in scene.h: of points first to end, and up to the next whole vector; u[0] and
     * v[0] are the first's. */
    void (*sphere_uv)(const struct sphere *sphere, const struct vec3_batch *points, uint32_t first,
                      uint32_t end, double *u, double *v);
    /* The texture at places first to end, and anything up to the next whole vector. */
    void (*texels)(const struct texture *texture, const double *u, const double *v, uint32_t first,
                   uint32_t end, struct vec3_batch *texels);
    /* Bends the normals by the texels of normal maps, as the original does: in world coordinates.
     * Points without a normal map have bent[i] = 0. */
    void (*bend)(const struct vec3_batch *texels, const double *bent, struct shade_batch *points);
    /* Fills in the cosines between normals and incoming rays. */
    void (*face)(struct shade_batch *points);
    /* The rays from n points, which lie on `prims`, to a light that has one for each point. */
    void (*aim_at)(const struct light *light, const struct vec3_batch *from, const uint32_t *prims,
                   double t_max, uint32_t n, struct ray_batch *rays);
    /* Adds what the light gives, of which `shares` arrive. */
    void (*add_light)(const struct shade_batch *points, const struct light *light,
                      const double *shares, struct light_batch *sums);
    /* The same of a point light or sun in modern. */
    void (*add_modern)(const struct shade_batch *points, const struct light *light,
                       const double *shares, struct light_batch *sums);
    /* Bit k: point k may get light from the lamp.  It gets none where bit k is 0; modern. */
    uint64_t (*front)(const struct shade_batch *points, const struct lamp *lamp);
    /* What samples of an area light give point k if nothing is in the way; modern. */
    void (*give)(const struct shade_batch *points, uint32_t k, const struct light *light,
                 const struct sample_batch *samples, struct vec3_batch *gives);
    /* Rays mirrored at the points; their t_max is not touched. */
    void (*reflect)(const struct shade_batch *points, struct ray_batch *rays);
    /* What light of these intensities weighs of which so much is mirrored.  Bit k: k's is not 0. */
    uint64_t (*weigh)(const struct vec3_batch *intensity, struct vec3 mirrored, uint32_t n,
                      struct vec3_batch *weight);
    struct box (*bounds)(const struct vec3_batch *points, uint32_t n);
    /* Adds the products of weights and colours. */
    void (*add_shares)(const struct vec3_batch *weights, const struct vec3_batch *colours,
                       uint32_t n, struct vec3_batch *sums);
    /* Colours as pixels of a picture of bytes, see picture_set_row. */
    void (*pack)(const struct picture *out, const struct vec3_batch *colours, uint32_t n,
                 uint8_t pixels[PACKED_ROOM]);
    /* Fills in what the points from `first` to `end`, which lie on `prims`, see of an area light,
     * behind the targets of sight->list.  Bit k of `opaque`: target k hides what is behind it. */
    void (*see)(const struct geometry *g, const struct lamp *lamp, uint32_t opaque,
                const struct vec3_batch *from, const uint32_t *prims, uint32_t first, uint32_t end,
                struct sight *sight);
};

extern const struct render_kernels render_plain, render_generic, render_avx2, render_avx512;

/* Rays of the next depth. */
struct offspring {
    struct ray_batch rays;
    struct vec3_batch weight; /* of their colours in their parents' */
    uint32_t parent[BATCH];   /* place in its batch of the ray that gave rise to it */
    bool in_order;            /* ray k's is ray k */
    struct path paths[BATCH];
};

/* What one depth needs while deeper ones are traced. */
struct level {
    struct offspring reflected, refracted;
    struct vec3_batch colours; /* of the deeper batch */
};

struct worker {
    const struct tracer *tracer;
    struct render_stats stats;
    VEC(struct level *) levels; /* by depth, made when first needed */
    struct ray_batch camera_rays;
    struct lookout lookout; /* of the camera rays */
    struct vec3_batch colours;
    struct vec3_batch sums; /* of all samples of a tile's pixels */
    /* Of the batch being shaded: */
    struct hit_batch hits;
    struct hit_shapes shapes;
    struct picked picked;
    struct shade_batch points;
    struct textured bumps, paints; /* by normal maps, by textures */
    struct light_batch light;
    struct vec3_batch arrived; /* what light.direct is but where it is the colours themselves */
    struct ray_batch shadow_rays;
    struct sample_batch jittered; /* samples of an area light for one point */
    alignas(64) double ones[BATCH_ROOM];
    double until;  /* thread_seconds() when it gives up; infinite while nobody waits */
    bool given_up; /* what it has traced since is nothing */
};

/* lamp.c */
void lamp_init(struct lamp *lamp, const struct light *light, bool brute_force, bool skips);
void lamp_free(struct lamp *lamp);

/* The shaft of all shadow rays from the box to the lamp; false when there is none to speak of: the
 * points are close by, or among the samples. */
bool shaft_to_lamp(const struct accel *a, const struct lamp *lamp, struct box from,
                   struct shaft *shaft);
/* What can stand between the box and the lamp. */
void list_shadowers(const struct tracer *t, const struct lamp *lamp, struct box from,
                    struct target_list *list);
/* What the points from `first` on see of an area light: as many as have a short list in common, or
 * one.  Points are `from` there, on `prims`; `box` holds all n of them.  Returns the end of those
 * that *sight tells of. */
uint32_t see_lamp(const struct tracer *t, const struct lamp *lamp, const struct vec3_batch *from,
                  const uint32_t *prims, struct box box, uint32_t first, uint32_t n,
                  struct sight *sight);
/* Point k of them; LAMP_PARTLY: `own` lists what can be in its way. */
enum lamp_view { LAMP_HIDDEN, LAMP_PARTLY, LAMP_OPEN };
enum lamp_view lamp_view(const struct tracer *t, const struct sight *sight, uint32_t k,
                         struct target_list *own);

/* shadow.c: the share of the lamp's light that reaches each of w->points, which lie in the box.
 * Classic, but for point lights and suns, which have it in both. */
const double *lamp_shares(struct worker *w, const struct lamp *lamp, struct box box,
                          double room[BATCH_ROOM]);
/* Bit k: point k may get light from the lamp if nothing is in the way; there are some. */
uint64_t lit_points(struct worker *w, const struct lamp *lamp);
/* How far a shadow ray to the light goes, in its own length. */
double shadow_reach(const struct tracer *t, const struct light *light);
/* Traces w->shadow_rays; bit i: ray i meets what blocks light. */
uint64_t find_blocked(struct worker *w, const struct target_list *list);
/* The primitive that blocks a shadow ray's light, or PRIM_NONE. */
uint32_t find_blocker(const struct tracer *t, const struct ray *ray);
/* Fill w->shadow_rays with rays to a light: from n of w->points, all or `which`, to one that has a
 * single ray a point; from a point to the counted ones of a batch of lamp->points, *counts telling
 * how often each is there, in `room` if need be; modern: from point k to samples of an area light
 * from `first` on, a multiple of BATCH, that give some light, and how much.  Returns the first not
 * tried.
 */
void aim_at_light(struct worker *w, const struct light *light, const uint32_t *which, uint32_t n);
void aim_at_points(struct worker *w, const struct lamp *lamp, size_t batch, struct vec3 p,
                   uint32_t prim, uint32_t room[BATCH], const uint32_t **counts);
uint32_t aim_at_samples(struct worker *w, const struct lamp *lamp, uint32_t k, uint32_t first,
                        struct vec3 gives[BATCH]);

/* kernels_plain.c: what the kernel hit_points fills in of point k. */
void place_point(const struct scene *scene, const struct hit_shapes *shapes, uint32_t k,
                 struct shade_batch *points);

/* modern.c: the reference of these kernels. */
void modern_add_light(const struct shade_batch *points, const struct light *light,
                      const double *shares, struct light_batch *sums);
void modern_give(const struct shade_batch *points, uint32_t k, const struct light *light,
                 const struct sample_batch *samples, struct vec3_batch *gives);

/* points.c: fills in w->points with the hits of the rays; paths is NULL for camera rays. */
void find_points(struct worker *w, const struct ray_batch *rays, const struct path *paths);

/* shade.c */
struct finish finish_of(const struct material *m);
/* Diffuse reflection of light from a direction of this cosine. */
struct vec3 finish_diffuse(const struct finish *f, struct vec3 diffuse, double cosine);
/* How bright the highlight is: the cosine to the power of the exponent. */
double finish_highlight(const struct finish *f, double cosine);
const struct render_kernels *render_kernels_of(enum isa isa);

/* Adds a ray that starts at point k; the caller fills in its path. */
static inline struct path *spawn_ray(struct offspring *o, const struct shade_batch *points,
                                     uint32_t k, struct vec3 direction, struct vec3 weight)
{
    uint32_t i = o->rays.n++;
    vec3_put(&o->weight, i, weight);
    o->parent[i] = points->ray[k];
    o->in_order = o->rays.common_from = false;
    vec3_put(&o->rays.origin, i, vec3_get(&points->p, k));
    vec3_put(&o->rays.direction, i, direction);
    o->rays.from[i] = points->prim[k];
    return &o->paths[i];
}

/* trace.c: whether what is under way is to be given up: it went on too long after somebody wanted
 * an end, or after the deadline.  One ray can give rise to 2^depth others, each with shadow rays to
 * all lights. */
bool worker_has_waited(struct worker *w);
static inline bool worker_gives_up(struct worker *w)
{
    const struct render_options *o = w->tracer->options;
    return (render_stopped(o) || o->deadline > 0) && worker_has_waited(w);
}

/* trace.c: the level of this depth, emptied; levels are made one after another. */
struct level *level_at(struct worker *w, uint32_t depth);
/* The colours seen along the rays; paths is NULL for camera rays. */
void trace_batch(struct worker *w, uint32_t depth, const struct ray_batch *rays,
                 const struct path *paths, struct vec3_batch *colours);
struct worker *worker_new(const struct tracer *tracer);
void worker_free(struct worker *w);

/* spare.c: notes primitives that lie exactly where an earlier one does, and returns how many. */
uint32_t find_twins(const struct tracer *t, bool *twins);

/* unmet.c: notes the primitives of surfaces that no ray can meet, and returns how many surfaces. */
uint32_t find_unseen(const struct tracer *t, bool *unseen);

/* prune.c: tracer.most. */
struct vec3 *most_radiance(const struct tracer *t);
/* Leaves out those of the rays, which are `depth` deep, that hardly matter; paths: of their
 * parents.
 */
void prune(struct worker *w, uint32_t depth, struct offspring *o, const struct path *paths);

/* render.c */
void tracer_init(struct tracer *t, const struct scene *scene, const struct render_options *options);
void tracer_free(struct tracer *t);

/* show.c: what is shown along the rays instead of their colours.  `range` holds the smallest and
 * the largest distance in the whole picture. */
void show_batch(struct worker *w, const struct ray_batch *rays, const double range[2], bool bytes,
                struct vec3_batch *colours);

#endif
