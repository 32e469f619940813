/* A native scene for another folder: the names of files are relative to it, everything else stays
 * as written.
 *
 * A relative name moves by a text before it, so what changes is the string it begins with, wherever
 * that is: where the name is used, or in a variable, argument or function.  What is used tells
 * itself; what evaluation did not use (a branch not taken) is only seen where a file is named. */
#include "config.h"

#include "base/file.h"
#include "convert/comments.h"
#include "convert/translating.h"

#include <stdlib.h>
#include <string.h>

/* What comes into the text somewhere. */
struct insertion {
    uint32_t at;
    const char *before, *after; /* of the way to the old folder, which is not written when NULL */
};

struct mover {
    const struct translation *t;
    struct str way;                       /* from the new folder to the old one */
    VEC(const struct ast_node *) strings; /* of the scene's own text, rising */
    VEC(struct insertion) insertions;
};

static void add_insertion(struct mover *m, uint32_t at, const char *before, const char *after)
{
    vec_push(&m->insertions, (struct insertion){at, before, after});
}

static void move_string(struct mover *m, const struct ast_node *string)
{
    add_insertion(m, string->span.begin + 1, "", "");
}

/* A relative name begins with it. */
static bool begins_relative(struct str text)
{
    return text.n > 0 && text.at[0] != '/';
}

/* ---- where files are named ---- */

/* The strings that the value of a file's name begins with, as far as it spells them itself. */
static void move_value(struct mover *m, const struct ast_node *value)
{
    switch (value->kind) {
    case AST_STRING:
        if (begins_relative(value->text))
            move_string(m, value);
        break;
    case AST_CONDITIONAL:
        move_value(m, value->children->next);
        move_value(m, value->children->next->next);
        break;
    case AST_PARENTHESES:
    case AST_CHAIN:
        move_value(m, value->children);
        break;
    default:
        break;
    }
}

/* An included file that is beside the scene and not in a folder of -I. */
static void move_include(struct mover *m, const struct ast_node *string)
{
    const char *reason;
    char *path = file_resolve(m->t->ast->source->name, string->text.at, string->text.n);
    if (begins_relative(string->text) && file_readable(m->t->sources->fence, path, &reason))
        move_string(m, string);
    free(path);
}

static bool names_file(const struct ast_node *n)
{
    for (int id = 0; id < SCHEMA_PROPS && n->kind == AST_PROPERTY; id++)
        if (schema_props[id].type == TYPE_FILE && str_is(n->name, schema_props[id].native))
            return true;
    return false;
}

static void walk(struct mover *m, const struct ast_node *n)
{
    for (; n; n = n->next) {
        if (n->kind == AST_STRING)
            vec_push(&m->strings, n);
        else if (n->kind == AST_INCLUDE)
            move_include(m, n->children);
        else if (names_file(n) && n->children)
            move_value(m, n->children);
        walk(m, n->children);
    }
}

/* ---- what evaluation found ---- */

static int compare_places(const void *key, const void *element)
{
    const uint32_t *at = key;
    const struct ast_node *const *string = element;
    return (*at > (*string)->span.begin) - (*at < (*string)->span.begin);
}

static bool is_own(const struct mover *m, uint32_t place)
{
    const struct source *s = m->t->ast->source;
    return place >= s->base && place <= s->base + s->n;
}

/* The string that a name begins with, or else the value as a whole. */
static void move_name(struct mover *m, const struct desc_value *v)
{
    const struct ast_node *const *found = NULL;
    if (!begins_relative(v->string) || !is_own(m, v->spelt))
        return;
    if (m->strings.n)
        found =
            bsearch(&v->spelt, m->strings.at, m->strings.n, sizeof *m->strings.at, compare_places);
    struct str text = found ? (*found)->text : (struct str){0};
    if (text.n && text.n <= v->string.n && memcmp(text.at, v->string.at, text.n) == 0) {
        move_string(m, *found);
    } else if (is_own(m, v->span.begin)) {
        add_insertion(m, v->span.begin, "\"", "\" + (");
        add_insertion(m, v->span.end, NULL, ")");
    }
}

static void move_objects(struct mover *m, struct desc_object *const *objects, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        for (const struct desc_prop *p = objects[i]->props; p; p = p->next) {
            if (schema_props[p->id].type == TYPE_FILE)
                move_name(m, &p->value);
            else if (schema_props[p->id].type == TYPE_SURFACE)
                move_objects(m, &p->value.object, 1);
        }
    }
}

/* ---- the text ---- */

static int compare_insertions(const void *a, const void *b)
{
    const struct insertion *x = a, *y = b;
    return (x->at > y->at) - (x->at < y->at);
}

/* Every place once, however often it is used. */
static void write_text(struct mover *m, struct buffer *out)
{
    const struct source *s = m->t->ast->source;
    uint32_t done = s->base;
    if (m->insertions.n)
        qsort(m->insertions.at, m->insertions.n, sizeof *m->insertions.at, compare_insertions);
    for (size_t i = 0; i < m->insertions.n; i++) {
        const struct insertion *in = &m->insertions.at[i];
        if (i > 0 && in->at == in[-1].at)
            continue;
        buffer_add(out, s->text + (done - s->base), in->at - done);
        done = in->at;
        if (in->before) {
            buffer_puts(out, in->before);
            native_escape(m->way, out);
        }
        buffer_puts(out, in->after);
    }
    buffer_add(out, s->text + (done - s->base), s->base + s->n - done);
}

void translate_files(const struct translation *t, struct buffer *out)
{
    const struct desc *d = t->desc;
    const char *folder = t->ast->source->name;
    char *way = file_relocate(folder, t->beside, "", 0);
    struct mover m = {.t = t, .way = str_of(way ? way : "")};
    if (way) {
        walk(&m, t->ast->statements);
        move_objects(&m, d->textures.at, d->textures.n);
        move_objects(&m, d->surfaces.at, d->surfaces.n);
        move_objects(&m, d->lights.at, d->lights.n);
    }
    write_text(&m, out);
    vec_free(&m.strings);
    vec_free(&m.insertions);
    free(way);
}
