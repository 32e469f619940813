#include "config.h"

#include "base/thread.h"

#include "base/mem.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

struct share {
    void (*work)(void *context, size_t item, unsigned worker);
    void *context;
    size_t items;
    unsigned threads;
    atomic_size_t next;
};

struct worker {
    struct share *share;
    pthread_t thread;
    unsigned number;
};

/* Neighbours are taken together while much is left: they often write to the same cache lines. */
static size_t items_at_once(size_t left, unsigned threads)
{
    enum { MOST = 64, PARTS = 64 };
    size_t n = left / ((size_t)PARTS * threads);
    return n > MOST ? MOST : n > 1 ? n : 1;
}

static void take_items(struct share *s, unsigned worker)
{
    for (;;) {
        size_t next = atomic_load_explicit(&s->next, memory_order_relaxed);
        if (next >= s->items)
            return;
        size_t n = items_at_once(s->items - next, s->threads);
        next = atomic_fetch_add_explicit(&s->next, n, memory_order_relaxed);
        size_t end = next < s->items && s->items - next > n ? next + n : s->items;
        for (; next < end; next++)
            s->work(s->context, next, worker);
    }
}

static void *start(void *p)
{
    struct worker *w = p;
    take_items(w->share, w->number);
    return NULL;
}

void thread_share(size_t items, unsigned threads,
                  void (*work)(void *context, size_t item, unsigned worker), void *context)
{
    struct share share = {.work = work, .context = context, .items = items};
    if (threads > items)
        threads = items ? (unsigned)items : 1;
    share.threads = threads;
    struct worker *workers = mem_alloc(threads, sizeof *workers);
    unsigned started = 1;
    for (; started < threads; started++) {
        workers[started] = (struct worker){.share = &share, .number = started};
        if (pthread_create(&workers[started].thread, NULL, start, &workers[started]) != 0)
            break;
    }
    take_items(&share, 0);
    for (unsigned i = 1; i < started; i++)
        pthread_join(workers[i].thread, NULL);
    free(workers);
}

unsigned thread_cores(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) > 0)
        return (unsigned)CPU_COUNT(&set);
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n > 0 ? (unsigned)n : 1;
}

double thread_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
