/* What options take: a function for each kind of argument, which opts.def names. */
#ifndef WRT_CMD_OPTION_ARGUMENTS_H
#define WRT_CMD_OPTION_ARGUMENTS_H

#include "cmd/options.h"

#include <stddef.h>

/* An option, of opts.def. */
struct opt_row {
    char letter;
    const char *name, *argument;
    unsigned commands;
    /* Takes the argument, NULL where none is given; false after saying what is wrong with it. */
    bool (*take)(const struct opt_row *row, const char *argument, struct options *out);
    size_t member;        /* of struct options: the offset of what is set */
    uint32_t least, most; /* of a number */
    const char *help;
};

bool take_flag(const struct opt_row *row, const char *text, struct options *out);
bool take_text(const struct opt_row *row, const char *text, struct options *out);
bool take_whole(const struct opt_row *row, const char *text, struct options *out);

#define FLAG(name)
#define TEXT(name)
#define WHOLE(name, least, most)
#define OWN(function) \
    bool function(const struct opt_row *row, const char *text, struct options *out);
#define ENDS
#define OPT(id, letter, name, argument, commands, taken, help) taken
#include "cmd/opts.def"

#endif
