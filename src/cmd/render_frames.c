/* wrt render --frames: one picture after another of a scene with the params `frame` and `time`.
 *
 * Beside the pictures lies a text that says which frames are there: for each a line of its number,
 * the check of its head (what it is of) and the hash of its file.  Lines are appended whole, or
 * take the place of the frame's older one, which is as long: several processes may write them.  The
 * last of a frame holds. */
#include "config.h"

#include "cmd/render_run.h"

#include "accel/store.h"
#include "base/file.h"
#include "base/hash.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FPS = 24 }; /* where --fps is not given */

/* Where the number of the frame comes in a name. */
struct place {
    size_t begin, end; /* of %04d */
    int digits;        /* at least */
};

/* False when there is not exactly one. */
static bool find_place(const char *pattern, struct place *out)
{
    enum { MOST_DIGITS = 10 };
    const char *percent = strchr(pattern, '%');
    if (!percent || strchr(percent + 1, '%'))
        return false;
    const char *p = percent + 1;
    bool padded = *p == '0';
    out->digits = padded ? 0 : 1;
    for (; padded && *p >= '0' && *p <= '9' && out->digits <= MOST_DIGITS; p++)
        out->digits = 10 * out->digits + (*p - '0');
    out->begin = (size_t)(percent - pattern);
    out->end = (size_t)(p + 1 - pattern);
    return *p == 'd' && out->digits >= 1 && out->digits <= MOST_DIGITS;
}

/* The name with something in place of %04d. */
static char *name_with(const char *pattern, const char *text)
{
    struct place p;
    struct buffer b = {0};
    if (find_place(pattern, &p)) {
        buffer_add(&b, pattern, p.begin);
        buffer_puts(&b, text);
        pattern += p.end;
    }
    buffer_add(&b, pattern, strlen(pattern) + 1);
    return b.at;
}

static char *frame_name(const char *pattern, uint32_t frame)
{
    struct place p = {.digits = 1};
    char text[16];
    find_place(pattern, &p);
    snprintf(text, sizeof text, "%0*" PRIu32, p.digits, frame);
    return name_with(pattern, text);
}

/* ---- which frames are there ---- */

struct record {
    uint32_t frame;
    uint64_t check, file;
    off_t at; /* of its line in the text */
};

struct frames {
    char *list;         /* path of the text */
    const char *unread; /* why that cannot be read; or NULL */
    VEC(struct record) records;
    struct cluster *cluster;
    uint32_t frame; /* under way */
    size_t params;  /* -D of the command line */
    bool said;      /* what there is to say of the scene */
};

/* Lines that are not whole are left out.  NULL, or why it cannot be read although it is there. */
static const char *read_list(struct frames *f)
{
    char *text;
    size_t n;
    if (access(f->list, F_OK) != 0 && errno == ENOENT)
        return NULL;
    const char *reason = file_read(f->list, &text, &n);
    if (reason)
        return reason;
    text[n] = 0;
    for (char *line = text, *end; (end = strchr(line, '\n')); line = end + 1) {
        struct record r;
        int length = 0;
        *end = 0;
        if (sscanf(line, "frame %" SCNu32 " %16" SCNx64 " %16" SCNx64 "%n", &r.frame, &r.check,
                   &r.file, &length) == 3 &&
            line + length == end) {
            r.at = line - text;
            vec_push(&f->records, r);
        }
    }
    free(text);
    return NULL;
}

/* What the text says of the frame under way, or NULL. */
static const struct record *find_record(const struct frames *f)
{
    const struct record *last = NULL;
    for (size_t i = 0; i < f->records.n; i++)
        if (f->records.at[i].frame == f->frame)
            last = &f->records.at[i];
    return last;
}

static uint64_t check_of(const struct tilefile_head *h)
{
    struct buffer b = {0};
    uint64_t check = tilefile_put_head(&b, h);
    buffer_free(&b);
    return check;
}

/* The hash of the file; NULL, or why it cannot be read. */
static const char *hash_file(const char *path, uint64_t *out)
{
    char *bytes;
    size_t n;
    const char *reason = file_read(path, &bytes, &n);
    if (reason)
        return reason;
    *out = hash_of(bytes, n, 0);
    free(bytes);
    return NULL;
}

bool render_frame_is_there(struct render_run *r)
{
    struct frames *f = r->frames;
    uint64_t check = check_of(&r->head), file;
    const struct record *last = find_record(f);
    bool there = last && last->check == check && !hash_file(r->output, &file) && file == last->file;
    if (there && r->options->verbose && r->options->stats != STATS_TEXT)
        fprintf(stderr, "wrt: '%s' is there and stays\n", r->output);
    return there;
}

/* Whether the frame's older line still stands where it was; the file is at it then. */
static bool to_older_line(const struct frames *f, int fd, const struct buffer *line)
{
    const struct record *old = find_record(f);
    char text[64];
    size_t same = strcspn(line->at + strlen("frame "), " ") + strlen("frame ") + 1;
    return old && line->n <= sizeof text && pread(fd, text, line->n, old->at) == (ssize_t)line->n &&
           memcmp(text, line->at, same) == 0 && text[line->n - 1] == '\n' &&
           lseek(fd, old->at, SEEK_SET) == old->at;
}

const char *render_frame_record(struct render_run *r)
{
    struct frames *f = r->frames;
    uint64_t file;
    const char *reason = hash_file(r->output, &file);
    if (reason)
        return reason;
    int fd = open(f->list, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (fd < 0)
        return strerror(errno);
    struct buffer line = {0};
    buffer_printf(&line, "frame %" PRIu32 " %016" PRIx64 " %016" PRIx64 "\n", f->frame,
                  check_of(&r->head), file);
    if (!to_older_line(f, fd, &line) && fcntl(fd, F_SETFL, O_APPEND) != 0)
        reason = strerror(errno);
    if (!reason)
        reason = file_put(fd, line.at, line.n);
    close(fd);
    buffer_free(&line);
    return reason;
}

/* ---- all frames ---- */

/* The options of one frame: what it defines comes last. */
static struct options frame_options(const struct options *o, const char *const defines[2])
{
    struct options mine = *o;
    mine.defines.at = NULL;
    mine.defines.n = mine.defines.capacity = 0;
    for (size_t i = 0; i < o->defines.n; i++)
        vec_push(&mine.defines, o->defines.at[i]);
    vec_push(&mine.defines, defines[0]);
    vec_push(&mine.defines, defines[1]);
    mine.optional_defines = 2;
    return mine;
}

static int render_frame(const struct options *o, const char *pattern, struct frames *f,
                        struct lower_files *files, struct accel_store *trees)
{
    struct buffer defines[2] = {{0}, {0}};
    buffer_printf(&defines[0], "frame=%" PRIu32 "%c", f->frame, 0);
    buffer_puts(&defines[1], "time=");
    buffer_number(&defines[1], (double)f->frame / (o->fps ? o->fps : FPS));
    buffer_add(&defines[1], "", 1);
    struct options mine = frame_options(o, (const char *const[]){defines[0].at, defines[1].at});
    char *name = frame_name(pattern, f->frame);
    char *journal = o->checkpoint ? frame_name(o->checkpoint, f->frame) : NULL;
    struct render_run r = {.options = &mine,
                           .output = name,
                           .checkpoint = journal,
                           .frames = f,
                           .files = files,
                           .cluster = f->cluster,
                           .stats = {.file = name, .frame = f->frame}};
    r.render.store = trees;
    int status = render_picture(&r);
    render_run_free(&r);
    vec_free(&mine.defines);
    buffer_free(&defines[0]);
    buffer_free(&defines[1]);
    free(name);
    free(journal);
    return status;
}

/* Which one is not there, and that nothing else is lost. */
static void tell_unfinished(const struct options *o, const struct frames *f)
{
    if (o->format != DIAG_FORMAT_TEXT || o->quiet || cluster_rank(f->cluster) != 0)
        return;
    fprintf(stderr,
            "wrt: note: that was frame %" PRIu32 " of %" PRIu32 "..%" PRIu32
            "; the same command again keeps those that are finished\n",
            f->frame, o->frames[0], o->frames[1]);
}

/* Whether -D gives this param. */
static bool defines(const struct options *o, const char *name)
{
    size_t n = strlen(name);
    for (size_t i = 0; i < o->defines.n; i++)
        if (strncmp(o->defines.at[i], name, n) == 0 && o->defines.at[i][n] == '=')
            return true;
    return false;
}

int render_frames(const struct options *o, const char *pattern, struct cluster *cluster)
{
    struct place place;
    if (!find_place(pattern, &place))
        return usage_error("--frames wants one %%04d in the output's name, not '%s'", pattern);
    if (defines(o, "frame") || defines(o, "time"))
        return usage_error("--frames gives the params 'frame' and 'time' their values, so -D "
                           "cannot give them others; --fps sets how fast time goes");
    if (o->checkpoint && !find_place(o->checkpoint, &place))
        return usage_error("--frames wants one %%04d in the journal's name, not '%s'",
                           o->checkpoint);
    struct frames f = {.params = o->defines.n, .cluster = cluster};
    char *list = name_with(pattern, "frames");
    struct buffer path = {0};
    buffer_puts(&path, list);
    buffer_add(&path, ".txt", sizeof ".txt");
    f.list = path.at;
    f.unread = read_list(&f);
    struct lower_files *files = lower_files_new();
    struct accel_store *trees = accel_store_new();
    int status = 0;
    for (uint64_t i = o->frames[0]; i <= o->frames[1] && status == 0; i++) {
        f.frame = (uint32_t)i;
        status = render_frame(o, pattern, &f, files, trees);
        f.said = true;
        if (status != 0)
            tell_unfinished(o, &f);
    }
    accel_store_free(trees);
    lower_files_free(files);
    vec_free(&f.records);
    free(list);
    buffer_free(&path);
    return status;
}

const char *render_frames_unread(const struct render_run *r, const char **path)
{
    *path = r->frames ? r->frames->list : NULL;
    return r->frames ? r->frames->unread : NULL;
}

bool render_frames_said(const struct render_run *r)
{
    return r->frames && r->frames->said;
}

/* Whether the params were asked for: a scene without them would be the same in each frame. */
bool render_frames_differ(const struct render_run *r)
{
    return !r->frames || r->frontend.desc.overridden.n > r->frames->params;
}
