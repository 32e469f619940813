/* The commands; each runs with the options it was given and returns the exit status. */
#ifndef WRT_CMD_COMMANDS_H
#define WRT_CMD_COMMANDS_H

#include "cmd/options.h"

int command_render(const struct options *o);
int command_check(const struct options *o);
int command_merge(const struct options *o);
int command_diff(const struct options *o);
int command_fmt(const struct options *o);
int command_info(const struct options *o);
int command_uv(const struct options *o);
int command_convert(const struct options *o);
int command_doc(const struct options *o);
int command_lint(const struct options *o);
int command_lsp(const struct options *o);
int command_explain(const struct options *o);

/* The scene's name with the suffix of a picture, in the current folder; the caller frees it. */
char *default_picture(const char *scene);

#endif
