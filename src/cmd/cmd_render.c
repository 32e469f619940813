#include "config.h"

#include "cmd/commands.h"
#include "cmd/interrupt.h"
#include "cmd/render_run.h"

#include "base/thread.h"

#include <stdlib.h>
#include <string.h>

/* The scene's name with another end instead of its suffix, in the current folder. */
static char *name_after(const char *scene, const char *end)
{
    const char *slash = strrchr(scene, '/'), *name = slash ? slash + 1 : scene;
    if (strcmp(name, "-") == 0)
        name = "scene";
    const char *dot = strrchr(name, '.');
    struct buffer b = {0};
    buffer_add(&b, name, dot && dot != name ? (size_t)(dot - name) : strlen(name));
    buffer_add(&b, end, strlen(end) + 1);
    return b.at;
}

char *default_picture(const char *scene)
{
    return name_after(scene, ".png");
}

static char *default_output(const struct options *o)
{
    char end[64];
    const char *frame = o->animated ? "-%04d" : "";
    if (o->parts > 0)
        snprintf(end, sizeof end, "%s-%u-of-%u.tiles", frame, o->part, o->parts);
    else
        snprintf(end, sizeof end, "%s.png", frame);
    return name_after(o->scenes.at[0], end);
}

/* What OpenMesh finds in each mesh, for --verbose. */
static void describe_meshes(const struct render_run *r)
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
static double deadline(const struct render_run *r)
{
    static const double write_s[] = {
        [PICTURE_PNG] = 40e-9, [PICTURE_PPM] = 3e-9, [PICTURE_PFM] = 12e-9, [PICTURE_EXR] = 120e-9};
    double pixels = (double)r->picture->width * r->picture->height;
    return r->started + r->options->time - write_s[r->format] * pixels;
}

static int load(struct render_run *r)
{
    const struct options *o = r->options;
    bool right = frontend_load(&r->frontend, o->scenes.at[0], o);
    r->stats.parse_s = r->frontend.seconds;
    double start = thread_seconds();
    if (right)
        right = lower_scene_keeping(&r->frontend.desc, &r->frontend.sources, r->files, o->threads,
                                    &r->lowered, &r->frontend.diag);
    r->stats.load_s = thread_seconds() - start;
    bool said = render_frames_said(r);
    if (right && !render_frames_differ(r))
        diag_report(&r->frontend.diag, DIAG_UNKNOWN_PARAM, (struct span){0},
                    "--frames: the scene has no param 'frame' or 'time', so all would be the same");
    int status = frontend_report(&r->frontend, o,
                                 said         ? DIAG_ERROR
                                 : o->verbose ? DIAG_NOTE
                                              : DIAG_WARNING);
    if (right && o->verbose && !said)
        describe_meshes(r);
    return status;
}

/* A tile is in the picture. */
static void note_tile(void *context, size_t tile)
{
    struct render_run *r = context;
    atomic_fetch_add_explicit(&r->finished, 1, memory_order_relaxed);
    if (r->journal)
        journal_finished(r->journal, tile);
}

static void begin_picture(struct render_run *r)
{
    const struct options *o = r->options;
    struct render_options *to = &r->render;
    uint32_t width = to->crop.x1 - to->crop.x0, height = to->crop.y1 - to->crop.y0;
    r->picture = picture_new(width, height, render_depth(r));
    picture_encode_as(r->picture, render_encoding(&r->lowered.scene, to->show));
    r->picture->gain = exp2(o->exposure);
    render_fill_head(r);
    r->stats.grid = to->grid;
    r->stats.width = width;
    r->stats.height = height;
}

static void render_tiles(void *context, const size_t *tiles, size_t n)
{
    struct render_run *r = context;
    rendering_tiles(r->rendering, tiles, n);
}

/* All tiles by all ranks; those that this one hears of are counted by rank 0. */
static void share_tiles(struct render_run *r)
{
    struct cluster_job job = {r->tiling,       r->picture,   0,         r->tiles, r->tile_count,
                              &interrupt_flag, render_tiles, note_tile, r};
    cluster_render(r->cluster, &job, &r->stats.cluster);
    r->stats.ranks = cluster_ranks(r->cluster);
}

/* What the statistics are of. */
static void note_share(struct render_run *r)
{
    struct run_stats *s = &r->stats;
    s->resumed = r->options->resume;
    s->tiles = r->expected;
    s->from_journal = r->finished;
    s->pixels = r->tiles ? 0 : tile_pixels(&r->tiling.whole);
    for (size_t i = 0; r->tiles && i < r->tile_count; i++) {
        struct tile t = tiling_at(&r->tiling, r->tiles[i]);
        s->pixels += tile_pixels(&t);
    }
}

static void render(struct render_run *r)
{
    struct render_options *to = &r->render;
    size_t tiles = r->tiles ? r->tile_count : r->tiling.n;
    to->deadline = r->options->time > 0 ? deadline(r) : 0;
    progress_begin(&r->progress, r->options->quiet,
                   (unsigned long)r->picture->width * r->picture->height);
    to->progress.report = progress_report;
    to->progress.context = &r->progress;
    if (cluster_rank(r->cluster) == 0)
        to->watch = (struct render_watch){note_tile, r, &interrupt_flag, tiles};
    r->finished = r->journal ? journal_tiles(r->journal) : 0;
    r->expected = r->finished + tiles;
    note_share(r);
    r->rendering = rendering_begin(&r->lowered.scene, to, r->picture);
    if (r->cluster)
        share_tiles(r);
    else
        rendering_tiles(r->rendering, r->tiles, r->tile_count);
    rendering_end(r->rendering, &r->stats.render);
    r->stats.late = to->deadline > 0 && thread_seconds() >= to->deadline;
    progress_end(&r->progress);
}

/* A tenth more than the time allowed is no matter. */
static void tell_overrun(const struct run_stats *s, double allowed)
{
    if (s->total_s > 1.1 * allowed)
        fprintf(stderr,
                "wrt: warning: --time %g was too short: it took %.2g s, of which %.2g s were for "
                "reading the scene and getting it ready\n",
                allowed, s->total_s, s->parse_s + s->load_s + s->render.build_s);
}

/* Whether a signal left something undone; a picture in a limited time is never done. */
static bool ended_early(const struct render_run *r)
{
    return interrupt_flag && (r->options->time > 0 || r->finished < r->expected);
}

/* All ranks must have come as far as this one, with the same scene.  The status of the worst. */
static int agree(struct render_run *r, int status)
{
    int who, all = cluster_agree(r->cluster, status, &who);
    if (all != 0 && status == 0 && cluster_rank(r->cluster) == 0)
        fprintf(stderr, "wrt: error: process %d of the %d could not go on (exit status %d)\n", who,
                cluster_ranks(r->cluster), all);
    return all;
}

static int agree_on_scene(struct render_run *r)
{
    bool same = cluster_tell(r->cluster, r->head.scene) == r->head.scene;
    return agree(r, same ? 0 : DIAG_EXIT_INPUT);
}

/* As far as the scene. */
static int prepare(struct render_run *r)
{
    int status = render_choose_format(r);
    if (status == 0)
        status = load(r);
    if (status == 0)
        status = render_choose(r);
    if (status == 0)
        status = render_check_output(r);
    status = agree(r, status);
    if (status != 0)
        return status;
    begin_picture(r);
    return agree_on_scene(r);
}

/* Of a frame that stays as it is; the exit status. */
static int keep_frame(struct render_run *r, bool leads)
{
    r->stats.total_s = thread_seconds() - r->started;
    if (leads)
        stats_print_render(&r->stats, r->options, &r->lowered.scene);
    return 0;
}

int render_picture(struct render_run *r)
{
    bool leads = cluster_rank(r->cluster) == 0;
    r->started = thread_seconds();
    int status = prepare(r);
    if (status != 0)
        return status;
    r->stats.kept = r->frames && leads && render_frame_is_there(r);
    if (cluster_tell(r->cluster, r->stats.kept))
        return keep_frame(r, leads);
    status = (int)cluster_tell(r->cluster, leads ? (uint64_t)render_open_journal(r) : 0);
    if (status != 0)
        return status;
    render_choose_tiles(r);
    interrupt_catch();
    render(r);
    if (!leads)
        return 0;
    status = ended_early(r) ? render_save(r) : render_finish(r);
    r->stats.total_s = thread_seconds() - r->started;
    if (r->options->time > 0 && !r->options->quiet && !interrupt_flag)
        tell_overrun(&r->stats, r->options->time);
    if (status == 0)
        stats_print_render(&r->stats, r->options, &r->lowered.scene);
    return status;
}

/* What cannot be asked for together; 0 or an exit status. */
static int check_options(const struct options *o)
{
    if (o->scenes.n != 1)
        return o->scenes.n ? usage_error("render takes one scene, but %zu are given", o->scenes.n)
                           : usage_error("render: no scene given");
    if (o->resume && !o->checkpoint)
        return usage_error("--resume goes on with a --checkpoint, and none is given");
    if (o->fps && !o->animated)
        return usage_error("--fps is of --frames, and none are asked for");
    if (o->seeded && !o->jitter)
        return usage_error("--seed starts the random numbers of --jitter, which is not given");
    if (o->time > 0 && (o->checkpoint || o->parts > 0 || o->animated || o->mpi))
        return usage_error("--time makes another picture each time: it is no option with "
                           "--checkpoint, --frames, --mpi and --part");
    return 0;
}

void render_run_free(struct render_run *r)
{
    if (r->journal)
        journal_close(r->journal, false);
    free(r->tiles);
    picture_free(r->picture);
    lower_free(&r->lowered);
    frontend_free(&r->frontend);
}

static int render_all(const struct options *o, struct cluster *cluster)
{
    int status;
    char *by_default = o->output ? NULL : default_output(o);
    struct render_run r = {.options = o,
                           .output = o->output ? o->output : by_default,
                           .checkpoint = o->checkpoint,
                           .cluster = cluster};
    if (o->animated) {
        status = render_frames(o, r.output, cluster);
    } else {
        status = render_picture(&r);
        render_run_free(&r);
    }
    free(by_default);
    return status;
}

/* Only rank 0 speaks; processes of one machine share its processors. */
static int render_by_mpi(const struct options *o)
{
    struct cluster *c = cluster_begin();
    if (!c)
        return usage_error("--mpi: this wrt was built without MPI");
    struct options mine = *o;
    unsigned neighbours = (unsigned)cluster_neighbours(c);
    if (o->own_threads)
        mine.threads = o->threads > neighbours ? o->threads / neighbours : 1;
    if (cluster_rank(c) > 0 &&
        (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)))
        mine.quiet = true;
    int status = render_all(&mine, c);
    cluster_end(c);
    return status;
}

int command_render(const struct options *o)
{
    int status = check_options(o);
    if (status != 0)
        return status;
    return o->mpi ? render_by_mpi(o) : render_all(o, NULL);
}
