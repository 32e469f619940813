#include "config.h"

#define BUNDLE_KERNELS bundle_avx2
#define WIDE_KERNELS wide_avx2
#include "accel/packet_lanes.h"
