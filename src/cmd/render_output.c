/* The files of a render: the picture or part, the picture so far, the journal. */
#include "config.h"

#include "cmd/interrupt.h"
#include "cmd/render_run.h"

#include "base/file.h"
#include "base/thread.h"
#include "farm/parts.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The bits a channel that a file of this format may have; the first is meant without --bits. */
static const struct {
    const char *name;
    uint32_t bits[2];
} formats[] = {
    [PICTURE_PNG] = {"PNG", {8, 16}},
    [PICTURE_PPM] = {"PPM", {8, 8}},
    [PICTURE_PFM] = {"PFM", {32, 32}},
    [PICTURE_EXR] = {"OpenEXR", {32, 16}},
};

/* By its suffix. */
static bool names_picture(const char *path)
{
    const char *slash = strrchr(path, '/');
    enum picture_format format;
    return strchr(slash ? slash : path, '.') && picture_format_of(path, &format);
}

int render_choose_format(struct render_run *r)
{
    const struct options *o = r->options;
    if (strcmp(r->output, "-") == 0 && (o->stats == STATS_JSON || o->format == DIAG_FORMAT_JSON))
        return usage_error("the picture and JSON cannot both go to standard output");
    r->bits = o->bits;
    if (o->parts > 0 && names_picture(r->output))
        return usage_error("--part writes tiles for 'wrt merge', and '%s' is a picture's name",
                           r->output);
    if (o->parts > 0) {
        r->bits = o->bits ? o->bits : 8;
        return 0;
    }
    if (!picture_format_of(r->output, &r->format))
        return usage_error("'%s' names no picture format; " PICTURE_SUFFIXES " are written",
                           r->output);
    if (!picture_format_built(r->format))
        return usage_error("'%s': this wrt was built without OpenEXR", r->output);
    const uint32_t *may = formats[r->format].bits;
    r->bits = o->bits ? o->bits : may[0];
    if (r->bits == may[0] || r->bits == may[1])
        return 0;
    if (may[0] == may[1])
        return usage_error("--bits: %s has %u bits a channel, not %u", formats[r->format].name,
                           may[0], r->bits);
    return usage_error("--bits: %s has %u or %u bits a channel, not %u", formats[r->format].name,
                       may[0], may[1], r->bits);
}

enum picture_depth render_depth(const struct render_run *r)
{
    bool floats = r->bits == 32 || (r->options->parts == 0 && r->format == PICTURE_EXR);
    return floats ? PICTURE_FLOATS : r->bits == 16 ? PICTURE_WORDS : PICTURE_BYTES;
}

/* Reports what is wrong with a file in place of what was reported before; returns the exit status.
 */
static int report_file(struct render_run *r, enum diag_code code, const char *what,
                       const char *path, const char *reason)
{
    diag_free(&r->frontend.diag);
    diag_init(&r->frontend.diag, &r->frontend.sources);
    diag_report(&r->frontend.diag, code, (struct span){0}, "%s '%s': %s", what, path, reason);
    return frontend_report(&r->frontend, r->options, DIAG_WARNING);
}

static int report_output(struct render_run *r, const char *path, const char *reason)
{
    return report_file(r, DIAG_CANNOT_WRITE, "could not write", path, reason);
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

/* What would be lost under the output's name; 0 or an exit status. */
static int check_names(const struct render_run *r)
{
    const struct options *o = r->options;
    if (strcmp(r->output, "-") == 0)
        return 0;
    if (file_same(r->output, o->scenes.at[0]))
        return usage_error("'%s' is the scene; it would be lost under what is written", r->output);
    if (r->checkpoint && file_same(r->output, r->checkpoint))
        return usage_error("--checkpoint: the journal cannot be '%s', which the picture goes to",
                           r->checkpoint);
    return 0;
}

int render_check_output(struct render_run *r)
{
    int status = check_names(r);
    if (status != 0)
        return status;
    const char *list, *unread = render_frames_unread(r, &list);
    if (unread)
        return report_file(r, DIAG_CANNOT_READ, "could not read the list of frames", list, unread);
    const char *obstacle = output_obstacle(r->output);
    return obstacle ? report_output(r, r->output, obstacle) : 0;
}

/* ---- the journal, and what it leaves to be done ---- */

int render_open_journal(struct render_run *r)
{
    struct buffer why = {0};
    struct tilefile_head head = r->head;
    head.part = head.parts = 0;
    if (!r->checkpoint)
        return 0;
    int status = 0;
    switch (journal_open(r->checkpoint, r->options->resume, &head, r->picture, &r->journal, &why)) {
    case JOURNAL_OPEN:
        break;
    case JOURNAL_EXISTS:
        status = usage_error("--checkpoint: there is a '%s' already; --resume goes on with it",
                             r->checkpoint);
        break;
    case JOURNAL_TAKEN:
        status = usage_error("--checkpoint: '%s' is there and is no journal, so it stays as it is",
                             r->checkpoint);
        break;
    case JOURNAL_UNUSABLE:
        status = report_file(r, DIAG_OTHER_TILES, "cannot resume from", r->checkpoint, why.at);
        break;
    case JOURNAL_FAILED:
        status = report_output(r, r->checkpoint, why.at);
        break;
    }
    buffer_free(&why);
    return status;
}

/* Leaves those out that the journal has. */
static void drop_saved(struct render_run *r)
{
    size_t n = 0;
    for (size_t i = 0; i < r->tile_count; i++)
        if (!journal_has(r->journal, r->tiles[i]))
            r->tiles[n++] = r->tiles[i];
    r->tile_count = n;
}

void render_choose_tiles(struct render_run *r)
{
    uint32_t part = r->options->part, parts = r->options->parts;
    if (parts > 0 || r->journal || r->cluster)
        r->tiles = part_tiles(&r->tiling, parts ? part : 1, parts ? parts : 1, &r->tile_count);
    if (r->journal)
        drop_saved(r);
}

/* ---- results ---- */

static const char *write_picture(struct render_run *r, const char *path, char why[])
{
    size_t n;
    struct tilefile_texts texts;
    tilefile_tell(&r->head, &texts);
    r->picture->texts = texts.at;
    r->picture->text_count = TILEFILE_TEXTS;
    r->picture->halves = r->bits == 16;
    void *bytes = picture_encode(r->picture, r->format, &n, why);
    const char *reason = bytes ? file_write(path, bytes, n) : why;
    free(bytes);
    return reason;
}

/* Tile after tile, so that a part's bytes do not depend on how it came about. */
static const char *write_part(struct render_run *r)
{
    struct buffer b = {0};
    size_t n;
    size_t *tiles = part_tiles(&r->tiling, r->head.part, r->head.parts, &n);
    uint64_t check = tilefile_put_head(&b, &r->head);
    for (size_t i = 0, run; i < n; i += run) {
        run = 1;
        while (i + run < n && tiles[i + run] == tiles[i] + run)
            run++;
        tilefile_put_tiles(&b, check, &r->tiling, r->picture, tiles[i], run);
    }
    tilefile_put_end(&b, check, n);
    const char *reason = file_write(r->output, b.at, b.n);
    free(tiles);
    buffer_free(&b);
    return reason;
}

/* dir/name.png becomes dir/name.partial.png; for the caller to free. */
static char *partial_name(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    size_t stem = dot ? (size_t)(dot - path) : strlen(path);
    struct buffer b = {0};
    buffer_add(&b, path, stem);
    buffer_puts(&b, ".partial");
    buffer_add(&b, path + stem, strlen(path + stem) + 1);
    return b.at;
}

/* Whether there is a place beside the output. */
static bool output_is_regular(const char *path)
{
    struct stat st;
    return strcmp(path, "-") != 0 && (stat(path, &st) != 0 || S_ISREG(st.st_mode));
}

/* What an interrupted run left is no part of the picture any more. */
static void remove_partial(const struct render_run *r)
{
    char *path = partial_name(r->output);
    if (r->head.parts == 0 && output_is_regular(r->output))
        unlink(path);
    free(path);
}

int render_finish(struct render_run *r)
{
    double start = thread_seconds();
    char why[IMAGE_REASON_BYTES];
    const char *reason = r->head.parts > 0 ? write_part(r) : write_picture(r, r->output, why);
    r->stats.write_s += thread_seconds() - start;
    int status = reason ? report_output(r, r->output, reason) : 0;
    if (status == 0 && (r->options->resume || r->frames))
        remove_partial(r);
    if (status == 0 && r->frames && (reason = render_frame_record(r)))
        status = report_output(r, "the list of frames", reason);
    if (r->journal) {
        reason = journal_close(r->journal, status == 0);
        r->journal = NULL;
        if (reason)
            status = report_output(r, r->checkpoint, reason);
    }
    return status;
}

/* Of a picture in a limited time no part is finished before the whole is. */
static void tell_share(const struct render_run *r, int number)
{
    size_t have = atomic_load(&r->finished), all = r->head.parts ? r->expected : r->tiling.n;
    fprintf(stderr, "wrt: ended by %s ", interrupt_name(number));
    if (r->options->time > 0)
        fputs("before the time was over", stderr);
    else
        fprintf(stderr, "with %.1f %% of the %s", 100.0 * (double)have / (double)all,
                r->head.parts ? "part" : "picture");
}

/* Writes the picture so far, if there is a place for it, and says where; false: it is lost. */
static bool save_picture(struct render_run *r)
{
    if (r->head.parts > 0 || !output_is_regular(r->output))
        return false;
    char why[IMAGE_REASON_BYTES], *path = partial_name(r->output);
    const char *reason = write_picture(r, path, why);
    if (reason)
        fprintf(stderr, "; could not write '%s': %s", path, reason);
    else if (r->options->time > 0)
        fprintf(stderr, "; the picture so far is in '%s'", path);
    else
        fprintf(stderr, ", which is in '%s'", path);
    free(path);
    return !reason;
}

int render_save(struct render_run *r)
{
    int number = interrupt_flag;
    const char *reason = r->journal ? journal_close(r->journal, false) : NULL;
    bool journal = r->journal && !reason;
    r->journal = NULL;
    if (reason)
        report_output(r, r->checkpoint, reason);
    tell_share(r, number);
    bool picture = save_picture(r);
    if (journal)
        fprintf(stderr, "; --checkpoint '%s' --resume goes on", r->options->checkpoint);
    else if (!picture)
        fputs("; nothing of it was kept", stderr);
    fputs("\n", stderr);
    return 128 + number;
}
