/* Wavefront OBJ files, read here and not by OpenMesh, whose reader passes every coordinate through
 * float and moves faces about. */
#include "config.h"

#include "scene/mesh.h"
#include "scene/scan.h"

#include <math.h>

/* Where the numbers of a face's corner point: vertex, texture coordinates, normal. */
enum { LIST_VERTEX, LIST_UV, LIST_NORMAL, LISTS };

static const struct {
    const char *none, *many;
} list_names[LISTS] = {
    [LIST_VERTEX] = {"is no vertex", "vertices"},
    [LIST_UV] = {"are no texture coordinates", "texture coordinates"},
    [LIST_NORMAL] = {"is no normal", "normals"},
};

struct corner {
    uint32_t index[LISTS]; /* from 0; MESH_NO_INDEX: not given */
};

/* The largest index into a list and where it is: indexes may run ahead of what they name. */
struct reach {
    uint64_t most; /* index + 1 */
    struct span span;
};

/* Statements that are counted only. */
enum loss { LOSS_NONE, LOSS_SHAPE, LOSS_MATERIAL, LOSS_SMOOTHING, LOSS_UNKNOWN, LOSSES };

struct obj {
    struct scan in;
    struct mesh *mesh;
    VEC(struct vec2) uvs;
    struct corner_list uv_corners; /* by face, into uvs; empty when no face has any */
    VEC(struct corner) polygon;    /* the face being read */
    struct reach reach[LISTS];
    size_t lost[LOSSES];
    struct span first_lost[LOSSES];
};

/* ---- numbers --------------------------------------------------------------------------------- */

/* `least` to `most` numbers to the end of the line.  False after reporting. */
static bool read_numbers(struct obj *o, const char *what, int least, int most, double *out)
{
    int n = 0;
    for (; !scan_at_line_end(&o->in); n++) {
        const char *begin = o->in.at;
        if (n == most || !scan_number(&o->in, &out[n])) {
            scan_expected(&o->in, "%s", n == most ? "the end of the line" : what);
            return false;
        }
        if (!scan_check_finite(&o->in, begin, out[n], "number"))
            return false;
    }
    if (n < least)
        scan_expected(&o->in, "%s", what);
    return n >= least;
}

/* Behind the coordinates a weight, which only curves have use for, or a colour. */
static bool read_vertex(struct obj *o)
{
    enum { MOST = 8 };
    double x[MOST];
    if (!read_numbers(o, "a coordinate of a vertex", 3, MOST, x))
        return false;
    vec_push(&o->mesh->points, vec3(x[0], x[1], x[2]));
    return true;
}

static bool read_uv(struct obj *o)
{
    double x[3] = {0, 0, 0};
    if (!read_numbers(o, "a texture coordinate", 1, 3, x))
        return false;
    vec_push(&o->uvs, (struct vec2){x[0], x[1]});
    return true;
}

static bool read_normal(struct obj *o)
{
    double x[3];
    if (!read_numbers(o, "a coordinate of a normal", 3, 3, x))
        return false;
    vec_push(&o->mesh->normals, mesh_direction(vec3(x[0], x[1], x[2])));
    return true;
}

/* ---- faces ----------------------------------------------------------------------------------- */

static size_t list_length(const struct obj *o, int list)
{
    return list == LIST_VERTEX ? o->mesh->points.n
           : list == LIST_UV   ? o->uvs.n
                               : o->mesh->normals.n;
}

static bool report_index(struct obj *o, int list, struct span span)
{
    struct str text = {o->in.source->text + (span.begin - o->in.source->base),
                       span.end - span.begin};
    struct diag_entry *e = diag_report(o->in.diag, DIAG_MESH_INDEX, span, "there %s %.*s",
                                       list_names[list].none, STR_ARG(text));
    diag_note(e, "the file has %zu %s, counted from 1, or from -1 backwards", list_length(o, list),
              list_names[list].many);
    return false;
}

/* One number of a corner, [p, end): forwards from 1, or backwards from -1, the last one so far. */
static bool read_index(struct obj *o, const char *p, const char *end, int list, uint32_t *out)
{
    struct span span = scan_span(&o->in, p, end);
    bool backwards = p < end && *p == '-';
    uint64_t n = 0, length = list_length(o, list);
    const char *digit = p + backwards;
    bool right = digit < end;
    for (; digit < end; digit++) {
        right = right && *digit >= '0' && *digit <= '9';
        n = n < UINT32_MAX && right ? 10 * n + (uint64_t)(*digit - '0') : n;
    }
    if (!right) {
        scan_expected(&o->in, "a corner of a face: v, v/vt, v//vn or v/vt/vn");
        return false;
    }
    if (n == 0 || n >= UINT32_MAX || (backwards && n > length))
        return report_index(o, list, span);
    *out = (uint32_t)(backwards ? length - n : n - 1);
    if (*out >= o->reach[list].most)
        o->reach[list] = (struct reach){(uint64_t)*out + 1, span};
    return true;
}

/* `v`, `v/vt`, `v//vn` or `v/vt/vn`. */
static bool read_corner(struct obj *o, struct corner *c)
{
    struct str word = scan_word(&o->in);
    const char *p = word.at, *end = word.at + word.n;
    *c = (struct corner){{MESH_NO_INDEX, MESH_NO_INDEX, MESH_NO_INDEX}};
    for (int list = 0; list < LISTS; list++) {
        const char *slash = list < LISTS - 1 ? memchr(p, '/', (size_t)(end - p)) : NULL;
        const char *stop = slash ? slash : end;
        bool skipped = list == LIST_UV && stop == p && slash;
        if (!skipped && !read_index(o, p, stop, list, &c->index[list]))
            return false;
        if (!slash)
            break;
        p = slash + 1;
    }
    o->in.at = end;
    return true;
}

static void pad_corners(struct corner_list *list, size_t faces)
{
    while (list->n < faces)
        vec_push(list, (struct triangle_corners){{MESH_NO_INDEX, MESH_NO_INDEX, MESH_NO_INDEX}});
}

/* Makes `t` the corners of a face; faces before it that have none get MESH_NO_INDEX. */
static void put_corners(struct corner_list *list, size_t face, struct triangle_corners t)
{
    pad_corners(list, face);
    vec_push(list, t);
}

static void add_triangle(struct obj *o, const struct corner *a, const struct corner *b,
                         const struct corner *c)
{
    struct triangle_corners t[LISTS];
    for (int list = 0; list < LISTS; list++)
        t[list] = (struct triangle_corners){{a->index[list], b->index[list], c->index[list]}};
    if (a->index[LIST_UV] != MESH_NO_INDEX)
        put_corners(&o->uv_corners, o->mesh->faces.n, t[LIST_UV]);
    if (a->index[LIST_NORMAL] != MESH_NO_INDEX)
        put_corners(&o->mesh->normal_corners, o->mesh->faces.n, t[LIST_NORMAL]);
    vec_push(&o->mesh->faces, t[LIST_VERTEX]);
}

static bool same_form(const struct corner *a, const struct corner *b)
{
    return (a->index[LIST_UV] == MESH_NO_INDEX) == (b->index[LIST_UV] == MESH_NO_INDEX) &&
           (a->index[LIST_NORMAL] == MESH_NO_INDEX) == (b->index[LIST_NORMAL] == MESH_NO_INDEX);
}

static bool read_corners(struct obj *o)
{
    o->polygon.n = 0;
    while (!scan_at_line_end(&o->in)) {
        struct corner c;
        struct str word = scan_word(&o->in);
        if (!read_corner(o, &c))
            return false;
        if (o->polygon.n && !same_form(&o->polygon.at[0], &c)) {
            diag_report(o->in.diag, DIAG_MESH_SYNTAX, scan_span(&o->in, word.at, word.at + word.n),
                        "the corners of a face must all be of one form: v, v/vt, v//vn or "
                        "v/vt/vn");
            return false;
        }
        vec_push(&o->polygon, c);
    }
    return true;
}

/* Split into triangles around the first corner. */
static bool read_face(struct obj *o)
{
    scan_skip_blanks(&o->in);
    const char *begin = o->in.at;
    if (!read_corners(o))
        return false;
    const struct corner *c = o->polygon.at;
    size_t n = o->polygon.n;
    struct span span = scan_span(&o->in, begin, o->in.at);
    if (n < 3) {
        diag_report(o->in.diag, DIAG_MESH_SYNTAX, span, "a face has at least 3 corners, not %zu",
                    n);
        return false;
    }
    if (c[0].index[LIST_UV] == MESH_NO_INDEX && (o->mesh->bare_faces += n - 2) == n - 2)
        o->mesh->bare = span;
    for (size_t i = 2; i < n; i++)
        add_triangle(o, &c[0], &c[i - 1], &c[i]);
    return true;
}

/* ---- statements ------------------------------------------------------------------------------ */

static const struct statement {
    const char *word;
    bool (*read)(struct obj *o); /* NULL: counted as `loss`, or of no consequence */
    enum loss loss;
} statements[] = {
    {"v", read_vertex, LOSS_NONE},
    {"vt", read_uv, LOSS_NONE},
    {"vn", read_normal, LOSS_NONE},
    {"f", read_face, LOSS_NONE},
    {"fo", read_face, LOSS_NONE}, /* an old spelling */
    {"g", NULL, LOSS_NONE},
    {"o", NULL, LOSS_NONE},
    {"mg", NULL, LOSS_NONE},
    {"s", NULL, LOSS_SMOOTHING},
    {"mtllib", NULL, LOSS_MATERIAL},
    {"usemtl", NULL, LOSS_MATERIAL},
    {"maplib", NULL, LOSS_MATERIAL},
    {"usemap", NULL, LOSS_MATERIAL},
    {"p", NULL, LOSS_SHAPE},
    {"l", NULL, LOSS_SHAPE},
    {"curv", NULL, LOSS_SHAPE},
    {"curv2", NULL, LOSS_SHAPE},
    {"surf", NULL, LOSS_SHAPE},
    {"bzp", NULL, LOSS_SHAPE},
    {"bsp", NULL, LOSS_SHAPE},
    {"cdc", NULL, LOSS_SHAPE},
    {"cdp", NULL, LOSS_SHAPE},
    {"res", NULL, LOSS_SHAPE},
    {"call", NULL, LOSS_SHAPE},
    {"csh", NULL, LOSS_SHAPE},
    /* what only curves and curved surfaces need */
    {"vp", NULL, LOSS_NONE},
    {"cstype", NULL, LOSS_NONE},
    {"deg", NULL, LOSS_NONE},
    {"bmat", NULL, LOSS_NONE},
    {"step", NULL, LOSS_NONE},
    {"parm", NULL, LOSS_NONE},
    {"trim", NULL, LOSS_NONE},
    {"hole", NULL, LOSS_NONE},
    {"scrv", NULL, LOSS_NONE},
    {"sp", NULL, LOSS_NONE},
    {"end", NULL, LOSS_NONE},
    {"con", NULL, LOSS_NONE},
    {"ctech", NULL, LOSS_NONE},
    {"stech", NULL, LOSS_NONE},
    /* how other programs draw */
    {"bevel", NULL, LOSS_NONE},
    {"c_interp", NULL, LOSS_NONE},
    {"d_interp", NULL, LOSS_NONE},
    {"lod", NULL, LOSS_NONE},
    {"shadow_obj", NULL, LOSS_NONE},
    {"trace_obj", NULL, LOSS_NONE},
};

static const struct statement *find_statement(struct str word)
{
    for (size_t i = 0; i < sizeof statements / sizeof *statements; i++)
        if (str_is(word, statements[i].word))
            return &statements[i];
    return NULL;
}

bool obj_is_statement(struct str word)
{
    return find_statement(word) != NULL;
}

static bool read_statement(struct obj *o)
{
    struct str word = scan_word(&o->in);
    const struct statement *s = find_statement(word);
    if (!s && (!word.n || !scan_is_printable(word))) {
        scan_expected(&o->in, "a statement of an OBJ file");
        return false;
    }
    enum loss loss = s ? s->loss : LOSS_UNKNOWN;
    if (loss != LOSS_NONE && o->lost[loss]++ == 0)
        o->first_lost[loss] = scan_span(&o->in, word.at, word.at + word.n);
    o->in.at += word.n;
    if (s && s->read)
        return s->read(o);
    scan_skip_line(&o->in);
    return true;
}

static void report_losses(const struct obj *o)
{
    static const struct {
        enum diag_code code;
        const char *what;
    } losses[LOSSES] = {
        [LOSS_SHAPE] = {DIAG_MESH_LEFT_OUT, "points, lines or curved surfaces are left out: only "
                                            "faces are read; statements"},
        [LOSS_UNKNOWN] = {DIAG_MESH_LEFT_OUT, "statements that OBJ does not have are left out"},
        [LOSS_MATERIAL] = {DIAG_MESH_UNUSED, "the materials are those of the scene, not of the "
                                             "file; statements without effect"},
        [LOSS_SMOOTHING] = {DIAG_MESH_UNUSED, "smoothing is up to 'smooth' and the file's "
                                              "normals; statements without effect"},
    };
    for (int i = 0; i < LOSSES; i++)
        if (losses[i].what && o->lost[i])
            diag_report(o->in.diag, losses[i].code, o->first_lost[i], "%s: %zu", losses[i].what,
                        o->lost[i]);
}

/* ---- the whole file -------------------------------------------------------------------------- */

static void resolve_uvs(struct obj *o)
{
    struct mesh *m = o->mesh;
    pad_corners(&o->uv_corners, m->faces.n);
    vec_reserve(&m->uvs, 3 * m->faces.n);
    for (size_t i = 0; i < 3 * m->faces.n; i++) {
        uint32_t index = o->uv_corners.at[i / 3].at[i % 3];
        m->uvs.at[m->uvs.n++] = index == MESH_NO_INDEX ? (struct vec2){0, 0} : o->uvs.at[index];
    }
}

static bool finish(struct obj *o)
{
    for (int list = 0; list < LISTS; list++)
        if (o->reach[list].most > list_length(o, list))
            return report_index(o, list, o->reach[list].span);
    if (o->uv_corners.n)
        resolve_uvs(o);
    else
        o->mesh->bare_faces = 0;
    if (o->mesh->normal_corners.n)
        pad_corners(&o->mesh->normal_corners, o->mesh->faces.n);
    else
        vec_free(&o->mesh->normals);
    report_losses(o);
    return true;
}

struct mesh *obj_parse(const struct source *source, struct diag *diag)
{
    struct obj o = {.in = scan_of(source, diag), .mesh = mesh_new()};
    o.in.comment = '#';
    o.in.continued = true;
    bool ok = true;
    for (scan_skip_space(&o.in); ok && o.in.at < o.in.end; scan_skip_space(&o.in))
        ok = read_statement(&o);
    ok = ok && finish(&o);
    vec_free(&o.uvs);
    vec_free(&o.uv_corners);
    vec_free(&o.polygon);
    if (ok)
        return o.mesh;
    mesh_free(o.mesh);
    return NULL;
}
