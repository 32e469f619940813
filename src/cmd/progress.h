/* The progress bar of long renders. */
#ifndef WRT_CMD_PROGRESS_H
#define WRT_CMD_PROGRESS_H

#include <stdbool.h>

struct progress {
    bool active;
    bool shown;      /* something is on the line */
    double start, last; /* seconds: of the render, of the last drawing */
    unsigned long pixels;
};

/* Draws on stderr, and only when it is a terminal and the render is not over at once. */
void progress_begin(struct progress *p, bool quiet, unsigned long pixels);
/* For struct render_progress: context is the struct progress. */
void progress_report(void *context, double done);
void progress_end(struct progress *p);

#endif
