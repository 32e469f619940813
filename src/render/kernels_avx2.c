#include "config.h"

#define RENDER_KERNELS render_avx2
#include "render/kernels_lanes.h"
