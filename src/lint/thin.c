/* Glass without an inside. */
#include "config.h"

#include "lint/checks.h"
#include "lint/survey.h"

static void report_thin(const struct lint *l, const struct desc_object *o, bool open)
{
    struct diag_entry *e =
        diag_report(l->diag, DIAG_THIN_GLASS, o->span,
                    "this %s%s refracts and has no inside: what is behind it is seen as if all of "
                    "that were glass",
                    open ? "open " : "", schema_kind_name(o->kind, o->xml));
    diag_note(e, "a pane has two sides: use a closed mesh, or a material that does not refract");
}

static void report_open(const struct lint *l, const struct desc_object *o,
                        const struct mesh_report *r)
{
    struct diag_entry *e =
        diag_report(l->diag, DIAG_MESH_OPEN_GLASS, o->span,
                    "the mesh refracts and is open: rays enter its glass and never leave it");
    diag_note(e,
              "%zu edges belong to one triangle only; the first joins vertices %u and %u, "
              "counted from 0",
              r->boundary_edges, r->first_boundary[0], r->first_boundary[1]);
}

void lint_thin_glass(const struct lint *l)
{
    const struct scene *s = &l->lowered->scene;
    for (uint32_t i = 0; i < s->surfaces.n; i++) {
        const struct surface *surface = &s->surfaces.at[i];
        if (vec3_is_zero(survey_material(l->survey, i)->refraction))
            continue;
        const struct desc_object *o = survey_object(l->survey, i);
        const struct mesh_report *r =
            surface->kind == SURFACE_MESH ? survey_mesh(l->survey, surface->mesh_file) : NULL;
        bool open = r && r->boundary_edges > 0;
        l->diag->frame = o->frame;
        if (open)
            report_open(l, o, r);
        if (open || surface->kind == SURFACE_TRIANGLE || surface->kind == SURFACE_QUAD)
            report_thin(l, o, open);
    }
    l->diag->frame = NULL;
}
