#include "config.h"

#include "convert/names.h"

#include "schema/schema.h"
#include "syntax/syntax.h"

static bool is_letter(char c)
{
    return ((c | 32) >= 'a' && (c | 32) <= 'z') || c == '_';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_identifier(struct str s)
{
    if (!s.n || !is_letter(s.at[0]))
        return false;
    for (size_t i = 1; i < s.n; i++)
        if (!is_letter(s.at[i]) && !is_digit(s.at[i]))
            return false;
    return true;
}

/* What makes objects, and what means something of its own in a value. */
static bool has_meaning(struct str s)
{
    for (int g = 0; g < SCHEMA_GROUPS; g++)
        if (schema_find_kind((enum schema_group)g, s, false) != SCHEMA_KINDS)
            return true;
    return str_is(s, "pi");
}

bool name_is_free(struct str text)
{
    return is_identifier(text) && !syntax_is_keyword(text);
}

/* Letters and digits of the text, with `_` for runs of other bytes. */
static struct str made_identifier(struct names *n, struct str text)
{
    char *name = arena_alloc(n->arena, text.n + 2), *out = name;
    if (!text.n || is_digit(text.at[0]))
        *out++ = '_';
    for (size_t i = 0; i < text.n; i++) {
        bool fits = is_letter(text.at[i]) || is_digit(text.at[i]);
        if (fits || out == name || out[-1] != '_')
            *out++ = fits ? text.at[i] : '_';
    }
    return (struct str){name, (size_t)(out - name)};
}

/* The name, with a number where it is taken or means something. */
static struct str free_variant(struct names *n, struct str name)
{
    struct str variant = name;
    for (unsigned i = 2;
         map_get(&n->taken, variant) || syntax_is_keyword(variant) || has_meaning(variant); i++) {
        const char *text = arena_printf(n->arena, "%.*s_%u", STR_ARG(name), i);
        variant = str_of(text);
    }
    return variant;
}

struct str names_take(struct names *n, struct str wanted)
{
    struct str name = is_identifier(wanted) ? wanted : made_identifier(n, wanted);
    name = free_variant(n, name);
    map_set(&n->taken, name, n);
    return name;
}

struct str names_of_file(struct names *n, struct str file)
{
    size_t begin = file.n;
    while (begin && file.at[begin - 1] != '/')
        begin--;
    size_t end = file.n;
    for (size_t i = file.n; i > begin + 1; i--) {
        if (file.at[i - 1] != '.')
            continue;
        end = i - 1;
        break;
    }
    struct str stem = {file.at + begin, end - begin};
    return free_variant(n, is_identifier(stem) ? stem : made_identifier(n, stem));
}

void names_free(struct names *n)
{
    map_free(&n->taken);
}
