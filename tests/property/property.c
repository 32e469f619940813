/* Properties that hold for any text, tried on random ones.
 *
 *     property COUNT [FIRST]     texts made of the seeds FIRST (1) and on
 *
 * A text that breaks a property is printed, with its seed. */
#include "config.h"

#include "random.h"

#include "base/vec.h"
#include "print/printer.h"
#include "syntax/syntax.h"

#include <stdio.h>
#include <stdlib.h>

/* A text and its tree. */
struct parsed {
    struct srcmap sources;
    struct diag diag;
    struct ast ast;
    struct str text;
};

static bool parse(struct parsed *p, struct str text)
{
    *p = (struct parsed){0};
    char *copy = mem_alloc(text.n + 2, 1);
    memcpy(copy, text.at, text.n);
    const struct source *s = srcmap_add(&p->sources, "scene", copy, text.n);
    diag_init(&p->diag, &p->sources);
    p->text = (struct str){s->text, s->n};
    return syntax_parse(s, &p->ast, &p->diag);
}

static void parsed_free(struct parsed *p)
{
    ast_free(&p->ast);
    diag_free(&p->diag);
    srcmap_free(&p->sources);
}

/* ---- what must be the same ---- */

static bool is_token(const struct ast_node *n)
{
    return n->kind == AST_NUMBER || n->kind == AST_ANGLE || n->kind == AST_STRING ||
           n->kind == AST_BOOL || n->kind == AST_COLOUR || n->kind == AST_NAME ||
           n->kind == AST_TEXT;
}

static struct str spelling(const struct parsed *p, struct span span)
{
    return srcmap_text(&p->sources, span);
}

static bool same_trees(const struct parsed *pa, const struct ast_node *a, const struct parsed *pb,
                       const struct ast_node *b)
{
    for (; a && b; a = a->next, b = b->next) {
        bool same = a->kind == b->kind && a->unit == b->unit && a->operator == b->operator &&
                    str_equal(a->name, b->name);
        if (a->kind == AST_BLOCK || a->kind == AST_DEFAULT)
            same = same && str_equal(a->label, b->label);
        if (is_token(a))
            same = same && str_equal(spelling(pa, a->span), spelling(pb, b->span));
        if (!same || !same_trees(pa, a->children, pb, b->children))
            return false;
    }
    return !a && !b;
}

/* A text's bytes without white space and the separators that the layout may leave out; a comment
 * keeps its bytes, but for blanks at the ends of its lines and before them. */
static void squeeze(const struct parsed *p, struct buffer *out)
{
    size_t comment = 0;
    for (uint32_t i = 0; i < p->text.n; i++) {
        const struct trivia *c = comment < p->ast.trivia.n ? &p->ast.trivia.at[comment] : NULL;
        uint32_t at = p->ast.source->base + i;
        bool inside = c && at >= c->span.begin;
        if (strchr(" \t\r\n,;", p->text.at[i]) == NULL || (inside && strchr(",;", p->text.at[i])))
            buffer_add(out, p->text.at + i, 1);
        comment += inside && at + 1 == c->span.end;
    }
}

static bool same_squeezed(const struct parsed *a, const struct parsed *b)
{
    struct buffer x = {0}, y = {0};
    squeeze(a, &x);
    squeeze(b, &y);
    bool same = str_equal((struct str){x.at, x.n}, (struct str){y.at, y.n}) &&
                a->ast.trivia.n == b->ast.trivia.n;
    buffer_free(&x);
    buffer_free(&y);
    return same;
}

/* ---- the layout ---- */

/* No blanks at the ends of lines, no two blank lines, one newline at the end. */
static bool is_tidy(struct str text)
{
    if (!text.n || text.at[text.n - 1] != '\n' || text.at[0] == '\n')
        return false;
    for (size_t i = 1; i < text.n; i++)
        if (text.at[i] == '\n' && strchr(" \t\r", text.at[i - 1]))
            return false;
    return true;
}

static const char *broken_layout(const struct parsed *first)
{
    struct buffer once = {0}, twice = {0};
    struct parsed second = {0};
    print_scene(&first->ast, &once);
    struct str text = {once.at, once.n};
    const char *broken = NULL;
    if (!parse(&second, text))
        broken = "fmt(x) parses";
    else if (!same_trees(first, first->ast.statements, &second, second.ast.statements))
        broken = "parse(fmt(x)) = parse(x)";
    else if (!same_squeezed(first, &second))
        broken = "tokens and comments keep their order";
    else if (!is_tidy(text))
        broken = "fmt(x) is tidy";
    if (!broken) {
        print_scene(&second.ast, &twice);
        if (!str_equal(text, (struct str){twice.at, twice.n}))
            broken = "fmt(fmt(x)) = fmt(x)";
    }
    if (broken)
        printf("---- once:\n%.*s---- twice:\n%.*s", STR_ARG(once), STR_ARG(twice));
    parsed_free(&second);
    buffer_free(&once);
    buffer_free(&twice);
    return broken;
}

static bool holds(uint64_t seed)
{
    struct buffer text = {0};
    struct parsed p;
    random_native(seed, &text);
    const char *broken = parse(&p, (struct str){text.at, text.n}) ? broken_layout(&p) : "x parses";
    if (broken)
        printf("---- seed %llu, broken: %s\n%.*s\n", (unsigned long long)seed, broken,
               STR_ARG(text));
    parsed_free(&p);
    buffer_free(&text);
    return !broken;
}

int main(int argc, char **argv)
{
    unsigned long count = argc > 1 ? strtoul(argv[1], NULL, 10) : 300;
    uint64_t first = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    for (uint64_t seed = first; seed < first + count; seed++)
        if (!holds(seed))
            return EXIT_FAILURE;
    printf("%lu random texts\n", count);
    return EXIT_SUCCESS;
}
