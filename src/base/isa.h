/* Instruction sets that the renderer's kernels are compiled for, chosen once at the start. */
#ifndef WRT_BASE_ISA_H
#define WRT_BASE_ISA_H

#include "base/str.h"

#include <stdbool.h>

/* Slowest first.  All give the same bytes. */
enum isa {
    ISA_PLAIN,   /* one ray, one point at a time: the reference */
    ISA_GENERIC, /* vectors of two doubles, on any machine */
    ISA_AVX2,
    ISA_AVX512,
    ISA_COUNT,
};

const char *isa_name(enum isa isa);

/* The instruction set of this name; false when there is none. */
bool isa_of_name(struct str name, enum isa *isa);

/* Whether this build has kernels for it and this machine can run them. */
bool isa_available(enum isa isa);

/* The fastest available. */
enum isa isa_best(void);

#endif
