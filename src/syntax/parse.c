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

static void run(const struct source *source, int start_token, struct ast *out, struct diag *diag)
{
    struct span start = {source->base, source->base};
    struct parser p = {.ast = out,
                       .diag = diag,
                       .source = source,
                       .start = start_token,
                       .at = source->base,
                       .previous = start,
                       .now = start};
    if (!open_scanner(&p, out->xml))
        mem_exhausted(source->n);
    if (scene_parse(&p) == 2 && !p.stopped)
        mem_exhausted(source->n);
    close_scanner(&p, out->xml);
    vec_free(&p.open);
}

bool syntax_parse(const struct source *source, struct ast *out, struct diag *diag)
{
    struct str text = {source->text, source->n};
    size_t errors = diag->errors;
    ast_init(out, source, syntax_is_xml(text));
    if (!str_trim(text).n)
        diag_report(diag, DIAG_EMPTY_FILE, (struct span){source->base, source->base},
                    "the file is empty, so there is no scene");
    else
        run(source, out->xml ? TOKEN_START_XML : TOKEN_START_NATIVE, out, diag);
    syntax_find_allows(out, diag);
    return diag->errors == errors;
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
