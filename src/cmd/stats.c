#include "config.h"

#include "cmd/stats.h"

#include <jansson.h>
#include <sys/resource.h>

uint64_t stats_peak_rss(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss * 1024 : 0;
}

static size_t count_triangles(const struct scene *s)
{
    size_t n = s->geometry.triangles.n;
    for (size_t i = 0; i < s->geometry.prototypes.n; i++)
        n += s->geometry.prototypes.at[i]->shapes.triangles.n;
    return n;
}

static json_t *skipped_names(const struct scene *s)
{
    json_t *list = json_array();
    for (size_t i = 0; i < s->skipped.n; i++)
        json_array_append_new(list, json_string(s->skipped.at[i]));
    return list;
}

/* One line where diagnostics are JSON lines too. */
static void print_json(json_t *object, const struct options *o)
{
    size_t layout = o->format == DIAG_FORMAT_JSON ? JSON_COMPACT : JSON_INDENT(2);
    if (object && json_dumpf(object, stdout, layout | JSON_REAL_PRECISION(6)) == 0)
        putchar('\n');
    json_decref(object);
}

/* Samples a pixel. */
static double samples_mean(const struct run_stats *s)
{
    return s->pixels ? (double)s->render.primary / (double)s->pixels : 0;
}

static json_t *samples_json(const struct run_stats *s, const struct options *o)
{
    return o->adaptive > 0 ? json_real(samples_mean(s)) : json_integer(s->grid * s->grid);
}

/* NULL where there is none. */
static json_t *cluster_json(const struct run_stats *s)
{
    if (s->ranks == 0)
        return NULL;
    return json_pack("{s:i, s:I, s:I}", "ranks", s->ranks, "messages",
                     (json_int_t)s->cluster.messages, "bytes", (json_int_t)s->cluster.bytes);
}

/* Whether no pixel has enough samples for its error to be told. */
static bool error_unknown(const struct run_stats *s)
{
    return s->render.adaptive.unfinished == s->pixels;
}

static json_t *error_json(const struct run_stats *s, double error)
{
    return error_unknown(s) ? json_null() : json_real(error);
}

/* NULL where it was not asked for. */
static json_t *adaptive_json(const struct run_stats *s, const struct options *o)
{
    const struct adaptive_stats *a = &s->render.adaptive;
    if (!(o->adaptive > 0))
        return NULL;
    return json_pack("{s:f, s:f, s:i, s:o, s:o, s:I}", "error", o->adaptive, "samples_mean",
                     samples_mean(s), "samples_max", (int)a->most, "estimated_error",
                     error_json(s, a->error), "estimated_error_max", error_json(s, a->worst),
                     "unfinished", (json_int_t)a->unfinished);
}

/* Numbers of what was left out, from one row of skips.def to another. */
static json_t *skips_json(const struct render_stats *r, int first, int end)
{
    json_t *counts = json_object();
    for (int i = first; i < end; i++)
        json_object_set_new(counts, skip_rows[i].name, json_integer((json_int_t)r->skipped[i]));
    return counts;
}

static json_t *frame_json(const struct run_stats *s)
{
    if (!s->file)
        return NULL;
    json_t *name = json_string(s->file);
    return json_pack("{s:I, s:o, s:b}", "number", (json_int_t)s->frame, "file",
                     name ? name : json_string("(not UTF-8)"), "kept", s->kept);
}

/* Where counts are those of some tiles only, which. */
static json_t *resumed_json(const struct run_stats *s)
{
    if (!s->resumed)
        return NULL;
    return json_pack("{s:I, s:I}", "all", (json_int_t)s->tiles, "from_journal",
                     (json_int_t)s->from_journal);
}

static void render_json(const struct run_stats *s, const struct options *o,
                        const struct scene *scene)
{
    const struct render_stats *r = &s->render;
    print_json(
        json_pack(
            "{s:o*, s:o*, s:f, s:f, s:f, s:f, s:f, s:f, s:i, s:s, s:i, s:i, s:o, s:o*, s:o*, "
            "s:{s:I, "
            "s:I, s:I, s:I}, s:I, s:o, s:I, s:I, s:o, s:o, s:I, s:{s:I, s:I}, s:I}",
            "frame", frame_json(s), "tiles", resumed_json(s), "parse_s", s->parse_s, "load_s",
            s->load_s, "build_s", r->build_s, "render_s", r->render_s, "write_s", s->write_s,
            "total_s", s->total_s, "threads", (int)o->threads, "isa", isa_name(o->isa), "width",
            (int)s->width, "height", (int)s->height, "samples", samples_json(s, o), "adaptive",
            adaptive_json(s, o), "mpi", cluster_json(s), "rays", "primary", (json_int_t)r->primary,
            "shadow", (json_int_t)r->shadow, "reflection", (json_int_t)r->reflection, "refraction",
            (json_int_t)r->refraction, "shadow_rays_skipped", (json_int_t)shadow_rays_skipped(r),
            "shadow_rays_skipped_as", skips_json(r, 0, SHADOW_SKIPS), "surfaces",
            (json_int_t)scene->surfaces.n, "triangles", (json_int_t)count_triangles(scene),
            "skipped", skipped_names(scene), "left_out", skips_json(r, SHADOW_SKIPS, SKIPS),
            "pruned", (json_int_t)r->pruned, "tree", "pieces", (json_int_t)r->tree.pieces, "moves",
            (json_int_t)r->tree.moves, "peak_rss_bytes", (json_int_t)stats_peak_rss()),
        o);
}

static void put_count(size_t n, const char *what, const char *behind)
{
    fprintf(stderr, "%zu %s%s%s", n, what, n == 1 ? "" : "s", behind);
}

/* An error above the one wanted has a reason: the time, or the most samples that a pixel may have.
 */
static void adaptive_text(const struct run_stats *s, const struct options *o)
{
    const struct adaptive_stats *a = &s->render.adaptive;
    const char *why = s->late
                          ? ": --time was too short"
                          : ": some pixels have cells as small, or samples as many, as they may";
    fprintf(stderr, "adaptive   %u sample%s a pixel at most; estimated error ", a->most,
            a->most == 1 ? "" : "s");
    if (error_unknown(s))
        fputs("not known", stderr);
    else
        fprintf(stderr, "%.3g, %.3g at most", a->error, a->worst);
    fprintf(stderr, " (%.3g wanted%s)\n", o->adaptive,
            a->unfinished > 0 || a->worst > o->adaptive ? why : "");
    if (a->unfinished > 0)
        fprintf(stderr, "unfinished %llu pixels, whose error is not known\n",
                (unsigned long long)a->unfinished);
}

/* What the lines behind are of. */
static void share_text(const struct run_stats *s)
{
    if (s->file)
        fprintf(stderr, "frame      %u: '%s'%s\n", s->frame, s->file,
                s->kept ? " is there and stays" : "");
    if (s->resumed && !s->kept)
        fprintf(stderr,
                "tiles      %zu, %zu of them from the journal; what follows is of the others\n",
                s->tiles, s->from_journal);
}

static void render_text(const struct run_stats *s, const struct options *o,
                        const struct scene *scene)
{
    const struct render_stats *r = &s->render;
    uint64_t rays = r->primary + r->shadow + r->reflection + r->refraction;
    share_text(s);
    if (s->kept)
        return;
    fprintf(stderr, "picture    %u x %u, ", s->width, s->height);
    if (o->adaptive > 0)
        fprintf(stderr, "%.2f samples a pixel, ", samples_mean(s));
    else
        fprintf(stderr, "%u sample%s a pixel, ", s->grid * s->grid, s->grid > 1 ? "s" : "");
    fprintf(stderr, "%u thread%s, %s\n", o->threads, o->threads > 1 ? "s" : "", isa_name(o->isa));
    if (o->adaptive > 0)
        adaptive_text(s, o);
    fputs("scene      ", stderr);
    put_count(scene->surfaces.n, "surface", ", ");
    put_count(count_triangles(scene), "triangle", ", ");
    put_count(scene->lights.n, "light", ", ");
    put_count(scene->textures.n, "texture", "\n");
    fprintf(stderr,
            "seconds    parse %.4f, load %.4f, build %.4f, render %.4f, write %.4f; %.4f in all\n",
            s->parse_s, s->load_s, r->build_s, r->render_s, s->write_s, s->total_s);
    if (r->tree.pieces + r->tree.moves > 0)
        fprintf(stderr, "tree       %llu pieces cut off large triangles, %llu subtrees moved\n",
                (unsigned long long)r->tree.pieces, (unsigned long long)r->tree.moves);
    fprintf(stderr,
            "rays       primary %llu, shadow %llu, reflection %llu, refraction %llu; %.2f million "
            "a second\n",
            (unsigned long long)r->primary, (unsigned long long)r->shadow,
            (unsigned long long)r->reflection, (unsigned long long)r->refraction,
            r->render_s > 0 ? (double)rays / r->render_s * 1e-6 : 0);
    fprintf(stderr, "skipped    %llu shadow rays", (unsigned long long)shadow_rays_skipped(r));
    for (int i = 0; i < SKIPS; i++)
        fprintf(stderr, "%s%llu %s%s", i == 0 ? " (" : ", ", (unsigned long long)r->skipped[i],
                skip_rows[i].name, i == SHADOW_SKIPS - 1 ? ")" : "");
    if (o->prune)
        fprintf(stderr, ", %llu rays pruned", (unsigned long long)r->pruned);
    for (size_t i = 0; i < scene->skipped.n; i++)
        fprintf(stderr, ", %s", scene->skipped.at[i]);
    fprintf(stderr, "\nmemory     %.1f MB at most\n", (double)stats_peak_rss() * 1e-6);
}

void stats_print_render(const struct run_stats *s, const struct options *o,
                        const struct scene *scene)
{
    if (o->stats == STATS_JSON)
        render_json(s, o, scene);
    else if (o->stats == STATS_TEXT)
        render_text(s, o, scene);
}

static void check_text(const struct check_stats *s)
{
    fprintf(stderr, "%s: ", s->scene);
    put_count(s->surfaces, "surface", ", ");
    put_count(s->lights, "light", ", ");
    put_count(s->materials, "material", ", ");
    put_count(s->textures, "texture", "; ");
    fprintf(stderr, "%.4f s, %.1f MB at most\n", s->parse_s, (double)stats_peak_rss() * 1e-6);
}

void stats_print_check(const struct check_stats *s, const struct options *o)
{
    if (o->stats == STATS_JSON)
        print_json(json_pack("{s:s, s:f, s:I, s:I, s:I, s:I, s:I, s:I, s:I}", "scene", s->scene,
                             "parse_s", s->parse_s, "surfaces", (json_int_t)s->surfaces, "lights",
                             (json_int_t)s->lights, "materials", (json_int_t)s->materials,
                             "textures", (json_int_t)s->textures, "errors", (json_int_t)s->errors,
                             "warnings", (json_int_t)s->warnings, "peak_rss_bytes",
                             (json_int_t)stats_peak_rss()),
                   o);
    else if (o->stats == STATS_TEXT)
        check_text(s);
}
