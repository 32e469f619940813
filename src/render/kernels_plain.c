/* The reference of the kernels: one ray, one point after another. */
#include "config.h"

#include "render/tracer.h"

static void aim(const struct lens *lens, const double *x, const double *y, uint32_t n,
                struct vec3_batch *directions)
{
    for (uint32_t i = 0; i < n; i++)
        vec3_put(directions, i, lens_direction(lens, x[i], y[i]));
}

static void aim_grid(const struct lens *lens, const double *x, uint32_t width, const double *y,
                     uint32_t height, struct vec3_batch *directions)
{
    for (uint32_t i = 0; i < width * height; i++)
        vec3_put(directions, i, lens_direction(lens, x[i % width], y[i / width]));
}

void place_point(const struct scene *scene, const struct hit_shapes *shapes, uint32_t k,
                 struct shade_batch *points)
{
    const struct geometry *g = &scene->geometry;
    const struct surface *surface = &scene->surfaces.at[points->surface[k]];
    struct ray ray = {.origin = vec3_get(shapes->origin, k),
                      .direction = vec3_get(points->incoming, k)};
    struct hit hit = {
        .t = points->t[k], .prim = points->prim[k], .part = (uint32_t)shapes->part[k]};
    struct vec3 face, p = geometry_hit_point(g, &ray, &hit, &face);
    if (g->prims.at[hit.prim].kind == PRIM_TRIANGLE)
        p = triangle_settle(g, hit.prim, p, vec3_largest(p));
    if (surface_interpolates(surface))
        geometry_weights(g, &ray, &hit);
    points->b1[k] = hit.b1;
    points->b2[k] = hit.b2;
    vec3_put(&points->p, k, p);
    vec3_put(&points->normal, k, surface_normal(scene, surface, &hit, face));
    if (!points->curved)
        return;
    struct vec3 outwards = vec3_dot(face, ray.direction) > 0 ? vec3_neg(face) : face;
    vec3_put(&points->geometric, k, surface->flip ? vec3_neg(face) : face);
    vec3_put(&points->lifted, k,
             surface->normals ? surface_lift(scene, surface, &hit, p, outwards) : p);
}

static void hit_points(const struct scene *scene, const struct hit_shapes *shapes,
                       struct shade_batch *points)
{
    for (uint32_t k = 0; k < points->n; k++)
        place_point(scene, shapes, k, points);
}

static void spheres_uv(const struct sphere *sphere, const struct vec3_batch *points, uint32_t first,
                       uint32_t end, double *u, double *v)
{
    for (uint32_t i = first; i < end; i++) {
        struct vec2 uv = sphere_uv(sphere, vec3_get(points, i));
        u[i - first] = uv.x;
        v[i - first] = uv.y;
    }
}

static void texels(const struct texture *texture, const double *u, const double *v, uint32_t first,
                   uint32_t end, struct vec3_batch *texels)
{
    for (uint32_t i = first; i < end; i++)
        vec3_put(texels, i, texture_fetch(texture, u[i], v[i]));
}

static void bend(const struct vec3_batch *texels, const double *bent, struct shade_batch *points)
{
    for (uint32_t i = 0; i < points->n; i++) {
        struct vec3 texel = vec3_get(texels, i), n = vec3_get(&points->normal, i);
        struct vec3 b = vec3_normalize(vec3(2 * (texel.x - 0.5), -2 * (texel.y - 0.5), 1));
        if (bent[i] != 0)
            vec3_put(&points->normal, i, vec3_normalize(vec3(n.x + b.x, n.y - b.y, n.z)));
    }
}

static void face(struct shade_batch *points)
{
    for (uint32_t i = 0; i < points->n; i++)
        points->facing[i] = vec3_dot(vec3_get(&points->normal, i), vec3_get(points->incoming, i));
}

static void aim_at(const struct light *light, const struct vec3_batch *from, const uint32_t *prims,
                   double t_max, uint32_t n, struct ray_batch *rays)
{
    for (uint32_t i = 0; i < n; i++) {
        struct vec3 p = vec3_get(from, i), to = light->position;
        vec3_put(&rays->origin, i, p);
        vec3_put(&rays->direction, i, light->kind == LIGHT_SUN ? to : vec3_sub(to, p));
        rays->from[i] = prims[i];
        rays->t_max[i] = t_max;
    }
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

/* Classic: neither cosine is clamped. */
static struct vec3 direct_light(const struct shade_point *s, struct vec3 to_light)
{
    double cosine = vec3_dot(s->normal, to_light);
    double mirrored = vec3_dot(s->incoming, to_light) - 2 * cosine * s->facing;
    struct vec3 lit = finish_diffuse(s->finish, s->diffuse, cosine);
    return vec3_mad(lit, finish_highlight(s->finish, mirrored), s->finish->specular);
}

/* share 0 leaves out direct light that may be no number. */
static void add_light(const struct shade_batch *points, const struct light *light,
                      const double *shares, struct light_batch *sums)
{
    for (uint32_t i = 0; i < points->n; i++) {
        struct shade_point s = shade_point_get(points, i);
        struct vec3 intensity = intensity_at(light, s.p), direct = s.diffuse;
        if (points->any_bounces)
            vec3_put(&sums->intensity, i, vec3_add(vec3_get(&sums->intensity, i), intensity));
        if (shares[i] == 0)
            continue;
        if (!s.finish->glows) {
            struct vec3 to_light = vec3_normalize(vec3_sub(light->position, s.p));
            direct = vec3_scale(direct_light(&s, to_light), shares[i]);
        }
        vec3_put(sums->direct, i, vec3_add(vec3_get(sums->direct, i), vec3_mul(intensity, direct)));
    }
}

static void reflect(const struct shade_batch *points, struct ray_batch *rays)
{
    for (uint32_t i = 0; i < points->n; i++) {
        struct shade_point s = shade_point_get(points, i);
        vec3_put(&rays->direction, i,
                 vec3_normalize(vec3_mad(s.incoming, -2 * s.facing, s.normal)));
        vec3_put(&rays->origin, i, s.p);
        rays->from[i] = s.prim;
    }
}

static uint64_t weigh(const struct vec3_batch *intensity, struct vec3 mirrored, uint32_t n,
                      struct vec3_batch *weight)
{
    uint64_t some = 0;
    for (uint32_t i = 0; i < n; i++) {
        vec3_put(weight, i, vec3_mul(vec3_get(intensity, i), mirrored));
        some |= (uint64_t)!vec3_is_zero(vec3_get(weight, i)) << i;
    }
    return some;
}

static void add_shares(const struct vec3_batch *weights, const struct vec3_batch *colours,
                       uint32_t n, struct vec3_batch *sums)
{
    for (uint32_t i = 0; i < n; i++)
        vec3_put(sums, i,
                 vec3_add(vec3_get(sums, i), vec3_mul(vec3_get(weights, i), vec3_get(colours, i))));
}

/* A point with a part that is no number leaves that part out. */
static struct box bounds(const struct vec3_batch *points, uint32_t n)
{
    struct box b = box_empty();
    for (uint32_t i = 0; i < n; i++) {
        struct vec3 p = vec3_get(points, i);
        b.lo = vec3_min(p, b.lo);
        b.hi = vec3_max(p, b.hi);
    }
    return b;
}

static void pack(const struct picture *out, const struct vec3_batch *colours, uint32_t n,
                 uint8_t pixels[PACKED_ROOM])
{
    for (uint32_t i = 0; i < n; i++) {
        struct vec3 c = vec3_scale(vec3_get(colours, i), out->gain);
        pixels[3 * i] = picture_byte(out, c.x);
        pixels[3 * i + 1] = picture_byte(out, c.y);
        pixels[3 * i + 2] = picture_byte(out, c.z);
    }
}

static uint64_t front(const struct shade_batch *points, const struct lamp *lamp)
{
    (void)points, (void)lamp;
    return UINT64_MAX;
}

/* Everything on the list may be in everyone's way. */
static void see(const struct geometry *g, const struct lamp *lamp, uint32_t opaque,
                const struct vec3_batch *from, const uint32_t *prims, uint32_t first, uint32_t end,
                struct sight *sight)
{
    (void)g, (void)lamp, (void)opaque, (void)from, (void)prims, (void)first, (void)end;
    memset(sight->near, 0xff, sight->list.n * sizeof *sight->near);
    sight->hidden = 0;
}

const struct render_kernels render_plain = {
    .aim = aim,
    .aim_grid = aim_grid,
    .fill = vec3_fill,
    .hit_points = hit_points,
    .sphere_uv = spheres_uv,
    .texels = texels,
    .bend = bend,
    .face = face,
    .aim_at = aim_at,
    .add_light = add_light,
    .add_modern = modern_add_light,
    .front = front,
    .give = modern_give,
    .reflect = reflect,
    .weigh = weigh,
    .add_shares = add_shares,
    .bounds = bounds,
    .pack = pack,
    .see = see,
};
