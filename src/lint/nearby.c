#include "config.h"

#include "lint/nearby.h"

/* ---- distances ------------------------------------------------------------------------------- */

static double sphere_gap(const struct sphere *s, struct vec3 p)
{
    return fabs(vec3_length(vec3_sub(p, s->center)) - s->radius);
}

/* Inside it is the nearer of side and cap. */
static double cylinder_gap(const struct cylinder *c, struct vec3 p)
{
    struct vec3 m = vec3_sub(p, c->base);
    double along = vec3_dot(m, c->axis);
    double side = vec3_length(vec3_mad(m, -along, c->axis)) - c->radius;
    double cap = fmax(-along, along - c->height);
    if (side <= 0 && cap <= 0)
        return fmin(-side, -cap);
    return hypot(fmax(side, 0), fmax(cap, 0));
}

static double segment_gap(struct vec3 p, struct vec3 a, struct vec3 b)
{
    struct vec3 along = vec3_sub(b, a);
    double square = vec3_dot(along, along);
    double t = square > 0 ? vec3_dot(vec3_sub(p, a), along) / square : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return vec3_length(vec3_sub(p, vec3_mad(a, t, along)));
}

/* That of its plane above the triangle, that of its edges elsewhere. */
static double triangle_gap(const struct geometry *g, const struct triangle *t, struct vec3 p)
{
    double gap = INFINITY;
    bool above = !vec3_is_zero(t->normal);
    for (int i = 0; i < 3; i++) {
        struct vec3 a = g->vertices.at[t->vertex[i]], b = g->vertices.at[t->vertex[(i + 1) % 3]];
        struct vec3 inwards = vec3_cross(t->normal, vec3_sub(b, a));
        above &= vec3_dot(vec3_sub(p, a), inwards) >= 0;
        gap = fmin(gap, segment_gap(p, a, b));
    }
    if (above)
        gap = fabs(vec3_dot(vec3_sub(p, g->vertices.at[t->vertex[0]]), t->normal));
    return gap;
}

static double prim_gap(const struct geometry *g, uint32_t prim, struct vec3 p)
{
    struct prim kind = g->prims.at[prim];
    if (kind.kind == PRIM_SPHERE)
        return sphere_gap(&g->spheres.at[kind.index], p);
    if (kind.kind == PRIM_CYLINDER)
        return cylinder_gap(&g->cylinders.at[kind.index], p);
    return triangle_gap(g, &g->triangles.at[kind.index], p);
}

double nearby_gap(struct box b, struct vec3 p)
{
    struct vec3 d = vec3_max(vec3_sub(b.lo, p), vec3_sub(p, b.hi));
    return vec3_length(vec3_max(d, vec3_all(0)));
}

/* ---- the search ------------------------------------------------------------------------------ */

struct search {
    struct vec3 p;
    double distance;
    uint32_t surface; /* or SURFACE_NONE: any */
    bool boxes;       /* a primitive's box will do */
    uint32_t found;
};

static void search_tree(const struct accel *a, struct search *s);

static bool is_near_instance(const struct accel *a, const struct instance *i,
                             const struct search *s)
{
    struct search inner = {.p = affine_point(&i->to_shape, s->p),
                           .distance = s->distance * i->growth,
                           .surface = SURFACE_NONE,
                           .found = PRIM_NONE};
    const struct accel *shapes = &a->prototypes[i->prototype];
    if (i->only != PRIM_NONE)
        return prim_gap(shapes->geometry, i->only, inner.p) <= inner.distance;
    search_tree(shapes, &inner);
    return inner.found != PRIM_NONE;
}

static bool is_near(const struct accel *a, struct target target, const struct search *s)
{
    const struct geometry *g = a->geometry;
    if (nearby_gap(geometry_prim_bounds(g, target.prim), s->p) > s->distance)
        return false;
    if (s->boxes)
        return true;
    if (target.kind == PRIM_INSTANCE)
        return is_near_instance(a, &g->instances.at[target.index], s);
    return prim_gap(g, target.prim, s->p) <= s->distance;
}

static void search_run(const struct accel *a, uint32_t first, uint32_t count, struct search *s)
{
    for (uint32_t i = first; i < first + count; i++) {
        struct target target = a->targets[i];
        bool wanted =
            s->surface == SURFACE_NONE || a->geometry->prims.at[target.prim].surface == s->surface;
        if (wanted && target.prim < s->found && is_near(a, target, s))
            s->found = target.prim;
    }
}

static struct box child_box(const struct bvh_node *node, int child)
{
    const double(*b)[3] = node->plane[child];
    return (struct box){{b[0][0], b[0][1], b[0][2]}, {b[1][0], b[1][1], b[1][2]}};
}

static void search_tree(const struct accel *a, struct search *s)
{
    uint32_t stack[BVH_DEPTH_LIMIT + 1] = {0};
    int depth = 1;
    if (!a->nodes) {
        search_run(a, 0, a->target_count, s);
        return;
    }
    while (depth > 0 && !(s->boxes && s->found != PRIM_NONE)) {
        const struct bvh_node *node = &a->nodes[stack[--depth]];
        for (int child = 0; child < 2; child++) {
            if (nearby_gap(child_box(node, child), s->p) > s->distance)
                continue;
            if (node->count[child] > 0)
                search_run(a, node->first[child], node->count[child], s);
            else
                stack[depth++] = node->first[child];
        }
    }
}

uint32_t nearby_prim(const struct accel *a, struct vec3 p, double distance, uint32_t surface)
{
    struct search s = {.p = p, .distance = distance, .surface = surface, .found = PRIM_NONE};
    search_tree(a, &s);
    return s.found;
}

bool nearby_box(const struct accel *a, struct vec3 p, double distance)
{
    struct search s = {
        .p = p, .distance = distance, .surface = SURFACE_NONE, .boxes = true, .found = PRIM_NONE};
    search_tree(a, &s);
    return s.found != PRIM_NONE;
}
