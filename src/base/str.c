#include "config.h"

#include "base/str.h"

#include <stdint.h>

static int lower(char c)
{
    return c >= 'A' && c <= 'Z' ? c + 32 : c;
}

bool str_equal_nocase(struct str a, struct str b)
{
    if (a.n != b.n)
        return false;
    for (size_t i = 0; i < a.n; i++)
        if (lower(a.at[i]) != lower(b.at[i]))
            return false;
    return true;
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

struct str str_trim(struct str s)
{
    while (s.n && is_space(s.at[0]))
        s.at++, s.n--;
    while (s.n && is_space(s.at[s.n - 1]))
        s.n--;
    return s;
}

struct str str_nth_word(const char *list, unsigned n)
{
    for (;;) {
        size_t length = strcspn(list, " ");
        if (n-- == 0)
            return (struct str){list, length};
        if (!list[length])
            return (struct str){0};
        list += length + 1;
    }
}

static unsigned least(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

unsigned str_distance(struct str a, struct str b)
{
    enum { LONGEST = 63 };
    if (a.n > LONGEST || b.n > LONGEST)
        return UINT32_MAX;
    unsigned row[3][LONGEST + 1]; /* the table's current row and the two above it */
    for (size_t j = 0; j <= b.n; j++)
        row[0][j] = (unsigned)j;
    for (size_t i = 1; i <= a.n; i++) {
        unsigned *now = row[i % 3], *up = row[(i + 2) % 3], *up2 = row[(i + 1) % 3];
        now[0] = (unsigned)i;
        for (size_t j = 1; j <= b.n; j++) {
            bool same = lower(a.at[i - 1]) == lower(b.at[j - 1]);
            now[j] = least(up[j - 1] + !same, least(up[j], now[j - 1]) + 1);
            if (i > 1 && j > 1 && lower(a.at[i - 1]) == lower(b.at[j - 2]) &&
                lower(a.at[i - 2]) == lower(b.at[j - 1]))
                now[j] = least(now[j], up2[j - 2] + 1);
        }
    }
    return row[a.n % 3][b.n];
}

struct str_nearest str_nearest_to(struct str wanted)
{
    return (struct str_nearest){.wanted = wanted, .distance = UINT32_MAX};
}

void str_nearest_try(struct str_nearest *n, struct str candidate)
{
    unsigned d = str_distance(n->wanted, candidate);
    if (d < n->distance) {
        n->distance = d;
        n->best = candidate;
    }
}

struct str str_nearest_found(const struct str_nearest *n)
{
    size_t length = n->wanted.n > n->best.n ? n->wanted.n : n->best.n;
    bool near = n->distance == 0 || (n->distance <= (length + 1) / 3 && n->distance < length);
    return near ? n->best : (struct str){0};
}

/* The length of the valid sequence at p, or 0. */
static size_t sequence_length(const unsigned char *p, size_t n)
{
    if (p[0] < 0x80)
        return 1;
    size_t want = str_utf8_length(p[0]);
    if (p[0] < 0xC2 || p[0] > 0xF4 || want > n)
        return 0;
    unsigned char lowest = p[0] == 0xE0 ? 0xA0 : p[0] == 0xF0 ? 0x90 : 0x80;
    unsigned char highest = p[0] == 0xED ? 0x9F : p[0] == 0xF4 ? 0x8F : 0xBF;
    if (p[1] < lowest || p[1] > highest)
        return 0;
    for (size_t i = 2; i < want; i++)
        if ((p[i] & 0xC0) != 0x80)
            return 0;
    return want;
}

size_t str_utf8_valid(const char *p, size_t n)
{
    const uint64_t high_bits = 0x8080808080808080u;
    size_t i = 0;
    while (i < n) {
        uint64_t word;
        if (i + 8 <= n && (memcpy(&word, p + i, 8), !(word & high_bits))) {
            i += 8;
            continue;
        }
        size_t length = sequence_length((const unsigned char *)p + i, n - i);
        if (!length)
            return i;
        i += length;
    }
    return n;
}

size_t str_control_length(const char *p, size_t n)
{
    unsigned char c = (unsigned char)p[0];
    if (c < 32 || c == 127)
        return 1;
    return c == 0xC2 && n > 1 && (unsigned char)p[1] < 0xA0 ? 2 : 0;
}

size_t str_utf8_encode(unsigned long c, char out[4])
{
    if (c < 0x80) {
        out[0] = (char)c;
        return 1;
    }
    size_t n = c < 0x800 ? 2 : c < 0x10000 ? 3 : 4;
    static const unsigned char lead[5] = {0, 0, 0xC0, 0xE0, 0xF0};
    for (size_t i = n - 1; i > 0; i--, c >>= 6)
        out[i] = (char)(0x80 | (c & 0x3F));
    out[0] = (char)(lead[n] | c);
    return n;
}
