#include "config.h"

#include "base/hash.h"

#include <string.h>

enum { STRIPE = 32 };

static const uint64_t PRIME1 = UINT64_C(0x9E3779B185EBCA87), PRIME2 = UINT64_C(0xC2B2AE3D27D4EB4F),
                      PRIME3 = UINT64_C(0x165667B19E3779F9), PRIME4 = UINT64_C(0x85EBCA77C2B2AE63),
                      PRIME5 = UINT64_C(0x27D4EB2F165667C5);

static uint64_t turn(uint64_t x, int bits)
{
    return x << bits | x >> (64 - bits);
}

static uint64_t load(const uint8_t *p, int bytes)
{
    uint64_t x = 0;
    memcpy(&x, p, (size_t)bytes);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    x = __builtin_bswap64(x);
#endif
    return x;
}

static uint64_t add_round(uint64_t lane, uint64_t input)
{
    return turn(lane + input * PRIME2, 31) * PRIME1;
}

static uint64_t merge(uint64_t sum, uint64_t lane)
{
    return (sum ^ add_round(0, lane)) * PRIME1 + PRIME4;
}

static void add_stripes(struct hash *h, const uint8_t *p, size_t stripes)
{
    uint64_t a = h->lane[0], b = h->lane[1], c = h->lane[2], d = h->lane[3];
    for (; stripes > 0; stripes--, p += STRIPE) {
        a = add_round(a, load(p, 8));
        b = add_round(b, load(p + 8, 8));
        c = add_round(c, load(p + 16, 8));
        d = add_round(d, load(p + 24, 8));
    }
    h->lane[0] = a;
    h->lane[1] = b;
    h->lane[2] = c;
    h->lane[3] = d;
}

void hash_begin(struct hash *h, uint64_t seed)
{
    *h = (struct hash){{seed + PRIME1 + PRIME2, seed + PRIME2, seed, seed - PRIME1}, seed, 0, {0}};
}

void hash_add(struct hash *h, const void *bytes, size_t n)
{
    const uint8_t *p = bytes;
    size_t have = h->n % STRIPE;
    h->n += n;
    if (have > 0) {
        size_t take = n < STRIPE - have ? n : STRIPE - have;
        memcpy(h->rest + have, p, take);
        if (have + take < STRIPE)
            return;
        add_stripes(h, h->rest, 1);
        p += take;
        n -= take;
    }
    add_stripes(h, p, n / STRIPE);
    if (n % STRIPE > 0)
        memcpy(h->rest, p + n / STRIPE * STRIPE, n % STRIPE);
}

uint64_t hash_end(const struct hash *h)
{
    uint64_t sum = h->seed + PRIME5;
    if (h->n >= STRIPE) {
        sum =
            turn(h->lane[0], 1) + turn(h->lane[1], 7) + turn(h->lane[2], 12) + turn(h->lane[3], 18);
        for (int i = 0; i < 4; i++)
            sum = merge(sum, h->lane[i]);
    }
    sum += h->n;
    const uint8_t *p = h->rest, *end = p + h->n % STRIPE;
    for (; end - p >= 8; p += 8)
        sum = turn(sum ^ add_round(0, load(p, 8)), 27) * PRIME1 + PRIME4;
    for (; end - p >= 4; p += 4)
        sum = turn(sum ^ load(p, 4) * PRIME1, 23) * PRIME2 + PRIME3;
    for (; p < end; p++)
        sum = turn(sum ^ *p * PRIME5, 11) * PRIME1;
    sum = (sum ^ sum >> 33) * PRIME2;
    sum = (sum ^ sum >> 29) * PRIME3;
    return sum ^ sum >> 32;
}

uint64_t hash_of(const void *bytes, size_t n, uint64_t seed)
{
    struct hash h;
    hash_begin(&h, seed);
    hash_add(&h, bytes, n);
    return hash_end(&h);
}
