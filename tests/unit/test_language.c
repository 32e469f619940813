/* The native language: values of expressions, what statements make, and mistakes. */
#include "config.h"

#include "load.h"
#include "unit.h"

#include <stdio.h>
#include <stdlib.h>

/* ---- expressions: what str() says of them ---- */

#define PRELUDE                                                                        \
    "wrt 1 model classic let zero = 0 let list = [1, 2, 3] let v = (1, 2, 3)"          \
    " fn f(a, b = 2, c = a + b) = (a, b, c) fn fact(n) = n <= 1 ? 1 : n * fact(n - 1)" \
    " material gold = lambert { diffuse: (1, 2, 3) }\n"

static const struct {
    const char *expression, *text;
} values[] = {
    {"1 + 2 * 3", "7"},
    {"(1 + 2) * 3", "9"},
    {"7 - 2 - 1", "4"},
    {"8 / 4 / 2", "1"},
    {"2 ^ 3 ^ 2", "512"},
    {"-2 ^ 2", "-4"},
    {"(-2) ^ 2", "4"},
    {"2 ^ -1", "0.5"},
    {"- - 3", "3"},
    {"+-3", "-3"},
    {"7 % 3", "1"},
    {"-7 % 3", "2"},
    {"7 % -3", "-2"},
    {"-7 % -3", "-1"},
    {"6 % 3", "0"},
    {"5.5 % 2", "1.5"},
    {"(7, -7) % 3", "(1, 2)"},
    {"1 + 2 == 3", "true"},
    {"1 < 2 && 2 < 1", "false"},
    {"1 < 2 || zero / zero == 1", "true"},
    {"false && zero / zero == 1", "false"},
    {"!(1 >= 2) && 1 <= 1 && 2 > 1", "true"},
    {"1 < 2 ? \"a\" : \"b\"", "a"},
    {"1 > 2 ? 1 : 2 > 1 ? 2 : 3", "2"},
    {"true ? 1 : 1 / 0", "1"},
    /* angles */
    {"45deg", "45deg"},
    {"45deg + 45deg", "90deg"},
    {"2 * 45deg", "90deg"},
    {"45deg * 2 / 4", "22.5deg"},
    {"90deg / 45deg", "2"},
    {"100deg % 90deg", "10deg"},
    {"0 + 45deg", "45deg"},
    {"-(45deg)", "-45deg"},
    {"180deg / 1rad == pi", "true"},
    {"0 == 0deg", "true"},
    {"90deg > 0 && 90deg > 45deg", "true"},
    {"(0, 45deg, 0) + (1deg, 0, 0)", "(1deg, 45deg, 0)"},
    {"2 * (0, 45deg, 0)", "(0, 90deg, 0)"},
    {"(0, 45deg, 0).y", "45deg"},
    {"(0, 45deg, 0)[1] * 2", "90deg"},
    /* vectors */
    {"(1, 2, 3) + (4, 5, 6)", "(5, 7, 9)"},
    {"(1, 2, 3) * (4, 5, 6)", "(4, 10, 18)"},
    {"2 * (1, 2) + 1", "(3, 5)"},
    {"1 - (1, 2)", "(0, -1)"},
    {"-(1, 2, 3) / 2", "(-0.5, -1, -1.5)"},
    {"(1, 2, 3) == (1, 2, 3)", "true"},
    {"(1, 2, 3) != (1, 2, 4)", "true"},
    {"v.x + v.y + v.z + v.r + v.g + v.b", "12"},
    {"v[2]", "3"},
    {"#ff0033", "(1, 0, 0.2)"},
    {"#ff0033.b * 5", "1"},
    /* lists and strings */
    {"[1, \"a\", true, [], (1, 2)]", "[1, a, true, [], (1, 2)]"},
    {"[1, 2] + [3]", "[1, 2, 3]"},
    {"[1, [2, 3]][1][0]", "2"},
    {"[(1, 2)][0].y", "2"},
    {"[i * i for i in range(4)]", "[0, 1, 4, 9]"},
    {"[[j for j in range(i)] for i in range(3)]", "[[], [0], [0, 1]]"},
    {"[\"a\" + str(i) for i in list]", "[a1, a2, a3]"},
    {"[1, [2]] == [1, [2]]", "true"},
    {"[1, 2] == [1, 3]", "false"},
    {"[1] == [1, 2]", "false"},
    {"\"a\" + \"b\" + \"\"", "ab"},
    {"\"a\" == \"a\" && \"a\" != \"b\"", "true"},
    {"range(3)", "[0, 1, 2]"},
    {"range(0)", "[]"},
    {"range(-3)", "[]"},
    {"range(2, 5)", "[2, 3, 4]"},
    {"range(5, 2)", "[]"},
    {"range(0, 7, 3)", "[0, 3, 6]"},
    {"range(5, 0, -2)", "[5, 3, 1]"},
    {"range(10)[3] + len(range(10))", "13"},
    {"range(3) + range(2) == [0, 1, 2, 0, 1]", "true"},
    {"steps(0, 1, 3)", "[0, 0.5, 1]"},
    {"steps(1, 2, 1)", "[1]"},
    {"steps(1, 2, 0)", "[]"},
    {"steps((0, 0), (1, 2), 3)[1]", "(0.5, 1)"},
    {"steps(0, 90deg, 4)", "[0deg, 30deg, 60deg, 90deg]"},
    {"steps(0, 0.1, 11)[10] == 0.1", "true"},
    {"len(\"caf\\u{e9}\") + len(list) * 10 + len((1, 2)) * 100", "234"},
    /* str */
    {"str(0.1) + str(1e300) + str(-0.5)", "0.11e+300-0.5"},
    {"str(pi, 3)", "3.142"},
    {"str(2.5, digits = 0) + str((1, 2), 1)", "2(1.0, 2.0)"},
    {"str(true) + str(\"x\") + str(45deg, 1)", "truex45.0deg"},
    {"gold", "lambert gold"},
    {"(gold { diffuse: 1 }) == gold", "false"},
    {"(gold { diffuse: 1 })", "lambert"},
    {"gold == gold", "true"},
    /* functions */
    {"abs(-2) + abs((-1, 1, -1)).x", "3"},
    {"abs(-45deg)", "45deg"},
    {"sign((-3, 0, 5))", "(-1, 0, 1)"},
    {"sign(-45deg)", "-1"},
    {"floor(-1.5) + 10 * ceil(-1.5)", "-12"},
    {"round((0.5, 1.4, -0.5))", "(1, 1, -1)"},
    {"sqrt(9) + exp(0) + log(1)", "4"},
    {"sin(90deg) + cos(180deg) + sin(0) + cos(0)", "1"},
    {"cos(90deg) == 0 && sin(180deg) == 0", "true"},
    {"round(tan(45deg))", "1"},
    {"asin(1) + acos(1)", "90deg"},
    {"acos(-1) == 180deg", "true"},
    {"atan2(1, 0)", "90deg"},
    {"atan2(y = -1, x = 0)", "-90deg"},
    {"min(3, 1, 2) + 10 * max(3, 1, 2)", "31"},
    {"min((1, 5), 3)", "(1, 3)"},
    {"max(10deg, 20deg, 0)", "20deg"},
    {"min(4)", "4"},
    {"clamp(5, 0, 1) + clamp(-5, 0, 1) + clamp(0.5, 0, 1)", "1.5"},
    {"clamp((-1, 0.5, 2), 0, 1)", "(0, 0.5, 1)"},
    {"lerp(1, 3, 0.25)", "1.5"},
    {"lerp((0, 0), (1, 2), 0.5)", "(0.5, 1)"},
    {"lerp(0deg, 90deg, 0.5)", "45deg"},
    {"lerp(1, 2, (0, 0.5, 1))", "(1, 1.5, 2)"},
    {"lerp(0.1, 0.7, 1) == 0.7 && lerp(0.1, 0.7, 0) == 0.1", "true"},
    {"smoothstep(0, 2, 1) + smoothstep(0, 2, -1) + smoothstep(0, 2, 3)", "1.5"},
    {"smoothstep(1, 1, 0.5) + smoothstep(1, 1, 1)", "1"},
    {"dot((1, 2, 3), (4, 5, 6))", "32"},
    {"dot((1, 2), (3, 4))", "11"},
    {"cross((1, 0, 0), (0, 1, 0))", "(0, 0, 1)"},
    {"length((3, 4)) + length((2, 3, 6)) + length((0, 0, 0))", "12"},
    {"abs(length((3e200, 4e200, 0)) / 5e200 - 1) < 1e-15", "true"},
    {"normalize((0, 0, 5))", "(0, 0, 1)"},
    {"normalize((3, 4))", "(0.6, 0.8)"},
    {"distance((1, 1), (4, 5))", "5"},
    {"rotate((1, 0, 0), (0, 0, 2), 90deg)", "(0, 1, 0)"},
    {"rgb(1, 0.5, 0)", "(1, 0.5, 0)"},
    {"hsv(0, 1, 1) + hsv(1 / 3, 1, 1) + hsv(2 / 3, 1, 1)", "(1, 1, 1)"},
    {"hsv(120deg, 1, 1)", "(0, 1, 0)"},
    {"hsv(-0.5, 1, 0.5)", "(0, 0.5, 0.5)"},
    {"hsv(0.7, 0, 0.25)", "(0.25, 0.25, 0.25)"},
    {"rand(1) == rand(1) && rand(1) != rand(2) && rand(1, 2) != rand(2, 1)", "true"},
    {"rand(0) == rand(-0) && rand((1, 2)) != rand(1, 2)", "true"},
    {"[0 <= rand(i) && rand(i) < 1 for i in range(3)]", "[true, true, true]"},
    {"round(max(abs(pi - 3.141592653589793), 0))", "0"},
    /* fn */
    {"f(1)", "(1, 2, 3)"},
    {"f(1, c = 5)", "(1, 2, 5)"},
    {"f(b = 1, a = 2)", "(2, 1, 3)"},
    {"f(1, 2, 3,)", "(1, 2, 3)"},
    {"fact(20)", "2.43290200817664e+18"},
};

/* What a run says first. */
static void check_value(const char *prelude, const char *expression, const char *text)
{
    struct load l;
    char scene[1000];
    snprintf(scene, sizeof scene, "%sassert false, str(%s)", prelude, expression);
    load_eval(&l, scene);
    ck_assert_msg(l.diag.entries.n == 1 && strcmp(load_first(&l), text) == 0, "%s is %s, not %s",
                  expression, load_first(&l), text);
    load_free(&l);
}

START_TEST(value_of_expression)
{
    check_value(PRELUDE, values[_i].expression, values[_i].text);
}
END_TEST

START_TEST(colours_of_models)
{
    check_value("wrt 1 model classic\n", "#80ff00 == (128 / 255, 1, 0)", "true");
    check_value("wrt 1 model modern\n", "str(#80ff00, 6)", "(0.215861, 1.000000, 0.000000)");
    check_value("wrt 1\n", "str(#0a0000, 7)", "(0.0030353, 0.0000000, 0.0000000)");
}
END_TEST

/* ---- statements: the surfaces they make ---- */

/* "kind name(center) radius material" and the image of (1, 1, 1) under the place, one a line. */
static void write_surfaces(FILE *out, const struct desc *d)
{
    for (size_t i = 0; i < d->surfaces.n; i++) {
        const struct desc_object *o = d->surfaces.at[i];
        const struct desc_value *m = desc_get(o, PROP_MATERIAL);
        struct vec3 c = desc_vector(o, PROP_CENTER);
        fprintf(out, "%.*s(%g %g %g) %g %.*s", STR_ARG(o->name), c.x, c.y, c.z,
                desc_number(o, PROP_RADIUS), m && m->object ? (int)m->object->name.n : 1,
                m && m->object ? m->object->name.at : "-");
        if (o->place) {
            struct vec3 p = affine_point(o->place, vec3_all(1));
            fprintf(out, " (%g %g %g)", p.x, p.y, p.z);
        }
        fputs("|", out);
    }
}

#define SCENE                                                                                     \
    "wrt 1 model classic material a = lambert { diffuse: 0 } material b = lambert { diffuse: 0 }" \
    " material c = lambert { diffuse: 0 }\n"
#define BALL "sphere { center: 0  radius: 1 } "

static const struct {
    const char *body, *surfaces;
} statements[] = {
    {"sphere s { center: (1, 2, 3)  radius: 1  material: a }", "s(1 2 3) 1 a|"},
    /* loops and branches */
    {"for i in range(3) { sphere { center: (i, 0, 0)  radius: i + 1 } }",
     "(0 0 0) 1 -|(1 0 0) 2 -|(2 0 0) 3 -|"},
    {"for p in [(1, 2, 3), (4, 5, 6)] { for r in [1, 2] { sphere { center: p  radius: r } } }",
     "(1 2 3) 1 -|(1 2 3) 2 -|(4 5 6) 1 -|(4 5 6) 2 -|"},
    {"for m in [a, b] { sphere { center: 0  radius: 1  material: m } }",
     "(0 0 0) 1 a|(0 0 0) 1 b|"},
    {"for i in [] { " BALL "}", ""},
    {"for i in range(4) { if i == 1 { sphere { center: 1  radius: 1 } } else if i == 2 { sphere {"
     " center: 2  radius: 1 } } else { sphere { center: 3  radius: 1 } } }",
     "(3 3 3) 1 -|(1 1 1) 1 -|(2 2 2) 1 -|(3 3 3) 1 -|"},
    {"if false { " BALL "}", ""},
    /* scopes */
    {"let r = 1 if true { let r = 2 sphere { center: 0  radius: r } } sphere { center: 0  radius: "
     "r }",
     "(0 0 0) 2 -|(0 0 0) 1 -|"},
    {"let i = 7 for i in range(1) { let r = i + 1 sphere { center: i  radius: r } }"
     " sphere { center: i  radius: 1 }",
     "(0 0 0) 1 -|(7 7 7) 1 -|"},
    {"let r = 3 fn f(x) = x * r if true { let r = 100 sphere { center: 0  radius: f(1) } }",
     "(0 0 0) 3 -|"},
    {"fn f(x) = x == 0 ? 1 : g(x - 1) fn g(x) = f(x) + 1 sphere { center: 0  radius: f(3) }",
     "(0 0 0) 4 -|"},
    /* default */
    {"default sphere { radius: 5  material: a } sphere { center: 1 } sphere { center: 2  radius: 1 "
     "}",
     "(1 1 1) 5 a|(2 2 2) 1 a|"},
    {"default sphere { radius: 5  material: a } default sphere { material: b } sphere { center: 1 "
     "}",
     "(1 1 1) 5 b|"},
    {"default sphere { radius: 5  center: 0 } if true { default sphere { radius: 6 } sphere { } }"
     " sphere { }",
     "(0 0 0) 6 -|(0 0 0) 5 -|"},
    {"default lambert { diffuse: (9, 9, 9) } material m = lambert { } sphere { center: 0"
     "  radius: 1  material: m }",
     "(0 0 0) 1 m|"},
    /* groups */
    {"group { " BALL "}", "(0 0 0) 1 -|"},
    {"group { translate: (1, 2, 3) " BALL "}", "(0 0 0) 1 - (2 3 4)|"},
    {"group { " BALL " translate: (1, 2, 3) }", "(0 0 0) 1 - (2 3 4)|"},
    {"group { scale: 2  rotate: (0, 0, 90deg)  translate: (10, 0, 0) " BALL "}",
     "(0 0 0) 1 - (8 2 2)|"},
    {"group { rotate: (0, 0, 90) " BALL "}", "(0 0 0) 1 - (-1 1 1)|"},
    {"group { matrix: [1, 0, 0, 5, 0, 2, 0, 0, 0, 0, 3, 0] " BALL "}", "(0 0 0) 1 - (6 2 3)|"},
    {"group { translate: (1, 0, 0) group { scale: 2 " BALL "} " BALL "} " BALL,
     "(0 0 0) 1 - (3 2 2)|(0 0 0) 1 - (2 1 1)|(0 0 0) 1 -|"},
    {"group { let d = 4  translate: (d, 0, 0) " BALL "}", "(0 0 0) 1 - (5 1 1)|"},
    {"group { material: a " BALL
     "sphere { center: 0  radius: 1  material: b } group { material: c " BALL "} group { " BALL
     "} }",
     "(0 0 0) 1 a|(0 0 0) 1 b|(0 0 0) 1 c|(0 0 0) 1 a|"},
    {"default sphere { material: a } group { material: b " BALL "} " BALL,
     "(0 0 0) 1 b|(0 0 0) 1 a|"},
    {"group { material: b  default sphere { material: a  radius: 7 } sphere { center: 0 } }",
     "(0 0 0) 7 b|"},
    {"group { " BALL "  material: a }", "(0 0 0) 1 a|"},
    /* templates */
    {"define d(x, m = a) { sphere { center: x  radius: 1  material: m } } d(1) d(2, b) d(m = c, x "
     "= 3)",
     "(1 1 1) 1 a|(2 2 2) 1 b|(3 3 3) 1 c|"},
    {"define d() { " BALL "} d() { material: a  translate: (1, 0, 0) } d() { }",
     "(0 0 0) 1 a (2 1 1)|(0 0 0) 1 -|"},
    {"define d() { " BALL "} define e() { d() { translate: (1, 0, 0) } } e() { scale: 3 } e()",
     "(0 0 0) 1 - (6 3 3)|(0 0 0) 1 - (2 1 1)|"},
    {"let r = 2 define d() { sphere { center: 0  radius: r } } if true { let r = 9 d() }",
     "(0 0 0) 2 -|"},
    {"define d() { " BALL
     "} default sphere { material: a } if true { default sphere { material: b } d() }",
     "(0 0 0) 1 a|"},
    {"define d(n) { for i in range(n) { sphere { center: i  radius: 1 } } } d(2) d(1)",
     "(0 0 0) 1 -|(1 1 1) 1 -|(0 0 0) 1 -|"},
};

START_TEST(surfaces_of_statements)
{
    struct load l;
    char scene[2000], *text;
    size_t n;
    snprintf(scene, sizeof scene, SCENE "%s\n", statements[_i].body);
    ck_assert_msg(load_eval(&l, scene), "%s: %s", statements[_i].body, load_first(&l));
    FILE *out = open_memstream(&text, &n);
    write_surfaces(out, &l.desc);
    fclose(out);
    ck_assert_msg(strcmp(text, statements[_i].surfaces) == 0, "%s: %s", statements[_i].body, text);
    free(text);
    load_free(&l);
}
END_TEST

/* Places are shared, so that a million members cost a pointer each. */
START_TEST(places_are_shared)
{
    struct load l;
    ck_assert_msg(load_eval(&l, SCENE "group { translate: (1, 0, 0) " BALL BALL
                                      "light point { } group { material: a " BALL "} }"),
                  "%s", load_first(&l));
    const struct affine *place = l.desc.surfaces.at[0]->place;
    ck_assert_ptr_nonnull(place);
    ck_assert_ptr_eq(l.desc.surfaces.at[1]->place, place);
    ck_assert_ptr_eq(l.desc.surfaces.at[2]->place, place);
    ck_assert_ptr_eq(l.desc.lights.at[0]->place, place);
    load_free(&l);
}
END_TEST

/* ---- mistakes ---- */

static const struct {
    const char *body, *findings; /* "code:text at its place" each */
} mistakes[] = {
    /* names */
    {"let a = 1", "E105:a|"},
    {"let x = y", "E104:y|"},
    {"let x = x", "E104:x|"},
    {"let f = sin", "E109:sin|"},
    {"let f = 1 let g = f(2)", "E109:f|"},
    {"let g = nosuch(y, 2)", "E104:nosuch|E104:y|"},
    {"fn f(a, a) = 1", "E105:a|"},
    {"define d() { } let x = d()", "E109:d()|"},
    {"define d() { } let x = d", "E109:d|"},
    {"fn f() = 1 f()", "E104:f|"},
    {"nosuch()", "E104:nosuch|"},
    {"define d() { } d { }", "E101:d|"},
    {"if true { let x = 1 } let z = x", "E104:x|"},
    /* types */
    {"let x = 1 + \"a\"", "E109:1 + \"a\"|"},
    {"let x = 1 + 2 + true * 3", "E109:true * 3|"},
    {"let x = 90 + 90deg", "E109:90 + 90deg|"},
    {"let x = 90deg * 90deg", "E109:90deg * 90deg|"},
    {"let x = 1 / 90deg", "E109:1 / 90deg|"},
    {"let x = 2 ^ 90deg", "E109:2 ^ 90deg|"},
    {"let x = (1, 2) + (1, 2, 3)", "E109:(1, 2) + (1, 2, 3)|"},
    {"let x = 1 < 2 < 3", "E109:1 < 2 < 3|"},
    {"let x = 1 == \"a\"", "E109:1 == \"a\"|"},
    {"let x = 1 == 1deg", "E109:1 == 1deg|"},
    {"let x = \"a\" < \"b\"", "E109:\"a\" < \"b\"|"},
    {"let x = !1", "E109:!1|"},
    {"let x = 1 && true", "E109:1|"},
    {"let x = 1 ? 2 : 3", "E109:1|"},
    {"if 1 { }", "E109:1|"},
    {"for i in 3 { }", "E109:3|"},
    {"let x = [i for i in (1, 2)]", "E109:(1, 2)|"},
    {"let x = (1, 2).z", "E109:z|"},
    {"let x = (1, 2, 3).w", "E109:w|"},
    {"let x = [1, 2].x", "E109:x|"},
    {"let x = \"a\"[0]", "E109:[0]|"},
    {"let x = [1][0.5]", "E109:0.5|"},
    {"let x = [1][1deg]", "E109:1deg|"},
    {"let x = sin(30)", "E109:30|"},
    {"let x = sin(\"a\")", "E109:\"a\"|"},
    {"let x = cross((1, 2), (3, 4))", "E109:(1, 2)|E109:(3, 4)|"},
    {"let x = dot((1, 2), (1, 2, 3))", "E109:(1, 2)|"},
    {"let x = min(1, 2deg)", "E109:1|"},
    {"let x = floor(90deg)", "E109:90deg|"},
    {"let x = lerp((1, 2), (3, 4), (1, 2, 3))", "E109:(1, 2, 3)|"},
    {"let x = range(1.5)", "E109:1.5|"},
    {"let x = range(step = 2, a = 3)", "E123:2|"},
    {"let x = steps(0, 1, -1)", "E109:-1|"},
    {"let x = str(1, 0.5)", "E109:0.5|"},
    {"let x = len(1)", "E109:1|"},
    {"assert 1, \"x\"", "E109:1|"},
    {"assert false, 1", "E109:1|"},
    /* limits */
    {"let x = range(20000000)", "E006:range(20000000)|"},
    {"let x = steps(0, 1, 20000000)", "E006:steps(0, 1, 20000000)|"},
    {"fn f(n) = f(n + 1) let x = f(0)", "E005:f(n + 1)|"},
    {"fn f(n) = f(n + 1) + f(n + 1) let x = f(0) let y = z", "E005:f(n + 1)|E104:z|"},
    {"fn f(n) = n == 0 ? 0 : 1 + f(n - 1) let x = f(255)", ""},
    {"fn f(n) = n == 0 ? 0 : 1 + f(n - 1) let x = f(256)", "E005:f(n - 1)|"},
    /* where statements may stand */
    {"radius: 1", "E010::|"},
    {"if true { radius: 1 }", "E108:radius|"},
    {"if true { param p = 1 }", "E108:p|"},
    {"for i in [1] { define d() { } }", "E108:d|"},
    {"group { param p = 1 }", "E108:p|"},
    {"define d() { param p = 1 } d()", "E108:p|"},
    {"if true { model classic }", "E108:classic|"},
    {"group { camera { } }", "E108:camera|"},
    {"define d() { camera { } } d()", "E108:camera|"},
    {"sphere { let x = 1 }", "E108:x|"},
    {"define d() { } d() { " BALL "}", "E108:sphere|"},
    {"define d() { } d() { radius: 1 }", "E102:radius|"},
    {"light point lamp { } sphere a b { center: 0  radius: 1  material: a }", "E108:b|"},
    /* groups */
    {"group { matrix: [1, 2] }", "E110:[1, 2]|"},
    {"group { matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0] }",
     "E118:[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0]|"},
    {"group { scale: (1, 0, 1) }", "E118:(1, 0, 1)|"},
    {"group { scale: 1  matrix: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0] }", "E117:scale|"},
    {"group { rotate: 45deg }", "E109:45deg|"},
    {"group { translate: (1deg, 0, 0) }", "E109:(1deg, 0, 0)|"},
    {"group { radius: 1 }", "E102:radius|"},
    {"group { material: 1 " BALL "}", "E109:1|"},
    /* default */
    {"default group { }", "E101:group|"},
    {"default sphre { }", "E101:sphre|"},
    {"default sphere x { }", "E101:sphere|"},
    {"default light { }", "E112:light|"},
    {"default sphere { radius: -1  center: 0  material: a } sphere { } sphere { }", "E111:-1|"},
    /* found later, about what is made inside */
    {"define d(r) { sphere { center: 0  radius: r  material: a } } d(1) d(-1) d(-2)",
     "E111:r|E111:r|"},
    {"define d(r) { sphere { center: 0  radius: r  material: a } } for i in [1, -1, -2] { d(i) }",
     "E111:r|"},
    {"for i in range(3) { sphere { center: 0  material: a } }", "E112:sphere|"},
    {"sphere { if true { radius: 1 }  center: 0  material: lambert { diffuse: 1 } }",
     "E108:if true { radius: 1 }|"},
    /* what was not read is not missed */
    {"include \"none\" sphere { center: 0  radius: r1  material: f(1) } g() h { }",
     "E201:\"none\"|E101:h|"},
};

START_TEST(mistakes_of_statements)
{
    struct load l;
    char scene[2000], found[500];
    snprintf(scene, sizeof scene,
             SCENE "camera { eye: 0  back: (0, 0, 1)  up: (0, 1, 0)  yfov: 20  resolution: (8, 8) }"
                   " %s\n",
             mistakes[_i].body);
    load_validate(&l, scene);
    load_findings(&l, found, sizeof found);
    ck_assert_msg(strcmp(found, mistakes[_i].findings) == 0, "%s: %s", mistakes[_i].body, found);
    load_free(&l);
}
END_TEST

Suite *language_suite(void)
{
    Suite *s = suite_create("language");
    TCase *t = tcase_create("values");
    tcase_add_loop_test(t, value_of_expression, 0, COUNT(values));
    tcase_add_test(t, colours_of_models);
    suite_add_tcase(s, t);

    t = tcase_create("statements");
    tcase_add_loop_test(t, surfaces_of_statements, 0, COUNT(statements));
    tcase_add_test(t, places_are_shared);
    tcase_add_loop_test(t, mistakes_of_statements, 0, COUNT(mistakes));
    suite_add_tcase(s, t);
    return s;
}
