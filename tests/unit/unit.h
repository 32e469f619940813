/* The suites of tests/unit: one a file, listed in unit.c. */
#ifndef WRT_TESTS_UNIT_H
#define WRT_TESTS_UNIT_H

#include <check.h>

Suite *image_suite(void);
Suite *mesh_suite(void);

#endif
