#include "config.h"

#include "random.h"

/* The splitmix64 generator (Steele, Lea, Flood, OOPSLA 2014). */
static uint64_t next(struct random *r)
{
    uint64_t z = r->state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

unsigned random_below(struct random *r, unsigned n)
{
    return (unsigned)((next(r) >> 32) * n >> 32);
}

bool random_once_in(struct random *r, unsigned n)
{
    return random_below(r, n) == 0;
}

struct str random_word(struct random *r, const char *words)
{
    unsigned n = 1;
    for (const char *c = words; *c; c++)
        n += *c == ' ';
    for (unsigned skip = random_below(r, n); skip; skip--)
        words = strchr(words, ' ') + 1;
    return (struct str){words, strcspn(words, " ")};
}
