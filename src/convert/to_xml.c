/* The native language to XML.
 *
 * What becomes an element is what evaluation made of the text: loops, templates, functions and
 * defaults are gone.  The tree still tells how a number was spelt, and where comments go: those of
 * an object evaluated several times are written with the first.
 *
 * The text written here is no more than right; the printer lays it out. */
#include "config.h"

#include "base/map.h"
#include "convert/names.h"
#include "convert/to_xml.h"

#include <stdlib.h>

/* ---- comments ---- */

/* Those of a stop that go to a place. */
static void put_placed(struct xml_writer *w, size_t owner, enum place_kind kind)
{
    const struct stop *stop = &w->places.stops.at[owner];
    for (size_t i = stop->first; i < stop->last; i++) {
        const struct place *p = &w->places.comments[i];
        if (p->kind != kind || p->owner != owner || p->done)
            continue;
        if (kind != PLACE_BEHIND)
            begin_line(w->out, kind != PLACE_SECTION &&
                                   gap_blank_before(w->ast, w->ast->trivia.at[i].span.begin));
        xml_put_comment(w, i, kind == PLACE_BEHIND ? COMMENT_BEHIND : COMMENT_OWN_LINE);
    }
}

/* Those outside of statements that belong to the scene as a whole. */
static void put_outside(struct xml_writer *w, enum place_kind kind)
{
    for (size_t i = 0; i < w->ast->trivia.n; i++) {
        if (w->places.comments[i].kind != kind || w->places.comments[i].done)
            continue;
        begin_line(w->out, gap_blank_before(w->ast, w->ast->trivia.at[i].span.begin));
        xml_put_comment(w, i, COMMENT_OWN_LINE);
    }
}

/* ---- objects ---- */

static void put_camera(struct xml_writer *w, const struct desc_object *o)
{
    xml_put_element(w, o, "camera", (struct str){0});
}

static void put_settings(struct xml_writer *w, const struct desc_object *o)
{
    xml_put_element(w, o, "settings", (struct str){0});
}

/* Names that were made from the file's go without saying. */
static void put_texture(struct xml_writer *w, const struct desc_object *o)
{
    xml_put_element(w, o, "Texture", w->texture_ids[o->number]);
}

static void put_light(struct xml_writer *w, const struct desc_object *o)
{
    xml_put_element(w, o, "light", xml_label_of(w, o));
}

static void put_surface(struct xml_writer *w, const struct desc_object *o)
{
    xml_put_element(w, o, "surface", xml_label_of(w, o));
}

/* ---- sections ---- */

struct section {
    const char *name;
    bool array;
    struct desc_object *const *at;
    size_t n;
    void (*put)(struct xml_writer *w, const struct desc_object *o);
    unsigned rank;             /* among sections that begin with one statement */
    uint32_t begin;            /* of its first statement, or of the note that holds its place */
    const struct stop *holder; /* that note, or NULL */
};

/* Where evaluation of the scene's own text came to the object. */
static uint32_t origin_of(const struct xml_writer *w, const struct desc_object *o)
{
    uint32_t at = xml_is_own(w, o->span.begin) ? o->span.begin : w->ast->source->base;
    for (const struct diag_frame *f = o->frame; f; f = f->parent)
        if (f->kind != DIAG_FRAME_GROUP && xml_is_own(w, f->at.begin))
            at = f->at.begin;
    return at;
}

/* The comments of a statement, before the first element it makes. */
static void begin_stop(struct xml_writer *w, size_t k)
{
    if (w->begun[k])
        return;
    w->begun[k] = true;
    put_placed(w, k, PLACE_SECTION);
    put_placed(w, k, PLACE_BEFORE);
}

static void end_stop(struct xml_writer *w, size_t k)
{
    put_placed(w, k, PLACE_BEHIND);
    put_placed(w, k, PLACE_AFTER);
}

/* An object, with its own comments where it stands inside of a statement. */
static void put_object(struct xml_writer *w, const struct section *s, const struct desc_object *o,
                       uint32_t statement)
{
    const struct ast_node *n = xml_node_at(w, o->span);
    bool inside = n && n->kind == AST_BLOCK && n->span.begin != statement;
    if (inside)
        xml_put_lead(w, n->span.begin);
    begin_line(w->out, false);
    s->put(w, o);
    if (inside)
        xml_put_behind(w, n->span.end);
}

static void put_objects(struct xml_writer *w, const struct section *s)
{
    for (size_t i = 0; i < s->n; i++) {
        size_t k = places_stop(&w->places, origin_of(w, s->at[i]));
        size_t next = i + 1 < s->n ? places_stop(&w->places, origin_of(w, s->at[i + 1])) : SIZE_MAX;
        begin_line(w->out, !w->begun[k] && gap_blank_before(w->ast, w->places.stops.at[k].begin));
        begin_stop(w, k);
        put_object(w, s, s->at[i], w->places.stops.at[k].begin);
        if (next != k)
            end_stop(w, k);
    }
}

static void put_section(struct xml_writer *w, const struct section *s)
{
    size_t k = s->holder ? (size_t)(s->holder - w->places.stops.at)
                         : places_stop(&w->places, origin_of(w, s->at[0]));
    put_placed(w, k, PLACE_SECTION);
    if (!s->array) {
        put_objects(w, s);
        return;
    }
    begin_line(w->out, false);
    buffer_printf(w->out, "<%s>", s->name);
    if (s->holder)
        begin_stop(w, k);
    put_objects(w, s);
    if (s->holder)
        end_stop(w, k);
    begin_line(w->out, false);
    buffer_printf(w->out, "</%s>\n", s->name);
}

static int compare_sections(const void *a, const void *b)
{
    const struct section *x = a, *y = b;
    if (x->begin != y->begin)
        return x->begin < y->begin ? -1 : 1;
    return (x->rank > y->rank) - (x->rank < y->rank);
}

static void locate_section(struct xml_writer *w, struct section *s)
{
    s->begin = s->n ? UINT32_MAX : 0;
    for (size_t i = 0; i < s->n; i++) {
        size_t k = places_stop(&w->places, origin_of(w, s->at[i]));
        uint32_t at = w->places.stops.at[k].begin;
        s->begin = at < s->begin ? at : s->begin;
    }
    for (size_t k = 0; k < w->places.stops.n; k++) {
        if (!str_is(w->places.stops.at[k].section, s->name))
            continue;
        s->holder = &w->places.stops.at[k];
        s->begin = s->holder->begin;
    }
}

/* ---- the scene ---- */

/* The attributes of the root. */
static void put_model(struct xml_writer *w)
{
    struct str noted = {0};
    for (const struct ast_node *s = w->ast->statements; s; s = s->next)
        if (s->kind == AST_MODEL)
            noted = xml_take_note(w, s->span.end, xml_next_token(w, s->span.end), "model");
    if (w->desc->model == SCHEMA_MODERN)
        xml_put(w, " model=\"modern\"");
    else if (noted.at)
        buffer_printf(w->out, " model=\"%.*s\"", STR_ARG(noted));
}

/* What evaluation left without a place: comments inside statements that XML does not have. */
static void put_left_over(struct xml_writer *w)
{
    for (size_t i = 0; i < w->ast->trivia.n; i++)
        if (w->places.comments[i].kind != PLACE_FOOT)
            xml_put_comment(w, i, COMMENT_OWN_LINE);
}

static void report_unused(struct xml_writer *w)
{
    for (size_t i = 0; i < w->desc->materials.n; i++)
        if (w->shared[i].id.n && !w->shared[i].written)
            diag_report(w->t->diag, DIAG_DROPPED, w->desc->materials.at[i]->span,
                        "XML has materials only where they are used, so '%.*s' is left out",
                        STR_ARG(w->desc->materials.at[i]->name));
}

static void put_scene(struct xml_writer *w, struct section *sections, size_t n)
{
    put_outside(w, PLACE_HEAD);
    begin_line(w->out, gap_blank_before(w->ast, xml_next_token(w, w->ast->source->base)));
    xml_put(w, "<scene");
    put_model(w);
    xml_put(w, ">");
    for (size_t i = 0; i < n; i++)
        if (sections[i].n || sections[i].holder)
            put_section(w, &sections[i]);
    put_outside(w, PLACE_TAIL);
    put_left_over(w);
    begin_line(w->out, false);
    xml_put(w, "</scene>\n");
    put_outside(w, PLACE_FOOT);
    report_unused(w);
}

/* ---- names ---- */

/* The note behind a name in the scene's own text. */
static struct str noted_id(struct xml_writer *w, struct str name)
{
    const struct source *s = w->ast->source;
    uintptr_t at = (uintptr_t)name.at - (uintptr_t)s->text;
    if (!name.n || at >= s->n)
        return (struct str){0};
    uint32_t end = s->base + (uint32_t)(at + name.n);
    return xml_take_note(w, end, xml_next_token(w, end), "id");
}

/* The first material of each name gets an id, unless all are to be written out. */
static void name_materials(struct xml_writer *w)
{
    struct map known = {0};
    w->shared = arena_zalloc(&w->arena, w->desc->materials.n, sizeof *w->shared);
    for (size_t i = 0; i < w->desc->materials.n; i++) {
        struct desc_object *m = w->desc->materials.at[i];
        struct str noted = noted_id(w, m->name);
        if (!m->name.n || map_get(&known, m->name) || w->t->expand)
            continue;
        map_set(&known, m->name, m);
        w->shared[i].id = noted.at ? noted : m->name;
    }
    map_free(&known);
}

/* Notes behind the names of materials where they are used: there XML had the definition. */
static void place_definitions(struct xml_writer *w, const struct desc_object *o)
{
    for (const struct desc_prop *p = o->props; p; p = p->next) {
        const struct ast_node *property = xml_property_at(w, p);
        if (p->id == PROP_OBJECT)
            place_definitions(w, p->value.object);
        if (p->id != PROP_MATERIAL || !property || property->children->kind != AST_NAME)
            continue;
        uint32_t end = property->span.end;
        if (xml_take_note(w, end, xml_next_token(w, end), "id").at)
            w->shared[p->value.object->number].place = property->children->span.begin;
    }
}

/* The ids of textures, none for a name that to_native.c would make of the file's. */
static void name_textures(struct xml_writer *w)
{
    struct names names = {.arena = &w->arena};
    w->texture_ids = arena_zalloc(&w->arena, w->desc->textures.n, sizeof *w->texture_ids);
    for (size_t i = 0; i < w->desc->textures.n; i++) {
        const struct desc_object *o = w->desc->textures.at[i];
        struct str noted = noted_id(w, o->name);
        struct str made = names_of_file(&names, desc_get(o, PROP_FILE)->string);
        if (noted.at || (o->name.n && !str_equal(o->name, made)))
            w->texture_ids[i] = noted.at ? noted : o->name;
        if (o->name.n)
            names_take(&names, o->name);
    }
    names_free(&names);
}

static int compare_offsets(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static void find_places(struct xml_writer *w, const struct section *sections, size_t n)
{
    VEC(uint32_t) origins = {0};
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < sections[i].n; j++)
            vec_push(&origins, origin_of(w, sections[i].at[j]));
    qsort(origins.at, origins.n, sizeof *origins.at, compare_offsets);
    places_find(&w->places, w->ast, origins.at, origins.n);
    w->begun = arena_zalloc(&w->arena, w->places.stops.n, sizeof *w->begun);
    vec_free(&origins);
}

bool translate_description(const struct translation *t, struct buffer *out)
{
    const struct desc *d = t->desc;
    struct xml_writer w = {.t = t, .ast = t->ast, .desc = d, .out = out};
    struct section sections[] = {
        {"camera", false, &d->camera, 1, put_camera, .rank = 0},
        {"settings", false, &d->settings, d->settings != NULL, put_settings, .rank = 1},
        {"textures", true, d->textures.at, d->textures.n, put_texture, .rank = 2},
        {"lights", true, d->lights.at, d->lights.n, put_light, .rank = 3},
        {"surfaces", true, d->surfaces.at, d->surfaces.n, put_surface, .rank = 4},
    };
    enum { SECTIONS = sizeof sections / sizeof *sections };
    size_t errors = t->diag->errors;
    xml_index_nodes(&w, t->ast->statements);
    find_places(&w, sections, SECTIONS);
    for (size_t i = 0; i < SECTIONS; i++)
        locate_section(&w, &sections[i]);
    qsort(sections, SECTIONS, sizeof *sections, compare_sections);
    name_materials(&w);
    name_textures(&w);
    for (size_t i = 0; i < d->surfaces.n; i++)
        place_definitions(&w, d->surfaces.at[i]);
    for (size_t i = 0; i < d->lights.n; i++)
        place_definitions(&w, d->lights.at[i]);
    put_scene(&w, sections, SECTIONS);
    places_free(&w.places);
    vec_free(&w.nodes);
    arena_free(&w.arena);
    return t->diag->errors == errors;
}
