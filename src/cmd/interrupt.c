#include "config.h"

#include "cmd/interrupt.h"

#include <stddef.h>

/* The one mutable global: a signal handler can reach nothing else. */
volatile sig_atomic_t interrupt_flag;

static const struct {
    int number;
    const char *name;
} signals[] = {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}};
enum { SIGNALS = sizeof signals / sizeof *signals };

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
    struct sigaction ours = {.sa_handler = note, .sa_flags = SA_RESTART}, before;
    sigemptyset(&ours.sa_mask);
    for (size_t i = 0; i < SIGNALS; i++)
        if (sigaction(signals[i].number, NULL, &before) == 0 && before.sa_handler == SIG_DFL)
            sigaction(signals[i].number, &ours, NULL);
}

const char *interrupt_name(int number)
{
    for (size_t i = 0; i < SIGNALS; i++)
        if (signals[i].number == number)
            return signals[i].name;
    return "a signal";
}
