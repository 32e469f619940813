/* What the checks share. */
#include "config.h"

#include "lint/checks.h"

#include <string.h>

static void look_at(const struct lint *l, struct desc_object *const *objects, size_t n,
                    lint_look *look)
{
    for (size_t i = 0; i < n; i++) {
        l->diag->frame = objects[i]->frame;
        look(l, objects[i]);
    }
    l->diag->frame = NULL;
}

void lint_each_surface(const struct lint *l, lint_look *look)
{
    look_at(l, l->desc->surfaces.at, l->desc->surfaces.n, look);
}

void lint_each_light(const struct lint *l, lint_look *look)
{
    look_at(l, l->desc->lights.at, l->desc->lights.n, look);
}

void lint_each_material(const struct lint *l, lint_look *look)
{
    look_at(l, l->desc->materials.at, l->desc->materials.n, look);
}

const struct desc_value *lint_own(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_prop *p = desc_find(o, id);
    return p && !p->inherited ? &p->value : NULL;
}

struct span lint_place(const struct desc_object *o, enum schema_prop_id id)
{
    const struct desc_value *v = desc_get(o, id);
    return v ? v->span : o->span;
}

struct span lint_extent(const struct desc_object *o, const struct desc_prop *p)
{
    bool elements = o->xml && schema_leaf_count((enum schema_prop_id)p->id) > 1;
    return elements ? span_join(p->name_span, p->value.span) : p->value.span;
}

struct str lint_name(const struct desc_object *o, enum schema_prop_id id)
{
    return schema_prop_name(id, o->xml);
}

bool lint_same_material(const struct desc_object *a, const struct desc_object *b)
{
    if (a == b)
        return true;
    if (a->kind != b->kind)
        return false;
    for (int i = 0; i < SCHEMA_PROPS; i++) {
        enum schema_prop_id id = (enum schema_prop_id)i;
        if (schema_has(a->kind, id) && schema_props[id].type != TYPE_TEXTURE &&
            !vec3_is_zero(vec3_sub(desc_vector(a, id), desc_vector(b, id))))
            return false;
    }
    return true;
}

bool lint_is_spelt_out(struct str text)
{
    for (size_t i = 0; i < text.n; i++)
        if (!strchr("0123456789.+-(), \t\n", text.at[i]))
            return false;
    return true;
}

bool lint_is_here(const struct lint *l, struct span span)
{
    const struct source *s = l->ast->source;
    return span.begin >= s->base && span.end <= s->base + s->n;
}

/* ---- text that goes away ---- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static uint32_t skip_blanks(const struct source *s, uint32_t at)
{
    while (is_blank(s->text[at - s->base]))
        at++;
    return at;
}

static uint32_t skip_blanks_back(const struct source *s, uint32_t at)
{
    while (at > s->base && is_blank(s->text[at - s->base - 1]))
        at--;
    return at;
}

static bool begins_line(const struct source *s, uint32_t at)
{
    return at == s->base || s->text[at - s->base - 1] == '\n';
}

static bool ends_line(const struct source *s, uint32_t at)
{
    return at == s->base + s->n || s->text[at - s->base] == '\n';
}

static bool is_allow(const struct lint *l, const struct trivia *comment)
{
    static const char mark[] = "wrt: allow(";
    struct str text = srcmap_text(l->sources, comment->span);
    return memmem(text.at, text.n, mark, sizeof mark - 1);
}

/* Behind the comment that begins at `at` and is the last thing on that line; else `at`. */
static uint32_t skip_last_comment(const struct lint *l, const struct source *s, uint32_t at)
{
    size_t i = ast_trivia_from(l->ast, at);
    if (i == l->ast->trivia.n || l->ast->trivia.at[i].span.begin != at)
        return at;
    struct span c = l->ast->trivia.at[i].span;
    uint32_t end = skip_blanks(s, c.end);
    bool one_line = !memchr(s->text + (c.begin - s->base), '\n', c.end - c.begin);
    return one_line && ends_line(s, end) ? end : at;
}

/* The line before the one that begins at `line`, when all of it is a comment that allows something
 * here; else `line`. */
static uint32_t allow_before(const struct lint *l, const struct source *s, uint32_t line)
{
    size_t i = ast_trivia_from(l->ast, line);
    const struct trivia *c = i ? &l->ast->trivia.at[i - 1] : NULL;
    if (!c || skip_blanks(s, c->span.end) + 1 != line || !is_allow(l, c))
        return line;
    uint32_t begin = skip_blanks_back(s, c->span.begin);
    return begins_line(s, begin) ? begin : line;
}

/* Whole lines, with the comments that speak of them: the one at the end and the allow comments
 * before.  Of the blank lines around them one stays. */
static struct span whole_lines(const struct lint *l, const struct source *s, struct span span)
{
    for (uint32_t line; (line = allow_before(l, s, span.begin)) != span.begin;)
        span.begin = line;
    span.end += span.end < s->base + s->n;
    uint32_t blank = skip_blanks(s, span.end);
    bool after = span.end < s->base + s->n && ends_line(s, blank);
    bool before = span.begin == s->base || begins_line(s, skip_blanks_back(s, span.begin - 1));
    if (before && after)
        span.end = blank + (blank < s->base + s->n);
    return span;
}

/* The text with its separator and the blanks behind it; with its lines when they hold nothing else
 * but a comment behind it. */
static struct span removal(const struct lint *l, const struct source *s, struct span span)
{
    uint32_t first = skip_blanks_back(s, span.begin), end = skip_blanks(s, span.end);
    char next = s->text[end - s->base];
    if (next == ',' || next == ';')
        end = skip_blanks(s, end + 1);
    uint32_t last = skip_last_comment(l, s, end);
    if (begins_line(s, first) && ends_line(s, last))
        return whole_lines(l, s, (struct span){first, last});
    next = s->text[end - s->base];
    bool opens = first > s->base && s->text[first - s->base - 1] == '{';
    if (ends_line(s, end) || (next == '}' && opens))
        return (struct span){first, end};
    if (next == '}' && is_blank(s->text[end - s->base - 1]))
        return (struct span){first, end - 1};
    return (struct span){span.begin, end};
}

/* Elements nest as deeply as they may. */
static bool has_id(const struct ast_node *node)
{
    for (const struct ast_node *c = node->children; c; c = c->next)
        if ((c->kind == AST_ATTRIBUTE && str_is(c->name, "id")) || has_id(c))
            return true;
    return false;
}

static const struct ast_node *named_at(const struct ast_node *first, struct span name)
{
    const struct ast_node *n = first;
    while (n && n->name_span.begin != name.begin)
        n = n->next;
    return n;
}

const struct ast_node *lint_surface_node(const struct lint *l, const struct desc_object *o)
{
    const struct ast_node *first = l->ast->statements, *node = NULL;
    if (o->frame || !first)
        return NULL;
    if (!l->ast->xml)
        return named_at(first, o->span);
    for (const struct ast_node *list = first->children; list && !node; list = list->next)
        node = named_at(list->children, o->span);
    return node && !has_id(node) ? node : NULL;
}

static bool loses_comment(const struct lint *l, struct span span)
{
    const struct ast *ast = l->ast;
    for (size_t i = ast_trivia_from(ast, span.begin);
         i < ast->trivia.n && ast->trivia.at[i].span.begin < span.end; i++)
        if (!is_allow(l, &ast->trivia.at[i]))
            return true;
    return false;
}

void lint_remove(const struct lint *l, struct diag_entry *e, struct span span,
                 enum diag_fix_kind kind)
{
    const struct source *s = srcmap_source(l->sources, span.begin);
    struct span all = s == l->ast->source ? removal(l, s, span) : span;
    diag_fix(e, all, loses_comment(l, all) ? DIAG_FIX_MAYBE : kind, "%s", "");
}
