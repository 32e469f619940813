/* Operators. */
#include "config.h"

#include "eval/context.h"

#include <math.h>

static struct value report_operands(struct eval *e, enum ast_operator op, const struct value *a,
                                    const struct value *b, struct span span)
{
    if (a->type == VALUE_ERROR || b->type == VALUE_ERROR)
        return value_error(span);
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_WRONG_TYPE, span, "'%s' cannot be applied to %s and %s",
                    ast_operators[op].text, value_type_name(a), value_type_name(b));
    bool text = a->type == VALUE_STRING || b->type == VALUE_STRING;
    bool numeric = value_is_numeric(a) && value_is_numeric(b);
    if (op == AST_ADD && text)
        diag_note(entry, "str(...) makes a string of a value");
    else if (numeric && !a->angles != !b->angles)
        diag_note(entry, "a number becomes an angle with a unit, as in 90deg; an angle over 1deg "
                         "or 1rad is a number");
    else if (a->type == VALUE_BOOL && ast_operators[op].level == ast_operators[AST_LESS].level)
        diag_note(entry, "comparisons do not chain: write 'a < b && b < c'");
    return value_error(span);
}

/* ---- numbers, by component ---- */

static double modulo(double x, double y)
{
    double r = fmod(x, y);
    return r != 0 && (r < 0) != (y < 0) ? r + y : r;
}

static double compute(enum ast_operator op, double x, double y)
{
    switch (op) {
    case AST_ADD:
        return x + y;
    case AST_SUBTRACT:
        return x - y;
    case AST_MULTIPLY:
        return x * y;
    case AST_DIVIDE:
        return x / y;
    case AST_MODULO:
        return modulo(x, y);
    default:
        return pow(x, y);
    }
}

/* Whether x op y is an angle, where `xa` and `ya` say whether x and y are; -1: it has no meaning.
 * 0 is an angle, too. */
static int unit_of(enum ast_operator op, double x, bool xa, double y, bool ya)
{
    switch (op) {
    case AST_MULTIPLY:
        return xa && ya ? -1 : xa || ya;
    case AST_DIVIDE:
        return ya ? (xa ? 0 : -1) : xa;
    case AST_POWER:
        return xa || ya ? -1 : 0;
    default:
        if (xa == ya)
            return xa;
        return (xa ? y : x) == 0 ? 1 : -1;
    }
}

static struct value report_not_finite(struct eval *e, enum ast_operator op, double x, double y,
                                      struct span span)
{
    const char *sign = ast_operators[op].text;
    if ((op == AST_DIVIDE || op == AST_MODULO) && y == 0)
        diag_report(e->diag, DIAG_ARITHMETIC, span, "division by zero: %.6g %s 0", x, sign);
    else if (op == AST_POWER && x == 0)
        diag_report(e->diag, DIAG_ARITHMETIC, span, "division by zero: 0 ^ %.6g", y);
    else if (op == AST_POWER && x < 0 && y != floor(y))
        diag_report(e->diag, DIAG_ARITHMETIC, span,
                    "a negative number has no real power with a fraction: %.6g ^ %.6g", x, y);
    else
        diag_report(e->diag, DIAG_ARITHMETIC, span, "the result is too large: %.6g %s %.6g", x,
                    sign, y);
    return value_error(span);
}

static struct value combine_numbers(struct eval *e, enum ast_operator op, const struct value *a,
                                    const struct value *b, struct span span)
{
    struct value v = {.n = a->n > b->n ? a->n : b->n};
    v.type = v.n > 1 ? VALUE_VECTOR : VALUE_NUMBER;
    if (a->n != b->n && a->n > 1 && b->n > 1)
        return report_operands(e, op, a, b, span);
    for (uint32_t i = 0; i < v.n; i++) {
        double x = value_number(a, i), y = value_number(b, i);
        int unit = unit_of(op, x, value_is_angle(a, i), y, value_is_angle(b, i));
        if (unit < 0)
            return report_operands(e, op, a, b, span);
        v.number[i] = compute(op, x, y);
        v.angles |= (uint8_t)(unit << i);
        if (!isfinite(v.number[i]))
            return report_not_finite(e, op, x, y, span);
    }
    return v;
}

/* ---- comparisons ---- */

static struct value compare_order(struct eval *e, enum ast_operator op, const struct value *a,
                                  const struct value *b, struct span span)
{
    double x = a->number[0], y = b->number[0];
    bool numbers = a->type == VALUE_NUMBER && b->type == VALUE_NUMBER;
    if (!numbers || unit_of(op, x, a->angles, y, b->angles) < 0)
        return report_operands(e, op, a, b, span);
    bool result = op == AST_LESS         ? x < y
                  : op == AST_LESS_EQUAL ? x <= y
                  : op == AST_GREATER    ? x > y
                                         : x >= y;
    return (struct value){.type = VALUE_BOOL, .boolean = result};
}

/* Numbers with other units, or as many, can be told apart only when they are comparable at all. */
enum equality { UNEQUAL, EQUAL, INCOMPARABLE };

static enum equality equal_numbers(const struct value *a, const struct value *b)
{
    bool equal = true;
    if (a->n != b->n)
        return INCOMPARABLE;
    for (uint32_t i = 0; i < a->n; i++) {
        double x = a->number[i], y = b->number[i];
        if (unit_of(AST_EQUAL, x, value_is_angle(a, i), y, value_is_angle(b, i)) < 0)
            return INCOMPARABLE;
        equal &= x == y;
    }
    return equal ? EQUAL : UNEQUAL;
}

static enum equality equal_values(struct eval *e, const struct value *a, const struct value *b,
                                  struct span span);

static enum equality equal_lists(struct eval *e, const struct value *a, const struct value *b,
                                 struct span span)
{
    enum equality result = a->n == b->n ? EQUAL : UNEQUAL;
    if (eval_enter(e, span) && eval_spend(e, a->n, span))
        for (uint32_t i = 0; result == EQUAL && i < a->n; i++) {
            struct value x = value_item(a, i), y = value_item(b, i);
            result = equal_values(e, &x, &y, span);
        }
    eval_leave(e);
    return result;
}

static enum equality equal_values(struct eval *e, const struct value *a, const struct value *b,
                                  struct span span)
{
    if (value_is_numeric(a) && value_is_numeric(b))
        return equal_numbers(a, b);
    if (a->type != b->type)
        return INCOMPARABLE;
    switch ((enum value_type)a->type) {
    case VALUE_BOOL:
        return a->boolean == b->boolean ? EQUAL : UNEQUAL;
    case VALUE_STRING:
        return str_equal(a->string, b->string) ? EQUAL : UNEQUAL;
    case VALUE_LIST:
        return equal_lists(e, a, b, span);
    case VALUE_OBJECT:
        return a->object == b->object ? EQUAL : UNEQUAL;
    default:
        return INCOMPARABLE;
    }
}

static struct value compare(struct eval *e, enum ast_operator op, const struct value *a,
                            const struct value *b, struct span span)
{
    enum equality equal = equal_values(e, a, b, span);
    if (equal == INCOMPARABLE)
        return report_operands(e, op, a, b, span);
    report_float_comparison(e, a, b, span);
    return (struct value){.type = VALUE_BOOL, .boolean = (equal == EQUAL) == (op == AST_EQUAL)};
}

/* ---- strings and lists ---- */

/* File names in the result start where the first part with a place is spelt. */
static struct value join_strings(struct eval *e, const struct value *a, const struct value *b,
                                 struct span span)
{
    struct value v = {.type = VALUE_STRING, .spelt = a->spelt ? a->spelt : b->spelt};
    char *text = string_reserve(e, a->string.n + b->string.n, span);
    if (!text)
        return value_error(span);
    memcpy(text, a->string.at, a->string.n);
    memcpy(text + a->string.n, b->string.at, b->string.n);
    v.string = (struct str){text, a->string.n + b->string.n};
    return v;
}

static struct value join_lists(struct eval *e, const struct value *a, const struct value *b,
                               struct span span)
{
    size_t n = (size_t)a->n + b->n;
    struct value *items = list_reserve(e, n, span);
    if (!items)
        return value_error(span);
    for (uint32_t i = 0; i < a->n; i++)
        items[i] = value_item(a, i);
    for (uint32_t i = 0; i < b->n; i++)
        items[a->n + i] = value_item(b, i);
    return (struct value){.type = VALUE_LIST, .n = (uint32_t)n, .items = items};
}

/* ---- all ---- */

struct value value_combine(struct eval *e, enum ast_operator op, const struct value *a,
                           const struct value *b, struct span span)
{
    if (a->type == VALUE_ERROR || b->type == VALUE_ERROR)
        return value_error(span);
    if (op == AST_EQUAL || op == AST_NOT_EQUAL)
        return compare(e, op, a, b, span);
    if (ast_operators[op].level == ast_operators[AST_LESS].level)
        return compare_order(e, op, a, b, span);
    if (value_is_numeric(a) && value_is_numeric(b))
        return combine_numbers(e, op, a, b, span);
    if (op == AST_ADD && a->type == VALUE_STRING && b->type == VALUE_STRING)
        return join_strings(e, a, b, span);
    if (op == AST_ADD && a->type == VALUE_LIST && b->type == VALUE_LIST)
        return join_lists(e, a, b, span);
    return report_operands(e, op, a, b, span);
}

struct value value_prefix(struct eval *e, enum ast_operator op, const struct value *a,
                          struct span span)
{
    struct value v = *a;
    if (op == AST_NOT && v.type == VALUE_BOOL) {
        v.boolean = !v.boolean;
        return v;
    }
    if (op != AST_NOT && value_is_numeric(a)) {
        for (uint32_t i = 0; i < v.n && op == AST_NEGATE; i++)
            v.number[i] = -v.number[i];
        v.colour = false;
        return v;
    }
    if (v.type != VALUE_ERROR)
        diag_report(e->diag, DIAG_WRONG_TYPE, span, "'%s' cannot be applied to %s",
                    ast_operators[op].text, value_type_name(a));
    return value_error(span);
}
