#include "config.h"

#include "render/tracer.h"

static struct vec3 fetch(const struct scene *scene, uint32_t texture, struct vec2 uv)
{
    return texture_fetch(&scene->textures.at[texture], uv.x, uv.y);
}

static struct vec2 map_uv(const struct uv_map *m, struct vec2 uv)
{
    return (struct vec2){ uv.x * m->scale.x + m->offset.x, uv.y * m->scale.y + m->offset.y };
}

/* original.md, section 5, bTexture. */
static struct vec3 bumped(struct vec3 normal, struct vec3 texel)
{
    struct vec3 b = vec3_normalize(vec3(2 * (texel.x - 0.5), -2 * (texel.y - 0.5), 1));
    return vec3_normalize(vec3(normal.x + b.x, normal.y - b.y, normal.z));
}

struct shade_point shade_point_of(const struct scene *scene, const struct ray *ray,
                                  struct hit *hit)
{
    const struct geometry *g = &scene->geometry;
    const struct surface *surface = &scene->surfaces.at[g->prims.at[hit->prim].surface];
    struct shade_point s = { .incoming = ray->direction,
                             .prim = hit->prim,
                             .surface = surface,
                             .material = &scene->materials.at[surface->material] };
    struct vec3 geometric;
    s.p = geometry_hit_point(g, ray, hit, &geometric);
    s.normal = surface_normal(scene, surface, hit, geometric);
    if (surface->needs_uv)
        s.uv = surface_uv(scene, surface, hit, s.p);
    if (surface->normal_map != TEXTURE_NONE) {
        s.uv = map_uv(&surface->uv, s.uv);
        s.normal = bumped(s.normal, fetch(scene, surface->normal_map, s.uv));
    }
    return s;
}

/* Diffuse reflection of light from a direction of cosine `cosine`.  A textured metal spreads the
 * mean of its three channels. */
static struct vec3 diffuse_term(const struct material *m, struct vec3 texel, double cosine)
{
    struct vec3 diffuse = m->texture == TEXTURE_NONE ? m->diffuse : vec3_mul(texel, m->diffuse);
    struct vec3 lit = vec3_scale(diffuse, cosine);
    if (m->kind != MATERIAL_METAL || m->texture == TEXTURE_NONE)
        return lit;
    return vec3_scale(m->diffuse, (lit.x + lit.y + lit.z) / 3);
}

/* original.md, section 4: neither cosine is clamped. */
static struct vec3 direct_term(const struct shade_point *s, struct vec3 texel, struct vec3 to_light)
{
    const struct material *m = s->material;
    double cosine = vec3_dot(s->normal, to_light);
    struct vec3 light = diffuse_term(m, texel, cosine);
    if (m->kind == MATERIAL_LAMBERT)
        return light;
    struct vec3 mirrored = vec3_mad(to_light, -2 * cosine, s->normal);
    double shine = pow(vec3_dot(s->incoming, mirrored), m->exponent);
    return vec3_mad(light, shine, m->specular);
}

/* Intensity of the light at the point. */
static struct vec3 intensity_at(const struct light *l, struct vec3 p)
{
    if (!l->inverse_square)
        return l->intensity;
    struct vec3 d = vec3_sub(l->position, p);
    double square = vec3_dot(d, d);
    return vec3(l->intensity.x / square, l->intensity.y / square, l->intensity.z / square);
}

struct vec3 shade_direct(struct worker *w, const struct shade_point *s, struct vec3 *intensity)
{
    const struct scene *scene = w->tracer->scene;
    const struct material *m = s->material;
    struct vec3 texel = vec3_all(1), sum = vec3_all(0);
    if (m->texture != TEXTURE_NONE)
        texel = fetch(scene, m->texture, map_uv(&m->uv, s->uv));
    *intensity = vec3_all(0);
    for (size_t i = 0; i < scene->lights.n; i++) {
        const struct light *light = &scene->lights.at[i];
        struct vec3 arriving = intensity_at(light, s->p);
        *intensity = vec3_add(*intensity, arriving);
        if (m->kind == MATERIAL_EMISSIVE) {
            sum = vec3_add(sum, vec3_mul(arriving, vec3_mul(m->diffuse, texel)));
            continue;
        }
        double share = lamp_share(w, &w->tracer->lamps[i], s);
        if (share == 0) /* a direct term that is no number must not show */
            continue;
        struct vec3 to_light = vec3_normalize(vec3_sub(light->position, s->p));
        struct vec3 direct = direct_term(s, texel, to_light);
        sum = vec3_add(sum, vec3_mul(arriving, vec3_scale(direct, share)));
    }
    return sum;
}
