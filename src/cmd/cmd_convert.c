#include "config.h"

#include "cmd/commands.h"
#include "cmd/frontend.h"

#include "base/file.h"
#include "convert/export.h"
#include "lower/lower.h"

#include <string.h>

/* Every format that is written: its name, what its files end with, and its writer. */
static const struct format {
    const char *name, *suffix;
    void (*write)(const struct scene *scene, const char *path, struct buffer *out,
                  struct diag *diag);
} formats[] = {
    {"json", ".json", export_json},
    {"pov", ".pov", export_pov},
    {"tachyon", ".dat", export_tachyon},
};
enum { FORMATS = sizeof formats / sizeof *formats };

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
        usage_error("'%s' names no format; give one with --to: json, pov or tachyon", o->output);
    else if (meant.n)
        usage_error("--to takes json, pov or tachyon, not '%s'; did you mean '%.*s'?", o->to,
                    STR_ARG(meant));
    else
        usage_error("--to takes json, pov or tachyon, not '%s'", o->to);
    return NULL;
}

static void convert(struct frontend *f, struct lowered *l, const struct format *format,
                    const char *output)
{
    struct buffer text = {0};
    format->write(&l->scene, output, &text, &f->diag);
    const char *reason = file_write(output, text.at, text.n);
    if (reason)
        diag_report(&f->diag, DIAG_CANNOT_WRITE, (struct span){0}, "could not write '%s': %s",
                    output, reason);
    buffer_free(&text);
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
    struct frontend f;
    struct lowered lowered = {0};
    if (frontend_load(&f, o->scenes.at[0], o) &&
        lower_scene_copied(&f.desc, &f.sources, &lowered, &f.diag))
        convert(&f, &lowered, format, o->output);
    int status = frontend_report(&f, o, o->quiet ? DIAG_WARNING : DIAG_NOTE);
    lower_free(&lowered);
    frontend_free(&f);
    return status;
}
