#include "config.h"

#include "eval/signature.h"

#include <string.h>

static const struct signature functions[] = {
#define FUNCTION(name_, parameters_, types_, required_, more_, doc_) \
    {#name_, parameters_, types_, required_, more_, doc_},
#include "eval/functions.def"
#undef FUNCTION
};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

static const struct {
    const char *name, *written, *doc;
} statements[] = {
#define STATEMENT(name_, written_, doc_) {name_, written_, doc_},
#include "eval/statements.def"
#undef STATEMENT
};
enum { STATEMENTS = sizeof statements / sizeof *statements };

/* Params whose values options give. */
static const struct {
    const char *name, *written, *doc;
} params[] = {
    {"frame", "param frame = 0",
     "the number of the frame that 'wrt render --frames A..B' is at; its own value otherwise"},
    {"time", "param time = 0",
     "the seconds from frame 0 to the one that 'wrt render --frames A..B' is at: its number over "
     "--fps; its own value otherwise"},
};
enum { PARAMS = sizeof params / sizeof *params };

const char *signature_type(char letter)
{
    static const struct {
        char letter;
        const char *words;
    } rows[] = {{'n', "a number"},
                {'u', "a number or an angle"},
                {'a', "an angle"},
                {'f', "a number or a vector"},
                {'c', "a number, an angle or a vector"},
                {'v', "a vector"},
                {'3', "a vector of three"},
                {'s', "a list, a string or a vector"},
                {'x', "any value"}};
    size_t i = 0;
    while (rows[i].letter != letter)
        i++;
    return rows[i].words;
}

/* What stands between the parentheses. */
static void add_parameters(struct buffer *out, const struct signature *s)
{
    struct str name;
    for (unsigned i = 0; (name = str_nth_word(s->parameters, i)).n; i++)
        buffer_printf(out, "%s%.*s%s", i ? ", " : "", STR_ARG(name),
                      i < s->required || s->more ? "" : " = ...");
    buffer_puts(out, s->more ? ", ..." : "");
}

void signature_write(struct buffer *out, const struct signature *s)
{
    buffer_printf(out, "%s(", s->name);
    add_parameters(out, s);
    buffer_puts(out, ")");
}

bool signature_is_function(struct str name)
{
    for (int f = 0; f < FUNCTIONS; f++)
        if (str_is(name, functions[f].name))
            return true;
    return false;
}

bool signature_describe_function(struct buffer *out, struct str name)
{
    int f = 0;
    while (f < FUNCTIONS && !str_is(name, functions[f].name))
        f++;
    if (f == FUNCTIONS)
        return false;
    const struct signature *s = &functions[f];
    size_t last = strlen(s->types) - 1;
    struct str parameter;
    signature_write(out, s);
    buffer_printf(out, ": %s\n\n", s->doc);
    for (unsigned i = 0; (parameter = str_nth_word(s->parameters, i)).n; i++)
        buffer_printf(out, "  %-8.*s %s%s\n", STR_ARG(parameter),
                      signature_type(s->types[i < last ? i : last]),
                      i < s->required ? "" : ", may be left out");
    return true;
}

bool signature_describe_statement(struct buffer *out, struct str name)
{
    int i = 0;
    while (i < STATEMENTS && !str_is(name, statements[i].name))
        i++;
    if (i < STATEMENTS)
        buffer_printf(out, "%s: %s\n", statements[i].written, statements[i].doc);
    return i < STATEMENTS;
}

bool signature_describe_param(struct buffer *out, struct str name)
{
    int i = 0;
    while (i < PARAMS && !str_is(name, params[i].name))
        i++;
    if (i < PARAMS)
        buffer_printf(out, "%s: %s\n", params[i].written, params[i].doc);
    return i < PARAMS;
}

void signature_list_functions(struct buffer *out)
{
    buffer_puts(out, "functions:\n");
    for (int i = 0; i < FUNCTIONS; i++) {
        buffer_puts(out, "  ");
        signature_write(out, &functions[i]);
        buffer_printf(out, "\n      %s\n", functions[i].doc);
    }
}

void signature_list_statements(struct buffer *out)
{
    buffer_puts(out, "statements:\n");
    for (int i = 0; i < STATEMENTS; i++)
        buffer_printf(out, "  %s\n      %s\n", statements[i].written, statements[i].doc);
}

struct str signature_meant(struct str name)
{
    static const struct {
        const char *elsewhere, *here;
    } rows[] = {{"sine", "sin"},    {"cosine", "cos"},     {"tangent", "tan"},
                {"arcsin", "asin"}, {"arccos", "acos"},    {"atan", "atan2"},
                {"mix", "lerp"},    {"norm", "normalize"}, {"magnitude", "length"},
                {"random", "rand"}, {"ln", "log"},         {"linspace", "steps"},
                {"string", "str"},  {"size", "len"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (str_is(name, rows[i].elsewhere))
            return str_of(rows[i].here);
    return (struct str){0};
}

void signature_try_names(struct str_nearest *nearest)
{
    for (int i = 0; i < FUNCTIONS; i++)
        str_nearest_try(nearest, str_of(functions[i].name));
    for (int i = 0; i < STATEMENTS; i++)
        str_nearest_try(nearest, str_of(statements[i].name));
    for (int i = 0; i < PARAMS; i++)
        str_nearest_try(nearest, str_of(params[i].name));
}

void signature_manual(struct buffer *out)
{
    buffer_puts(out, ".Bl -tag -width Ds\n");
    for (int i = 0; i < FUNCTIONS; i++) {
        buffer_printf(out, ".It Ic %s Ns No (", functions[i].name);
        add_parameters(out, &functions[i]);
        buffer_printf(out, ")\n%s.\n", functions[i].doc);
    }
    buffer_puts(out, ".El\n");
}
