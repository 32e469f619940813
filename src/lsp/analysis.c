#include "config.h"

#include "lsp/analysis.h"

#include "eval/eval.h"
#include "lint/lint.h"
#include "syntax/syntax.h"
#include "validate/validate.h"

#include <stdlib.h>

/* Editors keep a byte order mark, which the language has no place for; a copy that the scanners may
 * write to. */
static const struct source *add_source(struct analysis *a, const struct document *doc)
{
    static const char mark[] = "\xEF\xBB\xBF";
    char *copy = mem_alloc(doc->text.n + 2, 1);
    if (doc->text.n)
        memcpy(copy, doc->text.at, doc->text.n);
    if (doc->text.n >= 3 && memcmp(copy, mark, 3) == 0)
        memset(copy, ' ', 3);
    return srcmap_add(&a->sources, doc->path, copy, doc->text.n);
}

/* A comment may allow what only a stage finds that is not run here: it is no use to say so. */
static void pass_later_allows(struct diag *diag)
{
    for (size_t i = 0; i < diag->allows.n; i++)
        for (int code = 0; code < DIAG_CODES; code++)
            if (diag->allows.at[i].selection.has[code] &&
                lint_stage_of((enum diag_code)code) > LINT_DESCRIPTION)
                diag->allows.at[i].used = true;
}

static void lint(struct analysis *a)
{
    struct lint l = {.ast = &a->ast, .sources = &a->sources, .diag = &a->diag};
    if (a->ast.statements)
        lint_run(&l, LINT_TEXT);
    if (a->diag.errors)
        return;
    l.desc = &a->desc;
    lint_run(&l, LINT_DESCRIPTION);
    pass_later_allows(&a->diag);
    diag_report_unused_allows(&a->diag);
}

/* As the command line goes on after syntax errors. */
static void evaluate(struct analysis *a, const struct lsp_options *options)
{
    struct eval_options o = {
        .max_objects = options->max_objects,
        .sources = &a->sources,
        .folders = options->folders,
        .folder_count = options->folder_count,
    };
    a->parsed = syntax_parse(a->source, &a->ast, &a->diag);
    if (!a->parsed && (a->ast.xml || !a->ast.statements))
        return; /* what follows would be of the mistakes found */
    eval_scene(&a->ast, &o, &a->desc, &a->diag);
    a->desc.incomplete |= desc_is_part(&a->desc, &a->ast);
    if (a->parsed || a->desc.camera)
        validate_scene(&a->desc, &a->diag);
}

const struct analysis *analysis_of(struct document *doc, const struct lsp_options *options)
{
    if (doc->analysis)
        return doc->analysis;
    struct analysis *a = mem_zalloc(1, sizeof *a);
    diag_init(&a->diag, &a->sources);
    a->diag.policy = options->policy;
    a->sources.fence = options->fence;
    a->source = add_source(a, doc);
    if (!a->source) {
        free(a);
        return NULL;
    }
    evaluate(a, options);
    lint(a);
    diag_sort(&a->diag);
    bindings_build(&a->bindings, &a->ast, &a->desc);
    return doc->analysis = a;
}

void analysis_free(struct analysis *a)
{
    if (!a)
        return;
    bindings_free(&a->bindings);
    desc_free(&a->desc);
    ast_free(&a->ast);
    diag_free(&a->diag);
    srcmap_free(&a->sources);
    free(a);
}
