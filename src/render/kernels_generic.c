#include "config.h"

#define RENDER_KERNELS render_generic
#include "render/kernels_lanes.h"
