/* Runs every suite (CK_RUN_SUITE=name: that one). */
#include "config.h"

#include "unit.h"

#include <stdlib.h>

int main(void)
{
    SRunner *runner = srunner_create(NULL);
    srunner_add_suite(runner, base_suite());
    srunner_add_suite(runner, diag_suite());
    srunner_add_suite(runner, schema_suite());
    srunner_add_suite(runner, syntax_suite());
    srunner_add_suite(runner, eval_suite());
    srunner_add_suite(runner, language_suite());
    srunner_add_suite(runner, lower_suite());
    srunner_add_suite(runner, lint_suite());
    srunner_add_suite(runner, lsp_suite());
    srunner_add_suite(runner, export_suite());
    srunner_add_suite(runner, image_suite());
    srunner_add_suite(runner, measures_suite());
    srunner_add_suite(runner, farm_suite());
    srunner_add_suite(runner, formats_suite());
    srunner_add_suite(runner, mesh_suite());
    srunner_add_suite(runner, bvh_suite());
    srunner_add_suite(runner, tree_suite());
    srunner_add_suite(runner, geometry_suite());
    srunner_add_suite(runner, instance_suite());
    srunner_add_suite(runner, cubature_suite());
    srunner_add_suite(runner, kernels_suite());
    srunner_add_suite(runner, print_suite());
    srunner_add_suite(runner, modern_suite());
    srunner_add_suite(runner, render_suite());
    srunner_add_suite(runner, sight_suite());
    srunner_add_suite(runner, texture_suite());
    srunner_add_suite(runner, transform_suite());
    srunner_add_suite(runner, translate_suite());
    srunner_run_all(runner, CK_ENV);
    int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
