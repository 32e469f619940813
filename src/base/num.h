/* Decimal numbers to doubles and back, exact and independent of the locale. */
#ifndef WRT_BASE_NUM_H
#define WRT_BASE_NUM_H

#include <stdbool.h>
#include <stddef.h>

/* Reads the longest number at [p, end): optional sign, digits with optional point (at least one
 * digit), optional exponent.  `nan`, `inf` and hexadecimal forms are not numbers.  *out is the
 * double nearest to the spelling (infinite when it is too large).  Returns where reading stopped,
 * or NULL when there is no number. */
const char *num_parse(const char *p, const char *end, double *out);

/* The shortest decimal spelling that reads back as x, in buf; returns its length. */
enum { NUM_PRINT_BYTES = 32 };
size_t num_print(double x, char buf[NUM_PRINT_BYTES]);

#endif
