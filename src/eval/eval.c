#include "config.h"

#include "eval/context.h"

static void report_unused_defines(struct eval *e)
{
    for (size_t i = 0; i < e->options->define_count; i++)
        if (!e->define_used[i])
            diag_report(e->diag, DIAG_UNKNOWN_PARAM, (struct span){0},
                        "-D %.*s: the scene has no param of this name",
                        STR_ARG(e->options->defines[i].name));
}

bool eval_scene(const struct ast *ast, const struct eval_options *options, struct desc *out,
                struct diag *diag)
{
    *out = (struct desc){.xml = ast->xml, .start = {ast->source->base, ast->source->base}};
    struct eval e = {.options = options, .out = out, .diag = diag};
    size_t errors = diag->errors;
    e.define_used = mem_zalloc(options->define_count, sizeof *e.define_used);
    if (ast->xml)
        eval_xml(&e, ast->statements);
    else
        eval_native(&e, ast->statements);
    report_unused_defines(&e);
    free(e.define_used);
    map_free(&e.names);
    return diag->errors == errors;
}
