#include "config.h"

#include "ast/ast.h"

void ast_init(struct ast *a, const struct source *source, bool xml)
{
    *a = (struct ast){.source = source, .xml = xml};
}

void ast_free(struct ast *a)
{
    vec_free(&a->trivia);
    arena_free(&a->arena);
}

struct ast_node *ast_node(struct ast *a, enum ast_kind kind, struct span span)
{
    struct ast_node *n = arena_zalloc(&a->arena, 1, sizeof *n);
    a->nodes++;
    n->kind = (uint8_t)kind;
    n->span = n->name_span = span;
    n->xml = a->xml;
    return n;
}

struct ast_node *ast_named(struct ast *a, enum ast_kind kind, struct span span, struct str name,
                           struct span name_span)
{
    struct ast_node *n = ast_node(a, kind, span);
    n->name = name;
    n->name_span = name_span;
    return n;
}

struct ast_node *ast_number(struct ast *a, struct span span, double number)
{
    struct ast_node *n = ast_node(a, AST_NUMBER, span);
    n->number = number;
    return n;
}

struct ast_node *ast_text(struct ast *a, enum ast_kind kind, struct span span, struct str text)
{
    struct ast_node *n = ast_node(a, kind, span);
    n->text = text;
    return n;
}

struct ast_node *ast_with(struct ast_node *parent, struct ast_node *child)
{
    parent->children = child;
    return parent;
}

struct ast_node *ast_holding(struct ast_node *parent, struct ast_list children)
{
    return ast_with(parent, children.first);
}

struct ast_list ast_append(struct ast_list list, struct ast_node *node)
{
    return ast_concat(list, (struct ast_list){node, node});
}

struct ast_list ast_append_error(struct ast *a, struct ast_list list, struct span span)
{
    if (!list.last || list.last->kind != AST_ERROR)
        return ast_append(list, ast_node(a, AST_ERROR, span));
    list.last->span = list.last->name_span = span_join(list.last->span, span);
    return list;
}

struct ast_list ast_concat(struct ast_list a, struct ast_list b)
{
    if (!a.first)
        return b;
    if (!b.first)
        return a;
    a.last->next = b.first;
    a.last = b.last;
    return a;
}

size_t ast_count(const struct ast_node *first)
{
    size_t n = 0;
    for (; first; first = first->next)
        n++;
    return n;
}
