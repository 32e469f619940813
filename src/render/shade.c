#include "config.h"

#include "render/tracer.h"

static struct vec3 fetch(const struct scene *scene, uint32_t texture, struct vec2 uv)
{
    return texture_fetch(&scene->textures.at[texture], uv.x, uv.y);
}

static struct vec2 map_uv(const struct uv_map *m, struct vec2 uv)
{
    return (struct vec2){uv.x * m->scale.x + m->offset.x, uv.y * m->scale.y + m->offset.y};
}

/* The original's normal map: the texel bends the normal in world coordinates. */
static struct vec3 bumped(struct vec3 normal, struct vec3 texel)
{
    struct vec3 b = vec3_normalize(vec3(2 * (texel.x - 0.5), -2 * (texel.y - 0.5), 1));
    return vec3_normalize(vec3(normal.x + b.x, normal.y - b.y, normal.z));
}

static void apply_textures(struct shade_point *s, const struct scene *scene,
                           const struct surface *surface, const struct hit *hit)
{
    const struct material *m = s->finish->material;
    struct vec2 uv = surface_uv(scene, surface, hit, s->p);
    if (surface->normal_map != TEXTURE_NONE) {
        uv = map_uv(&surface->uv, uv);
        s->normal = bumped(s->normal, fetch(scene, surface->normal_map, uv));
    }
    if (m->texture != TEXTURE_NONE)
        s->diffuse = vec3_mul(fetch(scene, m->texture, map_uv(&m->uv, uv)), m->diffuse);
}

void shade_point_init(struct shade_point *s, const struct tracer *t, const struct ray *ray,
                      struct hit *hit)
{
    const struct scene *scene = t->scene;
    s->incoming = ray->direction;
    s->prim = hit->prim;
    s->surface = scene->geometry.prims.at[hit->prim].surface;
    const struct surface *surface = &scene->surfaces.at[s->surface];
    s->finish = &t->finishes[surface->material];
    s->diffuse = s->finish->material->diffuse;
    s->p = geometry_hit_point(&scene->geometry, ray, hit, &s->normal);
    if (surface->normals || surface->uvs)
        geometry_weights(&scene->geometry, ray, hit);
    if (surface->normals || surface->flip)
        s->normal = surface_normal(scene, surface, hit, s->normal);
    if (surface->needs_uv)
        apply_textures(s, scene, surface, hit);
    s->facing = vec3_dot(s->normal, s->incoming);
}

/* Whole exponents up to this are multiplied out: 1e-13 off at most, and several times faster than
 * pow. */
enum { SQUARED_LIMIT = 1000 };

struct finish finish_of(const struct material *m)
{
    bool whole = m->exponent <= SQUARED_LIMIT && m->exponent == floor(m->exponent);
    bool dull = m->kind == MATERIAL_LAMBERT || m->kind == MATERIAL_EMISSIVE;
    return (struct finish){.material = m,
                           .bounces = !vec3_is_zero(m->reflection) || !vec3_is_zero(m->refraction),
                           .dull = dull || (whole && vec3_is_zero(m->specular)),
                           .squared = whole,
                           .power = whole ? (unsigned)m->exponent : 0};
}

/* x^n by repeated squaring: every step rounds, so the error is below n 2^-53. */
static double whole_power(double x, unsigned n)
{
    double result = n & 1 ? x : 1;
    while (n >>= 1) {
        x *= x;
        result = n & 1 ? result * x : result;
    }
    return result;
}

/* A fractional power of a negative cosine is no number. */
static double highlight(const struct finish *f, double cosine)
{
    return f->squared ? whole_power(cosine, f->power) : pow(cosine, f->material->exponent);
}

/* Diffuse reflection of light from a direction of cosine `cosine`.  A textured metal spreads the
 * mean of its three channels. */
static struct vec3 diffuse_term(const struct shade_point *s, double cosine)
{
    const struct material *m = s->finish->material;
    struct vec3 lit = vec3_scale(s->diffuse, cosine);
    if (m->kind != MATERIAL_METAL || m->texture == TEXTURE_NONE)
        return lit;
    return vec3_scale(m->diffuse, (lit.x + lit.y + lit.z) / 3);
}

/* Classic: neither cosine is clamped. */
static struct vec3 direct_term(const struct shade_point *s, struct vec3 to_light)
{
    double cosine = vec3_dot(s->normal, to_light);
    struct vec3 light = diffuse_term(s, cosine);
    if (s->finish->dull)
        return light;
    double mirrored = vec3_dot(s->incoming, to_light) - 2 * cosine * s->facing;
    return vec3_mad(light, highlight(s->finish, mirrored), s->finish->material->specular);
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

/* What a light of this intensity at the point gives; share 0 leaves out a direct term that may be
 * no number. */
static void add_light(struct vec3 *sum, const struct shade_point *s, const struct light *light,
                      struct vec3 intensity, double share)
{
    struct vec3 direct = s->diffuse;
    if (share == 0)
        return;
    if (s->finish->material->kind != MATERIAL_EMISSIVE) {
        struct vec3 to_light = vec3_normalize(vec3_sub(light->position, s->p));
        direct = vec3_scale(direct_term(s, to_light), share);
    }
    *sum = vec3_add(*sum, vec3_mul(intensity, direct));
}

static void add_lamp(struct worker *w, const struct light *light, uint32_t n, const double *shares)
{
    for (uint32_t i = 0; i < n; i++) {
        const struct shade_point *s = &w->points[i];
        struct vec3 intensity = intensity_at(light, s->p);
        add_light(&w->light[i].direct, s, light, intensity, shares[i]);
        if (s->finish->bounces)
            w->light[i].intensity = vec3_add(w->light[i].intensity, intensity);
    }
}

void shade_points(struct worker *w, uint32_t n)
{
    const struct tracer *t = w->tracer;
    double shares[BATCH];
    struct box box = box_empty();
    for (uint32_t i = 0; i < n; i++) {
        w->light[i] = (struct shade_light){{0, 0, 0}, {0, 0, 0}};
        box = box_add(box, w->points[i].p);
    }
    for (size_t k = 0; k < t->scene->lights.n && n > 0; k++) {
        lamp_shares(w, &t->lamps[k], box, n, shares);
        add_lamp(w, &t->scene->lights.at[k], n, shares);
    }
}
