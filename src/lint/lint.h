/* What is right and still looks like a mistake: checks on each stage of a scene. */
#ifndef WRT_LINT_LINT_H
#define WRT_LINT_LINT_H

#include "ast/ast.h"
#include "diag/diag.h"
#include "eval/desc.h"
#include "lint/survey.h"

/* What a check needs of the scene, each more than the one before. */
enum lint_stage {
    LINT_TEXT,        /* the tree */
    LINT_DESCRIPTION, /* names resolved, values typed, no errors */
    LINT_SCENE,       /* lowered: meshes and textures are read */
    LINT_RAYS,        /* some rays are traced */
    LINT_STAGES
};

/* A scene under examination; what the stage does not need yet is NULL. */
struct lint {
    const struct ast *ast;
    const struct desc *desc;
    const struct lowered *lowered;
    struct survey *survey; /* of the lowered scene */
    struct srcmap *sources;
    struct diag *diag;
};

/* Runs the checks of one stage, but for those whose rules are all switched off. */
void lint_run(const struct lint *l, enum lint_stage stage);

/* How many rules that are wanted the checks of this stage and the later ones look for. */
unsigned lint_rules_from(const struct diag *diag, enum lint_stage stage);

/* The stage whose checks look for this; LINT_STAGES: none. */
enum lint_stage lint_stage_of(enum diag_code code);

/* What finding this needs of the scene, in words; NULL for what no check here looks for. */
const char *lint_needs(enum diag_code code);

/* A number that decides. */
struct lint_threshold {
    enum diag_code code;
    double value;
    const char *meaning;
};
/* The n-th of those of the rule; NULL behind the last. */
const struct lint_threshold *lint_threshold_of(enum diag_code code, unsigned n);

#endif
