#include "config.h"

#include "render/tracer.h"

const struct render_kernels *render_kernels_of(enum isa isa)
{
    static const struct render_kernels *const kernels[ISA_COUNT] = {
        [ISA_PLAIN] = &render_plain,
        [ISA_GENERIC] = &render_generic,
#ifdef HAVE_X86_KERNELS
        [ISA_AVX2] = &render_avx2,
        [ISA_AVX512] = &render_avx512,
#endif
    };
    return kernels[isa];
}

/* Whole exponents up to this are multiplied out: 1e-13 off at most, and several times faster than
 * pow. */
enum { SQUARED_LIMIT = 1000 };

struct finish finish_of(const struct material *m)
{
    bool matt = m->kind == MATERIAL_LAMBERT || m->kind == MATERIAL_EMISSIVE;
    bool whole = m->exponent <= SQUARED_LIMIT && m->exponent == floor(m->exponent);
    bool dull = matt || (whole && vec3_is_zero(m->specular)); /* 0 times a number is nothing */
    bool spread = m->kind == MATERIAL_METAL && m->texture != TEXTURE_NONE;
    return (struct finish){.material = m,
                           .specular = dull ? vec3_all(0) : m->specular,
                           .power = whole && !dull ? (unsigned)m->exponent : 0,
                           .squared = whole || dull,
                           .uneven = spread || !(whole || dull),
                           .bounces = !vec3_is_zero(m->reflection) || !vec3_is_zero(m->refraction),
                           .glows = m->kind == MATERIAL_EMISSIVE};
}

/* x^n by repeated squaring: every step rounds, so the error is below n 2^-53. */
static double whole_power(double x, unsigned n)
{
    double result = n & 1 ? x : 1;
    while (n >>= 1) {
        x *= x;
        result = n & 1 ? result * x : result;
    }
    return result;
}

/* A fractional power of a negative cosine is no number. */
double finish_highlight(const struct finish *f, double cosine)
{
    return f->squared ? whole_power(cosine, f->power) : pow(cosine, f->material->exponent);
}

/* A textured metal spreads the mean of its three channels. */
struct vec3 finish_diffuse(const struct finish *f, struct vec3 diffuse, double cosine)
{
    const struct material *m = f->material;
    struct vec3 lit = vec3_scale(diffuse, cosine);
    if (m->kind != MATERIAL_METAL || m->texture == TEXTURE_NONE)
        return lit;
    return vec3_scale(m->diffuse, (lit.x + lit.y + lit.z) / 3);
}
