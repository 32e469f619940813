/* The primitives that a bundle of rays can meet at all.
 *
 * A shaft holds every point o + t d of a bundle of rays, 0 <= t <= t_max, by bounds on each axis
 * that grow linearly with t.  What its list leaves out is hit by no ray of the bundle, so tracing
 * against the list gives the same hits as tracing against everything. */
#ifndef WRT_ACCEL_SHAFT_H
#define WRT_ACCEL_SHAFT_H

#include "accel/bundle.h"

struct shaft {
    struct box start, end; /* end: of the points at t_max, unless endless */
    double t_max;
    bool endless;
    bool spawned; /* all rays are */
    double from;  /* where all of them start: a primitive's number, or PRIM_NONE */
    double padding;
    /* Ready for tests: bounds at t = 0 with the padding, and 1 / their growth. */
    double lo[3], hi[3], lo_inverse[3], hi_inverse[3];
};

/* The rays from anywhere in `origins` along any of `directions`, without end. */
struct shaft shaft_of_rays(const struct accel *a, struct box origins, struct box directions);

/* The spawned rays p + t (q - p), 0 <= t <= t_max, t_max >= 1, for all p and q of the boxes. */
struct shaft shaft_between(const struct accel *a, struct box p, struct box q, double t_max);

/* Whether a ray of the bundle may hit something in the box. */
bool shaft_touches_box(const struct shaft *s, struct box b);

/* Whether a ray of the bundle may hit this one primitive. */
bool shaft_touches(const struct accel *a, const struct shaft *s, struct target target);

/* Fills in the list with what the shaft touches, the lower bounds left 0. */
void shaft_list(const struct accel *a, const struct shaft *s, struct target_list *list);

/* Those of `from` that the shaft touches, in their order. */
void shaft_narrow(const struct accel *a, const struct shaft *s, const struct target_list *from,
                  struct target_list *list);

/* Works out the lower bounds and sorts by them. */
void shaft_sort(const struct accel *a, const struct shaft *s, struct target_list *list);

#endif
