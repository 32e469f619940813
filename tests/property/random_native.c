/* Native texts with comments and blank lines between any two tokens. */
#include "config.h"

#include "random.h"

static void put_name(struct writer *w)
{
    put_one_of(w, "a b gold a_rather_long_name_for_a_thing x1 _ sphere pi center wood0 deg");
}

/* ---- values ---- */

static void put_value(struct writer *w, unsigned depth);
static void put_members(struct writer *w, unsigned depth);

static void put_block(struct writer *w, unsigned depth)
{
    put(w, "{");
    put_members(w, depth);
    put(w, "}");
}

static void put_primary(struct writer *w, unsigned depth);

static void put_list(struct writer *w, unsigned depth, unsigned least, unsigned most)
{
    unsigned n = least + below(w, most - least + 1);
    for (unsigned i = 0; i < n; i++) {
        if (i > 0)
            put(w, ",");
        put_value(w, depth);
    }
}

static void put_operand(struct writer *w, unsigned depth)
{
    while (once_in(w, 6))
        put_one_of(w, "- + !");
    put_primary(w, depth);
}

static void put_expression(struct writer *w, unsigned depth)
{
    if (depth == 0 || once_in(w, 2)) {
        put_primary(w, depth);
        return;
    }
    switch (below(w, 4)) {
    case 0:
        put_one_of(w, "- + !");
        put_expression(w, depth - 1);
        break;
    case 1:
        put_expression(w, depth - 1);
        put(w, "?");
        put_expression(w, depth - 1);
        put(w, ":");
        put_expression(w, depth - 1);
        break;
    default:
        for (unsigned n = 1 + below(w, once_in(w, 8) ? 30 : 3); n > 0; n--) {
            put_operand(w, depth - 1);
            put_one_of(w, "|| && == != < <= > >= + - * / % ^");
        }
        put_operand(w, depth - 1);
        break;
    }
}

static void put_arguments(struct writer *w, unsigned depth)
{
    unsigned n = below(w, 4);
    put(w, "(");
    for (unsigned i = 0; i < n; i++) {
        if (i > 0)
            put(w, ",");
        if (once_in(w, 3)) {
            put_name(w);
            put(w, "=");
        }
        put_value(w, depth);
    }
    if (n && once_in(w, 4))
        put(w, ",");
    put(w, ")");
}

static void put_selectors(struct writer *w, unsigned depth)
{
    while (once_in(w, 6)) {
        if (once_in(w, 2)) {
            put(w, ".");
            put_one_of(w, "x y z r g b");
        } else {
            put(w, "[");
            put_expression(w, depth);
            put(w, "]");
        }
    }
}

static void put_bracketed(struct writer *w, unsigned depth)
{
    switch (below(w, 5)) {
    case 0:
        put(w, "(");
        put_value(w, depth);
        put(w, ")");
        break;
    case 1:
        put(w, "(");
        for (unsigned n = 1 + below(w, 2); n > 0; n--) {
            put_expression(w, depth);
            put(w, ",");
        }
        put_expression(w, depth);
        put(w, ")");
        break;
    case 2:
        put(w, "[");
        put_list(w, depth, 1, once_in(w, 6) ? 60 : 4);
        if (once_in(w, 3))
            put(w, ",");
        put(w, "]");
        break;
    case 3:
        put(w, "[");
        put_value(w, depth);
        put(w, "for");
        put_name(w);
        put(w, "in");
        put_expression(w, depth);
        put(w, "]");
        break;
    default:
        put_name(w);
        put_arguments(w, depth);
        break;
    }
}

static void put_primary(struct writer *w, unsigned depth)
{
    static const char atoms[] = "0 1 -0 2.5 .5 1. 1e-3 12345.678901234567 54deg 1rad .5deg \"\" "
                                "\"wood.png\" \"a\\\"b\\u{41}//\" "
                                "true false #c7b852 a gold x1 pi";
    if (depth > 0 && once_in(w, 2))
        put_bracketed(w, depth - 1);
    else
        put_one_of(w, atoms);
    put_selectors(w, depth > 0 ? depth - 1 : 0);
}

static void put_value(struct writer *w, unsigned depth)
{
    if (depth > 0 && once_in(w, 4)) {
        put_name(w);
        put_block(w, depth - 1);
    } else {
        put_expression(w, depth);
    }
}

/* ---- statements ---- */

static void put_definition(struct writer *w, const char *word, unsigned depth)
{
    put(w, word);
    put_name(w);
    put(w, "=");
    put_value(w, depth);
}

static void put_parameters(struct writer *w, unsigned depth)
{
    unsigned n = below(w, 4);
    put(w, "(");
    for (unsigned i = 0; i < n; i++) {
        if (i > 0)
            put(w, ",");
        put_name(w);
        if (once_in(w, 2)) {
            put(w, "=");
            put_value(w, depth);
        }
    }
    if (n && once_in(w, 4))
        put(w, ",");
    put(w, ")");
}

static void put_if(struct writer *w, unsigned depth)
{
    put(w, "if");
    put_expression(w, depth);
    put_block(w, depth);
    while (once_in(w, 2)) {
        put(w, "else");
        if (once_in(w, 2)) {
            put_block(w, depth);
            return;
        }
        put(w, "if");
        put_expression(w, depth);
        put_block(w, depth);
    }
}

static void put_plain_statement(struct writer *w, unsigned depth)
{
    switch (below(w, 5)) {
    case 0:
        put(w, "model");
        put_one_of(w, "classic modern");
        break;
    case 1:
        put(w, "include");
        put(w, "\"metals.wrt\"");
        break;
    case 2:
        put(w, "assert");
        put_expression(w, depth);
        put(w, ",");
        put_expression(w, depth);
        break;
    case 3:
        put(w, "fn");
        put_name(w);
        put_parameters(w, depth);
        put(w, "=");
        put_value(w, depth);
        break;
    default:
        put_definition(w, once_in(w, 2) ? "let" : "param", depth);
        break;
    }
}

static void put_object(struct writer *w, unsigned depth)
{
    if (once_in(w, 5))
        put(w, "default");
    put_name(w);
    if (once_in(w, 2))
        put_name(w);
    put_block(w, depth);
}

/* `light point lamp { ... }` */
static void put_labelled(struct writer *w, unsigned depth)
{
    for (int i = 0; i < 3; i++)
        put_name(w);
    put_block(w, depth);
}

static void put_statement(struct writer *w, unsigned depth)
{
    switch (depth == 0 ? 0 : below(w, 9)) {
    case 0:
        put_plain_statement(w, depth);
        break;
    case 1:
        put_definition(w, "material", depth);
        break;
    case 2:
        put_definition(w, "texture", depth);
        break;
    case 3:
        put(w, "define");
        put_name(w);
        put_parameters(w, depth - 1);
        put_block(w, depth - 1);
        break;
    case 4:
        put(w, "for");
        put_name(w);
        put(w, "in");
        put_expression(w, depth - 1);
        put_block(w, depth - 1);
        break;
    case 5:
        put_if(w, depth - 1);
        break;
    case 6:
        put_name(w);
        put_arguments(w, depth - 1);
        if (once_in(w, 2))
            put_block(w, depth - 1);
        break;
    case 7:
        put_labelled(w, depth - 1);
        break;
    default:
        put_object(w, depth - 1);
        break;
    }
}

static void put_members(struct writer *w, unsigned depth)
{
    for (unsigned n = below(w, 5); n > 0; n--) {
        if (once_in(w, 4)) {
            put_statement(w, depth);
        } else {
            put_one_of(w, "center radius material texture diffuse a_property_with_a_longer_name");
            put(w, ":");
            put_value(w, depth);
        }
        while (once_in(w, 4))
            put_one_of(w, ", ;");
    }
}

void random_native(uint64_t seed, struct buffer *out)
{
    struct writer w = writer_begin(seed, false, out);
    put(&w, "wrt");
    put(&w, "1");
    for (unsigned n = below(&w, 8); n > 0; n--) {
        put_statement(&w, below(&w, 4));
        while (once_in(&w, 6))
            put(&w, ";");
    }
    put_gap(&w, false);
}
