/* Vectors of floats for bounds and boxes: four at a time anywhere, and as many as eight where the
 * file that includes this is compiled for it.
 *
 * Floats never reach a picture: they only leave out what cannot matter. */
#ifndef WRT_MATH_FLOATS_H
#define WRT_MATH_FLOATS_H

#include <stdint.h>

#if defined __AVX2__
#include <immintrin.h>
enum { FLOATS = 8 };
#elif defined __SSE2__
#include <emmintrin.h>
enum { FLOATS = 4 };
#else
enum { FLOATS = 4 };
#endif

typedef float vfour __attribute__((vector_size(16)));
typedef int32_t vfour_int __attribute__((vector_size(16)));
typedef float vfloat __attribute__((vector_size(4 * FLOATS)));
typedef float vfloat_in_memory __attribute__((vector_size(4 * FLOATS), aligned(4), may_alias));

/* ---- four -------------------------------------------------------------------------------------
 */

static inline vfour four_all(float a)
{
    return (vfour){a, a, a, a};
}

static inline vfour four_select(vfour_int mask, vfour a, vfour b)
{
    return (vfour)((mask & (vfour_int)a) | (~mask & (vfour_int)b));
}

/* a < b ? a : b, also where one is no number. */
static inline vfour four_min(vfour a, vfour b)
{
#ifdef __SSE2__
    return _mm_min_ps(a, b);
#else
    return four_select(a < b, a, b);
#endif
}

static inline vfour four_max(vfour a, vfour b)
{
#ifdef __SSE2__
    return _mm_max_ps(a, b);
#else
    return four_select(a > b, a, b);
#endif
}

static inline vfour four_abs(vfour a)
{
    return (vfour)((vfour_int)a & INT32_MAX);
}

static inline vfour four_copysign(vfour a, vfour sign)
{
    return (vfour)(((vfour_int)a & INT32_MAX) | ((vfour_int)sign & INT32_MIN));
}

/* ---- as many as there are ---------------------------------------------------------------------
 */

static inline vfloat f_load(const float *p)
{
    return *(const vfloat_in_memory *)p;
}

static inline void f_store(float *p, vfloat a)
{
    *(vfloat_in_memory *)p = a;
}

static inline vfloat f_all(float a)
{
    return a - (vfloat){0};
}

#if defined __AVX2__

static inline vfloat f_min(vfloat a, vfloat b)
{
    return _mm256_min_ps(a, b);
}

static inline vfloat f_max(vfloat a, vfloat b)
{
    return _mm256_max_ps(a, b);
}

/* Bit i: a <= b in lane i. */
static inline unsigned f_at_most(vfloat a, vfloat b)
{
#if defined __AVX512VL__ && defined __AVX512F__
    return _mm256_cmp_ps_mask(a, b, _CMP_LE_OQ);
#else
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
#endif
}

#else

static inline vfloat f_min(vfloat a, vfloat b)
{
    return four_min(a, b);
}

static inline vfloat f_max(vfloat a, vfloat b)
{
    return four_max(a, b);
}

static inline unsigned f_at_most(vfloat a, vfloat b)
{
#ifdef __SSE2__
    return (unsigned)_mm_movemask_ps((__m128)(a <= b));
#else
    vfour_int m = a <= b;
    return (m[0] & 1u) | (m[1] & 2u) | (m[2] & 4u) | (m[3] & 8u);
#endif
}

#endif

/* Of eight. */
static inline float f_least(const float *p)
{
    float least = p[0];
    for (int i = 1; i < 8; i++)
        least = p[i] < least ? p[i] : least;
    return least;
}

static inline float f_most(const float *p)
{
    float most = p[0];
    for (int i = 1; i < 8; i++)
        most = p[i] > most ? p[i] : most;
    return most;
}

/* a b + c.  Beside one rounding of that, which is relative to it, products of |a| <= 1 are off by
 * no more than this times |b|. */
static inline vfloat f_bound(vfloat a, vfloat b, vfloat c)
{
#if defined __AVX2__ && defined __FMA__
    return _mm256_fmadd_ps(a, b, c);
#else
    return a * b + c;
#endif
}

#if defined __AVX2__ && defined __FMA__
#define F_BOUND_ERROR 0.0f
#else
#define F_BOUND_ERROR 0x1p-24f
#endif

#endif
