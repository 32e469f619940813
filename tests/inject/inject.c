/* Preloaded into a program, makes one of its calls fail:
 *
 *     INJECT=KIND:N       the N-th call of this kind, from 1; KIND+:N: that one and all behind it
 *     INJECT_LOG=FILE     at the end, the calls of each kind, the blocks that are still allocated,
 *                         and whether a call failed, are written there
 *
 * The kinds are those of the table below.  stdio's own calls go past this: /dev/full is for them.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum kind {
    ALLOC,
    OPEN,
    STAT,
    READ,
    SHORT_READ,
    READ_INTR,
    WRITE,
    SHORT_WRITE,
    WRITE_INTR,
    SPACE,
    SYNC,
    CLOSE,
    CHMOD,
    RENAME,
    THREAD,
    KINDS
};

/* What a call of each kind sets errno to. */
static const struct {
    const char *name;
    int error;
} kinds[KINDS] = {
    [ALLOC] = {"alloc", ENOMEM},
    [OPEN] = {"open", EMFILE},
    [STAT] = {"stat", EIO},
    [READ] = {"read", EIO},
    [SHORT_READ] = {"short-read", 0},
    [READ_INTR] = {"read-intr", EINTR},
    [WRITE] = {"write", EIO},
    [SHORT_WRITE] = {"short-write", 0},
    [WRITE_INTR] = {"write-intr", EINTR},
    [SPACE] = {"space", ENOSPC},
    [SYNC] = {"sync", EIO},
    [CLOSE] = {"close", EIO},
    [CHMOD] = {"chmod", EPERM},
    [RENAME] = {"rename", EIO},
    [THREAD] = {"thread", EAGAIN},
};

static atomic_long counts[KINDS], live;
static atomic_bool failed;
static int chosen = -1;
static long number;
static bool onwards;

/* Counts a call; true when it is to fail. */
static bool fails(enum kind k)
{
    long n = atomic_fetch_add(&counts[k], 1) + 1;
    if ((int)k != chosen || (onwards ? n < number : n != number))
        return false;
    atomic_store(&failed, true);
    errno = kinds[k].error;
    return true;
}

__attribute__((constructor)) static void begin(void)
{
    static char out[BUFSIZ];
    const char *text = getenv("INJECT"), *colon = text ? strchr(text, ':') : NULL;
    for (int k = 0; k < KINDS;
         k++) /* what libraries did when they were loaded is not the program's */
        atomic_store(&counts[k], 0);
    atomic_store(&live, 0);
    setvbuf(stdout, out, _IOFBF, sizeof out); /* else its buffer is a block more */
    if (!colon)
        return;
    size_t n = (size_t)(colon - text);
    onwards = n && text[n - 1] == '+';
    n -= onwards;
    for (int k = 0; k < KINDS; k++)
        if (strlen(kinds[k].name) == n && strncmp(kinds[k].name, text, n) == 0)
            chosen = k;
    number = strtol(colon + 1, NULL, 10);
    if (chosen < 0)
        abort();
}

__attribute__((destructor)) static void end(void)
{
    const char *path = getenv("INJECT_LOG");
    long blocks = atomic_load(&live);
    chosen = -1;
    FILE *f = path ? fopen(path, "w") : NULL;
    if (!f)
        return;
    for (int k = 0; k < KINDS; k++)
        fprintf(f, "%s %ld\n", kinds[k].name, atomic_load(&counts[k]));
    fprintf(f, "live %ld\nfailed %d\n", blocks, atomic_load(&failed));
    fclose(f);
}

/* The real function of a name. */
#define NEXT(type, name, args) \
    static type(*next) args;   \
    if (!next)                 \
    *(void **)&next = dlsym(RTLD_NEXT, #name)

/* ---- memory ---------------------------------------------------------------------------------- */

void *__libc_malloc(size_t n);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *p, size_t n);
void *__libc_memalign(size_t alignment, size_t n);
void __libc_free(void *p);

static void *counted(void *p)
{
    if (p)
        atomic_fetch_add(&live, 1);
    return p;
}

void *malloc(size_t n)
{
    return fails(ALLOC) ? NULL : counted(__libc_malloc(n));
}

void *calloc(size_t n, size_t size)
{
    return fails(ALLOC) ? NULL : counted(__libc_calloc(n, size));
}

void *realloc(void *old, size_t n)
{
    if (fails(ALLOC))
        return NULL;
    void *p = __libc_realloc(old, n);
    return old ? p : counted(p);
}

void *memalign(size_t alignment, size_t n)
{
    return fails(ALLOC) ? NULL : counted(__libc_memalign(alignment, n));
}

void *aligned_alloc(size_t alignment, size_t n)
{
    return memalign(alignment, n);
}

int posix_memalign(void **out, size_t alignment, size_t n)
{
    void *p = memalign(alignment, n);
    if (p)
        *out = p;
    return p ? 0 : ENOMEM;
}

void free(void *p)
{
    if (p)
        atomic_fetch_sub(&live, 1);
    __libc_free(p);
}

/* ---- files ----------------------------------------------------------------------------------- */

int open(const char *path, int flags, ...)
{
    NEXT(int, open, (const char *, int, ...));
    va_list args;
    va_start(args, flags);
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(args, mode_t) : 0;
    va_end(args);
    return fails(OPEN) ? -1 : next(path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...)
{
    NEXT(int, openat, (int, const char *, int, ...));
    va_list args;
    va_start(args, flags);
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(args, mode_t) : 0;
    va_end(args);
    return fails(OPEN) ? -1 : next(folder, path, flags, mode);
}

int mkstemp(char *template)
{
    NEXT(int, mkstemp, (char *));
    return fails(OPEN) ? -1 : next(template);
}

int stat(const char *path, struct stat *st)
{
    NEXT(int, stat, (const char *, struct stat *));
    return fails(STAT) ? -1 : next(path, st);
}

int fstat(int fd, struct stat *st)
{
    NEXT(int, fstat, (int, struct stat *));
    return fails(STAT) ? -1 : next(fd, st);
}

static ssize_t do_read(ssize_t (*next)(int, void *, size_t), int fd, void *p, size_t n)
{
    bool shorter = fails(SHORT_READ) && n > 1;
    if (fails(READ) || fails(READ_INTR))
        return -1;
    return next(fd, p, shorter ? n / 2 < 7 ? 1 : 7 : n);
}

ssize_t read(int fd, void *p, size_t n)
{
    NEXT(ssize_t, read, (int, void *, size_t));
    return do_read(next, fd, p, n);
}

/* What read() becomes under _FORTIFY_SOURCE. */
ssize_t __read_chk(int fd, void *p, size_t n, size_t room);
ssize_t __read_chk(int fd, void *p, size_t n, size_t room)
{
    if (n > room)
        abort();
    return read(fd, p, n);
}

ssize_t write(int fd, const void *p, size_t n)
{
    NEXT(ssize_t, write, (int, const void *, size_t));
    bool shorter = fails(SHORT_WRITE) && n > 1;
    if (fails(WRITE) || fails(SPACE) || fails(WRITE_INTR))
        return -1;
    return next(fd, p, shorter ? n / 2 : n);
}

int fsync(int fd)
{
    NEXT(int, fsync, (int));
    return fails(SYNC) ? -1 : next(fd);
}

int fdatasync(int fd)
{
    NEXT(int, fdatasync, (int));
    return fails(SYNC) ? -1 : next(fd);
}

/* The descriptor is closed, as Linux does. */
int close(int fd)
{
    NEXT(int, close, (int));
    bool failing = fails(CLOSE);
    int result = next(fd);
    errno = failing ? kinds[CLOSE].error : errno;
    return failing ? -1 : result;
}

int fchmod(int fd, mode_t mode)
{
    NEXT(int, fchmod, (int, mode_t));
    return fails(CHMOD) ? -1 : next(fd, mode);
}

int rename(const char *from, const char *to)
{
    NEXT(int, rename, (const char *, const char *));
    return fails(RENAME) ? -1 : next(from, to);
}

/* ---- threads --------------------------------------------------------------------------------- */

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *),
                   void *argument)
{
    NEXT(int, pthread_create, (pthread_t *, const pthread_attr_t *, void *(*)(void *), void *));
    return fails(THREAD) ? kinds[THREAD].error : next(thread, attributes, start, argument);
}
