/* How often lights and pixels are sampled. */
#include "config.h"

#include "lint/checks.h"

static void check_samples(const struct lint *l, const struct desc_object *o)
{
    const struct desc_value *v = lint_own(o, PROP_LIGHT_SAMPLES);
    if (!v)
        return;
    double n = v->number[0];
    if (o->model == SCHEMA_CLASSIC && n < LINT(FEWEST_SAMPLES))
        diag_report(l->diag, DIAG_AREA_LIGHT_FEW_SAMPLES, v->span, "%g samples count as %g", n,
                    LINT(FEWEST_SAMPLES));
    else if (n > LINT(USEFUL_SAMPLES))
        diag_report(l->diag, DIAG_AREA_LIGHT_MANY_SAMPLES, v->span,
                    "%g samples along each side are %g shadow rays at every point that is seen", n,
                    n * n);
}

void lint_light_samples(const struct lint *l)
{
    lint_each_light(l, check_samples);
}

void lint_costs(const struct lint *l)
{
    const struct desc_object *o = l->desc->settings;
    const struct desc_value *samples = o ? lint_own(o, PROP_SAMPLES) : NULL;
    const struct desc_value *depth = o ? lint_own(o, PROP_DEPTH) : NULL;
    if (samples && samples->number[0] > LINT(MOST_SAMPLES))
        diag_report(l->diag, DIAG_COSTLY_SETTINGS, samples->span,
                    "%g samples along each side are %g rays through every pixel",
                    samples->number[0], samples->number[0] * samples->number[0]);
    if (depth && depth->number[0] > LINT(MOST_DEPTH))
        diag_report(l->diag, DIAG_COSTLY_SETTINGS, depth->span,
                    "rays are followed from mirror to mirror up to %g times", depth->number[0]);
}
