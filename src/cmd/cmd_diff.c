#include "config.h"

#include "cmd/commands.h"
#include "cmd/frontend.h"

#include "convert/compare.h"
#include "lower/lower.h"

enum { SHOWN = 20 }; /* differences; many follow from the first */

struct side {
    struct frontend frontend;
    struct lowered lowered;
};

/* Returns the exit status. */
static int load(struct side *s, const char *path, const struct options *o)
{
    struct frontend *f = &s->frontend;
    if (frontend_load(f, path, o))
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

int command_diff(const struct options *o)
{
    struct side sides[2] = {0};
    int status = 0;
    if (o->scenes.n != 2)
        return usage_error("diff takes two scenes, but %zu %s given", o->scenes.n,
                           o->scenes.n == 1 ? "is" : "are");
    struct options loading = *o;
    for (int i = 0; i < 2; i++) {
        loading.current = (size_t)i;
        status = status_worse(status, load(&sides[i], o->scenes.at[i], &loading));
    }
    if (status == 0)
        status = compare(sides);
    for (int i = 0; i < 2; i++) {
        lower_free(&sides[i].lowered);
        frontend_free(&sides[i].frontend);
    }
    return status;
}
