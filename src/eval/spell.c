/* Values as text, and strings under construction. */
#include "config.h"

#include "base/buffer.h"
#include "eval/context.h"

/* Bytes of a string. */
enum { STRING_LIMIT = 1 << 24 };

char *string_reserve(struct eval *e, size_t n, struct span span)
{
    enum { BYTES_A_STEP = 64 };
    if (n > STRING_LIMIT) {
        diag_report(e->diag, DIAG_TOO_MANY_OBJECTS, span,
                    "a string of %zu bytes is longer than the %d that are allowed", n,
                    STRING_LIMIT);
        return NULL;
    }
    return eval_spend(e, n / BYTES_A_STEP, span) ? eval_alloc(e, n, span) : NULL;
}

static void add_number(struct buffer *b, double x, bool angle, int digits)
{
    if (digits < 0)
        buffer_number(b, x);
    else
        buffer_printf(b, "%.*f", digits, x);
    buffer_puts(b, angle ? "deg" : "");
}

static bool add_value(struct eval *e, struct buffer *b, const struct value *v, int digits,
                      struct span span);

static bool add_items(struct eval *e, struct buffer *b, const struct value *v, int digits,
                      struct span span)
{
    bool right = eval_enter(e, span) && eval_spend(e, v->n, span);
    buffer_puts(b, "[");
    for (uint32_t i = 0; i < v->n && right; i++) {
        struct value item = value_item(v, i);
        buffer_puts(b, i ? ", " : "");
        right = add_value(e, b, &item, digits, span) && b->n <= STRING_LIMIT;
    }
    buffer_puts(b, "]");
    eval_leave(e);
    return right;
}

static void add_object(struct buffer *b, const struct desc_object *o)
{
    buffer_puts(b, schema_kind_name(o->kind, false));
    if (o->name.n)
        buffer_printf(b, " %.*s", STR_ARG(o->name));
}

static bool add_value(struct eval *e, struct buffer *b, const struct value *v, int digits,
                      struct span span)
{
    switch ((enum value_type)v->type) {
    case VALUE_NUMBER:
        add_number(b, v->number[0], v->angles, digits);
        return true;
    case VALUE_VECTOR:
        for (uint32_t i = 0; i < v->n; i++) {
            buffer_puts(b, i ? ", " : "(");
            add_number(b, v->number[i], value_is_angle(v, i), digits);
        }
        buffer_puts(b, ")");
        return true;
    case VALUE_BOOL:
        buffer_puts(b, v->boolean ? "true" : "false");
        return true;
    case VALUE_STRING:
        buffer_str(b, v->string);
        return true;
    case VALUE_LIST:
        return add_items(e, b, v, digits, span);
    case VALUE_OBJECT:
        add_object(b, v->object);
        return true;
    case VALUE_NONE:
    case VALUE_ERROR:
        break;
    }
    return false;
}

struct value value_text(struct eval *e, const struct value *v, int digits, struct span span)
{
    struct buffer b = {0};
    struct value out = value_error(span);
    char *text = add_value(e, &b, v, digits, span) ? string_reserve(e, b.n, span) : NULL;
    if (text) {
        memcpy(text, b.at ? b.at : "", b.n);
        out = (struct value){.type = VALUE_STRING, .string = {text, b.n}};
    }
    buffer_free(&b);
    return out;
}
