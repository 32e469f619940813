/* PLY files, read here and not by OpenMesh, whose reader passes every coordinate through float,
 * moves faces about and makes no faces of triangle strips. */
#include "config.h"

#include "scene/bytes.h"
#include "scene/ply.h"

#include <math.h>

struct ply {
    struct scan in;
    struct ply_header header;
    struct mesh *mesh;
    VEC(struct vec2) vertex_uvs;
    const char *value_at; /* where the last value of a text began */
    /* The row being read: */
    const struct ply_element *element;
    uint64_t row;            /* from 1 */
    double value[PLY_ROLES]; /* of properties that are no lists */
    VEC(uint32_t) corners;   /* MESH_NO_INDEX: the end of a strip */
    VEC(double) corner_uvs;
};

/* ---- values ---------------------------------------------------------------------------------- */

/* The last value; in a binary body nothing can be pointed at but the header. */
static struct span place_of(const struct ply *p)
{
    return p->header.layout == PLY_TEXT ? scan_span(&p->in, p->value_at, p->in.at)
                                        : p->element->span;
}

static double load(const uint8_t *at, enum ply_type type, bool big_endian)
{
    uint64_t bits = bytes_load(at, ply_sizes[type], big_endian);
    switch (type) {
    case PLY_INT8:
        return (int8_t)bits;
    case PLY_INT16:
        return (int16_t)bits;
    case PLY_INT32:
        return (int32_t)bits;
    case PLY_FLOAT32:
        return bytes_load_float(at, big_endian);
    case PLY_FLOAT64:
        return bytes_load_double(at, big_endian);
    default:
        return (double)bits;
    }
}

static bool read_binary(struct ply *p, enum ply_type type, double *out)
{
    if ((size_t)(p->in.end - p->in.at) < ply_sizes[type]) {
        diag_report(p->in.diag, DIAG_MESH_SYNTAX, p->element->span,
                    "the file ends within %.*s %llu of %llu", STR_ARG(p->element->name),
                    (unsigned long long)p->row, (unsigned long long)p->element->n);
        return false;
    }
    *out = load((const uint8_t *)p->in.at, type, p->header.layout == PLY_BIG_ENDIAN);
    p->in.at += ply_sizes[type];
    return true;
}

static bool read_text(struct ply *p, const struct ply_property *property, double *out)
{
    scan_skip_blanks(&p->in);
    p->value_at = p->in.at;
    if (scan_number(&p->in, out))
        return true;
    scan_expected(&p->in, "'%.*s' of %.*s %llu of %llu", STR_ARG(property->name),
                  STR_ARG(p->element->name), (unsigned long long)p->row,
                  (unsigned long long)p->element->n);
    return false;
}

static bool read_value(struct ply *p, const struct ply_property *property, enum ply_type type,
                       double *out)
{
    return p->header.layout == PLY_TEXT ? read_text(p, property, out) : read_binary(p, type, out);
}

static bool check_finite(const struct ply *p, const struct ply_property *property, double x)
{
    if (isfinite(x))
        return true;
    diag_report(p->in.diag, DIAG_NOT_FINITE, place_of(p), "'%.*s' of %.*s %llu is %s",
                STR_ARG(property->name), STR_ARG(p->element->name), (unsigned long long)p->row,
                isnan(x) ? "not a number" : "too large");
    return false;
}

/* ---- rows ------------------------------------------------------------------------------------ */

static bool take_corner(struct ply *p, double x)
{
    bool ends_strip = p->element->use == PLY_STRIPS && x == -1;
    if (ends_strip || (x >= 0 && x < (double)p->header.vertices && x == floor(x))) {
        vec_push(&p->corners, ends_strip ? MESH_NO_INDEX : (uint32_t)x);
        return true;
    }
    struct diag_entry *e =
        diag_report(p->in.diag, DIAG_MESH_INDEX, place_of(p), "there is no vertex %.17g", x);
    diag_note(e, "the file has %llu vertices, numbered from 0",
              (unsigned long long)p->header.vertices);
    return false;
}

static bool read_list(struct ply *p, const struct ply_property *property)
{
    double n, x;
    if (!read_value(p, property, property->count, &n))
        return false;
    if (!(n >= 0) || n != floor(n)) {
        diag_report(p->in.diag, DIAG_MESH_SYNTAX, place_of(p), "a list cannot have %.17g items", n);
        return false;
    }
    for (double i = 0; i < n; i++) {
        if (!read_value(p, property, property->type, &x))
            return false;
        if (property->role == ROLE_CORNERS && !take_corner(p, x))
            return false;
        if (property->role != ROLE_CORNER_UVS)
            continue;
        if (!check_finite(p, property, x))
            return false;
        vec_push(&p->corner_uvs, x);
    }
    return true;
}

static bool read_row(struct ply *p)
{
    const struct ply_element *e = p->element;
    p->corners.n = p->corner_uvs.n = 0;
    if (p->header.layout == PLY_TEXT)
        scan_skip_space(&p->in);
    for (size_t i = 0; i < e->properties.n; i++) {
        const struct ply_property *property = &e->properties.at[i];
        double x;
        if (property->count != PLY_NONE) {
            if (!read_list(p, property))
                return false;
            continue;
        }
        if (!read_value(p, property, property->type, &x))
            return false;
        if (property->role != ROLE_NONE && !check_finite(p, property, x))
            return false;
        p->value[property->role] = x;
    }
    if (p->header.layout != PLY_TEXT || scan_at_line_end(&p->in))
        return true;
    scan_expected(&p->in, "the end of the line of %.*s %llu of %llu", STR_ARG(e->name),
                  (unsigned long long)p->row, (unsigned long long)e->n);
    return false;
}

/* ---- what rows make -------------------------------------------------------------------------- */

static bool add_vertex(struct ply *p)
{
    const double *v = p->value;
    vec_push(&p->mesh->points, vec3(v[ROLE_X], v[ROLE_Y], v[ROLE_Z]));
    if (ply_has(p->element, ROLE_NX) && ply_has(p->element, ROLE_NY) &&
        ply_has(p->element, ROLE_NZ))
        vec_push(&p->mesh->normals, mesh_direction(vec3(v[ROLE_NX], v[ROLE_NY], v[ROLE_NZ])));
    if (ply_has(p->element, ROLE_U) && ply_has(p->element, ROLE_V))
        vec_push(&p->vertex_uvs, (struct vec2){v[ROLE_U], v[ROLE_V]});
    return true;
}

static bool wrong_row(const struct ply *p, const char *what, size_t n)
{
    diag_report(p->in.diag, DIAG_MESH_SYNTAX, place_of(p), "%.*s %llu has %zu %s",
                STR_ARG(p->element->name), (unsigned long long)p->row, n, what);
    return false;
}

static void pad_uvs(struct mesh *m)
{
    while (m->uvs.n < 3 * m->faces.n)
        vec_push(&m->uvs, (struct vec2){0, 0});
}

/* `uvs`: two numbers a corner of the row, or NULL.  The rest: places in the row. */
static void add_triangle(struct ply *p, const double *uvs, size_t a, size_t b, size_t c)
{
    const uint32_t *v = p->corners.at;
    size_t corners[3] = {a, b, c};
    struct mesh *m = p->mesh;
    if (uvs)
        pad_uvs(m);
    else if (m->bare_faces++ == 0)
        m->bare = place_of(p);
    for (int k = 0; uvs && k < 3; k++)
        vec_push(&m->uvs, (struct vec2){uvs[2 * corners[k]], uvs[2 * corners[k] + 1]});
    vec_push(&m->faces, (struct triangle_corners){{v[a], v[b], v[c]}});
}

/* Split into triangles around the first corner. */
static bool add_face(struct ply *p)
{
    size_t n = p->corners.n, numbers = p->corner_uvs.n;
    if (n < 3)
        return wrong_row(p, "corners; a face has at least 3", n);
    if (numbers != 0 && numbers != 2 * n)
        return wrong_row(p, "texture coordinates; two a corner or none are read", numbers);
    for (size_t i = 2; i < n; i++)
        add_triangle(p, numbers ? p->corner_uvs.at : NULL, 0, i - 1, i);
    return true;
}

/* Every corner from the third on makes a triangle with the two before it; the order alternates, so
 * that all of them turn the same way. */
static bool add_strip(struct ply *p)
{
    size_t first = 0;
    for (size_t i = 0; i < p->corners.n; i++) {
        bool odd = (i - first) % 2 == 1;
        if (p->corners.at[i] == MESH_NO_INDEX)
            first = i + 1;
        else if (i >= first + 2)
            add_triangle(p, NULL, odd ? i - 1 : i - 2, odd ? i - 2 : i - 1, i);
    }
    return true;
}

static bool pass_over(struct ply *p)
{
    (void)p;
    return true;
}

static bool read_element(struct ply *p, const struct ply_element *e)
{
    static bool (*const add[])(struct ply * p) = {
        [PLY_UNUSED] = pass_over,
        [PLY_VERTICES] = add_vertex,
        [PLY_FACES] = add_face,
        [PLY_STRIPS] = add_strip,
    };
    p->element = e;
    for (p->row = 1; e->properties.n && p->row <= e->n; p->row++)
        if (!read_row(p) || !add[e->use](p))
            return false;
    return true;
}

/* ---- the whole file -------------------------------------------------------------------------- */

/* A header can claim anything: nothing is begun that the rest of the file cannot hold. */
static bool check_counts(const struct ply *p)
{
    uint64_t rest = (uint64_t)(p->in.end - p->in.at) + 1;
    for (size_t i = 0; i < p->header.elements.n; i++) {
        const struct ply_element *e = &p->header.elements.at[i];
        uint64_t row = 0;
        for (size_t k = 0; k < e->properties.n; k++) {
            const struct ply_property *q = &e->properties.at[k];
            row += p->header.layout == PLY_TEXT
                       ? 2
                       : ply_sizes[q->count != PLY_NONE ? q->count : q->type];
        }
        if (row == 0 || e->n <= rest / row)
            continue;
        diag_report(p->in.diag, DIAG_MESH_SYNTAX, e->span,
                    "the file is too short for this number of '%.*s' elements", STR_ARG(e->name));
        return false;
    }
    return true;
}

/* The file's texture coordinates by face: those of the faces themselves, or else the vertices'. */
static void settle_uvs(struct ply *p)
{
    struct mesh *m = p->mesh;
    if (m->uvs.n) {
        pad_uvs(m);
        return;
    }
    m->bare_faces = 0;
    for (size_t i = 0; p->vertex_uvs.n && i < 3 * m->faces.n; i++)
        vec_push(&m->uvs, p->vertex_uvs.at[m->faces.at[i / 3].at[i % 3]]);
}

static void settle_normals(struct mesh *m)
{
    for (size_t i = 0; m->normals.n && i < m->faces.n; i++)
        vec_push(&m->normal_corners, m->faces.at[i]);
}

static void report_losses(const struct ply *p)
{
    bool faces = false;
    for (size_t i = 0; i < p->header.elements.n; i++) {
        const struct ply_element *e = &p->header.elements.at[i];
        faces |= e->use == PLY_FACES || e->use == PLY_STRIPS;
        if (e->use == PLY_UNUSED && e->n)
            diag_report(p->in.diag, DIAG_MESH_LEFT_OUT, e->span,
                        "the elements '%.*s' are left out: only faces are read", STR_ARG(e->name));
    }
    for (size_t i = 0; !faces && i < p->header.elements.n; i++)
        if (p->header.elements.at[i].use == PLY_VERTICES)
            diag_report(p->in.diag, DIAG_MESH_LEFT_OUT, p->header.elements.at[i].span,
                        "the vertices are left out: there are no faces");
}

static bool read_body(struct ply *p)
{
    if (!check_counts(p))
        return false;
    for (size_t i = 0; i < p->header.elements.n; i++)
        if (!read_element(p, &p->header.elements.at[i]))
            return false;
    if (p->header.layout == PLY_TEXT)
        scan_skip_space(&p->in);
    if (p->in.at >= p->in.end)
        return true;
    if (p->header.layout == PLY_TEXT)
        scan_expected(&p->in, "the end of the file after the last element");
    else
        diag_report(p->in.diag, DIAG_MESH_SYNTAX, p->element ? p->element->span : (struct span){0},
                    "%zu bytes follow the last element", (size_t)(p->in.end - p->in.at));
    return false;
}

struct mesh *ply_parse(const struct source *source, struct diag *diag)
{
    struct ply p = {.in = scan_of(source, diag), .mesh = mesh_new()};
    bool ok = ply_read_header(&p.in, &p.header) && read_body(&p);
    if (ok) {
        settle_uvs(&p);
        settle_normals(p.mesh);
        report_losses(&p);
    }
    ply_free_header(&p.header);
    vec_free(&p.vertex_uvs);
    vec_free(&p.corners);
    vec_free(&p.corner_uvs);
    if (ok)
        return p.mesh;
    mesh_free(p.mesh);
    return NULL;
}
