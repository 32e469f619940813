#include "config.h"

#define BUNDLE_KERNELS bundle_generic
#define WIDE_KERNELS wide_generic
#include "accel/packet_lanes.h"
