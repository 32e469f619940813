/* Subtrees of a binary tree of boxes put where they enlarge boxes less (Bittner, Hapala, Havran,
 * Fast insertion-based optimization of bounding volume hierarchies, 2013).  As in Meister, Bittner,
 * Parallel reinsertion for bounding volume hierarchy optimization, 2018, places are sought for many
 * of them at once, in a tree that does not change meanwhile. */
#ifndef WRT_ACCEL_REINSERT_H
#define WRT_ACCEL_REINSERT_H

#include "accel/sah.h"

struct reinsert_node {
    struct sah_box box;
    uint32_t parent;   /* of the root: nothing */
    uint32_t child[2]; /* of a leaf: whatever its owner likes */
    uint32_t height;   /* of a leaf 0 */
};

struct reinsert_tree {
    struct reinsert_node *nodes; /* root first */
    uint32_t n;
    uint32_t height_limit; /* not exceeded by the root, at most REINSERT_HEIGHT */
};

enum { REINSERT_HEIGHT = 100 };

/* How many rounds such rays repay in a tree of n primitives; 0: none. */
unsigned reinsert_rounds(uint32_t n, double rays);

/* Leaves and the root stay where they are among the nodes; the sum of all areas does not grow.  The
 * same for any number of threads.  Returns the number of moves. */
uint32_t reinsert(struct reinsert_tree *t, unsigned rounds, unsigned threads);

#endif
