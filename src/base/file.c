#include "config.h"

#include "base/file.h"

#include "base/fence.h"
#include "base/mem.h"
#include "base/str.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char TOO_LARGE[] = "the file is too large (limit 2 GB)";

/* Grows the buffer until the descriptor is at its end. */
static const char *read_all(int fd, size_t expected, char **data, size_t *n)
{
    enum { ROOM = 2, FIRST = 64 * 1024 };
    size_t capacity = expected ? expected + 1 : FIRST, have = 0;
    char *buffer = mem_alloc_large(capacity + ROOM);
    for (;;) {
        if (have == capacity) {
            capacity *= 2;
            buffer = mem_realloc(buffer, capacity + ROOM, 1);
        }
        ssize_t got = read(fd, buffer + have, capacity - have);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0 || have + (size_t)got > FILE_SIZE_LIMIT) {
            const char *reason = got < 0 ? strerror(errno) : TOO_LARGE;
            free(buffer);
            return reason;
        }
        if (got == 0)
            break;
        have += (size_t)got;
    }
    *data = buffer;
    *n = have;
    return NULL;
}

/* The one place where input files are opened. */
static int open_input(const struct file_fence *fence, const char *path, const char **reason)
{
    if (fence)
        return fence_open_file(fence, path, reason);
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    *reason = fd < 0 ? strerror(errno) : NULL;
    return fd;
}

const char *file_read(const char *path, char **data, size_t *n)
{
    return file_read_within(NULL, path, data, n);
}

const char *file_read_within(const struct file_fence *fence, const char *path, char **data,
                             size_t *n)
{
    if (strcmp(path, "-") == 0)
        return read_all(STDIN_FILENO, 0, data, n);
    const char *reason;
    int fd = open_input(fence, path, &reason);
    if (fd < 0)
        return reason;
    struct stat st;
    if (fstat(fd, &st) != 0)
        reason = strerror(errno);
    else if (S_ISDIR(st.st_mode))
        reason = strerror(EISDIR);
    else if (S_ISREG(st.st_mode) && (uint64_t)st.st_size > FILE_SIZE_LIMIT)
        reason = TOO_LARGE;
    else
        reason = read_all(fd, S_ISREG(st.st_mode) ? (size_t)st.st_size : 0, data, n);
    close(fd);
    return reason;
}

bool file_readable(const struct file_fence *fence, const char *path, const char **reason)
{
    struct stat st;
    if (fence) {
        int fd = fence_open_file(fence, path, reason);
        if (fd >= 0)
            close(fd);
        return fd >= 0;
    }
    *reason = NULL;
    if (stat(path, &st) != 0 || access(path, R_OK) != 0)
        *reason = strerror(errno);
    else if (S_ISDIR(st.st_mode))
        *reason = strerror(EISDIR);
    return *reason == NULL;
}

static char *join(const char *folder, size_t n, const char *name)
{
    size_t length = strlen(name);
    char *path = mem_alloc(n + length + 1, 1);
    memcpy(path, folder, n);
    memcpy(path + n, name, length + 1);
    return path;
}

char *file_other_case(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    char *folder = slash ? join(path, (size_t)(name - path), "") : NULL, *found = NULL;
    DIR *d = opendir(folder ? folder : ".");
    for (const struct dirent *e; d && !found && (e = readdir(d));)
        if (strcmp(e->d_name, name) != 0 && str_equal_nocase(str_of(e->d_name), str_of(name)))
            found = join(path, (size_t)(name - path), e->d_name);
    if (d)
        closedir(d);
    free(folder);
    return found;
}

char *file_meant(const struct file_fence *fence, const char *path, size_t from)
{
    size_t n = strlen(path);
    const char *reason;
    char *meant = join(path, n, "");
    for (size_t i = from; i < n; i++)
        if (meant[i] == '\\')
            meant[i] = '/';
    for (size_t i = from; i < n; i++) {
        i += strcspn(meant + i, "/");
        char end = meant[i], *other = NULL;
        meant[i] = 0; /* the path as far as this folder, or all of it */
        if (i > 0 && access(meant, F_OK) != 0) {
            other = file_other_case(meant);
            if (!other || strlen(other) != i) {
                free(other);
                free(meant);
                return NULL;
            }
            memcpy(meant, other, i);
            free(other);
        }
        meant[i] = end;
    }
    if (strcmp(meant, path) == 0 || (fence && !file_readable(fence, meant, &reason))) {
        free(meant);
        return NULL;
    }
    return meant;
}

/* The name up to its last dot; the name goes on behind the slice. */
static struct str stem_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    return (struct str){name, dot ? (size_t)(dot - name) : strlen(name)};
}

/* Suffixes of pictures, or of meshes, are as near to each other: a scene is no mesh. */
static bool same_use(struct str stem, struct str other)
{
    enum { JPG_TO_PNG = 2 };
    return str_distance(str_of(stem.at + stem.n), str_of(other.at + other.n)) <= JPG_TO_PNG;
}

char *file_nearest(const struct file_fence *fence, const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *reason;
    size_t n = (size_t)(name - path);
    struct str_nearest nearest = str_nearest_to(stem_of(name));
    struct dirent **names = NULL;
    char *folder = join(path, n, "."), *found = NULL;
    bool outside = fence && fence_objection(fence, path);
    int count = outside ? 0 : scandir(folder, &names, NULL, alphasort);
    for (int i = 0; i < count; i++)
        if (same_use(stem_of(names[i]->d_name), nearest.wanted))
            str_nearest_try(&nearest, stem_of(names[i]->d_name));
    if (str_nearest_found(&nearest).n)
        found = join(path, n, nearest.best.at);
    if (found && (strcmp(found, path) == 0 || !file_readable(fence, found, &reason))) {
        free(found);
        found = NULL;
    }
    for (int i = 0; i < count; i++)
        free(names[i]);
    free(names);
    free(folder);
    return found;
}

const char *file_put(int fd, const void *data, size_t n)
{
    const char *p = data;
    while (n) {
        ssize_t put = write(fd, p, n);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return strerror(put < 0 ? errno : ENOSPC);
        p += put;
        n -= (size_t)put;
    }
    return NULL;
}

static const char *write_directly(const char *path, const void *data, size_t n)
{
    int fd = open(path, O_WRONLY | O_CLOEXEC);
    if (fd < 0)
        return strerror(errno);
    const char *reason = file_put(fd, data, n);
    if (close(fd) != 0 && !reason)
        reason = strerror(errno);
    return reason;
}

/* Mode of the new file: the old one's, or what the umask leaves of rw-rw-rw-. */
static mode_t target_mode(const struct stat *old)
{
    if (old)
        return old->st_mode & 0777;
    mode_t mask = umask(0);
    umask(mask);
    return 0666 & ~mask;
}

static const char *write_renamed(const char *path, const struct stat *old, const void *data,
                                 size_t n)
{
    static const char suffix[] = ".XXXXXX";
    size_t length = strlen(path);
    char *temporary = mem_alloc(length + sizeof suffix, 1);
    memcpy(temporary, path, length);
    memcpy(temporary + length, suffix, sizeof suffix);
    int fd = mkstemp(temporary);
    const char *reason = fd < 0 ? strerror(errno) : file_put(fd, data, n);
    if (fd >= 0) {
        if (!reason && fchmod(fd, target_mode(old)) != 0)
            reason = strerror(errno);
        if (close(fd) != 0 && !reason)
            reason = strerror(errno);
        if (!reason && rename(temporary, path) != 0)
            reason = strerror(errno);
        if (reason)
            unlink(temporary);
    }
    free(temporary);
    return reason;
}

const char *file_write(const char *path, const void *data, size_t n)
{
    if (strcmp(path, "-") == 0)
        return file_put(STDOUT_FILENO, data, n);
    struct stat st;
    bool exists = stat(path, &st) == 0;
    if (!exists && errno != ENOENT)
        return strerror(errno);
    if (exists && !S_ISREG(st.st_mode))
        return write_directly(path, data, n);
    char *real = exists ? realpath(path, NULL) : NULL; /* a symbolic link stays one */
    if (exists && !real)
        return strerror(errno);
    const char *reason = write_renamed(real ? real : path, exists ? &st : NULL, data, n);
    free(real);
    return reason;
}

char *file_resolve(const char *beside, const char *name, size_t name_length)
{
    const char *slash = strrchr(beside, '/');
    size_t folder = name_length && name[0] == '/' ? 0 : slash ? (size_t)(slash + 1 - beside) : 0;
    char *path = mem_alloc(folder + name_length + 1, 1);
    memcpy(path, beside, folder);
    memcpy(path + folder, name, name_length);
    path[folder + name_length] = 0;
    if (strcmp(path, "-") != 0)
        return path;
    free(path); /* a file of that name, not standard input */
    return memcpy(mem_alloc(sizeof "./-", 1), "./-", sizeof "./-");
}

/* The real name of the folder of a path, without a slash at its end; NULL: it cannot be told. */
static char *real_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    size_t n = slash ? (size_t)(slash + 1 - path) : 0;
    char *folder = mem_alloc(n + sizeof ".", 1);
    memcpy(folder, path, n);
    memcpy(folder + n, ".", sizeof ".");
    char *real = realpath(folder, NULL);
    free(folder);
    if (real && strcmp(real, "/") == 0)
        real[0] = 0;
    return real;
}

/* The path of a name in folder `to`, from folder `from`; both are real names. */
static char *climb(const char *from, const char *to, const char *name)
{
    size_t same = 0, i = 0, up = 0;
    for (; from[i] && from[i] == to[i]; i++)
        same = from[i] == '/' ? i : same;
    if ((!from[i] || from[i] == '/') && (!to[i] || to[i] == '/'))
        same = i; /* one is within the other, or they are equal */
    for (const char *p = from + same; *p; p++)
        up += *p == '/';
    const char *down = to[same] ? to + same + 1 : to + same;
    char *path = mem_alloc(3 * up + strlen(down) + 1 + strlen(name) + 1, 1), *end = path;
    for (; up; up--)
        end = stpcpy(end, "../");
    end = stpcpy(end, down);
    stpcpy(*down ? stpcpy(end, "/") : end, name);
    return path;
}

char *file_relative(const char *beside, const char *path)
{
    const char *slash = strrchr(path, '/');
    char *from = real_folder(beside), *to = real_folder(path), *relative = NULL;
    if (from && to && path[0] != '/')
        relative = climb(from, to, slash ? slash + 1 : path);
    free(from);
    free(to);
    return relative ? relative : mem_string(path);
}

bool file_same_folder(const char *a, const char *b)
{
    char *folder_a = real_folder(a), *folder_b = real_folder(b);
    bool same = !folder_a || !folder_b || strcmp(folder_a, folder_b) == 0;
    free(folder_a);
    free(folder_b);
    return same;
}

char *file_relocate(const char *from, const char *to, const char *name, size_t name_length)
{
    char *there = real_folder(from), *here = real_folder(to), *moved = NULL;
    bool absolute = name_length && name[0] == '/';
    if (!absolute && there && here && strcmp(there, here) != 0) {
        char *ended = memcpy(mem_zalloc(name_length + 1, 1), name, name_length);
        moved = climb(here, there, ended);
        free(ended);
    }
    free(there);
    free(here);
    return moved;
}

bool file_identify(const char *path, struct file_id *id)
{
    struct stat st;
    if (stat(path, &st) != 0)
        return false;
    *id = (struct file_id){(uint64_t)st.st_dev, (uint64_t)st.st_ino};
    return true;
}

bool file_same(const char *a, const char *b)
{
    const char *slash_a = strrchr(a, '/'), *slash_b = strrchr(b, '/');
    struct file_id x, y;
    if (file_identify(a, &x) && file_identify(b, &y))
        return x.device == y.device && x.inode == y.inode;
    return strcmp(slash_a ? slash_a + 1 : a, slash_b ? slash_b + 1 : b) == 0 &&
           file_same_folder(a, b);
}
