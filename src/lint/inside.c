/* Eyes and lights inside of things, and lights on them. */
#include "config.h"

#include "lint/checks.h"
#include "lint/nearby.h"
#include "lint/survey.h"

static const char *kind_name(const struct desc_object *o)
{
    return schema_kind_name(o->kind, o->xml);
}

static struct span place_of(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_value *value = desc_get(o, id);
    return value ? value->span : o->span;
}

static bool holds_light(const struct lint *l, uint32_t surface, const struct light *light)
{
    const struct vec3 *place = survey_light_place(light, 0);
    for (size_t i = 0; place; place = survey_light_place(light, ++i))
        if (!survey_holds(l->survey, surface, *place))
            return false;
    return survey_light_place(light, 0) != NULL;
}

/* Who is inside together with a light is in a room.  The original's spheres and cylinders are black
 * from inside, whatever lights them. */
static bool is_room(const struct lint *l, uint32_t surface)
{
    const struct scene *s = &l->lowered->scene;
    if (s->model == SCENE_CLASSIC && s->surfaces.at[surface].kind != SURFACE_MESH)
        return false;
    if (!survey_holds(l->survey, surface, s->camera.origin))
        return false;
    for (size_t i = 0; i < s->lights.n; i++)
        if (holds_light(l, surface, &s->lights.at[i]))
            return true;
    return false;
}

/* Forgets those that are rooms; returns how many are left. */
static unsigned without_rooms(const struct lint *l, unsigned n, uint32_t surfaces[SURVEY_AROUND])
{
    unsigned kept = 0;
    for (unsigned i = 0; i < n; i++)
        if (!is_room(l, surfaces[i]))
            surfaces[kept++] = surfaces[i];
    return kept;
}

static void label_around(const struct lint *l, struct diag_entry *e, unsigned n,
                         const uint32_t surfaces[SURVEY_AROUND])
{
    for (unsigned i = 0; i < n; i++) {
        const struct desc_object *o = survey_object(l->survey, surfaces[i]);
        diag_label(e, o->span, "it is inside this %s", kind_name(o));
    }
}

void lint_camera_inside(const struct lint *l)
{
    uint32_t around[SURVEY_AROUND];
    unsigned n = survey_around(l->survey, l->lowered->scene.camera.origin, around);
    n = without_rooms(l, n, around);
    if (n)
        label_around(l,
                     diag_report(l->diag, DIAG_CAMERA_INSIDE, place_of(l->desc->camera, PROP_EYE),
                                 "the eye is inside something opaque, so nothing else is seen"),
                     n, around);
}

/* Forgets those that do not hold all of the light. */
static unsigned without_partial(const struct lint *l, const struct light *light, unsigned n,
                                uint32_t surfaces[SURVEY_AROUND])
{
    unsigned kept = 0;
    for (unsigned i = 0; i < n; i++)
        if (holds_light(l, surfaces[i], light))
            surfaces[kept++] = surfaces[i];
    return kept;
}

static void look_at_light(const struct lint *l, const struct light *light,
                          const struct desc_object *o)
{
    uint32_t around[SURVEY_AROUND];
    const struct vec3 *place = vec3_is_zero(light->intensity) ? NULL : survey_light_place(light, 0);
    unsigned n = place ? survey_around(l->survey, *place, around) : 0;
    n = without_rooms(l, without_partial(l, light, n, around), around);
    if (n == 0)
        return;
    struct diag_entry *e =
        diag_report(l->diag, DIAG_LIGHT_INSIDE, place_of(o, PROP_LIGHT_POSITION),
                    "the light is inside something opaque, which keeps its light in");
    label_around(l, e, n, around);
    diag_note(e, "for a lamp that is seen, use an emissive material, which lets light through");
}

void lint_light_inside(const struct lint *l)
{
    for (size_t i = 0; i < l->desc->lights.n; i++) {
        const struct desc_object *o = l->desc->lights.at[i];
        l->diag->frame = o->frame;
        look_at_light(l, &l->lowered->scene.lights.at[i], o);
    }
    l->diag->frame = NULL;
}

/* ---- lights on surfaces ---------------------------------------------------------------------- */

/* The surface that all places of the light are on, or SURFACE_NONE; what is emissive keeps no light
 * back. */
static uint32_t surface_under(const struct lint *l, const struct light *light, double distance)
{
    const struct accel *a = survey_accel(l->survey);
    const struct geometry *g = a->geometry;
    const struct vec3 *place = survey_light_place(light, 0);
    uint32_t found = SURFACE_NONE;
    for (size_t i = 0; place; place = survey_light_place(light, ++i)) {
        uint32_t prim = nearby_prim(a, *place, distance, found);
        if (prim == PRIM_NONE)
            return SURFACE_NONE;
        found = g->prims.at[prim].surface;
    }
    return found;
}

void lint_light_on_surface(const struct lint *l)
{
    const struct scene *s = &l->lowered->scene;
    struct box bounds = survey_bounds(l->survey);
    double size = vec3_length(vec3_sub(bounds.hi, bounds.lo));
    for (size_t i = 0; s->surfaces.n && i < s->lights.n; i++) {
        const struct desc_object *o = l->desc->lights.at[i];
        uint32_t under = surface_under(l, &s->lights.at[i], size * LINT(LIGHT_DISTANCE));
        if (under == SURFACE_NONE || !survey_is_opaque(l->survey, under) ||
            vec3_is_zero(s->lights.at[i].intensity)) /* told already */
            continue;
        l->diag->frame = o->frame;
        const struct desc_object *surface = survey_object(l->survey, under);
        struct diag_entry *e = diag_report(
            l->diag, DIAG_LIGHT_ON_SURFACE, place_of(o, PROP_LIGHT_POSITION),
            "the light lies on a %s, so rounding decides which side it lights", kind_name(surface));
        diag_label(e, surface->span, "it lies on this");
        diag_note(e, "move it a little to the side that it is meant to light");
    }
    l->diag->frame = NULL;
}
