/* STL files, read here and not by OpenMesh, whose reader moves faces about.
 *
 * STL has no vertex numbers: corners of equal coordinates are made one vertex, so that normals can
 * be interpolated.  The facets' own normals say nothing that their corners do not. */
#include "config.h"

#include "scene/bytes.h"
#include "scene/mesh.h"
#include "scene/scan.h"

#include <math.h>

/* Binary: a comment, the number of triangles, and for each of them a normal, three corners and two
 * bytes without meaning. */
enum { HEADER_BYTES = 80, START_BYTES = 84, NORMAL_BYTES = 12, FACET_BYTES = 50 };

/* ---- equal vertices -------------------------------------------------------------------------- */

/* Vertices by their coordinates: a hash table with open addressing, at most half full. */
struct welder {
    struct mesh *mesh;
    uint32_t *slots; /* vertex + 1, or 0 */
    size_t size;     /* a power of two */
};

static uint64_t hash_of(struct vec3 p)
{
    double xyz[3] = {p.x, p.y, p.z};
    uint64_t h = 0;
    for (int i = 0; i < 3; i++) {
        uint64_t bits;
        memcpy(&bits, &xyz[i], sizeof bits);
        h = (h ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
        h ^= h >> 32;
    }
    return h;
}

/* Where the vertex is, or the free slot where it should be. */
static uint32_t *slot_of(const struct welder *w, struct vec3 p)
{
    const struct vec3 *points = w->mesh->points.at;
    size_t i = hash_of(p) & (w->size - 1);
    for (; w->slots[i]; i = (i + 1) & (w->size - 1)) {
        struct vec3 q = points[w->slots[i] - 1];
        if (p.x == q.x && p.y == q.y && p.z == q.z)
            break;
    }
    return &w->slots[i];
}

static void grow(struct welder *w)
{
    free(w->slots);
    w->size = w->size ? 2 * w->size : 1024;
    w->slots = mem_zalloc(w->size, sizeof *w->slots);
    for (uint32_t i = 0; i < w->mesh->points.n; i++)
        *slot_of(w, w->mesh->points.at[i]) = i + 1;
}

/* The number of the vertex with these coordinates.  -0 is 0. */
static uint32_t weld(struct welder *w, struct vec3 p)
{
    p = vec3_add(p, vec3_all(0));
    if (2 * w->mesh->points.n >= w->size)
        grow(w);
    uint32_t *slot = slot_of(w, p);
    if (*slot == 0) {
        vec_push(&w->mesh->points, p);
        *slot = (uint32_t)w->mesh->points.n;
    }
    return *slot - 1;
}

/* ---- binary ---------------------------------------------------------------------------------- */

static uint64_t counted(const struct source *source)
{
    const uint8_t *bytes = (const uint8_t *)source->text;
    return source->n >= START_BYTES ? bytes_load(bytes + HEADER_BYTES, 4, false) : 0;
}

bool stl_is_binary(const struct source *source)
{
    return source->n >= START_BYTES && source->n - START_BYTES == FACET_BYTES * counted(source);
}

static bool read_facet(struct welder *w, const uint8_t *at, size_t number, const struct scan *in)
{
    struct triangle_corners t;
    for (int i = 0; i < 3; i++) {
        double xyz[3];
        for (int k = 0; k < 3; k++) {
            xyz[k] = bytes_load_float(at + NORMAL_BYTES + 12 * i + 4 * k, false);
            if (isfinite(xyz[k]))
                continue;
            diag_report(in->diag, DIAG_NOT_FINITE, scan_span(in, in->at, in->at),
                        "a coordinate of triangle %zu of this binary STL file is %s", number,
                        isnan(xyz[k]) ? "not a number" : "too large");
            return false;
        }
        t.at[i] = weld(w, vec3(xyz[0], xyz[1], xyz[2]));
    }
    vec_push(&w->mesh->faces, t);
    return true;
}

static bool read_binary(struct welder *w, const struct scan *in)
{
    uint64_t n = counted(in->source);
    if (!stl_is_binary(in->source)) {
        struct span start = scan_span(in, in->at, in->at);
        struct diag_entry *e =
            diag_report(in->diag, DIAG_MESH_SYNTAX, start, "neither a text nor a binary STL file");
        diag_note(e,
                  "text begins with 'solid'; a binary file of %u bytes cannot hold the %llu "
                  "triangles it counts",
                  in->source->n, (unsigned long long)n);
        return false;
    }
    const uint8_t *at = (const uint8_t *)in->source->text + START_BYTES;
    for (uint64_t i = 0; i < n; i++)
        if (!read_facet(w, at + FACET_BYTES * i, (size_t)i + 1, in))
            return false;
    return true;
}

/* ---- text ------------------------------------------------------------------------------------ */

static bool take_word(struct scan *in, const char *wanted)
{
    scan_skip_space(in);
    struct str word = scan_word(in);
    if (!str_equal_nocase(word, str_of(wanted)))
        return false;
    in->at += word.n;
    return true;
}

static bool demand_word(struct scan *in, const char *wanted)
{
    if (take_word(in, wanted))
        return true;
    scan_expected(in, "'%s'", wanted);
    return false;
}

static bool read_point(struct scan *in, const char *what, struct vec3 *out)
{
    double xyz[3];
    for (int i = 0; i < 3; i++) {
        scan_skip_blanks(in);
        const char *begin = in->at;
        if (!scan_number(in, &xyz[i])) {
            scan_expected(in, "a coordinate of a %s", what);
            return false;
        }
        if (!scan_check_finite(in, begin, xyz[i], "coordinate"))
            return false;
    }
    *out = vec3(xyz[0], xyz[1], xyz[2]);
    return true;
}

static void skip_word(struct scan *in)
{
    scan_skip_blanks(in);
    in->at += scan_word(in).n;
}

/* Behind `facet`. */
static bool read_text_facet(struct scan *in, struct welder *w)
{
    struct vec3 p;
    struct triangle_corners t;
    if (take_word(in, "normal")) /* not looked at: some programs write nan */
        for (int i = 0; i < 3; i++)
            skip_word(in);
    if (!demand_word(in, "outer") || !demand_word(in, "loop"))
        return false;
    for (int i = 0; i < 3; i++) {
        if (!demand_word(in, "vertex") || !read_point(in, "vertex", &p))
            return false;
        t.at[i] = weld(w, p);
    }
    vec_push(&w->mesh->faces, t);
    return demand_word(in, "endloop") && demand_word(in, "endfacet");
}

static bool read_text(struct scan *in, struct welder *w)
{
    while (take_word(in, "solid")) {
        scan_skip_line(in); /* its name */
        while (take_word(in, "facet"))
            if (!read_text_facet(in, w))
                return false;
        if (!demand_word(in, "endsolid"))
            return false;
        scan_skip_line(in);
    }
    if (in->at >= in->end)
        return true;
    scan_expected(in, "'solid'");
    return false;
}

struct mesh *stl_parse(const struct source *source, struct diag *diag)
{
    struct scan in = scan_of(source, diag);
    struct welder w = {.mesh = mesh_new()};
    struct scan start = in;
    bool text = !stl_is_binary(source) && take_word(&start, "solid");
    bool ok = text ? read_text(&in, &w) : read_binary(&w, &in);
    free(w.slots);
    if (ok)
        return w.mesh;
    mesh_free(w.mesh);
    return NULL;
}
