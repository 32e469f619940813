#include "config.h"

#define BUNDLE_KERNELS bundle_avx512
#include "accel/bundle_lanes.h"
