#include "config.h"

#include "eval/context.h"

/* What a scene may cost: calls, rounds and items for each object it may have. */
enum { STEPS_AN_OBJECT = 20, STEPS_LEAST = 1000 * 1000 };

/* Values and statements may nest this deep, by whatever mixture of brackets, operators, calls and
 * bodies: bounds the stack. */
enum { DEPTH_LIMIT = 8000 };

/* Bytes of a file's lists and strings at one time. */
#define MEMORY_LIMIT ((size_t)2 << 30)

bool eval_stopped(const struct eval *e)
{
    return e->stopped || diag_full(e->diag);
}

bool eval_spend(struct eval *e, size_t steps, struct span span)
{
    size_t limit = e->options->max_objects < SIZE_MAX / STEPS_AN_OBJECT
                       ? e->options->max_objects * STEPS_AN_OBJECT
                       : SIZE_MAX;
    limit = limit < STEPS_LEAST ? STEPS_LEAST : limit;
    if (e->stopped)
        return false;
    if (steps <= limit - e->steps) {
        e->steps += steps;
        return true;
    }
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_TOO_COSTLY, span,
                    "evaluation was given up after %zu calls, rounds and items", e->steps);
    diag_note(entry, "a greater --max-objects allows more, %d for each object", STEPS_AN_OBJECT);
    e->stopped = e->out->incomplete = true;
    return false;
}

void *eval_alloc(struct eval *e, size_t n, struct span span)
{
    if (n <= MEMORY_LIMIT && e->scratch->bytes <= MEMORY_LIMIT - n)
        return arena_alloc(e->scratch, n);
    diag_report(e->diag, DIAG_TOO_COSTLY, span,
                "the lists and strings at hand take more than %zu MB", MEMORY_LIMIT >> 20);
    e->stopped = e->out->incomplete = true;
    return NULL;
}

bool eval_enter(struct eval *e, struct span span)
{
    if (e->depth++ < DEPTH_LIMIT)
        return true;
    diag_report(e->diag, DIAG_TOO_DEEP, span, "evaluation nested deeper than %d levels",
                DEPTH_LIMIT);
    e->given_up = true;
    return false;
}

void eval_leave(struct eval *e)
{
    e->depth--;
}

/* ---- frames ---- */

void frame_open(struct eval *e, struct frame *f, enum diag_frame_kind kind, struct span at)
{
    *f = (struct frame){.shown = {.parent = e->diag->frame, .at = at, .kind = kind},
                        .outer = e->frame};
    e->frame = f;
    e->diag->frame = &f->shown;
}

void frame_close(struct eval *e, struct frame *f)
{
    e->frame = f->outer;
    e->diag->frame = f->shown.parent;
}

void frame_next(struct frame *f, const struct value *v, uint32_t i)
{
    bool number = v->type == VALUE_NUMBER;
    f->shown.kind = number ? DIAG_FRAME_ROUND : DIAG_FRAME_ITEM;
    f->shown.number = number ? v->number[0] : i;
    f->kept = NULL;
}

static const struct diag_frame *keep(struct eval *e, struct frame *f)
{
    if (!f || f->kept)
        return f ? f->kept : NULL;
    struct diag_frame *copy = arena_alloc(&e->out->arena, sizeof *copy);
    *copy = f->shown;
    copy->parent = keep(e, f->outer);
    return f->kept = copy;
}

const struct diag_frame *frame_keep(struct eval *e)
{
    return keep(e, e->frame);
}

/* ---- a scene ---- */

static void report_unused_define(struct eval *e, struct str name)
{
    struct str_nearest nearest = str_nearest_to(name);
    struct diag_entry *entry =
        diag_report(e->diag, DIAG_UNKNOWN_PARAM, (struct span){0},
                    "-D %.*s: the scene has no param of this name", STR_ARG(name));
    for (const struct binding *b = e->scope->newest; b && scope_may_try(e); b = b->next)
        if (b->param)
            str_nearest_try(&nearest, b->name);
    struct str meant = str_nearest_found(&nearest);
    const struct binding *same = scope_find(e, name);
    if (meant.n)
        diag_note(entry, "did you mean '%.*s'?", STR_ARG(meant));
    else if (same && span_known(same->span))
        diag_label(entry, same->span, "only what 'param' defines may be replaced");
}

static void report_unused_defines(struct eval *e)
{
    for (size_t i = 0; i < e->options->define_count; i++)
        if (!e->define_used[i] && !e->options->defines[i].optional)
            report_unused_define(e, e->options->defines[i].name);
}

bool eval_scene(const struct ast *ast, const struct eval_options *options, struct desc *out,
                struct diag *diag)
{
    *out = (struct desc){.xml = ast->xml, .start = {ast->source->base, ast->source->base}};
    struct eval e = {.options = options, .out = out, .diag = diag};
    size_t errors = diag->errors;
    e.last_place = &e.first_place;
    for (int xml = 0; xml < 2; xml++)
        schema_index_build(&e.index[xml], xml);
    e.define_used = mem_zalloc(options->define_count, sizeof *e.define_used);
    modules_begin(&e, ast->source->name);
    if (ast->xml)
        eval_xml(&e, ast->statements);
    else
        eval_native(&e, ast->statements);
    eval_places(&e);
    report_unused_defines(&e);
    modules_end(&e);
    arena_free(&e.group_arena);
    free(e.define_used);
    map_free(&e.ids);
    vec_free(&e.damaged);
    map_free(&e.missed);
    return diag->errors == errors;
}
