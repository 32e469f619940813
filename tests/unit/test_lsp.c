/* What the language server does with texts; what it says is in tests/lsp. */
#include "config.h"

#include "unit.h"

#include "lsp/position.h"
#include "lsp/uri.h"

#include <stdlib.h>

#define COUNT(a) (int)(sizeof(a) / sizeof *(a))

/* One line of each end, characters of one to four bytes, and an empty last line. */
static const char text[] = "ab\n"                 /* 0 */
                           "\xC3\xA9x\r\n"        /* 3: e acute */
                           "\xE2\x82\xACy\r"      /* 8: euro */
                           "\xF0\x9D\x84\x9Ez\n"; /* 13: clef */

static const struct {
    uint32_t offset, line;
    uint32_t character[POSITION_ENCODINGS]; /* UTF-16, UTF-8, UTF-32 */
} places[] = {
    {0, 0, {0, 0, 0}},  {1, 0, {1, 1, 1}},  {2, 0, {2, 2, 2}},  {3, 1, {0, 0, 0}},
    {5, 1, {1, 2, 1}},  {6, 1, {2, 3, 2}},  {8, 2, {0, 0, 0}},  {11, 2, {1, 3, 1}},
    {12, 2, {2, 4, 2}}, {13, 3, {0, 0, 0}}, {17, 3, {2, 4, 1}}, {18, 3, {3, 5, 2}},
    {19, 4, {0, 0, 0}},
};

START_TEST(places_go_there_and_back)
{
    struct line_index lines = {0};
    line_index_build(&lines, (struct str){text, sizeof text - 1});
    ck_assert_uint_eq(lines.starts.n, 5);
    for (int e = 0; e < POSITION_ENCODINGS; e++) {
        struct position p = position_of(&lines, places[_i].offset, (enum position_encoding)e);
        ck_assert_uint_eq(p.line, places[_i].line);
        ck_assert_uint_eq(p.character, places[_i].character[e]);
        ck_assert_uint_eq(position_offset(&lines, p, (enum position_encoding)e), places[_i].offset);
    }
    line_index_free(&lines);
}
END_TEST

/* Places that no character has. */
static const struct {
    struct position place;
    enum position_encoding encoding;
    uint32_t offset;
} strays[] = {
    {{0, 3}, POSITION_UTF16, 2},          /* behind the end of a line */
    {{1, 3}, POSITION_UTF16, 6},          /* which does not hold the CR */
    {{1, INT32_MAX}, POSITION_UTF8, 6},   /* far behind */
    {{2, 3}, POSITION_UTF32, 12},         /* before a CR alone */
    {{3, 1}, POSITION_UTF16, 13},         /* between the halves of a pair */
    {{3, 3}, POSITION_UTF8, 13},          /* between bytes */
    {{1, 1}, POSITION_UTF8, 3},           /* likewise */
    {{4, 1}, POSITION_UTF16, 19},         /* behind the end of the text */
    {{5, 0}, POSITION_UTF16, 19},         /* a line behind it */
    {{INT32_MAX, 7}, POSITION_UTF32, 19}, /* far behind */
};

START_TEST(strays_go_to_what_is_near)
{
    struct line_index lines = {0};
    line_index_build(&lines, (struct str){text, sizeof text - 1});
    ck_assert_uint_eq(position_offset(&lines, strays[_i].place, strays[_i].encoding),
                      strays[_i].offset);
    line_index_free(&lines);
}
END_TEST

START_TEST(an_empty_text_has_a_line)
{
    struct line_index lines = {0};
    line_index_build(&lines, (struct str){"", 0});
    struct position p = position_of(&lines, 0, POSITION_UTF16);
    ck_assert_uint_eq(p.line + p.character, 0);
    ck_assert_uint_eq(position_offset(&lines, (struct position){7, 7}, POSITION_UTF16), 0);
    line_index_free(&lines);
}
END_TEST

static const struct {
    const char *uri, *path;
} uris[] = {
    {"file:///a/b%20c.wrt", "/a/b c.wrt"}, {"file:///%C3%A9.wrt", "/\xC3\xA9.wrt"},
    {"file://host/a.wrt", "/a.wrt"},       {"file:/a.wrt", "/a.wrt"},
    {"file:///100%.wrt", "/100%.wrt"},     {"file:///a%2", "/a%2"},
    {"file:///nul%00.wrt", "/nul%00.wrt"}, {"untitled:Untitled-1", "untitled:Untitled-1"},
    {"untitled:a%20b", "untitled:a%20b"},  {"", ""},
};

START_TEST(uris_name_paths)
{
    char *path = uri_to_path(uris[_i].uri);
    ck_assert_str_eq(path, uris[_i].path);
    free(path);
}
END_TEST

START_TEST(paths_make_uris)
{
    struct buffer uri = {0};
    uri_add(&uri, "/a b/\xC3\xA9%#.wrt");
    buffer_add(&uri, "", 1);
    ck_assert_str_eq(uri.at, "file:///a%20b/%C3%A9%25%23.wrt");
    buffer_free(&uri);
}
END_TEST

Suite *lsp_suite(void)
{
    Suite *s = suite_create("lsp");
    TCase *t = tcase_create("texts");
    tcase_add_loop_test(t, places_go_there_and_back, 0, COUNT(places));
    tcase_add_loop_test(t, strays_go_to_what_is_near, 0, COUNT(strays));
    tcase_add_test(t, an_empty_text_has_a_line);
    tcase_add_loop_test(t, uris_name_paths, 0, COUNT(uris));
    tcase_add_test(t, paths_make_uris);
    suite_add_tcase(s, t);
    return s;
}
