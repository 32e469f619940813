/* OFF files, read here and not by OpenMesh, whose readers pass every coordinate through float. */
#include "config.h"

#include "base/num.h"
#include "base/str.h"
#include "scene/mesh.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Bytes of the shortest vertex, "0 0 0\n", and face, "3 0 0 0\n"; the last line may lack the
 * newline. */
enum { VERTEX_BYTES = 6, FACE_BYTES = 8 };

enum { FOUND_LIMIT = 24 }; /* bytes of a word that a message quotes */

struct off {
    const struct source *source;
    struct diag *diag;
    const char *at, *end;
    size_t vertices, faces;
    struct span crowded; /* first vertex line with more than three numbers */
    struct mesh *mesh;
};

/* ---- scanning -------------------------------------------------------------------------------- */

static struct span span_of(const struct off *o, const char *begin, const char *end)
{
    return (struct span){o->source->base + (uint32_t)(begin - o->source->text),
                         o->source->base + (uint32_t)(end - o->source->text)};
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

static bool ends_word(const struct off *o, const char *p)
{
    return p >= o->end || is_blank(*p) || *p == '\n' || *p == '#';
}

static void skip_blanks(struct off *o)
{
    while (o->at < o->end && is_blank(*o->at))
        o->at++;
}

static void skip_line(struct off *o)
{
    const char *newline = memchr(o->at, '\n', (size_t)(o->end - o->at));
    o->at = newline ? newline + 1 : o->end;
}

/* White space, newlines and comments. */
static void skip_space(struct off *o)
{
    for (skip_blanks(o); o->at < o->end; skip_blanks(o)) {
        if (*o->at == '#')
            skip_line(o);
        else if (*o->at == '\n')
            o->at++;
        else
            return;
    }
}

/* True at the end of a line, comments aside. */
static bool at_line_end(struct off *o)
{
    skip_blanks(o);
    return o->at >= o->end || *o->at == '\n' || *o->at == '#';
}

static struct str word_at(const struct off *o)
{
    const char *p = o->at;
    while (!ends_word(o, p))
        p++;
    return (struct str){o->at, (size_t)(p - o->at)};
}

/* ---- errors ---------------------------------------------------------------------------------- */

static bool is_printable(struct str s)
{
    for (size_t i = 0; i < s.n; i++)
        if (s.at[i] <= ' ' || s.at[i] > '~')
            return false;
    return true;
}

/* Vertices with colours or normals behind them, under a plain OFF header, are read as more vertices
 * until something fits no longer: points to where that began.  Returns false. */
static bool misread(const struct off *o, struct diag_entry *e)
{
    if (span_known(o->crowded))
        diag_label(e, o->crowded, "a vertex is three numbers; more follow here");
    return false;
}

/* Reports `what` was expected (with the number of the vertex or face, from 1, if count is not 0)
 * and what is there instead.  Returns false. */
static bool expected(struct off *o, const char *what, size_t number, size_t count)
{
    struct str found = word_at(o);
    struct span span = span_of(o, o->at, o->at + found.n);
    char of[64] = "";
    if (count)
        snprintf(of, sizeof of, " %zu of %zu", number, count);
    struct diag_entry *e;
    if (o->at >= o->end)
        e = diag_report(o->diag, DIAG_MESH_SYNTAX, span, "the file ends before %s%s", what, of);
    else if (found.n == 0)
        e = diag_report(o->diag, DIAG_MESH_SYNTAX, span, "the line ends before %s%s", what, of);
    else if (!is_printable(found))
        e = diag_report(o->diag, DIAG_MESH_SYNTAX, span, "expected %s%s, found no text", what, of);
    else
        e = diag_report(o->diag, DIAG_MESH_SYNTAX, span, "expected %s%s, found '%.*s%s'", what, of,
                        (int)(found.n > FOUND_LIMIT ? FOUND_LIMIT : found.n), found.at,
                        found.n > FOUND_LIMIT ? "..." : "");
    return misread(o, e);
}

/* ---- numbers --------------------------------------------------------------------------------- */

/* The number at the cursor, which moves behind it; false without a report when there is none. */
static bool scan_number(struct off *o, double *out)
{
    const char *after = num_parse(o->at, o->end, out);
    if (!after || !ends_word(o, after))
        return false;
    o->at = after;
    return true;
}

/* A whole number that is not negative.  Nearly all are a few digits. */
static bool scan_count(struct off *o, uint64_t *out)
{
    const char *p = o->at;
    uint64_t n = 0;
    while (p < o->end && *p >= '0' && *p <= '9' && p - o->at < 18)
        n = n * 10 + (uint64_t)(*p++ - '0');
    if (p > o->at && ends_word(o, p)) {
        o->at = p;
        *out = n;
        return true;
    }
    const char *begin = o->at;
    double x;
    if (scan_number(o, &x) && x >= 0 && x < 1e18 && x == floor(x)) {
        *out = (uint64_t)x;
        return true;
    }
    o->at = begin;
    return false;
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

/* Takes the letters of the family off the word; *meaning says what the first ones add. */
static struct str strip_family(struct str word, const char **meaning)
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
    return word;
}

static bool refuse_format(struct off *o, struct str word)
{
    static const struct {
        const char *word, *name;
    } others[] = {{"ply", "PLY"}, {"solid", "STL"}, {"v", "OBJ"}, {"#VRML", "VRML"}};
    struct span span = span_of(o, word.at, word.at + word.n);
    const char *meaning;
    if (str_is(strip_family(word, &meaning), "OFF")) {
        struct diag_entry *e = diag_report(o->diag, DIAG_MESH_FORMAT, span,
                                           "%.*s files are not read; plain OFF is", STR_ARG(word));
        diag_note(e, "the header says that each vertex has %s", meaning);
        return false;
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (str_is(word, others[i].word)) {
            diag_report(o->diag, DIAG_MESH_FORMAT, span, "%s files are not read; OFF is",
                        others[i].name);
            return false;
        }
    }
    diag_report(o->diag, DIAG_MESH_FORMAT, span, "not an OFF file: it does not begin with 'OFF'");
    return false;
}

static bool parse_header(struct off *o)
{
    static const char byte_order_mark[] = "\xEF\xBB\xBF";
    if (o->source->n >= 3 && memcmp(o->at, byte_order_mark, 3) == 0)
        o->at += 3;
    bool vrml = o->end - o->at >= 5 && memcmp(o->at, "#VRML", 5) == 0;
    if (vrml)
        return refuse_format(o, (struct str){o->at, 5});
    skip_space(o);
    struct str word = word_at(o);
    if (!str_is(word, "OFF")) {
        if (o->at < o->end)
            return refuse_format(o, word);
        diag_report(o->diag, DIAG_MESH_FORMAT, span_of(o, o->at, o->at),
                    "not an OFF file: it is empty");
        return false;
    }
    o->at += word.n;
    return true;
}

/* A header can claim anything: nothing is allocated that the rest of the file cannot hold. */
static bool check_counts(struct off *o, struct span span, uint64_t vertices, uint64_t faces)
{
    uint64_t rest = (uint64_t)(o->end - o->at) + 1;
    bool fits = vertices <= rest / VERTEX_BYTES && faces <= rest / FACE_BYTES &&
                vertices * VERTEX_BYTES + faces * FACE_BYTES <= rest;
    o->vertices = (size_t)vertices;
    o->faces = (size_t)faces;
    if (!fits)
        diag_report(o->diag, DIAG_MESH_SYNTAX, span,
                    "the file is too short for these numbers of vertices and faces");
    return fits;
}

/* Vertices, faces and, perhaps, edges (which nobody counts rightly), on one line. */
static bool parse_counts(struct off *o)
{
    uint64_t vertices, faces, edges;
    skip_space(o);
    const char *begin = o->at;
    if (!scan_count(o, &vertices))
        return expected(o, "the number of vertices", 0, 0);
    if (at_line_end(o) || !scan_count(o, &faces))
        return expected(o, "the number of faces", 0, 0);
    struct span span = span_of(o, begin, o->at);
    if (!at_line_end(o) && !scan_count(o, &edges))
        return expected(o, "the number of edges", 0, 0);
    if (!at_line_end(o))
        return expected(o, "the end of the line of counts", 0, 0);
    return check_counts(o, span, vertices, faces);
}

/* ---- vertices and faces ---------------------------------------------------------------------- */

static bool parse_vertex(struct off *o, size_t number)
{
    double xyz[3];
    for (int i = 0; i < 3; i++) {
        skip_space(o);
        const char *begin = o->at;
        if (!scan_number(o, &xyz[i]))
            return expected(o, "a coordinate of vertex", number, o->vertices);
        if (!isfinite(xyz[i])) {
            diag_report(o->diag, DIAG_NOT_FINITE, span_of(o, begin, o->at),
                        "this coordinate is too large");
            return false;
        }
    }
    o->mesh->points.at[o->mesh->points.n++] = vec3(xyz[0], xyz[1], xyz[2]);
    if (!at_line_end(o) && !span_known(o->crowded))
        o->crowded = span_of(o, o->at, o->at + word_at(o).n);
    return true;
}

static bool parse_corner(struct off *o, size_t face, uint32_t *out)
{
    uint64_t index = UINT64_MAX; /* stays for a negative number */
    skip_space(o);
    const char *begin = o->at;
    double negative;
    bool minus = o->at < o->end && *o->at == '-';
    if (minus ? !scan_number(o, &negative) : !scan_count(o, &index))
        return expected(o, "a vertex number of face", face, o->faces);
    if (index < o->vertices) {
        *out = (uint32_t)index;
        return true;
    }
    struct diag_entry *e = diag_report(o->diag, DIAG_MESH_INDEX, span_of(o, begin, o->at),
                                       "there is no vertex %.*s", (int)(o->at - begin), begin);
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
    skip_space(o);
    const char *begin = o->at;
    if (!scan_count(o, &corners))
        return expected(o, "the number of corners of face", number, o->faces);
    if (corners < 3)
        return misread(o, diag_report(o->diag, DIAG_MESH_SYNTAX, span_of(o, begin, o->at),
                                      "a face has at least 3 corners, not %llu",
                                      (unsigned long long)corners));
    struct triangle_corners t = {{0}};
    for (uint64_t i = 0; i < corners; i++) {
        if (!parse_corner(o, number, &t.at[i < 2 ? i : 2]))
            return false;
        if (i < 2)
            continue;
        vec_push(&o->mesh->faces, t);
        t.at[1] = t.at[2];
    }
    skip_line(o);
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
    skip_space(o);
    return o->at >= o->end || expected(o, "the end of the file after the last face", 0, 0);
}

/* ---- binary ---------------------------------------------------------------------------------- */

static bool parse_binary(struct off *o, struct str word)
{
    const uint8_t *end = (const uint8_t *)o->end;
    skip_line(o);
    const uint8_t *begin = (const uint8_t *)o->at;
    const char *reason = off_parse_binary(begin, (size_t)(end - begin), o->mesh);
    if (reason)
        diag_report(o->diag, DIAG_MESH_SYNTAX, span_of(o, word.at, word.at + word.n), "%s", reason);
    return !reason;
}

struct mesh *off_parse(const struct source *source, struct diag *diag)
{
    struct off o = {.source = source, .diag = diag};
    o.at = source->text;
    o.end = source->text + source->n;
    o.mesh = mesh_new();
    bool ok = parse_header(&o);
    if (ok) {
        skip_blanks(&o);
        struct str word = word_at(&o);
        ok = str_is(word, "BINARY") ? parse_binary(&o, word) : parse_text(&o);
    }
    if (ok)
        return o.mesh;
    mesh_free(o.mesh);
    return NULL;
}
