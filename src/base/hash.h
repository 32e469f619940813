/* Checksums and the identity of contents: XXH64 (Yann Collet, xxHash, the fast digest algorithm,
 * specification 0.1.1), 64 bits that any change scatters over.  It tells contents apart that differ
 * by chance or damage, not by somebody's intent. */
#ifndef WRT_BASE_HASH_H
#define WRT_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

/* Of bytes that come piece by piece; how they are cut does not matter. */
struct hash {
    uint64_t lane[4], seed, n;
    uint8_t rest[32]; /* the last n % 32 bytes */
};

void hash_begin(struct hash *h, uint64_t seed);
void hash_add(struct hash *h, const void *bytes, size_t n);
uint64_t hash_end(const struct hash *h);

uint64_t hash_of(const void *bytes, size_t n, uint64_t seed);

#endif
