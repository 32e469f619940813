#include "config.h"

#include "cmd/commands.h"
#include "cmd/frontend.h"

#include "base/file.h"
#include "base/linediff.h"
#include "diag/fix.h"
#include "lint/explain.h"
#include "lint/lint.h"
#include "syntax/syntax.h"

#include <string.h>

/* Warnings that are told as errors keep nothing from being looked for. */
static bool is_sound(const struct frontend *f)
{
    return diag_failures(&f->diag) == 0;
}

/* What all scenes of a run came to. */
struct tally {
    size_t of[DIAG_ERROR + 1]; /* findings told, by level */
    size_t safe, all;          /* of these, what --fix mends, and --fix=all */
    size_t fixed;
};

/* Where that needs what is not installed. */
static void tell_unexamined_meshes(const struct lowered *l)
{
    struct mesh_report none;
    const char *reason = l->meshes.n > 0 ? openmesh_analyse(NULL, 0, NULL, 0, &none) : NULL;
    if (reason)
        fprintf(stderr, "wrt: warning: no mesh is examined: %s\n", reason);
}

/* Everything that can be found in a scene that was loaded. */
static void examine(struct frontend *f)
{
    struct lint l = {.ast = &f->ast, .sources = &f->sources, .diag = &f->diag};
    struct lowered lowered;
    enum lint_stage next = LINT_DESCRIPTION;
    if (f->ast.statements)
        lint_run(&l, LINT_TEXT);
    else
        next = LINT_TEXT;
    bool part = desc_is_part(&f->desc, &f->ast);
    if (is_sound(f)) {
        l.desc = &f->desc;
        lint_run(&l, LINT_DESCRIPTION);
        next = LINT_SCENE;
    }
    if (is_sound(f) && !part) {
        lower_scene(&f->desc, &f->sources, &lowered, &f->diag);
        if (is_sound(f)) {
            l.lowered = &lowered;
            tell_unexamined_meshes(&lowered);
            l.survey = survey_new(&f->desc, &lowered);
            lint_run(&l, LINT_SCENE);
            lint_run(&l, LINT_RAYS);
            survey_free(l.survey);
        }
        lower_free(&lowered);
    }
    if (f->ast.source && !is_sound(f))
        f->unlooked = lint_rules_from(&f->diag, next);
    if (is_sound(f) && !part) /* else what they allow may not have been looked for */
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
 * into the other of the two.  Returns which holds the last; counts what was mended. */
static int mend(struct frontend scenes[2], const char *path, const struct options *o, size_t *fixed)
{
    enum { ROUNDS = 10 };
    int now = 0;
    for (int i = 0; i < ROUNDS; i++) {
        struct buffer mended = {0};
        struct frontend *f = &scenes[now], *next = &scenes[!now];
        size_t n = diag_fix_text(&f->diag, f->ast.source, o->fix == FIX_ALL, &mended);
        struct str text = {mended.at, mended.n};
        if (n)
            load(next, path, &text, o);
        buffer_free(&mended);
        if (!n)
            break;
        bool worse = next->diag.errors > f->diag.errors;
        frontend_free(worse ? next : f);
        if (worse)
            break;
        *fixed += n;
        now = !now;
    }
    return now;
}

/* What was in canonical layout before stays so: the text of f is laid out anew. */
static void lay_out(struct frontend *f, const char *path, struct str before,
                    const struct options *o)
{
    struct buffer was = {0}, text = {0};
    const struct source *s = f->ast.source;
    if (!str_equal(before, (struct str){s->text, s->n}) && frontend_lay_out(before, &was) &&
        str_equal(before, (struct str){was.at, was.n}) &&
        frontend_lay_out((struct str){s->text, s->n}, &text)) {
        frontend_free(f);
        load(f, path, &(struct str){text.at, text.n}, o);
    }
    buffer_free(&was);
    buffer_free(&text);
}

static void write_mended(struct frontend *f, const char *path, bool marked)
{
    const struct source *s = f->ast.source;
    struct buffer bytes = {0};
    syntax_encode((struct str){s->text, s->n}, marked, &bytes);
    const char *reason = file_write(path, bytes.at, bytes.n);
    buffer_free(&bytes);
    if (reason)
        diag_report(&f->diag, DIAG_CANNOT_WRITE, (struct span){0}, "could not write '%s': %s", path,
                    reason);
}

/* What becomes of a text that was mended.  The difference never stands among the findings. */
static void deliver(struct frontend *f, const char *path, struct str before, bool marked,
                    const struct options *o)
{
    const struct source *s = f->ast.source;
    struct str after = {s->text, s->n};
    struct buffer difference = {0};
    if (str_equal(before, after))
        return;
    if (!o->difference) {
        write_mended(f, path, marked);
        return;
    }
    linediff(s->name, before, s->name, after, &difference);
    fwrite(difference.at, 1, difference.n, o->format == DIAG_FORMAT_TEXT ? stdout : stderr);
    buffer_free(&difference);
}

/* As mend(); the file takes the mended text, or the difference is shown. */
static int fix_scene(struct frontend scenes[2], const char *path, const struct options *o,
                     size_t *fixed)
{
    const struct source *s = scenes[0].ast.source;
    struct buffer before = {0};
    if (!s)
        return 0;
    bool marked = s->marked;
    buffer_add(&before, s->text, s->n);
    int now = mend(scenes, path, o, fixed);
    lay_out(&scenes[now], path, (struct str){before.at, before.n}, o);
    deliver(&scenes[now], path, (struct str){before.at, before.n}, marked, o);
    if (o->difference) { /* the file is as it was, and so are the places in it */
        struct str text = {before.at, before.n};
        frontend_free(&scenes[now]);
        load(&scenes[now], path, &text, o);
    }
    buffer_free(&before);
    return now;
}

static bool is_talking(const struct options *o)
{
    return o->format == DIAG_FORMAT_TEXT && !o->quiet;
}

/* Silence about what errors hide would be taken for praise. */
static void report_unlooked(const struct frontend *f, const struct options *o)
{
    if (f->unlooked && is_talking(o))
        fprintf(stderr, "%s: note: %u rule%s not looked at because of errors\n",
                f->ast.source->name, f->unlooked, f->unlooked == 1 ? " was" : "s were");
}

static int lint_scene(const char *path, const struct options *o, struct tally *tally)
{
    struct frontend scenes[2];
    enum diag_level least = o->verbose ? DIAG_NOTE : DIAG_WARNING;
    size_t of[DIAG_ERROR + 1];
    load(&scenes[0], path, NULL, o);
    int now = o->fix ? fix_scene(scenes, path, o, &tally->fixed) : 0;
    struct frontend *f = &scenes[now];
    int status = frontend_report(f, o, least);
    report_unlooked(f, o);
    diag_count_shown(&f->diag, least, of);
    for (int level = 0; level <= DIAG_ERROR; level++)
        tally->of[level] += of[level];
    if (f->ast.source) {
        tally->safe += diag_fixable(&f->diag, f->ast.source, false);
        tally->all += diag_fixable(&f->diag, f->ast.source, true);
    }
    frontend_free(f);
    return status;
}

/* "2 errors, 1 warning" */
static void add_counts(struct buffer *out, const size_t of[DIAG_ERROR + 1])
{
    static const char *const words[] = {
        [DIAG_NOTE] = "note", [DIAG_WARNING] = "warning", [DIAG_ERROR] = "error"};
    for (int level = DIAG_ERROR; level >= 0; level--)
        if (of[level])
            buffer_printf(out, "%s%zu %s%s", out->n ? ", " : "", of[level], words[level],
                          of[level] == 1 ? "" : "s");
}

/* What of it could be mended, or was. */
static void add_fixes(struct buffer *out, const struct tally *t, const struct options *o)
{
    if (o->fix && o->difference && t->fixed)
        buffer_printf(out, "%s%zu would be fixed", out->n ? "; " : "", t->fixed);
    else if (o->fix == FIX_NOTHING && t->safe)
        buffer_printf(out, "; %zu can be fixed with --fix", t->safe);
    if (o->fix == FIX_ALL || o->difference || t->all == t->safe)
        return;
    size_t more = t->all - t->safe;
    buffer_printf(out,
                  o->fix == FIX_NOTHING && t->safe ? ", %zu more with --fix=all"
                                                   : "; %zu can be fixed with --fix=all",
                  more);
}

/* One line for the whole run. */
static void sum_up(const struct tally *t, const struct options *o)
{
    struct buffer line = {0};
    bool fixed = t->fixed && !o->difference;
    if (!is_talking(o) ||
        t->of[DIAG_ERROR] + t->of[DIAG_WARNING] + t->of[DIAG_NOTE] + t->fixed == 0)
        return;
    add_counts(&line, t->of);
    add_fixes(&line, t, o);
    if (fixed)
        fprintf(stderr, "%zu fixed, %s%.*s\n", t->fixed, line.n ? "left: " : "nothing left",
                (int)line.n, line.at ? line.at : "");
    else
        fprintf(stderr, "%.*s\n", (int)line.n, line.at);
    buffer_free(&line);
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
    struct tally tally = {0};
    for (size_t i = 0; i < o->scenes.n; i++) {
        linting.current = i;
        status = status_worse(status, lint_scene(o->scenes.at[i], &linting, &tally));
    }
    sum_up(&tally, o);
    return status;
}
