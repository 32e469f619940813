/* Names: scopes inside scopes. */
#include "config.h"

#include "eval/context.h"

/* A scope of more names is looked up by a map. */
enum { FEW = 8 };

void scope_open(struct eval *e, struct scope *s, struct scope *parent)
{
    *s = (struct scope){.parent = parent};
    e->scope = s;
}

void scope_close(struct eval *e, struct scope *outer)
{
    map_free(&e->scope->map);
    e->scope = outer;
}

static struct binding *find_in(const struct scope *s, struct str name)
{
    if (s->n > FEW)
        return map_get(&s->map, name);
    for (struct binding *b = s->newest; b; b = b->next)
        if (str_equal(b->name, name))
            return b;
    return NULL;
}

struct binding *scope_find(const struct eval *e, struct str name)
{
    for (const struct scope *s = e->scope; s; s = s->parent) {
        struct binding *b = find_in(s, name);
        if (b)
            return b;
    }
    return NULL;
}

static bool is_name_byte(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/* A long text counts as one that may hold any name. */
static bool holds_name(struct str text, struct str name)
{
    enum { LONG = 10000 };
    if (text.n > LONG)
        return true;
    for (size_t i = 0; i + name.n <= text.n; i++) {
        bool starts = i == 0 || !is_name_byte(text.at[i - 1]);
        bool ends = i + name.n == text.n || !is_name_byte(text.at[i + name.n]);
        if (starts && ends && memcmp(text.at + i, name.at, name.n) == 0)
            return true;
    }
    return false;
}

bool scope_told(struct eval *e, struct str name, struct span at)
{
    enum { MOST = 20 }; /* as many damaged texts are searched */
    for (size_t i = 0; i < e->damaged.n && i < MOST; i++)
        if (holds_name(srcmap_text(e->diag->sources, e->damaged.at[i]), name))
            return true;
    uintptr_t first = (uintptr_t)map_get(&e->missed, name);
    if (!first)
        map_set(&e->missed, name, (void *)(uintptr_t)at.begin);
    return first && first != at.begin;
}

bool scope_lost(struct eval *e, struct str name, struct span at)
{
    return e->names_lost || scope_told(e, name, at);
}

void scope_add(struct scope *s, struct binding *b)
{
    b->next = s->newest;
    s->newest = b;
    s->n++;
    if (s->n == FEW + 1)
        for (struct binding *each = b; each; each = each->next)
            map_set(&s->map, each->name, each);
    else if (s->n > FEW)
        map_set(&s->map, b->name, b);
}

static void report_duplicate(struct eval *e, struct str name, struct span span,
                             const struct binding *old)
{
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_DUPLICATE_NAME, span, "'%.*s' is defined twice", STR_ARG(name));
    diag_label(entry, old->span, "first defined here");
}

struct binding *scope_bind(struct eval *e, struct str name, struct span span,
                           enum binding_kind kind)
{
    const struct binding *old = find_in(e->scope, name);
    if (old) {
        report_duplicate(e, name, span, old);
        return NULL;
    }
    struct binding *b = arena_zalloc(e->scratch, 1, sizeof *b);
    b->name = name;
    b->span = span;
    b->kind = kind;
    scope_add(e->scope, b);
    return b;
}

/* A file that two others include gives both the same names. */
void scope_import(struct eval *e, const struct scope *from, struct span span)
{
    for (const struct binding *b = from->newest; b; b = b->next) {
        const struct binding *old = find_in(e->scope, b->name);
        if (old && old->span.begin == b->span.begin)
            continue;
        if (old) {
            struct diag_entry *entry =
                diag_report(e->diag, DIAG_DUPLICATE_NAME, span,
                            "the file defines '%.*s', which is defined already", STR_ARG(b->name));
            diag_label(entry, old->span, "first defined here");
            diag_label(entry, b->span, "then here");
            continue;
        }
        struct binding *copy = arena_alloc(e->scratch, sizeof *copy);
        *copy = *b;
        scope_add(e->scope, copy);
    }
}

/* Keeps thousands of unknown names among as many from taking minutes. */
enum { TRIES_LIMIT = 1000 * 1000 };

bool scope_may_try(struct eval *e)
{
    return e->names_tried++ < TRIES_LIMIT;
}

void scope_try_names(struct eval *e, struct str_nearest *nearest, unsigned binding_kinds)
{
    for (const struct scope *s = e->scope; s; s = s->parent)
        for (const struct binding *b = s->newest; b && scope_may_try(e); b = b->next)
            if (binding_kinds >> b->kind & 1)
                str_nearest_try(nearest, b->name);
}

void map_try_names(struct eval *e, const struct map *m, struct str_nearest *nearest)
{
    e->names_tried += m->capacity;
    for (size_t i = 0; i < m->capacity && e->names_tried <= TRIES_LIMIT; i++)
        if (m->slots[i].value)
            str_nearest_try(nearest, m->slots[i].key);
}
