/* How large things are, and how far out. */
#include "config.h"

#include "lint/checks.h"
#include "lint/survey.h"

/* The surface that is the extreme of something. */
struct extreme {
    double value;
    uint32_t surface;
};

static struct extreme most(struct extreme e, double value, uint32_t surface)
{
    return value > e.value ? (struct extreme){value, surface} : e;
}

static struct extreme least(struct extreme e, double value, uint32_t surface)
{
    return value < e.value ? (struct extreme){value, surface} : e;
}

/* Of a cylinder its height or thickness, else the longest side of the surface's box. */
static double size_of(const struct scene *s, uint32_t number, struct box box)
{
    const struct surface *surface = &s->surfaces.at[number];
    struct prim prim = s->geometry.prims.at[surface->first_prim];
    if (surface->prim_count == 1 && prim.kind == PRIM_CYLINDER) {
        const struct cylinder *c = &s->geometry.cylinders.at[prim.index];
        return fmin(c->height, 2 * c->radius);
    }
    return vec3_largest(vec3_sub(box.hi, box.lo));
}

static struct diag_entry *report(const struct lint *l, enum diag_code code, struct extreme e,
                                 const char *format)
{
    const struct desc_object *o = survey_object(l->survey, e.surface);
    l->diag->frame = o->frame;
    struct diag_entry *entry = diag_report(l->diag, code, o->span, "this %s %s %.3g",
                                           schema_kind_name(o->kind, o->xml), format, e.value);
    l->diag->frame = NULL;
    return entry;
}

void lint_scale(const struct lint *l)
{
    const struct scene *s = &l->lowered->scene;
    const struct box *boxes = survey_boxes(l->survey);
    struct extreme farthest = {0, 0}, largest = {0, 0}, smallest = {INFINITY, 0};
    for (uint32_t i = 0; i < s->surfaces.n; i++) {
        if (!s->surfaces.at[i].prim_count)
            continue;
        farthest = most(farthest, fmax(vec3_largest(boxes[i].lo), vec3_largest(boxes[i].hi)), i);
        largest = most(largest, vec3_largest(vec3_sub(boxes[i].hi, boxes[i].lo)), i);
        smallest = least(smallest, size_of(s, i, boxes[i]), i);
    }
    if (farthest.value > LINT(HUGE_COORDINATE))
        diag_note(report(l, DIAG_HUGE_COORDINATES, farthest, "reaches coordinates of"),
                  "the rounding errors of everything there are that much larger, too");
    if (smallest.value < LINT(TINY_SIZE))
        diag_note(report(l, DIAG_TINY_FEATURES, smallest, "has a size of"),
                  "nobody will see it, unless the unit is a very large one");
    if (largest.value > LINT(SCALE_RATIO) * smallest.value)
        diag_label(report(l, DIAG_MIXED_SCALE, smallest, "is the smallest surface, of size"),
                   survey_object(l->survey, largest.surface)->span,
                   "the largest has a size of %.3g", largest.value);
}
