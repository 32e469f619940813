/* Lights that weaken with distance and are too far from everything. */
#include "config.h"

#include "lint/checks.h"
#include "lint/nearby.h"
#include "lint/survey.h"

/* Whether any surface may get this much of it.  Mostly one of the first does; the tree is made when
 * none of these did. */
static bool reaches(const struct lint *l, const struct light *light, double least)
{
    enum { FIRST = 64 };
    const struct box *boxes = survey_boxes(l->survey);
    struct box box = survey_light_box(light);
    struct vec3 center = box_center(box);
    double far = sqrt(vec3_largest(light->intensity) / least);
    far += vec3_length(vec3_sub(box.hi, center));
    for (size_t i = 0; i < FIRST && i < l->lowered->scene.surfaces.n; i++)
        if (nearby_gap(boxes[i], center) <= far)
            return true;
    return nearby_box(survey_accel(l->survey), center, far);
}

static bool is_faint(const struct lint *l, const struct light *light, double least)
{
    return light->kind != LIGHT_SUN && light->inverse_square && !vec3_is_zero(light->intensity) &&
           !reaches(l, light, least);
}

/* Many faint lights together may be bright: they are told when all of them as strong as one were
 * not. */
void lint_faint_lights(const struct lint *l)
{
    const struct scene *s = &l->lowered->scene;
    size_t n = 0;
    for (size_t i = 0; s->surfaces.n && i < s->lights.n; i++)
        n += is_faint(l, &s->lights.at[i], LINT(FAINT_LIGHT));
    for (size_t i = 0; n && i < s->lights.n; i++) {
        const struct desc_object *o = l->desc->lights.at[i];
        if (!is_faint(l, &s->lights.at[i], LINT(FAINT_LIGHT) / (double)n))
            continue;
        l->diag->frame = o->frame;
        struct diag_entry *e =
            diag_report(l->diag, DIAG_FAINT_LIGHT, o->span,
                        "the light is too far from all surfaces to light any of them: it "
                        "weakens with the square of the distance");
        diag_note(e, "at a distance of 10 an intensity of 100 is what 1 is without falloff");
    }
    l->diag->frame = NULL;
}
