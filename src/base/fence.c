#include "config.h"

#include "base/fence.h"

#include "base/mem.h"
#include "base/vec.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#ifndef O_PATH
#define O_PATH O_RDONLY
#endif

enum { LINKS_LIMIT = 40, FOLDERS_LIMIT = 128, LINK_BYTES = 4096 };

static const char OUTSIDE[] = "it is outside of the folder that files may be read from";
static const char LEADS_OUT[] =
    "a symbolic link leads out of the folder that files may be read from";
static const char NOT_REGULAR[] = "it is no regular file";
static const char ABSOLUTE_LINK[] = "a symbolic link to an absolute path is not followed here";

/* A way through folders inside of the fence. */
struct walk {
    const struct file_fence *fence;
    VEC(int) folders; /* the open ones, without the fence's own */
    char *rest;       /* names yet to be walked; owned */
    unsigned links;   /* followed so far */
    bool looks;       /* and opens nothing at its end */
};

const char *fence_open(struct file_fence *f, const char *folder)
{
    *f = (struct file_fence){.folder = folder, .fd = -1};
    f->fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    f->real = f->fd < 0 ? NULL : realpath(folder, NULL);
    return f->real ? NULL : strerror(errno);
}

void fence_close(struct file_fence *f)
{
    if (f->fd >= 0)
        close(f->fd);
    free(f->real);
    *f = (struct file_fence){.fd = -1};
}

const char *fence_refusal(const struct file_fence *f, struct str name)
{
    if (!f)
        return NULL;
    if (name.n && *name.at == '/')
        return "an absolute path is not allowed here";
    for (size_t i = 0; i < name.n;) {
        const char *slash = memchr(name.at + i, '/', name.n - i);
        size_t n = slash ? (size_t)(slash - name.at) - i : name.n - i;
        if (str_is((struct str){name.at + i, n}, ".."))
            return "'..' is not allowed here";
        i += n + 1;
    }
    return NULL;
}

static char *join(const char *a, const char *b)
{
    size_t n = strlen(a), m = strlen(b);
    char *path = mem_alloc(n + m + 2, 1);
    memcpy(path, a, n);
    path[n] = '/';
    memcpy(path + n + 1, b, m + 1);
    return path;
}

/* What follows the folder in the path; NULL: it starts otherwise. */
static const char *behind(const char *path, const char *folder)
{
    size_t n = strlen(folder);
    while (n && folder[n - 1] == '/')
        n--;
    return strncmp(path, folder, n) == 0 && path[n] == '/' ? path + n + 1 : NULL;
}

/* The path from the fence's folder on; NULL: it starts elsewhere. */
static char *path_inside(const struct file_fence *f, const char *path)
{
    while (strncmp(path, "./", 2) == 0)
        path += 2;
    char *here = path[0] == '/' ? NULL : getcwd(NULL, 0);
    char *whole = here ? join(here, path) : NULL;
    const char *rest = behind(path, f->folder);
    if (!rest)
        rest = behind(whole ? whole : path, f->real);
    char *inside = rest ? join(".", rest) : NULL;
    free(whole);
    free(here);
    return inside;
}

static int folder_of(const struct walk *w)
{
    return w->folders.n ? w->folders.at[w->folders.n - 1] : w->fence->fd;
}

/* Devices and pipes are not even opened: that alone may do something, or wait. */
static int open_regular(const struct walk *w, const char *name, const char **reason)
{
    int folder = folder_of(w);
    struct stat st;
    int fd = -1;
    bool known = fstatat(folder, name, &st, AT_SYMLINK_NOFOLLOW) == 0;
    if (known && !S_ISREG(st.st_mode)) {
        *reason = S_ISDIR(st.st_mode) ? strerror(EISDIR) : NOT_REGULAR;
        return -1;
    }
    if (known && !w->looks)
        fd = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    *reason = fd < 0 ? strerror(errno) : NULL;
    return fd;
}

static const char *climb(struct walk *w)
{
    if (!w->folders.n)
        return w->links ? LEADS_OUT : OUTSIDE;
    close(w->folders.at[--w->folders.n]);
    return NULL;
}

static const char *descend(struct walk *w, const char *name)
{
    if (w->folders.n == FOLDERS_LIMIT)
        return strerror(ENAMETOOLONG);
    int fd = openat(folder_of(w), name, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (fd < 0)
        return strerror(errno);
    vec_push(&w->folders, fd);
    return NULL;
}

/* Goes on with the link's target, then what stands behind the link. */
static const char *follow(struct walk *w, const char *target, const char *rest)
{
    if (target[0] == '/')
        return ABSOLUTE_LINK;
    if (w->links++ == LINKS_LIMIT)
        return strerror(ELOOP);
    char *path = join(target, rest);
    free(w->rest);
    w->rest = path;
    return NULL;
}

/* The first name of w->rest, which it cuts off; opens the file when it is the last. */
static const char *step(struct walk *w, int *file)
{
    char *name = w->rest + strspn(w->rest, "/"), target[LINK_BYTES];
    size_t n = strcspn(name, "/");
    const char *rest = name + n + strspn(name + n, "/"), *reason = NULL;
    bool last = !*rest;
    name[n] = 0;
    ssize_t link = readlinkat(folder_of(w), name, target, sizeof target);
    if (link >= (ssize_t)sizeof target)
        return strerror(ENAMETOOLONG);
    if (link >= 0) {
        target[link] = 0;
        return follow(w, target, rest);
    }
    if (strcmp(name, "..") == 0)
        reason = climb(w);
    else if (last && *name)
        *file = open_regular(w, name, &reason);
    else if (*name && strcmp(name, ".") != 0)
        reason = descend(w, name);
    memmove(w->rest, rest, strlen(rest) + 1);
    return reason;
}

/* To the file at the path, which is opened unless the walk only looks. */
static int walk_to(const struct file_fence *f, const char *path, bool looks, const char **reason)
{
    struct walk w = {.fence = f, .rest = path_inside(f, path), .looks = looks};
    int file = -1;
    *reason = w.rest ? NULL : OUTSIDE;
    while (!*reason && file < 0)
        *reason = *w.rest ? step(&w, &file) : strerror(EISDIR);
    while (w.folders.n)
        climb(&w);
    vec_free(&w.folders);
    free(w.rest);
    return file;
}

int fence_open_file(const struct file_fence *f, const char *path, const char **reason)
{
    return walk_to(f, path, false, reason);
}

const char *fence_objection(const struct file_fence *f, const char *path)
{
    const char *reason;
    walk_to(f, path, true, &reason);
    bool ours = reason == OUTSIDE || reason == LEADS_OUT || reason == ABSOLUTE_LINK ||
                reason == NOT_REGULAR;
    return ours ? reason : NULL;
}
