/* Large triangles that lie aslant, cut into pieces with boxes of their own before a tree is built:
 * their own boxes are mostly empty.  In place of the spatial splits of Stich, Friedrich, Dietrich,
 * Spatial splits in bounding volume hierarchies, 2009; the planes are those of Karras, Aila, Fast
 * parallel construction of high-quality bounding volume hierarchies, 2013, section 4. */
#ifndef WRT_ACCEL_PIECES_H
#define WRT_ACCEL_PIECES_H

#include "accel/sah.h"

/* Cuts as much as so many rays repay and adds it to the run of all.  A triangle is then in as many
 * leaves as it has pieces.  Returns how many more there are. */
uint32_t pieces_cut(struct sah *s, struct sah_run *all, const struct geometry *g, double rays);

#endif
