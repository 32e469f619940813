#include "config.h"

#define BUNDLE_KERNELS bundle_avx512
#define WIDE_KERNELS wide_avx512
#include "accel/packet_lanes.h"
