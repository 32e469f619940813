/* One text through its scanner and the grammar. */
#include "config.h"

#include "syntax/syntax.h"

#include "syntax/allow.h"
#include "syntax/parser.h"

#include "grammar/scene.tab.h"

#include "grammar/native.lex.h"
#include "grammar/xml.lex.h"

#include <string.h>

/* The scanners work in the source's own buffer (its two NULs are flex's end marks). */
static bool open_scanner(struct parser *p, bool xml)
{
    char *text = p->source->text;
    size_t n = (size_t)p->source->n + 2;
    if (xml)
        return xml_lex_init_extra(p, &p->scanner) == 0 && xml__scan_buffer(text, n, p->scanner);
    return native_lex_init_extra(p, &p->scanner) == 0 && native__scan_buffer(text, n, p->scanner);
}

static void close_scanner(struct parser *p, bool xml)
{
    (xml ? xml_release : native_release)(p->scanner);
    (xml ? xml_lex_destroy : native_lex_destroy)(p->scanner);
}

/* Parses the text once, given the brackets that are known to be missing. */
static void run_once(struct parser *p)
{
    bool xml = p->ast->xml;
    p->at = p->source->base;
    p->previous = p->now = (struct span){p->at, p->at};
    if (!open_scanner(p, xml))
        mem_exhausted(p->source->n);
    if (scene_parse(p) == 2 && !p->stopped)
        mem_exhausted(p->source->n);
    close_scanner(p, xml);
    vec_free(&p->open);
}

/* Adds a brace that is missing to those known; false when there is none. */
static bool find_missing(struct parser *p)
{
    struct missing m;
    if (p->ast->xml || !p->astray || p->missing_count == MISSING_LIMIT ||
        !parser_find_unclosed(p, &m))
        return false;
    unsigned i = p->missing_count++;
    for (; i > 0 && p->missing[i - 1].place > m.place; i--)
        p->missing[i] = p->missing[i - 1];
    p->missing[i] = m;
    return true;
}

/* What was reported and made is taken back, and the text parsed again. */
static void run_again(struct parser *p, const struct parser *last, const struct diag_mark *mark)
{
    bool xml = last->ast->xml;
    diag_rewind(last->diag, mark);
    ast_free(last->ast);
    ast_init(last->ast, last->source, xml);
    *p = (struct parser){
        .ast = last->ast, .diag = last->diag, .source = last->source, .start = p->start};
    memcpy(p->missing, last->missing, sizeof p->missing);
    p->missing_count = last->missing_count;
    run_once(p);
}

/* A wrong text in which braces are not closed is parsed again with them closed where they should
 * be, so that what follows is not taken for a part of a block; unless that explains less. */
static void run(const struct source *source, int start_token, struct ast *out, struct diag *diag)
{
    struct diag_mark mark = diag_mark(diag);
    struct parser p = {.ast = out, .diag = diag, .source = source, .start = start_token};
    struct parser again = {.start = start_token};
    run_once(&p);
    size_t errors = diag->errors;
    if (!find_missing(&p))
        return;
    while (find_missing(&p)) {
    }
    run_again(&again, &p, &mark);
    if (diag->errors <= errors + p.missing_count)
        return;
    p.missing_count = 0;
    again.start = start_token;
    run_again(&again, &p, &mark);
}

/* Told behind everything else, so that a comment can allow it. */
static void check_version(const struct ast *ast, struct diag *diag)
{
    const struct ast_node *first = ast->statements;
    if (ast->xml || !first || first->kind == AST_VERSION || first->kind == AST_ERROR)
        return;
    struct span start = {first->span.begin, first->span.begin};
    struct diag_entry *e = diag_report(diag, DIAG_MISSING_VERSION, start,
                                       "the scene does not say its version; 'wrt 1' is taken");
    diag_fix(e, start, DIAG_FIX_SAFE, "wrt 1\n");
}

bool syntax_parse(const struct source *source, struct ast *out, struct diag *diag)
{
    struct str text = {source->text, source->n};
    size_t failures = diag_failures(diag);
    ast_init(out, source, syntax_is_xml(text));
    if (!str_trim(text).n)
        diag_report(diag, DIAG_EMPTY_FILE, (struct span){source->base, source->base},
                    "the file is empty, so there is no scene");
    else
        run(source, out->xml ? TOKEN_START_XML : TOKEN_START_NATIVE, out, diag);
    syntax_find_allows(out, diag);
    check_version(out, diag);
    return diag_failures(diag) == failures;
}

/* True when the tree takes a component that no value has, as in `wood.png`. */
static bool has_stray_member(const struct ast_node *n)
{
    static const char components[] = "xyzrgb";
    for (; n; n = n->next) {
        bool known = n->name.n == 1 && memchr(components, *n->name.at, sizeof components - 1);
        if ((n->kind == AST_MEMBER && !known) || has_stray_member(n->children))
            return true;
    }
    return false;
}

void syntax_parse_value(const struct srcmap *sources, const struct source *source, struct ast *out)
{
    struct diag silent;
    diag_init(&silent, sources);
    ast_init(out, source, false);
    run(source, TOKEN_START_VALUE, out, &silent);
    if (silent.errors || !out->statements || has_stray_member(out->statements))
        out->statements = ast_text(out, AST_STRING, (struct span){source->base, source->base},
                                   (struct str){source->text, source->n});
    diag_free(&silent);
}
