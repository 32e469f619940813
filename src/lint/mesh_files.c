/* What the analysis of mesh files finds. */
#include "config.h"

#include "lint/checks.h"
#include "lint/survey.h"

#include <float.h>

/* A mesh file that could be analysed. */
struct examined {
    const struct lower_mesh *file;
    const struct mesh *mesh;
    const struct mesh_report *report;
};

/* Calls it for each, in the frame of whoever named it first. */
static void each_file(const struct lint *l,
                      void (*look)(const struct lint *l, const struct examined *e))
{
    for (uint32_t i = 0; i < l->lowered->meshes.n; i++) {
        const struct lower_mesh *file = &l->lowered->meshes.at[i];
        struct examined e = {file, file->mesh, survey_mesh(l->survey, i)};
        l->diag->frame = file->frame;
        if (e.report)
            look(l, &e);
    }
    l->diag->frame = NULL;
}

static void look_at_faces(const struct lint *l, const struct examined *e)
{
    const struct mesh_report *r = e->report;
    struct span span = e->file->asked->span;
    size_t faces = e->mesh->faces.n;
    if (r->non_manifold_faces) {
        struct diag_entry *found =
            diag_report(l->diag, DIAG_MESH_NON_MANIFOLD, span,
                        "%zu of the mesh's %zu triangles do not continue one surface",
                        r->non_manifold_faces, faces);
        diag_note(found, "the first is triangle %zu, counted from 0", r->first_non_manifold);
        diag_note(found, "an edge joins two triangles that run the same way round, and the "
                         "triangles at a vertex make one fan");
    }
    if (r->degenerate_faces)
        diag_note(diag_report(l->diag, DIAG_MESH_DEGENERATE, span,
                              "%zu of the mesh's %zu triangles have no area, so no ray hits them",
                              r->degenerate_faces, faces),
                  "the first is triangle %zu, counted from 0", r->first_degenerate);
    if (r->unused_vertices)
        diag_note(diag_report(l->diag, DIAG_MESH_UNUSED_VERTICES, span,
                              "%zu of the mesh's %zu vertices are in no face", r->unused_vertices,
                              e->mesh->points.n),
                  "the first is vertex %zu, counted from 0", r->first_unused);
}

void lint_mesh_faces(const struct lint *l)
{
    each_file(l, look_at_faces);
}

/* ---- inside out ------------------------------------------------------------------------------ */

static bool is_inside_out(const struct lint *l, uint32_t surface, const struct mesh_report *r)
{
    const struct desc_object *o = survey_object(l->survey, surface);
    return r && survey_is_closed(r) && r->volume < 0 && desc_number(o, PROP_FLIP_NORMALS) == 0 &&
           !survey_holds(l->survey, surface, l->lowered->scene.camera.origin);
}

/* A mesh that the eye is inside of is a room and may well show its inside. */
void lint_mesh_inside_out(const struct lint *l)
{
    const struct scene *s = &l->lowered->scene;
    bool *told = mem_zalloc(l->lowered->meshes.n, sizeof *told);
    for (uint32_t i = 0; i < s->surfaces.n; i++) {
        uint32_t file = s->surfaces.at[i].mesh_file;
        if (s->surfaces.at[i].kind != SURFACE_MESH || told[file] ||
            !is_inside_out(l, i, survey_mesh(l->survey, file)))
            continue;
        const struct desc_object *o = survey_object(l->survey, i);
        struct str flip = schema_prop_name(PROP_FLIP_NORMALS, o->xml);
        told[file] = true;
        l->diag->frame = o->frame;
        struct diag_entry *e = diag_report(
            l->diag, DIAG_MESH_INVERTED, desc_get(o, PROP_MESH_FILE)->span,
            "the mesh is closed and inside out: its triangles run clockwise seen from outside");
        diag_note(e, "its volume counts as %.3g; '%.*s' turns the normals round",
                  survey_mesh(l->survey, file)->volume, STR_ARG(flip));
    }
    l->diag->frame = NULL;
    free(told);
}

/* ---- single precision ------------------------------------------------------------------------ */

static double longest_edge(const struct mesh *m, const struct triangle_corners *face, double *reach)
{
    double longest = 0;
    *reach = 0;
    for (int i = 0; i < 3; i++) {
        struct vec3 a = m->points.at[face->at[i]], b = m->points.at[face->at[(i + 1) % 3]];
        longest = fmax(longest, vec3_length(vec3_sub(b, a)));
        *reach = fmax(*reach, vec3_largest(a));
    }
    return longest;
}

/* A step of single precision is at most this times the number. */
static bool is_coarse(const struct mesh *m, const struct triangle_corners *face)
{
    double reach, longest = longest_edge(m, face, &reach);
    return longest > 0 && longest < LINT(FLOAT_STEPS) * FLT_EPSILON * reach;
}

static void look_at_precision(const struct lint *l, const struct examined *e)
{
    const struct mesh *m = e->mesh;
    size_t n = 0, first = 0;
    for (size_t i = 0; i < m->faces.n; i++)
        if (is_coarse(m, &m->faces.at[i]) && n++ == 0)
            first = i;
    if (n == 0)
        return;
    struct diag_entry *found =
        diag_report(l->diag, DIAG_MESH_SINGLE, e->file->asked->span,
                    "%zu of the mesh's %zu triangles are too small for numbers of single precision",
                    n, m->faces.n);
    diag_note(found, "the first is triangle %zu, counted from 0", first);
    diag_note(found, "other programs, and binary files, round the coordinates to 7 digits; a mesh "
                     "nearer to its origin keeps its shape");
}

void lint_mesh_precision(const struct lint *l)
{
    each_file(l, look_at_precision);
}
