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
    atomic_size_t next;
};

struct worker {
    struct share *share;
    pthread_t thread;
    unsigned number;
};

static void take_items(struct share *s, unsigned worker)
{
    for (;;) {
        size_t item = atomic_fetch_add_explicit(&s->next, 1, memory_order_relaxed);
        if (item >= s->items)
            return;
        s->work(s->context, item, worker);
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
