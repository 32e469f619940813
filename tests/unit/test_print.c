/* Layout and differences; whole scenes are the property tests' and the golden cases' business. */
#include "config.h"

#include "load.h"
#include "unit.h"

#include "base/linediff.h"
#include "print/layout.h"
#include "print/printer.h"

#include <stdlib.h>

/* ---- layout ---- */

static struct str text_of(const struct buffer *b)
{
    return (struct str){b->at, b->n};
}

/* `n` words of `length` letters in brackets, in a group or a filled one. */
static void lay_out(struct buffer *out, unsigned n, size_t length, bool fill)
{
    static const char letters[] =
        "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa";
    struct layout l = {.out = out};
    layout_open(&l, false);
    layout_text(&l, str_of("["));
    layout_indent(&l, LAYOUT_INDENT);
    for (unsigned i = 0; i < n; i++) {
        layout_break(&l, (struct layout_break){.width = i > 0, .fill = fill && i > 0});
        layout_text(&l, (struct str){letters, length});
    }
    layout_indent(&l, -LAYOUT_INDENT);
    layout_break(&l, (struct layout_break){0});
    layout_text(&l, str_of("]"));
    layout_close(&l);
    layout_flush(&l);
    layout_free(&l);
}

static const struct {
    unsigned n;
    size_t length;
    bool fill;
    size_t lines;
} groups[] = {
    {4, 23, false, 1}, /* 4 * 23 + 3 + 2 = 97 */
    {2, 49, false, 4}, /* 2 * 49 + 1 + 2 = 101 */
    {7, 14, false, 9}, /* 7 * 14 + 6 + 2 = 106 */
    {7, 14, true, 4},  /* six and one */
    {12, 15, true, 4}, /* six and six */
    {1, 60, true, 1},
};

START_TEST(group_fits_or_breaks)
{
    struct buffer out = {0};
    lay_out(&out, groups[_i].n, groups[_i].length, groups[_i].fill);
    size_t lines = 1, column = 0;
    for (size_t i = 0; i < out.n; i++) {
        lines += out.at[i] == '\n';
        column = out.at[i] == '\n' ? 0 : column + 1;
        ck_assert_uint_le(column, LAYOUT_COLUMNS);
        if (out.at[i] == '\n')
            ck_assert_int_ne(out.at[i - 1], ' ');
    }
    ck_assert_uint_eq(lines, groups[_i].lines);
    buffer_free(&out);
}
END_TEST

START_TEST(group_of_exactly_the_width)
{
    struct buffer out = {0};
    lay_out(&out, 3, 32, false); /* 3 * 32 + 2 + 2 */
    ck_assert_uint_eq(out.n, LAYOUT_COLUMNS);
    ck_assert_ptr_null(memchr(out.at, '\n', out.n));
    buffer_free(&out);
}
END_TEST

/* ---- differences ---- */

static const struct {
    const char *a, *b, *difference;
} differences[] = {
    {"", "", ""},
    {"a\n", "a\n", ""},
    {"", "a\n", "--- x\n+++ y\n@@ -0,0 +1 @@\n+a\n"},
    {"a\n", "", "--- x\n+++ y\n@@ -1 +0,0 @@\n-a\n"},
    {"a", "a\n", "--- x\n+++ y\n@@ -1 +1 @@\n-a\n\\ No newline at end of file\n+a\n"},
    {"a\nb\nc\n", "a\nx\nc\n", "--- x\n+++ y\n@@ -1,3 +1,3 @@\n a\n-b\n+x\n c\n"},
    {"a\nb\nc\nd\n", "b\nc\nd\ne\n", "--- x\n+++ y\n@@ -1,4 +1,4 @@\n-a\n b\n c\n d\n+e\n"},
    {"1\n2\n3\n4\n5\n6\n7\n8\n9\n", "x\n2\n3\n4\n5\n6\n7\n8\ny\n",
     "--- x\n+++ y\n@@ -1,4 +1,4 @@\n-1\n+x\n 2\n 3\n 4\n@@ -6,4 +6,4 @@\n 6\n 7\n 8\n-9\n+y\n"},
};

START_TEST(difference_of_texts)
{
    struct buffer out = {0};
    linediff("x", str_of(differences[_i].a), "y", str_of(differences[_i].b), &out);
    ck_assert_msg(str_is(text_of(&out), differences[_i].difference), "%.*s", (int)out.n, out.at);
    buffer_free(&out);
}
END_TEST

/* What a difference makes of the first text. */
static void apply(struct str a, struct str difference, struct buffer *out)
{
    size_t line = 1; /* of a, from 1 */
    for (const char *at = difference.at, *end = at + difference.n; at < end;) {
        size_t n = (size_t)((const char *)memchr(at, '\n', (size_t)(end - at)) + 1 - at);
        size_t begin = at[0] == '@' ? strtoul(at + 4, NULL, 10) : line;
        bool heads = at[0] == '@' || strncmp(at, "--- ", 4) == 0 || strncmp(at, "+++ ", 4) == 0;
        for (; a.n && line < begin; line++) {
            size_t length = (size_t)((const char *)memchr(a.at, '\n', a.n) + 1 - a.at);
            buffer_add(out, a.at, length);
            a = (struct str){a.at + length, a.n - length};
        }
        if (!heads && at[0] != '+') {
            ck_assert(a.n >= n - 1 && memcmp(a.at, at + 1, n - 1) == 0);
            a = (struct str){a.at + n - 1, a.n - (n - 1)};
            line++;
        }
        if (!heads && at[0] != '-')
            buffer_add(out, at + 1, n - 1);
        at += n;
    }
    buffer_str(out, a);
}

/* Lines of few kinds, so that many ways of matching them exist. */
static void random_lines(struct buffer *out, unsigned seed, size_t n, unsigned kinds)
{
    for (uint32_t x = seed; n > 0; n--) {
        x = x * 1664525 + 1013904223;
        buffer_printf(out, "%u\n", (x >> 16) % kinds);
    }
}

START_TEST(difference_makes_one_of_the_other)
{
    struct buffer a = {0}, b = {0}, difference = {0}, made = {0};
    unsigned seed = (unsigned)_i;
    size_t most = _i == 0 ? 3000 : 60; /* the first is beyond the limit of the search */
    random_lines(&a, seed * 2, most - seed % 7, 2 + seed % 5);
    random_lines(&b, seed * 2 + 1, most - seed % 11, 2 + seed % 5);
    linediff("x", text_of(&a), "y", text_of(&b), &difference);
    apply(text_of(&a), text_of(&difference), &made);
    ck_assert(str_equal(text_of(&made), text_of(&b)));
    buffer_free(&a);
    buffer_free(&b);
    buffer_free(&difference);
    buffer_free(&made);
}
END_TEST

/* ---- scenes ---- */

static const struct {
    const char *text, *printed;
} scenes[] = {
    {"wrt 1", "wrt 1\n"},
    {"// a", "// a\n"},
    {"\n\n/* a */ wrt 1\n\n\n// b", "/* a */ wrt 1\n\n// b\n"},
    {"wrt 1 let a = 1 .x let b = 1. .x let c = 1[0].x",
     "wrt 1\nlet a = 1 .x\nlet b = 1. .x\nlet c = 1[0].x\n"},
    {"wrt 1 let a = - - 1 let b = !-a let c = a - -b",
     "wrt 1\nlet a = --1\nlet b = !-a\nlet c = a - -b\n"},
    {"wrt 1 a{b:1;;c:2,}", "wrt 1\na { b: 1  c: 2 }\n"},
    {"wrt 1 a{b:1\n\n\nc:2 // d\n}", "wrt 1\na {\n  b: 1\n\n  c: 2 // d\n}\n"},
    {"wrt 1 a{\n\n\nb:1\n\n}", "wrt 1\na { b: 1 }\n"},
    {"wrt 1 a{b{}}", "wrt 1\na {\n  b {}\n}\n"},
    {"wrt 1 let a = ( 1 , // b\n2)", "wrt 1\nlet a = (\n  1, // b\n  2\n)\n"},
    {"wrt 1 let a = [ /* b */ ]", "wrt 1\nlet a = [\n  /* b */\n]\n"},
    {"<a/>", "<a/>\n"},
    {"<a></a>", "<a/>\n"},
    {"<a> x  y </a>", "<a>x  y</a>\n"},
    {"<a> 1\n\n 2 </a>", "<a>1 2</a>\n"},
    {"<a> <!-- b -->\n\n\n <c/></a >", "<a> <!-- b -->\n\n  <c/>\n</a>\n"},
    {"<a>x<b/></a>", "<a>x<b/></a>\n"},
    {"<a b = '\"' c=\"&lt;\"/>", "<a b='\"' c=\"&lt;\"/>\n"},
};

START_TEST(scene_printed)
{
    struct load l;
    struct buffer out = {0};
    load_parse(&l, scenes[_i].text);
    ck_assert_msg(l.diag.errors == 0, "%s", load_first(&l));
    print_scene(&l.ast, &out);
    ck_assert_msg(str_is(text_of(&out), scenes[_i].printed), "%.*s", (int)out.n, out.at);
    buffer_free(&out);
    load_free(&l);
}
END_TEST

Suite *print_suite(void)
{
    Suite *s = suite_create("print");
    TCase *t = tcase_create("layout");
    tcase_add_loop_test(t, group_fits_or_breaks, 0, COUNT(groups));
    tcase_add_test(t, group_of_exactly_the_width);
    suite_add_tcase(s, t);

    t = tcase_create("differences");
    tcase_add_loop_test(t, difference_of_texts, 0, COUNT(differences));
    tcase_add_loop_test(t, difference_makes_one_of_the_other, 0, 200);
    suite_add_tcase(s, t);

    t = tcase_create("scenes");
    tcase_add_loop_test(t, scene_printed, 0, COUNT(scenes));
    suite_add_tcase(s, t);
    return s;
}
