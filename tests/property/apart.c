#include "config.h"

#include "apart.h"

#include "eval/eval.h"
#include "random.h"
#include "syntax/syntax.h"
#include "validate/validate.h"

/* ---- texts ---- */

/* Takes the place of the n bytes at `at`. */
static void replace(struct buffer *text, size_t at, size_t n, struct str with)
{
    struct buffer changed = {0};
    buffer_add(&changed, text->at, at);
    buffer_str(&changed, with);
    buffer_add(&changed, text->at + at + n, text->n - at - n);
    buffer_free(text);
    *text = changed;
}

/* Behind the next byte that a member or value may follow, or at the end. */
static size_t behind_joint(const struct buffer *text, size_t at)
{
    while (at < text->n && !strchr("{:;,", text->at[at]))
        at++;
    return at < text->n ? at + 1 : at;
}

void damage(uint64_t seed, struct buffer *text)
{
    static const char pieces[] =
        "{ } ( ) [ ] , ; : = ? . - + a 1deg -2.5e1 1e999 1e99 -.5\t+1 (1,-2) "
        "(1,2,3,4), (1,2).x (1) a:1; a:b{ let:1\t; assert\ta,a:1,b:2 a:1\tin "
        "a:if{ a:texture{ let for in if else default model texture";
    struct random r = {seed};
    for (unsigned n = random_below(&r, 4); n > 0; n--) {
        bool joint = random_once_in(&r, 2);
        size_t at = random_below(&r, (unsigned)text->n), length = random_below(&r, 6);
        struct str with = random_once_in(&r, 3) ? (struct str){0} : random_word(&r, pieces);
        at = joint ? behind_joint(text, at) : at;
        replace(text, at, length < text->n - at ? length : text->n - at, with);
    }
}

/* Bytes of the string or comment that begins at `at`, or 0. */
static size_t skipped_length(struct str text, size_t at)
{
    size_t end = at + 1;
    bool second = end < text.n && text.at[at] == '/';
    if (text.at[at] == '"') {
        while (end < text.n && text.at[end] != '"' && text.at[end] != '\n')
            end += text.at[end] == '\\' && end + 1 < text.n && text.at[end + 1] != '\n' ? 2 : 1;
        return (end < text.n ? end + 1 : text.n) - at;
    }
    if (second && text.at[end] == '/') {
        const char *newline = memchr(text.at + at, '\n', text.n - at);
        return newline ? (size_t)(newline - text.at) - at : text.n - at;
    }
    if (second && text.at[end] == '*') {
        const char *close = memmem(text.at + at + 2, text.n - at - 2, "*/", 2);
        return close ? (size_t)(close + 2 - text.at) - at : text.n - at;
    }
    return 0;
}

void put_colons(struct str text, bool comments, struct buffer *out)
{
    for (size_t i = 0, n; i < text.n; i += n) {
        size_t skipped = skipped_length(text, i);
        n = skipped ? skipped : 1;
        buffer_add(out, text.at + i, n);
        if (text.at[i] == ':')
            buffer_puts(out, comments ? " /**/ " : "      ");
    }
    buffer_add(out, "", 1);
}

void read_all(struct load *l, const char *text)
{
    struct eval_options options = {.max_objects = 1000, .sources = &l->sources};
    load_text(l, "scene", text);
    bool parsed = syntax_parse(l->source, &l->ast, &l->diag);
    eval_scene(&l->ast, &options, &l->desc, &l->diag);
    if (parsed)
        validate_scene(&l->desc, &l->diag);
}

/* ---- trees ---- */

static bool is_token(const struct ast_node *n)
{
    return n->kind == AST_NUMBER || n->kind == AST_ANGLE || n->kind == AST_STRING ||
           n->kind == AST_BOOL || n->kind == AST_COLOUR || n->kind == AST_NAME ||
           n->kind == AST_TEXT;
}

static bool same_spelling(const struct load *a, struct span x, const struct load *b, struct span y)
{
    return str_equal(srcmap_text(&a->sources, x), srcmap_text(&b->sources, y));
}

static bool same_children(const struct load *la, const struct ast_node *a, const struct load *lb,
                          const struct ast_node *b)
{
    if (a->kind != AST_PROPERTY)
        return same_trees(la, a->children, lb, b->children);
    struct arena arena = {0};
    bool same = same_trees(la, ast_value(a, &arena), lb, ast_value(b, &arena));
    arena_free(&arena);
    return same;
}

bool same_trees(const struct load *la, const struct ast_node *a, const struct load *lb,
                const struct ast_node *b)
{
    for (; a && b; a = a->next, b = b->next) {
        bool same = a->kind == b->kind && a->unit == b->unit &&
                    a->operator== b->operator&& str_equal(a->name, b->name);
        if (a->kind == AST_BLOCK || a->kind == AST_DEFAULT)
            same = same && str_equal(a->label, b->label);
        if (a->kind == AST_NUMBER)
            same = same && a->number == b->number;
        if (is_token(a))
            same = same && same_spelling(la, a->span, lb, b->span);
        if (!same || !same_children(la, a, lb, b))
            return false;
    }
    return !a && !b;
}

/* ---- places ---- */

static bool same_span(struct span a, struct span b)
{
    return a.begin == b.begin && a.end == b.end;
}

static bool same_places(const struct ast_node *a, const struct ast_node *b)
{
    struct arena arena = {0};
    bool same = true;
    for (; same && a && b; a = a->next, b = b->next) {
        bool property = a->kind == AST_PROPERTY;
        same = same_span(a->span, b->span) && same_span(a->name_span, b->name_span) &&
               same_places(property ? ast_value(a, &arena) : a->children,
                           property ? ast_value(b, &arena) : b->children);
    }
    arena_free(&arena);
    return same;
}

/* ---- what was reported ---- */

static bool same_entry(const struct diag_entry *a, const struct diag_entry *b)
{
    bool same = a->code == b->code && same_span(a->span, b->span) &&
                strcmp(a->message, b->message) == 0 && a->labels.n == b->labels.n &&
                a->notes.n == b->notes.n && a->fixits.n == b->fixits.n &&
                a->frames.n == b->frames.n && a->repeats == b->repeats;
    for (size_t i = 0; same && i < a->labels.n; i++)
        same = same_span(a->labels.at[i].span, b->labels.at[i].span);
    for (size_t i = 0; same && i < a->notes.n; i++)
        same = strcmp(a->notes.at[i], b->notes.at[i]) == 0;
    return same;
}

static bool same_entries(const struct diag *a, const struct diag *b)
{
    bool same = a->entries.n == b->entries.n && a->errors == b->errors;
    for (size_t i = 0; same && i < a->entries.n; i++)
        same = same_entry(a->entries.at[i], b->entries.at[i]);
    return same;
}

/* ---- the description ---- */

static bool holds_numbers(enum schema_prop_id id)
{
    enum schema_type type = schema_props[id].type;
    return type <= TYPE_ROTATION || type == TYPE_SIZE;
}

static bool same_objects(const struct desc_object *a, const struct desc_object *b)
{
    const struct desc_prop *p = a->props, *q = b->props;
    bool same = a->kind == b->kind && same_span(a->span, b->span) && a->broken == b->broken;
    for (; same && p && q; p = p->next, q = q->next)
        same = p->id == q->id && p->broken == q->broken && same_span(p->name_span, q->name_span) &&
               same_span(p->value.span, q->value.span) && p->value.n == q->value.n &&
               (!holds_numbers((enum schema_prop_id)p->id) || p->broken ||
                memcmp(p->value.number, q->value.number, sizeof p->value.number) == 0);
    return same && !p && !q;
}

#define SAME_ALL(list)                             \
    for (size_t i = 0; same && i < a->list.n; i++) \
    same = same_objects(a->list.at[i], b->list.at[i])

static bool same_descriptions(const struct desc *a, const struct desc *b)
{
    bool same = !a->camera == !b->camera && a->materials.n == b->materials.n &&
                a->lights.n == b->lights.n && a->surfaces.n == b->surfaces.n;
    if (same && a->camera)
        same = same_objects(a->camera, b->camera);
    SAME_ALL(materials);
    SAME_ALL(lights);
    SAME_ALL(surfaces);
    return same;
}

bool same_reading(const struct load *a, const struct load *b)
{
    return same_entries(&a->diag, &b->diag) &&
           same_trees(a, a->ast.statements, b, b->ast.statements) &&
           same_places(a->ast.statements, b->ast.statements) &&
           same_descriptions(&a->desc, &b->desc);
}
