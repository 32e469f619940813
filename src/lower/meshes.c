/* Meshes: their vertices, texture coordinates and normals. */
#include "config.h"

#include "lower/lowering.h"

#include <math.h>
#include <string.h>

static const struct mesh *mesh_of(struct lowering *l, const struct desc_object *o)
{
    return lower_mesh_file(l, desc_get(o, PROP_MESH_FILE));
}

bool lower_mesh_shape(struct lowering *l, const struct desc_object *o, struct geometry *g,
                      uint32_t surface)
{
    const struct mesh *m = mesh_of(l, o);
    struct vec3 scale = desc_vector(o, PROP_MESH_SCALE),
                offset = desc_vector(o, PROP_MESH_POSITION);
    if (!m || !lower_fits(l, o, g, m->faces.n, m->points.n))
        return false;
    uint32_t first = (uint32_t)g->vertices.n;
    for (size_t i = 0; i < m->points.n; i++) {
        struct vec3 p = vec3_add(vec3_mul(m->points.at[i], scale), offset);
        if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) {
            diag_report(l->diag, DIAG_NOT_FINITE, o->span,
                        "vertex %zu of the mesh is too large once scaled and moved", i);
            return false;
        }
        geometry_add_vertex(g, p);
    }
    for (size_t i = 0; i < m->faces.n; i++) {
        const uint32_t *c = m->faces.at[i].at;
        geometry_add_triangle(g, surface, first + c[0], first + c[1], first + c[2]);
    }
    return true;
}

/* ---- texture coordinates ---- */

static void report_no_uvs(struct lowering *l, const struct desc_object *o,
                          const struct desc_prop *why)
{
    const char *what = why->id == PROP_NORMAL_MAP ? "normal map" : "texture";
    struct diag_entry *e =
        diag_report(l->diag, DIAG_MISSING_UV, o->span,
                    "%s has a %s but neither the mesh file nor a UV list has texture coordinates",
                    schema_kind_name(o->kind, o->xml), what);
    struct str name = schema_prop_name(PROP_UV_FILE, o->xml);
    diag_label(e, why->name_span, "the %s is given here", what);
    diag_note(e, "give '%.*s', a list of three pairs a face, or a file that has some",
              STR_ARG(name));
}

const struct vec2 *lower_mesh_uvs(struct lowering *l, const struct desc_object *o,
                                  const struct desc_prop *why)
{
    const struct mesh *m = mesh_of(l, o);
    const struct desc_value *list = desc_get(o, PROP_UV_FILE);
    if (list)
        return lower_uv_file(l, list, m->faces.n);
    if (m->faces.n > 0 && m->uvs.n == 0)
        report_no_uvs(l, o, why);
    if (m->bare_faces == 0)
        return m->uvs.at;
    size_t first = l->diag->entries.n;
    struct diag_entry *e = diag_report(l->diag, DIAG_MISSING_UV, m->bare,
                                       "this face has no texture coordinates, but others have");
    diag_note(e, "they are missing from %zu of %zu triangles", m->bare_faces, m->faces.n);
    diag_label(e, why->name_span, "this needs them");
    lower_label_request(l, first, desc_get(o, PROP_MESH_FILE));
    return NULL;
}

/* ---- normals ---- */

static struct vec3 *computed_normals(struct lowering *l, const struct mesh *m,
                                     uint32_t first_vertex)
{
    struct vec3 *normals = arena_zalloc(&l->scene->arena, m->points.n, sizeof *normals);
    mesh_vertex_normals(l->scene->geometry.vertices.at + first_vertex, m->points.n, m->faces.at,
                        m->faces.n, normals);
    return normals;
}

/* Normals turn as the cross products of edges do: by the cofactors of the scale, so that they keep
 * to the side that the scaled faces' own are on. */
static struct vec3 *scaled_normals(struct lowering *l, const struct mesh *m, struct vec3 scale,
                                   size_t more)
{
    struct vec3 *normals = arena_zalloc(&l->scene->arena, m->normals.n + more, sizeof *normals);
    struct vec3 unit = mesh_direction(scale);
    struct vec3 factor = vec3(unit.y * unit.z, unit.z * unit.x, unit.x * unit.y);
    for (size_t i = 0; i < m->normals.n; i++)
        normals[i] = mesh_direction(vec3_mul(m->normals.at[i], factor));
    return normals;
}

/* Whether some face has no normals in the file. */
static bool lacks_normals(const struct mesh *m)
{
    for (size_t i = 0; i < m->normal_corners.n; i++)
        if (m->normal_corners.at[i].at[0] == MESH_NO_INDEX)
            return true;
    return false;
}

static const struct triangle_corners *completed_corners(struct lowering *l, const struct mesh *m)
{
    struct triangle_corners *corners = arena_zalloc(&l->scene->arena, m->faces.n, sizeof *corners);
    for (size_t i = 0; i < m->faces.n; i++) {
        corners[i] = m->normal_corners.at[i];
        for (int k = 0; k < 3 && m->normal_corners.at[i].at[0] == MESH_NO_INDEX; k++)
            corners[i].at[k] = (uint32_t)m->normals.n + m->faces.at[i].at[k];
    }
    return corners;
}

void lower_mesh_normals(struct lowering *l, const struct desc_object *o, struct surface *s)
{
    const struct mesh *m = mesh_of(l, o);
    if (m->normal_corners.n == 0) {
        s->normals = computed_normals(l, m, s->first_vertex);
        return;
    }
    bool lacking = lacks_normals(m);
    struct vec3 *normals =
        scaled_normals(l, m, desc_vector(o, PROP_MESH_SCALE), lacking ? m->points.n : 0);
    s->normals = normals;
    s->normal_corners = m->normal_corners.at;
    if (!lacking)
        return;
    memcpy(normals + m->normals.n, computed_normals(l, m, s->first_vertex),
           m->points.n * sizeof *normals);
    s->normal_corners = completed_corners(l, m);
}

/* ---- the view of the normals ---- */

struct needles {
    struct geometry *g;
    uint32_t surface;
    double length;
};

static void add_needle(const struct needles *n, struct vec3 p, struct vec3 normal)
{
    struct vec3 tip = vec3_mad(p, n->length, normal);
    if (vec3_length(vec3_sub(tip, p)) > 0)
        geometry_add_cylinder(n->g, n->surface, p, tip, fabs(n->length) / 10);
}

/* One for each normal that a vertex has in turn: with normals of the file it may have several. */
static void add_needles(struct lowering *l, const struct needles *n, const struct surface *s,
                        const struct mesh *m)
{
    size_t points = m->points.n;
    uint32_t *shown = s->normal_corners ? mem_zalloc(points, sizeof *shown) : NULL;
    const struct vec3 *normals = s->normals ? s->normals : computed_normals(l, m, s->first_vertex);
    for (size_t i = 0; i < points && !shown; i++)
        add_needle(n, n->g->vertices.at[s->first_vertex + i], normals[i]);
    for (size_t i = 0; i < 3 * m->faces.n && shown; i++) {
        uint32_t vertex = m->faces.at[i / 3].at[i % 3];
        uint32_t normal = s->normal_corners[i / 3].at[i % 3];
        if (shown[vertex] != normal + 1)
            add_needle(n, n->g->vertices.at[s->first_vertex + vertex], normals[normal]);
        shown[vertex] = normal + 1;
    }
    free(shown);
}

void lower_normal_cylinders(struct lowering *l, const struct desc_object *o,
                            const struct surface *mesh)
{
    static const struct material white = {
        .kind = MATERIAL_LAMBERT, .diffuse = {1, 1, 1}, .texture = TEXTURE_NONE};
    struct geometry *g = &l->scene->geometry;
    const struct mesh *m = mesh_of(l, o);
    size_t most = mesh->normal_corners ? 3 * m->faces.n : m->points.n;
    if (!lower_fits(l, o, g, most, 0))
        return;
    struct needles needles = {
        .g = g,
        .surface = (uint32_t)l->scene->surfaces.n,
        .length = desc_number(o, PROP_SHOW_NORMALS) * (mesh->flip ? -1 : 1),
    };
    uint32_t first = (uint32_t)g->prims.n;
    add_needles(l, &needles, mesh, m);
    struct surface s = {.kind = SURFACE_CYLINDER,
                        .material = (uint32_t)l->scene->materials.n,
                        .first_prim = first,
                        .prim_count = (uint32_t)g->prims.n - first,
                        .normal_map = TEXTURE_NONE,
                        .span = mesh->span};
    vec_push(&l->scene->materials, white);
    vec_push(&l->scene->surfaces, s);
}
