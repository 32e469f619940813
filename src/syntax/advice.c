/* What is said beside a syntax error: how to write what was probably meant. */
#include "config.h"

#include "syntax/parser.h"
#include "syntax/syntax.h"

#include "grammar/scene.tab.h"

#include <string.h>

/* A value or a name, as far as its first character tells. */
static bool begins_item(struct str found)
{
    return found.n &&
           (strchr("([\"#_", found.at[0]) || (found.at[0] >= '0' && found.at[0] <= '9') ||
            ((found.at[0] | 32) >= 'a' && (found.at[0] | 32) <= 'z'));
}

/* A vector in the manner of POV-Ray, if it ends on its line. */
static void add_angle_brackets(const struct parser *p, struct diag_entry *e, struct span span)
{
    const char *text = p->source->text + (span.begin - p->source->base);
    size_t end = strcspn(text + 1, "<>\n") + 1;
    diag_note(e, "vectors are written (x, y, z)");
    if (text[end] != '>')
        return;
    struct span closing = {span.begin + (uint32_t)end, span.begin + (uint32_t)end + 1};
    diag_fix(e, span, DIAG_FIX_MAYBE, "(");
    diag_fix(e, closing, DIAG_FIX_MAYBE, ")");
}

/* ---- words of other languages ---------------------------------------------------------------- */

struct foreign {
    const char *words; /* with blanks around each */
    const char *ours;
};

static const struct foreign statements[] = {
    {" template macro module class struct ", "a template is written 'define name(...) { ... }'"},
    {" def function func fun lambda ", "a function is written 'fn name(...) = value'"},
    {" while foreach repeat loop ", "a loop is written 'for name in range(n) { ... }'"},
    {" import use require source #include ", "a file is included by 'include \"name\"'"},
    {" #declare #local #define #macro ", "a definition is written 'let name = value'"},
    {" elif elsif elseif ", "it is written 'else if'"},
    {" #if #ifdef #ifndef #while #for #else #end #version #version ",
     "the language has no directives; 'if', 'for' and 'let' are statements"},
};

static bool is_word_of(const char *words, struct str word)
{
    for (const char *at = words; word.n && (at = strstr(at, " ")) && at[1]; at++)
        if (strncmp(at + 1, word.at, word.n) == 0 && at[1 + word.n] == ' ')
            return true;
    return false;
}

/* The first word of the line, which an error at `span` is in. */
static struct str first_word(const struct parser *p, struct span span)
{
    struct str line = str_trim(srcmap_locate(p->diag->sources, span.begin).line_text);
    size_t n = line.n && *line.at == '#';
    while (n < line.n && (((line.at[n] | 32) >= 'a' && (line.at[n] | 32) <= 'z') ||
                          (line.at[n] >= '0' && line.at[n] <= '9') || line.at[n] == '_'))
        n++;
    return (struct str){line.at, n};
}

static const char *foreign_statement(const struct parser *p, struct span span)
{
    struct str word = first_word(p, span);
    for (size_t i = 0; i < sizeof statements / sizeof *statements; i++)
        if (is_word_of(statements[i].words, word))
            return statements[i].ours;
    return NULL;
}

/* `and`, `or` and `not` for `&&`, `||` and `!`; true when the word before the token is one. */
static bool add_operator(const struct parser *p, struct diag_entry *e)
{
    static const char *const words[][2] = {{"and", "&&"}, {"or", "||"}, {"not", "!"}};
    struct str word = srcmap_text(p->diag->sources, p->previous);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (!str_is(word, words[i][0]))
            continue;
        diag_note(e, "'%s' is written '%s'", words[i][0], words[i][1]);
        diag_fix(e, p->previous, DIAG_FIX_MAYBE, "%s", words[i][1]);
        return true;
    }
    return false;
}

/* ---- brackets -------------------------------------------------------------------------------- */

/* Points at the round or square bracket that is open where the token stands. */
static void label_open_bracket(const struct parser *p, struct diag_entry *e, struct span span)
{
    unsigned depth = p->bracket_at == span.begin ? p->depth_before : p->depth;
    struct span opening = depth ? p->brackets[depth - 1] : (struct span){0, 0};
    if (depth && *srcmap_text(p->diag->sources, opening).at != '{')
        diag_label(e, opening, "this is not closed");
}

static bool names_member(const struct parser *p, struct span span)
{
    const char *at = p->source->text + (span.end - p->source->base);
    return at[strspn(at, " \t\r\n")] == ':';
}

/* ---- statements ------------------------------------------------------------------------------ */

/* `a = 1` or `var a = 1` for `let a = 1`. */
static void add_let(const struct parser *p, struct diag_entry *e, struct span span)
{
    struct location line = srcmap_locate(p->diag->sources, span.begin);
    struct str word = first_word(p, span);
    uint32_t begin = line.line_base + (uint32_t)(word.at - line.line_text.at);
    diag_note(e, "a definition is written 'let name = value'");
    if (begin == p->previous.begin)
        diag_fix(e, (struct span){begin, begin}, DIAG_FIX_MAYBE, "let ");
    else
        diag_fix(e, (struct span){begin, begin + (uint32_t)word.n}, DIAG_FIX_MAYBE, "let");
}

/* A sign behind the first word of a statement. */
static void advise_on_sign(const struct parser *p, struct diag_entry *e, struct span span,
                           char sign)
{
    const char *at = p->source->text + (span.end - p->source->base);
    size_t n = strcspn(at, "{\n");
    if (at[n] == '{')
        diag_note(e, "a block follows its kind without a sign, as in 'sphere { ... }'");
    else if (sign == ':')
        diag_note(e, "a property stands in the block of its object");
    else
        add_let(p, e, span);
}

void parser_advise(const struct parser *p, struct diag_entry *e, struct span span,
                   const char *const *expected, size_t n)
{
    if (p->ast->xml)
        return;
    struct str found = srcmap_text(p->diag->sources, span);
    bool colon = false, name = false, comma = false, brace = false, closing = false;
    for (size_t i = 0; i < n; i++) {
        colon |= strcmp(expected[i], "':'") == 0;
        name |= strcmp(expected[i], "name") == 0;
        comma |= strcmp(expected[i], "','") == 0;
        brace |= strcmp(expected[i], "'{'") == 0;
        closing |= strcmp(expected[i], "')'") == 0 || strcmp(expected[i], "']'") == 0;
    }
    bool later = parser_on_later_line(p, span);
    bool item = begins_item(found) && !later && !syntax_is_keyword(found) && !names_member(p, span);
    const char *ours = later ? NULL : foreign_statement(p, span);
    if (ours)
        diag_note(e, "%s", ours);
    else if (!later && add_operator(p, e))
        return;
    else if (colon && str_is(found, "="))
        diag_note(e, "a property is written 'name: value'");
    else if (str_is(found, "<") && n == 1 && strcmp(expected[0], "value") == 0)
        add_angle_brackets(p, e, span);
    else if (name && brace && !colon && (str_is(found, "=") || str_is(found, ":")))
        advise_on_sign(p, e, span, *found.at);
    else if (n != 1 && found.n && *found.at == '#')
        diag_note(e, "comments begin with '//'");
    else if (closing && str_is(found, ":"))
        diag_note(e, "the properties of an object stand in braces, as in 'sphere { ... }'");
    else if (comma && (item || str_is(found, ";")))
        diag_note(e, "commas stand between the items of lists, vectors and calls");
    else if (closing && !item)
        label_open_bracket(p, e, span);
    else if (!later && str_is(first_word(p, span), "fn"))
        diag_note(e, "a function is written 'fn name(...) = value'");
    else if (!later && str_is(first_word(p, span), "define"))
        diag_note(e, "a template is written 'define name(...) { ... }'");
    else if (str_is(found, "if") && !later)
        diag_note(e, "a choice between values is written 'condition ? one : other'");
    else if (name && !brace && syntax_is_keyword(found) && !later)
        diag_note(e, "'%.*s' is a word of the language, so it cannot be a name", STR_ARG(found));
}
