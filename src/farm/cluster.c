/* Asking, answering and waiting go by polling with pauses: MPI's own waits would keep a processor
 * busy that has something better to do.  A rank asks for its next tiles before it renders those it
 * has, so it need not wait for the answer. */
#include "config.h"

#include "farm/cluster.h"

#ifdef HAVE_MPI

#include "base/mem.h"
#include "base/thread.h"

#include <mpi.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { TAG_ASK, TAG_TILES, TAG_MADE };

/* Nanoseconds between two looks for messages: it begins with one and grows to the other. */
enum { PAUSE_FIRST = 20 * 1000, PAUSE_LAST = 1000 * 1000 };

struct cluster {
    int rank, ranks, neighbours;
};

struct cluster *cluster_begin(void)
{
    struct cluster *c = mem_zalloc(1, sizeof *c);
    MPI_Comm here;
    int provided;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &c->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &c->ranks);
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &c->neighbours);
    MPI_Comm_free(&here);
    return c;
}

void cluster_end(struct cluster *c)
{
    if (c)
        MPI_Finalize();
    free(c);
}

int cluster_rank(const struct cluster *c)
{
    return c ? c->rank : 0;
}

int cluster_ranks(const struct cluster *c)
{
    return c ? c->ranks : 1;
}

int cluster_neighbours(const struct cluster *c)
{
    return c ? c->neighbours : 1;
}

int cluster_agree(struct cluster *c, int number, int *who)
{
    struct {
        int number, rank;
    } mine = {number, cluster_rank(c)}, all = mine;
    if (c)
        MPI_Allreduce(&mine, &all, 1, MPI_2INT, MPI_MAXLOC, MPI_COMM_WORLD);
    if (who)
        *who = all.rank;
    return all.number;
}

uint64_t cluster_tell(struct cluster *c, uint64_t number)
{
    if (c)
        MPI_Bcast(&number, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    return number;
}

/* Waits a little, longer each time. */
static void pause_for(long *nanoseconds)
{
    struct timespec t = {0, *nanoseconds};
    nanosleep(&t, NULL);
    *nanoseconds = *nanoseconds * 2 < PAUSE_LAST ? *nanoseconds * 2 : PAUSE_LAST;
}

/* Takes a message that is there; its size in bytes. */
static size_t take(const MPI_Status *status, struct buffer *out)
{
    int n;
    MPI_Get_count(status, MPI_BYTE, &n);
    out->n = 0;
    buffer_fill(out, 0, (size_t)n);
    MPI_Recv(out->at, n, MPI_BYTE, status->MPI_SOURCE, status->MPI_TAG, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    return (size_t)n;
}

/* ---- handing out ---- */

struct handout {
    const struct cluster *cluster;
    const struct cluster_job *job;
    pthread_mutex_t lock;
    size_t next;            /* of the job's tiles */
    size_t ended, awaited;  /* ranks that were told there are no more; answers that are due */
    bool own_done;          /* this rank renders nothing more */
    struct buffer received; /* a message */
    struct cluster_stats stats;
};

/* The next run of tiles, from *first on: a share of what is left, so that all end together. */
static size_t hand_out(struct handout *h, size_t *first)
{
    enum { MOST = 256, SHARES = 4 };
    pthread_mutex_lock(&h->lock);
    size_t left = h->job->tile_count - h->next;
    size_t n = left / ((size_t)SHARES * (size_t)h->cluster->ranks);
    n = n < 1 ? 1 : n > MOST ? MOST : n;
    n = *h->job->stop ? 0 : n < left ? n : left;
    *first = h->next;
    h->next += n;
    pthread_mutex_unlock(&h->lock);
    return n;
}

static void answer(struct handout *h, int rank)
{
    size_t first, n = hand_out(h, &first);
    const size_t *tiles = h->job->tiles + first;
    size_t bytes = n * sizeof *tiles;
    MPI_Send(tiles, (int)bytes, MPI_BYTE, rank, TAG_TILES, MPI_COMM_WORLD);
    h->ended += n == 0;
    h->awaited += n > 0;
    h->stats.messages++;
    h->stats.bytes += bytes;
}

/* A message of records, one behind another; each says how many tiles it has. */
static void take_made(struct handout *h)
{
    const struct cluster_job *job = h->job;
    const char *at = h->received.at, *end = at + h->received.n;
    while (end - at > (ptrdiff_t)sizeof(uint64_t)) {
        uint64_t bytes;
        size_t first, n;
        memcpy(&bytes, at, sizeof bytes);
        at += sizeof bytes;
        if (!tilefile_take_tiles(&job->tiling, at, (size_t)bytes, job->picture, &first, &n))
            break;
        for (size_t i = first; i < first + n; i++)
            job->arrived(job->context, i);
        at += bytes;
    }
    h->awaited--;
}

static bool serve_one(struct handout *h)
{
    MPI_Status status;
    int there;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (!there)
        return false;
    h->stats.bytes += take(&status, &h->received);
    h->stats.messages++;
    if (status.MPI_TAG == TAG_ASK)
        answer(h, status.MPI_SOURCE);
    else
        take_made(h);
    return true;
}

static bool all_done(struct handout *h)
{
    pthread_mutex_lock(&h->lock);
    bool own = h->own_done;
    pthread_mutex_unlock(&h->lock);
    return own && h->awaited == 0 && h->ended + 1 == (size_t)h->cluster->ranks;
}

static void *render_own(void *context)
{
    struct handout *h = context;
    size_t first, n;
    while ((n = hand_out(h, &first)) > 0)
        h->job->render(h->job->context, h->job->tiles + first, n);
    pthread_mutex_lock(&h->lock);
    h->own_done = true;
    pthread_mutex_unlock(&h->lock);
    return NULL;
}

/* Without a thread to render, this rank renders once the others have all there is. */
static void lead(struct handout *h)
{
    pthread_t renderer;
    pthread_mutex_init(&h->lock, NULL);
    bool helped = pthread_create(&renderer, NULL, render_own, h) == 0;
    if (!helped)
        h->own_done = true;
    for (long pause = PAUSE_FIRST; !all_done(h);) {
        if (serve_one(h))
            pause = PAUSE_FIRST;
        else
            pause_for(&pause);
    }
    if (helped)
        pthread_join(renderer, NULL);
    else
        render_own(h);
    pthread_mutex_destroy(&h->lock);
    buffer_free(&h->received);
}

/* ---- the other ranks ---- */

static void put_made(struct buffer *out, const struct cluster_job *job, const size_t *tiles,
                     size_t n)
{
    enum { CHECK = 8 }; /* MPI's messages need none */
    for (size_t i = 0, run; i < n; i += run) {
        run = 1;
        while (i + run < n && tiles[i + run] == tiles[i] + run)
            run++;
        size_t at = out->n;
        uint64_t bytes = 0;
        buffer_add(out, (const char *)&bytes, sizeof bytes);
        tilefile_put_tiles(out, job->check, &job->tiling, job->picture, tiles[i], run);
        out->n -= CHECK;
        bytes = out->n - at - sizeof bytes;
        memcpy(out->at + at, &bytes, sizeof bytes);
    }
}

static void await_tiles(struct buffer *out)
{
    MPI_Status status;
    int there = 0;
    for (long pause = PAUSE_FIRST;; pause_for(&pause)) {
        MPI_Iprobe(0, TAG_TILES, MPI_COMM_WORLD, &there, &status);
        if (there)
            break;
    }
    take(&status, out);
}

static void follow(const struct cluster_job *job)
{
    struct buffer tiles = {0}, made = {0};
    MPI_Send(NULL, 0, MPI_BYTE, 0, TAG_ASK, MPI_COMM_WORLD);
    for (;;) {
        await_tiles(&tiles);
        size_t n = tiles.n / sizeof(size_t);
        if (n == 0)
            break;
        size_t *mine = memcpy(mem_alloc(n, sizeof *mine), tiles.at, tiles.n);
        MPI_Send(NULL, 0, MPI_BYTE, 0, TAG_ASK, MPI_COMM_WORLD);
        job->render(job->context, mine, n);
        made.n = 0;
        put_made(&made, job, mine, n);
        MPI_Send(made.at, (int)made.n, MPI_BYTE, 0, TAG_MADE, MPI_COMM_WORLD);
        free(mine);
    }
    buffer_free(&tiles);
    buffer_free(&made);
}

void cluster_render(struct cluster *c, const struct cluster_job *job, struct cluster_stats *stats)
{
    struct handout h = {.cluster = c, .job = job};
    if (c->rank == 0)
        lead(&h);
    else
        follow(job);
    *stats = h.stats;
}

#else

struct cluster *cluster_begin(void)
{
    return NULL;
}

void cluster_end(struct cluster *c)
{
    (void)c;
}

int cluster_rank(const struct cluster *c)
{
    (void)c;
    return 0;
}

int cluster_ranks(const struct cluster *c)
{
    (void)c;
    return 1;
}

int cluster_neighbours(const struct cluster *c)
{
    (void)c;
    return 1;
}

int cluster_agree(struct cluster *c, int number, int *who)
{
    (void)c;
    if (who)
        *who = 0;
    return number;
}

uint64_t cluster_tell(struct cluster *c, uint64_t number)
{
    (void)c;
    return number;
}

void cluster_render(struct cluster *c, const struct cluster_job *job, struct cluster_stats *stats)
{
    (void)c;
    job->render(job->context, job->tiles, job->tile_count);
    *stats = (struct cluster_stats){0};
}

#endif
