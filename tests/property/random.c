#include "config.h"

#include "random.h"

/* The splitmix64 generator (Steele, Lea, Flood, OOPSLA 2014). */
static uint64_t next(struct random *r)
{
    uint64_t z = r->state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

unsigned random_below(struct random *r, unsigned n)
{
    return (unsigned)((next(r) >> 32) * n >> 32);
}

bool random_once_in(struct random *r, unsigned n)
{
    return random_below(r, n) == 0;
}

struct str random_word(struct random *r, const char *words)
{
    unsigned n = 1;
    for (const char *c = words; *c; c++)
        n += *c == ' ';
    for (unsigned skip = random_below(r, n); skip; skip--)
        words = strchr(words, ' ') + 1;
    return (struct str){words, strcspn(words, " ")};
}

/* ---- texts ---- */

struct writer writer_begin(uint64_t seed, bool xml, struct buffer *out)
{
    static const unsigned rates[] = {2, 5, 20, 1000};
    struct writer w = {.random = {seed}, .out = out, .xml = xml};
    w.comment_rate = rates[below(&w, 4)];
    return w;
}

unsigned below(struct writer *w, unsigned n)
{
    return random_below(&w->random, n);
}

bool once_in(struct writer *w, unsigned n)
{
    return random_once_in(&w->random, n);
}

static void put_blanks(struct writer *w)
{
    static const char *const blanks[] = {" ",         "  ", "\n",   "\n\n",
                                         " \n\n\n\t", "\t", "\r\n", "\n   "};
    buffer_puts(w->out, blanks[below(w, sizeof blanks / sizeof *blanks)]);
}

static void put_native_comment(struct writer *w, const char *content, unsigned n)
{
    switch (below(w, 3)) {
    case 0:
        buffer_printf(w->out, "//%s %u */\n", content, n);
        break;
    case 1:
        buffer_printf(w->out, "/*%s %u */", content, n);
        break;
    default:
        buffer_printf(w->out, "/*%s %u\n    more \n\n  * and more*/", content, n);
        break;
    }
}

static void put_xml_comment(struct writer *w, const char *content, unsigned n)
{
    if (once_in(w, 3))
        buffer_printf(w->out, "<!--%s %u\n    more */ \n\n  and more-->", content, n);
    else
        buffer_printf(w->out, "<!--%s %u */ -->", content, n);
}

static void put_comment(struct writer *w)
{
    static const char *const contents[] = {"",
                                           " plain",
                                           " dashes - - ",
                                           " xml: x=\"y\"",
                                           " \\xml: a=\"b\"",
                                           " caf\xC3\xA9 \\ ",
                                           " { a: ",
                                           " \" ",
                                           " // /* ",
                                           "\\",
                                           " trailing   ",
                                           " *\\/ -\\- "};
    const char *content = contents[below(w, sizeof contents / sizeof *contents)];
    unsigned n = w->comments++;
    bool note = strstr(content, "x=") || strstr(content, "a=");
    if (w->xml && note)
        buffer_printf(w->out, "<!--%s-->", content);
    else if (note)
        buffer_printf(w->out, "//%s\n", content);
    else if (w->xml)
        put_xml_comment(w, content, n);
    else
        put_native_comment(w, content, n);
}

void put_gap(struct writer *w, bool needed)
{
    bool any = false;
    if (!w->xml && w->out->n && w->out->at[w->out->n - 1] == '/')
        buffer_puts(w->out, " "); /* it would begin a comment with what follows */
    while (once_in(w, w->comment_rate)) {
        if (once_in(w, 2))
            put_blanks(w);
        put_comment(w);
        any = true;
    }
    if ((needed && !any) || once_in(w, 2))
        put_blanks(w);
}

static bool is_bracket(char c)
{
    return strchr("(){}[],;:", c) != NULL;
}

void put_str(struct writer *w, struct str token)
{
    const struct buffer *b = w->out;
    bool loose = b->n && !is_bracket(b->at[b->n - 1]) && !is_bracket(token.at[0]);
    put_gap(w, loose);
    buffer_str(w->out, token);
}

void put(struct writer *w, const char *token)
{
    put_str(w, str_of(token));
}

void put_one_of(struct writer *w, const char *words)
{
    put_str(w, random_word(&w->random, words));
}
