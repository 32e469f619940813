#include "config.h"

#include "cmd/option_arguments.h"

#include "base/file.h"
#include "base/num.h"
#include "base/thread.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum opt {
#define OPT(id, ...) OPT_##id,
#include "cmd/opts.def"
    OPTS
};

int usage_error(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fputs("wrt: error: ", stderr);
    vfprintf(stderr, format, args);
    fputs("\n", stderr);
    va_end(args);
    return EXIT_USAGE;
}

/* ---- the options ---- */

static const struct opt_row rows[OPTS] = {
#define FLAG(name) take_flag, offsetof(struct options, name), 0, 0
#define TEXT(name) take_text, offsetof(struct options, name), 0, 0
#define WHOLE(name, least, most) take_whole, offsetof(struct options, name), least, most
#define OWN(function) function, 0, 0, 0
#define ENDS NULL, 0, 0, 0 /* the command line: nothing behind it is read */
#define OPT(id, letter, name, argument, commands, taken, help) \
    {letter, name, argument, commands, taken, help},
#include "cmd/opts.def"
};

static bool optional_argument(enum opt o)
{
    return rows[o].argument && rows[o].argument[0] == '[';
}

/* ---- the command line ---- */

/* One option as it stands on the command line. */
struct given {
    enum opt opt;         /* OPTS: not known */
    const char *argument; /* or NULL */
    int words;            /* of argv it takes */
    bool stray;           /* an argument for an option that takes none, or none where one is due */
};

static enum opt find_long(struct str name)
{
    for (int o = 0; o < OPTS; o++)
        if (str_is(name, rows[o].name))
            return (enum opt)o;
    return OPTS;
}

static enum opt find_short(char letter)
{
    for (int o = 0; o < OPTS; o++)
        if (letter && rows[o].letter == letter)
            return (enum opt)o;
    return OPTS;
}

/* The option at argv[i], which starts with '-'; `next` is argv[i + 1] or NULL. */
static struct given parse_option(const char *word, const char *next)
{
    struct given g = {.opt = OPTS, .words = 1};
    if (word[1] == '-') {
        const char *equals = strchr(word, '=');
        size_t n = equals ? (size_t)(equals - word - 2) : strlen(word + 2);
        g.opt = find_long((struct str){word + 2, n});
        g.argument = equals ? equals + 1 : NULL;
    } else {
        g.opt = find_short(word[1]);
        g.argument = word[2] ? word + 2 : NULL;
    }
    if (g.opt == OPTS)
        return g;
    bool wants = rows[g.opt].argument && !optional_argument(g.opt);
    if (wants && !g.argument) {
        g.argument = next;
        g.words = 2;
    }
    g.stray = rows[g.opt].argument ? wants && !g.argument : g.argument != NULL;
    return g;
}

static bool is_option(const char *word)
{
    return word[0] == '-' && word[1];
}

int options_first_operand(int argc, char **argv)
{
    for (int i = 1; i < argc;) {
        if (strcmp(argv[i], "--") == 0)
            return i + 1;
        if (!is_option(argv[i]))
            return i;
        i += parse_option(argv[i], i + 1 < argc ? argv[i + 1] : NULL).words;
    }
    return argc;
}

static void report_unknown(const char *word)
{
    struct str name = str_of(word + strspn(word, "-"));
    name.n = strcspn(name.at, "=");
    struct str_nearest nearest = str_nearest_to(name);
    for (int o = 0; o < OPTS; o++)
        str_nearest_try(&nearest, str_of(rows[o].name));
    struct str meant = str_nearest_found(&nearest);
    if (meant.n && word[1] == '-')
        usage_error("unknown option '%s'; did you mean '--%.*s'?", word, STR_ARG(meant));
    else
        usage_error("unknown option '%s'; 'wrt help COMMAND' lists those of a command", word);
}

static bool accept(const struct given *g, const char *word, unsigned command, struct options *out)
{
    if (g->opt == OPTS) {
        report_unknown(word);
        return false;
    }
    const struct opt_row *row = &rows[g->opt];
    if (g->stray) {
        if (row->argument)
            usage_error("'%s' takes an argument: %s", word, row->argument);
        else
            usage_error("'--%s' takes no argument", row->name);
        return false;
    }
    if (!(row->commands & command)) {
        usage_error("'--%s' is no option of this command", row->name);
        return false;
    }
    return row->take(row, g->argument, out);
}

static bool called_as_scene(const char *word)
{
    const char *dot = strrchr(word, '.');
    return dot && (strcmp(dot, ".wrt") == 0 || strcmp(dot, ".xml") == 0);
}

/* `--adaptive 0.01`: an argument that may be left out stands behind `=`, so the word is an operand;
 * it was meant as an argument when it is no file and is not called as scenes are. */
static bool meant_as_argument(const struct given *g, const char *next)
{
    if (g->opt == OPTS || !optional_argument(g->opt) || g->argument || !next || is_option(next) ||
        strcmp(next, "-") == 0 || access(next, F_OK) == 0 || called_as_scene(next))
        return false;
    usage_error("'%s' is no file; what --%s takes stands behind '=': --%s=%s", next,
                rows[g->opt].name, rows[g->opt].name, next);
    return true;
}

/* More takes minutes for a single pixel. */
enum { USUAL_RAYS = 1000 * 1000 * 1000 };

enum options_result options_read(int argc, char **argv, unsigned command, struct options *out)
{
    *out = (struct options){.depth = DEPTH_OF_SCENE,
                            .isa = isa_best(),
                            .max_objects = 10 * 1000 * 1000,
                            .max_pixels = IMAGE_PIXEL_LIMIT,
                            .max_depth = UINT32_MAX,
                            .max_rays =
                                rows[OPT_MAX_RAYS].commands & command ? USUAL_RAYS : UINT64_MAX};
    for (int i = 0; i < MEASURES; i++)
        out->limits[i] = NAN;
    bool options_end = false;
    for (int i = 1; i < argc;) {
        if (!options_end && strcmp(argv[i], "--") == 0) {
            options_end = true;
            i++;
            continue;
        }
        if (options_end || !is_option(argv[i])) {
            vec_push(&out->scenes, argv[i++]);
            continue;
        }
        struct given g = parse_option(argv[i], i + 1 < argc ? argv[i + 1] : NULL);
        if (g.opt == OPT_HELP || g.opt == OPT_VERSION)
            return g.opt == OPT_HELP ? OPTIONS_HELP : OPTIONS_VERSION;
        if (!accept(&g, argv[i], command, out) ||
            meant_as_argument(&g, i + 1 < argc ? argv[i + 1] : NULL))
            return OPTIONS_WRONG;
        i += g.words;
    }
    out->own_threads = out->threads == 0;
    out->threads = out->own_threads ? thread_cores() : out->threads;
    return OPTIONS_RUN;
}

const char *options_overwritten(const struct options *o)
{
    bool file = o->output && strcmp(o->output, "-") != 0;
    for (size_t i = 0; file && i < o->scenes.n; i++)
        if (strcmp(o->scenes.at[i], "-") != 0 && file_same(o->output, o->scenes.at[i]))
            return o->scenes.at[i];
    return NULL;
}

void options_free(struct options *o)
{
    vec_free(&o->scenes);
    vec_free(&o->defines);
    vec_free(&o->folders);
}

void options_help(unsigned commands, FILE *out)
{
    for (int o = 0; o < OPTS; o++) {
        const struct opt_row *r = &rows[o];
        if ((r->commands & commands) != commands)
            continue;
        char names[64], letter[8] = "    ";
        if (r->letter)
            snprintf(letter, sizeof letter, "-%c, ", r->letter);
        const char *joint = r->argument && r->argument[0] != '[' ? " " : "";
        snprintf(names, sizeof names, "%s--%s%s%s", letter, r->name, joint,
                 r->argument ? r->argument : "");
        fprintf(out, "  %-28s %s\n", names, r->help);
    }
}
