/* Whole files in and out. */
#ifndef WRT_BASE_FILE_H
#define WRT_BASE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct file_fence;

/* Files larger than this are refused: offsets within all texts of a run are 32-bit. */
#define FILE_SIZE_LIMIT ((size_t)2000 * 1000 * 1000)

/* Reads a file, or standard input for "-".  On success *data (caller frees) holds *n bytes and
 * room for two more.  On failure returns a reason such as "No such file or directory": a string
 * that needs no freeing.  For files that the user names. */
const char *file_read(const char *path, char **data, size_t *n);

/* The same for a file that may lie inside of the fence only; NULL: anywhere.  For whatever a scene
 * names, and scenes. */
const char *file_read_within(const struct file_fence *fence, const char *path, char **data,
                             size_t *n);

/* True when path names a file inside of the fence (NULL: anywhere) that can be read; *reason says
 * why not. */
bool file_readable(const struct file_fence *fence, const char *path, const char **reason);

/* The name of another file in the folder of `path` that differs from it only in the case of
 * letters, with the folder as spelt in `path`; NULL when there is none.  Caller frees. */
char *file_other_case(const char *path);

/* The path of an existing file that differs from `path`, behind its first `from` bytes, only in the
 * case of letters and in `\\` for `/`, and lies inside of the fence; NULL when there is none.  As
 * long as `path`; caller frees. */
char *file_meant(const struct file_fence *fence, const char *path, size_t from);

/* The path of a file in the folder of `path` whose name is near to that one's, and that can be read
 * inside of the fence: for "did you mean".  NULL when there is none.  Caller frees. */
char *file_nearest(const struct file_fence *fence, const char *path);

/* Writes n bytes so that path holds either its old content or all of the new: a temporary file
 * beside it is renamed.  A path that exists and is no regular file (a device, a pipe), and "-" for
 * standard output, is written directly.  Returns NULL or a reason. */
const char *file_write(const char *path, const void *data, size_t n);

/* Writes all n bytes to an open file, and returns NULL or a reason. */
const char *file_put(int fd, const void *data, size_t n);

/* The path of `name` as spelt in a file at `beside`: relative names start at its folder, or at the
 * current one when that spells none.  A file called "-" is itself.  Caller frees. */
char *file_resolve(const char *beside, const char *name, size_t name_length);

/* The path of an existing file as one spells it in the file `beside`, which may not exist yet: the
 * opposite of file_resolve.  An absolute path stays, and so does one whose folders cannot be told.
 * Caller frees. */
char *file_relative(const char *beside, const char *path);

/* The relative `name` as spelt in a file at `from`, for one at `to`: from the folder of one to that
 * of the other, then the name.  NULL when it stays the same: the name is absolute, or the folders
 * are one (or cannot be told).  Caller frees. */
char *file_relocate(const char *from, const char *to, const char *name, size_t name_length);

/* True when the two paths lie in one folder, as far as can be told. */
bool file_same_folder(const char *a, const char *b);

/* True when both paths name one file, whether it is there yet or not. */
bool file_same(const char *a, const char *b);

/* Identity of an existing file, to load each one once; false when it cannot be told. */
struct file_id {
    uint64_t device, inode;
};
bool file_identify(const char *path, struct file_id *id);

#endif
