/* The language server's client. */
#include "config.h"

#include "fuzz.h"

#include "base/fence.h"
#include "lsp/lsp.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { MAX_OBJECTS = 200 };

static char nowhere[] = "";
static const struct file_fence closed = {.folder = nowhere, .real = nowhere, .fd = -1};

static void serve(const char *bytes, size_t n)
{
    struct diag_policy policy = {.lint = true};
    struct lsp_options options = {.policy = &policy, .max_objects = MAX_OBJECTS, .fence = &closed};
    struct buffer problem = {0};
    int in = memfd_create("client", MFD_CLOEXEC), out = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (in < 0 || out < 0 || write(in, bytes, n) != (ssize_t)n || lseek(in, 0, SEEK_SET) != 0)
        exit(3);
    lsp_serve(in, out, &options, &problem);
    buffer_free(&problem);
    close(in);
    close(out);
}

void fuzz_frames(const uint8_t *data, size_t n)
{
    serve((const char *)data, n);
}

static void add_frame(struct buffer *out, const char *body, size_t n)
{
    buffer_printf(out, "Content-Length: %zu\r\n\r\n", n);
    buffer_add(out, body, n);
}

void fuzz_messages(const uint8_t *data, size_t n)
{
    static const char first[] =
        "{\"jsonrpc\":\"2.0\",\"id\":0,\"method\":\"initialize\",\"params\":{\"capabilities\":{}}}";
    struct buffer stream = {0};
    add_frame(&stream, first, sizeof first - 1);
    for (const char *at = (const char *)data, *end = at + n; at < end;) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        stop = stop ? stop : end;
        add_frame(&stream, at, (size_t)(stop - at));
        at = stop + 1;
    }
    serve(stream.at, stream.n);
    buffer_free(&stream);
}

void words_lsp(struct buffer *out)
{
    static const char *const words[] = {
#define REQUEST(name, function) name,
#define NOTIFICATION(name, function) name,
#include "lsp/methods.def"
#undef REQUEST
#undef NOTIFICATION
        "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"",
        "\"params\":{",
        "\"textDocument\":{\"uri\":\"file:///a.wrt\"}",
        "\"position\":{\"line\":0,\"character\":0}",
        "\"range\":{\"start\":",
        "\"contentChanges\":[",
        "\"text\":\"",
        "\"version\":",
        "\"newName\":\"",
        "\\ud83d\\ude00",
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        buffer_add(out, words[i], strlen(words[i]) + 1);
}
