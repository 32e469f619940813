/* How well mistakes are told: scenes with one token deleted, doubled, swapped with the next or
 * misspelt.
 *
 *     mutants COUNT SCENE...
 *
 * Mutants that are still right are left out.  Of the others the first error should lie within a
 * line of the mutation, and one mistake should not be told as more than two.  Prints a table and
 * fails where fewer than 95 % do; with MUTANTS_SHOW set prints those mutants. */
#include "config.h"

#include "random.h"

#include "../unit/load.h"
#include "base/file.h"
#include "eval/eval.h"
#include "syntax/syntax.h"
#include "validate/validate.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum mutation { DELETED, DOUBLED, SWAPPED, MISSPELT, MUTATIONS };
static const char *const names[MUTATIONS] = {"deleted", "doubled", "swapped", "misspelt"};

struct token {
    size_t begin, end;
};

struct original {
    const char *path;
    char *text;
    size_t n;
    bool xml;
    VEC(struct token) tokens;
};

/* ---- tokens ---------------------------------------------------------------------------------- */

static bool in_word(char c)
{
    return isalnum((unsigned char)c) || c == '_' || c == '.' || (unsigned char)c >= 0x80;
}

/* The end of what is no token: white space and comments. */
static size_t skip_gap(const struct original *s, size_t at)
{
    static const char *const marks[][2] = {
        {"<!--", "-->"}, {"<?", "?>"}, {"/*", "*/"}, {"//", "\n"}};
    for (bool again = true; again;) {
        again = false;
        while (at < s->n && isspace((unsigned char)s->text[at]))
            at++;
        for (int i = s->xml ? 0 : 2; i < (s->xml ? 2 : 4); i++) {
            if (strncmp(s->text + at, marks[i][0], strlen(marks[i][0])) != 0)
                continue;
            const char *end = strstr(s->text + at, marks[i][1]);
            at = end ? (size_t)(end - s->text) + strlen(marks[i][1]) : s->n;
            again = true;
        }
    }
    return at;
}

/* Words, quoted texts, `</` and `/>`, and single characters. */
static size_t token_end(const struct original *s, size_t at)
{
    char c = s->text[at];
    if (c == '"') {
        const char *end = strchr(s->text + at + 1, '"');
        return end ? (size_t)(end - s->text) + 1 : s->n;
    }
    if (s->xml && (strncmp(s->text + at, "</", 2) == 0 || strncmp(s->text + at, "/>", 2) == 0))
        return at + 2;
    bool sign = s->xml && c == '-' && in_word(s->text[at + 1]);
    if (!in_word(c) && !sign)
        return at + 1;
    at++;
    while (at < s->n && in_word(s->text[at]))
        at++;
    return at;
}

static bool original_read(struct original *s, const char *path)
{
    *s = (struct original){.path = path};
    if (file_read(path, &s->text, &s->n))
        return false;
    s->text[s->n] = 0;
    s->xml = syntax_is_xml((struct str){s->text, s->n});
    for (size_t at = skip_gap(s, 0), end; at < s->n; at = skip_gap(s, end)) {
        end = token_end(s, at);
        vec_push(&s->tokens, (struct token){at, end});
    }
    return s->tokens.n > 1;
}

/* ---- mutations ------------------------------------------------------------------------------- */

static void add(struct buffer *out, const struct original *s, size_t begin, size_t end)
{
    buffer_add(out, s->text + begin, end - begin);
}

/* A letter, digit or character more, less, or another one. */
static void misspell(struct random *r, const struct original *s, struct token t, struct buffer *out)
{
    size_t at = t.begin + random_below(r, (unsigned)(t.end - t.begin));
    char other = "aeinorst"[random_below(r, 8)];
    unsigned how = random_below(r, 3);
    add(out, s, t.begin, at);
    if (how != 0)
        buffer_add(out, &other, 1);
    add(out, s, how == 2 ? at : at + 1, t.end);
}

/* Puts the mutant into *out; returns where the first changed token was. */
static size_t mutate(struct random *r, const struct original *s, enum mutation how,
                     struct buffer *out)
{
    size_t i = random_below(r, (unsigned)s->tokens.n - (how == SWAPPED));
    struct token t = s->tokens.at[i];
    add(out, s, 0, t.begin);
    if (how == MISSPELT) {
        misspell(r, s, t, out);
    } else if (how == DOUBLED) {
        add(out, s, t.begin, t.end);
        buffer_puts(out, " ");
        add(out, s, t.begin, t.end);
    } else if (how == SWAPPED) {
        struct token next = s->tokens.at[i + 1];
        add(out, s, next.begin, next.end);
        add(out, s, t.end, next.begin);
        add(out, s, t.begin, t.end);
        t.end = next.end;
    }
    add(out, s, t.end, s->n);
    return t.begin;
}

/* ---- what is said ---------------------------------------------------------------------------- */

struct tally {
    unsigned tried, wrong, near, few;
};

/* The whole front end, as `wrt check` runs it. */
static void check(struct load *l, const char *path, const char *text)
{
    struct eval_options options = {.max_objects = 10 * 1000 * 1000, .sources = &l->sources};
    load_text(l, path, text);
    bool parsed = syntax_parse(l->source, &l->ast, &l->diag);
    if (!parsed && (l->ast.xml || !l->ast.statements))
        return;
    eval_scene(&l->ast, &options, &l->desc, &l->diag);
    if (parsed || l->desc.camera)
        validate_scene(&l->desc, &l->diag);
}

static const struct diag_entry *first_error(struct load *l)
{
    diag_sort(&l->diag);
    for (size_t i = 0; i < l->diag.entries.n; i++)
        if (l->diag.entries.at[i]->level == DIAG_ERROR)
            return l->diag.entries.at[i];
    return NULL;
}

/* As they are told: one that is found in each round of a loop is one. */
static size_t count_errors(const struct load *l)
{
    size_t n = 0;
    for (size_t i = 0; i < l->diag.entries.n; i++)
        n += l->diag.entries.at[i]->level == DIAG_ERROR;
    return n;
}

static void examine(const struct original *s, const struct buffer *mutant, size_t place,
                    enum mutation how, struct tally *tally)
{
    struct load l;
    check(&l, s->path, mutant->at);
    const struct diag_entry *first = first_error(&l);
    tally->tried++;
    if (first) {
        struct location at = srcmap_locate(&l.sources, first->span.begin);
        uint32_t end = (uint32_t)(place < l.source->n ? place : l.source->n);
        struct location wanted = srcmap_locate(&l.sources, l.source->base + end);
        bool near =
            at.source == wanted.source && at.line + 1 >= wanted.line && at.line <= wanted.line + 1;
        bool few = count_errors(&l) <= 2;
        tally->wrong++;
        tally->near += near;
        tally->few += few;
        if (getenv("MUTANTS_SHOW") && !(near && few)) {
            printf("---- %s, line %u, %s%s%s: %.*s\n", s->path, wanted.line, names[how],
                   near ? "" : ", far", few ? "" : ", many", STR_ARG(wanted.line_text));
            diag_print(&l.diag, &(struct diag_print_options){.least = DIAG_ERROR}, stdout);
        }
    }
    load_free(&l);
}

/* Returns whether enough of the mutants are told well. */
static bool print_row(const char *format, const char *name, const struct tally *t)
{
    double wrong = t->wrong ? t->wrong : 1, near = 100 * t->near / wrong,
           few = 100 * t->few / wrong;
    printf("%-7s %-9s %6u %6u %9.1f %9.1f\n", format, name, t->tried, t->wrong, near, few);
    return near >= 95 && few >= 95;
}

int main(int argc, char **argv)
{
    unsigned long count = argc > 1 ? strtoul(argv[1], NULL, 10) : 0;
    struct tally tallies[2][MUTATIONS] = {0}, all = {0};
    VEC(struct original) scenes = {0};
    alarm(600); /* a mutant that hangs must not hang the tests */
    for (int i = 2; i < argc; i++) {
        struct original s;
        if (!original_read(&s, argv[i])) {
            fprintf(stderr, "mutants: could not read %s\n", argv[i]);
            return 1;
        }
        vec_push(&scenes, s);
    }
    for (unsigned long i = 0; i < count && scenes.n; i++) {
        struct random r = {.state = i};
        const struct original *s = &scenes.at[i % scenes.n];
        enum mutation how = (enum mutation)random_below(&r, MUTATIONS);
        struct buffer mutant = {0};
        size_t place = mutate(&r, s, how, &mutant);
        buffer_add(&mutant, "", 1);
        examine(s, &mutant, place, how, &tallies[s->xml][how]);
        buffer_free(&mutant);
    }
    puts("format  token      tried  wrong  % near  % at most 2 errors");
    for (int xml = 0; xml < 2; xml++) {
        for (int how = 0; how < MUTATIONS; how++) {
            const struct tally *t = &tallies[xml][how];
            print_row(xml ? "XML" : "native", names[how], t);
            all.tried += t->tried;
            all.wrong += t->wrong;
            all.near += t->near;
            all.few += t->few;
        }
    }
    bool good = print_row("all", "", &all) && all.wrong > 0;
    for (size_t i = 0; i < scenes.n; i++) {
        free(scenes.at[i].text);
        vec_free(&scenes.at[i].tokens);
    }
    vec_free(&scenes);
    return !good;
}
