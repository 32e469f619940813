/* Vectors of doubles for the kernels, as wide as the file that includes this is compiled for.
 *
 * Arithmetic is by the operators, lane by lane, and rounds as for single doubles.  Nothing here
 * fuses or reorders, so that a kernel gives the same bits at any width. */
#ifndef WRT_MATH_LANES_H
#define WRT_MATH_LANES_H

#include "math/angle.h"
#include "math/batch.h"

#if defined __AVX512F__ && defined __AVX512DQ__
#include <immintrin.h>
#define LANES_HAVE_FMA 1
enum { LANES = 8 };
#elif defined __AVX2__ && defined __FMA__
#include <immintrin.h>
#define LANES_HAVE_FMA 1
enum { LANES = 4 };
#else
#define LANES_HAVE_FMA 0 /* fma() is a function there, slower than a division */
enum { LANES = 2 };
#endif

typedef double vreal __attribute__((vector_size(8 * LANES)));
typedef int64_t vint __attribute__((vector_size(8 * LANES)));
typedef double vreal_in_memory __attribute__((vector_size(8 * LANES), aligned(8), may_alias));
typedef int64_t vint_in_memory __attribute__((vector_size(8 * LANES), aligned(8), may_alias));
typedef float vfloats_in_memory
    __attribute__((vector_size(4 * LANES), aligned(4), may_alias)); /* LANES of them */
typedef int32_t vint32 __attribute__((vector_size(4 * LANES)));
typedef int32_t vint32_in_memory __attribute__((vector_size(4 * LANES), aligned(4), may_alias));

static inline vreal v_load(const double *p)
{
    return *(const vreal_in_memory *)p;
}

/* Of floats. */
static inline vreal v_load_floats(const float *p)
{
    return __builtin_convertvector(*(const vfloats_in_memory *)p, vreal);
}

static inline vint v_load_int(const int64_t *p)
{
    return *(const vint_in_memory *)p;
}

static inline void v_store(double *p, vreal a)
{
    *(vreal_in_memory *)p = a;
}

/* Of numbers that floats hold exactly. */
static inline void v_store_floats(float *p, vreal a)
{
    *(vfloats_in_memory *)p = __builtin_convertvector(a, vfloats_in_memory);
}

static inline vint32 v_load_int32(const int32_t *p)
{
    return *(const vint32_in_memory *)p;
}

/* Numbers below 2^31, their fractions cut off. */
static inline vint32 v_int32(vreal a)
{
    return __builtin_convertvector(a, vint32);
}

static inline void v_store_int32(int32_t *p, vint32 a)
{
    *(vint32_in_memory *)p = a;
}

static inline vreal v_real(vint32 a)
{
    return __builtin_convertvector(a, vreal);
}

static inline vreal v_all(double a)
{
    return a - (vreal){0};
}

/* Of whole numbers from 0 to 2^51. */
static inline vreal v_real_of_long(vint a)
{
    return (vreal)(a | (vint)v_all(0x1p52)) - 0x1p52;
}

static inline vint v_long(vint32 a)
{
    return __builtin_convertvector(a, vint);
}

static inline vreal v_abs(vreal a)
{
    return (vreal)((vint)a & INT64_MAX);
}

static inline vreal v_copysign(vreal a, vreal sign)
{
    return (vreal)(((vint)a & INT64_MAX) | ((vint)sign & INT64_MIN));
}

#if defined __AVX512F__ && defined __AVX512DQ__

typedef __mmask8 vmask;

static inline vmask v_less(vreal a, vreal b)
{
    return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
}

static inline vmask v_at_most(vreal a, vreal b)
{
    return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ);
}

static inline vmask v_equal(vreal a, vreal b)
{
    return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ);
}

static inline vmask v_odd(vint a)
{
    return _mm512_test_epi64_mask((__m512i)a, _mm512_set1_epi64(1));
}

static inline bool v_any_int(vint a)
{
    return _mm512_test_epi64_mask((__m512i)a, (__m512i)a) != 0;
}

static inline vmask v_not(vmask m)
{
    return (vmask)~m;
}

static inline bool v_any(vmask m)
{
    return m != 0;
}

/* Bit i: lane i. */
static inline unsigned v_bits(vmask m)
{
    return m;
}

static inline vreal v_select(vmask m, vreal a, vreal b)
{
    return _mm512_mask_blend_pd(m, b, a);
}

static inline vreal v_sqrt(vreal a)
{
    return _mm512_sqrt_pd(a);
}

/* from[at], lane by lane. */
static inline vreal v_gather(const double *from, vint at)
{
    return _mm512_i64gather_pd((__m512i)at, from, sizeof *from);
}

static inline vint v_gather_uint32(const uint32_t *from, vint at)
{
    return (vint)_mm512_cvtepu32_epi64(
        _mm512_i64gather_epi32((__m512i)at, (const int *)from, sizeof *from));
}

static inline vreal v_truncate(vreal a)
{
    return _mm512_roundscale_pd(a, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}

/* a b + c, rounded once. */
static inline vreal v_fma(vreal a, vreal b, vreal c)
{
    return _mm512_fmadd_pd(a, b, c);
}

/* a < b ? a : b, also where one is no number. */
static inline vreal v_min(vreal a, vreal b)
{
    return _mm512_min_pd(a, b);
}

static inline vreal v_max(vreal a, vreal b)
{
    return _mm512_max_pd(a, b);
}

/* Of all lanes. */
static inline double v_least(vreal a)
{
    return _mm512_reduce_min_pd(a);
}

static inline double v_most(vreal a)
{
    return _mm512_reduce_max_pd(a);
}

#else

typedef vint vmask;

static inline vmask v_less(vreal a, vreal b)
{
    return (vmask)(a < b);
}

static inline vmask v_at_most(vreal a, vreal b)
{
    return (vmask)(a <= b);
}

static inline vmask v_equal(vreal a, vreal b)
{
    return (vmask)(a == b);
}

static inline vmask v_odd(vint a)
{
    return (vmask)((a & 1) == 1);
}

static inline vmask v_not(vmask m)
{
    return ~m;
}

#if defined __AVX2__ && defined __FMA__

static inline bool v_any_int(vint a)
{
    return !_mm256_testz_si256((__m256i)a, (__m256i)a);
}

static inline unsigned v_bits(vmask m)
{
    return (unsigned)_mm256_movemask_pd((__m256d)m);
}

static inline vreal v_select(vmask m, vreal a, vreal b)
{
    return _mm256_blendv_pd(b, a, (__m256d)m);
}

static inline vreal v_sqrt(vreal a)
{
    return _mm256_sqrt_pd(a);
}

static inline vreal v_gather(const double *from, vint at)
{
    return _mm256_i64gather_pd(from, (__m256i)at, sizeof *from);
}

static inline vint v_gather_uint32(const uint32_t *from, vint at)
{
    return (vint)_mm256_cvtepu32_epi64(
        _mm256_i64gather_epi32((const int *)from, (__m256i)at, sizeof *from));
}

static inline vreal v_truncate(vreal a)
{
    return _mm256_round_pd(a, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}

static inline vreal v_fma(vreal a, vreal b, vreal c)
{
    return _mm256_fmadd_pd(a, b, c);
}

static inline vreal v_min(vreal a, vreal b)
{
    return _mm256_min_pd(a, b);
}

static inline vreal v_max(vreal a, vreal b)
{
    return _mm256_max_pd(a, b);
}

static inline double v_least(vreal a)
{
    __m128d m = _mm_min_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1));
    return _mm_cvtsd_f64(_mm_min_sd(m, _mm_unpackhi_pd(m, m)));
}

static inline double v_most(vreal a)
{
    __m128d m = _mm_max_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1));
    return _mm_cvtsd_f64(_mm_max_sd(m, _mm_unpackhi_pd(m, m)));
}

#else

static inline bool v_any_int(vint a)
{
    return (a[0] | a[1]) != 0;
}

static inline unsigned v_bits(vmask m)
{
    return (m[0] != 0) | (unsigned)(m[1] != 0) << 1;
}

static inline vreal v_select(vmask m, vreal a, vreal b)
{
    return (vreal)((m & (vint)a) | (~m & (vint)b));
}

static inline vreal v_sqrt(vreal a)
{
    return (vreal){sqrt(a[0]), sqrt(a[1])};
}

static inline vreal v_gather(const double *from, vint at)
{
    return (vreal){from[at[0]], from[at[1]]};
}

static inline vint v_gather_uint32(const uint32_t *from, vint at)
{
    return (vint){from[at[0]], from[at[1]]};
}

static inline vreal v_truncate(vreal a)
{
    return (vreal){trunc(a[0]), trunc(a[1])};
}

static inline vreal v_fma(vreal a, vreal b, vreal c)
{
    return (vreal){fma(a[0], b[0], c[0]), fma(a[1], b[1], c[1])};
}

static inline vreal v_min(vreal a, vreal b)
{
    return v_select((vmask)(a < b), a, b);
}

static inline vreal v_max(vreal a, vreal b)
{
    return v_select((vmask)(b < a), a, b);
}

static inline double v_least(vreal a)
{
    return a[0] < a[1] ? a[0] : a[1];
}

static inline double v_most(vreal a)
{
    return a[0] > a[1] ? a[0] : a[1];
}

#endif

static inline bool v_any(vmask m)
{
    return v_bits(m) != 0;
}

#endif

/* The lowest three bytes of each, the lowest first; 4 LANES bytes may be written. */
static inline void v_store_triples(uint8_t *p, vint32 a)
{
#if LANES_HAVE_FMA
    const __m128i order = _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
    for (int i = 0; i < LANES / 4; i++) {
        __m128i four;
        memcpy(&four, (const char *)&a + i * sizeof four, sizeof four);
        _mm_storeu_si128((__m128i *)(p + 12 * i), _mm_shuffle_epi8(four, order));
    }
#else
    for (int i = 0; i < LANES; i++)
        for (int byte = 0; byte < 3; byte++)
            p[3 * i + byte] = (uint8_t)(a[i] >> 8 * byte);
#endif
}

/* Lanes 0 to n. */
static inline vmask v_first(uint32_t n)
{
    static const double numbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    return v_less(v_load(numbers), v_all(n));
}

static inline vint v_select_int(vmask m, vint a, vint b)
{
    return (vint)v_select(m, (vreal)a, (vreal)b);
}

/* a b + c, rounded once or twice: for bounds only. */
static inline vreal v_bound(vreal a, vreal b, vreal c)
{
#if LANES_HAVE_FMA
    return v_fma(a, b, c);
#else
    return a * b + c;
#endif
}

/* a / b where 1 / b is known.  The same bits as the division's by Markstein's theorem (Computation
 * of elementary functions on the IBM RISC System/6000 processor, IBM J. Res. Dev. 34, 1990):
 * quotients must be 0 or far from overflow and underflow, b's digits not all ones. */
static inline vreal v_quotient(vreal a, double b, double inverse)
{
#if LANES_HAVE_FMA
    vreal q = a * inverse;
    return v_fma(v_fma(v_all(-b), q, a), v_all(inverse), q);
#else
    (void)inverse;
    return a / b;
#endif
}

static inline vreal v_difference_of_products(vreal a, vreal b, vreal c, vreal d)
{
    vreal cd = c * d;
    return v_fma(a, b, -cd) + v_fma(-c, d, cd);
}

/* See angle_of. */
static inline vreal v_angle(vreal x, vreal y)
{
    vreal ax = v_abs(x), ay = v_abs(y), zero = v_all(0);
    vmask steep = v_less(ax, ay);
    vreal lo = v_select(steep, ax, ay), hi = v_select(steep, ay, ax);
    vmask far = v_less(ANGLE_HALF_OCTANT * hi, lo);
    vreal t = v_select(far, lo - hi, lo) / v_select(far, lo + hi, hi);
    vreal square = t * t, fourth = square * square;
    vreal even = v_all(angle_term[ANGLE_TERMS - 1]), odd = v_all(angle_term[ANGLE_TERMS - 2]);
    for (int k = ANGLE_TERMS - 3; k >= 2; k -= 2) {
        even = even * fourth + angle_term[k];
        odd = odd * fourth + angle_term[k - 1];
    }
    even = even * fourth + angle_term[0];
    vreal rest = t + t * square * (even + square * odd), eighths = v_select(far, v_all(1), zero);
    const vmask turned[3] = {steep, v_less(x, zero), v_less(y, zero)};
    for (int i = 0; i < 3; i++) {
        eighths = v_select(turned[i], (2 << i) - eighths, eighths);
        rest = v_select(turned[i], -rest, rest);
    }
    return eighths * (PI / 4) + rest;
}

/* ---- three of them --------------------------------------------------------------------------- */

/* As struct vec3, with the same order of operations in everything. */
struct vvec3 {
    vreal x, y, z;
};

static inline struct vvec3 v3_load(const struct vec3_batch *b, uint32_t i)
{
    return (struct vvec3){v_load(b->x + i), v_load(b->y + i), v_load(b->z + i)};
}

static inline void v3_store(struct vec3_batch *b, uint32_t i, struct vvec3 a)
{
    v_store(b->x + i, a.x);
    v_store(b->y + i, a.y);
    v_store(b->z + i, a.z);
}

/* The element `at` of an array of which `from` is in the first; step: doubles from one to the next.
 */
static inline struct vvec3 v3_gather(const struct vec3 *from, vint at, int step)
{
    const double *x = &from->x;
    at *= step;
    return (struct vvec3){v_gather(x, at), v_gather(x + 1, at), v_gather(x + 2, at)};
}

static inline struct vvec3 v3_all(struct vec3 a)
{
    return (struct vvec3){v_all(a.x), v_all(a.y), v_all(a.z)};
}

static inline struct vvec3 v3_add(struct vvec3 a, struct vvec3 b)
{
    return (struct vvec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vvec3 v3_sub(struct vvec3 a, struct vvec3 b)
{
    return (struct vvec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vvec3 v3_mul(struct vvec3 a, struct vvec3 b)
{
    return (struct vvec3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline struct vvec3 v3_scale(struct vvec3 a, vreal s)
{
    return (struct vvec3){a.x * s, a.y * s, a.z * s};
}

/* a + s b */
static inline struct vvec3 v3_mad(struct vvec3 a, vreal s, struct vvec3 b)
{
    return (struct vvec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline vreal v3_dot(struct vvec3 a, struct vvec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* See vec3_cross_plain. */
static inline struct vvec3 v3_cross_plain(struct vvec3 a, struct vvec3 b)
{
    return (struct vvec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline struct vvec3 v3_normalize(struct vvec3 a)
{
    return v3_scale(a, 1 / v_sqrt(v3_dot(a, a)));
}

static inline struct vvec3 v3_select(vmask m, struct vvec3 a, struct vvec3 b)
{
    return (struct vvec3){v_select(m, a.x, b.x), v_select(m, a.y, b.y), v_select(m, a.z, b.z)};
}

static inline vreal v3_largest(struct vvec3 a)
{
    vreal x = v_abs(a.x), y = v_abs(a.y), z = v_abs(a.z);
    return v_max(v_max(x, y), z);
}

/* ---- four of them, for what has three parts ----------------------------------------------------
 */

typedef double vquad __attribute__((vector_size(32)));
typedef int64_t vquad_int __attribute__((vector_size(32)));
typedef float vquad_floats __attribute__((vector_size(16)));

static inline vquad quad_all(double a)
{
    return (vquad){a, a, a, a};
}

static inline vquad quad_of(struct vec3 a)
{
    return (vquad){a.x, a.y, a.z, 0};
}

static inline vquad quad_abs(vquad a)
{
    return (vquad)((vquad_int)a & INT64_MAX);
}

static inline vquad quad_copysign(vquad a, vquad sign)
{
    return (vquad)(((vquad_int)a & INT64_MAX) | ((vquad_int)sign & INT64_MIN));
}

static inline vquad quad_select(vquad_int mask, vquad a, vquad b)
{
    return (vquad)((mask & (vquad_int)a) | (~mask & (vquad_int)b));
}

static inline bool quad_any(vquad_int mask)
{
    return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
}

static inline vquad_floats quad_floats(vquad a)
{
    return __builtin_convertvector(a, vquad_floats);
}

static inline vquad quad_wide(vquad_floats a)
{
    return __builtin_convertvector(a, vquad);
}

#endif
