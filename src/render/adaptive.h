#ifndef WRT_RENDER_ADAPTIVE_H
#define WRT_RENDER_ADAPTIVE_H

#include "render/tracer.h"

/* Renders the crop by samples where they are needed; a worker for each thread. */
struct adaptive_stats render_adaptive(const struct tracer *t, struct worker **workers,
                                      struct picture *out);

#endif
