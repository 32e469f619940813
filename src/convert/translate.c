#include "config.h"

#include "convert/translating.h"

#include "base/file.h"
#include "print/printer.h"
#include "syntax/syntax.h"

#include <stdlib.h>

struct str translate_text(const struct translation *t, struct span span)
{
    return srcmap_text(t->sources, span);
}

struct str translate_file(const struct translation *t, struct str name, uint32_t spelt,
                          struct arena *arena)
{
    const struct source *s = srcmap_source(t->sources, spelt);
    char *moved = file_relocate(s ? s->name : t->ast->source->name, t->beside, name.at, name.n);
    if (!moved)
        return name;
    const char *kept = arena_copy(arena, moved, strlen(moved));
    free(moved);
    return str_of(kept);
}

/* The text in canonical layout. */
static bool lay_out(const struct translation *t, const struct buffer *text, struct buffer *out)
{
    struct srcmap sources = {0};
    struct diag diag;
    struct ast ast;
    char *copy = mem_alloc(text->n + 2, 1);
    memcpy(copy, text->at, text->n);
    const struct source *s = srcmap_add(&sources, "", copy, text->n);
    diag_init(&diag, &sources);
    bool right = s && syntax_parse(s, &ast, &diag);
    if (right)
        print_scene(&ast, out);
    else
        diag_report(t->diag, DIAG_NOT_VERIFIED, (struct span){0},
                    "the converted text would not be read: %s",
                    s ? diag.entries.at[0]->message : "it is too large");
    if (s)
        ast_free(&ast);
    diag_free(&diag);
    srcmap_free(&sources);
    return right;
}

bool translate_to_native(const struct translation *t, struct buffer *out)
{
    struct buffer text = {0};
    translate_xml(t, &text);
    bool right = lay_out(t, &text, out);
    buffer_free(&text);
    return right;
}

bool translate_to_xml(const struct translation *t, struct buffer *out)
{
    struct buffer text = {0};
    bool right = translate_description(t, &text) && lay_out(t, &text, out);
    buffer_free(&text);
    return right;
}

bool translate_native_moved(const struct translation *t, struct buffer *out)
{
    struct buffer text = {0};
    translate_files(t, &text);
    bool right = lay_out(t, &text, out);
    buffer_free(&text);
    return right;
}
