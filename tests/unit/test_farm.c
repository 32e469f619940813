/* Work shared by time and machines: checksums, fingerprints, files of tiles, parts. */
#include "config.h"

#include "base/hash.h"
#include "farm/journal.h"
#include "farm/parts.h"
#include "scene/fingerprint.h"

#include "load.h"
#include "unit.h"

#include <string.h>

/* ---- checksums ---- */

static const struct {
    const char *text;
    uint64_t sum;
} sums[] = {
    {"", UINT64_C(0xef46db3751d8e999)},
    {"a", UINT64_C(0xd24ec4f1a98c6e5b)},
    {"abc", UINT64_C(0x44bc2cf5ad770999)},
    {"Nobody inspects the spammish repetition", UINT64_C(0xfbcea83c8a378bf1)},
};

START_TEST(hash_known)
{
    ck_assert_uint_eq(hash_of(sums[_i].text, strlen(sums[_i].text), 0), sums[_i].sum);
}
END_TEST

START_TEST(hash_in_pieces)
{
    uint8_t bytes[200];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (uint8_t)(i * 7);
    for (size_t n = 0; n <= sizeof bytes; n += 3) {
        for (size_t piece = 1; piece < 70; piece += 5) {
            struct hash h;
            hash_begin(&h, 42);
            for (size_t at = 0; at < n; at += piece)
                hash_add(&h, bytes + at, n - at < piece ? n - at : piece);
            ck_assert_uint_eq(hash_end(&h), hash_of(bytes, n, 42));
        }
    }
}
END_TEST

/* ---- fingerprints ---- */

#define SCENE                                                                                      \
    "wrt 1\nmodel modern\nsettings { background: 0.1 ambient: 0.2 depth: 4 samples: 2 }\n"         \
    "camera { eye: (0, 1, 9) look_at: (0, 0, 0) up: (0, 1, 0) fov: 30 resolution: (20, 15) }\n"    \
    "light point { position: (3, 4, 5) intensity: 2 }\n"                                           \
    "light sun { direction: (1, -2, 1) intensity: 3 }\n"                                           \
    "light area { intensity: 1 samples: 3 shape: sphere position: (0, 9, 0) size: 1 }\n"           \
    "sphere { center: (0, 0, 0) radius: 1 material: phong { diffuse: 0.5 specular: 0.25 "          \
    "exponent: 20 } }\n"                                                                           \
    "cylinder { base: (1, 0, 0) top: (1, 2, 0) radius: 0.5 material: glass { diffuse: 0 "          \
    "specular: 0.5 exponent: 9 reflection: 0.125 refraction: 0.875 ior: 1.5 } }\n"                 \
    "triangle { vertices: [(0, 0, 0), (1, 0, 0), (0, 1, 0)] material: lambert { diffuse: 1 } }\n"  \
    "group { scale: (1, 2, 3) sphere { center: (5, 5, 5) radius: 2 material: emissive { diffuse: " \
    "7 } } }\n"

/* Every one of these makes another scene of SCENE. */
static const struct {
    const char *from, *to;
} changes[] = {
    {"background: 0.1", "background: 0.11"},
    {"ambient: 0.2", "ambient: 0.21"},
    {"depth: 4", "depth: 5"},
    {"samples: 2", "samples: 3"},
    {"(0, 1, 9)", "(0, 1, 8)"},
    {"look_at: (0, 0, 0)", "look_at: (0, 0, 1)"},
    {"up: (0, 1, 0)", "up: (0, 1, 1)"},
    {"fov: 30", "fov: 31"},
    {"(20, 15)", "(20, 16)"},
    {"(3, 4, 5)", "(3, 4, 5.5)"},
    {"intensity: 2", "intensity: (2, 2, 2.5)"},
    {"(1, -2, 1)", "(1, -2, 0)"},
    {"intensity: 3", "intensity: 4"},
    {"samples: 3 shape", "samples: 4 shape"},
    {"position: (0, 9, 0)", "position: (0, 9, 1)"},
    {"center: (0, 0, 0) radius: 1", "center: (0, 0, 0) radius: 1.0000000000000002"},
    {"diffuse: 0.5", "diffuse: 0.25"},
    {"reflection: 0.125", "reflection: 0.25"},
    {"refraction: 0.875", "refraction: 0.75"},
    {"specular: 0.25", "specular: 0.5"},
    {"exponent: 20", "exponent: 21"},
    {"base: (1, 0, 0)", "base: (1, 0, 0.5)"},
    {"top: (1, 2, 0)", "top: (1, 3, 0)"},
    {"radius: 0.5", "radius: 0.75"},
    {"ior: 1.5", "ior: 1.25"},
    {"(0, 1, 0)] ", "(0, 2, 0)] "},
    {"(1, 2, 3)", "(1, 3, 3)"},
    {"emissive { diffuse: 7 }", "emissive { diffuse: 8 }"},
};

static uint64_t fingerprint_of(const char *text)
{
    struct load l;
    ck_assert_msg(load_lower(&l, "scene.wrt", text), "%s", load_first(&l));
    uint64_t print = scene_fingerprint(&l.lowered.scene);
    load_free(&l);
    return print;
}

START_TEST(fingerprint_changes)
{
    struct buffer b = {0};
    const char *at = strstr(SCENE, changes[_i].from);
    ck_assert_ptr_nonnull(at);
    buffer_add(&b, SCENE, (size_t)(at - SCENE));
    buffer_puts(&b, changes[_i].to);
    buffer_add(&b, at + strlen(changes[_i].from), strlen(at) - strlen(changes[_i].from) + 1);
    ck_assert_uint_ne(fingerprint_of(b.at), fingerprint_of(SCENE));
    buffer_free(&b);
}
END_TEST

START_TEST(fingerprint_stays)
{
    uint64_t whole = fingerprint_of(SCENE);
    ck_assert_uint_eq(whole, fingerprint_of(SCENE));
    ck_assert_uint_eq(whole, fingerprint_of(SCENE "// a comment\nlet unused = 3\n"));
}
END_TEST

/* ---- parts ---- */

static const struct {
    uint32_t width, height, parts;
} cuts[] = {{640, 480, 1}, {640, 480, 7}, {1920, 1080, 16}, {100, 3, 5}, {9, 9, 50}, {512, 512, 8}};

START_TEST(parts_make_the_whole)
{
    struct tiling t = tiling_of(0, 0, cuts[_i].width, cuts[_i].height);
    uint32_t parts = cuts[_i].parts, *of = mem_zalloc(t.n, sizeof *of);
    for (uint32_t part = 1; part <= parts; part++) {
        size_t n, *tiles = part_tiles(&t, part, parts, &n);
        for (size_t i = 0; i < n; i++) {
            ck_assert_uint_eq(of[tiles[i]], 0);
            of[tiles[i]] = part;
        }
        if (t.n > 64 * parts) /* about the same work each */
            ck_assert_msg(n > t.n / parts / 2 && n < 2 * t.n / parts, "%zu of %zu", n, t.n);
        free(tiles);
    }
    for (size_t i = 0; i < t.n; i++)
        ck_assert_uint_eq(of[i], part_of_tile(&t, parts, i));
    free(of);
}
END_TEST

/* ---- files of tiles ---- */

START_TEST(heads_differ)
{
    struct buffer room = {0};
    struct tilefile_head a = {
        .version = "1.0", .scene = 1, .settings = "s", .width = 8, .height = 8};
    struct tilefile_head b = a;
    b.part = b.parts = 3;
    ck_assert_ptr_null(tilefile_other(&a, &b, &room));
    strcpy(b.version, "1.1");
    ck_assert_str_eq(tilefile_other(&a, &b, &room), "it was made by wrt 1.0, and this is 1.1");
    b = a;
    b.scene = 2;
    ck_assert_str_eq(tilefile_other(&a, &b, &room), "it is of another scene");
    b = a;
    b.encoding = ENCODING_SRGB;
    ck_assert_str_eq(tilefile_other(&a, &b, &room), "its pixels are kept in another way");
    buffer_free(&room);
}
END_TEST

/* All depths, tiles cut off at the right and at the bottom. */
START_TEST(tiles_come_back)
{
    enum { W = 21, H = 13 };
    struct picture *p = picture_new(W, H, (enum picture_depth)_i), *q;
    q = picture_new(W, H, (enum picture_depth)_i);
    size_t bytes = W * H * picture_pixel_bytes((enum picture_depth)_i), first, n;
    uint8_t *pixels = picture_pixel(p, 0, 0);
    for (size_t i = 0; i < bytes; i++)
        pixels[i] = (uint8_t)(i * 31);
    struct tiling t = tiling_of(0, 0, W, H);
    struct buffer b = {0};
    tilefile_put_tiles(&b, 9, &t, p, 0, 4);
    size_t end = b.n;
    tilefile_put_tiles(&b, 9, &t, p, 4, t.n - 4);
    enum { CHECK = 8 };
    ck_assert(tilefile_take_tiles(&t, b.at, end - CHECK, q, &first, &n));
    ck_assert(first == 0 && n == 4);
    ck_assert(tilefile_take_tiles(&t, b.at + end, b.n - end - CHECK, q, &first, &n));
    ck_assert(first == 4 && n == t.n - 4);
    ck_assert_mem_eq(picture_pixel(q, 0, 0), pixels, bytes);
    ck_assert(!tilefile_take_tiles(&t, b.at, end - CHECK - 1, q, &first, &n));
    ck_assert(!tilefile_take_tiles(&t, b.at, 7, q, &first, &n));
    buffer_free(&b);
    picture_free(p);
    picture_free(q);
}
END_TEST

Suite *farm_suite(void)
{
    Suite *s = suite_create("farm");
    TCase *t = tcase_create("farm");
    tcase_add_loop_test(t, hash_known, 0, COUNT(sums));
    tcase_add_test(t, hash_in_pieces);
    tcase_add_loop_test(t, fingerprint_changes, 0, COUNT(changes));
    tcase_add_test(t, fingerprint_stays);
    tcase_add_loop_test(t, parts_make_the_whole, 0, COUNT(cuts));
    tcase_add_test(t, heads_differ);
    tcase_add_loop_test(t, tiles_come_back, 0, 3);
    suite_add_tcase(s, t);
    return s;
}
