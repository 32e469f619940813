#include "config.h"

#include "cmd/commands.h"
#include "cmd/frontend.h"

#include "base/file.h"
#include "convert/bake.h"
#include "convert/compare.h"
#include "convert/export.h"
#include "convert/translate.h"
#include "lower/lower.h"
#include "print/printer.h"

#include <string.h>

struct conversion {
    const struct options *options;
    const struct format *format;
    const char *input, *output;
    const char *beside; /* files named in a scene written are looked up beside this path */
    struct frontend frontend;
    struct arena arena;
    struct desc desc;       /* what a scene written says; borrows from the frontend's */
    struct lowered lowered; /* when a writer or the verification wants it */
    struct buffer text;     /* the result */
};

static bool write_xml(struct conversion *c);
static bool write_native(struct conversion *c);

/* Every format that is written: its name, what its files end with, and its writer: one of scenes,
 * which are verified, or one for another program. */
static const struct format {
    const char *name, *suffix;
    bool (*translate)(struct conversion *c); /* into c->text; false after reporting */
    void (*export)(const struct scene *scene, const char *path, struct buffer *out,
                   struct diag *diag);
} formats[] = {
    {"xml", ".xml", .translate = write_xml},       {"wrt", ".wrt", .translate = write_native},
    {"json", ".json", .export = export_json},      {"pov", ".pov", .export = export_pov},
    {"tachyon", ".dat", .export = export_tachyon},
};
enum { FORMATS = sizeof formats / sizeof *formats };
#define FORMAT_NAMES "xml, wrt, json, pov or tachyon"

/* By --to, or else by the output's suffix; NULL after saying why not. */
static const struct format *choose_format(const struct options *o)
{
    struct str_nearest nearest = str_nearest_to(str_of(o->to ? o->to : ""));
    struct str path = str_of(o->output);
    for (int i = 0; i < FORMATS; i++) {
        struct str suffix = str_of(formats[i].suffix);
        if (o->to ? strcmp(o->to, formats[i].name) == 0
                  : path.n > suffix.n &&
                        str_is((struct str){path.at + path.n - suffix.n, suffix.n}, suffix.at))
            return &formats[i];
        str_nearest_try(&nearest, str_of(formats[i].name));
    }
    struct str meant = str_nearest_found(&nearest);
    if (!o->to)
        usage_error("'%s' names no format; give one with --to: " FORMAT_NAMES, o->output);
    else if (meant.n)
        usage_error("--to takes " FORMAT_NAMES ", not '%s'; did you mean '%.*s'?", o->to,
                    STR_ARG(meant));
    else
        usage_error("--to takes " FORMAT_NAMES ", not '%s'", o->to);
    return NULL;
}

/* ---- scenes ---- */

static struct str text_of(const struct buffer *b)
{
    return (struct str){b->at, b->n};
}

static struct translation translation_of(const struct conversion *c, struct frontend *f)
{
    bool given = f == &c->frontend;
    return (struct translation){.ast = &f->ast,
                                .desc = given ? &c->desc : &f->desc,
                                .sources = &f->sources,
                                .diag = &f->diag,
                                .expand = c->options->expand,
                                .beside = c->beside};
}

/* By way of the native language, which has all of XML. */
static bool xml_to_xml(struct conversion *c)
{
    struct buffer native = {0};
    struct frontend middle;
    struct translation first = translation_of(c, &c->frontend);
    bool right = translate_to_native(&first, &native);
    if (right) {
        right = frontend_load_text(&middle, c->beside, text_of(&native), c->options);
        struct translation second = translation_of(c, &middle);
        right = right && translate_to_xml(&second, &c->text);
        frontend_free(&middle);
    }
    buffer_free(&native);
    return right;
}

static bool write_xml(struct conversion *c)
{
    struct frontend *f = &c->frontend;
    struct translation t = translation_of(c, f);
    if (f->ast.xml)
        return xml_to_xml(c);
    return bake_places(&f->desc, &c->arena, &f->diag, &c->desc) && translate_to_xml(&t, &c->text);
}

static bool write_native(struct conversion *c)
{
    struct translation t = translation_of(c, &c->frontend);
    if (c->frontend.ast.xml)
        return translate_to_native(&t, &c->text);
    if (c->options->rebase)
        return translate_native_moved(&t, &c->text);
    print_scene(&c->frontend.ast, &c->text);
    return true;
}

static void note_differences(struct diag_entry *e, const struct comparison *c)
{
    for (size_t i = 0; i < c->found.n; i++)
        diag_note(e, "%s: %s, but %s", c->found.at[i].what, c->found.at[i].a, c->found.at[i].b);
}

/* Reads the result back as another run would, and compares what both scenes are. */
static void compare_with_result(struct conversion *c)
{
    enum { SHOWN = 5 };
    struct frontend f;
    struct lowered result = {0};
    struct comparison comparison = {0};
    struct options options = *c->options;
    if (c->format->translate == write_xml) /* which has no params */
        options.defines.n = 0;
    bool right = frontend_load_text(&f, c->beside, text_of(&c->text), &options) &&
                 lower_scene(&f.desc, &f.sources, &result, &f.diag);
    if (!right && f.diag.exit == DIAG_EXIT_RESOURCE)
        diag_report(&c->frontend.diag, DIAG_CANNOT_READ, (struct span){0},
                    "the result could not be checked, so nothing is written: %s",
                    f.diag.entries.at[0]->message);
    else if (!right || !compare_scenes(&c->lowered.scene, &result.scene, SHOWN, &comparison)) {
        struct diag_entry *e =
            diag_report(&c->frontend.diag, DIAG_NOT_VERIFIED, (struct span){0},
                        "the result would be another scene, so nothing is written");
        if (!right && f.diag.entries.n)
            diag_note(e, "%s", f.diag.entries.at[0]->message);
        note_differences(e, &comparison);
    }
    comparison_free(&comparison);
    lower_free(&result);
    frontend_free(&f);
}

static void verify(struct conversion *c)
{
    struct diag *diag = &c->frontend.diag;
    size_t before = diag->entries.n;
    struct frontend *f = &c->frontend;
    if (lower_scene(&c->desc, &f->sources, &c->lowered, diag))
        compare_with_result(c);
    else if (diag->entries.n > before)
        diag_note(diag->entries.at[before],
                  "--no-verify converts without opening the scene's files");
}

/* The first file name of the objects that does not begin at the root folder. */
static const struct desc_value *relative_file(struct desc_object *const *objects, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        for (const struct desc_prop *p = objects[i]->props; p; p = p->next) {
            enum schema_type type = schema_props[p->id].type;
            if (type == TYPE_FILE && p->value.string.at[0] != '/')
                return &p->value;
            const struct desc_value *inner =
                type == TYPE_SURFACE ? relative_file(&p->value.object, 1) : NULL;
            if (inner)
                return inner;
        }
    }
    return NULL;
}

static void warn_of_relative_files(struct conversion *c)
{
    struct frontend *f = &c->frontend;
    const struct desc *d = &f->desc;
    if (c->options->rebase || file_same_folder(c->output, f->ast.source->name))
        return;
    const struct desc_value *v = relative_file(d->textures.at, d->textures.n);
    v = v ? v : relative_file(d->surfaces.at, d->surfaces.n);
    v = v ? v : relative_file(d->lights.at, d->lights.n);
    if (!v)
        return;
    struct diag_entry *e =
        diag_report(&f->diag, DIAG_RELATIVE_FILES, v->span,
                    "'%.*s' is relative to another folder than the output's", STR_ARG(v->string));
    diag_note(e, "--rebase makes file names relative to the output");
}

static void translate(struct conversion *c)
{
    const struct options *o = c->options;
    c->desc = c->frontend.desc;
    c->beside = o->rebase ? c->output : c->frontend.ast.source->name;
    if (c->format->translate(c) && !o->no_verify)
        verify(c);
    if (c->frontend.diag.errors == 0)
        warn_of_relative_files(c);
}

/* ---- the command ---- */

static void write_result(struct conversion *c)
{
    const char *reason = file_write(c->output, c->text.at, c->text.n);
    if (reason)
        diag_report(&c->frontend.diag, DIAG_CANNOT_WRITE, (struct span){0},
                    "could not write '%s': %s", c->output, reason);
}

static int convert(struct conversion *c)
{
    const struct options *o = c->options;
    struct frontend *f = &c->frontend;
    bool right = frontend_load(f, c->input, o);
    if (right && c->format->translate)
        translate(c);
    else if (right && lower_scene_copied(&f->desc, &f->sources, &c->lowered, &f->diag))
        c->format->export(&c->lowered.scene, c->output, &c->text, &f->diag);
    if (f->diag.errors == 0)
        write_result(c);
    return frontend_report(f, o, o->quiet ? DIAG_WARNING : DIAG_NOTE);
}

int command_convert(const struct options *o)
{
    if (o->scenes.n != 1)
        return o->scenes.n ? usage_error("convert takes one scene, but %zu are given", o->scenes.n)
                           : usage_error("convert: no scene given");
    if (!o->output)
        return usage_error("convert: no output given; name it with -o");
    const struct format *format = choose_format(o);
    if (!format)
        return EXIT_USAGE;
    if (o->expand && format->translate != write_xml)
        return usage_error("--expand is for xml");
    if (format->export && (o->rebase || o->no_verify))
        return usage_error("--%s is for xml and wrt", o->rebase ? "rebase" : "no-verify");
    struct conversion c = {
        .options = o, .format = format, .input = o->scenes.at[0], .output = o->output};
    int status = convert(&c);
    buffer_free(&c.text);
    arena_free(&c.arena);
    lower_free(&c.lowered);
    frontend_free(&c.frontend);
    return status;
}
