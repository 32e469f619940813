#include "config.h"

#include "cmd/commands.h"
#include "cmd/diff.h"
#include "cmd/frontend.h"

#include "base/file.h"
#include "convert/compare.h"
#include "farm/tilefile.h"
#include "lower/lower.h"

#include <stdlib.h>
#include <string.h>

enum { SHOWN = 20 }; /* differences; many follow from the first */

struct side {
    struct frontend frontend;
    struct lowered lowered;
};

/* Takes the bytes; returns the exit status. */
static int load(struct side *s, struct diff_input *input, const struct options *o)
{
    struct frontend *f = &s->frontend;
    bool loaded = frontend_load_bytes(f, input->path, input->bytes, input->n, o);
    input->bytes = NULL;
    if (loaded)
        lower_scene(&f->desc, &f->sources, &s->lowered, &f->diag);
    return frontend_report(f, o, DIAG_WARNING);
}

static void print_place(const struct side *s, struct span span)
{
    struct location at = srcmap_locate(&s->frontend.sources, span.begin);
    if (at.source)
        printf(" at %s:%u:%u", at.source->name, at.line, at.column);
    else
        printf(" in %s", s->frontend.ast.source->name);
}

static void print_difference(const struct side sides[2], const struct scene_difference *d)
{
    printf("%s: %s", d->what, d->a);
    print_place(&sides[0], d->at_a);
    printf(", but %s", d->b);
    print_place(&sides[1], d->at_b);
    puts("");
}

static int compare(const struct side sides[2])
{
    struct comparison c = {0};
    bool equal = compare_scenes(&sides[0].lowered.scene, &sides[1].lowered.scene, SHOWN, &c);
    for (size_t i = 0; i < c.found.n; i++)
        print_difference(sides, &c.found.at[i]);
    if (c.count > c.found.n)
        printf("and %zu more differences\n", c.count - c.found.n);
    comparison_free(&c);
    return equal ? DIAG_EXIT_OK : DIAG_EXIT_INPUT;
}

static int diff_scenes(struct diff_input inputs[2], const struct options *o)
{
    struct side sides[2] = {0};
    struct options loading = *o;
    int status = 0;
    if (o->output || o->json || o->limited || !o->own_threads)
        return usage_error("--%s is for two pictures", o->output    ? "out"
                                                       : o->json    ? "json"
                                                       : o->limited ? "fail-above"
                                                                    : "threads");
    for (int i = 0; i < 2; i++) {
        loading.current = (size_t)i;
        status = status_worse(status, load(&sides[i], &inputs[i], &loading));
    }
    if (status == 0)
        status = compare(sides);
    for (int i = 0; i < 2; i++) {
        lower_free(&sides[i].lowered);
        frontend_free(&sides[i].frontend);
    }
    return status;
}

/* ---- what there is to compare ---- */

static struct diff_input read_input(const char *path, const struct options *o)
{
    struct diff_input in = {.path = path, .name = strcmp(path, "-") == 0 ? "<stdin>" : path};
    in.problem = file_read_within(o->fence, path, &in.bytes, &in.n);
    in.picture = !in.problem && picture_recognised(in.bytes, in.n);
    return in;
}

/* Says which of the two cannot be read, or else that they are not alike. */
static int report_inputs(const struct diff_input inputs[2], const struct options *o)
{
    struct frontend f;
    const struct diff_input *picture = &inputs[inputs[0].picture ? 0 : 1];
    const struct diff_input *scene = &inputs[inputs[0].picture ? 1 : 0];
    frontend_init(&f, o);
    for (int i = 0; i < 2; i++)
        if (inputs[i].problem)
            diag_report(&f.diag, DIAG_CANNOT_READ, (struct span){0}, "could not read '%s': %s",
                        inputs[i].name, inputs[i].problem);
    if (!f.diag.errors && tilefile_recognised(scene->bytes, scene->n))
        diag_report(&f.diag, DIAG_NOT_COMPARABLE, (struct span){0},
                    "'%s' is a picture and '%s' holds tiles of one; 'wrt merge' makes the picture",
                    picture->name, scene->name);
    else if (!f.diag.errors)
        diag_report(&f.diag, DIAG_NOT_COMPARABLE, (struct span){0},
                    "'%s' is a picture and '%s' is none; two pictures or two scenes are compared",
                    picture->name, scene->name);
    int status = frontend_report(&f, o, DIAG_WARNING);
    frontend_free(&f);
    return status;
}

static int diff_inputs(struct diff_input inputs[2], const struct options *o)
{
    struct options as_one = *o; /* findings are those of one input */
    as_one.scenes.n = 1;
    if (inputs[0].problem || inputs[1].problem || inputs[0].picture != inputs[1].picture)
        return report_inputs(inputs, &as_one);
    return inputs[0].picture ? diff_pictures(inputs, &as_one) : diff_scenes(inputs, o);
}

int command_diff(const struct options *o)
{
    if (o->scenes.n != 2)
        return usage_error("diff takes two scenes or two pictures, but %zu %s given", o->scenes.n,
                           o->scenes.n == 1 ? "is" : "are");
    if (strcmp(o->scenes.at[0], "-") == 0 && strcmp(o->scenes.at[1], "-") == 0)
        return usage_error("diff: only one of the two can be standard input");
    if (options_overwritten(o))
        return usage_error("--out: '%s' is compared, and would be lost under the difference",
                           options_overwritten(o));
    struct diff_input inputs[2] = {read_input(o->scenes.at[0], o), read_input(o->scenes.at[1], o)};
    int status = diff_inputs(inputs, o);
    free(inputs[0].bytes);
    free(inputs[1].bytes);
    return status;
}
