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

static void apply_textures(struct shade_point *s, const struct scene *scene,
                           const struct surface *surface, const struct hit *hit)
{
    struct vec2 uv = surface_uv(scene, surface, hit, s->p);
    if (surface->normal_map != TEXTURE_NONE) {
        uv = map_uv(&surface->uv, uv);
        s->normal = bumped(s->normal, fetch(scene, surface->normal_map, uv));
    }
    const struct material *m = s->material;
    if (m->texture != TEXTURE_NONE)
        s->diffuse = vec3_mul(fetch(scene, m->texture, map_uv(&m->uv, uv)), m->diffuse);
}

void shade_point_init(struct shade_point *s, const struct scene *scene, const struct ray *ray,
                      struct hit *hit)
{
    struct vec3 geometric;
    s->incoming = ray->direction;
    s->prim = hit->prim;
    s->surface = scene->geometry.prims.at[hit->prim].surface;
    const struct surface *surface = &scene->surfaces.at[s->surface];
    if (surface->normals || surface->uvs)
        geometry_weights(&scene->geometry, ray, hit);
    s->p = geometry_hit_point(&scene->geometry, ray, hit, &geometric);
    s->normal = surface_normal(scene, surface, hit, geometric);
    s->material = &scene->materials.at[surface->material];
    s->diffuse = s->material->diffuse;
    if (surface->needs_uv)
        apply_textures(s, scene, surface, hit);
}

/* Diffuse reflection of light from a direction of cosine `cosine`.  A textured metal spreads the
 * mean of its three channels. */
static struct vec3 diffuse_term(const struct shade_point *s, double cosine)
{
    const struct material *m = s->material;
    struct vec3 lit = vec3_scale(s->diffuse, cosine);
    if (m->kind != MATERIAL_METAL || m->texture == TEXTURE_NONE)
        return lit;
    return vec3_scale(m->diffuse, (lit.x + lit.y + lit.z) / 3);
}

/* Whether adding k cosine^exponent cannot change the light, not even its last bit: the power is
 * below 2^-60, for x^n <= exp(-n (1 - x)), and k not that much larger than the light.  A specular
 * of 0 adds nothing to begin with.  The power of a negative cosine must be a number. */
static bool is_invisible(struct vec3 light, struct vec3 k, double cosine, double exponent)
{
    bool is_number = exponent == floor(exponent) && exponent <= 1e6 && fabs(cosine) < 2;
    if (k.x == 0 && k.y == 0 && k.z == 0)
        return is_number;
    return exponent * (1 - fabs(cosine)) > 42 && is_number && k.x < 32 * fabs(light.x) &&
           k.y < 32 * fabs(light.y) && k.z < 32 * fabs(light.z);
}

static struct vec3 add_highlight(struct vec3 light, const struct material *m, double cosine)
{
    if (is_invisible(light, m->specular, cosine, m->exponent))
        return light;
    double shine = m->exponent == 1 ? cosine : pow(cosine, m->exponent);
    return vec3_mad(light, shine, m->specular);
}

/* original.md, section 4: neither cosine is clamped. */
static struct vec3 direct_term(const struct shade_point *s, struct vec3 to_light)
{
    double cosine = vec3_dot(s->normal, to_light);
    struct vec3 light = diffuse_term(s, cosine);
    if (s->material->kind == MATERIAL_LAMBERT)
        return light;
    struct vec3 mirrored = vec3_mad(to_light, -2 * cosine, s->normal);
    return add_highlight(light, s->material, vec3_dot(s->incoming, mirrored));
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

/* Adds what this light does; share 0 leaves out a direct term that may be no number. */
static void add_light(struct shade_light *sum, const struct shade_point *s,
                      const struct light *light, double share)
{
    struct vec3 intensity = intensity_at(light, s->p), direct = s->diffuse;
    sum->intensity = vec3_add(sum->intensity, intensity);
    if (share == 0)
        return;
    if (s->material->kind != MATERIAL_EMISSIVE) {
        struct vec3 to_light = vec3_normalize(vec3_sub(light->position, s->p));
        direct = vec3_scale(direct_term(s, to_light), share);
    }
    sum->direct = vec3_add(sum->direct, vec3_mul(intensity, direct));
}

void shade_points(struct worker *w, uint32_t n)
{
    const struct scene *scene = w->tracer->scene;
    double shares[BATCH];
    struct box box = box_empty();
    for (uint32_t i = 0; i < n; i++) {
        w->light[i] = (struct shade_light){ { 0, 0, 0 }, { 0, 0, 0 } };
        box = box_add(box, w->points[i].p);
    }
    for (size_t k = 0; k < scene->lights.n; k++) {
        lamp_shares(w, &w->tracer->lamps[k], box, n, shares);
        for (uint32_t i = 0; i < n; i++)
            add_light(&w->light[i], &w->points[i], &scene->lights.at[k], shares[i]);
    }
}
