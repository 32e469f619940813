/* Flat surfaces of classic scenes that show their back.
 *
 * The original does not turn normals towards the eye, and takes cosines below 0 as they are: light
 * on the side that is seen is subtracted.  Some rays tell whether that is what happens. */
#include "config.h"

#include "lint/checks.h"
#include "lint/frustum.h"
#include "lint/survey.h"

/* Lights that are tried, and points of each triangle. */
enum { LIGHTS_TRIED = 64, POINTS_TRIED = 4 };

struct look {
    const struct lint *l;
    struct frustum frustum;
    uint32_t surface, prim;
    struct vec3 normal, corner[3];
};

static void aim_at(struct look *k, uint32_t prim)
{
    const struct geometry *g = &k->l->lowered->scene.geometry;
    const struct triangle *t = &g->triangles.at[g->prims.at[prim].index];
    k->prim = prim;
    k->normal = t->normal;
    for (int i = 0; i < 3; i++)
        k->corner[i] = g->vertices.at[t->vertex[i]];
}

static bool is_behind(const struct look *k, struct vec3 p)
{
    return vec3_dot(k->normal, vec3_sub(p, k->corner[0])) < 0;
}

static struct vec3 point_of(const struct look *k, int number)
{
    static const double near = 0.8, middle = 1.0 / 3;
    struct vec3 p = vec3_all(0);
    for (int i = 0; i < 3; i++)
        p = vec3_mad(p, number == 3 ? middle : i == number ? near : (1 - near) / 2, k->corner[i]);
    return p;
}

static bool is_seen(const struct look *k, struct vec3 p)
{
    struct vec3 eye = k->l->lowered->scene.camera.origin;
    struct ray ray = {.origin = eye,
                      .direction = vec3_sub(p, eye),
                      .t_max = RAY_UNBOUNDED,
                      .from = PRIM_NONE,
                      .surface = SURFACE_NONE};
    struct hit hit;
    return !frustum_beyond(&k->frustum, (struct box){p, p}) &&
           accel_closest(survey_accel(k->l->survey), &ray, &hit) && hit.prim == k->prim;
}

/* The light on the eye's side that the point is lit by, or NULL. */
static const struct light *light_at(const struct look *k, struct vec3 p)
{
    const struct scene *s = &k->l->lowered->scene;
    for (size_t i = 0; i < s->lights.n && i < LIGHTS_TRIED; i++) {
        const struct light *light = &s->lights.at[i];
        struct ray ray = {.origin = p,
                          .direction = vec3_sub(light->position, p),
                          .t_max = 1,
                          .from = k->prim,
                          .surface = SURFACE_NONE,
                          .spawned = true};
        if (is_behind(k, light->position) && !vec3_is_zero(light->intensity) &&
            !accel_any(survey_accel(k->l->survey), &ray))
            return light;
    }
    return NULL;
}

static const struct light *find_light(struct look *k)
{
    const struct surface *surface = &k->l->lowered->scene.surfaces.at[k->surface];
    const struct light *light = NULL;
    for (uint32_t i = 0; i < surface->prim_count; i++) {
        aim_at(k, surface->first_prim + i);
        if (!is_behind(k, k->l->lowered->scene.camera.origin))
            return NULL;
        for (int n = 0; n < POINTS_TRIED && !light; n++)
            if (is_seen(k, point_of(k, n)))
                light = light_at(k, point_of(k, n));
    }
    return light;
}

/* Mirrors look the same from behind, and normal maps have their own normals. */
static bool may_be_turned(const struct lint *l, uint32_t number)
{
    const struct surface *surface = &l->lowered->scene.surfaces.at[number];
    const struct material *m = survey_material(l->survey, number);
    bool flat = surface->kind == SURFACE_TRIANGLE || surface->kind == SURFACE_QUAD;
    return flat && surface->normal_map == TEXTURE_NONE && m->kind != MATERIAL_EMISSIVE &&
           !vec3_is_zero(m->diffuse);
}

static void report(const struct lint *l, uint32_t surface, const struct light *light)
{
    const struct desc_object *o = survey_object(l->survey, surface);
    enum schema_prop_id id = o->kind == KIND_QUAD ? PROP_QUAD_VERTICES : PROP_TRIANGLE_VERTICES;
    l->diag->frame = o->frame;
    struct diag_entry *e =
        diag_report(l->diag, DIAG_BACK_FACING, desc_get(o, id)->span,
                    "this %s shows its back, where classic light darkens in place of lighting",
                    schema_kind_name(o->kind, o->xml));
    diag_label(e, light->span, "this light falls on it");
    diag_note(e, "the normal is (v1 - v0) x (v2 - v0): give the corners the other way round");
    l->diag->frame = NULL;
}

void lint_turned(const struct lint *l)
{
    const struct scene *s = &l->lowered->scene;
    struct look k = {.l = l, .frustum = frustum_of(&s->camera)};
    for (uint32_t i = 0; s->model == SCENE_CLASSIC && i < s->surfaces.n; i++) {
        if (!may_be_turned(l, i) || frustum_beyond(&k.frustum, survey_boxes(l->survey)[i]))
            continue;
        k.surface = i;
        const struct light *light = find_light(&k);
        if (light)
            report(l, i, light);
    }
}
