#include "config.h"

#include "farm/journal.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/thread.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* Saving is due when the last time took at most this share of the time since, but not more often
 * than every so many seconds. */
#define SHARE (1.0 / 100)
#define LEAST_SECONDS 0.05

struct journal {
    int fd;
    char *path;
    uint64_t check;
    struct tiling tiling;
    const struct picture *picture;
    atomic_bool *finished; /* by tile: its pixels are in the picture */
    bool *saved;           /* by tile */
    size_t tiles;          /* that are saved */
    uint64_t good;         /* bytes of the file that are whole */
    pthread_mutex_t saving;
    _Atomic double due; /* of thread_seconds() */
    const char *reason; /* of the first failure, after which nothing more is saved; or NULL */
};

/* ---- writing ---- */

/* Appends; after a failure the file is as it was before. */
static void append(struct journal *j, const struct buffer *b)
{
    const char *reason = file_put(j->fd, b->at, b->n);
    if (!reason && fdatasync(j->fd) != 0)
        reason = strerror(errno);
    if (!reason) {
        j->good += b->n;
        return;
    }
    j->reason = reason;
    if (ftruncate(j->fd, (off_t)j->good) != 0)
        return; /* readers drop the torn end */
}

/* Saves all that is finished: a record for each run of tiles. */
static void save(struct journal *j)
{
    struct buffer b = {0};
    size_t tiles = 0;
    for (size_t i = 0; i < j->tiling.n;) {
        size_t end = i;
        while (end < j->tiling.n && !j->saved[end] &&
               atomic_load_explicit(&j->finished[end], memory_order_acquire))
            j->saved[end++] = true;
        if (end > i)
            tilefile_put_tiles(&b, j->check, &j->tiling, j->picture, i, end - i);
        tiles += end - i;
        i = end > i ? end : i + 1;
    }
    if (b.n > 0 && !j->reason)
        append(j, &b);
    j->tiles += tiles;
    buffer_free(&b);
}

void journal_finished(void *context, size_t tile)
{
    struct journal *j = context;
    atomic_store_explicit(&j->finished[tile], true, memory_order_release);
    double now = thread_seconds();
    if (now < atomic_load_explicit(&j->due, memory_order_relaxed) ||
        pthread_mutex_trylock(&j->saving) != 0)
        return;
    if (now >= atomic_load_explicit(&j->due, memory_order_relaxed)) {
        save(j);
        double end = thread_seconds(), pause = (end - now) / SHARE;
        atomic_store_explicit(&j->due, end + (pause > LEAST_SECONDS ? pause : LEAST_SECONDS),
                              memory_order_relaxed);
    }
    pthread_mutex_unlock(&j->saving);
}

bool journal_has(const struct journal *j, size_t tile)
{
    return j->saved[tile];
}

size_t journal_tiles(const struct journal *j)
{
    return j->tiles;
}

/* ---- opening ---- */

static enum journal_opened refuse(struct buffer *why, enum journal_opened kind, const char *reason)
{
    why->n = 0;
    buffer_puts(why, reason);
    buffer_add(why, "", 1);
    return kind;
}

/* Whether what is there began as a journal. */
static bool is_journal(const char *path)
{
    struct stat st;
    struct tilefile t;
    bool torn;
    if (stat(path, &st) != 0 || !S_ISREG(st.st_mode))
        return false;
    if (tilefile_open(&t, path, &torn))
        return torn;
    tilefile_close(&t);
    return true;
}

/* A file of this process alone. */
static enum journal_opened open_file(struct journal *j, bool resume, struct buffer *why)
{
    struct stat st;
    j->fd = open(j->path, O_RDWR | O_CREAT | O_CLOEXEC | (resume ? 0 : O_EXCL), 0666);
    if (j->fd < 0 && errno == EEXIST)
        return refuse(why, is_journal(j->path) ? JOURNAL_EXISTS : JOURNAL_TAKEN, strerror(EEXIST));
    if (j->fd < 0)
        return refuse(why, JOURNAL_FAILED, strerror(errno));
    if (fstat(j->fd, &st) != 0)
        return refuse(why, JOURNAL_FAILED, strerror(errno));
    if (!S_ISREG(st.st_mode))
        return refuse(why, JOURNAL_UNUSABLE, "it is no regular file");
    if (flock(j->fd, LOCK_EX | LOCK_NB) != 0)
        return refuse(why, JOURNAL_FAILED,
                      errno == EWOULDBLOCK ? "another process is at work on it" : strerror(errno));
    return JOURNAL_OPEN;
}

static void take_records(struct journal *j, struct tilefile *t, struct picture *p)
{
    size_t first, n;
    while (tilefile_next(t, p, &first, &n) == TILEFILE_TILES) {
        for (size_t i = first; i < first + n; i++) {
            j->tiles += !j->saved[i];
            j->saved[i] = true;
            atomic_store_explicit(&j->finished[i], true, memory_order_relaxed);
        }
        j->good = t->good;
    }
}

/* What is in the file, if it is of this picture. */
static enum journal_opened take_file(struct journal *j, const struct tilefile_head *head,
                                     struct picture *p, struct buffer *why)
{
    struct tilefile t;
    bool torn;
    const char *reason = tilefile_open(&t, j->path, &torn);
    if (reason)
        return torn ? JOURNAL_OPEN
                    : refuse(why, t.failed ? JOURNAL_FAILED : JOURNAL_UNUSABLE, reason);
    const char *other = tilefile_other(&t.head, head, why);
    if (!other) {
        j->good = t.good;
        take_records(j, &t, p);
    }
    tilefile_close(&t);
    if (t.failed)
        return refuse(why, JOURNAL_FAILED, "it could not be read");
    return other ? JOURNAL_UNUSABLE : JOURNAL_OPEN;
}

/* Leaves the file at the end of what is whole, which is its head at least. */
static enum journal_opened begin_writing(struct journal *j, const struct tilefile_head *head,
                                         struct buffer *why)
{
    struct buffer b = {0};
    j->check = tilefile_put_head(&b, head);
    if (ftruncate(j->fd, (off_t)j->good) != 0 || lseek(j->fd, 0, SEEK_END) < 0)
        j->reason = strerror(errno);
    else if (j->good == 0)
        append(j, &b);
    buffer_free(&b);
    return j->reason ? refuse(why, JOURNAL_FAILED, j->reason) : JOURNAL_OPEN;
}

static void journal_free(struct journal *j)
{
    if (j->fd >= 0)
        close(j->fd);
    pthread_mutex_destroy(&j->saving);
    free(j->finished);
    free(j->saved);
    free(j->path);
    free(j);
}

enum journal_opened journal_open(const char *path, bool resume, const struct tilefile_head *head,
                                 struct picture *p, struct journal **out, struct buffer *why)
{
    struct journal *j = mem_zalloc(1, sizeof *j);
    j->tiling = tilefile_tiling(head);
    j->picture = p;
    j->finished = mem_zalloc(j->tiling.n, sizeof *j->finished);
    j->saved = mem_zalloc(j->tiling.n, sizeof *j->saved);
    j->path = mem_string(path);
    pthread_mutex_init(&j->saving, NULL);
    enum journal_opened opened = open_file(j, resume, why);
    if (opened == JOURNAL_OPEN)
        opened = take_file(j, head, p, why);
    if (opened == JOURNAL_OPEN)
        opened = begin_writing(j, head, why);
    atomic_store(&j->due, thread_seconds() + LEAST_SECONDS);
    *out = j;
    if (opened != JOURNAL_OPEN) {
        journal_free(j);
        *out = NULL;
    }
    return opened;
}

const char *journal_close(struct journal *j, bool remove_file)
{
    if (!remove_file)
        save(j);
    else if (unlink(j->path) != 0 && !j->reason)
        j->reason = strerror(errno);
    const char *reason = j->reason;
    journal_free(j);
    return reason;
}
