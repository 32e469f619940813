/* Threads that share a counter of work items. */
#ifndef WRT_BASE_THREAD_H
#define WRT_BASE_THREAD_H

#include <stddef.h>

/* Calls work(context, item, worker) once for each item in [0, items), on `threads` threads, this
 * one among them (worker 0).  Which thread takes which item is not fixed.  Threads that cannot be
 * created leave their share to the others. */
void thread_share(size_t items, unsigned threads,
                  void (*work)(void *context, size_t item, unsigned worker), void *context);

/* Processors this process may run on; at least 1. */
unsigned thread_cores(void);

/* Seconds of a steady clock. */
double thread_seconds(void);

#endif
