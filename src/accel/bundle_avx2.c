#include "config.h"

#define BUNDLE_KERNELS bundle_avx2
#include "accel/bundle_lanes.h"

#define WIDE_KERNELS wide_avx2
#include "accel/wide_lanes.h"
