/* Comments that silence rules: `// wrt: allow(NAME, ...)`, `<!-- wrt: allow(NAME) -->`.
 *
 * One behind a statement on its line speaks of that statement; one behind an opening brace or tag
 * of all of that block; any other of the statement that follows. */
#include "config.h"

#include "syntax/allow.h"

#include <string.h>

struct allows {
    const struct ast *ast;
    struct diag *diag;
    size_t next; /* comment */
};

/* What stands around a comment. */
struct surroundings {
    const struct ast_node *before, *after, *around;
    uint32_t opening; /* where what opens the block around ends: its name, attributes, label */
};

static const char *text_at(const struct ast *ast, uint32_t offset)
{
    return ast->source->text + (offset - ast->source->base);
}

static bool on_one_line(const struct ast *ast, uint32_t begin, uint32_t end)
{
    return begin <= end && !memchr(text_at(ast, begin), '\n', end - begin);
}

static struct span covered(const struct ast *ast, const struct surroundings *s, struct span comment)
{
    if (s->before && on_one_line(ast, s->before->span.end, comment.begin))
        return s->before->span;
    if (s->around && !s->before && on_one_line(ast, s->opening, comment.begin))
        return s->around->span;
    return s->after ? s->after->span : (struct span){0, 0};
}

static const char *skip_blanks(const char *at, const char *end)
{
    while (at < end && (*at == ' ' || *at == '\t'))
        at++;
    return at;
}

static const char *skip_letters(const char *at, const char *end)
{
    while (at < end && (((*at | 32) >= 'a' && (*at | 32) <= 'z') || *at == '-' || *at == '_'))
        at++;
    return at;
}

/* A comment that begins with `wrt:` and goes on otherwise: prose, unless it is spelt like the real
 * thing. */
static void check_word(struct diag *diag, struct span span, bool opens)
{
    struct str word = srcmap_text(diag->sources, span);
    if (!word.n || (!opens && str_distance(word, str_of("allow")) > 1))
        return;
    struct diag_entry *e =
        str_is(word, "allow")
            ? diag_report(diag, DIAG_UNUSED_ALLOW, span,
                          "expected 'allow(name)'; nothing is allowed")
            : diag_report(diag, DIAG_UNUSED_ALLOW, span,
                          "no comment of wrt says '%.*s'; nothing is allowed", STR_ARG(word));
    if (!str_is(word, "allow"))
        diag_did_you_mean(e, span, str_of("allow"));
}

/* The names in the comment's parentheses; false when it is another comment. */
static bool find_names(struct allows *a, struct span comment, struct span *names)
{
    struct str text = {text_at(a->ast, comment.begin), comment.end - comment.begin};
    const char *at = text.at, *end = text.at + text.n;
    while (at < end && strchr("/*<!- \t", *at))
        at++;
    if (!str_begins((struct str){at, (size_t)(end - at)}, "wrt:"))
        return false;
    const char *word = skip_blanks(at + strlen("wrt:"), end), *behind = skip_letters(word, end);
    struct span span = {comment.begin + (uint32_t)(word - text.at),
                        comment.begin + (uint32_t)(behind - text.at)};
    at = skip_blanks(behind, end);
    bool opens = at < end && *at == '(';
    const char *close = opens ? memchr(at, ')', (size_t)(end - at)) : NULL;
    if (!close || !str_is((struct str){word, (size_t)(behind - word)}, "allow")) {
        check_word(a->diag, span, opens);
        return false;
    }
    names->begin = comment.begin + (uint32_t)(at + 1 - text.at);
    names->end = comment.begin + (uint32_t)(close - text.at);
    return true;
}

static void take_comment(struct allows *a, const struct surroundings *s)
{
    struct span comment = a->ast->trivia.at[a->next++].span, names;
    if (!find_names(a, comment, &names))
        return;
    struct span where = covered(a->ast, s, comment);
    for (uint32_t at = names.begin; at <= names.end;) {
        const char *text = text_at(a->ast, at), *comma = memchr(text, ',', names.end - at);
        uint32_t end = comma ? at + (uint32_t)(comma - text) : names.end;
        struct str name = str_trim((struct str){text, end - at});
        uint32_t begin = at + (uint32_t)(name.at - text);
        diag_allow(a->diag, where, (struct span){begin, begin + (uint32_t)name.n});
        at = end + 1;
    }
}

static bool has_comment_before(const struct allows *a, uint32_t offset)
{
    return a->next < a->ast->trivia.n && a->ast->trivia.at[a->next].span.begin < offset;
}

static bool opens_block(const struct ast_node *node)
{
    return node->kind == AST_ATTRIBUTE || node->kind == AST_LABEL || node->kind == AST_PARAMETER;
}

/* The comments among these siblings, in and between them, up to `end`.  Trees are not deep. */
static void walk(struct allows *a, const struct ast_node *first, const struct ast_node *around,
                 uint32_t end)
{
    struct surroundings s = {.around = around, .opening = around ? around->name_span.end : 0};
    for (const struct ast_node *n = first; n; n = n->next) {
        s.after = n;
        while (has_comment_before(a, n->span.begin))
            take_comment(a, &s);
        if (has_comment_before(a, n->span.end))
            walk(a, n->children, n->kind == AST_BODY ? around : n, n->span.end);
        if (opens_block(n))
            s.opening = n->span.end;
        else
            s.before = n;
    }
    s.after = NULL;
    while (has_comment_before(a, end))
        take_comment(a, &s);
}

void syntax_find_allows(const struct ast *ast, struct diag *diag)
{
    struct allows a = {.ast = ast, .diag = diag};
    struct str text = {ast->source->text, ast->source->n};
    if (memmem(text.at, text.n, "wrt:", strlen("wrt:")))
        walk(&a, ast->statements, NULL, UINT32_MAX);
}
