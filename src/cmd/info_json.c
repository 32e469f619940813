#include "config.h"

#include "cmd/info.h"

#include "cmd/stats.h"
#include "schema/schema.h"

/* What is no finite number, as a colour may be in classic, is null; adding nothing takes the sign
 * off zeros. */
static json_t *number_json(double x)
{
    return isfinite(x) ? json_real(x + 0) : json_null();
}

static json_t *vec3_json(struct vec3 v)
{
    return json_pack("[o, o, o]", number_json(v.x), number_json(v.y), number_json(v.z));
}

static json_t *str_json(struct str s)
{
    return json_stringn(s.at, s.n);
}

/* Adds "file", "line" and "column". */
static void set_place(json_t *j, const struct info *i, struct span span)
{
    struct location at = srcmap_locate(&i->frontend.sources, span.begin);
    if (!at.source)
        return;
    json_object_set_new(j, "file", json_string(at.source->name));
    json_object_set_new(j, "line", json_integer(at.line));
    json_object_set_new(j, "column", json_integer(at.column));
}

/* Its kind, its name if it has one, and its place. */
static json_t *object_json(const struct info *i, const struct desc_object *o)
{
    json_t *j = json_pack("{s:s}", "kind", schema_kinds[o->kind].native);
    if (o->name.n)
        json_object_set_new(j, "name", str_json(o->name));
    set_place(j, i, o->span);
    return j;
}

static json_t *objects_json(const struct info *i, struct desc_object *const *objects, size_t n)
{
    json_t *list = json_array();
    for (size_t k = 0; k < n && (k < INFO_LISTED || i->options->verbose); k++)
        json_array_append_new(list, object_json(i, objects[k]));
    return list;
}

static json_t *surface_json(const struct info *i, const struct desc_object *o)
{
    json_t *j = object_json(i, o);
    const struct desc_value *file = desc_get(o, PROP_MESH_FILE);
    if (file)
        json_object_set_new(j, "mesh", str_json(file->string));
    json_object_set_new(j, "material", object_json(i, desc_get(o, PROP_MATERIAL)->object));
    return j;
}

/* Nodes nest as deeply as loops, uses and files do. */
static json_t *node_json(const struct info *i, const struct info_node *n)
{
    json_t *j = n->object ? surface_json(i, n->object) : json_object();
    size_t k = 0;
    json_object_set_new(j, "surfaces", json_integer((json_int_t)n->count));
    if (n->object)
        return j;
    if (n->frame) {
        struct str name = srcmap_text(&i->frontend.sources, n->frame->at);
        json_object_set_new(j, info_frame_words[n->frame->kind], str_json(name));
        set_place(j, i, n->frame->at);
    }
    json_t *children = json_array();
    for (const struct info_node *c = n->children; c; c = c->next, k++)
        if (k < INFO_LISTED || i->options->verbose)
            json_array_append_new(children, node_json(i, c));
    json_object_set_new(j, "children", children);
    if (k > INFO_LISTED && !i->options->verbose)
        json_object_set_new(j, "unlisted", json_integer((json_int_t)(k - INFO_LISTED)));
    return j;
}

static json_t *tree_json(const struct info *i)
{
    struct arena a = {0};
    json_t *j = node_json(i, info_tree(&i->frontend.desc, &a));
    arena_free(&a);
    return j;
}

static json_t *textures_json(const struct scene *s)
{
    json_t *list = json_array();
    for (size_t k = 0; k < s->textures.n; k++)
        json_array_append_new(list, json_pack("{s:s, s:[i, i]}", "file", s->textures.at[k].file,
                                              "size", (int)s->textures.at[k].image->width,
                                              (int)s->textures.at[k].image->height));
    return list;
}

json_t *info_files_json(const struct info *i)
{
    struct needed files;
    json_t *list = json_array();
    needed_files(&i->frontend, &files);
    for (size_t k = 0; k < files.paths.n; k++)
        json_array_append_new(list, json_string(files.paths.at[k]));
    needed_free(&files);
    return list;
}

static json_t *counts_json(const struct info_facts *f)
{
    json_t *j = json_object();
    for (int k = 0; k < INFO_COUNTS; k++)
        json_object_set_new(j, info_count_words[k], json_integer((json_int_t)f->counts[k]));
    return j;
}

static json_t *memory_json(const struct info_facts *f)
{
    json_t *j = json_object();
    for (int k = 0; k < INFO_PARTS; k++)
        json_object_set_new(j, info_part_words[k], json_integer((json_int_t)f->bytes[k]));
    return j;
}

json_t *info_json(const struct info *i)
{
    const struct desc *d = &i->frontend.desc;
    const struct scene *s = &i->lowered.scene;
    struct info_facts f = info_facts(i);
    json_t *bounds = f.empty ? json_null()
                             : json_pack("{s:o, s:o}", "low", vec3_json(f.bounds.lo), "high",
                                         vec3_json(f.bounds.hi));
    json_t *camera = object_json(i, d->camera);
    json_object_set_new(camera, "resolution",
                        json_pack("[i, i]", (int)s->camera.width, (int)s->camera.height));
    json_t *j = json_pack("{s:s, s:s, s:o}", "scene", i->options->scenes.at[0], "model",
                          schema_model_name(d->model), "camera", camera);
    if (d->settings)
        json_object_set_new(j, "settings", object_json(i, d->settings));
    json_t *rest = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "lights", objects_json(i, d->lights.at, d->lights.n),
        "textures", textures_json(s), "tree", tree_json(i), "counts", counts_json(&f), "bounds",
        bounds, "memory", memory_json(&f), "files", info_files_json(i));
    json_object_update_missing(j, rest);
    json_decref(rest);
    return j;
}

/* ---- a pixel -----------------------------------------------------------------------------------
 */

static json_t *frames_json(const struct info *i, const struct diag_frame *innermost)
{
    json_t *frames = json_array();
    for (const struct diag_frame *f = innermost; f; f = f->parent) {
        json_t *frame = json_object();
        struct str name = srcmap_text(&i->frontend.sources, f->at);
        json_object_set_new(frame, info_frame_words[f->kind], str_json(name));
        if (f->kind == DIAG_FRAME_ROUND)
            json_object_set_new(frame, "value", json_real(f->number));
        if (f->kind == DIAG_FRAME_ITEM)
            json_object_set_new(frame, "item", json_integer((json_int_t)f->number));
        set_place(frame, i, f->at);
        json_array_append_new(frames, frame);
    }
    return frames;
}

static json_t *light_json(const struct info *i, size_t k, const struct probe_light *light)
{
    json_t *j = object_json(i, info_light(i, k)), *blockers = json_array();
    for (const struct probe_blocker *b = light->blockers; b; b = b->next) {
        json_t *blocker = object_json(i, info_surface(i, b->surface));
        json_object_set_new(blocker, "rays", json_integer((json_int_t)b->rays));
        json_array_append_new(blockers, blocker);
    }
    json_object_set_new(j, "rays", json_integer((json_int_t)light->rays));
    json_object_set_new(j, "lit", json_integer((json_int_t)light->lit));
    json_object_set_new(j, "blockers", blockers);
    json_object_set_new(j, "diffuse", vec3_json(light->diffuse));
    json_object_set_new(j, "highlight", vec3_json(light->highlight));
    return j;
}

static void set_surface(json_t *j, const struct info *i, const struct probe_ray *r)
{
    const struct desc_object *o = info_surface(i, r->surface);
    json_t *lights = json_array();
    for (size_t k = 0; k < i->lowered.scene.lights.n; k++)
        json_array_append_new(lights, light_json(i, k, &r->lights[k]));
    json_object_set_new(j, "distance", number_json(r->distance));
    json_object_set_new(j, "point", vec3_json(r->point));
    json_object_set_new(j, "normal", vec3_json(r->normal));
    json_object_set_new(j, "surface", surface_json(i, o));
    json_object_set_new(j, "frames", frames_json(i, o->frame));
    json_object_set_new(j, "diffuse", vec3_json(r->diffuse));
    json_object_set_new(j, "ambient", vec3_json(r->without));
    json_object_set_new(j, "lights", lights);
}

static void set_ray(json_t *j, const struct info *i, const struct probe_ray *r)
{
    json_object_set_new(j, "hit", json_boolean(r->hit));
    json_object_set_new(j, "origin", vec3_json(r->origin));
    json_object_set_new(j, "direction", vec3_json(r->direction));
    if (r->hit)
        set_surface(j, i, r);
    const struct probe_ray *const bounced[] = {r->reflected, r->refracted};
    for (int k = 0; k < 2; k++) {
        if (!bounced[k])
            continue;
        json_t *ray = json_pack("{s:o}", "weight", vec3_json(bounced[k]->weight));
        set_ray(ray, i, bounced[k]);
        json_object_set_new(j, k ? "refracted" : "reflected", ray);
    }
    json_object_set_new(j, "colour", vec3_json(r->colour));
}

json_t *info_pixel_json(const struct info *i, const struct info_pixel *p)
{
    json_t *j = json_pack("{s:[i, i]}", "pixel", (int)p->x, (int)p->y);
    set_ray(j, i, p->ray);
    json_object_set_new(j, "bytes", json_pack("[i, i, i]", p->bytes[0], p->bytes[1], p->bytes[2]));
    return j;
}
