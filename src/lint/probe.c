/* A small picture of the scene. */
#include "config.h"

#include "lint/checks.h"
#include "lint/frustum.h"
#include "lint/survey.h"
#include "render/render.h"

enum { PROBE = 16 }; /* pixels across and down */

static bool is_black(const struct lint *l, uint32_t grid)
{
    const struct scene *s = &l->lowered->scene;
    struct picture *p = picture_new(PROBE, PROBE, PICTURE_BYTES);
    struct render_stats stats;
    struct render_options o = {.width = PROBE,
                               .height = PROBE,
                               .crop = {0, 0, PROBE, PROBE},
                               .whole_view = true,
                               .grid = grid,
                               .depth = s->depth,
                               .threads = 1,
                               .isa = isa_best()};
    bool black = true;
    picture_encode_as(p, render_encoding(s, SHOW_PICTURE));
    render_scene(s, &o, p, &stats);
    for (int i = 0; i < 3 * PROBE * PROBE; i++)
        black &= p->bytes[i] == 0;
    picture_free(p);
    return black;
}

static bool is_anything_in_view(const struct lint *l)
{
    const struct scene *s = &l->lowered->scene;
    const struct box *boxes = survey_boxes(l->survey);
    struct frustum f = frustum_of(&s->camera);
    for (size_t i = 0; i < s->surfaces.n; i++)
        if (s->surfaces.at[i].prim_count && !frustum_beyond(&f, boxes[i]))
            return true;
    return false;
}

/* Small things are missed by one sample a pixel: what is black by that is looked at more closely.
 * A view of nothing is told of already (unseen.c). */
void lint_black_picture(const struct lint *l)
{
    const struct desc *d = l->desc;
    if (!d->lights.n || !is_anything_in_view(l) || !is_black(l, 1) || !is_black(l, PROBE))
        return;
    struct diag_entry *e =
        diag_report(l->diag, DIAG_BLACK_PICTURE, d->camera->span, "the picture is black");
    diag_note(e, "what is in the view gives no light: look at where the lights are, what stands "
                 "between, and the materials");
}
