#include "config.h"

#define BUNDLE_KERNELS bundle_avx2
#include "accel/bundle_lanes.h"
