/* The commands; each reads its own arguments and returns the exit status. */
#ifndef WRT_CMD_COMMANDS_H
#define WRT_CMD_COMMANDS_H

int command_render(int argc, char **argv);
int command_check(int argc, char **argv);

/* Prints `wrt --version`'s line, or help for one command; returns 0. */
int command_version(void);
int command_help(unsigned command);

#endif
