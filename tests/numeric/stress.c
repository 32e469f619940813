/* stress [--full] [WORDS...]: the numerical stress suite; with words, the rows that hold one.
 *
 * Prints a row for each property: how many cases, the worst value measured and its bound, and how
 * many cases went wrong.  The rows are in stress_*.c. */
#include "config.h"

#include "stress.h"

#include "base/thread.h"

#include <stdio.h>
#include <string.h>

/* A row is cut into parts of equal size, whose random numbers do not depend on threads. */
enum { PARTS = 48 };

struct job {
    const struct row *row;
    uint64_t cases; /* a part */
    struct tally tallies[PARTS];
};

static void run_part(void *context, size_t item, unsigned worker)
{
    struct job *job = context;
    struct dice dice = {.seed = rng_mix(item) ^ job->row->full};
    (void)worker;
    job->row->run(&dice, job->cases, &job->tallies[item]);
}

static struct tally run_row(const struct row *row, bool full)
{
    struct job job = {.row = row};
    size_t parts = full ? PARTS : 4;
    struct tally sum = {0};
    job.cases = ((full ? row->full : row->quick) + parts - 1) / parts;
    thread_share(parts, thread_cores(), run_part, &job);
    for (size_t i = 0; i < parts; i++) {
        tally_measure(&sum, job.tallies[i].worst);
        sum.cases += job.tallies[i].cases;
        sum.wrong += job.tallies[i].wrong;
    }
    return sum;
}

struct counts {
    unsigned passed, failed, skipped;
};

static void report(const struct row *row, const struct tally *t, double seconds, struct counts *c)
{
    bool good = t->wrong == 0 && (row->bound == 0 || t->worst <= row->bound) && t->cases > 0;
    char measured[32] = "", bound[64] = "";
    if (row->bound > 0) {
        snprintf(measured, sizeof measured, "%.3g", t->worst);
        snprintf(bound, sizeof bound, "%g %s", row->bound, row->unit);
    }
    printf("%-52s %10llu %9s  %-22s %5llu %6.1f%s\n", row->what, (unsigned long long)t->cases,
           measured, bound, (unsigned long long)t->wrong, seconds, good ? "" : "  FAILED");
    fflush(stdout);
    c->passed += good;
    c->failed += !good;
}

static void run_rows(const struct row *row, bool full, char **words, struct counts *c)
{
    for (; row->what; row++) {
        bool wanted = !*words;
        for (char **word = words; *word; word++)
            wanted = wanted || strstr(row->what, *word);
        if (!wanted)
            continue;
#ifndef HAVE___FLOAT128
        if (row->exact) {
            printf("SKIP: %s: this compiler has no __float128\n", row->what);
            c->skipped++;
            continue;
        }
#endif
        double start = thread_seconds();
        struct tally t = run_row(row, full);
        report(row, &t, thread_seconds() - start, c);
    }
}

int main(int argc, char **argv)
{
    static const struct row *const tables[] = {rows_exact, rows_tight, rows_spawn, rows_tree};
    bool full = argc > 1 && strcmp(argv[1], "--full") == 0;
    struct counts c = {0};
    printf("%-52s %10s %9s  %-22s %5s %6s\n", "", "cases", "worst", "bound (eps = 2^-53)", "wrong",
           "s");
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
        run_rows(tables[i], full, argv + 1 + full, &c);
    printf("%u passed, %u failed, %u skipped\n", c.passed, c.failed, c.skipped);
    return c.failed > 0;
}
