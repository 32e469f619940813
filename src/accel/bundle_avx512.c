#include "config.h"

#define BUNDLE_KERNELS bundle_avx512
#include "accel/bundle_lanes.h"

#define WIDE_KERNELS wide_avx512
#include "accel/wide_lanes.h"
