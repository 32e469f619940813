/* What `wrt diff` compares. */
#ifndef WRT_CMD_DIFF_H
#define WRT_CMD_DIFF_H

#include "cmd/options.h"

struct diff_input {
    const char *path, *name; /* as given, and as it is called in messages */
    const char *problem;     /* why it could not be read, or NULL */
    char *bytes;             /* the whole file */
    size_t n;
    bool picture; /* by its content */
};

/* Measures two files of pictures, writes their difference if that is asked for; returns the exit
 * status. */
int diff_pictures(const struct diff_input inputs[2], const struct options *o);

#endif
