/* A folder that files are not read from outside of, for scenes of strangers.
 *
 * Paths are walked folder by folder from a descriptor of the fence's own, so nothing that is
 * renamed or linked meanwhile leads out, and what lies outside is not even asked for. */
#ifndef WRT_BASE_FENCE_H
#define WRT_BASE_FENCE_H

#include "base/str.h"

struct file_fence {
    const char *folder; /* as spelt; borrowed */
    char *real;         /* its real name */
    int fd;
};

/* Opens the folder; returns NULL or a reason.  Free with fence_close in any case. */
const char *fence_open(struct file_fence *f, const char *folder);
void fence_close(struct file_fence *f);

/* Why a file may not be called this in a scene: absolute names and `..` are refused, whether or not
 * they lead out.  NULL: it may, or there is no fence. */
const char *fence_refusal(const struct file_fence *f, struct str name);

/* A descriptor of the regular file at `path`, which starts with the folder as spelt or with its
 * real name, or is relative to a current folder inside.  Symbolic links are followed unless they
 * are absolute or climb out.  -1 and a reason otherwise. */
int fence_open_file(const struct file_fence *f, const char *path, const char **reason);

/* Why that would not open a file at `path`, which is not opened; NULL: nothing speaks against it,
 * or there is none. */
const char *fence_objection(const struct file_fence *f, const char *path);

#endif
