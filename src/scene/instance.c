#include "config.h"

#include "scene/instance.h"

#include "scene/intersect.h"
#include "scene/shape.h"

static const struct instance *instance_at(const struct geometry *g, uint32_t prim)
{
    return &g->instances.at[g->prims.at[prim].index];
}

static const struct geometry *shapes_of(const struct geometry *g, const struct instance *i)
{
    return &g->prototypes.at[i->prototype]->shapes;
}

/* ---- making ---------------------------------------------------------------------------------- */

/* The largest row sum of |a|. */
static double row_norm(const struct affine *a)
{
    double most = 0;
    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(a->m[i][0]) + fabs(a->m[i][1]) + fabs(a->m[i][2]));
    return most;
}

/* The largest row sum of |a| |b|: what rounding errors grow by on the way through b and a. */
static double product_norm(const struct affine *a, const struct affine *b)
{
    struct affine x, y;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            x.m[i][j] = fabs(a->m[i][j]);
            y.m[i][j] = fabs(b->m[i][j]);
        }
        x.m[i][3] = y.m[i][3] = 0;
    }
    struct affine product = affine_times(&x, &y);
    return row_norm(&product);
}

static struct vec3 row(const struct affine *a, int i)
{
    return vec3(a->m[i][0], a->m[i][1], a->m[i][2]);
}

static struct vec3 row_lengths(struct vec3 x, struct vec3 y, struct vec3 z)
{
    return vec3(vec3_length(x), vec3_length(y), vec3_length(z));
}

/* A ball's image reaches as far along an axis as the map's row is long. */
static struct box ellipsoid_box(const struct affine *a, const struct sphere *s)
{
    struct vec3 reach = row_lengths(row(a, 0), row(a, 1), row(a, 2));
    struct vec3 center = affine_point(a, s->center);
    reach = vec3_scale(reach, s->radius);
    return (struct box){vec3_sub(center, reach), vec3_add(center, reach)};
}

/* A disc's, as the part of the row across its normal. */
static struct box elliptic_cylinder_box(const struct affine *a, const struct cylinder *c)
{
    struct vec3 across[3];
    for (int i = 0; i < 3; i++)
        across[i] = vec3_mad(row(a, i), -vec3_dot(row(a, i), c->axis), c->axis);
    struct vec3 reach = vec3_scale(row_lengths(across[0], across[1], across[2]), c->radius);
    struct vec3 base = affine_point(a, c->base);
    struct vec3 top = affine_point(a, vec3_mad(c->base, c->height, c->axis));
    return (struct box){vec3_sub(vec3_min(base, top), reach), vec3_add(vec3_max(base, top), reach)};
}

static struct box image_of_box(const struct affine *a, struct box b)
{
    struct box image = box_empty();
    for (int i = 0; i < 8; i++) {
        struct vec3 corner =
            vec3(i & 1 ? b.hi.x : b.lo.x, i & 2 ? b.hi.y : b.lo.y, i & 4 ? b.hi.z : b.lo.z);
        image = box_add(image, affine_point(a, corner));
    }
    return image;
}

static double box_reach(struct box b)
{
    return fmax(vec3_largest(b.lo), vec3_largest(b.hi));
}

static void place_shape(struct instance *i, struct prototype *p)
{
    const struct geometry *g = &p->shapes;
    double reach;
    if (i->only == PRIM_NONE) {
        if (!(p->box.lo.x <= p->box.hi.x))
            p->box = geometry_bounds(g);
        i->box = image_of_box(&i->to_world, p->box);
        reach = box_reach(p->box);
    } else {
        struct prim prim = g->prims.at[i->only];
        i->box = prim.kind == PRIM_SPHERE
                     ? ellipsoid_box(&i->to_world, &g->spheres.at[prim.index])
                     : elliptic_cylinder_box(&i->to_world, &g->cylinders.at[prim.index]);
        reach = box_reach(geometry_prim_bounds(g, i->only));
    }
    i->growth = row_norm(&i->to_shape);
    i->reach = product_norm(&i->to_shape, &i->to_world) * reach;
}

bool geometry_add_instance(struct geometry *g, uint32_t surface, uint32_t prototype, uint32_t only,
                           const struct affine *to_world)
{
    struct instance i = {.to_world = *to_world, .prototype = prototype, .only = only};
    if (!affine_invert(to_world, &i.to_shape))
        return false;
    place_shape(&i, g->prototypes.at[prototype]);
    if (!isfinite(box_reach(i.box)))
        return false;
    g->worst_growth = fmax(g->worst_growth, product_norm(to_world, &i.to_shape));
    geometry_add_prim(g, PRIM_INSTANCE, g->instances.n, surface);
    vec_push(&g->instances, i);
    return true;
}

/* ---- rays ------------------------------------------------------------------------------------ */

struct inner_ray instance_ray(const struct instance *i, const struct ray *ray, double t_max)
{
    struct inner_ray inner = {.ray = {.origin = affine_point(&i->to_shape, ray->origin),
                                      .direction = affine_vector(&i->to_shape, ray->direction),
                                      .t_max = t_max,
                                      .from = PRIM_NONE,
                                      .surface = SURFACE_NONE,
                                      .spawned = ray->spawned}};
    inner.frame = ray_frame_of(&inner.ray);
    if (ray->spawned)
        inner.frame.reach = i->growth * vec3_largest(ray->origin) + i->reach;
    return inner;
}

bool instance_offer(const struct instance *i, uint32_t prim, const struct hit *inner,
                    struct hit *best)
{
    if (inner->prim == PRIM_NONE)
        return false;
    return target_offer(inner->t, prim, i->only == PRIM_NONE ? inner->prim : inner->part, best);
}

bool instance_intersect(const struct geometry *g, uint32_t prim, const struct ray *ray,
                        struct hit *best)
{
    const struct instance *i = instance_at(g, prim);
    const struct geometry *shapes = shapes_of(g, i);
    struct inner_ray inner = instance_ray(i, ray, best->t);
    struct hit hit = hit_none(best->t);
    if (i->only != PRIM_NONE)
        geometry_intersect(shapes, i->only, &inner.ray, &inner.frame, &hit);
    for (uint32_t k = 0; i->only == PRIM_NONE && k < shapes->prims.n; k++)
        geometry_intersect(shapes, k, &inner.ray, &inner.frame, &hit);
    return instance_offer(i, prim, &hit, best);
}

/* ---- the shape's row of geometry.c ----------------------------------------------------------- */

struct box instance_bounds(const struct geometry *g, uint32_t prim)
{
    return instance_at(g, prim)->box;
}

bool instance_lies_on(const struct geometry *g, uint32_t prim, struct vec3 p, double reach)
{
    const struct instance *i = instance_at(g, prim);
    const struct geometry *shapes = shapes_of(g, i);
    struct vec3 inner = affine_point(&i->to_shape, p);
    reach = i->growth * reach + i->reach;
    if (i->only != PRIM_NONE)
        return geometry_lies_on(shapes, i->only, inner, reach);
    for (uint32_t k = 0; k < shapes->prims.n; k++)
        if (geometry_lies_on(shapes, k, inner, reach))
            return true;
    return false;
}

struct vec3 instance_hit_point(const struct geometry *g, const struct ray *ray,
                               const struct hit *hit, struct vec3 *normal)
{
    struct spot spot = geometry_spot(g, hit);
    const struct instance *i = spot.instance;
    struct inner_ray inner = instance_ray(i, ray, hit->t);
    struct hit inner_hit = {.t = hit->t, .prim = spot.prim, .part = spot.part};
    struct vec3 p = geometry_hit_point(spot.geometry, &inner.ray, &inner_hit, normal);
    if (spot.geometry->prims.at[spot.prim].kind == PRIM_TRIANGLE)
        p = triangle_settle(spot.geometry, spot.prim, p,
                            i->growth * vec3_largest(affine_point(&i->to_world, p)) + i->reach);
    *normal = affine_normal(&i->to_shape, *normal);
    *normal = vec3_largest(*normal) > 0 ? vec3_normalize(*normal) : *normal;
    return affine_point(&i->to_world, p);
}
