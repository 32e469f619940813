/* FLIP: how large a difference between two pictures looks to a person who flips between them.
 *
 * LDR-FLIP of Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference
 * Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics 3(2), 2020, for a
 * picture seen at 67 pixels a degree: on a screen 3840 pixels and 0.7 m wide, from 0.7 m. */
#ifndef WRT_IMAGE_FLIP_H
#define WRT_IMAGE_FLIP_H

#include "image/picture.h"

/* The error of each pixel, from 0 to 1, into width x height floats.  The pictures have one size and
 * both hold bytes, taken as sRGB, or both floats, taken as light and cut to [0, 1]. */
void flip_map(const struct picture *a, const struct picture *b, unsigned threads, float *map);

#endif
