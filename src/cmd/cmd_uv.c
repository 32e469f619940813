#include "config.h"

#include "cmd/commands.h"
#include "cmd/frontend.h"

#include "base/file.h"
#include "convert/uv.h"

/* Writes the list; all that went wrong is reported. */
static void convert(struct frontend *f, const char *path, const char *output)
{
    const struct source *s = frontend_read(f, path);
    struct buffer list = {0};
    if (s && uv_list_from_vrml(s, &list, &f->diag)) {
        const char *reason = file_write(output, list.at, list.n);
        if (reason)
            diag_report(&f->diag, DIAG_CANNOT_WRITE, (struct span){0}, "could not write '%s': %s",
                        output, reason);
    }
    buffer_free(&list);
}

int command_uv(const struct options *o)
{
    if (o->scenes.n != 1)
        return o->scenes.n ? usage_error("uv takes one file, but %zu are given", o->scenes.n)
                           : usage_error("uv: no file given");
    if (options_overwritten(o))
        return usage_error("uv: '%s' is what the list is made of; it would be lost under that",
                           options_overwritten(o));
    struct frontend f;
    frontend_init(&f, o);
    convert(&f, o->scenes.at[0], o->output ? o->output : "-");
    int status = frontend_report(&f, o, DIAG_WARNING);
    frontend_free(&f);
    return status;
}
