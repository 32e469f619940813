#include "config.h"

#include "lsp/uri.h"

#include "base/mem.h"

#include <stdlib.h>
#include <unistd.h>

static int hex(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* An escaped byte, which is none within a path when it is zero; -1: none is there. */
static int escaped(const char *p)
{
    int high = p[0] == '%' ? hex(p[1]) : -1;
    int low = high >= 0 ? hex(p[2]) : -1;
    return low < 0 || high * 16 + low == 0 ? -1 : high * 16 + low;
}

char *uri_to_path(const char *uri)
{
    const char *p = uri;
    bool file = strncmp(uri, "file:", 5) == 0;
    if (file && strncmp(p += 5, "//", 2) == 0)
        p += 2 + strcspn(p + 2, "/"); /* the host */
    char *path = mem_alloc(strlen(p) + 1, 1), *to = path;
    while (*p) {
        int byte = file ? escaped(p) : -1;
        *to++ = byte < 0 ? *p : (char)byte;
        p += byte < 0 ? 1 : 3;
    }
    *to = 0;
    return path;
}

static bool is_plain(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           (c && strchr("-._~/", c));
}

static void add_path(struct buffer *out, const char *path)
{
    for (; *path; path++)
        if (is_plain(*path))
            buffer_add(out, path, 1);
        else
            buffer_printf(out, "%%%02X", (unsigned char)*path);
}

void uri_add(struct buffer *out, const char *path)
{
    char *folder = path[0] == '/' ? NULL : getcwd(NULL, 0);
    buffer_puts(out, "file://");
    if (folder) {
        add_path(out, folder);
        buffer_puts(out, "/");
    }
    add_path(out, path);
    free(folder);
}
