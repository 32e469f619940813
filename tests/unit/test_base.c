/* src/base: numbers, strings, memory, source positions, files. */
#include "config.h"

#include "base/arena.h"
#include "base/buffer.h"
#include "base/file.h"
#include "base/map.h"
#include "base/num.h"
#include "base/srcmap.h"
#include "base/str.h"
#include "math/rng.h"

#include "unit.h"

#include <dirent.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define COUNT(a) (int)(sizeof(a) / sizeof *(a))

/* ---- numbers --------------------------------------------------------------------------------- */

static uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* The same text must read as strtod reads it, to the last bit and byte. */
static void check_as_strtod(const char *text)
{
    double x = 0;
    char *end;
    double expected = strtod(text, &end);
    const char *after = num_parse(text, text + strlen(text), &x);
    if (after != end) /* an assertion of the library each time would take most of the time */
        ck_abort_msg("'%s' is read up to '%s'", text, after ? after : "nowhere");
    if (bits_of(x) != bits_of(expected))
        ck_abort_msg("'%s' reads as %.17g, not %.17g", text, x, expected);
}

static const char *const spellings[] = {
    "0",
    "-0",
    "+0",
    "0.0",
    "-.0",
    "1",
    "+1",
    "-1",
    "1.",
    ".5",
    "-.5",
    "5E-1",
    "5e+1",
    "00012.500",
    "123456789012345678901234567890",
    "0.1",
    "0.2",
    "0.3",
    "1e22",
    "1e23",
    "-1e22",
    "9e22",
    /* fast path and its borders: integers about 2^53, powers about 10^22 */
    "9007199254740991",
    "9007199254740992",
    "9007199254740993",
    "9007199254740995",
    "9007199254740993e1",
    "9007199254740991e22",
    "9007199254740991e23",
    "9007199254740991e-22",
    "9007199254740991e-23",
    "9007199254740993.0000000000000000000000000000000000000001",
    "1234567890123456789",
    "12345678901234567890",
    "18446744073709551615",
    "18446744073709551616",
    "999999999999999999999999",
    "0.000000000000000000000000000000123456789012345678",
    /* half-way cases */
    "1.00000000000000011102230246251565404236316680908203125",
    "1.00000000000000011102230246251565404236316680908203124",
    "1.00000000000000011102230246251565404236316680908203126",
    "8.5e15",
    "6.10351562500000000001e-5",
    /* the ends of the range */
    "1.7976931348623157e308",
    "1.7976931348623158e308",
    "1.7976931348623159e308",
    "1e308",
    "1e309",
    "-1e999",
    "2.2250738585072014e-308",
    "2.2250738585072011e-308",
    "2.2250738585072012e-308",
    "4.9406564584124654e-324",
    "5e-324",
    "2.4703282292062327e-324",
    "2.4703282292062328e-324",
    "1e-400",
    "1e-99999999999999999999",
    "1e99999999999999999999",
    "0e99999999999999999999",
    "0."
    "0000000000000000000000000000000000000000000000000000000000000000000000000000000000000000e100",
    "100000000000000000000000000000000000000000000000000000000000000000000000000000000000000e-50",
};

START_TEST(number_as_strtod)
{
    check_as_strtod(spellings[_i]);
}
END_TEST

static const struct {
    const char *text;
    int length; /* bytes read; -1: no number */
} extents[] = {
    {"", -1},     {"-", -1},        {"+", -1},    {".", -1},   {"-.", -1},  {"e5", -1},
    {"nan", -1},  {"inf", -1},      {"-inf", -1}, {"0x10", 1}, {"--1", -1}, {"+-1", -1},
    {" 1", -1},   {"1 2", 1},       {"1e", 1},    {"1e+", 1},  {"1em", 1},  {"1e5.5", 3},
    {"1.5.5", 3}, {"1..5", 2},      {"1,5", 1},   {"1d5", 1},  {"1E5", 3},  {"1e-07x", 5},
    {"1_000", 1}, {"\xd9\xa1", -1},
};

START_TEST(number_extent)
{
    const char *text = extents[_i].text;
    double x;
    const char *after = num_parse(text, text + strlen(text), &x);
    ck_assert_int_eq(after ? (int)(after - text) : -1, extents[_i].length);
}
END_TEST

START_TEST(number_stops_at_the_end)
{
    const char *text = "123456";
    double x;
    for (int n = 1; n <= 6; n++)
        ck_assert_ptr_eq(num_parse(text, text + n, &x), text + n);
    ck_assert_ptr_null(num_parse(text, text, &x));
}
END_TEST

static void spell(char *out, size_t room, double x, uint32_t how)
{
    static const int precisions[] = {15, 16, 17, 3, 0, 20};
    int precision = precisions[how / 3 % COUNT(precisions)];
    if (how % 3 == 0)
        snprintf(out, room, "%.*g", precision, x);
    else if (how % 3 == 1)
        snprintf(out, room, "%.*e", precision, x);
    else
        snprintf(out, room, "%.*f", precision, x);
}

/* Doubles of any size, spelt in several ways. */
START_TEST(number_random)
{
    enum { ROUNDS = SANITIZED(4000, 40000) };
    for (uint32_t i = 0; i < ROUNDS; i++) {
        uint64_t bits = rng_mix(rng_mix(i) ^ (uint64_t)_i);
        double x;
        memcpy(&x, &bits, sizeof x);
        if (i % 2) /* of usual size */
            x = ldexp((double)(int64_t)bits, -40 - (int)(bits & 31));
        if (!isfinite(x))
            continue;
        char text[512];
        spell(text, sizeof text, x, i);
        check_as_strtod(text);
        char printed[NUM_PRINT_BYTES];
        size_t n = num_print(x, printed);
        double back = 0;
        const char *after = num_parse(printed, printed + strlen(printed), &back);
        if (after != printed + n || bits_of(back) != bits_of(x))
            ck_abort_msg("%.17g is printed as %s", x, printed);
    }
}
END_TEST

static const struct {
    double x;
    const char *text;
} printed[] = {
    {0, "0"},
    {-0.0, "-0"},
    {1, "1"},
    {-1.5, "-1.5"},
    {0.1, "0.1"},
    {1.0 / 3, "0.3333333333333333"},
    {1e21, "1e+21"},
    {123456789, "123456789"},
    {0.1 + 0.2, "0.30000000000000004"},
    {5e-324, "5e-324"},
    {DBL_MAX, "1.7976931348623157e+308"},
    {DBL_MIN, "2.2250738585072014e-308"},
    {1e-5, "1e-05"},
};

START_TEST(number_printed)
{
    char text[NUM_PRINT_BYTES];
    num_print(printed[_i].x, text);
    ck_assert_str_eq(text, printed[_i].text);
}
END_TEST

/* ---- strings --------------------------------------------------------------------------------- */

static const struct {
    const char *a, *b;
    unsigned distance;
} distances[] = {
    {"", "", 0},
    {"", "abc", 3},
    {"radius", "radius", 0},
    {"radius", "RADIUS", 0},
    {"radus", "radius", 1},
    {"raduis", "radius", 1},
    {"sphere", "shpere", 1},
    {"kitten", "sitting", 3},
    {"ca", "abc", 3},
    {"centre", "center", 1},
    {"a", "b", 1},
    {"abcdef", "", 6},
};

START_TEST(string_distance)
{
    struct str a = str_of(distances[_i].a), b = str_of(distances[_i].b);
    ck_assert_uint_eq(str_distance(a, b), distances[_i].distance);
    ck_assert_uint_eq(str_distance(b, a), distances[_i].distance);
}
END_TEST

START_TEST(string_distance_of_long_names)
{
    char name[200];
    memset(name, 'x', sizeof name);
    for (size_t n = 60; n < sizeof name; n++) {
        unsigned d = str_distance((struct str){name, n}, (struct str){name, n});
        ck_assert(n <= 63 ? d == 0 : d >= 63);
    }
}
END_TEST

static const struct {
    const char *wanted, *found;
} nearest[] = {
    {"gren", "green"},   {"GREEN", "green"}, {"gold", ""},          {"blu", "blue"},    {"b", ""},
    {"orang", "orange"}, {"", ""},           {"greenish", "green"}, {"greenhouse", ""},
};

START_TEST(string_nearest)
{
    struct str_nearest n = str_nearest_to(str_of(nearest[_i].wanted));
    static const char *const names[] = {"red", "green", "blue", "orange"};
    for (int i = 0; i < COUNT(names); i++)
        str_nearest_try(&n, str_of(names[i]));
    struct str found = str_nearest_found(&n);
    ck_assert_msg(str_is(found, nearest[_i].found), "'%s' finds '%.*s'", nearest[_i].wanted,
                  STR_ARG(found));
}
END_TEST

START_TEST(string_trim)
{
    ck_assert(str_is(str_trim(str_of(" \t\r\n a b \n")), "a b"));
    ck_assert(str_is(str_trim(str_of("ab")), "ab"));
    ck_assert_uint_eq(str_trim(str_of(" \n ")).n, 0);
    ck_assert_uint_eq(str_trim(str_of("")).n, 0);
    ck_assert(str_equal_nocase(str_of("QuaD"), str_of("qUAd")));
    ck_assert(!str_equal_nocase(str_of("[a"), str_of("{a")));
}
END_TEST

static const struct {
    const char *bytes;
    size_t valid; /* bytes */
} utf8[] = {
    {"", 0},
    {"plain", 5},
    {"plain text, longer than a word", 30},
    {"\xc2\x80", 2},
    {"\xdf\xbf", 2},
    {"\xe0\xa0\x80", 3},
    {"\xef\xbf\xbf", 3},
    {"\xf0\x90\x80\x80", 4},
    {"\xf4\x8f\xbf\xbf", 4},
    {"\x80", 0},
    {"a\xbf", 1},
    {"\xc0\x80", 0},
    {"\xc1\xbf", 0},
    {"\xe0\x9f\xbf", 0},
    {"\xed\xa0\x80", 0},
    {"\xed\xbf\xbf", 0},
    {"\xed\x9f\xbf", 3},
    {"\xee\x80\x80", 3},
    {"\xf0\x8f\xbf\xbf", 0},
    {"\xf4\x90\x80\x80", 0},
    {"\xf5\x80\x80\x80", 0},
    {"\xff", 0},
    {"\xfe\xff", 0},
    {"\xc3", 0},
    {"\xe2\x82", 0},
    {"\xf0\x9f\x98", 0},
    {"\xc3(", 0},
    {"\xe2(\xa1", 0},
    {"\xe2\x82(", 0},
    {"eight by\xc3\xa9tes", 13},
    {"1234567\xe2\x82\xac", 10},
    {"12345678\xe2\x82", 8},
    {"12345678\xe2\x82\xac\x80", 11},
};

START_TEST(utf8_valid)
{
    size_t n = strlen(utf8[_i].bytes);
    ck_assert_uint_eq(str_utf8_valid(utf8[_i].bytes, n), utf8[_i].valid);
}
END_TEST

START_TEST(utf8_every_code_point)
{
    for (unsigned long c = 0; c <= 0x10FFFF; c++) {
        char bytes[4];
        size_t n = str_utf8_encode(c, bytes);
        bool surrogate = c >= 0xD800 && c <= 0xDFFF;
        bool control = c < 32 || (c >= 127 && c < 160);
        if (str_utf8_length((unsigned char)bytes[0]) != n ||
            str_utf8_valid(bytes, n) != (surrogate ? 0 : n) ||
            str_control_length(bytes, n) != (control ? n : 0))
            ck_abort_msg("U+%04lX", c);
    }
}
END_TEST

/* ---- memory ---------------------------------------------------------------------------------- */

START_TEST(arena_allocations)
{
    static const size_t sizes[] = {0,      1, 7, 16, 100, 64 * 1024 - 1, 64 * 1024, 64 * 1024 + 1,
                                   1 << 20};
    enum { ROUNDS = 200 };
    struct arena a = {0};
    char *made[ROUNDS];
    for (int i = 0; i < ROUNDS; i++) {
        size_t n = sizes[i % COUNT(sizes)];
        made[i] = arena_zalloc(&a, n, 1);
        ck_assert_ptr_nonnull(made[i]);
        ck_assert_uint_eq((uintptr_t)made[i] % _Alignof(uint64_t), 0);
        for (size_t j = 0; j < n; j += 97)
            ck_assert_int_eq(made[i][j], 0);
        memset(made[i], i, n);
    }
    for (int i = 0; i < ROUNDS; i++) /* nothing overlaps */
        for (size_t j = 0; j < sizes[i % COUNT(sizes)]; j += 97)
            ck_assert_int_eq((unsigned char)made[i][j], (unsigned char)i);
    ck_assert_str_eq(arena_copy(&a, "abcdef", 3), "abc");
    struct arena_mark m = arena_mark(&a);
    char *first = arena_alloc(&a, 100);
    for (size_t n = 1; n < 40 << 20; n *= 3) /* through blocks of every size */
        memset(arena_alloc(&a, n), 1, n);
    arena_release(&a, m);
    ck_assert_ptr_eq(arena_alloc(&a, 100), first);
    ck_assert_uint_eq(a.bytes, m.bytes + 104);
    ck_assert_str_eq(arena_printf(&a, "%d-%s", 7, "x"), "7-x");
    arena_free(&a);
    arena_free(&a);
}
END_TEST

START_TEST(map_of_many)
{
    enum { KEYS = 5000 };
    static char keys[KEYS][16];
    struct map m = {0};
    ck_assert_ptr_null(map_get(&m, str_of("x")));
    for (int round = 0; round < 2; round++) /* the second time replaces */
        for (int i = 0; i < KEYS; i++) {
            snprintf(keys[i], sizeof keys[i], "key %d", i);
            map_set(&m, str_of(keys[i]), &keys[(i + round) % KEYS]);
        }
    ck_assert_uint_eq(m.n, KEYS);
    for (int i = 0; i < KEYS; i++) {
        char key[16];
        snprintf(key, sizeof key, "key %d", i);
        ck_assert_ptr_eq(map_get(&m, str_of(key)), &keys[(i + 1) % KEYS]);
    }
    ck_assert_ptr_null(map_get(&m, str_of("key")));
    ck_assert_ptr_null(map_get(&m, str_of("")));
    map_set(&m, str_of(""), keys);
    ck_assert_ptr_eq(map_get(&m, str_of("")), keys);
    map_free(&m);
}
END_TEST

/* ---- source positions ------------------------------------------------------------------------ */

static struct source *add_text(struct srcmap *m, const char *name, const char *text)
{
    size_t n = strlen(text);
    char *copy = malloc(n + 2);
    ck_assert_ptr_nonnull(copy);
    memcpy(copy, text, n);
    return srcmap_add(m, name, copy, n);
}

static const struct {
    const char *text;
    uint32_t at, line, column;
    const char *line_text;
} places[] = {
    {"", 0, 1, 1, ""},
    {"abc", 0, 1, 1, "abc"},
    {"abc", 3, 1, 4, "abc"},
    {"abc\n", 3, 1, 4, "abc"},
    {"abc\n", 4, 2, 1, ""},
    {"a\nb\nc", 4, 3, 1, "c"},
    {"\n\n\n", 2, 3, 1, ""},
    {"a\r\nbc\r\n", 4, 2, 2, "bc"},
    {"a\r\nbc\r\n", 1, 1, 2, "a"},
    {"a\rb", 2, 1, 3, "a\rb"},
    {"\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80x", 9, 1, 4, "\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80x"},
    {"x\n\xc3\xa9y", 4, 2, 2, "\xc3\xa9y"},
    {"\t\tx", 2, 1, 3, "\t\tx"},
};

START_TEST(place_of_offset)
{
    struct srcmap m = {0};
    add_text(&m, "before", "some\nlines\n");
    struct source *s = add_text(&m, "it", places[_i].text);
    add_text(&m, "behind", "");
    struct location at = srcmap_locate(&m, s->base + places[_i].at);
    ck_assert_ptr_eq(at.source, s);
    ck_assert_uint_eq(at.line, places[_i].line);
    ck_assert_uint_eq(at.column, places[_i].column);
    ck_assert(str_is(at.line_text, places[_i].line_text));
    ck_assert_ptr_eq(s->text + (at.line_base - s->base), at.line_text.at);
    srcmap_free(&m);
}
END_TEST

/* Columns are told faster when places come in order; other orders must give the same. */
START_TEST(places_in_any_order)
{
    static const char text[] = "ab\xc3\xa9"
                               "cd\nx\n\n\xe2\x82\xac\xe2\x82\xac yz\nlast";
    struct srcmap m = {0};
    struct source *s = add_text(&m, "it", text);
    uint32_t n = s->n + 1;
    for (uint32_t i = 0; i < 1000; i++) {
        uint32_t at = (uint32_t)(rng_mix(i) % n), line = 1, column = 1;
        for (uint32_t j = 0; j < at; j++) {
            column = text[j] == '\n' ? 1 : column + ((text[j + 1] & 0xC0) != 0x80);
            line += text[j] == '\n';
        }
        if ((text[at] & 0xC0) == 0x80)
            continue;
        struct location l = srcmap_locate(&m, s->base + at);
        ck_assert_uint_eq(l.line, line);
        ck_assert_uint_eq(l.column, column);
    }
    srcmap_free(&m);
}
END_TEST

START_TEST(places_outside)
{
    struct srcmap m = {0};
    ck_assert_ptr_null(srcmap_locate(&m, 1).source);
    struct source *a = add_text(&m, "a", "abc"), *b = add_text(&m, "b", "def");
    ck_assert_ptr_null(srcmap_locate(&m, 0).source);
    ck_assert_ptr_eq(srcmap_source(&m, a->base), a);
    ck_assert_ptr_eq(srcmap_source(&m, a->base + 3), a);
    ck_assert_ptr_eq(srcmap_source(&m, b->base), b);
    ck_assert_ptr_null(srcmap_source(&m, b->base + 4));
    ck_assert(str_is(srcmap_text(&m, (struct span){a->base + 1, a->base + 3}), "bc"));
    ck_assert(str_is(srcmap_text(&m, (struct span){a->base + 1, a->base + 9}), "bc"));
    ck_assert_uint_eq(srcmap_text(&m, (struct span){0, 0}).n, 0);
    srcmap_free(&m);
}
END_TEST

/* ---- files ----------------------------------------------------------------------------------- */

static char folder[64];

static void make_folder(void)
{
    strcpy(folder, "/tmp/wrt-unit.XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    ck_assert_int_eq(chdir(folder), 0);
}

/* Removes the folder; it must hold `files` files, none of them temporary. */
static void remove_folder(int files)
{
    DIR *d = opendir(".");
    ck_assert_ptr_nonnull(d);
    for (struct dirent *e; (e = readdir(d));) {
        if (e->d_name[0] == '.')
            continue;
        ck_assert_msg(strlen(e->d_name) < 5, "%s is left", e->d_name);
        files--;
        ck_assert_int_eq(remove(e->d_name), 0);
    }
    closedir(d);
    ck_assert_int_eq(files, 0);
    ck_assert_int_eq(chdir("/"), 0);
    ck_assert_int_eq(rmdir(folder), 0);
}

static void check_content(const char *path, const char *expected)
{
    char *data;
    size_t n;
    ck_assert_ptr_null(file_read(path, &data, &n));
    ck_assert_uint_eq(n, strlen(expected));
    ck_assert_int_eq(memcmp(data, expected, n), 0);
    free(data);
}

START_TEST(file_replaced_whole)
{
    struct stat st;
    make_folder();
    mode_t mask = umask(027);
    ck_assert_ptr_null(file_write("new", "first", 5));
    umask(mask);
    check_content("new", "first");
    ck_assert_int_eq(stat("new", &st), 0);
    ck_assert_uint_eq(st.st_mode & 0777, 0640);
    ck_assert_int_eq(chmod("new", 0604), 0);
    ck_assert_int_eq(link("new", "old"), 0);
    ck_assert_ptr_null(file_write("new", "", 0));
    check_content("new", "");
    check_content("old", "first"); /* the old file was never touched */
    ck_assert_int_eq(stat("new", &st), 0);
    ck_assert_uint_eq(st.st_mode & 0777, 0604);
    remove_folder(2);
}
END_TEST

START_TEST(file_behind_symbolic_link)
{
    struct stat st;
    make_folder();
    ck_assert_ptr_null(file_write("real", "1", 1));
    ck_assert_int_eq(symlink("real", "link"), 0);
    ck_assert_ptr_null(file_write("link", "22", 2));
    ck_assert_int_eq(lstat("link", &st), 0);
    ck_assert(S_ISLNK(st.st_mode));
    check_content("real", "22");
    remove_folder(2);
}
END_TEST

START_TEST(file_not_written)
{
    make_folder();
    ck_assert_int_eq(mkdir("dir", 0777), 0);
    ck_assert_ptr_null(file_write("a", "1", 1));
    ck_assert_ptr_nonnull(file_write("dir", "x", 1));
    ck_assert_ptr_nonnull(file_write("dir/", "x", 1));
    ck_assert_ptr_nonnull(file_write("none/a", "x", 1));
    ck_assert_ptr_nonnull(file_write("a/b", "x", 1));
    ck_assert_ptr_nonnull(file_write("", "x", 1));
    check_content("a", "1");
    ck_assert_ptr_null(file_write("/dev/null", "x", 1));
    if (access("/dev/full", W_OK) == 0)
        ck_assert_ptr_nonnull(file_write("/dev/full", "x", 1));
    remove_folder(2);
}
END_TEST

START_TEST(file_not_read)
{
    char *data;
    size_t n;
    const char *reason;
    make_folder();
    ck_assert_ptr_nonnull(file_read("none", &data, &n));
    ck_assert_ptr_nonnull(file_read(".", &data, &n));
    ck_assert(!file_readable(NULL, "none", &reason) && reason);
    ck_assert(!file_readable(NULL, ".", &reason) && reason);
    ck_assert_ptr_null(file_write("a", "1", 1));
    ck_assert(file_readable(NULL, "a", &reason) && !reason);
    int fd = open("big", O_CREAT | O_WRONLY, 0666); /* one hole */
    ck_assert_int_ge(fd, 0);
    ck_assert_int_eq(ftruncate(fd, (off_t)FILE_SIZE_LIMIT + 1), 0);
    close(fd);
    ck_assert_ptr_nonnull(strstr(file_read("big", &data, &n), "too large"));
    remove_folder(2);
}
END_TEST

static const struct {
    const char *beside, *name, *path;
} resolutions[] = {
    {"scene.xml", "a.png", "a.png"},
    {"in/scene.xml", "a.png", "in/a.png"},
    {"/x/scene.xml", "b/a.png", "/x/b/a.png"},
    {"in/scene.xml", "/a.png", "/a.png"},
    {"-", "a.png", "a.png"},
    {"in/scene.xml", "../a.png", "in/../a.png"},
    {"scene.xml", "-", "./-"},
    {"in/scene.xml", "-", "in/-"},
    {"in/scene.xml", "", "in/"},
};

START_TEST(file_resolved)
{
    const char *name = resolutions[_i].name;
    char *path = file_resolve(resolutions[_i].beside, name, strlen(name));
    ck_assert_str_eq(path, resolutions[_i].path);
    free(path);
}
END_TEST

START_TEST(buffer_grows)
{
    struct buffer b = {0};
    buffer_add(&b, "", 0);
    ck_assert_uint_eq(b.n, 0);
    buffer_puts(&b, "ab");
    for (int i = 0; i < 10; i++) /* from itself, while it moves */
        buffer_add(&b, b.at, b.n);
    ck_assert_uint_eq(b.n, 2048);
    for (size_t i = 0; i < b.n; i++)
        ck_assert_int_eq(b.at[i], i % 2 ? 'b' : 'a');
    b.n = 0;
    buffer_printf(&b, "%s %d", "x", 12);
    buffer_printf(&b, "%s", "");
    buffer_str(&b, (struct str){" yz", 2});
    buffer_number(&b, -0.1);
    ck_assert(str_is((struct str){b.at, b.n}, "x 12 y-0.1"));
    buffer_free(&b);
    ck_assert_ptr_null(b.at);
}
END_TEST

START_TEST(string_begins)
{
    ck_assert(str_begins(str_of("abc"), "ab"));
    ck_assert(str_begins(str_of("abc"), "abc"));
    ck_assert(str_begins(str_of("abc"), ""));
    ck_assert(!str_begins(str_of("abc"), "abcd"));
    ck_assert(!str_begins(str_of("abc"), "b"));
}
END_TEST

static const struct {
    const char *beside, *path, *relative;
} relatives[] = {
    {"a.pov", "t.png", "t.png"},
    {"a.pov", "in/t.png", "in/t.png"},
    {"out/a.pov", "t.png", "../t.png"},
    {"out/a.pov", "in/t.png", "../in/t.png"},
    {"out/a.pov", "out/t.png", "t.png"},
    {"out/a.pov", "out/deep/t.png", "deep/t.png"},
    {"out/deep/a.pov", "out/t.png", "../t.png"},
    {"out/deep/a.pov", "in/../t.png", "../../t.png"},
    {"out/../in/a.pov", "inn/t.png", "../inn/t.png"},
    {"inn/a.pov", "in/t.png", "../in/t.png"},
    {"-", "in/t.png", "in/t.png"},
    {"out/a.pov", "/t.png", "/t.png"},
    {"none/a.pov", "t.png", "t.png"},
    {"out/a.pov", "none/t.png", "none/t.png"},
};

START_TEST(file_made_relative)
{
    make_folder();
    ck_assert_int_eq(mkdir("in", 0777), 0);
    ck_assert_int_eq(mkdir("inn", 0777), 0);
    ck_assert_int_eq(mkdir("out", 0777), 0);
    ck_assert_int_eq(mkdir("out/deep", 0777), 0);
    char *relative = file_relative(relatives[_i].beside, relatives[_i].path);
    ck_assert_str_eq(relative, relatives[_i].relative);
    free(relative);
    rmdir("out/deep");
    remove_folder(3);
}
END_TEST

Suite *base_suite(void)
{
    Suite *s = suite_create("base");
    TCase *t = tcase_create("numbers");
    tcase_set_timeout(t, 60);
    tcase_add_loop_test(t, number_as_strtod, 0, COUNT(spellings));
    tcase_add_loop_test(t, number_extent, 0, COUNT(extents));
    tcase_add_test(t, number_stops_at_the_end);
    tcase_add_loop_test(t, number_random, 0, 4);
    tcase_add_loop_test(t, number_printed, 0, COUNT(printed));
    suite_add_tcase(s, t);

    t = tcase_create("strings");
    tcase_set_timeout(t, 60);
    tcase_add_loop_test(t, string_distance, 0, COUNT(distances));
    tcase_add_test(t, string_distance_of_long_names);
    tcase_add_loop_test(t, string_nearest, 0, COUNT(nearest));
    tcase_add_test(t, string_trim);
    tcase_add_test(t, string_begins);
    tcase_add_loop_test(t, utf8_valid, 0, COUNT(utf8));
    tcase_add_test(t, utf8_every_code_point);
    suite_add_tcase(s, t);

    t = tcase_create("memory");
    tcase_add_test(t, arena_allocations);
    tcase_add_test(t, map_of_many);
    tcase_add_test(t, buffer_grows);
    suite_add_tcase(s, t);

    t = tcase_create("places");
    tcase_add_loop_test(t, place_of_offset, 0, COUNT(places));
    tcase_add_test(t, places_in_any_order);
    tcase_add_test(t, places_outside);
    suite_add_tcase(s, t);

    t = tcase_create("files");
    tcase_add_test(t, file_replaced_whole);
    tcase_add_test(t, file_behind_symbolic_link);
    tcase_add_test(t, file_not_written);
    tcase_add_test(t, file_not_read);
    tcase_add_loop_test(t, file_resolved, 0, COUNT(resolutions));
    tcase_add_loop_test(t, file_made_relative, 0, COUNT(relatives));
    suite_add_tcase(s, t);
    return s;
}
