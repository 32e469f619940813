#include "config.h"

#include "lint/checks.h"

enum { CODES_OF_A_CHECK = 10 };

/* Code 0 ends a list: it is no rule of any check. */
static const struct check {
    enum lint_stage stage;
    void (*run)(const struct lint *l);
    enum diag_code codes[CODES_OF_A_CHECK + 1];
} checks[] = {
#define CHECK(stage, function, ...) {stage, function, {__VA_ARGS__}},
#include "lint/checks.def"
#undef CHECK
};
enum { CHECKS = sizeof checks / sizeof *checks };

const struct lint_threshold lint_thresholds[LINT_THRESHOLDS] = {
#define THRESHOLD(name, code, value, meaning) {code, value, meaning},
#include "lint/thresholds.def"
#undef THRESHOLD
};

static bool is_wanted(const struct lint *l, const struct check *c)
{
    for (int i = 0; c->codes[i]; i++)
        if (diag_wants(l->diag, c->codes[i]))
            return true;
    return false;
}

void lint_run(const struct lint *l, enum lint_stage stage)
{
    for (int i = 0; i < CHECKS; i++)
        if (checks[i].stage == stage && is_wanted(l, &checks[i]))
            checks[i].run(l);
}

enum lint_stage lint_stage_of(enum diag_code code)
{
    for (int i = 0; i < CHECKS; i++)
        for (int k = 0; checks[i].codes[k]; k++)
            if (checks[i].codes[k] == code)
                return checks[i].stage;
    return LINT_STAGES;
}

unsigned lint_rules_from(const struct diag *diag, enum lint_stage stage)
{
    unsigned n = 0;
    for (int i = 0; i < DIAG_CODES; i++) {
        enum lint_stage own = lint_stage_of((enum diag_code)i);
        n += own >= stage && own < LINT_STAGES && diag_wants(diag, (enum diag_code)i);
    }
    return n;
}

const char *lint_needs(enum diag_code code)
{
    static const char *const words[LINT_STAGES] = {
        [LINT_TEXT] = "reads the text alone",
        [LINT_DESCRIPTION] = "evaluates the scene, and opens no texture or mesh",
        [LINT_SCENE] = "lowers the scene: textures and meshes are read",
        [LINT_RAYS] = "lowers the scene and traces some rays",
    };
    enum lint_stage stage = lint_stage_of(code);
    return stage == LINT_STAGES ? NULL : words[stage];
}

const struct lint_threshold *lint_threshold_of(enum diag_code code, unsigned n)
{
    for (int i = 0; i < LINT_THRESHOLDS; i++)
        if (lint_thresholds[i].code == code && n-- == 0)
            return &lint_thresholds[i];
    return NULL;
}
