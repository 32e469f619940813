/* The checks and their numbers (used by lint_run). */
#ifndef WRT_LINT_CHECKS_H
#define WRT_LINT_CHECKS_H

#include "lint/lint.h"

/* LINT_NAME for each threshold. */
enum lint_threshold_number {
#define THRESHOLD(name, code, value, meaning) LINT_NUMBER_##name,
#include "lint/thresholds.def"
#undef THRESHOLD
    LINT_THRESHOLDS
};
extern const struct lint_threshold lint_thresholds[LINT_THRESHOLDS];

/* LINT(NAME) is the threshold's value. */
#define LINT(name) (lint_thresholds[LINT_NUMBER_##name].value)

#define CHECK(stage, function, ...) void function(const struct lint *l);
#include "lint/checks.def"
#undef CHECK

#endif
