#include "config.h"

#include "base/num.h"
#include "base/str.h"
#include "scene/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of the shortest pair with its newline, "0 0\n"; the last line may lack the newline. */
enum { PAIR_BYTES = 4 };

struct uv_reader {
    const struct source *source;
    struct diag *diag;
    size_t wanted, n; /* pairs */
    struct vec2 *out;
};

static struct span span_of(const struct uv_reader *r, const char *begin, const char *end)
{
    return (struct span){r->source->base + (uint32_t)(begin - r->source->text),
                         r->source->base + (uint32_t)(end - r->source->text)};
}

/* One number and the blanks behind it; NULL after reporting. */
static const char *read_number(struct uv_reader *r, const char *p, const char *end, double *out)
{
    const char *after = num_parse(p, end, out);
    const char *stop = after ? after : p;
    while (stop < end && *stop != ' ' && *stop != '\t')
        stop++;
    if (!after || after != stop) {
        struct diag_entry *e = diag_report(r->diag, DIAG_MESH_SYNTAX, span_of(r, p, stop),
                                           p == end ? "the second number of the pair is missing"
                                                    : "this is not a number");
        diag_note(e, "a line of a UV list is a pair of numbers, 'u v'");
        return NULL;
    }
    if (!isfinite(*out)) {
        diag_report(r->diag, DIAG_NOT_FINITE, span_of(r, p, stop),
                    "this texture coordinate is too large");
        return NULL;
    }
    while (stop < end && (*stop == ' ' || *stop == '\t'))
        stop++;
    return stop;
}

static bool read_line(struct uv_reader *r, struct str line)
{
    const char *p = line.at, *end = line.at + line.n;
    struct vec2 uv;
    if (!(p = read_number(r, p, end, &uv.x)) || !(p = read_number(r, p, end, &uv.y)))
        return false;
    if (p < end) {
        diag_report(r->diag, DIAG_MESH_SYNTAX, span_of(r, p, end),
                    "a line of a UV list is a pair of numbers; this follows them");
        return false;
    }
    if (r->n < r->wanted)
        r->out[r->n] = uv;
    else if (r->n == r->wanted)
        diag_report(r->diag, DIAG_UV_COUNT, span_of(r, line.at, end),
                    "more than the %zu pairs that the mesh's %zu faces need", r->wanted,
                    r->wanted / 3);
    return r->n++ < r->wanted;
}

static bool read_lines(struct uv_reader *r)
{
    const char *p = r->source->text, *end = p + r->source->n;
    while (p < end) {
        const char *newline = memchr(p, '\n', (size_t)(end - p));
        const char *stop = newline ? newline : end;
        struct str line = str_trim((struct str){p, (size_t)(stop - p)});
        if (line.n && !read_line(r, line))
            return false;
        p = newline ? newline + 1 : end;
    }
    return true;
}

static bool report_missing(struct uv_reader *r, const char *how_many)
{
    const char *end = r->source->text + r->source->n;
    struct diag_entry *e = diag_report(r->diag, DIAG_UV_COUNT, span_of(r, end, end),
                                       "the UV list ends after %s %zu pairs", how_many, r->n);
    diag_note(e, "the mesh's %zu faces need %zu, three a face", r->wanted / 3, r->wanted);
    return false;
}

bool uv_list_parse(const struct source *source, size_t faces, struct vec2 **out, struct diag *diag)
{
    struct uv_reader r = {.source = source, .diag = diag};
    size_t most = ((size_t)source->n + 1) / PAIR_BYTES;
    *out = NULL;
    if (faces > SIZE_MAX / 3 || 3 * faces > most) {
        r.n = most;
        r.wanted = faces > SIZE_MAX / 3 ? SIZE_MAX : 3 * faces;
        return report_missing(&r, "at most");
    }
    r.wanted = 3 * faces;
    r.out = mem_alloc(r.wanted, sizeof *r.out);
    bool ok = read_lines(&r);
    if (ok && r.n < r.wanted)
        ok = report_missing(&r, "only");
    if (ok)
        *out = r.out;
    else
        free(r.out);
    return ok;
}
