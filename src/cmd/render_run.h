/* What the parts of `wrt render` share: one picture from its scene to its file. */
#ifndef WRT_CMD_RENDER_RUN_H
#define WRT_CMD_RENDER_RUN_H

#include "cmd/frontend.h"
#include "cmd/progress.h"
#include "cmd/stats.h"
#include "farm/cluster.h"
#include "farm/journal.h"

#include <stdatomic.h>

struct frames;

struct render_run {
    const struct options *options;
    struct frames *frames;     /* the picture is one of them; or NULL */
    struct lower_files *files; /* that they share; or NULL */
    struct cluster *cluster;   /* whose ranks share the work; or NULL */
    struct rendering *rendering;
    struct frontend frontend;
    struct lowered lowered;
    const char *output;     /* path of the picture, or of a part */
    const char *checkpoint; /* path of its journal, or NULL */
    enum picture_format format;
    uint32_t bits; /* a channel of the file */
    struct render_options render;
    struct tilefile_head head; /* what the picture is of */
    struct tiling tiling;      /* of the crop */
    size_t *tiles;             /* that are to be rendered; NULL: all */
    size_t tile_count;
    struct picture *picture;
    struct journal *journal; /* or NULL */
    atomic_size_t finished;  /* tiles in the picture */
    size_t expected;         /* that are in it once all is done */
    struct run_stats stats;
    struct progress progress;
    double started; /* of thread_seconds() */
};

/* ---- cmd_render.c ---- */

/* All steps; the exit status.  Options, output, frames, files and cluster are set. */
int render_picture(struct render_run *r);
void render_run_free(struct render_run *r);

/* ---- render_frames.c ---- */

/* `pattern` has %04d in it; the exit status. */
int render_frames(const struct options *o, const char *pattern, struct cluster *cluster);
/* Whether the frame's file is there, made of the same scene and settings, and whole. */
bool render_frame_is_there(struct render_run *r);
/* Notes that it is; NULL or a reason. */
const char *render_frame_record(struct render_run *r);
/* Why the text of what is there cannot be read, and its path; NULL when it can, or there is none.
 */
const char *render_frames_unread(const struct render_run *r, const char **path);
/* Whether findings of the scene have been told with a frame before. */
bool render_frames_said(const struct render_run *r);
/* Whether the scene has one of the params that frames set; true without frames. */
bool render_frames_differ(const struct render_run *r);

/* ---- render_settings.c: what is rendered ---- */

/* Size, crop and sampling of the picture by the scene and the options; 0 or an exit status. */
int render_choose(struct render_run *r);
/* Fills the head with what the choice comes to. */
void render_fill_head(struct render_run *r);

/* ---- render_output.c: files ---- */

/* What a channel of the picture is kept as. */
enum picture_depth render_depth(const struct render_run *r);
/* The picture's format; told before any work is done.  0 or an exit status. */
int render_choose_format(struct render_run *r);
/* Whether the output's folder is there, and what is there of frames can be read; 0 or an exit
 * status. */
int render_check_output(struct render_run *r);
/* Opens the journal that was asked for; its tiles are in the picture then.  0 or an exit status. */
int render_open_journal(struct render_run *r);
/* The tiles that are left to be rendered. */
void render_choose_tiles(struct render_run *r);
/* Writes the picture or part, and removes the journal; 0 or an exit status. */
int render_finish(struct render_run *r);
/* After a signal: saves the journal, writes the picture so far beside the output, says so; returns
 * the exit status. */
int render_save(struct render_run *r);

#endif
