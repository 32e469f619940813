/* The shortest edit script by E. W. Myers, An O(ND) difference algorithm and its variations,
 * Algorithmica 1(2), 1986: the greedy form, whose steps are kept to walk back. */
#include "config.h"

#include "base/linediff.h"

#include "base/vec.h"

#include <stdbool.h>

enum {
    CONTEXT = 3,      /* equal lines around changes */
    EDIT_LIMIT = 1000 /* texts with more changed lines are taken to differ altogether */
};

struct lines {
    VEC(struct str) v; /* each with its newline, but perhaps the last */
};

/* Lines [a0, a1) of one text become [b0, b1) of the other. */
struct change {
    long a0, a1, b0, b1;
};

struct comparison {
    struct lines a, b;
    long prefix, suffix;        /* equal lines at both ends */
    long n, m;                  /* lines between them */
    VEC(struct change) changes; /* first from the end, then turned round */
};

static void split(struct str text, struct lines *out)
{
    while (text.n) {
        const char *newline = memchr(text.at, '\n', text.n);
        size_t n = newline ? (size_t)(newline + 1 - text.at) : text.n;
        vec_push(&out->v, (struct str){text.at, n});
        text = (struct str){text.at + n, text.n - n};
    }
}

/* Line x of the first text's middle against line y of the second's. */
static bool same(const struct comparison *c, long x, long y)
{
    return str_equal(c->a.v.at[c->prefix + x], c->b.v.at[c->prefix + y]);
}

static void find_ends(struct comparison *c)
{
    long n = (long)c->a.v.n, m = (long)c->b.v.n, most = n < m ? n : m;
    while (c->prefix < most && same(c, 0, 0))
        c->prefix++;
    while (c->suffix < most - c->prefix &&
           str_equal(c->a.v.at[n - 1 - c->suffix], c->b.v.at[m - 1 - c->suffix]))
        c->suffix++;
    c->n = n - c->prefix - c->suffix;
    c->m = m - c->prefix - c->suffix;
}

/* Takes over a change that ends where the last one taken begins, or a new one. */
static void add_change(struct comparison *c, struct change change)
{
    struct change *last = c->changes.n ? &c->changes.at[c->changes.n - 1] : NULL;
    if (last && last->a0 == change.a1 && last->b0 == change.b1) {
        last->a0 = change.a0;
        last->b0 = change.b0;
    } else {
        vec_push(&c->changes, change);
    }
}

/* Whether the furthest point on diagonal k after d edits is reached by taking a line in (else by
 * leaving one out); v is the row of d - 1 edits. */
static bool by_insertion(const long *v, long d, long k)
{
    return k == -d || (k != d && v[k - 1] < v[k + 1]);
}

/* Row d holds the diagonals from -d to d. */
static void walk_back(struct comparison *c, long *const *rows, long edits)
{
    long x = c->n, y = c->m;
    for (long d = edits; d > 0; d--) {
        const long *v = rows[d - 1] + (d - 1);
        long k = x - y;
        bool insertion = by_insertion(v, d, k);
        long from = insertion ? k + 1 : k - 1, fx = v[from], fy = fx - from;
        long tx = insertion ? fx : fx + 1, ty = insertion ? fy + 1 : fy;
        add_change(c, (struct change){fx, tx, fy, ty});
        x = fx;
        y = fy;
    }
}

/* One more edit: the furthest points on each diagonal, from those of the row before.  True when the
 * end is reached. */
static bool advance(const struct comparison *c, const long *before, long *now, long d)
{
    for (long k = -d; k <= d; k += 2) {
        long x = d == 0 ? 0 : by_insertion(before, d, k) ? before[k + 1] : before[k - 1] + 1;
        while (x < c->n && x - k < c->m && same(c, x, x - k))
            x++;
        now[k] = x;
        if (x >= c->n && x - k >= c->m)
            return true;
    }
    return false;
}

static void find_changes(struct comparison *c)
{
    long *rows[EDIT_LIMIT + 1], d = 0;
    bool done = false;
    for (; !done && d <= EDIT_LIMIT; d++) {
        rows[d] = mem_alloc(2 * (size_t)d + 1, sizeof **rows);
        done = advance(c, d > 0 ? rows[d - 1] + (d - 1) : NULL, rows[d] + d, d);
    }
    if (done)
        walk_back(c, rows, d - 1);
    else
        add_change(c, (struct change){0, c->n, 0, c->m});
    while (d > 0)
        free(rows[--d]);
}

/* ---- writing ---- */

static void put_lines(struct buffer *out, const struct lines *from, char mark, long begin, long end)
{
    for (long i = begin; i < end; i++) {
        struct str line = from->v.at[i];
        buffer_fill(out, mark, 1);
        buffer_str(out, line);
        if (line.at[line.n - 1] != '\n')
            buffer_puts(out, "\n\\ No newline at end of file\n");
    }
}

static void put_range(struct buffer *out, char mark, long begin, long end)
{
    if (end - begin == 1)
        buffer_printf(out, "%c%ld", mark, begin + 1);
    else
        buffer_printf(out, "%c%ld,%ld", mark, end > begin ? begin + 1 : begin, end - begin);
}

/* Changes [i, j), which stand close together. */
static void put_hunk(const struct comparison *c, size_t i, size_t j, struct buffer *out)
{
    const struct change *first = &c->changes.at[i], *last = &c->changes.at[j - 1];
    long before = first->a0 < CONTEXT ? first->a0 : CONTEXT;
    long left = (long)c->a.v.n - last->a1, after = left < CONTEXT ? left : CONTEXT;
    buffer_puts(out, "@@ ");
    put_range(out, '-', first->a0 - before, last->a1 + after);
    buffer_puts(out, " ");
    put_range(out, '+', first->b0 - before, last->b1 + after);
    buffer_puts(out, " @@\n");
    long at = first->a0 - before;
    for (; i < j; i++) {
        const struct change *now = &c->changes.at[i];
        put_lines(out, &c->a, ' ', at, now->a0);
        put_lines(out, &c->a, '-', now->a0, now->a1);
        put_lines(out, &c->b, '+', now->b0, now->b1);
        at = now->a1;
    }
    put_lines(out, &c->a, ' ', at, at + after);
}

/* From the first change on, with places in the whole texts. */
static void turn_round(struct comparison *c)
{
    size_t n = c->changes.n;
    for (size_t i = 0; i < n / 2; i++) {
        struct change swap = c->changes.at[i];
        c->changes.at[i] = c->changes.at[n - 1 - i];
        c->changes.at[n - 1 - i] = swap;
    }
    for (size_t i = 0; i < n; i++) {
        struct change *change = &c->changes.at[i];
        change->a0 += c->prefix;
        change->a1 += c->prefix;
        change->b0 += c->prefix;
        change->b1 += c->prefix;
    }
}

void linediff(const char *name_a, struct str a, const char *name_b, struct str b,
              struct buffer *out)
{
    struct comparison c = {0};
    split(a, &c.a);
    split(b, &c.b);
    find_ends(&c);
    find_changes(&c);
    turn_round(&c);
    if (c.changes.n)
        buffer_printf(out, "--- %s\n+++ %s\n", name_a, name_b);
    for (size_t i = 0, j; i < c.changes.n; i = j) {
        for (j = i + 1; j < c.changes.n; j++)
            if (c.changes.at[j].a0 - c.changes.at[j - 1].a1 > 2 * CONTEXT)
                break;
        put_hunk(&c, i, j, out);
    }
    vec_free(&c.a.v);
    vec_free(&c.b.v);
    vec_free(&c.changes);
}
