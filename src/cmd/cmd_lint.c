#include "config.h"

#include "cmd/commands.h"
#include "cmd/frontend.h"

#include "base/file.h"
#include "base/linediff.h"
#include "diag/fix.h"
#include "lint/explain.h"
#include "lint/lint.h"

#include <string.h>

/* Warnings that are told as errors keep nothing from being looked for. */
static bool is_sound(const struct frontend *f)
{
    return diag_failures(&f->diag) == 0;
}

/* Everything that can be found in a scene that was loaded. */
static void examine(struct frontend *f)
{
    struct lint l = {.ast = &f->ast, .sources = &f->sources, .diag = &f->diag};
    struct lowered lowered;
    if (f->ast.statements)
        lint_run(&l, LINT_TEXT);
    if (is_sound(f)) {
        l.desc = &f->desc;
        lint_run(&l, LINT_DESCRIPTION);
        lower_scene(&f->desc, &f->sources, &lowered, &f->diag);
        if (is_sound(f)) {
            l.lowered = &lowered;
            l.survey = survey_new(&f->desc, &lowered);
            lint_run(&l, LINT_SCENE);
            lint_run(&l, LINT_RAYS);
            survey_free(l.survey);
        }
        lower_free(&lowered);
    }
    if (is_sound(f)) /* else what they allow may not have been looked for */
        diag_report_unused_allows(&f->diag);
}

/* Loads the scene and examines it: the file itself, or this text of it. */
static void load(struct frontend *f, const char *path, const struct str *text,
                 const struct options *o)
{
    if (text)
        frontend_load_text(f, path, *text, o);
    else
        frontend_load(f, path, o);
    examine(f);
}

/* Mends the text of scenes[0] until nothing is left that can be; each round loads the next text
 * into the other of the two.  Returns which holds the last. */
static int mend(struct frontend scenes[2], const char *path, const struct options *o)
{
    enum { ROUNDS = 10 };
    int now = 0;
    for (int i = 0; i < ROUNDS; i++) {
        struct buffer mended = {0};
        struct frontend *f = &scenes[now], *next = &scenes[!now];
        bool any = diag_fix_text(&f->diag, f->ast.source, o->fix == FIX_ALL, &mended) > 0;
        struct str text = {mended.at, mended.n};
        if (any)
            load(next, path, &text, o);
        buffer_free(&mended);
        if (!any)
            break;
        bool worse = next->diag.errors > f->diag.errors;
        frontend_free(worse ? next : f);
        if (worse)
            break;
        now = !now;
    }
    return now;
}

static void write_mended(struct frontend *f, const char *path)
{
    const struct source *s = f->ast.source;
    const char *reason = file_write(path, s->text, s->n);
    if (reason)
        diag_report(&f->diag, DIAG_CANNOT_WRITE, (struct span){0}, "could not write '%s': %s", path,
                    reason);
}

/* What becomes of a text that was mended. */
static void deliver(struct frontend *f, const char *path, struct str before,
                    const struct options *o)
{
    const struct source *s = f->ast.source;
    struct str after = {s->text, s->n};
    struct buffer difference = {0};
    if (str_equal(before, after))
        return;
    if (!o->difference) {
        write_mended(f, path);
        return;
    }
    linediff(s->name, before, s->name, after, &difference);
    fwrite(difference.at, 1, difference.n, stdout);
    buffer_free(&difference);
}

/* As mend(); the file takes the mended text, or the difference is shown. */
static int fix_scene(struct frontend scenes[2], const char *path, const struct options *o)
{
    const struct source *s = scenes[0].ast.source;
    struct buffer before = {0};
    if (!s)
        return 0;
    buffer_add(&before, s->text, s->n);
    int now = mend(scenes, path, o);
    deliver(&scenes[now], path, (struct str){before.at, before.n}, o);
    if (o->difference) { /* the file is as it was, and so are the places in it */
        struct str text = {before.at, before.n};
        frontend_free(&scenes[now]);
        load(&scenes[now], path, &text, o);
    }
    buffer_free(&before);
    return now;
}

static int lint_scene(const char *path, const struct options *o)
{
    struct frontend scenes[2];
    load(&scenes[0], path, NULL, o);
    int now = o->fix ? fix_scene(scenes, path, o) : 0;
    int status = frontend_report(&scenes[now], o, o->verbose ? DIAG_NOTE : DIAG_WARNING);
    frontend_free(&scenes[now]);
    return status;
}

static int print_list(void)
{
    struct buffer out = {0};
    explain_list(&out);
    fwrite(out.at, 1, out.n, stdout);
    buffer_free(&out);
    return 0;
}

int command_lint(const struct options *o)
{
    struct options linting = *o;
    linting.policy.lint = true;
    if (o->list)
        return print_list();
    if (o->difference && !o->fix)
        return usage_error("--diff shows what --fix would change: give both");
    for (size_t i = 0; i < o->scenes.n; i++)
        if (o->fix && strcmp(o->scenes.at[i], "-") == 0)
            return usage_error("standard input cannot be fixed in place");
    int status = o->scenes.n ? 0 : usage_error("lint: no scene given");
    for (size_t i = 0; i < o->scenes.n; i++) {
        linting.current = i;
        status = status_worse(status, lint_scene(o->scenes.at[i], &linting));
    }
    return status;
}
