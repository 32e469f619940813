/* One pixel, with all that its colour is made of. */
#ifndef WRT_RENDER_PIXEL_PROBE_H
#define WRT_RENDER_PIXEL_PROBE_H

#include "base/arena.h"
#include "render/render.h"

enum probe_way { PROBE_CAMERA, PROBE_REFLECTED, PROBE_REFRACTED };

/* A surface that stands between a point and some samples of a light. */
struct probe_blocker {
    struct probe_blocker *next;
    uint32_t surface, prim;
    uint64_t rays;
};

/* What one of the scene's lights does at a point. */
struct probe_light {
    uint64_t rays, lit; /* to its samples, counted as often as they occur, and those that arrive */
    struct probe_blocker *blockers; /* in the order they were met */
    struct vec3 diffuse, highlight; /* in the ray's colour; all of a glowing surface is diffuse */
};

/* A ray, and what it meets first. */
struct probe_ray {
    enum probe_way way;
    struct vec3 weight; /* of its colour in that of the ray it comes from */
    struct vec3 origin, direction;
    bool hit;
    double distance;
    struct vec3 point, normal; /* the normal that is shaded by */
    struct vec3 diffuse;       /* the material's, times the texture's */
    uint32_t surface, prim;
    struct vec3 without; /* lights: modern's ambient light, or what glows; or the background */
    struct probe_light *lights;              /* one for each of the scene */
    struct probe_ray *reflected, *refracted; /* or NULL */
    struct vec3
        colour; /* without + lights + reflected weight x colour + refracted weight x colour */
};

/* The tree of pixel x, y of the picture of one sample a pixel; all of it in the arena.  Its colour
 * is that of render_scene to the last bit. */
const struct probe_ray *probe_pixel(const struct scene *scene, const struct render_options *options,
                                    uint32_t x, uint32_t y, struct arena *arena);

#endif
