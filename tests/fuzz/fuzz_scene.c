/* Scenes, as far as they go: text, description, lint, conversion, lowering, a picture of few pixels. */
#include "config.h"

#include "fuzz.h"

#include "base/fence.h"
#include "convert/translate.h"
#include "diag/fix.h"
#include "diag/print.h"
#include "eval/eval.h"
#include "lint/explain.h"
#include "lint/lint.h"
#include "lint/survey.h"
#include "lower/lower.h"
#include "print/printer.h"
#include "render/render.h"
#include "schema/schema.h"
#include "syntax/syntax.h"
#include "validate/validate.h"

#include <stdio.h>
#include <stdlib.h>

enum { MAX_OBJECTS = 200, PICTURE_SIDE = 2, MOST_DEPTH = 3 };

/* No file can be read inside of this. */
static char nowhere[] = "";
static const struct file_fence closed = {.folder = nowhere, .real = nowhere, .fd = -1};

struct scene_run {
    struct srcmap sources;
    struct diag diag;
    struct diag_policy policy;
    struct ast ast;
    struct desc desc;
    struct lowered lowered;
};

static void begin(struct scene_run *r)
{
    *r = (struct scene_run){.sources.fence = &closed, .policy.lint = true};
    diag_init(&r->diag, &r->sources);
    r->diag.policy = &r->policy;
}

static void end(struct scene_run *r)
{
    lower_free(&r->lowered);
    desc_free(&r->desc);
    ast_free(&r->ast);
    diag_free(&r->diag);
    srcmap_free(&r->sources);
}

static void print_findings(struct scene_run *r)
{
    static const struct diag_book book = {explain_why, explain_code};
    enum { SELDOM = 16 }; /* a SARIF log has all rules in it */
    int last = r->ast.nodes % SELDOM ? DIAG_FORMAT_JSON : DIAG_FORMAT_SARIF;
    FILE *out = fopen("/dev/null", "w");
    for (int format = DIAG_FORMAT_TEXT; out && format <= last; format++) {
        size_t printed = 0;
        struct diag_print_options o = {
            .format = (enum diag_format)format, .book = &book, .printed = &printed};
        diag_print(&r->diag, &o, out);
    }
    if (out)
        fclose(out);
}

static bool parse(struct scene_run *r, const uint8_t *data, size_t n)
{
    const struct source *s = syntax_take(&r->sources, "scene", fuzz_copy(data, n), n,
                                         DIAG_CANNOT_READ, (struct span){0}, &r->diag);
    return s && syntax_parse(s, &r->ast, &r->diag);
}

/* Layout is layout: laid out again it stays as it is; nothing is left of a lone semicolon. */
static void lay_out(const struct ast *ast)
{
    struct buffer once = {0}, twice = {0};
    struct scene_run again;
    print_scene(ast, &once);
    begin(&again);
    if (once.n > 0 && !parse(&again, (const uint8_t *)once.at, once.n))
        abort();
    if (once.n > 0)
        print_scene(&again.ast, &twice);
    if (!str_equal((struct str){once.at, once.n}, (struct str){twice.at, twice.n}))
        abort();
    end(&again);
    buffer_free(&once);
    buffer_free(&twice);
}

static void translate(struct scene_run *r)
{
    struct buffer out = {0};
    struct translation t = {.ast = &r->ast,
                            .desc = &r->desc,
                            .sources = &r->sources,
                            .diag = &r->diag,
                            .beside = "elsewhere/scene"};
    if (r->ast.xml)
        translate_to_native(&t, &out);
    else
        translate_native_moved(&t, &out);
    buffer_free(&out);
}

static void render(const struct scene *scene)
{
    struct render_stats stats;
    struct render_options o = {.width = PICTURE_SIDE,
                               .height = PICTURE_SIDE,
                               .crop = {.x1 = PICTURE_SIDE, .y1 = PICTURE_SIDE},
                               .grid = 1,
                               .depth = scene->depth < MOST_DEPTH ? scene->depth : MOST_DEPTH,
                               .threads = 1,
                               .isa = isa_best()};
    struct picture *p = picture_new(PICTURE_SIDE, PICTURE_SIDE, false);
    picture_encode_as(p, render_encoding(scene, SHOW_PICTURE));
    render_scene(scene, &o, p, &stats);
    picture_free(p);
}

/* As `wrt lint` goes on. */
static void examine(struct scene_run *r)
{
    struct lint l = {.ast = &r->ast, .sources = &r->sources, .diag = &r->diag};
    if (r->ast.statements)
        lint_run(&l, LINT_TEXT);
    if (r->diag.errors)
        return;
    l.desc = &r->desc;
    lint_run(&l, LINT_DESCRIPTION);
    if (!lower_scene(&r->desc, &r->sources, &r->lowered, &r->diag) || !r->desc.camera)
        return;
    l.lowered = &r->lowered;
    l.survey = survey_new(&r->desc, &r->lowered);
    lint_run(&l, LINT_SCENE);
    survey_free(l.survey);
    render(&r->lowered.scene);
}

static void evaluate(struct scene_run *r, const struct eval_define *defines, size_t n)
{
    struct eval_options o = {.max_objects = MAX_OBJECTS,
                             .sources = &r->sources,
                             .defines = defines,
                             .define_count = n};
    eval_scene(&r->ast, &o, &r->desc, &r->diag);
    if (r->desc.camera || !r->diag.errors)
        validate_scene(&r->desc, &r->diag);
}

void fuzz_scene(const uint8_t *data, size_t n)
{
    struct scene_run r;
    struct buffer mended = {0};
    begin(&r);
    bool parsed = parse(&r, data, n);
    if (parsed)
        lay_out(&r.ast);
    if (parsed || (!r.ast.xml && r.ast.statements))
        evaluate(&r, NULL, 0);
    if (parsed && !r.diag.errors)
        translate(&r);
    examine(&r);
    if (r.ast.source)
        diag_fix_text(&r.diag, r.ast.source, true, &mended);
    buffer_free(&mended);
    print_findings(&r);
    end(&r);
}

void fuzz_define(const uint8_t *data, size_t n)
{
    static const char scene[] = "wrt 1\nparam a = 1\nparam b = \"text\"\nlet c = a\n";
    struct scene_run r;
    struct ast value;
    begin(&r);
    char *text = fuzz_copy(data, n);
    size_t length = strnlen(text, n); /* as of an argument */
    const struct source *s = srcmap_add(&r.sources, "<-D a>", text, length);
    syntax_parse_value(&r.sources, s, &value);
    struct eval_define defines[] = {{.name = str_of("a"), .value = value.statements},
                                    {.name = str_of("b"), .value = value.statements}};
    if (parse(&r, (const uint8_t *)scene, sizeof scene - 1))
        evaluate(&r, defines, 2);
    print_findings(&r);
    ast_free(&value);
    end(&r);
}

/* ---- words ----------------------------------------------------------------------------------- */

static void add(struct buffer *out, const char *word)
{
    buffer_add(out, word, strlen(word) + 1);
}

static void add_kinds(struct buffer *out, bool xml)
{
    for (int kind = 0; kind < SCHEMA_KINDS; kind++)
        add(out, schema_kind_name((enum schema_kind)kind, xml));
}

void words_native(struct buffer *out)
{
#define FUNCTION(name, ...) add(out, #name "(");
#include "eval/functions.def"
#undef FUNCTION
#define STATEMENT(word, ...) add(out, word " ");
#include "eval/statements.def"
#undef STATEMENT
    static const char *const others[] = {"deg", "rad", "//", "/*", "*/",  "wrt 1\n", "#ff8000",
                                         "&&",  "||",  "==", "!=", "[i]", "1e308",   "\\u{1F600}"};
    add_kinds(out, false);
    for (int i = 0; i < SCHEMA_PROPS; i++) {
        add(out, schema_props[i].native);
        add(out, ": ");
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        add(out, others[i]);
}

void words_xml(struct buffer *out)
{
    static const char *const others[] = {"<scene>", "<surfaces>", "<lights>", "<textures>", "<item>",
                                         "<class>", "</",         "/>",       " id=\"",     " ref=\""};
    add_kinds(out, true);
    for (int i = 0; i < SCHEMA_PROPS; i++)
        for (const char *at = schema_props[i].xml; *at; at += strspn(at, " ")) {
            size_t n = strcspn(at, " ");
            buffer_printf(out, "<%.*s>%c", (int)n, at, 0);
            at += n;
        }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        add(out, others[i]);
}
