/* Comparing scenes, names and comments of conversions.  Whole conversions are golden cases'
 * and random scenes' business. */
#include "config.h"

#include "load.h"
#include "unit.h"

#include "base/file.h"
#include "convert/comments.h"
#include "convert/compare.h"
#include "convert/names.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---- comparison ---- */

#define CAMERA                                                                                     \
    "camera { eye: (0, 1, -4)  back: (0, 0.25, -1)  up: (0, 1, 0)  yfov: 27  resolution: (8, 9)  " \
    "compat: 1 }\n"
#define SCENE                                                                                      \
    "wrt 1 model classic\n" CAMERA "light point { position: (1, 2, 3)  intensity: 1 }\n"           \
    "light area { position: (1, 2, 3)  intensity: 1  shape: sphere  size: 1  samples: 3 }\n"       \
    "sphere { center: (1, 2, 3)  radius: 1  material: glass { diffuse: 1  specular: 1  "           \
    "exponent: 2  reflection: 1  refraction: 1  ior: 2  uv_offset: (1, 2)  uv_scale: (1, 2) } }\n" \
    "cylinder { base: (1, 2, 3)  top: (1, 4, 3)  radius: 1  material: lambert { diffuse: 1 } }\n"  \
    "quad { vertices: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]  "                              \
    "material: lambert { diffuse: 1 } }\n"

static const struct {
    const char *from, *to, *what;
} changes[] = {
    {"eye: (0, 1, -4)", "eye: (0, 1, 4)", "camera: eye"},
    {"back: (0, 0.25, -1)", "back: (0, 0.25, 1)", "camera: back"},
    {"up: (0, 1, 0)", "up: (0, 2, 0)", "camera: up"},
    {"yfov: 27", "yfov: 28", "camera: yfov"},
    {"(8, 9)", "(7, 9)", "camera: width"},
    {"(8, 9)", "(8, 8)", "camera: height"},
    {"compat: 1", "compat: 0", "camera: compat"},
    {"position: (1, 2, 3)", "position: (1, 2, 4)", "light 1: position"},
    {"intensity: 1 }", "intensity: 2 }", "light 1: intensity"},
    {"intensity: 1 }", "intensity: 1  falloff: inverse_square }",
     "light 1: falloff inverse_square"},
    {"size: 1", "size: 2", "light 2: radius"},
    {"samples: 3", "samples: 4", "light 2: sample points"},
    {"shape: sphere", "shape: quad", "light 2: primitives"},
    {"center: (1, 2, 3)", "center: (1, 2, 4)", "surface 1 (sphere): center"},
    {"radius: 1  material: glass", "radius: 2  material: glass", "surface 1 (sphere): radius"},
    {"diffuse: 1  specular", "diffuse: 2  specular", "surface 1 (sphere): diffuse"},
    {"specular: 1", "specular: 2", "surface 1 (sphere): specular"},
    {"exponent: 2", "exponent: 3", "surface 1 (sphere): exponent"},
    {"reflection: 1", "reflection: 2", "surface 1 (sphere): reflection"},
    {"refraction: 1", "refraction: 2", "surface 1 (sphere): refraction"},
    {"ior: 2", "ior: 3", "surface 1 (sphere): ior"},
    {"uv_offset: (1, 2)", "uv_offset: (1, 1)", "surface 1 (sphere): uv_offset"},
    {"uv_scale: (1, 2)", "uv_scale: (1, 1)", "surface 1 (sphere): uv_scale"},
    {"material: lambert { diffuse: 1 }", "material: emissive { diffuse: 1 }",
     "surface 2 (cylinder): material"},
    {"base: (1, 2, 3)", "base: (1, 2, 2)", "surface 2 (cylinder): base"},
    {"top: (1, 4, 3)", "top: (1, 5, 3)", "surface 2 (cylinder): height"},
    {"radius: 1  material: lambert", "radius: 2  material: lambert",
     "surface 2 (cylinder): radius"},
    {"(1, 0, 0), (1", "(2, 0, 0), (1", "surface 3 (quad): primitive 1: vertex 2"},
    {"(0, 1, 0)] ", "(0, 2, 0)] ", "surface 3 (quad): primitive 2: vertex 2"},
};

static void replace(struct buffer *out, const char *from, const char *to)
{
    const char *at = strstr(SCENE, from);
    ck_assert_ptr_nonnull(at);
    buffer_add(out, SCENE, (size_t)(at - SCENE));
    buffer_puts(out, to);
    buffer_puts(out, at + strlen(from));
    buffer_add(out, "", 1);
}

START_TEST(change_is_found)
{
    struct load a, b;
    struct buffer text = {0};
    struct comparison c = {0};
    replace(&text, changes[_i].from, changes[_i].to);
    ck_assert_msg(load_lower(&a, "a", SCENE), "%s", load_first(&a));
    ck_assert_msg(load_lower(&b, "b", text.at), "%s", load_first(&b));
    ck_assert(!compare_scenes(&a.lowered.scene, &b.lowered.scene, 1, &c));
    ck_assert_str_eq(c.found.at[0].what, changes[_i].what);
    ck_assert_str_ne(c.found.at[0].a, c.found.at[0].b);
    ck_assert_uint_eq(c.found.n, 1);
    comparison_free(&c);
    load_free(&a);
    load_free(&b);
    buffer_free(&text);
}
END_TEST

START_TEST(equal_scenes)
{
    struct load a, b;
    struct comparison c = {0};
    ck_assert(load_lower(&a, "a", SCENE) && load_lower(&b, "b", SCENE));
    ck_assert(compare_scenes(&a.lowered.scene, &b.lowered.scene, 1, &c));
    ck_assert_uint_eq(c.count, 0);
    comparison_free(&c);
    load_free(&a);
    load_free(&b);
}
END_TEST

/* ---- files in other folders ---- */

static const struct {
    const char *from, *to, *name, *moved; /* NULL: it stays */
} moves[] = {
    {"a/x", "a/y", "n.png", NULL},
    {"x", "y", "n.png", NULL},
    {"a/x", "a/b/y", "n.png", "../n.png"},
    {"a/b/x", "a/y", "n.png", "b/n.png"},
    {"a/b/x", "c/y", "d/n.png", "../a/b/d/n.png"},
    {"a/x", "y", "../n.png", "a/../n.png"},
    {"x", "a/b/y", "n.png", "../../n.png"},
    {"a/x", "ab/y", "n.png", "../a/n.png"},
    {"a/x", "c/y", "/n.png", NULL},
    {"a/../x", "./y", "n.png", NULL},
    {"none/x", "c/y", "n.png", NULL},
};

START_TEST(name_of_a_file_elsewhere)
{
    char folder[] = "/tmp/wrt-unit.XXXXXX", back[4096];
    ck_assert_ptr_nonnull(mkdtemp(folder));
    ck_assert_ptr_nonnull(getcwd(back, sizeof back));
    ck_assert_int_eq(chdir(folder), 0);
    ck_assert(!mkdir("a", 0700) && !mkdir("a/b", 0700) && !mkdir("c", 0700) && !mkdir("ab", 0700));
    const char *name = moves[_i].name;
    char *moved = file_relocate(moves[_i].from, moves[_i].to, name, strlen(name));
    ck_assert_pstr_eq(moved, moves[_i].moved);
    free(moved);
    rmdir("a/b");
    rmdir("a");
    rmdir("c");
    rmdir("ab");
    ck_assert_int_eq(chdir(back), 0);
    rmdir(folder);
}
END_TEST

/* ---- names ---- */

START_TEST(names_are_distinct)
{
    static const char *const wanted[] = {"wood", "wood", "wood 2", "2",
                                         "",     "for",  "sphere", "\xC3\xA9\xC3\xA9"};
    static const char *const made[] = {"wood", "wood_2", "wood_2_2", "_2",
                                       "_",    "for_2",  "sphere_2", "__2"};
    struct arena arena = {0};
    struct names names = {.arena = &arena};
    for (int i = 0; i < COUNT(wanted); i++) {
        struct str name = names_take(&names, str_of(wanted[i]));
        ck_assert_msg(str_is(name, made[i]), "%s: %.*s", wanted[i], STR_ARG(name));
    }
    names_free(&names);
    arena_free(&arena);
}
END_TEST

/* ---- comments ---- */

static const struct {
    const char *native, *xml;
} comments[] = {
    {"// a", "<!-- a -->"},
    {"//a  ", "<!-- a -->"},
    {"/* a */", "<!-- a -->"},
    {"//", "<!-- -->"},
    {"// a -- b --- c", "<!-- a -\\- b -\\-\\- c -->"},
    {"// a -\\- b", "<!-- a -\\\\- b -->"},
    {"// a */ b *\\/", "<!-- a */ b *\\/ -->"},
    {"/* a *\\/ b *\\\\/ */", "<!-- a */ b *\\/ -->"},
    {"// \\xml: a=\"b\"", "<!-- xml: a=\"b\" -->"},
    {"// \\\\xml: a=\"b\"", "<!-- \\xml: a=\"b\" -->"},
    {"// xml: a", "<!-- xml: a -->"},
    {"// \001 \\u{1} \\\\u{1} \\u{41}", "<!-- \\u{1} \\\\u{1} \\\\\\u{1} \\u{41} -->"},
    {"// \xEF\xBF\xBF", "<!-- \\u{FFFF} -->"},
};

/* The only comment of a text in the other format, NUL-terminated. */
static void convert_comment(const char *text, struct buffer *out)
{
    struct load l;
    struct buffer line = {0};
    load_parse(&l, text);
    ck_assert_uint_eq(l.ast.trivia.n, 1);
    (l.ast.xml ? comment_to_native : comment_to_xml)(&l.ast, &l.ast.trivia.at[0], COMMENT_OWN_LINE,
                                                     &line);
    struct str comment = str_trim((struct str){line.at, line.n});
    buffer_printf(out, "%.*s%s", STR_ARG(comment), l.ast.xml ? "\n" : "<a/>");
    buffer_add(out, "", 1);
    buffer_free(&line);
    load_free(&l);
}

START_TEST(comment_there_and_back)
{
    struct buffer there = {0}, back = {0}, again = {0}, expected = {0};
    buffer_printf(&expected, "%s<a/>", comments[_i].xml);
    buffer_add(&expected, "", 1);
    convert_comment(comments[_i].native, &there);
    ck_assert_str_eq(there.at, expected.at);
    convert_comment(there.at, &back);
    convert_comment(back.at, &again);
    ck_assert_str_eq(again.at, expected.at);
    buffer_free(&there);
    buffer_free(&back);
    buffer_free(&again);
    buffer_free(&expected);
}
END_TEST

Suite *translate_suite(void)
{
    Suite *s = suite_create("translate");
    TCase *t = tcase_create("comparison");
    tcase_add_loop_test(t, change_is_found, 0, COUNT(changes));
    tcase_add_test(t, equal_scenes);
    suite_add_tcase(s, t);

    t = tcase_create("names");
    tcase_add_loop_test(t, name_of_a_file_elsewhere, 0, COUNT(moves));
    tcase_add_test(t, names_are_distinct);
    suite_add_tcase(s, t);

    t = tcase_create("comments");
    tcase_add_loop_test(t, comment_there_and_back, 0, COUNT(comments));
    suite_add_tcase(s, t);
    return s;
}
