#ifndef WRT_RENDER_ADAPTIVE_H
#define WRT_RENDER_ADAPTIVE_H

#include "render/tracer.h"

/* Samples where they are needed; a worker for each thread.  As struct rendering. */
struct frame;
struct frame *adaptive_new(const struct tracer *t, struct worker **workers, struct picture *out);
void adaptive_tiles(struct frame *f, const size_t *tiles, size_t n);
struct adaptive_stats adaptive_end(struct frame *f);

#endif
