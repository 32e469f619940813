/* The native language in canonical layout. */
#include "config.h"

#include "print/printing.h"

static const struct joint space = {.kind = JOINT_SPACE};
/* May end the line when what follows does not fit. */
static const struct joint fold = {.kind = JOINT_BREAK, .width = 1, .fill = true};

static const char between_members[] = ",;";

static void print_value(struct printing *p, const struct ast_node *n);
static void print_statement(struct printing *p, const struct ast_node *n);

/* A word with a space before it. */
static void print_next(struct printing *p, const char *word)
{
    print_joint(p, space);
    print_word(p, word);
}

static void print_name(struct printing *p, struct str name)
{
    print_joint(p, space);
    print_token(p, name.n);
}

static void print_spaced(struct printing *p, const struct ast_node *value)
{
    print_joint(p, space);
    print_value(p, value);
}

static void print_close(struct printing *p, struct joint joint)
{
    joint.kind = JOINT_BREAK;
    joint.closing = true;
    joint.outdent = LAYOUT_INDENT;
    print_joint(p, joint);
    print_token(p, 1);
    layout_close(&p->layout);
}

/* ---- blocks ---- */

static void print_member(struct printing *p, const struct ast_node *n, bool first)
{
    bool property = n->kind == AST_PROPERTY;
    print_joint(p, (struct joint){.kind = property ? JOINT_BREAK : JOINT_LINE,
                                  .width = first ? 1 : 2,
                                  .blank = true,
                                  .separators = between_members});
    if (!property) {
        print_statement(p, n);
        return;
    }
    print_token(p, n->name.n);
    print_word(p, ":");
    print_spaced(p, ast_value(n, &p->texts));
}

/* A block stays on one line when it fits and holds neither comment nor statement. */
static void print_block(struct printing *p, const struct ast_node *members)
{
    print_joint(p, space);
    print_group(p, true);
    print_open(p, 1);
    for (const struct ast_node *m = members; m; m = m->next)
        print_member(p, m, m == members);
    print_close(
        p, (struct joint){.width = members ? 1 : 0, .blank = true, .separators = between_members});
}

/* ---- values ---- */

/* Items between brackets, as many on a line as fit; those before `end`, or all. */
static void print_items(struct printing *p, const struct ast_node *items,
                        const struct ast_node *end)
{
    print_group(p, false);
    print_open(p, 1);
    for (const struct ast_node *n = items; n != end; n = n->next) {
        if (n != items)
            print_word(p, ",");
        print_joint(p, n == items ? (struct joint){.kind = JOINT_BREAK} : fold);
        print_value(p, n);
    }
    print_close(p, (struct joint){.separators = ","});
}

static void print_chain(struct printing *p, const struct ast_node *first)
{
    print_group(p, false);
    print_value(p, first);
    layout_indent(&p->layout, LAYOUT_INDENT);
    for (const struct ast_node *n = first->next; n; n = n->next) {
        print_next(p, ast_operators[n->operator].text);
        print_joint(p, fold);
        print_value(p, n);
    }
    layout_indent(&p->layout, -LAYOUT_INDENT);
    layout_close(&p->layout);
}

static void print_conditional(struct printing *p, const struct ast_node *condition)
{
    const struct ast_node *yes = condition->next;
    print_group(p, false);
    print_value(p, condition);
    layout_indent(&p->layout, LAYOUT_INDENT);
    print_joint(p, fold);
    print_word(p, "?");
    print_spaced(p, yes);
    print_joint(p, fold);
    print_word(p, ":");
    print_spaced(p, yes->next);
    layout_indent(&p->layout, -LAYOUT_INDENT);
    layout_close(&p->layout);
}

static void print_comprehension(struct printing *p, const struct ast_node *n)
{
    print_group(p, false);
    print_open(p, 1);
    print_joint(p, (struct joint){.kind = JOINT_BREAK});
    print_value(p, n->children);
    print_joint(p, fold);
    print_word(p, "for");
    print_name(p, n->name);
    print_next(p, "in");
    print_spaced(p, n->children->next);
    print_close(p, (struct joint){0});
}

static void print_select(struct printing *p, const struct ast_node *base)
{
    print_value(p, base);
    for (const struct ast_node *s = base->next; s; s = s->next) {
        if (s->kind == AST_INDEX) {
            print_items(p, s->children, NULL);
            continue;
        }
        if (s == base->next && base->kind == AST_NUMBER) /* `1.x` would be a number with a unit */
            print_joint(p, space);
        print_word(p, ".");
        print_token(p, s->name.n);
    }
}

/* `a` or `a = 1`: a parameter or an argument. */
static void print_named(struct printing *p, const struct ast_node *n)
{
    print_token(p, n->name.n);
    if (!n->children)
        return;
    print_next(p, "=");
    print_spaced(p, n->children);
}

static void print_value(struct printing *p, const struct ast_node *n)
{
    switch (n->kind) {
    case AST_VECTOR:
    case AST_LIST:
    case AST_PARENTHESES:
        print_items(p, n->children, NULL);
        break;
    case AST_COMPREHENSION:
        print_comprehension(p, n);
        break;
    case AST_CONSTRUCT:
        print_token(p, n->name.n);
        print_block(p, n->children);
        break;
    case AST_CALL:
        print_token(p, n->name.n);
        print_items(p, n->children, NULL);
        break;
    case AST_SELECT:
        print_select(p, n->children);
        break;
    case AST_PREFIX:
        print_token(p, 1);
        print_value(p, n->children);
        break;
    case AST_CHAIN:
        print_chain(p, n->children);
        break;
    case AST_CONDITIONAL:
        print_conditional(p, n->children);
        break;
    case AST_PARAMETER:
    case AST_ARGUMENT:
        print_named(p, n);
        break;
    default: /* one token */
        print_to(p, n->span.end);
        break;
    }
}

/* ---- statements ---- */

/* `let a = v` */
static void print_definition(struct printing *p, const char *word, const struct ast_node *n)
{
    print_word(p, word);
    print_name(p, n->name);
    print_next(p, "=");
    print_spaced(p, n->children);
}

static const struct ast_node *last_of(const struct ast_node *siblings)
{
    while (siblings->next)
        siblings = siblings->next;
    return siblings;
}

static void print_fn(struct printing *p, const struct ast_node *n)
{
    const struct ast_node *value = last_of(n->children);
    print_word(p, "fn");
    print_name(p, n->name);
    print_items(p, n->children, value);
    print_next(p, "=");
    print_spaced(p, value);
}

static void print_define(struct printing *p, const struct ast_node *n)
{
    const struct ast_node *body = last_of(n->children);
    print_word(p, "define");
    print_name(p, n->name);
    print_items(p, n->children, body);
    print_block(p, body->children);
}

static void print_use(struct printing *p, const struct ast_node *n)
{
    const struct ast_node *last = n->children ? last_of(n->children) : NULL;
    const struct ast_node *body = last && last->kind == AST_BODY ? last : NULL;
    print_token(p, n->name.n);
    print_items(p, n->children, body);
    if (body)
        print_block(p, body->children);
}

static void print_for(struct printing *p, const struct ast_node *n)
{
    print_word(p, "for");
    print_name(p, n->name);
    print_next(p, "in");
    print_spaced(p, n->children);
    print_block(p, n->children->next->children);
}

static void print_if(struct printing *p, const struct ast_node *n)
{
    for (;;) {
        const struct ast_node *then = n->children->next, *otherwise = then->next;
        print_word(p, "if");
        print_spaced(p, n->children);
        print_block(p, then->children);
        if (!otherwise)
            return;
        print_next(p, "else");
        if (otherwise->kind == AST_BODY) {
            print_block(p, otherwise->children);
            return;
        }
        n = otherwise;
        print_joint(p, space);
    }
}

static void print_assert(struct printing *p, const struct ast_node *n)
{
    print_group(p, false);
    print_word(p, "assert");
    print_spaced(p, n->children);
    print_word(p, ",");
    layout_indent(&p->layout, LAYOUT_INDENT);
    print_joint(p, fold);
    print_value(p, n->children->next);
    layout_indent(&p->layout, -LAYOUT_INDENT);
    layout_close(&p->layout);
}

static void print_object(struct printing *p, const struct ast_node *n)
{
    if (n->kind == AST_DEFAULT)
        print_word(p, "default");
    if (n->kind == AST_DEFAULT)
        print_joint(p, space);
    print_token(p, n->name.n);
    if (n->label.n)
        print_name(p, n->label);
    const struct ast_node *label =
        n->children && n->children->kind == AST_LABEL ? n->children : NULL;
    if (label)
        print_name(p, label->name);
    print_block(p, label ? label->next : n->children);
}

/* A word and the one token behind it. */
static void print_pair(struct printing *p, const char *word, const struct ast_node *n)
{
    print_word(p, word);
    print_joint(p, space);
    print_to(p, n->span.end);
}

static void print_statement(struct printing *p, const struct ast_node *n)
{
    switch (n->kind) {
    case AST_VERSION:
        print_pair(p, "wrt", n);
        break;
    case AST_MODEL:
        print_pair(p, "model", n);
        break;
    case AST_INCLUDE:
        print_pair(p, "include", n);
        break;
    case AST_LET:
        print_definition(p, "let", n);
        break;
    case AST_PARAM:
        print_definition(p, "param", n);
        break;
    case AST_MATERIAL:
        print_definition(p, "material", n);
        break;
    case AST_TEXTURE:
        print_definition(p, "texture", n);
        break;
    case AST_FN:
        print_fn(p, n);
        break;
    case AST_DEFINE:
        print_define(p, n);
        break;
    case AST_ASSERT:
        print_assert(p, n);
        break;
    case AST_FOR:
        print_for(p, n);
        break;
    case AST_IF:
        print_if(p, n);
        break;
    case AST_USE:
        print_use(p, n);
        break;
    default: /* AST_BLOCK, AST_DEFAULT */
        print_object(p, n);
        break;
    }
}

void print_native(struct printing *p)
{
    for (const struct ast_node *n = p->ast->statements; n; n = n->next) {
        print_joint(
            p, (struct joint){.kind = JOINT_LINE, .blank = true, .separators = between_members});
        print_statement(p, n);
        print_flush(p);
    }
    print_joint(p, (struct joint){.separators = between_members});
    print_end(p);
}
