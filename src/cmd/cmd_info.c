/* `wrt info`: what a scene is made of, what files it needs, what is behind a pixel. */
#include "config.h"

#include "cmd/commands.h"
#include "cmd/info.h"

#include "cmd/stats.h"

#include <stdlib.h>
#include <string.h>

const char *const info_count_words[INFO_COUNTS] = {
#define COUNT_WORD(id, word) [INFO_##id] = word,
    INFO_COUNT_LIST(COUNT_WORD)
#undef COUNT_WORD
};

const char *const info_part_words[INFO_PARTS] = {
#define PART_WORD(id, word) [INFO_##id] = word,
    INFO_PART_LIST(PART_WORD)
#undef PART_WORD
};

const char *const info_frame_words[] = {
    [DIAG_FRAME_INCLUDE] = "include", [DIAG_FRAME_CALL] = "call", [DIAG_FRAME_USE] = "use",
    [DIAG_FRAME_ROUND] = "for",       [DIAG_FRAME_ITEM] = "for",       [DIAG_FRAME_GROUP] = "group",
};

/* ---- facts ----------------------------------------------------------------------------------- */

static size_t mesh_bytes(const struct lowered *l)
{
    size_t sum = 0;
    for (size_t i = 0; i < l->meshes.n; i++) {
        const struct mesh *m = l->meshes.at[i].mesh;
        sum += m->points.capacity * sizeof *m->points.at + m->faces.capacity * sizeof *m->faces.at;
    }
    return sum;
}

/* With the prototypes, which hold none themselves. */
static size_t geometry_bytes(const struct geometry *g)
{
    size_t sum = g->instances.capacity * sizeof *g->instances.at;
    for (size_t i = 0; i < g->prototypes.n; i++)
        sum += geometry_bytes(&g->prototypes.at[i]->shapes);
    return sum + g->prims.capacity * sizeof *g->prims.at +
           g->spheres.capacity * sizeof *g->spheres.at +
           g->cylinders.capacity * sizeof *g->cylinders.at +
           g->triangles.capacity * sizeof *g->triangles.at +
           g->vertices.capacity * sizeof *g->vertices.at;
}

static size_t picture_bytes(const struct scene *s)
{
    size_t sum = 0;
    for (size_t i = 0; i < s->images.n; i++) {
        const struct image *image = s->images.at[i];
        sum += 3 * (size_t)image->width * image->height * (image->data16 ? 2 : 1);
    }
    return sum;
}

static size_t text_bytes(const struct srcmap *m)
{
    size_t sum = 0;
    for (size_t i = 0; i < m->sources.n; i++)
        sum += m->sources.at[i]->n;
    return sum;
}

static void count_shapes(const struct geometry *g, size_t counts[INFO_COUNTS])
{
    counts[INFO_INSTANCES] += g->instances.n;
    counts[INFO_SPHERES] += g->spheres.n;
    counts[INFO_CYLINDERS] += g->cylinders.n;
    counts[INFO_TRIANGLES] += g->triangles.n;
    counts[INFO_VERTICES] += g->vertices.n;
}

struct info_facts info_facts(const struct info *i)
{
    const struct scene *s = &i->lowered.scene;
    const struct geometry *g = &s->geometry;
    struct info_facts f = {.bounds = geometry_bounds(g), .empty = g->prims.n == 0};
    f.counts[INFO_SURFACES] = i->frontend.desc.surfaces.n;
    count_shapes(g, f.counts);
    for (size_t k = 0; k < g->prototypes.n; k++)
        count_shapes(&g->prototypes.at[k]->shapes, f.counts);
    f.counts[INFO_LIGHTS] = s->lights.n;
    f.counts[INFO_MATERIALS] = s->materials.n;
    f.counts[INFO_TEXTURES] = s->textures.n;
    f.bytes[INFO_TEXT] = text_bytes(&i->frontend.sources);
    f.bytes[INFO_TREE] = i->frontend.ast.arena.bytes;
    f.bytes[INFO_DESCRIPTION] = i->frontend.desc.arena.bytes;
    f.bytes[INFO_MESHES] = mesh_bytes(&i->lowered);
    f.bytes[INFO_GEOMETRY] = geometry_bytes(g) + s->arena.bytes;
    f.bytes[INFO_PICTURES] = picture_bytes(s);
    f.bytes[INFO_PEAK] = stats_peak_rss();
    return f;
}

/* ---- text ------------------------------------------------------------------------------------ */

void info_print_place(const struct info *i, struct span span)
{
    struct location at = srcmap_locate(&i->frontend.sources, span.begin);
    if (at.source)
        printf("  (%s:%u:%u)", at.source->name, at.line, at.column);
}

void info_print_vec3(struct vec3 v)
{
    printf("(%.6g, %.6g, %.6g)", v.x, v.y, v.z);
}

/* "sphere ball", "phong gold" */
void info_print_object(const struct desc_object *o)
{
    printf("%s%s%.*s", schema_kinds[o->kind].native, o->name.n ? " " : "", STR_ARG(o->name));
}

/* The file of a mesh, and the material. */
static void print_details(const struct desc_object *surface)
{
    const struct desc_value *file = desc_get(surface, PROP_MESH_FILE);
    if (file)
        printf(" \"%.*s\"", STR_ARG(file->string));
    fputs(": ", stdout);
    info_print_object(desc_get(surface, PROP_MATERIAL)->object);
}

void info_print_frame(const struct info *i, const struct diag_frame *f)
{
    struct str name = srcmap_text(&i->frontend.sources, f->at);
    if (f->kind == DIAG_FRAME_GROUP)
        printf("%.*s", STR_ARG(name));
    else if (f->kind == DIAG_FRAME_USE)
        printf("%.*s(...)", STR_ARG(name));
    else
        printf("%s %.*s", info_frame_words[f->kind], STR_ARG(name));
}

/* Nodes nest as deeply as loops, uses and files do. */
static void print_node(const struct info *i, const struct info_node *n, int depth)
{
    size_t k = 0;
    if (n->object || n->frame) {
        printf("%*s", 2 * depth, "");
        if (n->object)
            info_print_object(n->object);
        else
            info_print_frame(i, n->frame);
        if (n->object && n->count > 1)
            printf(" x %zu", n->count);
        if (n->object)
            print_details(n->object);
        else
            printf(": %zu surface%s", n->count, n->count > 1 ? "s" : "");
        info_print_place(i, n->span);
        putchar('\n');
    }
    for (const struct info_node *c = n->children; c; c = c->next, k++)
        if (k < INFO_LISTED || i->options->verbose)
            print_node(i, c, depth + 1);
    if (k > INFO_LISTED && !i->options->verbose)
        printf("%*s... and %zu more; -v shows all\n", 2 * depth + 2, "", k - INFO_LISTED);
}

static void print_tree(const struct info *i)
{
    struct arena a = {0};
    print_node(i, info_tree(&i->frontend.desc, &a), 0);
    arena_free(&a);
}

static void print_lights(const struct info *i)
{
    const struct desc *d = &i->frontend.desc;
    for (size_t k = 0; k < d->lights.n; k++) {
        if (k == INFO_LISTED && !i->options->verbose) {
            printf("  ... and %zu more; -v shows all\n", d->lights.n - k);
            return;
        }
        fputs("  ", stdout);
        info_print_object(d->lights.at[k]);
        info_print_place(i, d->lights.at[k]->span);
        putchar('\n');
    }
}

static void print_textures(const struct scene *s)
{
    for (size_t k = 0; k < s->textures.n; k++)
        printf("  image %s: %u x %u\n", s->textures.at[k].file, s->textures.at[k].image->width,
               s->textures.at[k].image->height);
}

static void print_bytes(const char *before, const char *what, size_t bytes)
{
    bool many = bytes >= 1000 * 1000;
    printf("%s%s %.*f %s", before, what, many, (double)bytes * (many ? 1e-6 : 1e-3),
           many ? "MB" : "kB");
}

static void print_facts(const struct info *i)
{
    struct info_facts f = info_facts(i);
    putchar('\n');
    for (int k = 0; k < INFO_COUNTS; k++)
        printf("%-12s %zu\n", info_count_words[k], f.counts[k]);
    fputs("bounds       ", stdout);
    if (f.empty) {
        fputs("none", stdout);
    } else {
        info_print_vec3(f.bounds.lo);
        fputs(" to ", stdout);
        info_print_vec3(f.bounds.hi);
    }
    fputs("\nmemory       ", stdout);
    for (int k = 0; k < INFO_PARTS; k++)
        print_bytes(k ? ", " : "", info_part_words[k], f.bytes[k]);
    putchar('\n');
}

static void print_info(const struct info *i)
{
    const struct camera *c = &i->lowered.scene.camera;
    printf("%s: model %s, %u x %u pixels\n  camera", i->options->scenes.at[0],
           schema_model_name(i->frontend.desc.model), c->width, c->height);
    info_print_place(i, i->frontend.desc.camera->span);
    putchar('\n');
    if (i->frontend.desc.settings) {
        fputs("  settings", stdout);
        info_print_place(i, i->frontend.desc.settings->span);
        putchar('\n');
    }
    print_lights(i);
    print_textures(&i->lowered.scene);
    print_tree(i);
    print_facts(i);
}

/* ---- files ----------------------------------------------------------------------------------- */

/* As make reads names: '$' doubled, backslashes before blanks, '#' and ':'.  A name with a newline
 * cannot be told to make. */
static void print_escaped(const char *name)
{
    for (const char *p = name; *p; p++) {
        if (*p == ' ' || *p == '\t')
            for (const char *q = p; q > name && q[-1] == '\\'; q--)
                putchar('\\');
        if (*p == '$' || strchr(" \t#:", *p))
            putchar(*p == '$' ? '$' : '\\');
        putchar(*p);
    }
}

/* A rule for the picture that `wrt render` makes by default. */
static void print_rule(const struct info *i)
{
    struct needed files;
    char *picture = default_picture(i->options->scenes.at[0]);
    needed_files(&i->frontend, &files);
    print_escaped(i->options->output ? i->options->output : picture);
    putchar(':');
    for (size_t k = 0; k < files.paths.n; k++) {
        fputs(" \\\n  ", stdout);
        print_escaped(files.paths.at[k]);
    }
    putchar('\n');
    needed_free(&files);
    free(picture);
}

/* ---- the command ----------------------------------------------------------------------------- */

static void print_json(json_t *j, const struct options *o)
{
    size_t layout = o->format == DIAG_FORMAT_JSON ? JSON_COMPACT : JSON_INDENT(2);
    if (j && json_dumpf(j, stdout, layout | JSON_REAL_PRECISION(12)) == 0)
        putchar('\n');
    json_decref(j);
}

static void print_files(const struct info *i)
{
    if (i->options->json)
        print_json(json_pack("{s:o}", "files", info_files_json(i)), i->options);
    else
        print_rule(i);
}

static int print_what_is_behind(const struct info *i)
{
    const struct camera *c = &i->lowered.scene.camera;
    const struct options *o = i->options;
    uint32_t width = o->width ? o->width : c->width, height = o->width ? o->height : c->height;
    if (o->pixel[0] >= width || o->pixel[1] >= height)
        return usage_error("--pixel lies outside the picture of %u x %u", width, height);
    struct info_pixel p;
    info_pixel(i, width, height, &p);
    if (o->json)
        print_json(info_pixel_json(i, &p), o);
    else
        info_print_pixel(i, &p);
    arena_free(&p.arena);
    return 0;
}

static int tell(struct info *i)
{
    const struct options *o = i->options;
    bool right = frontend_load(&i->frontend, o->scenes.at[0], o);
    if (right && o->deps)
        right = needed_check(&i->frontend);
    else if (right)
        right =
            lower_scene(&i->frontend.desc, &i->frontend.sources, &i->lowered, &i->frontend.diag);
    int status = frontend_report(&i->frontend, o, DIAG_WARNING);
    if (!right)
        return status;
    if (o->deps)
        print_files(i);
    else if (o->behind)
        return print_what_is_behind(i);
    else if (o->json)
        print_json(info_json(i), o);
    else
        print_info(i);
    return status;
}

int command_info(const struct options *o)
{
    if (o->scenes.n != 1)
        return o->scenes.n ? usage_error("info takes one scene, but %zu are given", o->scenes.n)
                           : usage_error("info: no scene given");
    if (o->deps && o->behind)
        return usage_error("--deps and --pixel cannot be combined");
    if (o->width && !o->behind)
        return usage_error("--res says of which picture --pixel is, and that is not given");
    if (o->output && !o->deps)
        return usage_error("-o names the picture of --deps, which is not given");
    struct info i = {.options = o};
    int status = tell(&i);
    lower_free(&i.lowered);
    frontend_free(&i.frontend);
    return status;
}
