/* What the text alone could say more clearly. */
#include "config.h"

#include "lint/checks.h"

#include <string.h>

/* ---- values that are plain numbers ---- */

/* The number that a literal spells, perhaps with a sign. */
static bool is_literal(const struct ast_node *node, double *x)
{
    bool negative = false;
    while (node->kind == AST_PREFIX || node->kind == AST_PARENTHESES) {
        negative ^= node->kind == AST_PREFIX && node->children->operator== AST_NEGATE;
        node = node->children;
    }
    *x = negative ? -node->number : node->number;
    return node->kind == AST_NUMBER || node->kind == AST_ANGLE;
}

/* Whether the value is x, or a vector of nothing else. */
static bool is_all(const struct ast_node *value, double x)
{
    double y;
    if (value->kind != AST_VECTOR)
        return is_literal(value, &y) && x == y;
    for (const struct ast_node *c = value->children; c; c = c->next)
        if (!is_literal(c, &y) || x != y)
            return false;
    return true;
}

static bool is_identity(const struct ast_node *list)
{
    double x;
    int i = 0;
    if (list->kind != AST_LIST)
        return false;
    for (const struct ast_node *c = list->children; c; c = c->next, i++)
        if (!is_literal(c, &x) || x != (i % 5 == 0)) /* 1 at 0, 5 and 10 */
            return false;
    return true;
}

/* ---- groups and uses of templates ---- */

/* Numbers that need no nodes, or a value. */
static bool is_nothing_but(const struct ast_node *property, double x)
{
    double numbers[3];
    unsigned n = property->children ? 0 : ast_plain_value(property, numbers);
    for (unsigned i = 0; i < n; i++)
        if (numbers[i] != x)
            return false;
    return property->children ? is_all(property->children, x) : n > 0;
}

static bool moves_nothing(const struct ast_node *property)
{
    if (str_is(property->name, schema_props[PROP_TRANSLATE].native) ||
        str_is(property->name, schema_props[PROP_ROTATE].native))
        return is_nothing_but(property, 0);
    if (str_is(property->name, schema_props[PROP_GROUP_SCALE].native))
        return is_nothing_but(property, 1);
    return str_is(property->name, schema_props[PROP_MATRIX].native) && property->children &&
           is_identity(property->children);
}

static void check_transforms(const struct lint *l, const struct ast_node *members)
{
    for (const struct ast_node *m = members; m; m = m->next) {
        if (m->kind != AST_PROPERTY || !moves_nothing(m))
            continue;
        struct diag_entry *e = diag_report(l->diag, DIAG_IDENTITY_TRANSFORM, m->span,
                                           "this '%.*s' changes nothing", STR_ARG(m->name));
        lint_remove(l, e, m->span, DIAG_FIX_SAFE);
    }
}

static void check_use(const struct lint *l, const struct ast_node *node)
{
    for (const struct ast_node *c = node->children; c; c = c->next)
        if (c->kind == AST_BODY)
            check_transforms(l, c->children);
}

static bool has_statements(const struct ast_node *members)
{
    for (const struct ast_node *m = members; m; m = m->next)
        if (m->kind != AST_PROPERTY)
            return true;
    return false;
}

static void check_group(const struct lint *l, const struct ast_node *node)
{
    check_transforms(l, node->children);
    if (!has_statements(node->children))
        diag_report(l->diag, DIAG_EMPTY_GROUP, node->span, "there is nothing in this group");
}

/* ---- loops ---- */

static bool is_empty_range(const struct ast_node *call)
{
    double x[2] = {0};
    int n = 0;
    if (!str_is(call->name, "range"))
        return false;
    for (const struct ast_node *c = call->children; c; c = c->next, n++)
        if (n == 2 || !is_literal(c, &x[n]))
            return false;
    return n == 1 ? x[0] <= 0 : n == 2 && x[1] <= x[0];
}

static bool is_empty_list(const struct ast_node *v)
{
    return v->kind == AST_LIST ? !v->children : v->kind == AST_CALL && is_empty_range(v);
}

static void check_sequence(const struct lint *l, const struct ast_node *sequence)
{
    if (is_empty_list(sequence))
        diag_report(l->diag, DIAG_EMPTY_LOOP, sequence->span,
                    "there is nothing here to go through: the loop never runs");
}

static void check_for(const struct lint *l, const struct ast_node *node)
{
    check_sequence(l, node->children);
    if (!node->children->next->children)
        diag_report(l->diag, DIAG_EMPTY_LOOP, node->span, "there is nothing in this loop");
}

static void check_comprehension(const struct lint *l, const struct ast_node *node)
{
    check_sequence(l, node->children->next);
}

/* ---- names of XML ---- */

/* The class of an element that names a kind otherwise than the schema does at first. */
static void check_class(const struct lint *l, const struct ast_node *attribute,
                        enum schema_group group)
{
    const struct ast_node *text = attribute->children;
    struct str name = str_trim(text->text);
    enum schema_kind kind = schema_find_kind(group, name, true);
    if (kind == SCHEMA_KINDS || str_is(name, schema_kinds[kind].xml))
        return;
    struct diag_entry *e =
        diag_report(l->diag, DIAG_DEPRECATED_NAME, text->span, "'%.*s' is another name of '%s'",
                    STR_ARG(name), schema_kinds[kind].xml);
    struct str spelt = srcmap_text(l->sources, text->span); /* with its quotes */
    const char *at = memmem(spelt.at, spelt.n, name.at, name.n);
    if (!at)
        return;
    uint32_t begin = text->span.begin + (uint32_t)(at - spelt.at);
    diag_fix(e, (struct span){begin, begin + (uint32_t)name.n}, DIAG_FIX_SAFE, "%s",
             schema_kinds[kind].xml);
}

static void check_element(const struct lint *l, const struct ast_node *node)
{
    for (const struct ast_node *c = node->children; c; c = c->next)
        if (c->kind == AST_ATTRIBUTE && str_is(c->name, "class") && str_is(node->name, "material"))
            check_class(l, c, SCHEMA_MATERIAL);
}

/* ---- any node ---- */

static void check_block(const struct lint *l, const struct ast_node *node)
{
    if (node->xml)
        check_element(l, node);
    else if (str_is(node->name, "group"))
        check_group(l, node);
}

/* As deep as the tree, which the parser bounds. */
static void visit(const struct lint *l, const struct ast_node *first)
{
    static void (*const looks[AST_KINDS])(const struct lint *l, const struct ast_node *node) = {
        [AST_BLOCK] = check_block,
        [AST_USE] = check_use,
        [AST_FOR] = check_for,
        [AST_COMPREHENSION] = check_comprehension,
    };
    for (const struct ast_node *n = first; n; n = n->next) {
        if (looks[n->kind])
            looks[n->kind](l, n);
        visit(l, n->children);
    }
}

void lint_style(const struct lint *l)
{
    visit(l, l->ast->statements);
}

/* ---- the same twice ---- */

static bool are_same(const struct lint *l, const struct ast_node *a, const struct ast_node *b)
{
    return str_equal(srcmap_text(l->sources, a->span), srcmap_text(l->sources, b->span));
}

static void check_comparison(const struct lint *l, const struct ast_node *node)
{
    const struct ast_node *left = node->children, *right = left->next;
    bool compares = right->operator>= AST_EQUAL && right->operator<= AST_GREATER_EQUAL;
    if (compares && !right->next && are_same(l, left, right))
        diag_report(l->diag, DIAG_SAME_OPERANDS, node->span, "this is compared with itself");
}

/* A condition, and what follows by it; for `if` the other branch may be missing. */
static void check_choice(const struct lint *l, const struct ast_node *node)
{
    const struct ast_node *one = node->children->next, *other = one->next;
    if (other && are_same(l, one, other))
        diag_label(diag_report(l->diag, DIAG_SAME_OPERANDS, other->span,
                               "this is the same whatever the condition says"),
                   one->span, "the other branch is here");
}

static void visit_choices(const struct lint *l, const struct ast_node *first)
{
    for (const struct ast_node *n = first; n; n = n->next) {
        if (n->kind == AST_CHAIN)
            check_comparison(l, n);
        else if (n->kind == AST_CONDITIONAL || n->kind == AST_IF)
            check_choice(l, n);
        visit_choices(l, n->children);
    }
}

void lint_same_operands(const struct lint *l)
{
    visit_choices(l, l->ast->statements);
}

/* ---- the order of statements ---- */

enum turn { TURN_CAMERA, TURN_LIGHTS, TURN_SURFACES, TURN_NONE };

static enum turn turn_of(const struct ast_node *node)
{
    if (node->kind != AST_BLOCK)
        return TURN_NONE;
    if (node->xml ? str_is(node->name, "lights") : str_is(node->name, "light"))
        return TURN_LIGHTS;
    if (str_is(node->name, "camera"))
        return TURN_CAMERA;
    bool surface = node->xml ? str_is(node->name, "surfaces")
                             : schema_find_kind(SCHEMA_SURFACE, node->name, false) != SCHEMA_KINDS;
    return surface ? TURN_SURFACES : TURN_NONE;
}

void lint_order(const struct lint *l)
{
    static const char *const words[] = {
        [TURN_CAMERA] = "the camera", [TURN_LIGHTS] = "lights", [TURN_SURFACES] = "surfaces"};
    const struct ast_node *first = l->ast->statements, *latest = NULL;
    for (const struct ast_node *n = l->ast->xml ? first->children : first; n; n = n->next) {
        if (turn_of(n) == TURN_NONE)
            continue;
        if (!latest || turn_of(n) >= turn_of(latest)) {
            latest = n;
            continue;
        }
        struct diag_entry *e = diag_report(
            l->diag, DIAG_UNORDERED_SCENE, n->name_span, "%s usually come%s before %s",
            words[turn_of(n)], turn_of(n) == TURN_CAMERA ? "s" : "", words[turn_of(latest)]);
        diag_label(e, latest->name_span, "this comes before");
        return;
    }
}

/* ---- what would be so anyway ---- */

static bool is_default(const struct desc_object *o, const struct desc_prop *p)
{
    const struct schema_prop *s = &schema_props[p->id];
    const double *usual = s->value[o->model];
    if (!(s->has_default >> o->model & 1))
        return false;
    if (s->type == TYPE_WORD)
        return p->value.word == (unsigned)usual[0];
    bool three = s->type == TYPE_VECTOR || s->type == TYPE_SCALE || s->type == TYPE_COLOUR;
    bool pair = s->type == TYPE_VECTOR_OR_PAIR;
    for (int i = 0; i < (three ? 3 : pair ? 2 : 1); i++)
        if (p->value.number[i] != usual[i])
            return false;
    return true;
}

/* A property that `default` gives, too, or a material that this one is made from, may be given
 * otherwise there. */
static bool may_differ_elsewhere(const struct lint *l, const struct desc_object *o,
                                 enum schema_prop_id id)
{
    struct str opening = srcmap_text(l->sources, o->span);
    if (schema_kinds[o->kind].group == SCHEMA_MATERIAL && !o->xml &&
        !str_is(opening, schema_kinds[o->kind].native))
        return true;
    for (size_t i = 0; i < l->desc->defaults.n; i++)
        if (l->desc->defaults.at[i]->kind == o->kind && desc_find(l->desc->defaults.at[i], id))
            return true;
    return false;
}

/* What another rule asks to be said, whatever it is: W582, W550. */
static bool is_asked_for(const struct desc_object *o, enum schema_prop_id id)
{
    return (id == PROP_SMOOTH && o->xml && o->model == SCHEMA_CLASSIC) || id == PROP_INTENSITY;
}

static void check_defaults(const struct lint *l, const struct desc_object *o)
{
    for (const struct desc_prop *p = o->props; p; p = p->next) {
        enum schema_prop_id id = (enum schema_prop_id)p->id;
        bool word = schema_props[id].type == TYPE_WORD, flag = schema_props[id].type == TYPE_SWITCH;
        if (p->inherited || !is_default(o, p) || is_asked_for(o, id) ||
            may_differ_elsewhere(l, o, id))
            continue;
        struct str text = srcmap_text(l->sources, p->value.span);
        if (!word && !lint_is_spelt_out(text) &&
            !(flag && (str_is(text, "true") || str_is(text, "false"))))
            continue;
        struct span all = span_join(p->name_span, p->value.span);
        struct diag_entry *e =
            diag_report(l->diag, DIAG_REDUNDANT_DEFAULT, o->xml ? p->value.span : all,
                        "'%.*s' has the default value", STR_ARG(lint_name(o, id)));
        if (!o->xml)
            lint_remove(l, e, all, DIAG_FIX_SAFE);
    }
}

static void check_if_any(const struct lint *l, const struct desc_object *o)
{
    if (o)
        check_defaults(l, o);
}

void lint_defaults(const struct lint *l)
{
    check_if_any(l, l->desc->camera);
    check_if_any(l, l->desc->settings);
    lint_each_light(l, check_defaults);
    lint_each_material(l, check_defaults);
    lint_each_surface(l, check_defaults);
    for (size_t i = 0; i < l->desc->textures.n; i++)
        check_defaults(l, l->desc->textures.at[i]);
}
