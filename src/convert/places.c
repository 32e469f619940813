#include "config.h"

#include "convert/places.h"

#include <stdlib.h>

static void add_note(struct places *p, size_t i)
{
    struct note note;
    const struct trivia *c = &p->ast->trivia.at[i];
    if (!note_read(p->ast, c, &note))
        return;
    bool end = str_is(note.name, "end");
    if (!end && !str_is(note.name, "section"))
        return;
    if (end)
        p->foot = p->stops.n;
    p->comments[i].done = true;
    vec_push(&p->stops, (struct stop){.begin = c->span.begin,
                                      .end = c->span.end,
                                      .produces = !end,
                                      .section = note.value});
}

/* Statements and notes between them, in the order of the file. */
static void find_stops(struct places *p, const uint32_t *producing, size_t n)
{
    size_t i = 0;
    for (const struct ast_node *s = p->ast->statements; s; s = s->next) {
        for (; i < p->ast->trivia.n && p->ast->trivia.at[i].span.begin < s->span.begin; i++)
            add_note(p, i);
        while (i < p->ast->trivia.n && p->ast->trivia.at[i].span.begin < s->span.end)
            i++;
        while (n && *producing < s->span.begin) {
            producing++;
            n--;
        }
        bool produces = n && *producing < s->span.end;
        vec_push(&p->stops,
                 (struct stop){.begin = s->span.begin, .end = s->span.end, .produces = produces});
    }
    for (; i < p->ast->trivia.n; i++)
        add_note(p, i);
    size_t next = SIZE_MAX;
    for (size_t k = p->stops.n; k > 0; k--) {
        next = p->stops.at[k - 1].produces ? k - 1 : next;
        p->stops.at[k - 1].next = next;
    }
}

/* Where what is set apart before stop k goes. */
static struct place apart(const struct places *p, size_t k)
{
    if (k == 0 && p->stops.n && p->ast->statements && p->ast->statements->kind == AST_VERSION)
        return (struct place){.kind = PLACE_HEAD};
    if (k > p->foot && p->foot != SIZE_MAX)
        return (struct place){.kind = PLACE_FOOT};
    size_t next = k < p->stops.n ? p->stops.at[k].next : SIZE_MAX;
    return next == SIZE_MAX ? (struct place){.kind = PLACE_TAIL}
                            : (struct place){.kind = PLACE_SECTION, .owner = next};
}

/* Where a group of comments in the gap before stop k goes, by what it touches. */
static struct place place_of_group(const struct places *p, size_t k, bool touches_before,
                                   bool touches_behind)
{
    const struct stop *before = k > 0 ? &p->stops.at[k - 1] : NULL;
    struct place set_apart = apart(p, k);
    if (set_apart.kind == PLACE_HEAD)
        return set_apart;
    if (touches_behind && p->stops.at[k].produces)
        return (struct place){.kind = PLACE_BEFORE, .owner = k};
    if (touches_before && before && before->produces && !before->section.n)
        return (struct place){.kind = PLACE_AFTER, .owner = k - 1};
    return set_apart;
}

static void set_places(struct places *p, size_t first, size_t last, struct place place)
{
    for (; first < last; first++) {
        place.done = p->comments[first].done;
        p->comments[first] = place;
    }
}

static bool line_ends_between(const struct ast *ast, uint32_t begin, uint32_t end)
{
    return memchr(ast->source->text + (begin - ast->source->base), '\n', end - begin) != NULL;
}

/* The comments from `first` on that end the line on which stop k - 1 ends. */
static size_t behind(const struct places *p, size_t k, size_t first, size_t last, uint32_t end)
{
    const struct trivia *c = p->ast->trivia.at;
    uint32_t from = p->stops.at[k - 1].end;
    size_t i = first;
    for (; i < last && !line_ends_between(p->ast, from, c[i].span.begin); i++)
        from = c[i].span.end;
    bool ends_line = i < last || line_ends_between(p->ast, from, end) || k == p->stops.n;
    return ends_line ? i : first;
}

/* The comments before stop k, from the end of the one before. */
static void place_gap(struct places *p, size_t k)
{
    const struct trivia *c = p->ast->trivia.at;
    uint32_t text_end = p->ast->source->base + p->ast->source->n;
    uint32_t end = k < p->stops.n ? p->stops.at[k].begin : text_end;
    size_t group = k > 0 ? gap_at(p->ast, p->stops.at[k - 1].end).comment : 0;
    size_t last = gap_at(p->ast, end).comment,
           line = k > 0 ? behind(p, k, group, last, end) : group;
    bool touches = true;
    if (group == last)
        return;
    if (line > group)
        set_places(p, group, line,
                   p->stops.at[k - 1].produces && !p->stops.at[k - 1].section.n
                       ? (struct place){.kind = PLACE_BEHIND, .owner = k - 1}
                       : place_of_group(p, k, false, false));
    group = line;
    for (size_t i = group; i < last; i++) {
        if (!gap_blank_before(p->ast, c[i].span.begin))
            continue;
        set_places(p, group, i, place_of_group(p, k, touches, false));
        group = i;
        touches = false;
    }
    bool touches_behind = k < p->stops.n && !gap_blank_before(p->ast, end);
    set_places(p, group, last, place_of_group(p, k, touches, touches_behind));
}

/* The comments of a stop lie between the producing ones around it. */
static void find_runs(struct places *p)
{
    size_t first = 0, last = p->ast->trivia.n;
    for (size_t k = 0; k < p->stops.n; k++) {
        p->stops.at[k].first = first;
        if (p->stops.at[k].produces)
            first = gap_at(p->ast, p->stops.at[k].end).comment;
    }
    for (size_t k = p->stops.n; k > 0; k--) {
        p->stops.at[k - 1].last = last;
        if (p->stops.at[k - 1].produces)
            last = gap_at(p->ast, p->stops.at[k - 1].begin).comment;
    }
}

void places_find(struct places *p, const struct ast *ast, const uint32_t *producing, size_t n)
{
    *p = (struct places){
        .ast = ast, .foot = SIZE_MAX, .comments = mem_zalloc(ast->trivia.n, sizeof *p->comments)};
    find_stops(p, producing, n);
    for (size_t k = 0; k <= p->stops.n; k++)
        place_gap(p, k);
    find_runs(p);
}

size_t places_stop(const struct places *p, uint32_t offset)
{
    size_t first = 0, last = p->stops.n; /* the first that begins behind the offset */
    while (first < last) {
        size_t middle = first + (last - first) / 2;
        if (p->stops.at[middle].begin <= offset)
            first = middle + 1;
        else
            last = middle;
    }
    return first > 0 ? first - 1 : 0;
}

void places_free(struct places *p)
{
    vec_free(&p->stops);
    free(p->comments);
}
