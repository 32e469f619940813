#include "config.h"

#include "convert/to_xml.h"

/* ---- the tree ---- */

void xml_index_nodes(struct xml_writer *w, const struct ast_node *n)
{
    for (; n; n = n->next) {
        bool looked_up =
            n->kind == AST_BLOCK || n->kind == AST_CONSTRUCT || n->kind == AST_PROPERTY;
        if (looked_up)
            vec_push(&w->nodes, (struct entry){n->span.begin, n});
        xml_index_nodes(w, n->children);
    }
}

const struct ast_node *xml_node_at(const struct xml_writer *w, struct span span)
{
    size_t first = 0, last = w->nodes.n;
    while (first < last) {
        size_t middle = first + (last - first) / 2;
        if (w->nodes.at[middle].begin < span.begin)
            first = middle + 1;
        else
            last = middle;
    }
    bool found = first < w->nodes.n && w->nodes.at[first].begin == span.begin;
    return found ? w->nodes.at[first].node : NULL;
}

const struct ast_node *xml_property_at(const struct xml_writer *w, const struct desc_prop *p)
{
    const struct ast_node *n = p->inherited ? NULL : xml_node_at(w, p->name_span);
    return n && n->kind == AST_PROPERTY ? n : NULL;
}

bool xml_is_own(const struct xml_writer *w, uint32_t offset)
{
    const struct source *s = w->ast->source;
    return offset >= s->base && offset <= s->base + s->n;
}

/* ---- comments ---- */

void xml_put(struct xml_writer *w, const char *text)
{
    buffer_puts(w->out, text);
}

void xml_put_comment(struct xml_writer *w, size_t i, enum comment_place place)
{
    if (w->places.comments[i].done)
        return;
    w->places.comments[i].done = true;
    comment_to_xml(w->ast, &w->ast->trivia.at[i], place, w->out);
}

void xml_put_between(struct xml_writer *w, uint32_t begin, uint32_t end, enum comment_place place)
{
    for (size_t i = gap_at(w->ast, begin).comment;
         i < w->ast->trivia.n && w->ast->trivia.at[i].span.begin < end; i++)
        xml_put_comment(w, i, place);
}

void xml_put_behind(struct xml_writer *w, uint32_t end)
{
    struct gap g = gap_at(w->ast, end);
    struct gap_unit u;
    g.separators = ",;";
    if (gap_next(&g, &u) && u.newlines == 0 && u.ends_line)
        xml_put_between(w, end, w->ast->trivia.at[u.first + u.n - 1].span.end, COMMENT_BEHIND);
}

void xml_put_lead(struct xml_writer *w, uint32_t begin)
{
    size_t last = gap_at(w->ast, begin).comment, first = last;
    uint32_t at = begin;
    const char *text = w->ast->source->text;
    for (;;) {
        while (memchr(" \t\r\n,;", text[at - 1 - w->ast->source->base], 6))
            at--;
        if (first == 0 || w->ast->trivia.at[first - 1].span.end != at)
            break;
        at = w->ast->trivia.at[--first].span.begin;
    }
    for (; first < last; first++) {
        begin_line(w->out, gap_blank_before(w->ast, w->ast->trivia.at[first].span.begin));
        xml_put_comment(w, first, COMMENT_OWN_LINE);
    }
    begin_line(w->out, gap_blank_before(w->ast, begin));
}

struct str xml_take_note(struct xml_writer *w, uint32_t begin, uint32_t end, const char *name)
{
    for (size_t i = gap_at(w->ast, begin).comment;
         i < w->ast->trivia.n && w->ast->trivia.at[i].span.begin < end; i++) {
        struct note note;
        if (!note_read(w->ast, &w->ast->trivia.at[i], &note) || !str_is(note.name, name))
            continue;
        w->places.comments[i].done = true;
        return note.value;
    }
    return (struct str){0};
}

uint32_t xml_next_token(const struct xml_writer *w, uint32_t at)
{
    struct gap g = gap_at(w->ast, at);
    struct gap_unit u;
    while (gap_next(&g, &u))
        ;
    return g.at;
}
