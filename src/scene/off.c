/* OFF files, read here and not by OpenMesh, whose readers pass every coordinate through float. */
#include "config.h"

#include "scene/mesh.h"
#include "scene/scan.h"

#include <string.h>

/* Bytes of the shortest vertex, "0 0 0\n", and face, "3 0 0 0\n"; the last line may lack the
 * newline. */
enum { VERTEX_BYTES = 6, FACE_BYTES = 8 };

struct off {
    struct scan in;
    size_t vertices, faces;
    struct span crowded; /* first vertex line with more than three numbers */
    struct mesh *mesh;
};

/* ---- errors ---------------------------------------------------------------------------------- */

/* Vertices with colours or normals behind them, under a plain OFF header, are read as more vertices
 * until something fits no longer: points to where that began.  Returns false. */
static bool misread(const struct off *o, struct diag_entry *e)
{
    if (span_known(o->crowded))
        diag_label(e, o->crowded, "a vertex is three numbers; more follow here");
    return false;
}

/* Reports what was expected: `what`, with the number of the vertex or face, from 1, if count is not
 * 0.  Returns false. */
static bool expected(struct off *o, const char *what, size_t number, size_t count)
{
    return misread(o, count ? scan_expected(&o->in, "%s %zu of %zu", what, number, count)
                            : scan_expected(&o->in, "%s", what));
}

/* ---- header ---------------------------------------------------------------------------------- */

/* What the letters before OFF add to each vertex, in the order they may stand. */
static const struct {
    const char *letters, *meaning;
} family[] = {
    {"ST", "texture coordinates"},
    {"C", "colours"},
    {"N", "normals"},
    {"4", "a fourth coordinate"},
    {"n", "another number of coordinates"},
};

bool off_is_header(struct str word, const char **meaning)
{
    *meaning = NULL;
    for (size_t i = 0; i < sizeof family / sizeof *family; i++) {
        struct str letters = str_of(family[i].letters);
        if (word.n < letters.n || memcmp(word.at, letters.at, letters.n) != 0)
            continue;
        word.at += letters.n;
        word.n -= letters.n;
        if (!*meaning)
            *meaning = family[i].meaning;
    }
    return str_is(word, "OFF");
}

static bool refuse_format(struct off *o, struct str word)
{
    struct span span = scan_span(&o->in, word.at, word.at + word.n);
    const char *meaning;
    if (off_is_header(word, &meaning)) {
        struct diag_entry *e = diag_report(o->in.diag, DIAG_MESH_FORMAT, span,
                                           "%.*s files are not read; plain OFF is", STR_ARG(word));
        diag_note(e, "the header says that each vertex has %s", meaning);
        return false;
    }
    diag_report(o->in.diag, DIAG_MESH_FORMAT, span,
                "not an OFF file: it does not begin with 'OFF'");
    return false;
}

static bool parse_header(struct off *o)
{
    scan_skip_space(&o->in);
    struct str word = scan_word(&o->in);
    if (!str_is(word, "OFF"))
        return refuse_format(o, word);
    o->in.at += word.n;
    return true;
}

/* A header can claim anything: nothing is allocated that the rest of the file cannot hold. */
static bool check_counts(struct off *o, struct span span, uint64_t vertices, uint64_t faces)
{
    uint64_t rest = (uint64_t)(o->in.end - o->in.at) + 1;
    bool fits = vertices <= rest / VERTEX_BYTES && faces <= rest / FACE_BYTES &&
                vertices * VERTEX_BYTES + faces * FACE_BYTES <= rest;
    o->vertices = (size_t)vertices;
    o->faces = (size_t)faces;
    if (!fits)
        diag_report(o->in.diag, DIAG_MESH_SYNTAX, span,
                    "the file is too short for these numbers of vertices and faces");
    return fits;
}

/* Vertices, faces and, perhaps, edges (which nobody counts rightly), on one line. */
static bool parse_counts(struct off *o)
{
    uint64_t vertices, faces, edges;
    scan_skip_space(&o->in);
    const char *begin = o->in.at;
    if (!scan_count(&o->in, &vertices))
        return expected(o, "the number of vertices", 0, 0);
    if (scan_at_line_end(&o->in) || !scan_count(&o->in, &faces))
        return expected(o, "the number of faces", 0, 0);
    struct span span = scan_span(&o->in, begin, o->in.at);
    if (!scan_at_line_end(&o->in) && !scan_count(&o->in, &edges))
        return expected(o, "the number of edges", 0, 0);
    if (!scan_at_line_end(&o->in))
        return expected(o, "the end of the line of counts", 0, 0);
    return check_counts(o, span, vertices, faces);
}

/* ---- vertices and faces ---------------------------------------------------------------------- */

static bool parse_vertex(struct off *o, size_t number)
{
    double xyz[3];
    for (int i = 0; i < 3; i++) {
        scan_skip_space(&o->in);
        const char *begin = o->in.at;
        if (!scan_number(&o->in, &xyz[i]))
            return expected(o, "a coordinate of vertex", number, o->vertices);
        if (!scan_check_finite(&o->in, begin, xyz[i], "coordinate"))
            return false;
    }
    o->mesh->points.at[o->mesh->points.n++] = vec3(xyz[0], xyz[1], xyz[2]);
    if (!scan_at_line_end(&o->in) && !span_known(o->crowded))
        o->crowded = scan_span(&o->in, o->in.at, o->in.at + scan_word(&o->in).n);
    return true;
}

static bool parse_corner(struct off *o, size_t face, uint32_t *out)
{
    uint64_t index = UINT64_MAX; /* stays for a negative number */
    scan_skip_space(&o->in);
    const char *begin = o->in.at;
    double negative;
    bool minus = o->in.at < o->in.end && *o->in.at == '-';
    if (minus ? !scan_number(&o->in, &negative) : !scan_count(&o->in, &index))
        return expected(o, "a vertex number of face", face, o->faces);
    if (index < o->vertices) {
        *out = (uint32_t)index;
        return true;
    }
    struct diag_entry *e =
        diag_report(o->in.diag, DIAG_MESH_INDEX, scan_span(&o->in, begin, o->in.at),
                    "there is no vertex %.*s", (int)(o->in.at - begin), begin);
    if (o->vertices)
        diag_note(e, "the file has %zu vertices, numbered from 0 to %zu", o->vertices,
                  o->vertices - 1);
    else
        diag_note(e, "the file has no vertices");
    return misread(o, e);
}

/* `k a b c ...`, split into k - 2 triangles around a; what follows on the line is a colour. */
static bool parse_face(struct off *o, size_t number)
{
    uint64_t corners;
    scan_skip_space(&o->in);
    const char *begin = o->in.at;
    if (!scan_count(&o->in, &corners))
        return expected(o, "the number of corners of face", number, o->faces);
    if (corners < 3)
        return misread(
            o, diag_report(o->in.diag, DIAG_MESH_SYNTAX, scan_span(&o->in, begin, o->in.at),
                           "a face has at least 3 corners, not %llu", (unsigned long long)corners));
    struct triangle_corners t = {{0}};
    for (uint64_t i = 0; i < corners; i++) {
        if (!parse_corner(o, number, &t.at[i < 2 ? i : 2]))
            return false;
        if (i < 2)
            continue;
        vec_push(&o->mesh->faces, t);
        t.at[1] = t.at[2];
    }
    scan_skip_line(&o->in);
    return true;
}

static bool parse_text(struct off *o)
{
    if (!parse_counts(o))
        return false;
    vec_reserve(&o->mesh->points, o->vertices);
    vec_reserve(&o->mesh->faces, o->faces);
    for (size_t i = 1; i <= o->vertices; i++)
        if (!parse_vertex(o, i))
            return false;
    for (size_t i = 1; i <= o->faces; i++)
        if (!parse_face(o, i))
            return false;
    scan_skip_space(&o->in);
    return o->in.at >= o->in.end || expected(o, "the end of the file after the last face", 0, 0);
}

/* ---- binary ---------------------------------------------------------------------------------- */

static bool parse_binary(struct off *o, struct str word)
{
    const uint8_t *end = (const uint8_t *)o->in.end;
    scan_skip_line(&o->in);
    const uint8_t *begin = (const uint8_t *)o->in.at;
    const char *reason = off_parse_binary(begin, (size_t)(end - begin), o->mesh);
    if (reason)
        diag_report(o->in.diag, DIAG_MESH_SYNTAX, scan_span(&o->in, word.at, word.at + word.n),
                    "%s", reason);
    return !reason;
}

struct mesh *off_parse(const struct source *source, struct diag *diag)
{
    struct off o = {.in = scan_of(source, diag), .mesh = mesh_new()};
    o.in.comment = '#';
    bool ok = parse_header(&o);
    if (ok) {
        scan_skip_blanks(&o.in);
        struct str word = scan_word(&o.in);
        ok = str_is(word, "BINARY") ? parse_binary(&o, word) : parse_text(&o);
    }
    if (ok)
        return o.mesh;
    mesh_free(o.mesh);
    return NULL;
}
