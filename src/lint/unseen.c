/* What cannot show: neither directly, nor by its shadow, nor in a mirror.
 *
 * A surface throws no shadow on what is seen when some plane has it on one side, and the lights and
 * all that is seen on the other: one of the sides of the view, or of the box around what is seen.
 */
#include "config.h"

#include "base/map.h"
#include "lint/checks.h"
#include "lint/frustum.h"
#include "lint/survey.h"

/* Planes as bits: the frustum's, then the lower and upper ones of the box. */
enum { BOX_PLANES = FRUSTUM_SIDES, PLANES = FRUSTUM_SIDES + 6 };

struct sight {
    struct frustum frustum;
    struct box seen;              /* of what is within the view, all of it */
    bool has_light[1 << PLANES];  /* some light is within just these planes */
    uint16_t lights[1 << PLANES]; /* the same as a list */
    unsigned light_kinds;
};

static unsigned bit(unsigned plane)
{
    return 1u << plane;
}

/* Bit n: all of the box is beyond plane n. */
static unsigned planes_beyond(const struct sight *s, struct box b)
{
    unsigned planes = frustum_beyond(&s->frustum, b);
    for (int axis = 0; axis < 3; axis++) {
        if (vec3_at(b.hi, axis) < vec3_at(s->seen.lo, axis))
            planes |= bit(BOX_PLANES + 2 * (unsigned)axis);
        if (vec3_at(b.lo, axis) > vec3_at(s->seen.hi, axis))
            planes |= bit(BOX_PLANES + 2 * (unsigned)axis + 1);
    }
    return planes;
}

/* Bit n: the way from what is seen to the light never leaves plane n. */
static unsigned planes_of_light(const struct sight *s, const struct light *light)
{
    bool sun = light->kind == LIGHT_SUN;
    struct box box = sun ? (struct box){light->position, light->position} : survey_light_box(light);
    struct box seen = sun ? (struct box){{0, 0, 0}, {0, 0, 0}} : s->seen;
    unsigned planes =
        sun ? frustum_keeps(&s->frustum, light->position) : frustum_within(&s->frustum, box);
    for (int axis = 0; axis < 3; axis++) {
        if (vec3_at(box.lo, axis) >= vec3_at(seen.lo, axis))
            planes |= bit(BOX_PLANES + 2 * (unsigned)axis);
        if (vec3_at(box.hi, axis) <= vec3_at(seen.hi, axis))
            planes |= bit(BOX_PLANES + 2 * (unsigned)axis + 1);
    }
    return planes;
}

static void add_light(struct sight *s, unsigned planes)
{
    if (!s->has_light[planes])
        s->lights[s->light_kinds++] = (uint16_t)planes;
    s->has_light[planes] = true;
}

/* False when something in view reflects or refracts: it may show anything. */
static bool survey_sight(const struct lint *l, struct sight *s)
{
    const struct scene *scene = &l->lowered->scene;
    const struct box *boxes = survey_boxes(l->survey);
    *s = (struct sight){.frustum = frustum_of(&scene->camera), .seen = box_empty()};
    for (uint32_t i = 0; i < scene->surfaces.n; i++) {
        if (!scene->surfaces.at[i].prim_count || frustum_beyond(&s->frustum, boxes[i]))
            continue;
        if (survey_bounces(l->survey, i))
            return false;
        s->seen = box_join(s->seen, boxes[i]);
    }
    for (size_t i = 0; i < scene->lights.n; i++)
        add_light(s, planes_of_light(s, &scene->lights.at[i]));
    return true;
}

/* What is emissive lets light through. */
static bool may_shade(const struct lint *l, const struct sight *s, uint32_t surface,
                      unsigned planes)
{
    if (survey_material(l->survey, surface)->kind == MATERIAL_EMISSIVE ||
        s->seen.lo.x > s->seen.hi.x)
        return false;
    for (unsigned i = 0; i < s->light_kinds; i++)
        if (!(s->lights[i] & planes))
            return true;
    return false;
}

static void report(const struct lint *l, uint32_t surface, unsigned sides)
{
    static const char *const words[FRUSTUM_SIDES] = {[FRUSTUM_LEFT] = "left of",
                                                     [FRUSTUM_RIGHT] = "right of",
                                                     [FRUSTUM_BELOW] = "below",
                                                     [FRUSTUM_ABOVE] = "above"};
    const struct desc_object *o = survey_object(l->survey, surface);
    const char *name = schema_kind_name(o->kind, o->xml);
    unsigned side = FRUSTUM_LEFT;
    l->diag->frame = o->frame;
    if (sides & bit(FRUSTUM_EYE)) {
        diag_report(l->diag, DIAG_BEHIND_CAMERA, o->span,
                    "this %s is behind the eye, and throws no shadow into the view", name);
    } else {
        while (!(sides & bit(side)))
            side++;
        diag_report(l->diag, DIAG_OUTSIDE_VIEW, o->span,
                    "this %s is %s the view, and throws no shadow into it", name, words[side]);
    }
    l->diag->frame = NULL;
}

/* The sides that all of the surface is beyond; 0 when it may show. */
static unsigned sides_of(const struct lint *l, const struct sight *s, uint32_t surface)
{
    struct box box = survey_boxes(l->survey)[surface];
    unsigned sides = frustum_beyond(&s->frustum, box);
    bool any = l->lowered->scene.surfaces.at[surface].prim_count > 0;
    return any && !may_shade(l, s, surface, planes_beyond(s, box)) ? sides : 0;
}

static struct str place_of(const struct desc_object *o)
{
    return (struct str){(const char *)&o->span, sizeof o->span};
}

/* A statement that makes many surfaces is right as long as one of them shows: a fence that leaves
 * the view is made by one loop.  Those that do are collected here. */
static void find_shown(const struct lint *l, const struct sight *s, struct map *shown)
{
    for (uint32_t i = 0; i < l->lowered->scene.surfaces.n; i++) {
        const struct desc_object *o = survey_object(l->survey, i);
        if (diag_frame_told(o->frame) && !sides_of(l, s, i))
            map_set(shown, place_of(o), shown);
    }
}

void lint_unseen(const struct lint *l)
{
    struct sight *s = mem_alloc(1, sizeof *s);
    struct map shown = {0};
    bool any = true;
    if (survey_sight(l, s) && (any = s->seen.lo.x <= s->seen.hi.x)) {
        find_shown(l, s, &shown);
        for (uint32_t i = 0; i < l->lowered->scene.surfaces.n; i++) {
            unsigned sides = sides_of(l, s, i);
            if (sides && !map_get(&shown, place_of(survey_object(l->survey, i))))
                report(l, i, sides);
        }
    }
    if (!any && l->lowered->scene.surfaces.n) {
        struct diag_entry *e = diag_report(l->diag, DIAG_BLACK_PICTURE, l->desc->camera->span,
                                           "no surface is in the view");
        diag_note(e, "look at where the camera points");
    }
    map_free(&shown);
    free(s);
}
