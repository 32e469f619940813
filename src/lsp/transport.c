#include "config.h"

#include "lsp/transport.h"

#include "base/mem.h"

#include <errno.h>
#include <poll.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

void transport_init(struct transport *t, int in, int out)
{
    *t = (struct transport){.in = in, .out = out};
}

void transport_free(struct transport *t)
{
    buffer_free(&t->input);
}

/* ---- bytes ----------------------------------------------------------------------------------- */

static bool has_input(const struct transport *t)
{
    struct pollfd p = {.fd = t->in, .events = POLLIN};
    return poll(&p, 1, 0) > 0;
}

static void drop_taken(struct transport *t)
{
    t->input.n -= t->at;
    memmove(t->input.at, t->input.at + t->at, t->input.n);
    t->at = 0;
}

bool transport_read(struct transport *t, bool wait)
{
    char bytes[1 << 16];
    if (t->ended || (!wait && !has_input(t)))
        return false;
    ssize_t n;
    do
        n = read(t->in, bytes, sizeof bytes);
    while (n < 0 && errno == EINTR);
    if (n <= 0) {
        t->ended = true;
        t->error = n < 0 ? errno : t->error;
        return false;
    }
    if (t->at)
        drop_taken(t);
    size_t skipped = t->skip < (size_t)n ? t->skip : (size_t)n;
    t->skip -= skipped;
    buffer_add(&t->input, bytes + skipped, (size_t)n - skipped);
    return true;
}

/* ---- frames ---------------------------------------------------------------------------------- */

struct header {
    size_t bytes; /* of the header itself, with the empty line */
    size_t length;
    bool has_length;
};

/* Digits only; a number too long to be one is as good as the largest. */
static bool read_length(struct str text, size_t *out)
{
    size_t x = 0;
    for (size_t i = 0; i < text.n; i++) {
        if (text.at[i] < '0' || text.at[i] > '9')
            return false;
        x = x > SIZE_MAX / 16 ? SIZE_MAX / 16 : x * 10 + (size_t)(text.at[i] - '0');
    }
    *out = x;
    return text.n > 0;
}

/* One field, without the end of its line; NULL or what is wrong. */
static const char *read_field(struct str line, struct header *h)
{
    const char *colon = memchr(line.at, ':', line.n);
    if (!colon)
        return "a line of a message's header has no ':'";
    struct str name = {line.at, (size_t)(colon - line.at)};
    struct str value = str_trim((struct str){colon + 1, line.n - name.n - 1});
    if (!str_equal_nocase(name, str_of("Content-Length")))
        return NULL;
    if (h->has_length)
        return "a message's header has two lengths";
    h->has_length = true;
    return read_length(value, &h->length) ? NULL : "the Content-Length of a message is no number";
}

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/* Reads lines as far as they are complete, so that what is no header is known at once. */
static enum transport_result read_header(struct str text, struct header *h, const char **problem)
{
    *h = (struct header){0};
    while (h->bytes < text.n) {
        const char *line = text.at + h->bytes, *end = memchr(line, '\n', text.n - h->bytes);
        *problem = !is_letter(*line) && *line != '\r' ? "a message does not begin with a header"
                   : (end ? (size_t)(end - text.at) : text.n) > TRANSPORT_HEADER_LIMIT
                       ? "the header of a message does not end"
                   : end && (end == line || end[-1] != '\r')
                       ? "a line of a message's header does not end with CR LF"
                       : NULL;
        if (*problem)
            return TRANSPORT_BROKEN;
        if (!end)
            return TRANSPORT_NOTHING;
        h->bytes = (size_t)(end + 1 - text.at);
        if (end - 1 == line) {
            *problem = h->has_length ? NULL : "a message's header has no Content-Length";
            return h->has_length ? TRANSPORT_MESSAGE : TRANSPORT_BROKEN;
        }
        *problem = read_field((struct str){line, (size_t)(end - 1 - line)}, h);
        if (*problem)
            return TRANSPORT_BROKEN;
    }
    return TRANSPORT_NOTHING;
}

/* What is incomplete stays so when the input has ended. */
static enum transport_result nothing_yet(const struct transport *t, const char **problem)
{
    if (!t->ended)
        return TRANSPORT_NOTHING;
    *problem = "the input ends within a message";
    return t->at == t->input.n && !t->skip ? TRANSPORT_END : TRANSPORT_BROKEN;
}

enum transport_result transport_take(struct transport *t, struct str *body, const char **problem)
{
    struct header h;
    if (t->at == t->input.n)
        return nothing_yet(t, problem);
    struct str rest = {t->input.at + t->at, t->input.n - t->at};
    enum transport_result result = read_header(rest, &h, problem);
    if (result == TRANSPORT_NOTHING)
        return nothing_yet(t, problem);
    if (result == TRANSPORT_BROKEN)
        return result;
    size_t here = rest.n - h.bytes;
    if (h.length > TRANSPORT_MESSAGE_LIMIT) {
        size_t now = h.length < here ? h.length : here;
        t->skip = h.length - now;
        t->at += h.bytes + now;
        return TRANSPORT_TOO_LARGE;
    }
    if (h.length > here)
        return nothing_yet(t, problem);
    *body = (struct str){rest.at + h.bytes, h.length};
    t->at += h.bytes + h.length;
    return TRANSPORT_MESSAGE;
}

/* ---- output ---------------------------------------------------------------------------------- */

static bool write_all(int fd, const char *p, size_t n)
{
    while (n) {
        ssize_t written = write(fd, p, n);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return false;
        p += written;
        n -= (size_t)written;
    }
    return true;
}

bool transport_send(struct transport *t, const json_t *message)
{
    struct buffer frame = {0};
    char *text = json_dumps(message, JSON_COMPACT);
    if (!text)
        mem_exhausted(0);
    /* cppcheck-suppress nullPointerRedundantCheck */
    size_t n = strlen(text);
    buffer_printf(&frame, "Content-Length: %zu\r\n\r\n", n);
    buffer_add(&frame, text, n);
    bool sent = write_all(t->out, frame.at, frame.n);
    t->error = sent ? t->error : errno;
    buffer_free(&frame);
    free(text);
    return sent;
}
