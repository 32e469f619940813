#include "config.h"

#include "load.h"

#include "eval/eval.h"
#include "syntax/syntax.h"
#include "validate/validate.h"

#include <stdio.h>
#include <string.h>

void load_text(struct load *l, const char *name, const char *text)
{
    size_t n = strlen(text);
    *l = (struct load){0};
    srcmap_add(&l->sources, "before", mem_zalloc(10 + 2, 1), 10);
    char *copy = mem_alloc(n + 2, 1);
    memcpy(copy, text, n);
    l->source = srcmap_add(&l->sources, name, copy, n);
    diag_init(&l->diag, &l->sources);
}

static bool parse(struct load *l)
{
    return syntax_parse(l->source, &l->ast, &l->diag);
}

static bool eval(struct load *l)
{
    struct eval_options options = {.max_objects = 10 * 1000 * 1000, .sources = &l->sources};
    return parse(l) && eval_scene(&l->ast, &options, &l->desc, &l->diag);
}

static bool validate(struct load *l)
{
    return eval(l) && validate_scene(&l->desc, &l->diag);
}

bool load_parse(struct load *l, const char *text)
{
    load_text(l, "scene", text);
    return parse(l);
}

bool load_eval(struct load *l, const char *text)
{
    load_text(l, "scene", text);
    return eval(l);
}

bool load_validate(struct load *l, const char *text)
{
    load_text(l, "scene", text);
    return validate(l);
}

bool load_lower(struct load *l, const char *name, const char *text)
{
    load_text(l, name, text);
    return validate(l) && lower_scene(&l->desc, &l->sources, &l->lowered, &l->diag);
}

bool load_lower_placed(struct load *l, const char *name, const char *text,
                       const struct affine *place)
{
    load_text(l, name, text);
    if (!validate(l))
        return false;
    for (size_t i = 0; i < l->desc.surfaces.n; i++)
        l->desc.surfaces.at[i]->place = place;
    for (size_t i = 0; i < l->desc.lights.n; i++)
        l->desc.lights.at[i]->place = place;
    return lower_scene(&l->desc, &l->sources, &l->lowered, &l->diag);
}

void load_free(struct load *l)
{
    lower_free(&l->lowered);
    desc_free(&l->desc);
    ast_free(&l->ast);
    diag_free(&l->diag);
    srcmap_free(&l->sources);
}

const char *load_first(const struct load *l)
{
    return l->diag.entries.n ? l->diag.entries.at[0]->message : "";
}

void load_findings(struct load *l, char *out, size_t room)
{
    out[0] = 0;
    diag_sort(&l->diag);
    for (size_t i = 0, n = 0; i < l->diag.entries.n; i++, n = strlen(out)) {
        const struct diag_entry *e = l->diag.entries.at[i];
        struct str at = srcmap_text(&l->sources, e->span);
        snprintf(out + n, room - n, "%s:%.*s|", diag_rules[e->code].code, STR_ARG(at));
    }
}
