#include "config.h"

#include "base/num.h"

#include "base/mem.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* 10^0 .. 10^22 are exact doubles; an integer below 2^53 times or over one of them is rounded
 * once, hence correctly (Clinger, How to read floating point numbers accurately, 1990). */
static const double exact_power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                     1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                     1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
enum { EXACT_POWERS = sizeof exact_power / sizeof *exact_power, EXPONENT_LIMIT = 100000 };

struct decimal {
    const char *begin, *end; /* the spelling, without the sign */
    uint64_t digits;         /* all digits read as one integer, when there are at most 19 */
    ptrdiff_t digit_count;   /* without the zeros at the left */
    ptrdiff_t exponent;      /* of ten, on `digits` */
    bool negative;
};

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static const char *read_digits(const char *p, const char *end, struct decimal *d)
{
    while (p < end && *p == '0' && !d->digit_count)
        p++;
    const char *first = p;
    uint64_t digits = d->digits;
    for (; p < end && is_digit(*p); p++)
        digits = digits * 10 + (uint64_t)(*p - '0');
    d->digits = digits;
    d->digit_count += p - first;
    return p;
}

static const char *read_exponent(const char *p, const char *end, struct decimal *d)
{
    const char *q = p + 1;
    bool negative = q < end && *q == '-';
    q += q < end && (*q == '-' || *q == '+');
    if (q >= end || !is_digit(*q))
        return p; /* "2em" is the number 2 and a word */
    int e = 0;
    for (; q < end && is_digit(*q); q++)
        e = e < EXPONENT_LIMIT ? e * 10 + (*q - '0') : e;
    d->exponent += negative ? -e : e;
    return q;
}

static bool scan(const char *p, const char *end, struct decimal *d)
{
    *d = (struct decimal){.negative = p < end && *p == '-'};
    p += p < end && (*p == '-' || *p == '+');
    d->begin = p;
    const char *after = read_digits(p, end, d);
    bool any = after > p;
    if (after < end && *after == '.') {
        const char *fraction = after + 1;
        after = read_digits(fraction, end, d);
        d->exponent = fraction - after;
        any = any || after > fraction;
    }
    if (!any)
        return false;
    if (after < end && (*after == 'e' || *after == 'E'))
        after = read_exponent(after, end, d);
    d->end = after;
    return true;
}

/* strtod rounds correctly but wants a NUL after the number, and obeys the locale, which this
 * program never sets. */
static double convert_slowly(const struct decimal *d)
{
    char small[128], *z = small;
    size_t n = (size_t)(d->end - d->begin);
    if (n >= sizeof small)
        z = mem_alloc(n + 1, 1);
    memcpy(z, d->begin, n);
    z[n] = 0;
    double x = strtod(z, NULL);
    if (z != small)
        free(z);
    return x;
}

static double convert(const struct decimal *d)
{
    if (!d->digit_count)
        return 0;
    bool fits = d->digit_count <= 19 && d->digits < (UINT64_C(1) << 53);
    if (fits && d->exponent >= 0 && d->exponent < EXACT_POWERS)
        return (double)d->digits * exact_power[d->exponent];
    if (fits && d->exponent < 0 && -d->exponent < EXACT_POWERS)
        return (double)d->digits / exact_power[-d->exponent];
    return convert_slowly(d);
}

const char *num_parse(const char *p, const char *end, double *out)
{
    struct decimal d;
    if (!scan(p, end, &d))
        return NULL;
    double x = convert(&d);
    *out = d.negative ? -x : x;
    return d.end;
}

size_t num_print(double x, char buf[NUM_PRINT_BYTES])
{
    int n = 0;
    /* every spelling of 15 digits is told apart, but for numbers too small for all their bits */
    int precision = fabs(x) < DBL_MIN ? 1 : 15;
    for (; precision <= 17; precision++) {
        n = snprintf(buf, NUM_PRINT_BYTES, "%.*g", precision, x);
        if (strtod(buf, NULL) == x)
            break;
    }
    return (size_t)n;
}
