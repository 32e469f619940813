#include "config.h"

#include "cmd/progress.h"

#include "base/thread.h"

#include <stdio.h>
#include <unistd.h>

#define FIRST_AFTER 0.5 /* seconds: shorter renders need no bar */
#define REDRAW_AFTER 0.1
enum { BAR_WIDTH = 40 };

void progress_begin(struct progress *p, bool quiet, unsigned long pixels)
{
    double now = thread_seconds();
    *p = (struct progress){
        .active = !quiet && isatty(STDERR_FILENO), .start = now, .last = now, .pixels = pixels};
}

static void print_time(double seconds)
{
    unsigned long s = (unsigned long)(seconds + 0.5);
    if (s >= 3600)
        fprintf(stderr, "%lu:%02lu:%02lu", s / 3600, s / 60 % 60, s % 60);
    else
        fprintf(stderr, "%lu:%02lu", s / 60, s % 60);
}

void progress_report(void *context, double done)
{
    struct progress *p = context;
    if (!p->active)
        return;
    double now = thread_seconds(), spent = now - p->start;
    if (spent < FIRST_AFTER || now - p->last < REDRAW_AFTER || done <= 0)
        return;
    p->last = now;
    p->shown = true;
    int full = (int)(done * BAR_WIDTH);
    fputs("\r[", stderr);
    for (int i = 0; i < BAR_WIDTH; i++)
        putc(i < full ? '#' : ' ', stderr);
    fprintf(stderr, "] %3.0f %%  %.2f Mpixel/s  ", done * 100,
            done * (double)p->pixels / spent * 1e-6);
    print_time(spent / done - spent);
    fputs(" left \033[K", stderr);
    fflush(stderr);
}

void progress_end(struct progress *p)
{
    if (p->shown)
        fputs("\r\033[K", stderr);
}
