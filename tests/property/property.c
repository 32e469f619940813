/* Properties that hold for any text, tried on random ones.
 *
 *     property COUNT [FIRST]     texts made of the seeds FIRST (1) and on
 *
 * A text that breaks a property is printed, with its seed. */
#include "config.h"

#include "apart.h"
#include "events.h"
#include "random.h"

#include "../unit/load.h"
#include "base/file.h"
#include "convert/bake.h"
#include "convert/compare.h"
#include "convert/translate.h"
#include "print/printer.h"
#include "syntax/syntax.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* A text, NUL-terminated, and what it means. */
struct text {
    struct buffer bytes;
    struct load load;
};

static struct str text_of(const struct text *t)
{
    return (struct str){t->bytes.at, t->bytes.n - 1};
}

static void text_end(struct text *t)
{
    buffer_add(&t->bytes, "", 1);
}

static bool parse(struct text *t)
{
    load_text(&t->load, "scene", t->bytes.at);
    return syntax_parse(t->load.source, &t->load.ast, &t->load.diag);
}

static bool lower(struct text *t)
{
    return load_lower(&t->load, "scene", t->bytes.at);
}

static void text_free(struct text *t)
{
    buffer_free(&t->bytes);
    load_free(&t->load);
}

/* ---- what must be the same ---- */

/* A text's bytes without white space and the separators that the layout may leave out; a comment
 * keeps those. */
static void squeeze(const struct text *t, struct buffer *out)
{
    const struct ast *ast = &t->load.ast;
    size_t comment = 0;
    for (uint32_t i = 0; i + 1 < t->bytes.n; i++) {
        const struct trivia *c = comment < ast->trivia.n ? &ast->trivia.at[comment] : NULL;
        uint32_t at = ast->source->base + i;
        bool inside = c && at >= c->span.begin;
        if (!strchr(inside ? " \t\r\n" : " \t\r\n,;", t->bytes.at[i]))
            buffer_add(out, t->bytes.at + i, 1);
        comment += inside && at + 1 == c->span.end;
    }
}

static bool same_bytes(struct buffer *a, struct buffer *b)
{
    bool same = str_equal((struct str){a->at, a->n}, (struct str){b->at, b->n});
    buffer_free(a);
    buffer_free(b);
    return same;
}

static bool same_squeezed(const struct text *a, const struct text *b)
{
    struct buffer x = {0}, y = {0};
    squeeze(a, &x);
    squeeze(b, &y);
    return same_bytes(&x, &y) && a->load.ast.trivia.n == b->load.ast.trivia.n;
}

static bool same_events(const struct text *a, const struct text *b)
{
    struct buffer x = {0}, y = {0};
    xml_events(&a->load.ast, &x);
    xml_events(&b->load.ast, &y);
    return same_bytes(&x, &y);
}

static bool same_comments(const struct text *a, const struct text *b)
{
    struct buffer x = {0}, y = {0};
    comment_events(&a->load.ast, &x);
    comment_events(&b->load.ast, &y);
    return same_bytes(&x, &y);
}

static bool same_scene(const struct scene *a, const struct scene *b)
{
    struct comparison c = {0};
    bool same = compare_scenes(a, b, 3, &c);
    for (size_t i = 0; i < c.found.n; i++)
        printf("%s: %s, but %s\n", c.found.at[i].what, c.found.at[i].a, c.found.at[i].b);
    comparison_free(&c);
    return same;
}

/* ---- the layout ---- */

/* No blanks at the ends of lines, one newline at the end. */
static bool is_tidy(struct str text)
{
    if (!text.n || text.at[text.n - 1] != '\n' || text.at[0] == '\n')
        return false;
    for (size_t i = 1; i < text.n; i++)
        if (text.at[i] == '\n' && strchr(" \t\r", text.at[i - 1]))
            return false;
    return true;
}

static bool is_laid_out(const struct text *t)
{
    struct buffer again = {0}, now = {0};
    print_scene(&t->load.ast, &again);
    buffer_str(&now, text_of(t));
    return same_bytes(&again, &now);
}

/* A text that was parsed; the result is the property that it breaks, or NULL. */
static const char *broken_layout(const struct text *first)
{
    bool xml = first->load.ast.xml;
    struct text second = {0};
    print_scene(&first->load.ast, &second.bytes);
    text_end(&second);
    const char *broken =
        !parse(&second)                       ? "fmt(x) parses"
        : xml && !same_events(first, &second) ? "elements and comments keep their order"
        : !xml && !same_trees(&first->load, first->load.ast.statements, &second.load,
                              second.load.ast.statements)
            ? "parse(fmt(x)) = parse(x)"
        : !xml && !same_squeezed(first, &second) ? "tokens and comments keep their order"
        : !xml && !is_tidy(text_of(&second))     ? "fmt(x) is tidy"
        : !is_laid_out(&second)                  ? "fmt(fmt(x)) = fmt(x)"
                                                 : NULL;
    if (broken)
        printf("---- laid out:\n%s", second.bytes.at);
    text_free(&second);
    return broken;
}

static const char *check_native(uint64_t seed, struct text *t)
{
    random_native(seed, &t->bytes);
    text_end(t);
    return parse(t) ? broken_layout(t) : "x parses";
}

/* ---- members taken whole ---- */

static const char *broken_reading(struct text *t, uint64_t seed)
{
    struct text whole = {0}, apart = {0};
    damage(seed, &t->bytes);
    put_colons((struct str){t->bytes.at, t->bytes.n}, false, &whole.bytes);
    put_colons((struct str){t->bytes.at, t->bytes.n}, true, &apart.bytes);
    read_all(&whole.load, whole.bytes.at);
    read_all(&apart.load, apart.bytes.at);
    bool same = same_reading(&whole.load, &apart.load);
    if (!same) {
        struct diag_print_options all = {.least = DIAG_NOTE};
        diag_print(&whole.load.diag, &all, stdout);
        puts("---- but token by token:");
        diag_print(&apart.load.diag, &all, stdout);
    }
    text_free(&whole);
    text_free(&apart);
    return same ? NULL : "a member is the same whole and token by token";
}

static const char *check_members(uint64_t seed, struct text *t)
{
    random_native(seed, &t->bytes);
    const char *broken = broken_reading(t, seed);
    text_end(t);
    load_text(&t->load, "scene", t->bytes.at);
    return broken;
}

static const char *check_scene_members(uint64_t seed, struct text *t)
{
    random_scene(seed, &t->bytes);
    const char *broken = broken_reading(t, seed);
    text_end(t);
    load_text(&t->load, "scene", t->bytes.at);
    return broken;
}

/* ---- conversions ---- */

static struct translation translation_of(struct text *t, const struct desc *desc)
{
    return (struct translation){.ast = &t->load.ast,
                                .desc = desc,
                                .sources = &t->load.sources,
                                .diag = &t->load.diag,
                                .beside = "scene"};
}

/* The scene in the other format, and what that means. */
static bool convert(struct text *from, const struct desc *desc, struct text *to)
{
    struct translation t = translation_of(from, desc);
    bool right =
        from->load.ast.xml ? translate_to_native(&t, &to->bytes) : translate_to_xml(&t, &to->bytes);
    text_end(to);
    return right && lower(to);
}

/* The scene goes to `there`, that to `back`, and that to `again`. */
static const char *broken_round_trip(struct text *t, const struct desc *desc,
                                     const struct scene *scene, struct text *there,
                                     struct text *back, struct text *again)
{
    bool xml = t->load.ast.xml;
    if (!convert(t, desc, there))
        return "x is converted";
    if (!same_scene(scene, &there->load.lowered.scene))
        return "convert(x) is the same scene";
    if (!is_laid_out(there))
        return "convert(x) is laid out";
    if (!xml && !same_comments(t, there))
        return "convert(x) has the same comments";
    if (!convert(there, &there->load.desc, back))
        return "convert(x) is converted back";
    if (xml && !same_events(t, back))
        return "what comes back has the same elements, spellings and comments";
    if (!convert(back, &back->load.desc, again))
        return "what comes back is converted again";
    return same_squeezed(there, again) ? NULL : "what comes back is converted alike";
}

static const char *check_round_trip(struct text *t, const struct desc *desc,
                                    const struct scene *scene)
{
    struct text there = {0}, back = {0}, again = {0};
    const char *broken = broken_round_trip(t, desc, scene, &there, &back, &again);
    if (broken)
        printf("---- there:\n%s\n---- back:\n%s\n---- again:\n%s\n",
               there.bytes.n ? there.bytes.at : "", back.bytes.n ? back.bytes.at : "",
               again.bytes.n ? again.bytes.at : "");
    for (size_t i = 0; broken && i < there.load.diag.entries.n; i++)
        printf("there: %s\n", there.load.diag.entries.at[i]->message);
    for (size_t i = 0; broken && i < back.load.diag.entries.n; i++)
        printf("back: %s\n", back.load.diag.entries.at[i]->message);
    text_free(&there);
    text_free(&back);
    text_free(&again);
    return broken;
}

static const char *check_xml(uint64_t seed, struct text *t)
{
    random_xml(seed, &t->bytes);
    text_end(t);
    if (!lower(t))
        return "x is a scene";
    const char *broken = broken_layout(t);
    return broken ? broken : check_round_trip(t, &t->load.desc, &t->load.lowered.scene);
}

static const char *check_scene(uint64_t seed, struct text *t)
{
    random_scene(seed, &t->bytes);
    text_end(t);
    if (!lower(t))
        return "x is a scene";
    struct arena arena = {0};
    struct desc desc;
    struct lowered lowered = {0};
    const char *broken = broken_layout(t);
    if (!broken && (!bake_places(&t->load.desc, &arena, &t->load.diag, &desc) ||
                    !lower_scene(&desc, &t->load.sources, &lowered, &t->load.diag)))
        broken = "places are made part of x";
    if (!broken)
        broken = check_round_trip(t, &desc, &lowered.scene);
    lower_free(&lowered);
    arena_free(&arena);
    return broken;
}

/* ---- the program ---- */

static bool holds(const char *(*check)(uint64_t seed, struct text *t), uint64_t seed)
{
    struct text t = {0};
    const char *broken = check(seed, &t);
    if (broken) {
        printf("---- seed %llu, broken: %s\n%s\n", (unsigned long long)seed, broken, t.bytes.at);
        diag_print(&t.load.diag, &(struct diag_print_options){.least = DIAG_ERROR}, stdout);
    }
    text_free(&t);
    return !broken;
}

/* The files that random scenes name. */
static bool write_files(void)
{
    static const char mesh[] = "OFF\n4 2 0\n0 0 0\n1.1 0 0\n0 1.7 0\n1 1 0.3\n3 0 1 2\n3 1 3 2\n";
    static const char uvs[] = "0 0\n1 0\n0 1\n1 0\n1 1\n0 1\n";
    char why[IMAGE_REASON_BYTES];
    size_t n;
    struct picture *p = picture_new(2, 2, PICTURE_BYTES);
    picture_set(p, 1, 1, vec3(1, 0.5, 0));
    void *png = picture_encode(p, PICTURE_PNG, &n, why);
    bool written = png && !file_write("t.png", png, n) &&
                   !file_write("m.off", mesh, sizeof mesh - 1) &&
                   !file_write("m.txt", uvs, sizeof uvs - 1);
    free(png);
    picture_free(p);
    return written;
}

static bool try_all(uint64_t first, unsigned long count)
{
    for (uint64_t seed = first; seed < first + count; seed++)
        if (!holds(check_native, seed) || !holds(check_xml, seed) || !holds(check_scene, seed) ||
            !holds(check_members, seed) || !holds(check_scene_members, seed))
            return false;
    return true;
}

int main(int argc, char **argv)
{
    unsigned long count = argc > 1 ? strtoul(argv[1], NULL, 10) : 300;
    uint64_t first = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    char folder[] = "/tmp/wrt-property.XXXXXX";
    if (!mkdtemp(folder) || chdir(folder) != 0 || !write_files()) {
        puts("no folder for the files of the scenes");
        return EXIT_FAILURE;
    }
    bool right = try_all(first, count);
    static const char *const files[] = {"t.png", "m.off", "m.txt"};
    for (int i = 0; i < COUNT(files); i++)
        unlink(files[i]);
    rmdir(folder);
    if (right)
        printf("%lu random native texts, XML scenes and native scenes each\n", count);
    return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
