/* The files a scene needs to be rendered, known without opening them. */
#ifndef WRT_CMD_NEEDED_H
#define WRT_CMD_NEEDED_H

#include "cmd/frontend.h"

#include "base/map.h"

struct needed {
    struct arena arena;
    struct map known;
    VEC(const char *) paths;
};

/* Each once, beginning with the scene itself; textures and meshes need not exist.  Free with
 * needed_free. */
void needed_files(const struct frontend *f, struct needed *out);
void needed_free(struct needed *n);

/* Reports those that --restrict keeps from being read; true when there are none. */
bool needed_check(struct frontend *f);

#endif
