#include "config.h"

#include "cmd/interrupt.h"

#include <stddef.h>

/* The one mutable global: a signal handler can reach nothing else. */
volatile sig_atomic_t interrupt_flag;

static void note(int number)
{
    if (interrupt_flag) {
        signal(number, SIG_DFL);
        raise(number);
    }
    interrupt_flag = number;
}

void interrupt_catch(void)
{
    static const int signals[] = {SIGINT, SIGTERM};
    struct sigaction ours = {.sa_handler = note, .sa_flags = SA_RESTART}, before;
    sigemptyset(&ours.sa_mask);
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++)
        if (sigaction(signals[i], NULL, &before) == 0 && before.sa_handler == SIG_DFL)
            sigaction(signals[i], &ours, NULL);
}
