#include "config.h"

#include "events.h"

#include "base/vec.h"
#include "convert/comments.h"

#include <stdlib.h>

/* The words of a text with single spaces between them. */
static void put_words(struct str text, struct buffer *out)
{
    bool space = false;
    text = str_trim(text);
    for (size_t i = 0; i < text.n; i++) {
        bool blank = strchr(" \t\r\n", text.at[i]) != NULL;
        if (!blank && space)
            buffer_puts(out, " ");
        if (!blank)
            buffer_add(out, text.at + i, 1);
        space = blank;
    }
}

static struct str text_of(const struct ast *ast, struct span span)
{
    return (struct str){ast->source->text + (span.begin - ast->source->base),
                        span.end - span.begin};
}

/* ---- elements ---- */

struct events {
    const struct ast *ast;
    size_t comment; /* the next one */
    struct buffer *out;
};

static void put_comments(struct events *e, uint32_t end)
{
    for (; e->comment < e->ast->trivia.n; e->comment++) {
        const struct trivia *c = &e->ast->trivia.at[e->comment];
        if (c->span.begin >= end)
            return;
        if (c->kind == TRIVIA_PI)
            continue;
        struct str text = text_of(e->ast, c->span);
        buffer_puts(e->out, "#");
        put_words((struct str){text.at + 4, text.n - 7}, e->out);
        buffer_puts(e->out, "\n");
    }
}

static void put_attributes(struct events *e, const struct ast_node *n)
{
    static const char *const names[] = {"model", "class", "id", "ref"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        for (const struct ast_node *a = n->children; a; a = a->next) {
            if (a->kind != AST_ATTRIBUTE || !str_is(a->name, names[i]))
                continue;
            buffer_printf(e->out, " %s=", names[i]);
            put_words(a->children->text, e->out);
        }
}

static void put_element(struct events *e, const struct ast_node *n)
{
    put_comments(e, n->span.begin);
    buffer_printf(e->out, "<%.*s", STR_ARG(n->name));
    put_attributes(e, n);
    buffer_puts(e->out, ">\n");
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (c->kind == AST_BLOCK || c->kind == AST_PROPERTY)
            put_element(e, c);
    put_comments(e, n->span.end);
    for (const struct ast_node *c = n->children; c; c = c->next)
        if (c->kind == AST_TEXT && c->text.n)
            put_words(c->text, e->out);
    buffer_puts(e->out, "\n>\n");
}

void xml_events(const struct ast *ast, struct buffer *out)
{
    struct events e = {.ast = ast, .out = out};
    put_element(&e, ast->statements);
    put_comments(&e, UINT32_MAX);
}

/* ---- comments alone ---- */

static int compare(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

void comment_events(const struct ast *ast, struct buffer *out)
{
    VEC(char *) all = {0};
    for (size_t i = 0; i < ast->trivia.n; i++) {
        struct buffer xml = {0}, words = {0};
        if (ast->xml)
            buffer_str(&xml, text_of(ast, ast->trivia.at[i].span));
        else
            comment_to_xml(ast, &ast->trivia.at[i], COMMENT_OWN_LINE, &xml);
        struct str text = str_trim((struct str){xml.at, xml.n});
        put_words((struct str){text.at + 4, text.n - 7}, &words);
        buffer_add(&words, "", 1);
        vec_push(&all, words.at);
        buffer_free(&xml);
    }
    if (all.n)
        qsort(all.at, all.n, sizeof *all.at, compare);
    for (size_t i = 0; i < all.n; i++) {
        buffer_printf(out, "#%s\n", all.at[i]);
        free(all.at[i]);
    }
    vec_free(&all);
}
