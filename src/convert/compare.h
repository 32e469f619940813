/* Two lowered scenes compared: everything a picture can depend on, numbers bit for bit. */
#ifndef WRT_CONVERT_COMPARE_H
#define WRT_CONVERT_COMPARE_H

#include "base/arena.h"
#include "scene/scene.h"

struct scene_difference {
    const char *what;       /* "surface 3 (sphere): radius" */
    const char *a, *b;      /* the two values */
    struct span at_a, at_b; /* where each scene says it, as far as is known */
};

/* Zero-initialise; free with comparison_free. */
struct comparison {
    struct arena arena;
    VEC(struct scene_difference) found; /* the first ones, in the scenes' order */
    size_t count;                       /* all */
};

/* True when the scenes are equal; otherwise the first `most` differences are described. */
bool compare_scenes(const struct scene *a, const struct scene *b, size_t most,
                    struct comparison *out);

void comparison_free(struct comparison *c);

#endif
