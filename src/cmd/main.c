/* wrt: one program, git-style.  The data walks one way:
 *
 *     text -> tokens -> AST          src/syntax, grammar/
 *          -> description            src/eval
 *          -> checked                src/validate
 *          -> runtime scene          src/lower, src/scene
 *          -> BVH -> picture         src/accel, src/render
 *          -> file                   src/image, src/base/file
 */
#include "config.h"

#include "cmd/commands.h"
#include "cmd/options.h"

#include "base/fence.h"
#include "base/mem.h"
#include "base/str.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct command {
    const char *name;
    unsigned bit;
    int (*run)(const struct options *o);
    const char *usage, *summary;
} commands[] = {
    {"render", FOR_RENDER, command_render, "render SCENE [options]", "render a scene to a picture"},
    {"merge", FOR_MERGE, command_merge, "merge PART... -o FILE",
     "join the parts of a picture that --part made"},
    {"check", FOR_CHECK, command_check, "check SCENE... [options]",
     "parse and validate scenes; opens no texture or mesh"},
    {"lint", FOR_LINT, command_lint, "lint SCENE... [options]",
     "look for errors and for what is likely to be a mistake"},
    {"explain", FOR_EXPLAIN, command_explain, "explain CODE...",
     "what a diagnostic means, with a wrong and a right example"},
    {"convert", FOR_CONVERT, command_convert, "convert SCENE -o FILE",
     "write a scene in another format, or for another program"},
    {"diff", FOR_DIFF, command_diff, "diff A B [options]",
     "tell how far two pictures are apart, or how two scenes differ"},
    {"fmt", FOR_FMT, command_fmt, "fmt SCENE... [options]",
     "print scenes in canonical layout, or bring them into it"},
    {"info", FOR_INFO, command_info, "info SCENE [options]",
     "tell what a scene is made of, which files it needs, what is behind a pixel"},
    {"lsp", FOR_LSP, command_lsp, "lsp [options]",
     "serve an editor: the language server protocol on standard input and output"},
    {"uv", FOR_UV, command_uv, "uv FILE.wrl [-o FILE]",
     "make a UV list of a VRML 2.0 file's texture coordinates"},
    {"doc", FOR_DOC, command_doc, "doc [NAME[.PROPERTY]]",
     "what scenes are made of: kinds, properties, functions, statements"},
};
enum { COMMANDS = sizeof commands / sizeof *commands };

static int print_version(void)
{
    printf("wrt %s\n", PACKAGE_VERSION);
    return 0;
}

static int print_help(const struct command *c)
{
    if (c) {
        printf("usage: wrt %s\n\n%s\n\noptions:\n", c->usage, c->summary);
    } else {
        puts("usage: wrt COMMAND ... [options]\n       wrt SCENE [options]\n\ncommands:");
        for (int i = 0; i < COMMANDS; i++)
            printf("  %-28s %s\n", commands[i].usage, commands[i].summary);
        puts("\n'wrt SCENE' is short for 'wrt render SCENE'.  Options may stand anywhere.\n"
             "'wrt help COMMAND' lists all options of a command: 'wrt help render' those of "
             "pictures.\n\noptions of all commands that read scenes:");
    }
    options_help(c ? c->bit : FOR_SCENES, stdout);
    puts("\nsee wrt(1)");
    return 0;
}

/* Runs a command within the memory and the folder that it may use. */
static int run_limited(int (*run)(const struct options *o), struct options *o)
{
    struct file_fence fence = {.fd = -1};
    const char *reason = o->restricted ? fence_open(&fence, o->restricted) : NULL;
    int status = DIAG_EXIT_RESOURCE;
    o->fence = o->restricted ? &fence : NULL;
    if (reason)
        fprintf(stderr, "wrt: error: --restrict: could not open '%s': %s\n", o->restricted, reason);
    else if (o->max_memory && !mem_limit(o->max_memory))
        fprintf(stderr, "wrt: error: --max-memory: could not set the limit: %s\n", strerror(errno));
    else
        status = run(o);
    o->fence = NULL;
    fence_close(&fence);
    return status;
}

static int run_command(const struct command *c, int argc, char **argv)
{
    struct options o;
    size_t printed = 0;
    enum options_result result = options_read(argc, argv, c->bit, &o);
    o.printed = &printed;
    int status = result == OPTIONS_HELP      ? print_help(c)
                 : result == OPTIONS_VERSION ? print_version()
                 : result == OPTIONS_WRONG   ? EXIT_USAGE
                                             : run_limited(c->run, &o);
    options_free(&o);
    return status;
}

static const struct command *find_command(const char *name)
{
    for (int i = 0; i < COMMANDS; i++)
        if (strcmp(name, commands[i].name) == 0)
            return &commands[i];
    return NULL;
}

static struct str nearest_command(const char *word)
{
    struct str_nearest nearest = str_nearest_to(str_of(word));
    for (int i = 0; i < COMMANDS; i++)
        str_nearest_try(&nearest, str_of(commands[i].name));
    return str_nearest_found(&nearest);
}

/* A word that is no file was meant as a command when other operands follow, or when it is near to
 * one. */
static bool looks_like_command(const char *word, size_t operands)
{
    if (strpbrk(word, "./") || access(word, F_OK) == 0)
        return false;
    return operands > 1 || nearest_command(word).n;
}

static int unknown_command(const char *word)
{
    struct str meant = nearest_command(word);
    if (meant.n)
        return usage_error("unknown command '%s'; did you mean '%.*s'?", word, STR_ARG(meant));
    return usage_error("unknown command '%s'; 'wrt --help' lists them", word);
}

/* Without a command: rendering, or the help that was asked for. */
static int run_without_command(int argc, char **argv)
{
    struct options o;
    enum options_result result = options_read(argc, argv, FOR_RENDER, &o);
    size_t operands = o.scenes.n;
    const char *first = operands ? o.scenes.at[0] : NULL;
    int status = result == OPTIONS_HELP                         ? print_help(NULL)
                 : result == OPTIONS_VERSION                    ? print_version()
                 : first && looks_like_command(first, operands) ? unknown_command(first)
                 : result == OPTIONS_WRONG                      ? EXIT_USAGE
                 : operands                                     ? run_limited(command_render, &o)
                            : usage_error("no scene given; 'wrt --help' says more");
    options_free(&o);
    return status;
}

/* What was printed must have arrived; returns the exit status. */
static int close_output(int status)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return status;
    fprintf(stderr, "wrt: error: could not write to standard output: %s\n", strerror(errno));
    return status ? status : DIAG_EXIT_RESOURCE;
}

/* `wrt help [COMMAND]`; another word gives no help. */
static int help_on(const char *word)
{
    const struct command *c = word ? find_command(word) : NULL;
    return word && !c ? unknown_command(word) : print_help(c);
}

/* For jansson, which would go on without what it could not have. */
static void *allocate(size_t n)
{
    return mem_alloc(n, 1);
}

int main(int argc, char **argv)
{
    json_set_alloc_funcs(allocate, free);
    int first = options_first_operand(argc, argv);
    const struct command *c = first < argc ? find_command(argv[first]) : NULL;
    if (first < argc && strcmp(argv[first], "help") == 0 && access("help", F_OK) != 0)
        return close_output(help_on(first + 1 < argc ? argv[first + 1] : NULL));
    if (!c)
        return close_output(run_without_command(argc, argv));
    for (int i = first; i + 1 < argc; i++) /* the command's name is no operand */
        argv[i] = argv[i + 1];
    return close_output(run_command(c, argc - 1, argv));
}
