#include "config.h"

#include "cmd/commands.h"
#include "cmd/frontend.h"

#include "base/file.h"
#include "base/linediff.h"
#include "print/printer.h"

#include <string.h>

static void write_text(struct frontend *f, const char *path, struct str text)
{
    const char *reason = file_write(path, text.at, text.n);
    if (reason)
        diag_report(&f->diag, DIAG_CANNOT_WRITE, (struct span){0}, "could not write '%s': %s", path,
                    reason);
}

static void print_text(struct str text)
{
    if (text.n)
        fwrite(text.at, 1, text.n, stdout);
}

static void print_difference(const struct source *before, struct str after)
{
    struct buffer difference = {0};
    linediff(before->name, (struct str){before->text, before->n}, before->name, after, &difference);
    print_text((struct str){difference.at, difference.n});
    buffer_free(&difference);
}

/* What becomes of the formatted text; returns the exit status. */
static int deliver(struct frontend *f, const char *path, struct str text, const struct options *o)
{
    const struct source *before = f->ast.source;
    bool changed = !str_equal(text, (struct str){before->text, before->n});
    if (o->difference)
        print_difference(before, text);
    else if (o->check && changed)
        puts(before->name);
    if (o->in_place && changed)
        write_text(f, path, text);
    else if (!o->in_place && !o->check && !o->difference)
        print_text(text);
    return o->check && changed ? DIAG_EXIT_INPUT : DIAG_EXIT_OK;
}

static int format_scene(const char *path, const struct options *o)
{
    struct frontend f;
    struct buffer text = {0};
    int status = 0;
    if (frontend_parse(&f, path, o)) {
        print_scene(&f.ast, &text);
        status = deliver(&f, path, (struct str){text.at, text.n}, o);
    }
    status = status_worse(status, frontend_report(&f, o, DIAG_ERROR));
    buffer_free(&text);
    frontend_free(&f);
    return status;
}

int command_fmt(const struct options *o)
{
    int status = 0;
    if (!o->scenes.n)
        return usage_error("fmt: no scene given");
    if (o->in_place && (o->check || o->difference))
        return usage_error("--in-place cannot be combined with --check or --diff");
    for (size_t i = 0; i < o->scenes.n; i++)
        if (o->in_place && strcmp(o->scenes.at[i], "-") == 0)
            return usage_error("standard input cannot be formatted in place");
    struct options formatting = *o;
    for (size_t i = 0; i < o->scenes.n; i++) {
        formatting.current = i;
        status = status_worse(status, format_scene(o->scenes.at[i], &formatting));
    }
    return status;
}
