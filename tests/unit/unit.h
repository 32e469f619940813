/* The suites of tests/unit: one a file, listed in unit.c. */
#ifndef WRT_TESTS_UNIT_H
#define WRT_TESTS_UNIT_H

#include <check.h>

/* Under a sanitizer or valgrind less is tried of what takes long. */
#if defined __SANITIZE_ADDRESS__ || defined FEW_TRIES
#define SANITIZED(less, all) (less)
#else
#define SANITIZED(less, all) (all)
#endif

Suite *base_suite(void);
Suite *bvh_suite(void);
Suite *cubature_suite(void);
Suite *diag_suite(void);
Suite *eval_suite(void);
Suite *farm_suite(void);
Suite *formats_suite(void);
Suite *export_suite(void);
Suite *geometry_suite(void);
Suite *image_suite(void);
Suite *kernels_suite(void);
Suite *language_suite(void);
Suite *instance_suite(void);
Suite *lint_suite(void);
Suite *lower_suite(void);
Suite *lsp_suite(void);
Suite *measures_suite(void);
Suite *mesh_suite(void);
Suite *print_suite(void);
Suite *modern_suite(void);
Suite *render_suite(void);
Suite *schema_suite(void);
Suite *sight_suite(void);
Suite *syntax_suite(void);
Suite *texture_suite(void);
Suite *transform_suite(void);
Suite *translate_suite(void);
Suite *tree_suite(void);

#endif
