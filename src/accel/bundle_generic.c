#include "config.h"

#define BUNDLE_KERNELS bundle_generic
#include "accel/bundle_lanes.h"
