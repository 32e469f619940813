#include "config.h"

#define BUNDLE_KERNELS bundle_generic
#include "accel/bundle_lanes.h"

#define WIDE_KERNELS wide_generic
#include "accel/wide_lanes.h"
