#include "config.h"

#include "cmd/frontend.h"

#include "base/buffer.h"
#include "base/file.h"
#include "base/thread.h"
#include "eval/eval.h"
#include "farm/tilefile.h"
#include "image/picture.h"
#include "lint/explain.h"
#include "lower/lower.h"
#include "print/printer.h"
#include "scene/mesh.h"
#include "syntax/syntax.h"
#include "validate/validate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *display_name(const char *path)
{
    return strcmp(path, "-") == 0 ? "<stdin>" : path;
}

void frontend_init(struct frontend *f, const struct options *o)
{
    *f = (struct frontend){0};
    diag_init(&f->diag, &f->sources);
    f->diag.policy = &o->policy;
    f->sources.fence = o->fence;
}

const struct source *frontend_read(struct frontend *f, const char *path)
{
    char *text;
    size_t n;
    const char *reason = file_read_within(f->sources.fence, path, &text, &n);
    const struct source *s = reason ? NULL : srcmap_add(&f->sources, display_name(path), text, n);
    if (!s)
        diag_report(&f->diag, DIAG_CANNOT_READ, (struct span){0}, "could not read '%s': %s",
                    display_name(path), reason ? reason : "it is too large");
    return s;
}

/* The value of a -D as a source of its own; its name starts with `<`, as it is no file. */
static const struct source *add_define(struct frontend *f, struct str name, const char *value)
{
    size_t n = strlen(value);
    char *copy = mem_alloc(n + 2, 1);
    struct buffer title = {0};
    memcpy(copy, value, n);
    buffer_printf(&title, "<-D %.*s>%c", STR_ARG(name), 0);
    const struct source *s = srcmap_add(&f->sources, title.at, copy, n);
    if (!s)
        mem_exhausted(n);
    buffer_free(&title);
    return s;
}

/* Each -D as an expression. */
static struct eval_define *parse_defines(struct frontend *f, const struct options *o)
{
    struct eval_define *defines = mem_zalloc(o->defines.n, sizeof *defines);
    vec_reserve(&f->defines, o->defines.n); /* nodes are pointed to */
    for (size_t i = 0; i < o->defines.n; i++) {
        const char *text = o->defines.at[i], *value = strchr(text, '=') + 1;
        struct str name = {text, (size_t)(value - 1 - text)};
        struct ast ast;
        syntax_parse_value(&f->sources, add_define(f, name, value), &ast);
        vec_push(&f->defines, ast);
        defines[i] =
            (struct eval_define){name, ast.statements, i + o->optional_defines >= o->defines.n};
    }
    return defines;
}

/* XML that is no tree would only yield consequential errors; a native text with a mistake still
 * shows most of its statements. */
static bool may_evaluate(const struct frontend *f, bool parsed)
{
    return parsed || (!f->ast.xml && f->ast.statements);
}

/* The rays that a pixel takes at least: one for each sample, and from there to each light's points;
 * *place is of what makes most of them. */
static double rays_a_pixel(const struct desc *d, const struct options *o, struct span *place)
{
    const struct desc_value *samples = d->settings ? desc_get(d->settings, PROP_SAMPLES) : NULL;
    bool asked = o->grid || o->adaptive > 0 || !samples;
    double side = o->grid ? o->grid : asked ? 1 : samples->number[0];
    double most = asked ? 1 : side, points = 0;
    *place = asked ? (struct span){0} : samples->span;
    for (size_t i = 0; i < d->lights.n; i++) {
        const struct desc_value *v = desc_get(d->lights.at[i], PROP_LIGHT_SAMPLES);
        double across = v ? fmax(v->number[0], 1) : 1;
        points += across * across;
        if (across > most) {
            most = across;
            *place = v->span;
        }
    }
    return side * side * (1 + points);
}

/* What a service may not want to spend on a scene; what the user asks for is known beforehand. */
static void check_limits(struct frontend *f, const struct options *o)
{
    const struct desc_object *settings = f->desc.settings;
    const struct desc_value *size =
        f->desc.camera ? desc_get(f->desc.camera, PROP_RESOLUTION) : NULL;
    if (size && !o->width && size->number[0] * size->number[1] > o->max_pixels)
        diag_report(&f->diag, DIAG_SCENE_TOO_LARGE, size->span,
                    "the picture has %.0f pixels, more than --max-pixels allows (%u)",
                    size->number[0] * size->number[1], o->max_pixels);
    if (size && o->depth == DEPTH_OF_SCENE && lower_depth(&f->desc) > o->max_depth)
        diag_report(&f->diag, DIAG_OUT_OF_RANGE,
                    settings && desc_get(settings, PROP_DEPTH)
                        ? desc_get(settings, PROP_DEPTH)->span
                        : (struct span){0},
                    "rays are followed deeper than --max-depth allows (%u)", o->max_depth);
    struct span place;
    double rays = rays_a_pixel(&f->desc, o, &place);
    if (rays > (double)o->max_rays)
        diag_report(&f->diag, DIAG_SCENE_TOO_LARGE, place,
                    "samples and lights take %.4g rays for each pixel, more than --max-rays allows "
                    "(%llu)",
                    rays, (unsigned long long)o->max_rays);
}

/* After syntax errors nothing is said to be missing: it may stand where the text did not parse. */
static void evaluate(struct frontend *f, const struct options *o, bool parsed)
{
    struct eval_define *defines = parse_defines(f, o);
    struct eval_options options = {
        .defines = defines,
        .define_count = o->defines.n,
        .max_objects = o->max_objects,
        .sources = &f->sources,
        .folders = o->folders.at,
        .folder_count = o->folders.n,
    };
    eval_scene(&f->ast, &options, &f->desc, &f->diag);
    if (o->policy.lint && desc_is_part(&f->desc, &f->ast))
        f->desc.incomplete = true;
    if (parsed || f->desc.camera)
        validate_scene(&f->desc, &f->diag);
    if (f->diag.errors == 0)
        check_limits(f, o);
    free(defines);
}

/* What a file is that is no scene, and what can be done with it; NULL: nothing speaks against its
 * being one. */
static const char *other_use(const char *path, char *bytes, size_t n)
{
    if (tilefile_recognised(bytes, n))
        return "holds tiles of a picture and no scene; 'wrt merge' makes the picture";
    if (picture_recognised(bytes, n))
        return "is a picture and no scene; 'wrt diff' compares pictures";
    if (mesh_recognised(path, bytes, n))
        return "is a mesh and no scene; 'mesh { file: \"...\"  material: ... }' in a scene shows "
               "it";
    return NULL;
}

/* The bytes as a scene; takes them. */
static const struct source *take_bytes(struct frontend *f, const char *path, char *bytes, size_t n)
{
    const char *other = other_use(path, bytes, n);
    if (!other)
        return syntax_take(&f->sources, path, bytes, n, DIAG_CANNOT_READ, (struct span){0},
                           &f->diag);
    diag_report(&f->diag, DIAG_NOT_TEXT, (struct span){0}, "'%s' %s", display_name(path), other);
    free(bytes);
    return NULL;
}

static void report_unread(struct frontend *f, const char *path, const struct options *o,
                          const char *reason)
{
    struct diag_entry *e = diag_report(&f->diag, DIAG_CANNOT_READ, (struct span){0},
                                       "could not read '%s': %s", display_name(path), reason);
    char *near = file_nearest(o->fence, path);
    if (near)
        diag_note(e, "did you mean '%s'?", near);
    free(near);
}

bool frontend_parse(struct frontend *f, const char *path, const struct options *o)
{
    frontend_init(f, o);
    char *bytes;
    size_t n;
    const char *reason = file_read_within(o->fence, path, &bytes, &n);
    if (reason)
        report_unread(f, path, o, reason);
    const struct source *s = reason ? NULL : take_bytes(f, path, bytes, n);
    return s && syntax_parse(s, &f->ast, &f->diag);
}

static const struct source *add_text(struct frontend *f, const char *name, struct str text)
{
    char *copy = mem_alloc(text.n + 2, 1);
    if (text.n)
        memcpy(copy, text.at, text.n);
    return srcmap_add(&f->sources, name, copy, text.n);
}

bool frontend_load_text(struct frontend *f, const char *path, struct str text,
                        const struct options *o)
{
    frontend_init(f, o);
    const struct source *s = add_text(f, path, text);
    if (!s)
        diag_report(&f->diag, DIAG_CANNOT_READ, (struct span){0}, "the result is too large");
    bool parsed = s && syntax_parse(s, &f->ast, &f->diag);
    if (may_evaluate(f, parsed))
        evaluate(f, o, parsed);
    return f->diag.errors == 0;
}

bool frontend_load_bytes(struct frontend *f, const char *path, char *bytes, size_t n,
                         const struct options *o)
{
    frontend_init(f, o);
    const struct source *s = take_bytes(f, path, bytes, n);
    bool parsed = s && syntax_parse(s, &f->ast, &f->diag);
    if (may_evaluate(f, parsed))
        evaluate(f, o, parsed);
    return f->diag.errors == 0;
}

bool frontend_lay_out(struct str text, struct buffer *out)
{
    struct options none = {0};
    struct frontend f;
    frontend_init(&f, &none);
    const struct source *s = add_text(&f, "", text);
    bool parsed = s && syntax_parse(s, &f.ast, &f.diag);
    if (parsed)
        print_scene(&f.ast, out);
    frontend_free(&f);
    return parsed;
}

bool frontend_load(struct frontend *f, const char *path, const struct options *o)
{
    double start = thread_seconds();
    bool parsed = frontend_parse(f, path, o);
    if (may_evaluate(f, parsed))
        evaluate(f, o, parsed);
    f->seconds = thread_seconds() - start;
    return f->diag.errors == 0;
}

void frontend_free(struct frontend *f)
{
    desc_free(&f->desc);
    ast_free(&f->ast);
    for (size_t i = 0; i < f->defines.n; i++)
        ast_free(&f->defines.at[i]);
    vec_free(&f->defines);
    diag_free(&f->diag);
    srcmap_free(&f->sources);
}

int status_worse(int a, int b)
{
    return a == DIAG_EXIT_INPUT || b == DIAG_EXIT_INPUT ? DIAG_EXIT_INPUT : a > b ? a : b;
}

int frontend_report(struct frontend *f, const struct options *o, enum diag_level least)
{
    bool text = o->format == DIAG_FORMAT_TEXT;
    const char *no_color = getenv("NO_COLOR");
    static const struct diag_book book = {explain_why, explain_code};
    struct diag_print_options print = {
        .format = o->format,
        .book = &book,
        .printed = o->printed,
        .colour = text && isatty(STDERR_FILENO) && !(no_color && *no_color),
        .least = least,
        .begun = o->current > 0,
        .goes_on = o->current + 1 < o->scenes.n,
    };
    diag_print(&f->diag, &print, text ? stderr : stdout);
    return (int)f->diag.exit;
}
