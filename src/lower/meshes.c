/* Meshes: their vertices, texture coordinates and normals.
 *
 * Surfaces that use a file in the same proportions share a model: the file's vertices times a
 * ratio, with normals of its own.  What else moves and scales a mesh is a map from the model's
 * space to the world.  Small meshes, and those used once, are copied into the scene; of the others
 * the scene has one prototype, and each use is an instance. */
#include "config.h"

#include "lower/lowering.h"

#include <math.h>
#include <string.h>

/* Copies of a mesh beyond the first may have this many triangles in all; then they are instances.
 * Some 10 MB, and copies are faster to trace. */
enum { COPY_LIMIT = 65536 };

/* ---- models ---- */

/* In classic, as in the original, normals are made after the mesh's own scale; elsewhere a mesh is
 * made first and then scaled, as groups do it.  Even scales make no difference. */
static struct vec3 ratio_of(const struct desc_object *o)
{
    struct vec3 scale = desc_vector(o, PROP_MESH_SCALE);
    bool even = scale.x > 0 && scale.x == scale.y && scale.y == scale.z;
    return o->model == SCHEMA_MODERN || even ? vec3_all(1) : scale;
}

static struct affine map_of(const struct desc_object *o)
{
    struct vec3 ratio = ratio_of(o), scale = desc_vector(o, PROP_MESH_SCALE);
    scale = vec3(scale.x / ratio.x, scale.y / ratio.y, scale.z / ratio.z);
    struct affine by = affine_scaling(scale);
    struct affine to = affine_translation(desc_vector(o, PROP_MESH_POSITION));
    struct affine own = affine_times(&to, &by);
    return o->place ? affine_times(o->place, &own) : own;
}

static struct mesh_model *model_of(struct lowering *l, const struct desc_object *o)
{
    struct arena *arena = &l->scene->arena;
    struct vec3 ratio = ratio_of(o);
    const struct lower_mesh *file = lower_mesh_file(l, desc_get(o, PROP_MESH_FILE));
    const char *key = arena_printf(arena, "%a %a %a %s", ratio.x, ratio.y, ratio.z, file->path);
    struct mesh_model *model = map_get(&l->models, str_of(key));
    if (!model) {
        model = arena_zalloc(arena, 1, sizeof *model);
        *model = (struct mesh_model){
            .mesh = file->mesh, .file = (uint32_t)(file - l->out->meshes.at), .ratio = ratio};
        map_set(&l->models, str_of(key), model);
    }
    return model;
}

void lower_count_meshes(struct lowering *l)
{
    for (size_t i = 0; i < l->desc->surfaces.n; i++) {
        const struct desc_object *o = l->desc->surfaces.at[i];
        if (o->kind != KIND_MESH || desc_get(o, PROP_SHOW_NORMALS))
            continue;
        l->diag->frame = o->frame;
        model_of(l, o)->uses++;
    }
}

/* ---- shapes ---- */

static void add_faces(struct geometry *g, const struct mesh *m, uint32_t surface, uint32_t first)
{
    for (size_t i = 0; i < m->faces.n; i++) {
        const uint32_t *c = m->faces.at[i].at;
        geometry_add_triangle(g, surface, first + c[0], first + c[1], first + c[2]);
    }
}

bool lower_mesh_shape(struct lowering *l, const struct desc_object *o, struct geometry *g,
                      uint32_t surface)
{
    const struct mesh *m = model_of(l, o)->mesh;
    struct vec3 scale = desc_vector(o, PROP_MESH_SCALE),
                offset = desc_vector(o, PROP_MESH_POSITION);
    if (!m || !lower_fits(l, o, g, m->faces.n, m->points.n))
        return false;
    uint32_t first = (uint32_t)g->vertices.n;
    for (size_t i = 0; i < m->points.n; i++) {
        struct vec3 p = vec3_add(vec3_mul(m->points.at[i], scale), offset);
        if (o->place)
            p = affine_point(o->place, p);
        if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) {
            diag_report(l->diag, DIAG_NOT_FINITE, o->span,
                        "vertex %zu of the mesh is too large once scaled and moved", i);
            return false;
        }
        geometry_add_vertex(g, p);
    }
    add_faces(g, m, surface, first);
    return true;
}

static bool make_prototype(struct lowering *l, const struct desc_object *o,
                           struct mesh_model *model)
{
    struct geometry *g = &l->scene->geometry;
    if (model->prototype)
        return true;
    uint32_t number = geometry_add_prototype(g);
    struct geometry *shapes = &g->prototypes.at[number]->shapes;
    const struct mesh *m = model->mesh;
    if (!lower_fits(l, o, shapes, m->faces.n, m->points.n))
        return false;
    for (size_t i = 0; i < m->points.n; i++) {
        struct vec3 p = vec3_mul(m->points.at[i], model->ratio);
        if (!lower_is_finite(l, o, p))
            return false;
        geometry_add_vertex(shapes, p);
    }
    add_faces(shapes, m, 0, 0);
    model->prototype = number;
    return true;
}

static bool is_shared(const struct mesh_model *model)
{
    return model->uses > 1 && model->mesh->faces.n > COPY_LIMIT / (model->uses - 1);
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

static const struct vec2 *report_bare_faces(struct lowering *l, const struct desc_object *o,
                                            const struct mesh *m, const struct desc_prop *why)
{
    size_t first = l->diag->entries.n;
    struct diag_entry *e = diag_report(l->diag, DIAG_MISSING_UV, m->bare,
                                       "this face has no texture coordinates, but others have");
    diag_note(e, "they are missing from %zu of %zu triangles", m->bare_faces, m->faces.n);
    diag_label(e, why->name_span, "this needs them");
    lower_label_request(l, first, desc_get(o, PROP_MESH_FILE));
    return NULL;
}

/* Of the mesh's UV list or else of its file, which owns them then; NULL after errors. */
static const struct vec2 *mesh_uvs(struct lowering *l, const struct desc_object *o,
                                   const struct mesh *m)
{
    const struct desc_prop *why = lower_wants_uvs(o);
    const struct desc_value *list = desc_get(o, PROP_UV_FILE);
    if (list)
        return lower_uv_file(l, list, m->faces.n);
    if (m->faces.n > 0 && m->uvs.n == 0)
        report_no_uvs(l, o, why);
    return m->bare_faces == 0 ? m->uvs.at : report_bare_faces(l, o, m, why);
}

/* ---- normals ---- */

/* How a map turns normals: as the cross products of edges, so that they keep to the side that the
 * faces' own are on. */
struct turn {
    struct affine inverse;
    double side; /* -1: the map is a mirror */
};

static struct turn turn_of(const struct affine *map)
{
    struct turn t = {.side = affine_determinant(map) < 0 ? -1 : 1};
    affine_invert(map, &t.inverse);
    return t;
}

static struct vec3 *turned(struct lowering *l, const struct turn *t, const struct vec3 *normals,
                           size_t n)
{
    struct vec3 *out = arena_zalloc(&l->scene->arena, n, sizeof *out);
    for (size_t i = 0; i < n; i++)
        out[i] = mesh_direction(vec3_scale(affine_normal(&t->inverse, normals[i]), t->side));
    return out;
}

/* Of the faces around each vertex. */
static const struct vec3 *computed_normals(struct lowering *l, const struct mesh_model *model)
{
    const struct mesh *m = model->mesh;
    size_t n = m->points.n;
    struct vec3 *normals = arena_zalloc(&l->scene->arena, n, sizeof *normals);
    struct vec3 *points = mem_alloc(n, sizeof *points);
    for (size_t i = 0; i < n; i++)
        points[i] = vec3_mul(m->points.at[i], model->ratio);
    mesh_vertex_normals(points, n, m->faces.at, m->faces.n, normals);
    free(points);
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

/* The file's normals, and behind them the vertices' own for faces that have none. */
static void complete_normals(struct lowering *l, struct mesh_model *model)
{
    const struct mesh *m = model->mesh;
    size_t own = m->normals.n, n = own + m->points.n;
    struct vec3 *normals = arena_zalloc(&l->scene->arena, n, sizeof *normals);
    struct triangle_corners *corners = arena_zalloc(&l->scene->arena, m->faces.n, sizeof *corners);
    memcpy(normals, model->normals, own * sizeof *normals);
    memcpy(normals + own, computed_normals(l, model), m->points.n * sizeof *normals);
    for (size_t i = 0; i < m->faces.n; i++) {
        corners[i] = m->normal_corners.at[i];
        for (int k = 0; k < 3 && m->normal_corners.at[i].at[0] == MESH_NO_INDEX; k++)
            corners[i].at[k] = (uint32_t)own + m->faces.at[i].at[k];
    }
    model->normals = normals;
    model->normal_corners = corners;
}

static void find_normals(struct lowering *l, struct mesh_model *model)
{
    const struct mesh *m = model->mesh;
    if (model->normals || m->faces.n == 0)
        return;
    if (m->normal_corners.n == 0) {
        model->normals = computed_normals(l, model);
        return;
    }
    struct affine ratio = affine_scaling(model->ratio);
    struct turn turn = turn_of(&ratio);
    model->normals = turned(l, &turn, m->normals.at, m->normals.n);
    model->normal_corners = m->normal_corners.at;
    if (lacks_normals(m))
        complete_normals(l, model);
}

static size_t normal_count(const struct mesh_model *model)
{
    const struct mesh *m = model->mesh;
    bool completed = model->normal_corners && model->normal_corners != m->normal_corners.at;
    size_t of_file = model->normal_corners ? m->normals.n : 0;
    return of_file + (completed || !model->normal_corners ? m->points.n : 0);
}

/* The normals of a copy, in the world. */
static const struct vec3 *world_normals(struct lowering *l, const struct mesh_model *model,
                                        const struct affine *map)
{
    if (affine_keeps_directions(map) || !model->normals)
        return model->normals;
    struct turn turn = turn_of(map);
    return turned(l, &turn, model->normals, normal_count(model));
}

/* ---- surfaces ---- */

static bool is_smooth(const struct desc_object *o)
{
    return desc_number(o, PROP_SMOOTH) > 0;
}

static bool lower_copy(struct lowering *l, const struct desc_object *o,
                       const struct mesh_model *model, struct surface *s)
{
    struct affine map = map_of(o);
    if (!lower_mesh_shape(l, o, &l->scene->geometry, (uint32_t)l->scene->surfaces.n))
        return false;
    if (is_smooth(o))
        s->normals = world_normals(l, model, &map);
    if (affine_determinant(&map) < 0)
        s->flip = !s->flip;
    return true;
}

static bool lower_instance(struct lowering *l, const struct desc_object *o,
                           struct mesh_model *model, struct surface *s)
{
    struct affine map = map_of(o);
    if (is_smooth(o))
        s->normals = model->normals;
    return make_prototype(l, o, model) &&
           lower_add_instance(l, o, &l->scene->geometry, (uint32_t)l->scene->surfaces.n,
                              model->prototype, PRIM_NONE, &map);
}

bool lower_mesh(struct lowering *l, const struct desc_object *o, struct surface *s)
{
    struct mesh_model *model = model_of(l, o);
    if (!model->mesh || !lower_has_volume(l, o))
        return false;
    if (is_smooth(o))
        find_normals(l, model);
    s->mesh_file = model->file;
    s->flip = desc_number(o, PROP_FLIP_NORMALS) != 0;
    bool shared = is_shared(model) && !l->copied && !desc_get(o, PROP_SHOW_NORMALS);
    if (shared ? !lower_instance(l, o, model, s) : !lower_copy(l, o, model, s))
        return false;
    if (is_smooth(o))
        s->normal_corners = model->normal_corners;
    if (s->needs_uv)
        s->uvs = mesh_uvs(l, o, model->mesh);
    return true;
}

/* ---- the view of the normals ---- */

struct needles {
    struct geometry *g;
    const struct vec3 *points; /* of the mesh, in the world */
    const struct vec3 *normals;
    uint32_t surface;
    double length;
};

static void add_needle(const struct needles *n, uint32_t vertex, uint32_t normal)
{
    struct vec3 p = n->points[vertex], tip = vec3_mad(p, n->length, n->normals[normal]);
    if (vec3_length(vec3_sub(tip, p)) > 0)
        geometry_add_cylinder(n->g, n->surface, p, tip, fabs(n->length) / 10);
}

/* One for each normal that a vertex has in turn: with normals of the file it may have several. */
static void add_needles(const struct needles *n, const struct mesh_model *model)
{
    const struct mesh *m = model->mesh;
    if (!model->normal_corners) {
        for (uint32_t i = 0; i < m->points.n; i++)
            add_needle(n, i, i);
        return;
    }
    uint32_t *shown = mem_zalloc(m->points.n, sizeof *shown);
    for (size_t i = 0; i < 3 * m->faces.n; i++) {
        uint32_t vertex = m->faces.at[i / 3].at[i % 3];
        uint32_t normal = model->normal_corners[i / 3].at[i % 3];
        if (shown[vertex] != normal + 1)
            add_needle(n, vertex, normal);
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
    struct mesh_model *model = model_of(l, o);
    struct affine map = map_of(o);
    find_normals(l, model);
    size_t most = model->normal_corners ? 3 * model->mesh->faces.n : model->mesh->points.n;
    if (!model->normals || !lower_fits(l, o, g, most, 0))
        return;
    struct needles needles = {
        .g = g,
        .points = g->vertices.at + mesh->first_vertex,
        .normals = world_normals(l, model, &map),
        .surface = (uint32_t)l->scene->surfaces.n,
        .length = desc_number(o, PROP_SHOW_NORMALS) * (mesh->flip ? -1 : 1),
    };
    uint32_t first = (uint32_t)g->prims.n;
    add_needles(&needles, model);
    struct surface s = {.kind = SURFACE_CYLINDER,
                        .material = (uint32_t)l->scene->materials.n,
                        .first_prim = first,
                        .prim_count = (uint32_t)g->prims.n - first,
                        .normal_map = TEXTURE_NONE,
                        .span = mesh->span};
    vec_push(&l->scene->materials, white);
    vec_push(&l->scene->surfaces, s);
}
