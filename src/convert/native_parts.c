#include "config.h"

#include "convert/to_native.h"

/* ---- elements ---- */

bool element_is(const struct ast_node *n)
{
    return n->kind == AST_BLOCK || n->kind == AST_PROPERTY;
}

struct str element_attribute(const struct ast_node *n, const char *name)
{
    for (const struct ast_node *a = n->children; a; a = a->next)
        if (a->kind == AST_ATTRIBUTE && str_is(a->name, name))
            return str_trim(a->children->text);
    return (struct str){0};
}

const struct ast_node *native_section(const struct native_writer *w, const char *name)
{
    for (const struct ast_node *c = w->ast->statements->children; c; c = c->next)
        if (element_is(c) && str_is(c->name, name))
            return c;
    return NULL;
}

void native_members(const struct native_writer *w, const struct ast_node *element,
                    struct members *out)
{
    struct gap_unit u;
    struct gap g = gap_at(w->ast, gap_content(w->ast, element));
    *out = (struct members){0};
    for (const struct ast_node *c = element->children;; c = c->next) {
        if (c && !element_is(c))
            continue;
        struct member *last = out->v.n ? &out->v.at[out->v.n - 1] : NULL;
        struct member next = {.node = c};
        while (g.at < element->span.end && gap_next(&g, &u)) { /* `<lights/>` has no inside */
            bool behind = last && u.ends_line && u.newlines == 0 && next.leads == 0;
            size_t *first = behind ? &last->behind : &next.lead;
            size_t *n = behind ? &last->behinds : &next.leads;
            *first = *n ? *first : u.first;
            *n += u.n;
        }
        if (!c) {
            out->tail = next.lead;
            out->tails = next.leads;
            return;
        }
        vec_push(&out->v, next);
        gap_move(&g, c->span.end);
    }
}

/* ---- comments ---- */

void native_put(struct native_writer *w, const char *text)
{
    buffer_puts(w->out, text);
}

static void put_comment(struct native_writer *w, size_t i, enum comment_place place)
{
    const struct trivia *c = &w->ast->trivia.at[i];
    if (c->kind != TRIVIA_PI) {
        comment_to_native(w->ast, c, place, w->out);
        return;
    }
    struct str text = translate_text(w->t, c->span);
    if (!str_begins(text, "<?xml") || !memchr(" \t\r\n", text.at[5], 4))
        diag_report(w->t->diag, DIAG_DROPPED, c->span,
                    "the native language has no processing instructions, so this one is left out");
}

void native_put_comments(struct native_writer *w, size_t first, size_t n, enum comment_place place)
{
    for (size_t i = first; i < first + n; i++)
        put_comment(w, i, place);
}

void native_put_lead(struct native_writer *w, const struct member *m, bool blanks)
{
    for (size_t i = m->lead; i < m->lead + m->leads; i++) {
        begin_line(w->out, blanks && gap_blank_before(w->ast, w->ast->trivia.at[i].span.begin));
        put_comment(w, i, COMMENT_OWN_LINE);
    }
    begin_line(w->out, blanks && gap_blank_before(w->ast, m->node->span.begin));
}

void native_put_behind(struct native_writer *w, const struct member *m)
{
    for (size_t i = 0; i < m->behinds; i++)
        put_comment(w, m->behind + i, i + 1 < m->behinds ? COMMENT_BEHIND_MORE : COMMENT_BEHIND);
}

void native_put_inside(struct native_writer *w, const struct ast_node *n)
{
    for (size_t i = gap_at(w->ast, n->span.begin).comment;
         i < w->ast->trivia.n && w->ast->trivia.at[i].span.begin < n->span.end; i++)
        put_comment(w, i, COMMENT_INSIDE);
}

void native_put_note(struct native_writer *w, const char *name, struct str value)
{
    native_put(w, " ");
    note_write(name, value, COMMENT_INSIDE, w->out);
}
