/* The camera. */
#include "config.h"

#include "lint/checks.h"

#include <math.h>

/* The full vertical angle in degrees; 0: the rays are parallel.  Classic's number is half of a
 * horizontal one, for a picture as wide as high. */
static double vertical_angle(const struct desc_object *o)
{
    struct vec3 size = desc_vector(o, PROP_RESOLUTION);
    if (o->model == SCHEMA_MODERN)
        return desc_get(o, PROP_FOV) ? desc_number(o, PROP_FOV) : 0;
    double shape = size.x / size.y;
    double half = tan(desc_number(o, PROP_YFOV) * (PI / 180) * shape) / shape;
    return 2 * atan(half) * (180 / PI);
}

/* A right angle in radians is 1.57. */
static void check_unit(const struct lint *l, const struct desc_object *o)
{
    const struct desc_value *fov = lint_own(o, PROP_FOV);
    if (!fov || fov->number[0] >= LINT(LEAST_DEGREES))
        return;
    struct str text = srcmap_text(l->sources, fov->span);
    if (!lint_is_spelt_out(text))
        return;
    struct diag_entry *e =
        diag_report(l->diag, DIAG_FOV_IN_RADIANS, fov->span,
                    "a field of view of %.4g degrees is next to nothing", fov->number[0]);
    diag_note(e, "numbers without a unit are degrees: %.*srad is %.4g of them", STR_ARG(text),
              fov->number[0] * (180 / PI));
}

void lint_view(const struct lint *l)
{
    const struct desc_object *o = l->desc->camera;
    if (!o)
        return; /* a part of scenes */
    enum schema_prop_id id = o->model == SCHEMA_MODERN ? PROP_FOV : PROP_YFOV;
    double angle = vertical_angle(o);
    if (angle > 0 && (angle > LINT(WIDEST_VIEW) || angle < LINT(NARROWEST_VIEW)))
        diag_report(l->diag, DIAG_EXTREME_FOV, lint_place(o, id),
                    "the picture shows %.4g degrees from bottom to top, which %s", angle,
                    angle < LINT(NARROWEST_VIEW) ? "leaves almost nothing to see"
                                                 : "draws out whatever is near its edges");
    else
        check_unit(l, o);
    struct vec3 size = desc_vector(o, PROP_RESOLUTION);
    double longer = fmax(size.x, size.y), shorter = fmin(size.x, size.y);
    if (longer / shorter > LINT(LONGEST_PICTURE))
        diag_report(l->diag, DIAG_RESOLUTION_ASPECT, lint_place(o, PROP_RESOLUTION),
                    "the picture is %.4g times as %s as it is %s", longer / shorter,
                    size.x > size.y ? "wide" : "high", size.x > size.y ? "high" : "wide");
}
