#include "config.h"

#include "base/isa.h"

static const char *const names[] = {"plain", "generic", "avx2", "avx512"};
_Static_assert(sizeof names / sizeof *names == ISA_COUNT, "a name for every instruction set");

const char *isa_name(enum isa isa)
{
    return names[isa];
}

bool isa_of_name(struct str name, enum isa *isa)
{
    for (int i = 0; i < ISA_COUNT; i++) {
        if (str_is(name, names[i])) {
            *isa = (enum isa)i;
            return true;
        }
    }
    return false;
}

bool isa_available(enum isa isa)
{
#ifdef HAVE_X86_KERNELS
    if (isa == ISA_AVX2)
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (isa == ISA_AVX512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma");
#endif
    return isa == ISA_PLAIN || isa == ISA_GENERIC;
}

enum isa isa_best(void)
{
    enum isa best = ISA_GENERIC;
    for (int i = 0; i < ISA_COUNT; i++)
        best = isa_available((enum isa)i) ? (enum isa)i : best;
    return best;
}
