/* Tests with files in a folder of their own. */
#ifndef WRT_TESTS_FOLDER_H
#define WRT_TESTS_FOLDER_H

/* Made, and made the current one; removed with the files of these names. */
struct folder {
    char path[64];
};
void folder_enter(struct folder *f);
void folder_leave(const struct folder *f, const char *const *names, int n);

/* A PNG of 2 x 3 pixels in the current folder: three yellow ones, then three red ones. */
void folder_add_picture(const char *name);

#endif
