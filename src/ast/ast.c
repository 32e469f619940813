#include "config.h"

#include "ast/ast.h"

#include "base/num.h"

const struct ast_operator_row ast_operators[AST_OPERATORS] = {
    [AST_NO_OPERATOR] = {"", 0},  [AST_OR] = {"||", 1},        [AST_AND] = {"&&", 2},
    [AST_EQUAL] = {"==", 3},      [AST_NOT_EQUAL] = {"!=", 3}, [AST_LESS] = {"<", 4},
    [AST_LESS_EQUAL] = {"<=", 4}, [AST_GREATER] = {">", 4},    [AST_GREATER_EQUAL] = {">=", 4},
    [AST_ADD] = {"+", 5},         [AST_SUBTRACT] = {"-", 5},   [AST_MULTIPLY] = {"*", 6},
    [AST_DIVIDE] = {"/", 6},      [AST_MODULO] = {"%", 6},     [AST_PLUS] = {"+", 7},
    [AST_NEGATE] = {"-", 7},      [AST_NOT] = {"!", 7},        [AST_POWER] = {"^", 8},
};

void ast_init(struct ast *a, const struct source *source, bool xml)
{
    *a = (struct ast){.source = source, .xml = xml};
}

void ast_free(struct ast *a)
{
    vec_free(&a->trivia);
    arena_free(&a->arena);
}

static struct ast_node *new_node(struct arena *a, enum ast_kind kind, struct span span)
{
    struct ast_node *n = arena_alloc(a, sizeof *n);
    *n = (struct ast_node){.kind = (uint8_t)kind, .span = span, .name_span = span};
    return n;
}

struct ast_node *ast_node(struct ast *a, enum ast_kind kind, struct span span)
{
    struct ast_node *n = new_node(&a->arena, kind, span);
    n->xml = a->xml;
    a->nodes++;
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

/* Appends to a node that knows its last child. */
static struct ast_node *extend(struct ast_node *parent, struct span span, struct ast_node *child)
{
    parent->last->next = child;
    parent->last = child;
    parent->span = parent->name_span = span;
    return parent;
}

static struct ast_node *couple(struct ast *a, enum ast_kind kind, struct span span,
                               struct ast_node *first, struct ast_node *second)
{
    struct ast_node *n = ast_holding(ast_node(a, kind, span), ast_pair(first, second));
    n->last = second;
    return n;
}

struct ast_node *ast_chain(struct ast *a, struct span span, struct ast_node *left,
                           enum ast_operator operator, struct ast_node * right)
{
    right->operator=(uint8_t) operator;
    int level = ast_operators[operator].level;
    bool longer = left->kind == AST_CHAIN && ast_operators[left->last->operator].level == level;
    return longer ? extend(left, span, right) : couple(a, AST_CHAIN, span, left, right);
}

struct ast_node *ast_prefix(struct ast *a, struct span span, enum ast_operator operator,
                            struct ast_node * operand)
{
    operand->operator=(uint8_t) operator;
    return ast_with(ast_node(a, AST_PREFIX, span), operand);
}

struct ast_node *ast_select(struct ast *a, struct span span, struct ast_node *base,
                            struct ast_node *selector)
{
    bool longer = base->kind == AST_SELECT;
    return longer ? extend(base, span, selector) : couple(a, AST_SELECT, span, base, selector);
}

struct ast_list ast_pair(struct ast_node *first, struct ast_node *second)
{
    return ast_append(ast_append((struct ast_list){0}, first), second);
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

/* ---- plain values ---- */

struct span ast_value_span(const struct ast_node *property)
{
    uint32_t end = property->span.end;
    return property->children ? property->children->span
                              : (struct span){end - (uint32_t)property->text.n, end};
}

static bool is_between_numbers(char c)
{
    return c <= ' ' || c == ',' || c == '(' || c == ')';
}

/* The next number of a plain value, and where it stands; false behind the last. */
static bool next_number(struct str text, size_t *at, struct str *spelling, double *x)
{
    while (*at < text.n && is_between_numbers(text.at[*at]))
        ++*at;
    if (*at == text.n)
        return false;
    const char *end = num_parse(text.at + *at, text.at + text.n, x);
    *spelling = (struct str){text.at + *at, (size_t)(end - text.at) - *at};
    *at += spelling->n;
    return true;
}

unsigned ast_plain_value(const struct ast_node *property, double numbers[3])
{
    struct str spelling;
    unsigned n = 0;
    size_t at = 0;
    if (property->children)
        return 0;
    while (next_number(property->text, &at, &spelling, &numbers[n]))
        n++;
    return n;
}

/* As the grammar makes them: a sign is an operator. */
static struct ast_node *number_node(struct arena *a, struct span span, bool negative, double x)
{
    struct span digits = {span.begin + negative, span.end};
    struct ast_node *n = new_node(a, AST_NUMBER, digits);
    n->number = negative ? -x : x;
    if (!negative)
        return n;
    n->operator= AST_NEGATE;
    return ast_with(new_node(a, AST_PREFIX, span), n);
}

const struct ast_node *ast_value(const struct ast_node *property, struct arena *a)
{
    struct span span = ast_value_span(property);
    struct ast_list numbers = {0};
    struct str spelling;
    size_t at = 0;
    double x;
    if (property->children)
        return property->children;
    while (next_number(property->text, &at, &spelling, &x)) {
        uint32_t end = span.begin + (uint32_t)at;
        struct span place = {end - (uint32_t)spelling.n, end};
        numbers = ast_append(numbers, number_node(a, place, *spelling.at == '-', x));
    }
    bool vector = numbers.first != numbers.last;
    return vector ? ast_holding(new_node(a, AST_VECTOR, span), numbers) : numbers.first;
}

size_t ast_count(const struct ast_node *first)
{
    size_t n = 0;
    for (; first; first = first->next)
        n++;
    return n;
}

bool ast_is_damaged(const struct ast_node *node)
{
    bool damaged = node->kind == AST_ERROR;
    for (const struct ast_node *c = node->children; c && !damaged; c = c->next)
        damaged = c->kind == AST_ERROR;
    return damaged;
}

size_t ast_trivia_from(const struct ast *ast, uint32_t at)
{
    size_t low = 0, high = ast->trivia.n;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (ast->trivia.at[middle].span.begin < at)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}
