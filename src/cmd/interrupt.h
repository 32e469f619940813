/* The signals by which people and batch systems end a program. */
#ifndef WRT_CMD_INTERRUPT_H
#define WRT_CMD_INTERRUPT_H

#include <signal.h>

/* From now on the first SIGINT or SIGTERM only raises the flag; the second ends the process at
 * once, as it would have without this.  A signal that is ignored stays so. */
void interrupt_catch(void);

/* 0, or the signal that came. */
extern volatile sig_atomic_t interrupt_flag;

/* What it is called. */
const char *interrupt_name(int number);

#endif
