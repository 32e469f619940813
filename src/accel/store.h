/* Trees that outlive their geometry, for scenes that come again a little changed. */
#ifndef WRT_ACCEL_STORE_H
#define WRT_ACCEL_STORE_H

#include "accel/bvh.h"

/* By the fingerprint of what they were built of. */
struct accel_store;
struct accel_store *accel_store_new(void);
void accel_store_free(struct accel_store *s);

/* Takes the tree of an equal geometry out of the store; false when there is none. */
bool accel_store_take(struct accel_store *s, uint64_t fingerprint, struct accel *out);

/* In place of accel_free(): keeps the trees of *a and of its prototypes, and those only: what was
 * not taken since the last time is dropped. */
void accel_store_keep(struct accel_store *s, struct accel *a);

#endif
