#include "config.h"

#include "lint/explain.h"

#include "lint/lint.h"

#include <string.h>

static const struct explanation {
    const char *why, *wrong, *right;
} explanations[DIAG_CODES] = {
#define EXPLAIN(id, why, wrong, right) [DIAG_##id] = {why, wrong, right},
#include "lint/explain.def"
#include "lint/explain_errors.def"
#undef EXPLAIN
};

static const char *level_of(enum diag_code code)
{
    static const char *const words[] = {
        [DIAG_NOTE] = "note", [DIAG_WARNING] = "warning", [DIAG_ERROR] = "error"};
    return words[diag_rules[code].level];
}

static void add_indented(struct buffer *out, const char *title, const char *text)
{
    if (!*text)
        return;
    buffer_printf(out, "\n%s:\n", title);
    for (const char *line = text, *end; *line; line = end + (*end != 0)) {
        end = line + strcspn(line, "\n");
        buffer_printf(out, "    %.*s\n", (int)(end - line), line);
    }
}

/* Words until the line is full; a newline in the text ends a paragraph. */
static void add_wrapped(struct buffer *out, const char *text)
{
    enum { WIDTH = 79 };
    size_t column = 0;
    for (const char *word = text; *word;) {
        size_t n = strcspn(word, " \n");
        if (column && column + 1 + n > WIDTH) {
            buffer_puts(out, "\n");
            column = 0;
        }
        buffer_puts(out, column ? " " : "");
        buffer_add(out, word, n);
        column += n + (column > 0);
        word += n;
        if (*word == '\n') {
            buffer_puts(out, "\n");
            column = 0;
        }
        word += *word != 0;
    }
}

static void add_thresholds(struct buffer *out, enum diag_code code)
{
    for (unsigned i = 0; lint_threshold_of(code, i); i++) {
        const struct lint_threshold *t = lint_threshold_of(code, i);
        buffer_printf(out, "%s    ", i ? "" : "\nthresholds:\n");
        buffer_number(out, t->value);
        buffer_printf(out, "  %s\n", t->meaning);
    }
}

const char *explain_why(enum diag_code code)
{
    return explanations[code].why;
}

void explain_code(enum diag_code code, struct buffer *out)
{
    const struct diag_rule *rule = &diag_rules[code];
    const struct explanation *e = &explanations[code];
    buffer_printf(out, "%s %s (%s", rule->code, rule->slug, level_of(code));
    if (rule->group)
        buffer_printf(out, ", group %s%s", diag_groups[rule->group].name,
                      diag_is_optional(code) ? ", off unless asked for" : "");
    buffer_printf(out, ")\n%s\n", rule->summary);
    if (!e->why)
        return;
    buffer_puts(out, "\n");
    add_wrapped(out, e->why);
    add_indented(out, "wrong", e->wrong);
    add_indented(out, "right", e->right);
    add_thresholds(out, code);
    if (lint_needs(code))
        buffer_printf(out, "\n'wrt lint' looks for it; the check %s.\n", lint_needs(code));
}

void explain_list(struct buffer *out)
{
    for (int g = DIAG_NONE + 1; g < DIAG_GROUPS; g++) {
        buffer_printf(out, "%s%s: %s\n", g > DIAG_NONE + 1 ? "\n" : "", diag_groups[g].name,
                      diag_groups[g].summary);
        for (int i = 0; i < DIAG_CODES; i++) {
            const struct diag_rule *r = &diag_rules[i];
            if (r->group == (enum diag_group)g)
                buffer_printf(out, "  %s %-30s %-7s %s\n", r->code, r->slug,
                              level_of((enum diag_code)i), r->summary);
        }
    }
}

/* What mdoc takes for a macro or a quote is spelt otherwise. */
static void add_plain(struct buffer *out, const char *text)
{
    for (const char *at = text; *at; at++)
        if (*at == '\'')
            buffer_puts(out, "\\(aq");
        else
            buffer_add(out, at, 1);
}

static bool is_empty(enum diag_group group)
{
    for (int i = 0; i < DIAG_CODES; i++)
        if (diag_rules[i].group == group)
            return false;
    return true;
}

void explain_manual(struct buffer *out)
{
    for (int g = DIAG_NONE; g < DIAG_GROUPS; g++) {
        if (is_empty((enum diag_group)g))
            continue;
        buffer_printf(out, ".Ss %s\n", g ? diag_groups[g].name : "always told");
        buffer_puts(out, ".Bl -tag -width Ds -compact\n");
        for (int i = 0; i < DIAG_CODES; i++) {
            const struct diag_rule *r = &diag_rules[i];
            if (r->group != (enum diag_group)g)
                continue;
            buffer_printf(out, ".It %s %s Pq %s\n", r->code, r->slug,
                          diag_is_optional((enum diag_code)i) ? "note, off unless asked for"
                                                              : level_of((enum diag_code)i));
            add_plain(out, r->summary);
            buffer_puts(out, "\n");
        }
        buffer_puts(out, ".El\n");
    }
}
