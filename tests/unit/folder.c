#include "config.h"

#include "folder.h"

#include "base/file.h"
#include "image/picture.h"

#include <check.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void folder_enter(struct folder *f)
{
    strcpy(f->path, "/tmp/wrt-unit.XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(f->path));
    ck_assert_int_eq(chdir(f->path), 0);
}

void folder_leave(const struct folder *f, const char *const *names, int n)
{
    for (int i = 0; i < n; i++)
        unlink(names[i]);
    ck_assert_int_eq(chdir("/"), 0);
    ck_assert_int_eq(rmdir(f->path), 0);
}

void folder_add_picture(const char *name)
{
    struct picture *p = picture_new(2, 3, PICTURE_BYTES);
    for (uint32_t i = 0; i < 6; i++)
        picture_set(p, i % 2, i / 2, vec3(1, i < 3, 0));
    char why[IMAGE_REASON_BYTES];
    size_t n;
    void *png = picture_encode(p, PICTURE_PNG, &n, why);
    ck_assert_ptr_null(file_write(name, png, n));
    free(png);
    picture_free(p);
}
