/* What is rendered: by the scene and the options, and in words. */
#include "config.h"

#include "cmd/render_run.h"

#include "scene/fingerprint.h"

#include <string.h>

/* What validation asks of the scene's own resolution; 0 or an exit status. */
static int check_field_of_view(const struct camera *c, uint32_t width, uint32_t height)
{
    bool same = (uint64_t)width * c->height == (uint64_t)height * c->width;
    if (same || c->yfov * width / height < 90)
        return 0;
    return usage_error(
        "--res: %u x %u is too wide for the scene's field of view: %.6g degrees times "
        "width over height must be below 90",
        width, height, c->yfov);
}

/* Size and crop of the picture; 0 or an exit status. */
static int choose_size(struct render_run *r)
{
    const struct options *o = r->options;
    const struct camera *c = &r->lowered.scene.camera;
    struct render_options *to = &r->render;
    to->width = o->width ? o->width : c->width;
    to->height = o->height ? o->height : c->height;
    to->crop.x1 = to->width;
    to->crop.y1 = to->height;
    int status = check_field_of_view(c, to->width, to->height);
    if (!o->cropped || status != 0)
        return status;
    if (o->crop[2] > to->width || o->crop[3] > to->height)
        return usage_error("--crop reaches beyond the picture of %u x %u", to->width, to->height);
    to->crop.x0 = o->crop[0];
    to->crop.y0 = o->crop[1];
    to->crop.x1 = o->crop[2];
    to->crop.y1 = o->crop[3];
    return 0;
}

/* What adaptive sampling cannot be combined with; 0 or an exit status. */
static int check_sampling(const struct options *o, const struct scene *scene)
{
    enum { MOST_CELLS = 16 };
    bool power_of_two = (o->grid & (o->grid - 1)) == 0;
    if (o->adaptive > 0 && (!power_of_two || o->grid > MOST_CELLS))
        return usage_error("-s is 1, 2, 4, 8 or 16 with --adaptive and --time, not %u", o->grid);
    if (o->adaptive > 0 && o->jitter && scene->model == SCENE_CLASSIC)
        return usage_error("--adaptive places its samples itself, and in a classic scene --jitter "
                           "moves nothing else");
    if (o->adaptive > 0 && o->show != SHOW_PICTURE && o->show != SHOW_SAMPLES)
        return usage_error(
            "--show takes one sample a pixel; of --adaptive and --time, only samples are shown");
    if (o->exposure != 0 && o->show != SHOW_PICTURE)
        return usage_error("--exposure is of light, and --show shows none");
    if (!(o->adaptive > 0) && o->show == SHOW_SAMPLES)
        return usage_error(
            "--show samples tells what --adaptive or --time does, and neither is given");
    return 0;
}

static void choose_sampling(struct render_run *r)
{
    const struct options *o = r->options;
    struct render_options *to = &r->render;
    to->grid = o->grid ? o->grid : o->adaptive > 0 ? 1 : r->lowered.scene.grid;
    to->adaptive = o->adaptive;
    to->jitter = o->jitter;
    to->seed = o->seed;
    to->depth = o->depth != DEPTH_OF_SCENE ? o->depth : r->lowered.scene.depth;
    to->threads = o->threads;
    to->show = o->show;
    to->brute_force = o->brute_force;
    to->no_skip = o->no_skip;
    to->prune = o->prune;
    to->isa = o->isa;
}

int render_choose(struct render_run *r)
{
    int status = choose_size(r);
    if (status == 0)
        status = check_sampling(r->options, &r->lowered.scene);
    if (status != 0)
        return status;
    choose_sampling(r);
    r->tiling = tiling_of(0, 0, r->render.crop.x1 - r->render.crop.x0,
                          r->render.crop.y1 - r->render.crop.y0);
    return 0;
}

/* Everything on the command line that can change a byte, and nothing else. */
static void put_settings(struct buffer *b, const struct render_run *r)
{
    static const char *const shows[] = {[SHOW_NORMALS] = "normals",
                                        [SHOW_DEPTH] = "depth",
                                        [SHOW_IDS] = "ids",
                                        [SHOW_SAMPLES] = "samples"};
    const struct render_options *o = &r->render;
    buffer_printf(b, "%ux%u", o->width, o->height);
    if (r->options->cropped)
        buffer_printf(b, " crop %u,%u,%u,%u", o->crop.x0, o->crop.y0, o->crop.x1, o->crop.y1);
    buffer_printf(b, " samples %u", o->grid);
    if (o->adaptive > 0) {
        buffer_puts(b, " adaptive ");
        buffer_number(b, o->adaptive);
    }
    buffer_printf(b, "%s seed %llu depth %u%s", o->jitter ? " jitter" : "",
                  (unsigned long long)o->seed, o->depth, o->prune ? " prune" : "");
    if (o->show != SHOW_PICTURE)
        buffer_printf(b, " show %s", shows[o->show]);
    if (r->options->exposure != 0) {
        buffer_puts(b, " exposure ");
        buffer_number(b, r->options->exposure);
    }
    buffer_add(b, "", 1);
}

void render_fill_head(struct render_run *r)
{
    struct tilefile_head *h = &r->head;
    struct buffer settings = {0};
    *h = (struct tilefile_head){.version = PACKAGE_VERSION,
                                .scene = scene_fingerprint(&r->lowered.scene),
                                .width = r->picture->width,
                                .height = r->picture->height,
                                .depth = picture_depth_of(r->picture),
                                .encoding = r->picture->encoding,
                                .part = r->options->part,
                                .parts = r->options->parts};
    put_settings(&settings, r);
    strncpy(h->settings, settings.at, sizeof h->settings - 1);
    buffer_free(&settings);
}
