#include "config.h"

#include "cmd/commands.h"
#include "cmd/frontend.h"
#include "cmd/progress.h"
#include "cmd/stats.h"

#include "base/file.h"
#include "base/thread.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* One run of the command. */
struct run {
    const struct options *options;
    struct frontend frontend;
    struct lowered lowered;
    const char *output; /* path of the picture */
    enum picture_format format;
    struct render_options render;
    struct picture *picture;
    struct run_stats stats;
    struct progress progress;
    double started; /* of thread_seconds() */
};

char *default_picture(const char *scene)
{
    const char *slash = strrchr(scene, '/'), *name = slash ? slash + 1 : scene;
    if (strcmp(name, "-") == 0)
        name = "scene";
    const char *dot = strrchr(name, '.');
    size_t n = dot && dot != name ? (size_t)(dot - name) : strlen(name);
    char *path = mem_alloc(n + sizeof ".png", 1);
    memcpy(path, name, n);
    memcpy(path + n, ".png", sizeof ".png");
    return path;
}

/* The picture's format; told before any work is done.  0 or an exit status. */
static int choose_format(struct run *r)
{
    const struct options *o = r->options;
    if (!picture_format_of(r->output, &r->format))
        return usage_error("'%s' names no picture format; .png, .ppm and .pfm are written",
                           r->output);
    if (strcmp(r->output, "-") == 0 && (o->stats == STATS_JSON || o->format == DIAG_FORMAT_JSON))
        return usage_error("the picture and JSON cannot both go to standard output");
    return 0;
}

/* Reports a failure of the output; returns the exit status. */
static int report_output(struct run *r, const char *reason)
{
    diag_free(&r->frontend.diag);
    diag_init(&r->frontend.diag, &r->frontend.sources);
    diag_report(&r->frontend.diag, DIAG_CANNOT_WRITE, (struct span){0}, "could not write '%s': %s",
                r->output, reason);
    return frontend_report(&r->frontend, r->options, DIAG_WARNING);
}

/* A long render should not end with "no such directory". */
static const char *output_obstacle(const char *path)
{
    struct stat st;
    if (stat(path, &st) == 0 && S_ISDIR(st.st_mode))
        return strerror(EISDIR);
    const char *slash = strrchr(path, '/');
    size_t n = slash ? (size_t)(slash - path) : 0;
    if (!slash || n == 0)
        return NULL;
    char *folder = mem_alloc(n + 1, 1);
    memcpy(folder, path, n);
    folder[n] = 0;
    const char *reason = stat(folder, &st) != 0 ? strerror(errno)
                         : S_ISDIR(st.st_mode)  ? NULL
                                                : strerror(ENOTDIR);
    free(folder);
    return reason;
}

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
static int choose_size(struct run *r)
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
    if (!(o->adaptive > 0) && o->show == SHOW_SAMPLES)
        return usage_error(
            "--show samples tells what --adaptive or --time does, and neither is given");
    return 0;
}

static void choose_sampling(struct run *r)
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
    to->isa = o->isa;
}

/* What OpenMesh finds in each mesh, for --verbose. */
static void describe_meshes(const struct run *r)
{
    for (size_t i = 0; i < r->lowered.meshes.n; i++) {
        const struct lower_mesh *m = &r->lowered.meshes.at[i];
        struct mesh_report report;
        const char *reason = openmesh_analyse(m->mesh->points.at, m->mesh->points.n,
                                              m->mesh->faces.at, m->mesh->faces.n, &report);
        if (reason)
            fprintf(stderr, "mesh       %s: %s\n", m->path, reason);
        else
            fprintf(stderr,
                    "mesh       %s: %zu vertices (%zu unused), %zu faces (%zu of no area, "
                    "%zu not manifold), %s\n",
                    m->path, m->mesh->points.n, report.unused_vertices, m->mesh->faces.n,
                    report.degenerate_faces, report.non_manifold_faces,
                    report.boundary_edges ? "open"
                    : report.volume < 0   ? "closed, inside out"
                                          : "closed");
    }
}

/* When the picture has to be there for it to be written in time, by the seconds that writing takes
 * for a pixel. */
static double deadline(const struct run *r)
{
    static const double write_s[] = {
        [PICTURE_PNG] = 40e-9, [PICTURE_PPM] = 3e-9, [PICTURE_PFM] = 12e-9};
    double pixels = (double)r->picture->width * r->picture->height;
    return r->started + r->options->time - write_s[r->format] * pixels;
}

/* What a service may not want to spend on a scene; what the user asks for is known beforehand. */
static bool check_limits(struct run *r)
{
    const struct options *o = r->options;
    const struct scene *s = &r->lowered.scene;
    const struct desc *d = &r->frontend.desc;
    uint64_t pixels = (uint64_t)s->camera.width * s->camera.height;
    const struct desc_value *depth = d->settings ? desc_get(d->settings, PROP_DEPTH) : NULL;
    if (!o->width && pixels > o->max_pixels)
        diag_report(&r->frontend.diag, DIAG_SCENE_TOO_LARGE,
                    desc_get(d->camera, PROP_RESOLUTION)->span,
                    "the picture has more pixels than --max-pixels allows (%u)", o->max_pixels);
    if (o->depth == DEPTH_OF_SCENE && s->depth > o->max_depth)
        diag_report(&r->frontend.diag, DIAG_OUT_OF_RANGE, depth ? depth->span : (struct span){0},
                    "rays are followed deeper than --max-depth allows (%u)", o->max_depth);
    return r->frontend.diag.errors == 0;
}

static int load(struct run *r)
{
    const struct options *o = r->options;
    bool right = frontend_load(&r->frontend, o->scenes.at[0], o);
    r->stats.parse_s = r->frontend.seconds;
    double start = thread_seconds();
    if (right)
        right =
            lower_scene(&r->frontend.desc, &r->frontend.sources, &r->lowered, &r->frontend.diag);
    r->stats.load_s = thread_seconds() - start;
    right = right && check_limits(r);
    int status = frontend_report(&r->frontend, o, o->verbose ? DIAG_NOTE : DIAG_WARNING);
    if (right && o->verbose)
        describe_meshes(r);
    return status;
}

static void render(struct run *r)
{
    struct render_options *to = &r->render;
    uint32_t width = to->crop.x1 - to->crop.x0, height = to->crop.y1 - to->crop.y0;
    choose_sampling(r);
    r->picture = picture_new(width, height, r->format == PICTURE_PFM);
    picture_encode_as(r->picture, render_encoding(&r->lowered.scene, to->show));
    to->deadline = r->options->time > 0 ? deadline(r) : 0;
    progress_begin(&r->progress, r->options->quiet, (unsigned long)width * height);
    to->progress.report = progress_report;
    to->progress.context = &r->progress;
    render_scene(&r->lowered.scene, to, r->picture, &r->stats.render);
    progress_end(&r->progress);
    r->stats.grid = to->grid;
    r->stats.width = width;
    r->stats.height = height;
}

static int write_picture(struct run *r)
{
    double start = thread_seconds();
    char why[256];
    size_t n;
    void *bytes = picture_encode(r->picture, r->format, &n, why);
    const char *reason = bytes ? file_write(r->output, bytes, n) : why;
    free(bytes);
    r->stats.write_s = thread_seconds() - start;
    return reason ? report_output(r, reason) : 0;
}

static int run_steps(struct run *r)
{
    r->started = thread_seconds();
    int status = choose_format(r);
    if (status == 0)
        status = load(r);
    if (status == 0)
        status = choose_size(r);
    if (status == 0)
        status = check_sampling(r->options, &r->lowered.scene);
    const char *obstacle = status == 0 ? output_obstacle(r->output) : NULL;
    if (obstacle)
        status = report_output(r, obstacle);
    if (status != 0)
        return status;
    render(r);
    status = write_picture(r);
    r->stats.total_s = thread_seconds() - r->started;
    if (status == 0)
        stats_print_render(&r->stats, r->options, &r->lowered.scene);
    return status;
}

int command_render(const struct options *o)
{
    if (o->scenes.n != 1)
        return o->scenes.n ? usage_error("render takes one scene, but %zu are given", o->scenes.n)
                           : usage_error("render: no scene given");
    char *by_default = o->output ? NULL : default_picture(o->scenes.at[0]);
    struct run r = {.options = o, .output = o->output ? o->output : by_default};
    int status = run_steps(&r);
    picture_free(r.picture);
    lower_free(&r.lowered);
    frontend_free(&r.frontend);
    free(by_default);
    return status;
}
