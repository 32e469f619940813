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

#include "base/str.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const struct command {
    const char *name;
    unsigned bit;
    int (*run)(int argc, char **argv);
    const char *usage, *summary;
} commands[] = {
    {"render", FOR_RENDER, command_render, "render SCENE [options]", "render a scene to a picture"},
    {"check", FOR_CHECK, command_check, "check SCENE... [options]",
     "parse and validate scenes; opens no texture or mesh"},
};
enum { COMMANDS = sizeof commands / sizeof *commands };

int command_version(void)
{
    printf("wrt %s\n", PACKAGE_VERSION);
    return 0;
}

int command_help(unsigned bits)
{
    if (bits == (FOR_RENDER | FOR_CHECK)) {
        puts("usage: wrt [COMMAND] SCENE [options]\n\ncommands:");
        for (int i = 0; i < COMMANDS; i++)
            printf("  %-28s %s\n", commands[i].usage, commands[i].summary);
        puts("\n'wrt SCENE' is short for 'wrt render SCENE'.  Options may stand anywhere.\n\noptions:");
    } else {
        for (int i = 0; i < COMMANDS; i++)
            if (commands[i].bit == bits)
                printf("usage: wrt %s\n\n%s\n\noptions:\n", commands[i].usage, commands[i].summary);
    }
    options_help(bits, stdout);
    puts("\nsee wrt(1)");
    return 0;
}

static const struct command *find_command(const char *name)
{
    for (int i = 0; i < COMMANDS; i++)
        if (strcmp(name, commands[i].name) == 0)
            return &commands[i];
    return NULL;
}

/* A word before other operands that is no file was meant as a command. */
static bool looks_like_command(const char *word, size_t operands)
{
    return operands > 1 && !strpbrk(word, "./") && access(word, F_OK) != 0;
}

static int unknown_command(const char *word)
{
    struct str_nearest nearest = str_nearest_to(str_of(word));
    for (int i = 0; i < COMMANDS; i++)
        str_nearest_try(&nearest, str_of(commands[i].name));
    struct str meant = str_nearest_found(&nearest);
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
    options_free(&o);
    if (result == OPTIONS_HELP)
        return command_help(FOR_RENDER | FOR_CHECK);
    if (result == OPTIONS_VERSION)
        return command_version();
    if (first && looks_like_command(first, operands))
        return unknown_command(first);
    if (result == OPTIONS_WRONG)
        return EXIT_USAGE;
    return operands ? command_render(argc, argv)
                    : usage_error("no scene given; 'wrt --help' says more");
}

/* What was printed must have arrived; returns the exit status. */
static int close_output(int status)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return status;
    fprintf(stderr, "wrt: error: could not write to standard output: %s\n", strerror(errno));
    return status ? status : DIAG_EXIT_RESOURCE;
}

int main(int argc, char **argv)
{
    int first = options_first_operand(argc, argv);
    const struct command *c = first < argc ? find_command(argv[first]) : NULL;
    if (!c)
        return close_output(run_without_command(argc, argv));
    for (int i = first; i + 1 < argc; i++) /* the command's name is no operand */
        argv[i] = argv[i + 1];
    return close_output(c->run(argc - 1, argv));
}
