/* The functions of the native language, a row of functions.def each. */
#include "config.h"

#include "eval/context.h"
#include "eval/signature.h"
#include "math/rng.h"

#include <math.h>

/* Whole numbers up to here are exact. */
#define WHOLE_LIMIT 0x1p53

struct call {
    struct eval *e;
    const struct builtin *f;
    const struct ast_node *node;
    const struct value *args;
    uint32_t n; /* arguments; those not given count where no more may follow */
};

struct builtin {
    const char *name, *parameters, *types;
    uint8_t required;
    bool more;
    struct value (*run)(const struct call *c);
    const char *doc;
};

/* ---- by component ---- */

/* The shape that arguments [from, to) have together, numbers standing for vectors; false after
 * reporting that they have none. */
static bool common_shape(const struct call *c, uint32_t from, uint32_t to, struct value *out)
{
    const struct value *first = &c->args[from];
    *out = (struct value){.type = VALUE_NUMBER, .n = 1};
    for (uint32_t i = from; i < to; i++)
        out->n = c->args[i].n > out->n ? c->args[i].n : out->n;
    out->type = out->n > 1 ? VALUE_VECTOR : VALUE_NUMBER;
    for (uint32_t k = 0; k < out->n; k++)
        for (uint32_t i = from; i < to; i++)
            out->angles |= (uint8_t)(value_is_angle(&c->args[i], k) << k);
    for (uint32_t i = from; i < to; i++) {
        const struct value *v = &c->args[i];
        bool fits = v->n == 1 || v->n == out->n;
        for (uint32_t k = 0; k < out->n && fits; k++)
            fits = value_is_angle(v, k) == value_is_angle(out, k) || value_number(v, k) == 0;
        if (fits)
            continue;
        diag_report(c->e->diag, DIAG_WRONG_TYPE, v->span, "'%s' cannot mix %s and %s", c->f->name,
                    value_type_name(i == from ? &c->args[from + 1] : first), value_type_name(v));
        return false;
    }
    return true;
}

static struct value map_numbers(const struct call *c, double (*f)(double))
{
    struct value v = c->args[0];
    v.colour = false;
    for (uint32_t i = 0; i < v.n; i++)
        v.number[i] = f(v.number[i]);
    return v;
}

static double sign_of(double x)
{
    return (x > 0) - (x < 0);
}

static struct value fn_abs(const struct call *c)
{
    return map_numbers(c, fabs);
}

static struct value fn_sign(const struct call *c)
{
    struct value v = map_numbers(c, sign_of);
    v.angles = 0;
    return v;
}

static struct value fn_floor(const struct call *c)
{
    return map_numbers(c, floor);
}

static struct value fn_ceil(const struct call *c)
{
    return map_numbers(c, ceil);
}

static struct value fn_round(const struct call *c)
{
    return map_numbers(c, round);
}

static struct value fn_sqrt(const struct call *c)
{
    return map_numbers(c, sqrt);
}

static struct value fn_exp(const struct call *c)
{
    return map_numbers(c, exp);
}

static struct value fn_log(const struct call *c)
{
    return map_numbers(c, log);
}

static struct value extreme(const struct call *c, double sign)
{
    struct value v;
    if (!common_shape(c, 0, c->n, &v))
        return value_error(c->node->span);
    for (uint32_t k = 0; k < v.n; k++) {
        v.number[k] = value_number(&c->args[0], k);
        for (uint32_t i = 1; i < c->n; i++) {
            double x = value_number(&c->args[i], k);
            if (sign * x > sign * v.number[k])
                v.number[k] = x;
        }
    }
    return v;
}

static struct value fn_min(const struct call *c)
{
    return extreme(c, -1);
}

static struct value fn_max(const struct call *c)
{
    return extreme(c, 1);
}

static struct value fn_clamp(const struct call *c)
{
    struct value v;
    if (!common_shape(c, 0, 3, &v))
        return value_error(c->node->span);
    for (uint32_t k = 0; k < v.n; k++) {
        double x = value_number(&c->args[0], k);
        double low = value_number(&c->args[1], k), high = value_number(&c->args[2], k);
        v.number[k] = x < low ? low : x > high ? high : x;
    }
    return v;
}

/* Exact at both ends. */
static void mix(const struct value *a, const struct value *b, const struct value *t,
                struct value *out)
{
    for (uint32_t k = 0; k < out->n; k++) {
        double x = value_number(t, k);
        out->number[k] = (1 - x) * value_number(a, k) + x * value_number(b, k);
    }
}

static struct value fn_lerp(const struct call *c)
{
    struct value v;
    const struct value *t = &c->args[2];
    if (!common_shape(c, 0, 2, &v))
        return value_error(c->node->span);
    if (t->n > 1 && v.n == 1) {
        v.type = VALUE_VECTOR;
        v.n = t->n;
        v.angles = v.angles ? (uint8_t)((1u << t->n) - 1) : 0;
    }
    if (t->n > 1 && t->n != v.n) {
        diag_report(c->e->diag, DIAG_WRONG_TYPE, t->span, "'lerp' cannot mix %s and %s",
                    value_type_name(&v), value_type_name(t));
        return value_error(c->node->span);
    }
    mix(&c->args[0], &c->args[1], t, &v);
    return v;
}

static struct value fn_smoothstep(const struct call *c)
{
    struct value v;
    if (!common_shape(c, 0, 3, &v))
        return value_error(c->node->span);
    for (uint32_t k = 0; k < v.n; k++) {
        double a = value_number(&c->args[0], k), b = value_number(&c->args[1], k);
        double x = value_number(&c->args[2], k);
        double t = a == b ? x >= b : (x - a) / (b - a);
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        v.number[k] = t * t * (3 - 2 * t);
    }
    v.angles = 0;
    return v;
}

/* ---- angles ---- */

static struct value fn_sin(const struct call *c)
{
    return value_of_number(sin_degrees(c->args[0].number[0]));
}

static struct value fn_cos(const struct call *c)
{
    return value_of_number(cos_degrees(c->args[0].number[0]));
}

static struct value fn_tan(const struct call *c)
{
    double x = c->args[0].number[0];
    return value_of_number(sin_degrees(x) / cos_degrees(x));
}

static struct value fn_asin(const struct call *c)
{
    return value_of_angle(asin(c->args[0].number[0]) * (180 / PI));
}

static struct value fn_acos(const struct call *c)
{
    return value_of_angle(acos(c->args[0].number[0]) * (180 / PI));
}

static struct value fn_atan2(const struct call *c)
{
    return value_of_angle(atan2(c->args[0].number[0], c->args[1].number[0]) * (180 / PI));
}

/* ---- vectors ---- */

static struct vec3 vector_of(const struct value *v)
{
    return vec3(v->number[0], v->number[1], v->n > 2 ? v->number[2] : 0);
}

static struct value fn_dot(const struct call *c)
{
    struct value v;
    if (!common_shape(c, 0, 2, &v))
        return value_error(c->node->span);
    return value_of_number(vec3_dot(vector_of(&c->args[0]), vector_of(&c->args[1])));
}

static struct value fn_cross(const struct call *c)
{
    return value_of_vec3(vec3_cross(vector_of(&c->args[0]), vector_of(&c->args[1])));
}

/* The vector times the power of two that brings its largest component near 1: exact, and free of
 * overflow from there on. */
static struct vec3 tamed(struct vec3 v, int *exponent)
{
    frexp(vec3_largest(v), exponent);
    return vec3(ldexp(v.x, -*exponent), ldexp(v.y, -*exponent), ldexp(v.z, -*exponent));
}

static double length_of(struct vec3 v)
{
    int exponent;
    double length = vec3_length(tamed(v, &exponent));
    return ldexp(length, exponent);
}

static struct value fn_length(const struct call *c)
{
    return value_of_number(length_of(vector_of(&c->args[0])));
}

static struct value fn_normalize(const struct call *c)
{
    struct value v = c->args[0];
    int exponent;
    struct vec3 a = tamed(vector_of(&v), &exponent);
    double length = vec3_length(a);
    v.colour = false;
    for (int i = 0; i < 3; i++)
        v.number[i] = vec3_at(a, i) / length;
    return v;
}

static struct value fn_distance(const struct call *c)
{
    struct value v;
    if (!common_shape(c, 0, 2, &v))
        return value_error(c->node->span);
    return value_of_number(length_of(vec3_sub(vector_of(&c->args[0]), vector_of(&c->args[1]))));
}

static struct value fn_rotate(const struct call *c)
{
    return value_of_vec3(
        vec3_rotate(vector_of(&c->args[0]), vector_of(&c->args[1]), c->args[2].number[0]));
}

/* ---- colours ---- */

static struct value fn_rgb(const struct call *c)
{
    return value_of_vec3(vec3(c->args[0].number[0], c->args[1].number[0], c->args[2].number[0]));
}

/* One channel: full within a sixth of a turn around its own hue, nothing from a third on. */
static double hsv_channel(double turns, double s, double v, double n)
{
    double k = fmod(n + 6 * turns, 6);
    double share = fmin(fmin(k, 4 - k), 1);
    return v - v * s * fmax(share, 0);
}

static struct value fn_hsv(const struct call *c)
{
    double h = c->args[0].number[0], s = c->args[1].number[0], v = c->args[2].number[0];
    double turns = c->args[0].angles ? h / 360 : h;
    turns -= floor(turns);
    return value_of_vec3(vec3(hsv_channel(turns, s, v, 5), hsv_channel(turns, s, v, 3),
                              hsv_channel(turns, s, v, 1)));
}

/* ---- lists ---- */

/* A whole number that is not too large, or not `least` at least, is reported. */
static bool require_whole(const struct call *c, uint32_t i, double least)
{
    const struct value *v = &c->args[i];
    double x = v->number[0];
    if (x == floor(x) && fabs(x) <= WHOLE_LIMIT && x >= least)
        return true;
    diag_report(c->e->diag, DIAG_WRONG_TYPE, v->span,
                least >= 0 ? "'%s' takes a whole number from 0 on, but this is %.17g"
                           : "'%s' takes whole numbers, but this is %.17g",
                c->f->name, x);
    return false;
}

static struct value fn_range(const struct call *c)
{
    bool bounds = c->args[1].type != VALUE_NONE, stepped = c->args[2].type != VALUE_NONE;
    double first = bounds ? c->args[0].number[0] : 0;
    double end = c->args[bounds].number[0], step = stepped ? c->args[2].number[0] : 1;
    for (uint32_t i = 0; i < 3; i++)
        if (c->args[i].type != VALUE_NONE && !require_whole(c, i, -INFINITY))
            return value_error(c->node->span);
    if (step == 0 || (stepped && !bounds)) {
        diag_report(c->e->diag, DIAG_ARITHMETIC, c->args[2].span,
                    step == 0 ? "a range cannot have steps of 0"
                              : "a range with a step needs both its bounds");
        return value_error(c->node->span);
    }
    double n = ceil((end - first) / step);
    n = n > 0 ? n : 0;
    if (!list_allowed(c->e, n, c->node->span))
        return value_error(c->node->span);
    return (struct value){.type = VALUE_LIST, .n = (uint32_t)n, .first = first, .step = step};
}

static struct value fn_steps(const struct call *c)
{
    struct value shape;
    if (!require_whole(c, 2, 0) || !common_shape(c, 0, 2, &shape))
        return value_error(c->node->span);
    double n = c->args[2].number[0];
    bool allowed = list_allowed(c->e, n, c->node->span);
    struct value *items = allowed ? list_reserve(c->e, (size_t)n, c->node->span) : NULL;
    if (!items)
        return value_error(c->node->span);
    shape.span = c->node->span;
    for (uint32_t i = 0; i < (uint32_t)n; i++) {
        struct value t = value_of_number(n > 1 ? i / (n - 1) : 0);
        items[i] = shape;
        mix(&c->args[0], &c->args[1], &t, &items[i]);
    }
    return (struct value){.type = VALUE_LIST, .n = (uint32_t)n, .items = items};
}

static size_t count_characters(struct str s)
{
    size_t n = 0;
    for (size_t i = 0; i < s.n; i++)
        n += (s.at[i] & 0xC0) != 0x80;
    return n;
}

static struct value fn_len(const struct call *c)
{
    const struct value *v = &c->args[0];
    return value_of_number(v->type == VALUE_STRING ? (double)count_characters(v->string) : v->n);
}

static struct value fn_str(const struct call *c)
{
    enum { MOST_DIGITS = 17 };
    bool given = c->args[1].type != VALUE_NONE;
    double digits = given ? c->args[1].number[0] : -1;
    if (given && !require_whole(c, 1, 0))
        return value_error(c->node->span);
    if (digits > MOST_DIGITS)
        digits = MOST_DIGITS;
    return value_text(c->e, &c->args[0], (int)digits, c->node->span);
}

static struct value fn_rand(const struct call *c)
{
    uint64_t x = 0;
    for (uint32_t i = 0; i < c->n; i++) {
        for (uint32_t k = 0; k < c->args[i].n; k++) {
            double number = c->args[i].number[k] + 0.0; /* -0 counts as 0 */
            uint64_t bits;
            memcpy(&bits, &number, sizeof bits);
            x = rng_mix(x ^ bits);
        }
        x = rng_mix(x + 1); /* (a, b) and a, b differ */
    }
    return value_of_number((double)(x >> 11) * 0x1p-53);
}

/* ---- the table ---- */

static const struct builtin builtins[] = {
#define FUNCTION(name_, parameters_, types_, required_, more_, doc_) \
    {#name_, parameters_, types_, required_, more_, fn_##name_, doc_},
#include "eval/functions.def"
#undef FUNCTION
};
enum { BUILTINS = sizeof builtins / sizeof *builtins };

uint32_t builtin_required(const struct builtin *f)
{
    return f->required;
}

bool builtin_takes_more(const struct builtin *f)
{
    return f->more;
}

struct str builtin_parameter(const struct builtin *f, uint32_t i)
{
    return str_nth_word(f->parameters, i);
}

static uint32_t count_parameters(const struct builtin *f)
{
    uint32_t n = 0;
    while (builtin_parameter(f, n).n)
        n++;
    return n;
}

void builtins_bind(struct eval *e)
{
    const struct span nowhere = {0};
    for (int i = 0; i < BUILTINS; i++) {
        struct binding *b = scope_bind(e, str_of(builtins[i].name), nowhere, BINDING_BUILTIN);
        b->builtin = &builtins[i];
        b->parameters = count_parameters(&builtins[i]);
    }
    scope_bind(e, str_of("pi"), nowhere, BINDING_VALUE)->value = value_of_number(PI);
}

/* ---- calls ---- */

static bool fits(char type, const struct value *v)
{
    bool number = v->type == VALUE_NUMBER, vector = v->type == VALUE_VECTOR;
    switch (type) {
    case 'n':
        return number && !v->angles;
    case 'u':
        return number;
    case 'a':
        return number && (v->angles || v->number[0] == 0);
    case 'f':
        return (number || vector) && !v->angles;
    case 'c':
        return number || vector;
    case 'v':
        return vector && !v->angles;
    case '3':
        return vector && !v->angles && v->n == 3;
    case 's':
        return vector || v->type == VALUE_LIST || v->type == VALUE_STRING;
    default:
        return true;
    }
}

/* `30` becomes `30deg`, `x` becomes `x * 1deg`, `x + 1` becomes `(x + 1) * 1deg`. */
static void offer_units(struct eval *e, struct diag_entry *entry, struct span span)
{
    static const char *const units[] = {"deg", "rad"};
    struct str text = srcmap_text(e->diag->sources, span);
    bool number = text.n && strspn(text.at, "0123456789.") >= text.n;
    size_t simple = 0;
    while (simple < text.n && !strchr(" \t\n+-*/%^?<>=&|!", text.at[simple]))
        simple++;
    for (int i = 0; i < 2; i++)
        diag_fix(entry, span, DIAG_FIX_MAYBE,
                 number             ? "%.*s%s"
                 : simple == text.n ? "%.*s * 1%s"
                                    : "(%.*s) * 1%s",
                 STR_ARG(text), units[i]);
    diag_note(entry, "an angle has a unit, 'deg' or 'rad', as in 90deg");
}

static bool check_argument(const struct call *c, uint32_t i)
{
    const struct value *v = &c->args[i];
    size_t last = strlen(c->f->types) - 1;
    char type = c->f->types[i < last ? i : last];
    if (v->type == VALUE_NONE || fits(type, v))
        return true;
    struct str name = builtin_parameter(c->f, i);
    struct diag_entry *entry =
        diag_report(c->e->diag, DIAG_WRONG_TYPE, v->span, "'%s' takes %s%s%.*s%s, but this is %s",
                    c->f->name, signature_type(type), name.n ? " as '" : "", STR_ARG(name),
                    name.n ? "'" : "", value_type_name(v));
    if (type == 'a' && v->type == VALUE_NUMBER)
        offer_units(c->e, entry, v->span);
    else
        diag_note(entry, "%s: %s", c->f->name, c->f->doc);
    return false;
}

static bool is_finite(const struct value *v)
{
    for (uint32_t i = 0; value_is_numeric(v) && i < v->n; i++)
        if (!isfinite(v->number[i]))
            return false;
    return true;
}

struct value builtin_call(struct eval *e, const struct builtin *f, const struct ast_node *call,
                          const struct arguments *arguments)
{
    struct call c = {e, f, call, arguments->at, arguments->n};
    bool right = true;
    while (f->more && c.args[c.n - 1].type == VALUE_NONE)
        c.n--;
    for (uint32_t i = 0; i < c.n; i++)
        right &= check_argument(&c, i);
    if (!right)
        return value_error(call->span);
    struct value v = f->run(&c);
    if (is_finite(&v))
        return v;
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_ARITHMETIC, call->span, "'%s' has no finite value here", f->name);
    for (uint32_t i = 0; i < c.n; i++) {
        struct value text = value_text(e, &c.args[i], -1, call->span);
        struct str name = builtin_parameter(f, i);
        if (text.type == VALUE_STRING)
            diag_note(entry, "'%.*s' is %.*s", STR_ARG(name), STR_ARG(text.string));
    }
    return value_error(call->span);
}
