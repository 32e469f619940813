#include "config.h"

#include "render/tracer.h"

/* ---- what the rays hit ----------------------------------------------------------------------- */

/* The hit of the ray with the surface it crossed, alone. */
static bool hits_crossed_surface(const struct tracer *t, struct ray ray, uint32_t crossed,
                                 struct hit *hit)
{
    const struct surface *surface = &t->scene->surfaces.at[crossed];
    const struct geometry *g = &t->scene->geometry;
    if (surface->prim_count == 1 && g->prims.at[surface->first_prim].kind != PRIM_INSTANCE) {
        struct ray_frame frame = ray_frame_of(&ray);
        *hit = hit_none(ray.t_max);
        return ray_has_direction(&ray) &&
               geometry_intersect(g, surface->first_prim, &ray, &frame, hit);
    }
    ray.surface = crossed;
    return accel_closest(&t->accel, &ray, hit);
}

/* So few targets are not worth finding out which of them the rays of a tile can hit. */
enum { FEW_TARGETS = 8 };

/* What the rays can hit at all, nearest first; found from what is known of camera rays, if
 * anything, or put into `room`. */
static const struct target_list *find_targets(const struct tracer *t, const struct ray_batch *rays,
                                              const struct lookout *ahead, struct target_list *room)
{
    const struct target_list *known = ahead && ahead->known ? &ahead->list : NULL;
    room->usable = false;
    if (known && known->usable && known->n <= FEW_TARGETS)
        return known;
    if (!t->skips || rays->n <= 1 || bundle_needs_no_lists(&t->accel))
        return room;
    struct box origins = t->kernels->bounds(&rays->origin, rays->common_origin ? 1 : rays->n);
    struct box directions = t->kernels->bounds(&rays->direction, rays->n);
    struct shaft shaft = shaft_of_rays(&t->accel, origins, directions);
    shaft.from = rays->common_from ? rays->from[0] : PRIM_NONE;
    if (known && known->usable) {
        shaft_narrow(&t->accel, &shaft, known, room);
        return room;
    }
    shaft_list(&t->accel, &shaft, room);
    if (room->usable)
        shaft_sort(&t->accel, &shaft, room);
    return room;
}

/* A refracted ray meets the far side of what it crossed before anything else.  Bit i: ray i does.
 */
static uint64_t meet_crossed_surfaces(struct worker *w, const struct ray_batch *rays,
                                      const struct path *paths)
{
    uint64_t inside = 0;
    if (!paths || w->tracer->modern || !w->tracer->any_refractive)
        return 0;
    for (uint32_t i = 0; i < rays->n; i++) {
        struct hit hit;
        if (paths[i].crossed == SURFACE_NONE ||
            !hits_crossed_surface(w->tracer, ray_get(rays, i), paths[i].crossed, &hit))
            continue;
        inside |= UINT64_C(1) << i;
        hit_put(&w->hits, i, &hit);
    }
    return inside;
}

/* ---- what they lie on ------------------------------------------------------------------------ */

/* Or all hit nothing. */
static bool all_hit_the_same(const struct hit_batch *hits, uint32_t n)
{
    uint64_t number[BATCH], differing = 0; /* as bits, which are compared side by side */
    memcpy(number, hits->prim, n * sizeof *number);
    for (uint32_t i = 1; i < n; i++)
        differing |= number[i] ^ number[0];
    return differing == 0;
}

/* Nothing to do where the last points did, too. */
static void note_prim(struct worker *w, uint32_t number, uint32_t n)
{
    struct shade_batch *points = &w->points;
    struct prim prim = w->tracer->scene->geometry.prims.at[number];
    if (points->noted >= n && points->prim[0] == number)
        return;
    for (uint32_t k = 0; k < n; k++) {
        points->ray[k] = k;
        points->prim[k] = number;
        points->surface[k] = prim.surface;
        w->shapes.index[k] = prim.index;
    }
    points->noted = n;
}

/* Those of points that all lie on one primitive, as most tiles' do. */
static void note_same(struct worker *w, uint32_t n)
{
    struct shade_batch *points = &w->points;
    uint32_t number = (uint32_t)w->hits.prim[0];
    unsigned kind_of = w->tracer->scene->geometry.prims.at[number].kind;
    note_prim(w, number, n);
    for (unsigned kind = 0; kind <= PRIM_KINDS; kind++)
        w->shapes.first[kind] = kind <= kind_of ? 0 : n;
    points->n = n;
    points->in_order = true;
}

/* Puts the points in the order of their kinds, of which there are some. */
static void sort_kinds(struct worker *w)
{
    const struct prim *prims = w->tracer->scene->geometry.prims.at;
    struct shade_batch *points = &w->points;
    uint32_t ray[BATCH], prim[BATCH], n = 0;
    memcpy(ray, points->ray, points->n * sizeof *ray);
    memcpy(prim, points->prim, points->n * sizeof *prim);
    for (unsigned kind = 0; kind < PRIM_KINDS; kind++) {
        w->shapes.first[kind] = n;
        for (uint32_t k = 0; k < points->n; k++) {
            if (prims[prim[k]].kind != kind)
                continue;
            points->ray[n] = ray[k];
            points->prim[n] = prim[k];
            points->surface[n] = prims[prim[k]].surface;
            w->shapes.index[n++] = prims[prim[k]].index;
        }
    }
    w->shapes.first[PRIM_KINDS] = n;
    points->in_order = false;
}

static void note_any(struct worker *w, uint32_t n)
{
    const struct prim *prims = w->tracer->scene->geometry.prims.at;
    struct shade_batch *points = &w->points;
    unsigned kinds = 0;
    points->noted = 0;
    for (uint32_t i = 0; i < n; i++) {
        uint32_t number = (uint32_t)w->hits.prim[i], hit = number != PRIM_NONE;
        struct prim prim = hit ? prims[number] : (struct prim){0};
        points->ray[points->n] = i;
        points->prim[points->n] = number;
        points->surface[points->n] = prim.surface;
        w->shapes.index[points->n] = prim.index;
        kinds |= hit << prim.kind;
        points->n += hit;
    }
    points->in_order = points->n == n;
    for (unsigned kind = 0; kind <= PRIM_KINDS; kind++)
        w->shapes.first[kind] = kinds >> kind ? 0 : points->n;
    if (kinds & (kinds - 1))
        sort_kinds(w);
}

static void pick(double *to, const double *from, const uint32_t *which, uint32_t n)
{
    for (uint32_t k = 0; k < n; k++)
        to[k] = from[which[k]];
}

static void pick_vectors(struct vec3_batch *to, const struct vec3_batch *from,
                         const uint32_t *which, uint32_t n)
{
    pick(to->x, from->x, which, n);
    pick(to->y, from->y, which, n);
    pick(to->z, from->z, which, n);
}

/* The rays of the points. */
static void pick_rays(struct worker *w, const struct ray_batch *rays)
{
    struct shade_batch *points = &w->points;
    struct hit_shapes *shapes = &w->shapes;
    uint32_t n = points->n;
    struct picked *picked = &w->picked;
    shapes->origin = &rays->origin;
    points->incoming = &rays->direction;
    points->t = w->hits.t;
    shapes->part = w->hits.part;
    if (points->in_order)
        return;
    pick_vectors(&picked->incoming, &rays->direction, points->ray, n);
    pick(picked->t, w->hits.t, points->ray, n);
    pick(picked->part, w->hits.part, points->ray, n);
    points->incoming = &picked->incoming;
    points->t = picked->t;
    shapes->part = picked->part;
    if (rays->common_origin)
        return;
    pick_vectors(&picked->origin, &rays->origin, points->ray, n);
    shapes->origin = &picked->origin;
}

static bool lie_on_one_surface(const struct shade_batch *points)
{
    uint32_t differing = 0;
    for (uint32_t k = 1; k < points->n; k++)
        differing |= points->surface[k] ^ points->surface[0];
    return differing == 0;
}

/* The end of the points from `first` on that lie on the same surface. */
static uint32_t end_of_surface(const struct shade_batch *points, uint32_t first)
{
    if (points->one_surface)
        return points->n;
    uint32_t end = first + 1;
    while (end < points->n && points->surface[end] == points->surface[first])
        end++;
    return end;
}

static void note_surfaces(struct worker *w)
{
    struct shade_batch *points = &w->points;
    struct hit_shapes *shapes = &w->shapes;
    shapes->weighted = shapes->bent = points->curved = false;
    points->one_surface = lie_on_one_surface(points);
    for (uint32_t k = 0; k < points->n; k = end_of_surface(points, k)) {
        const struct surface *s = &w->tracer->scene->surfaces.at[points->surface[k]];
        shapes->weighted |= surface_interpolates(s);
        shapes->bent |= s->normals || s->flip;
        points->curved |= w->tracer->modern && (s->normals || s->normal_map != TEXTURE_NONE);
    }
    shapes->bent |= points->curved;
}

/* ---- their surfaces -------------------------------------------------------------------------- */

static struct hit hit_of_point(const struct worker *w, uint32_t k)
{
    const struct shade_batch *points = &w->points;
    return (struct hit){.t = points->t[k],
                        .prim = points->prim[k],
                        .part = (uint32_t)w->shapes.part[k],
                        .b1 = points->b1[k],
                        .b2 = points->b2[k]};
}

/* Texture coordinates of points first to end, which lie on one primitive, and up to the next whole
 * vector. */
static void find_uv(const struct worker *w, uint32_t first, uint32_t end,
                    const struct surface *surface, double *u, double *v)
{
    const struct scene *scene = w->tracer->scene;
    const struct shade_batch *points = &w->points;
    uint32_t prim = points->prim[first];
    struct prim shape = scene->geometry.prims.at[prim];
    if (shape.kind == PRIM_SPHERE) {
        w->tracer->kernels->sphere_uv(&scene->geometry.spheres.at[shape.index], &points->p, first,
                                      end, u, v);
        return;
    }
    if (surface->uvs && shape.kind == PRIM_TRIANGLE) {
        const struct vec2 *corner = surface->uvs + 3 * (prim - surface->first_prim);
        for (uint32_t k = first; k < end; k++) {
            struct vec2 uv = triangle_uv(corner, points->b1[k], points->b2[k]);
            u[k - first] = uv.x;
            v[k - first] = uv.y;
        }
        return;
    }
    for (uint32_t k = first; k < end; k++) {
        struct hit hit = hit_of_point(w, k);
        struct vec2 uv = surface_uv(scene, surface, &hit, vec3_get(&points->p, k));
        u[k - first] = uv.x;
        v[k - first] = uv.y;
    }
}

static void map_coordinates(double *restrict to, const double *restrict from, uint32_t n,
                            double scale, double offset)
{
    for (uint32_t i = 0; i < n; i++)
        to[i] = from[i] * scale + offset;
}

/* Adds points first to end, whose coordinates are u and v, where `map` puts them. */
static void add_textured(struct textured *t, uint32_t first, uint32_t end, uint32_t texture,
                         const struct uv_map *map, const double *u, const double *v)
{
    struct texture_run *last = t->runs ? &t->run[t->runs - 1] : NULL;
    map_coordinates(t->u + first, u, end - first, map->scale.x, map->offset.x);
    map_coordinates(t->v + first, v, end - first, map->scale.y, map->offset.y);
    if (last && last->texture == texture && last->end == first)
        last->end = end;
    else
        t->run[t->runs++] = (struct texture_run){first, end, texture};
}

/* Points first to end lie on one surface. */
static void note_textures(struct worker *w, uint32_t first, uint32_t end,
                          const struct surface *surface)
{
    const struct material *m = w->points.finish[first]->material;
    struct textured *bumps = &w->bumps;
    double found[2][BATCH_ROOM], *u = found[0], *v = found[1];
    for (uint32_t k = first, next; k < end; k = next) {
        next = k + 1;
        while (next < end && w->points.prim[next] == w->points.prim[k])
            next++;
        find_uv(w, k, next, surface, u + k - first, v + k - first);
    }
    if (surface->normal_map != TEXTURE_NONE) {
        add_textured(bumps, first, end, surface->normal_map, &surface->uv, u, v);
        if (!w->tracer->modern) { /* the original's material starts from the mapped ones */
            u = bumps->u + first;
            v = bumps->v + first;
        }
    }
    if (m->texture != TEXTURE_NONE)
        add_textured(&w->paints, first, end, m->texture, &m->uv, u, v);
}

/* What a run's last vector puts behind its end, the next run overwrites. */
static void fetch_texels(const struct worker *w, const struct textured *t, struct vec3_batch *out)
{
    for (const struct texture_run *run = t->run; run < t->run + t->runs; run++)
        w->tracer->kernels->texels(&w->tracer->scene->textures.at[run->texture], t->u, t->v,
                                   run->first, run->end, out);
}

/* Modern: the texels are normals in the surface's own frame. */
static void turn_normals(struct worker *w, const struct texture_run *run,
                         const struct vec3_batch *texels)
{
    struct shade_batch *points = &w->points;
    const struct scene *scene = w->tracer->scene;
    for (uint32_t k = run->first; k < run->end; k++) {
        const struct surface *surface = &scene->surfaces.at[points->surface[k]];
        struct hit hit = hit_of_point(w, k);
        struct vec3 texel = vec3_get(texels, k), n = vec3_get(&points->normal, k), x, y;
        surface_frame(scene, surface, &hit, vec3_get(&points->p, k), n, &x, &y);
        n = vec3_scale(n, 2 * texel.z - 1);
        n = vec3_mad(vec3_mad(n, 2 * texel.x - 1, x), 2 * texel.y - 1, y);
        if (!vec3_is_zero(n))
            vec3_put(&points->normal, k, vec3_normalize(n));
    }
}

static void bend_normals(struct worker *w)
{
    const struct texture_run *end = w->bumps.run + w->bumps.runs;
    struct vec3_batch texels;
    double bent[BATCH_ROOM] = {0};
    fetch_texels(w, &w->bumps, &texels);
    for (const struct texture_run *run = w->bumps.run; run < end; run++) {
        if (w->tracer->modern)
            turn_normals(w, run, &texels);
        else
            fill(bent, run->first, run->end, 1);
    }
    if (!w->tracer->modern)
        w->tracer->kernels->bend(&texels, bent, &w->points);
}

static void multiply(double *restrict to, const double *restrict by, const struct texture_run *run)
{
    for (uint32_t k = run->first; k < run->end; k++)
        to[k] *= by[k];
}

static void paint(struct worker *w)
{
    struct vec3_batch *diffuse = &w->points.diffuse;
    const struct texture_run *end = w->paints.run + w->paints.runs;
    struct vec3_batch texels;
    fetch_texels(w, &w->paints, &texels);
    w->points.painted = true;
    for (const struct texture_run *run = w->paints.run; run < end; run++) {
        multiply(diffuse->x, texels.x, run);
        multiply(diffuse->y, texels.y, run);
        multiply(diffuse->z, texels.z, run);
    }
}

/* Once more for all points, most often; what textures coloured is plain again. */
static void fill_finish(const struct tracer *t, struct shade_batch *points, uint32_t first,
                        uint32_t end, const struct finish *finish)
{
    bool filled = first == 0 && points->filled_with == finish && points->filled >= end;
    if (!filled || points->painted)
        t->kernels->fill(&points->diffuse, first, filled ? points->filled : end,
                         finish->material->diffuse);
    points->painted = false;
    if (filled)
        return;
    for (uint32_t k = first; k < end; k++)
        points->finish[k] = finish;
    for (uint32_t k = first; k < end; k++)
        points->power[k] = finish->power;
    t->kernels->fill(&points->specular, first, end, finish->specular);
    points->filled_with = first == 0 ? finish : NULL;
    points->filled = end;
}

/* The material of points first to end, which lie on one surface. */
static void finish_run(struct worker *w, uint32_t first, uint32_t end)
{
    const struct tracer *t = w->tracer;
    struct shade_batch *points = &w->points;
    const struct surface *surface = &t->scene->surfaces.at[points->surface[first]];
    const struct finish *finish = &t->finishes[surface->material];
    fill_finish(t, points, first, end, finish);
    points->any_uneven |= finish->uneven;
    points->any_glowing |= finish->glows;
    points->any_bounces |= finish->bounces;
    if (surface->needs_uv)
        note_textures(w, first, end, surface);
}

static void finish_points(struct worker *w)
{
    struct shade_batch *points = &w->points;
    w->bumps.runs = w->paints.runs = 0;
    points->any_uneven = points->any_glowing = points->any_bounces = false;
    for (uint32_t first = 0, end; first < points->n; first = end) {
        end = end_of_surface(points, first);
        finish_run(w, first, end);
    }
    points->plain = points->one_surface && w->paints.runs == 0;
    if (points->curved)
        vec3_copy(&points->smooth, points->n, &points->normal);
    if (w->bumps.runs > 0)
        bend_normals(w);
    if (w->paints.runs > 0)
        paint(w);
    w->tracer->kernels->face(points);
}

void find_points(struct worker *w, const struct ray_batch *rays, const struct path *paths)
{
    const struct tracer *t = w->tracer;
    struct shade_batch *points = &w->points;
    struct target_list room;
    points->n = 0;
    points->in_order = points->any_bounces = false;
    if (rays->n == 0)
        return;
    const struct target_list *list = find_targets(t, rays, paths ? NULL : &w->lookout, &room);
    if (list->usable && list->n == 0 && tracer_skips(t, SKIP_EMPTY)) {
        w->stats.skipped[SKIP_EMPTY] += paths == NULL;
        return;
    }
    bundle_closest(&t->accel, t->bundles, rays, list, &w->hits);
    uint64_t inside = meet_crossed_surfaces(w, rays, paths);
    bool same = all_hit_the_same(&w->hits, rays->n);
    if (same && w->hits.prim[0] == PRIM_NONE)
        return;
    if (same)
        note_same(w, rays->n);
    else
        note_any(w, rays->n);
    pick_rays(w, rays);
    note_surfaces(w);
    memset(points->inside, 0, sizeof points->inside);
    for (uint32_t k = 0; k < points->n && inside; k++)
        points->inside[k] = inside >> points->ray[k] & 1;
    t->kernels->hit_points(t->scene, &w->shapes, points);
    finish_points(w);
}
