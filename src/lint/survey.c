#include "config.h"

#include "lint/survey.h"

struct analysed {
    bool tried;
    const char *reason; /* it could not be done */
    struct mesh_report report;
};

struct survey {
    const struct desc *desc;
    const struct lowered *lowered;
    const struct scene *scene; /* &lowered->scene */
    struct accel accel;
    bool has_accel;
    struct box *boxes; /* by surface; NULL: not asked for so far */
    struct box bounds;
    struct analysed *meshes; /* by file; likewise */
};

struct survey *survey_new(const struct desc *desc, const struct lowered *lowered)
{
    struct survey *s = mem_zalloc(1, sizeof *s);
    s->desc = desc;
    s->lowered = lowered;
    s->scene = &lowered->scene;
    return s;
}

void survey_free(struct survey *s)
{
    if (s->has_accel)
        accel_free(&s->accel);
    free(s->boxes);
    free(s->meshes);
    free(s);
}

const struct accel *survey_accel(struct survey *s)
{
    if (!s->has_accel)
        accel_build(&s->accel, &s->scene->geometry, false);
    s->has_accel = true;
    return &s->accel;
}

/* A surface without primitives has the empty box. */
const struct box *survey_boxes(struct survey *s)
{
    const struct scene *scene = s->scene;
    if (s->boxes)
        return s->boxes;
    s->boxes = mem_alloc(scene->surfaces.n, sizeof *s->boxes);
    s->bounds = box_empty();
    for (size_t i = 0; i < scene->surfaces.n; i++) {
        const struct surface *surface = &scene->surfaces.at[i];
        struct box box = box_empty();
        for (uint32_t k = 0; k < surface->prim_count; k++)
            box = box_join(box, geometry_prim_bounds(&scene->geometry, surface->first_prim + k));
        s->boxes[i] = box;
        s->bounds = box_join(s->bounds, box);
    }
    return s->boxes;
}

struct box survey_bounds(struct survey *s)
{
    survey_boxes(s);
    return s->bounds;
}

const struct mesh_report *survey_mesh(struct survey *s, uint32_t number)
{
    const struct mesh *m = s->lowered->meshes.at[number].mesh;
    if (!s->meshes)
        s->meshes = mem_zalloc(s->lowered->meshes.n, sizeof *s->meshes);
    struct analysed *a = &s->meshes[number];
    if (!a->tried && m)
        a->reason =
            openmesh_analyse(m->points.at, m->points.n, m->faces.at, m->faces.n, &a->report);
    a->tried = true;
    return m && !a->reason ? &a->report : NULL;
}

bool survey_is_closed(const struct mesh_report *r)
{
    return r->boundary_edges == 0 && r->non_manifold_faces == 0 && r->volume != 0;
}

const struct desc_object *survey_object(const struct survey *s, uint32_t surface)
{
    return s->desc->surfaces.at[s->scene->surfaces.at[surface].described];
}

const struct material *survey_material(const struct survey *s, uint32_t surface)
{
    return &s->scene->materials.at[s->scene->surfaces.at[surface].material];
}

bool survey_is_opaque(const struct survey *s, uint32_t surface)
{
    const struct material *m = survey_material(s, surface);
    return m->kind != MATERIAL_EMISSIVE && vec3_is_zero(m->refraction);
}

bool survey_bounces(const struct survey *s, uint32_t surface)
{
    const struct material *m = survey_material(s, surface);
    return !vec3_is_zero(m->reflection) || !vec3_is_zero(m->refraction);
}

/* ---- what is inside what --------------------------------------------------------------------- */

static bool box_holds(struct box b, struct vec3 p)
{
    return p.x > b.lo.x && p.y > b.lo.y && p.z > b.lo.z && p.x < b.hi.x && p.y < b.hi.y &&
           p.z < b.hi.z;
}

static bool solid_holds(const struct geometry *g, uint32_t prim, struct vec3 p)
{
    struct prim kind = g->prims.at[prim];
    if (kind.kind == PRIM_SPHERE) {
        const struct sphere *s = &g->spheres.at[kind.index];
        return vec3_length(vec3_sub(p, s->center)) < s->radius;
    }
    const struct cylinder *c = &g->cylinders.at[kind.index];
    struct vec3 m = vec3_sub(p, c->base);
    double along = vec3_dot(m, c->axis);
    return along > 0 && along < c->height && vec3_length(vec3_mad(m, -along, c->axis)) < c->radius;
}

/* Whether the ray's first hit on the mesh is from inside.  Copies of a mesh that are mirrored have
 * turned over faces; lowering turns their normals back by `flip`, instances keep theirs. */
static bool leaves_mesh(struct survey *s, uint32_t number, const struct mesh_report *r,
                        struct vec3 p, struct vec3 direction)
{
    const struct surface *surface = &s->scene->surfaces.at[number];
    bool flipped = desc_number(survey_object(s, number), PROP_FLIP_NORMALS) != 0;
    bool outwards = (r->volume > 0) == (surface->flip == flipped);
    struct ray ray = {.origin = p,
                      .direction = direction,
                      .t_max = RAY_UNBOUNDED,
                      .from = PRIM_NONE,
                      .surface = number};
    struct hit hit;
    struct vec3 normal;
    if (!accel_closest(survey_accel(s), &ray, &hit))
        return false;
    geometry_hit_point(&s->scene->geometry, &ray, &hit, &normal);
    return (vec3_dot(normal, direction) > 0) == outwards;
}

/* Ways that no scene is built along. */
static const struct vec3 ways[3] = {
    {0.3711, 0.7853, -0.4957}, {-0.8439, 0.1717, 0.5084}, {0.1931, -0.6287, -0.7533}};

static bool mesh_holds(struct survey *s, uint32_t surface, struct vec3 p)
{
    const struct mesh_report *r = survey_mesh(s, s->scene->surfaces.at[surface].mesh_file);
    if (!r || !survey_is_closed(r))
        return false;
    for (int i = 0; i < 3; i++)
        if (!leaves_mesh(s, surface, r, p, ways[i]))
            return false;
    return true;
}

bool survey_holds(struct survey *s, uint32_t number, struct vec3 p)
{
    const struct surface *surface = &s->scene->surfaces.at[number];
    const struct geometry *g = &s->scene->geometry;
    uint32_t prim = surface->first_prim;
    if (!box_holds(survey_boxes(s)[number], p))
        return false;
    if (surface->kind == SURFACE_MESH)
        return mesh_holds(s, number, p);
    if ((surface->kind != SURFACE_SPHERE && surface->kind != SURFACE_CYLINDER) ||
        surface->prim_count != 1) /* the needles that show normals are many */
        return false;
    struct prim kind = g->prims.at[prim];
    if (kind.kind != PRIM_INSTANCE)
        return solid_holds(g, prim, p);
    const struct instance *i = &g->instances.at[kind.index];
    return solid_holds(&g->prototypes.at[i->prototype]->shapes, i->only,
                       affine_point(&i->to_shape, p));
}

static bool is_new(const uint32_t *seen, unsigned n, uint32_t surface)
{
    for (unsigned i = 0; i < n; i++)
        if (seen[i] == surface)
            return false;
    return true;
}

/* Whatever holds the point is met by any ray from there. */
unsigned survey_around(struct survey *s, struct vec3 p, uint32_t surfaces[SURVEY_AROUND])
{
    enum { STEPS = 64 };
    const struct accel *a = survey_accel(s);
    struct ray ray = {.origin = p,
                      .direction = ways[0],
                      .t_max = RAY_UNBOUNDED,
                      .from = PRIM_NONE,
                      .surface = SURFACE_NONE};
    uint32_t seen[STEPS];
    unsigned n = 0;
    struct hit hit;
    for (unsigned i = 0; i < STEPS && n < SURVEY_AROUND && accel_closest(a, &ray, &hit); i++) {
        uint32_t surface = seen[i] = s->scene->geometry.prims.at[hit.prim].surface;
        if (is_new(seen, i, surface) && survey_is_opaque(s, surface) && survey_holds(s, surface, p))
            surfaces[n++] = surface;
        ray.origin = vec3_mad(ray.origin, hit.t, ray.direction);
        ray.from = hit.prim;
        ray.spawned = true;
    }
    return n;
}

const struct vec3 *survey_light_place(const struct light *light, size_t n)
{
    if (light->samples.n)
        return n < light->samples.n ? &light->samples.at[n].position : NULL;
    if (n == 0)
        return light->kind == LIGHT_SUN ? NULL : &light->position;
    return n <= light->points.n ? &light->points.at[n - 1].position : NULL;
}

/* Classic shadow rays to a sample go on for as far as the light's position is. */
struct box survey_light_box(const struct light *light)
{
    if (light->samples.n)
        return geometry_bounds(&light->object);
    struct box box = {light->position, light->position};
    for (size_t i = 0; i < light->points.n; i++)
        box = box_add(box, light->points.at[i].position);
    struct vec3 reach = vec3_all(vec3_length(vec3_sub(box.hi, box.lo)));
    return (struct box){vec3_sub(box.lo, reach), vec3_add(box.hi, reach)};
}
