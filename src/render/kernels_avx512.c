#include "config.h"

#define RENDER_KERNELS render_avx512
#include "render/kernels_lanes.h"
