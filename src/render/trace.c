#include "config.h"

#include "base/thread.h"
#include "render/tracer.h"

#include <string.h>

struct worker *worker_new(const struct tracer *tracer)
{
    struct worker *w = mem_alloc_aligned(1, sizeof *w);
    memset(w, 0, sizeof *w);
    w->tracer = tracer;
    w->until = INFINITY;
    w->light.direct = &w->arrived;
    fill(w->ones, 0, BATCH_ROOM, 1);
    return w;
}

void worker_free(struct worker *w)
{
    for (size_t i = 0; i < w->levels.n; i++)
        free(w->levels.at[i]);
    vec_free(&w->levels);
    free(w);
}

/* Seconds that work under way may still take. */
#define PATIENCE 1.0

bool worker_has_waited(struct worker *w)
{
    const struct render_options *o = w->tracer->options;
    if (w->given_up)
        return true;
    double now = thread_seconds(), asked = render_stopped(o) ? now : INFINITY;
    if (o->deadline > 0 && o->deadline < asked)
        asked = o->deadline;
    w->until = fmin(w->until, asked + PATIENCE);
    w->given_up = now > w->until;
    return w->given_up;
}

static struct level *level_new(void)
{
    struct level *level = mem_alloc_aligned(1, sizeof *level);
    memset(level, 0, sizeof *level);
    level->reflected.rays.spawned = level->refracted.rays.spawned = true;
    fill(level->reflected.rays.t_max, 0, BATCH_ROOM, RAY_UNBOUNDED);
    fill(level->refracted.rays.t_max, 0, BATCH_ROOM, RAY_UNBOUNDED);
    for (uint32_t i = 0; i < BATCH; i++) /* classic: so are all mirrored rays */
        level->reflected.paths[i] = (struct path){.crossed = SURFACE_NONE, .index = 1};
    return level;
}

struct level *level_at(struct worker *w, uint32_t depth)
{
    if (depth == w->levels.n)
        vec_push(&w->levels, level_new());
    struct level *level = w->levels.at[depth];
    level->reflected.rays.n = level->refracted.rays.n = 0;
    return level;
}

/* Traces the rays and adds their share to their parents' colours. */
static void trace_offspring(struct worker *w, struct level *level, uint32_t depth,
                            const struct offspring *o, struct vec3_batch *colours)
{
    if (o->rays.n == 0)
        return;
    trace_batch(w, depth + 1, &o->rays, o->paths, &level->colours);
    if (o->in_order) {
        w->tracer->kernels->add_shares(&o->weight, &level->colours, o->rays.n, colours);
        return;
    }
    for (uint32_t i = 0; i < o->rays.n; i++) {
        struct vec3 share = vec3_mul(vec3_get(&o->weight, i), vec3_get(&level->colours, i));
        vec3_put(colours, o->parent[i], vec3_add(vec3_get(colours, o->parent[i]), share));
    }
}

static void add_lights(struct worker *w)
{
    const struct shading *shading = w->tracer->shading;
    struct box box = shading->begin(w);
    for (size_t k = 0; k < w->tracer->scene->lights.n; k++)
        if (!w->tracer->lamps[k].dark)
            shading->add(w, k, box);
}

/* What the rays see before others come back, some of which hit nothing. */
static void put_colours(const struct worker *w, uint32_t n, struct vec3_batch *colours)
{
    vec3_fill(colours, 0, n, w->tracer->scene->background);
    for (uint32_t k = 0; k < w->points.n; k++)
        vec3_put(colours, w->points.ray[k], vec3_get(w->light.direct, k));
}

/* A ray's colour is its direct light, then its reflection, then its refraction: the order of the
 * sum, and so every bit of it, does not depend on what else is in the batch. */
void trace_batch(struct worker *w, uint32_t depth, const struct ray_batch *rays,
                 const struct path *paths, struct vec3_batch *colours)
{
    if (worker_gives_up(w)) {
        vec3_fill(colours, 0, rays->n, vec3_all(0));
        return;
    }
    struct level *level = level_at(w, depth);
    const struct tracer *t = w->tracer;
    find_points(w, rays, paths);
    w->light.direct = w->points.in_order ? colours : &w->arrived;
    if (w->points.n > 0)
        add_lights(w);
    if (!w->points.in_order)
        put_colours(w, rays->n, colours);
    w->light.direct = &w->arrived;
    if (depth < t->options->depth && w->points.any_bounces)
        t->shading->spawn(w, level, paths);
    if (t->most && depth < t->options->depth) {
        prune(w, depth + 1, &level->reflected, paths);
        prune(w, depth + 1, &level->refracted, paths);
    }
    w->stats.reflection += level->reflected.rays.n;
    w->stats.refraction += level->refracted.rays.n;
    trace_offspring(w, level, depth, &level->reflected, colours);
    trace_offspring(w, level, depth, &level->refracted, colours);
}
