#include "config.h"

#include "render/tracer.h"

void lamp_init(struct lamp *lamp, const struct light *light, bool brute_force)
{
    *lamp = (struct lamp){.light = light, .box = {light->position, light->position}};
    if (light->samples.n > 0) {
        lamp->box = geometry_bounds(&light->object);
        lamp->always_counts = true;
    } else if (light->kind == LIGHT_AREA) {
        accel_build(&lamp->object, &light->object, brute_force);
        lamp->box = box_empty();
        for (size_t i = 0; i < light->points.n; i++) {
            const struct light_point *point = &light->points.at[i];
            lamp->box = box_add(lamp->box, point->position);
            lamp->always_counts |= point->on_object || point->inside;
        }
    }
    lamp->center = box_center(lamp->box);
    lamp->radius = vec3_length(vec3_sub(lamp->box.hi, lamp->center));
    if (light->object.prims.n == 1 && light->object.prims.at[0].kind == PRIM_SPHERE) {
        lamp->center = light->object.spheres.at[0].center;
        lamp->radius = light->object.spheres.at[0].radius;
    }
}

void lamp_free(struct lamp *lamp)
{
    if (lamp->object.geometry)
        accel_free(&lamp->object);
}

/* Distance from the nearest point of one box to the nearest of the other. */
static double box_gap(struct box a, struct box b)
{
    struct vec3 d = vec3_max(vec3_sub(a.lo, b.hi), vec3_sub(b.lo, a.hi));
    return vec3_length(vec3_max(d, vec3_all(0)));
}

/* The largest t at which a shadow ray from the box to a sample of the lamp still counts: the
 * distance to the light's position over that to the sample.  Infinite when it cannot be told. */
static double longest_shadow_ray(const struct lamp *lamp, struct box from)
{
    if (lamp->light->kind == LIGHT_POINT || lamp->light->samples.n > 0)
        return 1;
    struct vec3 p = lamp->light->position;
    struct vec3 d = vec3_max(vec3_sub(p, from.lo), vec3_sub(from.hi, p));
    return vec3_length(d) / box_gap(from, lamp->box) * (1 + 0x1p-30);
}

/* The shaft of all shadow rays from the box to the lamp; false when there is none to speak of: the
 * points are close by, or among the samples. */
static bool shaft_to_lamp(const struct tracer *t, const struct lamp *lamp, struct box from,
                          struct shaft *shaft)
{
    if (lamp->light->kind == LIGHT_SUN) {
        *shaft = shaft_of_rays(&t->accel, from, lamp->box);
        return true;
    }
    double t_max = longest_shadow_ray(lamp, from);
    if (!(t_max <= 4))
        return false;
    *shaft = shaft_between(&t->accel, from, lamp->box, t_max > 1 ? t_max : 1);
    return true;
}

void list_shadowers(const struct tracer *t, const struct lamp *lamp, struct box from,
                    struct target_list *list)
{
    struct shaft shaft;
    list->usable = false;
    if (shaft_to_lamp(t, lamp, from, &shaft))
        shaft_list(&t->accel, &shaft, list);
}

static struct ray shadow_ray(const struct shade_point *s, struct vec3 target, double t_max)
{
    return (struct ray){.origin = s->p,
                        .direction = vec3_sub(target, s->p),
                        .t_max = t_max,
                        .from = s->prim,
                        .surface = SURFACE_NONE,
                        .spawned = true};
}

static bool is_emissive(const struct tracer *t, uint32_t prim)
{
    return t->emissive[t->scene->geometry.prims.at[prim].surface];
}

/* Whether light may get past some target to a ray. */
static bool lets_light(const struct tracer *t, const struct target_list *list)
{
    if (!t->any_emissive || !list->usable)
        return t->any_emissive;
    for (uint32_t i = 0; i < list->n; i++)
        if (is_emissive(t, list->at[i].prim))
            return true;
    return false;
}

/* Modern: whether anything but emissive surfaces is in the ray's way, of which `hit` is the first.
 * What is emissive is passed by a ray that starts on it; enough such stretches for any scene end a
 * walk that rounding errors keep on the spot. */
static bool is_blocked(const struct tracer *t, struct ray ray, struct hit hit)
{
    enum { STRETCHES = 1000 };
    for (int i = 0; i < STRETCHES && hit.prim != PRIM_NONE; i++) {
        if (!is_emissive(t, hit.prim))
            return true;
        ray.origin = vec3_mad(ray.origin, hit.t, ray.direction);
        ray.t_max -= hit.t;
        ray.from = hit.prim;
        ray.spawned = true;
        accel_closest(&t->accel, &ray, &hit);
    }
    return false;
}

/* A ray is blocked when its nearest hit is not emissive, in modern also when something behind it is
 * not; where nothing is emissive, when it hits anything. */
void find_blocked(struct worker *w, const struct target_list *list, bool *blocked)
{
    const struct tracer *t = w->tracer;
    const struct ray_batch *rays = &w->shadow_rays;
    struct hit_batch hits;
    w->stats.shadow += rays->n;
    if (!lets_light(t, list)) {
        bundle_any(&t->accel, t->bundles, rays, list, blocked);
        return;
    }
    bundle_closest(&t->accel, t->bundles, rays, list, &hits);
    for (uint32_t i = 0; i < rays->n; i++) {
        blocked[i] = hits.prim[i] != PRIM_NONE && !is_emissive(t, (uint32_t)hits.prim[i]);
        if (t->modern && hits.prim[i] != PRIM_NONE && !blocked[i])
            blocked[i] = is_blocked(t, ray_get(rays, i), hit_get(&hits, i));
    }
}

/* What a ball of directions, seen from a point, is to a ball in the scene. */
enum cover { COVER_NONE, COVER_SOME, COVER_ALL };

/* The lamp as a shade point sees it. */
struct aim {
    struct vec3 p, to_center;
    double distance;           /* to the lamp's center */
    double tangent;            /* length of a tangent to the lamp's ball */
    double radius;             /* of the lamp's ball */
    double least_reach, reach; /* how far shadow rays go, the shortest and the longest */
};

/* Rounding errors of the tests below are far smaller than this, relative to the distances. */
#define COVER_MARGIN 1e-6

/* Whether a ball at center c can stand in the way of the lamp's ball, or hides all of it: compares
 * the angle between both centers with the sum and the difference of both angular radii, by the
 * cosines times both distances.  power: |p - c|^2 - r^2 >= 0. */
static enum cover ball_cover(const struct aim *aim, struct vec3 c, double r, double power)
{
    struct vec3 g = vec3_sub(c, aim->p);
    double far = vec3_length(g), along = vec3_dot(g, aim->to_center), tangent = sqrt(power);
    double margin = COVER_MARGIN * far * aim->distance;
    if (far - r > aim->reach * (1 + COVER_MARGIN))
        return COVER_NONE;
    if (along < tangent * aim->tangent - r * aim->radius - margin)
        return COVER_NONE;
    bool larger = r * aim->distance > aim->radius * far;
    if (larger && along > tangent * aim->tangent + r * aim->radius + margin)
        return COVER_ALL;
    return COVER_SOME;
}

static enum cover sphere_cover(const struct aim *aim, const struct sphere *s)
{
    double power =
        sphere_power(s, vec3_sub(aim->p, s->center), vec3_largest(aim->p), SPAWN_TOLERANCE);
    if (!(power >= 0) || !(aim->distance > aim->radius))
        return COVER_SOME;
    enum cover cover = ball_cover(aim, s->center, s->radius, power);
    /* The first hit from outside is no farther than the tangent; from the sphere, than through it.
     */
    double farthest = power == 0 ? 2 * s->radius : sqrt(power);
    if (cover == COVER_ALL && !(farthest < aim->least_reach * (1 - COVER_MARGIN)))
        return COVER_SOME;
    return cover;
}

static enum cover cylinder_cover(const struct aim *aim, const struct cylinder *c)
{
    struct vec3 middle = vec3_mad(c->base, 0.5 * c->height, c->axis);
    struct vec3 f = vec3_sub(aim->p, middle);
    double r2 = 0.25 * c->height * c->height + c->radius * c->radius;
    double power = vec3_dot(f, f) - r2;
    if (!(power > COVER_MARGIN * r2) || !(aim->distance > aim->radius))
        return COVER_SOME;
    return ball_cover(aim, middle, sqrt(r2), power) == COVER_NONE ? COVER_NONE : COVER_SOME;
}

/* Classic's rays go as far as the light's position is, modern's to the samples themselves. */
static struct aim aim_at(const struct lamp *lamp, struct vec3 p)
{
    struct vec3 to_center = vec3_sub(lamp->center, p);
    double square = vec3_dot(to_center, to_center), distance = sqrt(square);
    double reach = vec3_length(vec3_sub(lamp->light->position, p));
    bool modern = lamp->light->samples.n > 0;
    return (struct aim){.p = p,
                        .to_center = to_center,
                        .distance = distance,
                        .tangent = sqrt(fmax(square - lamp->radius * lamp->radius, 0)),
                        .radius = lamp->radius,
                        .least_reach = modern ? distance - lamp->radius : reach,
                        .reach = modern ? distance + lamp->radius : reach};
}

/* Leaves in the list what can stand between this one point and the lamp; false when one of its
 * members alone hides all of the lamp. */
static bool narrow_list(const struct tracer *t, const struct lamp *lamp,
                        const struct shade_point *s, struct target_list *list)
{
    const struct geometry *g = &t->scene->geometry;
    struct aim aim = aim_at(lamp, s->p);
    struct shaft shaft;
    bool has_shaft = shaft_to_lamp(t, lamp, (struct box){s->p, s->p}, &shaft);
    uint32_t n = 0;
    for (uint32_t i = 0; i < list->n; i++) {
        struct target target = list->at[i];
        enum cover cover = COVER_SOME;
        if (target.kind == PRIM_SPHERE)
            cover = sphere_cover(&aim, &g->spheres.at[target.index]);
        else if (target.kind == PRIM_CYLINDER)
            cover = cylinder_cover(&aim, &g->cylinders.at[target.index]);
        else if (target.prim == s->prim || (has_shaft && !shaft_touches(&t->accel, &shaft, target)))
            cover = COVER_NONE;
        if (cover == COVER_ALL && !t->any_emissive)
            return false;
        if (cover != COVER_NONE)
            list->at[n++] = target;
    }
    list->n = n;
    return true;
}

/* Whether the ray from the point through the grid point meets the light's object. */
static bool sample_counts(const struct lamp *lamp, const struct light_point *sample,
                          const struct shade_point *s, bool skips)
{
    if (sample->on_object || (sample->inside && skips))
        return true;
    struct ray ray = shadow_ray(s, sample->position, RAY_UNBOUNDED);
    ray.from = PRIM_NONE;
    return accel_any(&lamp->object, &ray);
}

struct tally {
    uint64_t counted, lit;
};

/* Traces the rays gathered and empties them. */
static void add_to_tally(struct worker *w, const struct target_list *list, const uint32_t *counts,
                         struct tally *tally)
{
    bool blocked[BATCH];
    find_blocked(w, list, blocked);
    for (uint32_t i = 0; i < w->shadow_rays.n; i++) {
        tally->counted += counts[i];
        tally->lit += blocked[i] ? 0 : counts[i];
    }
    w->shadow_rays.n = 0;
}

static void add_shadow_ray(struct ray_batch *rays, const struct ray *ray)
{
    uint32_t i = rays->n++;
    vec3_put(&rays->origin, i, ray->origin);
    vec3_put(&rays->direction, i, ray->direction);
    rays->t_max[i] = ray->t_max;
    rays->from[i] = ray->from;
}

/* The share of the lamp's samples that are lit, each tried. */
static double sampled_share(struct worker *w, const struct lamp *lamp,
                            const struct target_list *list, const struct shade_point *s)
{
    const struct light *light = lamp->light;
    double reach = vec3_length(vec3_sub(light->position, s->p));
    struct tally tally = {0, 0};
    struct ray_batch *rays = &w->shadow_rays;
    uint32_t counts[BATCH];
    rays->n = 0;
    rays->common_origin = true;
    for (size_t i = 0; i < light->points.n; i++) {
        const struct light_point *sample = &light->points.at[i];
        if (!sample_counts(lamp, sample, s, w->tracer->skips))
            continue;
        struct ray ray = shadow_ray(s, sample->position, 0);
        double t_max = reach / vec3_length(ray.direction);
        ray.t_max = t_max <= RAY_UNBOUNDED ? t_max : RAY_UNBOUNDED;
        counts[rays->n] = sample->count;
        add_shadow_ray(rays, &ray);
        if (rays->n == BATCH)
            add_to_tally(w, list, counts, &tally);
    }
    if (rays->n > 0)
        add_to_tally(w, list, counts, &tally);
    return tally.counted ? (double)tally.lit / (double)tally.counted : 0;
}

/* Nothing in the way is nothing known where the light's own object decides which samples count. */
enum lamp_view lamp_view(struct worker *w, const struct lamp *lamp, const struct target_list *batch,
                         const struct shade_point *s, struct target_list *own)
{
    const struct tracer *t = w->tracer;
    own->usable = false;
    if (!t->skips)
        return LAMP_PARTLY;
    if (batch->usable)
        *own = *batch;
    else
        list_shadowers(t, lamp, (struct box){s->p, s->p}, own);
    if (own->usable && !narrow_list(t, lamp, s, own))
        return LAMP_HIDDEN;
    return own->usable && own->n == 0 && lamp->always_counts ? LAMP_OPEN : LAMP_PARTLY;
}

static double area_share(struct worker *w, const struct lamp *lamp, const struct target_list *batch,
                         const struct shade_point *s)
{
    struct target_list own;
    enum lamp_view view = lamp_view(w, lamp, batch, s, &own);
    if (view == LAMP_PARTLY)
        return sampled_share(w, lamp, &own, s);
    w->stats.shadow_skipped += lamp->light->points.n;
    return view == LAMP_OPEN;
}

/* The points that a light lights at all. */
static uint32_t lit_points(const struct shade_batch *points, uint32_t which[BATCH])
{
    uint32_t n = 0;
    for (uint32_t k = 0; k < points->n; k++)
        if (!points->any_glowing || !points->finish[k]->glows)
            which[n++] = k;
    return n;
}

/* Nothing stands between any of the points and the lamp. */
static void open_shares(struct worker *w, double *shares)
{
    uint32_t which[BATCH];
    fill(shares, 0, w->points.n, 1);
    w->stats.shadow_skipped += lit_points(&w->points, which);
}

/* Modern's shadow rays end this much of their length before the light, so that what the light lies
 * on does not shadow it: far more than rounding errors, far less than can be seen. */
#define LIGHT_CLEARANCE 0x1p-32

double shadow_reach(const struct tracer *t, const struct light *light)
{
    return light->kind == LIGHT_SUN ? RAY_UNBOUNDED : t->modern ? 1 - LIGHT_CLEARANCE : 1;
}

static void subtract(double from, const double *x, uint32_t n, double *difference)
{
    for (uint32_t i = 0; i < n; i++)
        difference[i] = from - x[i];
}

/* The rays from n of the points to the light. */
static void aim_at_light(struct worker *w, const struct light *light, const uint32_t *which,
                         uint32_t n)
{
    const struct shade_batch *points = &w->points;
    const struct vec3_batch *from = w->tracer->modern ? &points->lifted : &points->p;
    struct ray_batch *rays = &w->shadow_rays;
    if (n == points->n)
        vec3_copy(&rays->origin, n, from);
    for (uint32_t i = 0; i < n && n < points->n; i++)
        vec3_put(&rays->origin, i, vec3_get(from, which[i]));
    for (uint32_t i = 0; i < n; i++)
        rays->from[i] = points->prim[which[i]];
    fill(rays->t_max, 0, n, shadow_reach(w->tracer, light));
    if (light->kind == LIGHT_SUN) {
        vec3_fill(&rays->direction, 0, n, light->position);
    } else {
        subtract(light->position.x, rays->origin.x, n, rays->direction.x);
        subtract(light->position.y, rays->origin.y, n, rays->direction.y);
        subtract(light->position.z, rays->origin.z, n, rays->direction.z);
    }
    rays->n = n;
    rays->common_origin = n == 1;
}

static void point_shares(struct worker *w, const struct lamp *lamp, const struct target_list *list,
                         double *shares)
{
    bool blocked[BATCH];
    uint32_t which[BATCH], n = lit_points(&w->points, which);
    fill(shares, 0, w->points.n, 1);
    if (n == 0)
        return;
    aim_at_light(w, lamp->light, which, n);
    find_blocked(w, list, blocked);
    for (uint32_t i = 0; i < n; i++)
        shares[which[i]] = blocked[i] ? 0 : 1;
}

void lamp_shares(struct worker *w, const struct lamp *lamp, struct box box, double *shares)
{
    uint32_t n = w->points.n;
    struct target_list list = {.usable = false};
    if (w->tracer->skips && n > 1)
        list_shadowers(w->tracer, lamp, box, &list);
    if (lamp->light->kind != LIGHT_AREA) {
        if (list.usable && list.n == 0)
            open_shares(w, shares);
        else
            point_shares(w, lamp, &list, shares);
        return;
    }
    for (uint32_t i = 0; i < n; i++) {
        struct shade_point s = shade_point_get(&w->points, i);
        shares[i] = s.finish->glows ? 1 : area_share(w, lamp, &list, &s);
    }
}
