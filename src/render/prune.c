/* Rays that are left out because too little can come back along them; only where it is asked for.
 */
#include "config.h"

#include "render/tracer.h"

/* Half a step of a byte: what all channels must stay below. */
#define PRUNE_BELOW (1.0 / 512)

/* What arrives from a light at most.  There is no limit to what comes from nearby, nor a simple one
 * for the samples of surfaces that are stretched. */
static struct vec3 most_of_light(const struct light *l)
{
    double shares = l->kind == LIGHT_AREA && l->samples.n > 0 ? 0 : 1;
    if (l->inverse_square || l->object.instances.n > 0)
        return vec3_all(INFINITY);
    for (size_t i = 0; i < l->samples.n; i++)
        shares += l->samples.at[i].share;
    return vec3_scale(l->intensity, shares);
}

static struct vec3 sum_of_lights(const struct scene *scene)
{
    struct vec3 sum = vec3_all(0);
    for (size_t i = 0; i < scene->lights.n; i++)
        sum = vec3_add(sum, most_of_light(&scene->lights.at[i]));
    return sum;
}

/* What a material makes of light at most: no cosine and no texel is above 1. */
static struct vec3 most_reflected(const struct tracer *t, const struct material *m,
                                  struct vec3 lights)
{
    if (m->kind == MATERIAL_EMISSIVE)
        return t->modern ? m->diffuse : vec3_mul(m->diffuse, lights);
    struct vec3 specular = m->kind == MATERIAL_LAMBERT ? vec3_all(0) : m->specular;
    struct vec3 most = vec3_mul(vec3_add(m->diffuse, specular), lights);
    return t->modern ? vec3_add(most, vec3_mul(m->diffuse, t->scene->ambient)) : most;
}

struct vec3 *most_radiance(const struct tracer *t)
{
    const struct scene *scene = t->scene;
    uint32_t depths = t->options->depth + 1;
    struct vec3 lights = sum_of_lights(scene), direct = scene->background, bounced = vec3_all(0);
    struct vec3 *most = mem_alloc(depths, sizeof *most);
    for (size_t i = 0; i < scene->materials.n; i++) {
        const struct material *m = &scene->materials.at[i];
        direct = vec3_max(direct, most_reflected(t, m, lights));
        bounced = vec3_max(bounced, vec3_add(m->reflection, m->refraction));
    }
    if (!t->modern)
        bounced = vec3_mul(bounced, lights);
    most[0] = direct;
    for (uint32_t i = 1; i < depths; i++)
        most[i] = vec3_add(direct, vec3_mul(bounced, most[i - 1]));
    return most;
}

static void move_ray(struct offspring *o, uint32_t to, uint32_t from)
{
    vec3_put(&o->rays.origin, to, vec3_get(&o->rays.origin, from));
    vec3_put(&o->rays.direction, to, vec3_get(&o->rays.direction, from));
    o->rays.t_max[to] = o->rays.t_max[from];
    o->rays.from[to] = o->rays.from[from];
    vec3_put(&o->weight, to, vec3_get(&o->weight, from));
    o->parent[to] = o->parent[from];
    o->paths[to] = o->paths[from];
    o->in_order = false;
}

void prune(struct worker *w, uint32_t depth, struct offspring *o, const struct path *paths)
{
    struct vec3 most = w->tracer->most[w->tracer->options->depth - depth];
    uint32_t n = 0;
    for (uint32_t i = 0; i < o->rays.n; i++) {
        struct path *path = &o->paths[i];
        path->total = vec3_get(&o->weight, i);
        if (paths)
            path->total = vec3_mul(path->total, paths[o->parent[i]].total);
        if (vec3_largest(vec3_mul(path->total, most)) < PRUNE_BELOW)
            continue;
        if (n < i)
            move_ray(o, n, i);
        n++;
    }
    w->stats.pruned += o->rays.n - n;
    o->rays.n = n;
}
