/* Textures with more texels than anybody sees. */
#include "config.h"

#include "lint/checks.h"
#include "lint/frustum.h"
#include "lint/survey.h"

/* A texture of the description. */
struct shown {
    const struct desc_object *object; /* NULL: not used */
    const struct image *image;
    double share; /* of the picture that may show it */
};

static void add_use(struct shown *shown, const struct scene *s, const struct desc_value *texture,
                    uint32_t number, double share)
{
    if (!texture || number == TEXTURE_NONE)
        return;
    struct shown *t = &shown[texture->object->number];
    t->object = texture->object;
    t->image = s->textures.at[number].image;
    t->share += share;
}

/* What reflects or refracts in the view may show anything. */
static bool is_direct(const struct lint *l, const struct frustum *f)
{
    const struct box *boxes = survey_boxes(l->survey);
    for (uint32_t i = 0; i < l->lowered->scene.surfaces.n; i++)
        if (survey_bounces(l->survey, i) && !frustum_beyond(f, boxes[i]))
            return false;
    return true;
}

static void find_shown(const struct lint *l, struct shown *shown)
{
    const struct scene *s = &l->lowered->scene;
    const struct box *boxes = survey_boxes(l->survey);
    struct frustum f = frustum_of(&s->camera);
    bool direct = is_direct(l, &f);
    for (uint32_t i = 0; i < s->surfaces.n; i++) {
        const struct surface *surface = &s->surfaces.at[i];
        const struct desc_object *o = survey_object(l->survey, i);
        if (!surface->needs_uv)
            continue;
        double share = direct ? frustum_share(&f, boxes[i]) : 1;
        add_use(shown, s, desc_get(desc_get(o, PROP_MATERIAL)->object, PROP_TEXTURE),
                survey_material(l->survey, i)->texture, share);
        add_use(shown, s, desc_get(o, PROP_NORMAL_MAP), surface->normal_map, share);
    }
}

static void judge(const struct lint *l, const struct shown *t)
{
    const struct scene *s = &l->lowered->scene;
    double texels = (double)t->image->width * t->image->height;
    double samples = fmin(t->share, 1) * s->camera.width * s->camera.height * s->grid * s->grid;
    if (!(texels > LINT(TEXELS_A_SAMPLE) * samples))
        return;
    l->diag->frame = t->object->frame;
    struct span file = desc_get(t->object, PROP_FILE)->span;
    struct diag_entry *e =
        samples > 0 ? diag_report(l->diag, DIAG_LARGE_TEXTURE, file,
                                  "the texture has %u x %u texels, and at most %.0f samples of the "
                                  "picture can show it",
                                  t->image->width, t->image->height, ceil(samples))
                    : diag_report(l->diag, DIAG_LARGE_TEXTURE, file,
                                  "the texture has %u x %u texels, and what has it is out of view",
                                  t->image->width, t->image->height);
    if (samples > 0)
        diag_note(e, "a smaller one is read faster and shows as much");
    l->diag->frame = NULL;
}

void lint_large_textures(const struct lint *l)
{
    size_t n = l->desc->textures.n;
    struct shown *shown = mem_zalloc(n, sizeof *shown);
    find_shown(l, shown);
    for (size_t i = 0; i < n; i++)
        if (shown[i].object)
            judge(l, &shown[i]);
    free(shown);
}
