#include "config.h"

#include "cmd/options.h"

#include "base/thread.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES_LIMIT = 1024, DEPTH_LIMIT = 1000, THREADS_LIMIT = 1024 };

enum opt {
#define OPT(id, ...) OPT_##id,
#include "cmd/opts.def"
#undef OPT
    OPTS
};

static const struct opt_row {
    char letter;
    const char *name, *argument;
    unsigned commands;
    const char *help;
} rows[OPTS] = {
#define OPT(id, letter, name, argument, commands, help) {letter, name, argument, commands, help},
#include "cmd/opts.def"
#undef OPT
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

static bool optional_argument(enum opt o)
{
    return rows[o].argument && rows[o].argument[0] == '[';
}

/* ---- arguments of options ---- */

static bool read_whole(const char *text, uint64_t least, uint64_t most, uint64_t *out)
{
    char *end;
    if (text[0] < '0' || text[0] > '9')
        return false;
    errno = 0;
    unsigned long long x = strtoull(text, &end, 10);
    *out = x;
    return *end == 0 && errno == 0 && x >= least && x <= most;
}

static bool take_whole(enum opt o, const char *text, uint64_t least, uint64_t most, uint64_t *out)
{
    if (read_whole(text, least, most, out))
        return true;
    usage_error("--%s takes a whole number from %llu to %llu, not '%s'", rows[o].name,
                (unsigned long long)least, (unsigned long long)most, text);
    return false;
}

static bool take_u32(enum opt o, const char *text, uint32_t least, uint32_t most, uint32_t *out)
{
    uint64_t x = 0;
    bool right = take_whole(o, text, least, most, &x);
    *out = (uint32_t)x;
    return right;
}

/* `n` whole numbers with a separator between them. */
static bool read_list(const char *text, char separator, unsigned n, uint32_t *out)
{
    for (unsigned i = 0; i < n; i++) {
        char *end;
        if (text[0] < '0' || text[0] > '9')
            return false;
        unsigned long x = strtoul(text, &end, 10);
        if (x > UINT32_MAX || *end != (i + 1 < n ? separator : 0))
            return false;
        out[i] = (uint32_t)x;
        text = end + 1;
    }
    return true;
}

static bool take_res(const char *text, struct options *out)
{
    uint32_t size[2];
    if (!read_list(text, 'x', 2, size)) {
        usage_error("--res takes WIDTHxHEIGHT, as in 640x480, not '%s'", text);
        return false;
    }
    if (!image_size_allowed(size[0], size[1])) {
        usage_error("--res: a picture has 1 to %d pixels, at most %d along a side",
                    IMAGE_PIXEL_LIMIT, IMAGE_SIDE_LIMIT);
        return false;
    }
    out->width = size[0];
    out->height = size[1];
    return true;
}

static bool take_crop(const char *text, struct options *out)
{
    uint32_t *c = out->crop;
    if (!read_list(text, ',', 4, c) || c[0] >= c[2] || c[1] >= c[3]) {
        usage_error("--crop takes X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1, not '%s'", text);
        return false;
    }
    return out->cropped = true;
}

static bool take_pixel(const char *text, struct options *out)
{
    if (!read_list(text, ',', 2, out->pixel)) {
        usage_error("--pixel takes X,Y, not '%s'", text);
        return false;
    }
    return out->behind = true;
}

/* The number of a word in a list that ends with NULL; -1 after reporting another. */
static int take_word(enum opt o, const char *text, const char *const *words)
{
    struct str_nearest nearest = str_nearest_to(str_of(text));
    char list[128] = "";
    for (int i = 0; words[i]; i++) {
        if (strcmp(text, words[i]) == 0)
            return i;
        str_nearest_try(&nearest, str_of(words[i]));
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s'%s'",
                 i == 0         ? ""
                 : words[i + 1] ? ", "
                                : " or ",
                 words[i]);
    }
    struct str meant = str_nearest_found(&nearest);
    if (meant.n)
        usage_error("--%s takes %s, not '%s'; did you mean '%.*s'?", rows[o].name, list, text,
                    STR_ARG(meant));
    else
        usage_error("--%s takes %s, not '%s'", rows[o].name, list, text);
    return -1;
}

static bool take_show(const char *text, struct options *out)
{
    static const char *const words[] = {"normals", "depth", "ids", NULL};
    static const enum render_show shows[] = {SHOW_NORMALS, SHOW_DEPTH, SHOW_IDS};
    int i = take_word(OPT_SHOW, text, words);
    out->show = i >= 0 ? shows[i] : SHOW_PICTURE;
    return i >= 0;
}

static bool take_format(const char *text, struct options *out)
{
    static const char *const words[] = {"text", "json", NULL};
    static const enum diag_format formats[] = {DIAG_FORMAT_TEXT, DIAG_FORMAT_JSON};
    int i = take_word(OPT_FORMAT, text, words);
    out->format = formats[i > 0];
    return i >= 0;
}

static bool take_stats(const char *text, struct options *out)
{
    static const char *const words[] = {"json", NULL};
    out->stats = text ? STATS_JSON : STATS_TEXT;
    return !text || take_word(OPT_STATS, text, words) >= 0;
}

static bool take_accel(const char *text, struct options *out)
{
    static const char *const words[] = {"none", NULL};
    out->brute_force = true;
    return take_word(OPT_ACCEL, text, words) >= 0;
}

static bool take_isa(const char *text, struct options *out)
{
    const char *words[ISA_COUNT + 1] = {NULL};
    for (int i = 0; i < ISA_COUNT; i++)
        words[i] = isa_name((enum isa)i);
    int i = take_word(OPT_ISA, text, words);
    if (i < 0)
        return false;
    out->isa = (enum isa)i;
    if (!isa_available(out->isa))
        usage_error("--isa: this machine or build has no %s", words[i]);
    return isa_available(out->isa);
}

static bool take_define(const char *text, struct options *out)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text) {
        usage_error("--define takes NAME=VALUE, not '%s'", text);
        return false;
    }
    vec_push(&out->defines, text);
    return true;
}

/* `argument` is NULL where none is given. */
static bool take(enum opt o, const char *argument, struct options *out)
{
    const char *text = argument ? argument : "";
    uint64_t whole = 0;
    switch (o) {
    case OPT_OUTPUT:
        out->output = text;
        return true;
    case OPT_TO:
        out->to = text;
        return true;
    case OPT_SAMPLES:
        return take_u32(o, text, 1, SAMPLES_LIMIT, &out->grid);
    case OPT_THREADS:
        return take_u32(o, text, 1, THREADS_LIMIT, &out->threads);
    case OPT_DEPTH:
        return take_u32(o, text, 0, DEPTH_LIMIT, &out->depth);
    case OPT_SEED:
        return take_whole(o, text, 0, UINT64_MAX, &out->seed);
    case OPT_MAX_OBJECTS:
        if (!take_whole(o, text, 1, UINT32_MAX, &whole))
            return false;
        out->max_objects = (size_t)whole;
        return true;
    case OPT_RES:
        return take_res(text, out);
    case OPT_CROP:
        return take_crop(text, out);
    case OPT_SHOW:
        return take_show(text, out);
    case OPT_ACCEL:
        return take_accel(text, out);
    case OPT_ISA:
        return take_isa(text, out);
    case OPT_DEFINE:
        return take_define(text, out);
    case OPT_INCLUDE:
        vec_push(&out->folders, text);
        return true;
    case OPT_STATS:
        return take_stats(argument, out);
    case OPT_FORMAT:
        return take_format(text, out);
    case OPT_EXPAND:
        return out->expand = true;
    case OPT_REBASE:
        return out->rebase = true;
    case OPT_NO_VERIFY:
        return out->no_verify = true;
    case OPT_IN_PLACE:
        return out->in_place = true;
    case OPT_CHECK:
        return out->check = true;
    case OPT_DIFF:
        return out->difference = true;
    case OPT_JITTER:
        return out->jitter = true;
    case OPT_NO_SKIP:
        return out->no_skip = true;
    case OPT_QUIET:
        return out->quiet = true;
    case OPT_VERBOSE:
        return out->verbose = true;
    case OPT_JSON:
        return out->json = true;
    case OPT_DEPS:
        return out->deps = true;
    case OPT_PIXEL:
        return take_pixel(text, out);
    case OPT_MAN:
        return out->manual = true;
    case OPT_HELP:
    case OPT_VERSION:
    case OPTS:
        break;
    }
    return true;
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
        usage_error("unknown option '%s'; 'wrt --help' lists them", word);
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
    return take(g->opt, g->argument, out);
}

enum options_result options_read(int argc, char **argv, unsigned command, struct options *out)
{
    *out = (struct options){.depth = DEPTH_OF_SCENE,
                            .threads = thread_cores(),
                            .isa = isa_best(),
                            .max_objects = 10 * 1000 * 1000};
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
        if (!accept(&g, argv[i], command, out))
            return OPTIONS_WRONG;
        i += g.words;
    }
    return OPTIONS_RUN;
}

void options_free(struct options *o)
{
    vec_free(&o->scenes);
    vec_free(&o->defines);
    vec_free(&o->folders);
}

void options_help(unsigned command, FILE *out)
{
    for (int o = 0; o < OPTS; o++) {
        const struct opt_row *r = &rows[o];
        if (!(r->commands & command))
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
