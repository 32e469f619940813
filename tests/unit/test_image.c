/* Pictures and textures: every kind of PNG, JPEG and PNM, whole and damaged. */
#include "config.h"

#include "base/mem.h"
#include "base/vec.h"
#include "image/picture.h"
#include "math/srgb_bytes.h"

#include "unit.h"

#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef HAVE_JPEG
#include <jpeglib.h>
#endif

#define COUNT(a) (int)(sizeof(a) / sizeof *(a))

struct file {
    VEC(uint8_t) bytes;
};

static void file_add(struct file *f, const void *bytes, size_t n)
{
    vec_reserve(&f->bytes, n);
    memcpy(f->bytes.at + f->bytes.n, bytes, n);
    f->bytes.n += n;
}

/* The decoders get a block of exactly n bytes, so that a sanitizer sees any step beyond it. */
static struct image *decode_exactly(const uint8_t *bytes, size_t n, char *reason)
{
    uint8_t *copy = mem_alloc(n, 1);
    memcpy(copy, bytes, n);
    memset(reason, 0, IMAGE_REASON_BYTES);
    struct image *i = image_decode(copy, n, reason);
    free(copy);
    return i;
}

/* Any shortened file is an error with a reason; any file with a byte changed is an error with a
 * reason or a picture. */
static void damage_everywhere(struct file *f)
{
    static const uint8_t flips[] = {0x01, 0x80, 0xFF};
    char reason[IMAGE_REASON_BYTES];
    for (size_t n = 0; n < f->bytes.n; n++) {
        ck_assert_msg(!decode_exactly(f->bytes.at, n, reason), "a picture from %zu bytes", n);
        ck_assert_msg(reason[0], "no reason at %zu bytes", n);
    }
    for (size_t at = 0; at < f->bytes.n; at++) {
        for (int k = 0; k < COUNT(flips); k++) {
            f->bytes.at[at] ^= flips[k];
            struct image *i = decode_exactly(f->bytes.at, f->bytes.n, reason);
            ck_assert_msg(i || reason[0], "no reason with byte %zu changed", at);
            image_free(i);
            f->bytes.at[at] ^= flips[k];
        }
    }
}

/* ---- PNG ------------------------------------------------------------------------------------- */

static const struct png_kind {
    const char *name;
    int colour, depth;
    bool interlaced, transparent; /* transparent: with a tRNS chunk */
} png_kinds[] = {
    {"grey 1", PNG_COLOR_TYPE_GRAY, 1, false, false},
    {"grey 2", PNG_COLOR_TYPE_GRAY, 2, false, false},
    {"grey 4", PNG_COLOR_TYPE_GRAY, 4, false, false},
    {"grey 8", PNG_COLOR_TYPE_GRAY, 8, false, false},
    {"grey 16", PNG_COLOR_TYPE_GRAY, 16, false, false},
    {"grey 1, tRNS", PNG_COLOR_TYPE_GRAY, 1, false, true},
    {"grey 16, tRNS", PNG_COLOR_TYPE_GRAY, 16, false, true},
    {"grey 4, interlaced", PNG_COLOR_TYPE_GRAY, 4, true, false},
    {"grey alpha 8", PNG_COLOR_TYPE_GRAY_ALPHA, 8, false, false},
    {"grey alpha 16", PNG_COLOR_TYPE_GRAY_ALPHA, 16, false, false},
    {"grey alpha 16, interlaced", PNG_COLOR_TYPE_GRAY_ALPHA, 16, true, false},
    {"palette 1", PNG_COLOR_TYPE_PALETTE, 1, false, false},
    {"palette 2", PNG_COLOR_TYPE_PALETTE, 2, false, false},
    {"palette 4, tRNS", PNG_COLOR_TYPE_PALETTE, 4, false, true},
    {"palette 8", PNG_COLOR_TYPE_PALETTE, 8, false, false},
    {"palette 8, tRNS, interlaced", PNG_COLOR_TYPE_PALETTE, 8, true, true},
    {"rgb 8", PNG_COLOR_TYPE_RGB, 8, false, false},
    {"rgb 8, tRNS", PNG_COLOR_TYPE_RGB, 8, false, true},
    {"rgb 8, interlaced", PNG_COLOR_TYPE_RGB, 8, true, false},
    {"rgb 16", PNG_COLOR_TYPE_RGB, 16, false, false},
    {"rgba 8", PNG_COLOR_TYPE_RGBA, 8, false, false},
    {"rgba 8, interlaced", PNG_COLOR_TYPE_RGBA, 8, true, false},
    {"rgba 16", PNG_COLOR_TYPE_RGBA, 16, false, false},
};

enum { WIDTH = 13, HEIGHT = 11, CHANNELS = 4 };

static int png_channels(const struct png_kind *k)
{
    switch (k->colour) {
    case PNG_COLOR_TYPE_GRAY_ALPHA:
        return 2;
    case PNG_COLOR_TYPE_RGB:
        return 3;
    case PNG_COLOR_TYPE_RGBA:
        return 4;
    default:
        return 1;
    }
}

/* What the file holds at a pixel's channel; alpha takes all values too, 0 among them. */
static unsigned png_sample(const struct png_kind *k, int x, int y, int channel)
{
    unsigned hash = (unsigned)(x * 7919 + y * 104729 + channel * 1299709 + 17) * 2654435761u;
    return (hash >> 16) & ((1u << k->depth) - 1);
}

static png_color palette_colour(unsigned i)
{
    return (png_color){(png_byte)(i * 37), (png_byte)(255 - i), (png_byte)(i * i)};
}

/* The channel that must come out, 16 bits if the file has 16. */
static unsigned png_wanted(const struct png_kind *k, int x, int y, int channel)
{
    bool grey = !(k->colour & PNG_COLOR_MASK_COLOR);
    unsigned v = png_sample(k, x, y, grey || k->colour == PNG_COLOR_TYPE_PALETTE ? 0 : channel);
    if (k->colour == PNG_COLOR_TYPE_PALETTE) {
        png_color c = palette_colour(v);
        return channel == 0 ? c.red : channel == 1 ? c.green : c.blue;
    }
    return k->depth < 8 ? v * 255 / ((1u << k->depth) - 1) : v;
}

static void png_row(const struct png_kind *k, int y, uint8_t *row)
{
    int channels = png_channels(k);
    memset(row, 0, WIDTH * CHANNELS * 2);
    for (int x = 0, bit = 0; x < WIDTH; x++) {
        for (int c = 0; c < channels; c++, bit += k->depth) {
            unsigned v = png_sample(k, x, y, c);
            if (k->depth == 16) {
                row[bit / 8] = (uint8_t)(v >> 8);
                row[bit / 8 + 1] = (uint8_t)v;
            } else {
                row[bit / 8] |= (uint8_t)(v << (8 - k->depth - bit % 8));
            }
        }
    }
}

static void png_put(png_structp png, png_bytep bytes, size_t n)
{
    file_add(png_get_io_ptr(png), bytes, n);
}

static void png_set_kind(png_structp png, png_infop info, const struct png_kind *k)
{
    png_byte alpha[256];
    png_color palette[256];
    png_color_16 key = {0}; /* the colour of pixel 0, 0 is the transparent one */
    png_set_IHDR(png, info, WIDTH, HEIGHT, k->depth, k->colour,
                 k->interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    int colours = k->depth <= 8 ? 1 << k->depth : 0;
    for (int i = 0; i < colours; i++) {
        palette[i] = palette_colour((unsigned)i);
        alpha[i] = (png_byte)(i * 3);
    }
    if (k->colour == PNG_COLOR_TYPE_PALETTE)
        png_set_PLTE(png, info, palette, colours);
    key.gray = key.red = (png_uint_16)png_sample(k, 0, 0, 0);
    key.green = (png_uint_16)png_sample(k, 0, 0, 1);
    key.blue = (png_uint_16)png_sample(k, 0, 0, 2);
    if (k->transparent)
        png_set_tRNS(png, info, alpha, colours, &key);
    png_set_gAMA(png, info, 1.0); /* to be ignored */
}

static struct file png_make(const struct png_kind *k)
{
    struct file f = {0};
    uint8_t rows[HEIGHT][WIDTH * CHANNELS * 2];
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &f, png_put, NULL);
    png_set_kind(png, info, k);
    png_write_info(png, info);
    int passes = png_set_interlace_handling(png);
    for (int pass = 0; pass < passes; pass++)
        for (int y = 0; y < HEIGHT; y++) {
            png_row(k, y, rows[y]);
            png_write_row(png, rows[y]);
        }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return f;
}

START_TEST(png_kind_is_read)
{
    const struct png_kind *k = &png_kinds[_i];
    struct file f = png_make(k);
    char reason[IMAGE_REASON_BYTES];
    struct image *i = decode_exactly(f.bytes.at, f.bytes.n, reason);
    ck_assert_msg(i, "%s: %s", k->name, reason);
    ck_assert_uint_eq(i->width, WIDTH);
    ck_assert_uint_eq(i->height, HEIGHT);
    ck_assert_int_eq(i->data16 != NULL, k->depth == 16);
    ck_assert_int_eq(i->data8 != NULL, k->depth != 16);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++) {
                int at = (y * WIDTH + x) * 3 + c;
                unsigned got = i->data16 ? i->data16[at] : i->data8[at];
                ck_assert_msg(got == png_wanted(k, x, y, c), "%s: (%d, %d) channel %d: %u, not %u",
                              k->name, x, y, c, got, png_wanted(k, x, y, c));
            }
    image_free(i);
    vec_free(&f.bytes);
}
END_TEST

START_TEST(png_damage_is_found)
{
    struct file f = png_make(&png_kinds[_i]);
    damage_everywhere(&f);
    vec_free(&f.bytes);
}
END_TEST

static uint32_t crc(const uint8_t *p, size_t n)
{
    uint32_t c = UINT32_MAX;
    while (n--) {
        c ^= *p++;
        for (int k = 0; k < 8; k++)
            c = c & 1 ? 0xEDB88320u ^ c >> 1 : c >> 1;
    }
    return ~c;
}

static void put_u32(uint8_t *p, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(v >> (24 - 8 * i));
}

static const struct {
    uint32_t width, height;
    const char *reason;
} png_sizes[] = {
    {1 << 14, 1 << 14, "ends early"},
    {1 << 20, 1 << 8, "ends early"},
    {1 << 20, 1 << 20, "larger than the limit"},
    {(1 << 20) + 1, 1, "limit"},
    {INT32_MAX, INT32_MAX, "limit"},
    {UINT32_MAX, 1, ""},
    {0, 1, ""},
};

/* The header's size and checksum sit at fixed places behind the signature. */
START_TEST(png_of_claimed_size_is_refused)
{
    enum { TYPE_AT = 12, WIDTH_AT = 16, HEIGHT_AT = 20, CRC_AT = 29 };
    struct file f = png_make(&png_kinds[COUNT(png_kinds) - 1]);
    char reason[IMAGE_REASON_BYTES];
    put_u32(f.bytes.at + WIDTH_AT, png_sizes[_i].width);
    put_u32(f.bytes.at + HEIGHT_AT, png_sizes[_i].height);
    put_u32(f.bytes.at + CRC_AT, crc(f.bytes.at + TYPE_AT, CRC_AT - TYPE_AT));
    ck_assert_ptr_null(decode_exactly(f.bytes.at, f.bytes.n, reason));
    ck_assert_msg(reason[0] && strstr(reason, png_sizes[_i].reason), "%s", reason);
    vec_free(&f.bytes);
}
END_TEST

/* ---- JPEG ------------------------------------------------------------------------------------ */

#ifdef HAVE_JPEG

static const struct jpeg_kind {
    const char *name;
    J_COLOR_SPACE from, stored; /* what the samples are, what the file holds */
    int sampling;               /* of the first component, horizontal and vertical */
    bool progressive;
} jpeg_kinds[] = {
    {"grey", JCS_GRAYSCALE, JCS_GRAYSCALE, 1, false},
    {"YCbCr", JCS_RGB, JCS_YCbCr, 1, false},
    {"YCbCr, 4:2:0", JCS_RGB, JCS_YCbCr, 2, false},
    {"YCbCr, 4:2:0, progressive", JCS_RGB, JCS_YCbCr, 2, true},
    {"grey, progressive", JCS_GRAYSCALE, JCS_GRAYSCALE, 1, true},
    {"RGB", JCS_RGB, JCS_RGB, 1, false},
};

static int jpeg_channels(J_COLOR_SPACE space)
{
    return space == JCS_GRAYSCALE ? 1 : space == JCS_CMYK ? 4 : 3;
}

/* Smooth, so that quality 100 keeps it within a few steps at any sampling. */
static unsigned smooth_sample(int x, int y, int channel)
{
    return (unsigned)(60 + 5 * x + 7 * y + 20 * channel);
}

static struct file jpeg_make(const struct jpeg_kind *k, jpeg_scan_info *scans, int scan_count)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct file f = {0};
    unsigned char *out = NULL;
    unsigned long n = 0;
    int channels = jpeg_channels(k->from);
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &out, &n);
    jpeg.image_width = WIDTH;
    jpeg.image_height = HEIGHT;
    jpeg.input_components = channels;
    jpeg.in_color_space = k->from;
    jpeg_set_defaults(&jpeg);
    jpeg_set_colorspace(&jpeg, k->stored);
    jpeg_set_quality(&jpeg, 100, TRUE);
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = k->sampling;
    if (k->progressive)
        jpeg_simple_progression(&jpeg);
    if (scans) {
        jpeg.scan_info = scans;
        jpeg.num_scans = scan_count;
    }
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < HEIGHT; y++) {
        JSAMPLE row[WIDTH * CHANNELS], *rows[] = {row};
        for (int i = 0; i < WIDTH * channels; i++)
            row[i] = (JSAMPLE)smooth_sample(i / channels, y, i % channels);
        jpeg_write_scanlines(&jpeg, rows, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    file_add(&f, out, n);
    free(out);
    return f;
}

START_TEST(jpeg_kind_is_read)
{
    const struct jpeg_kind *k = &jpeg_kinds[_i];
    struct file f = jpeg_make(k, NULL, 0);
    char reason[IMAGE_REASON_BYTES];
    struct image *i = decode_exactly(f.bytes.at, f.bytes.n, reason);
    ck_assert_msg(i, "%s: %s", k->name, reason);
    ck_assert_uint_eq(i->width, WIDTH);
    ck_assert_uint_eq(i->height, HEIGHT);
    ck_assert_ptr_null(i->data16);
    for (int at = 0; at < 3 * WIDTH * HEIGHT; at++) {
        int channel = k->from == JCS_GRAYSCALE ? 0 : at % 3;
        unsigned wanted = smooth_sample(at / 3 % WIDTH, at / 3 / WIDTH, channel);
        ck_assert_msg(abs((int)i->data8[at] - (int)wanted) <= 6, "%s: sample %d: %u, not %u",
                      k->name, at, i->data8[at], wanted);
    }
    image_free(i);
    vec_free(&f.bytes);
}
END_TEST

START_TEST(jpeg_damage_is_found)
{
    struct file f = jpeg_make(&jpeg_kinds[_i], NULL, 0);
    damage_everywhere(&f);
    vec_free(&f.bytes);
}
END_TEST

START_TEST(jpeg_cmyk_is_refused)
{
    static const J_COLOR_SPACE stored[] = {JCS_CMYK, JCS_YCCK};
    struct jpeg_kind k = {"CMYK", JCS_CMYK, stored[_i], 1, false};
    struct file f = jpeg_make(&k, NULL, 0);
    char reason[IMAGE_REASON_BYTES];
    ck_assert_ptr_null(decode_exactly(f.bytes.at, f.bytes.n, reason));
    ck_assert_msg(strstr(reason, "CMYK"), "%s", reason);
    vec_free(&f.bytes);
}
END_TEST

/* One scan for each frequency of each component: 192, all of them legal. */
START_TEST(jpeg_of_many_scans_is_refused)
{
    enum { COMPONENTS = 3, FREQUENCIES = 64 };
    jpeg_scan_info scans[COMPONENTS * FREQUENCIES] = {0};
    for (int i = 0; i < COMPONENTS * FREQUENCIES; i++)
        scans[i] = (jpeg_scan_info){.comps_in_scan = 1,
                                    .component_index = {i / FREQUENCIES},
                                    .Ss = i % FREQUENCIES,
                                    .Se = i % FREQUENCIES};
    struct file f = jpeg_make(&jpeg_kinds[1], scans, COMPONENTS * FREQUENCIES);
    char reason[IMAGE_REASON_BYTES];
    ck_assert_ptr_null(decode_exactly(f.bytes.at, f.bytes.n, reason));
    ck_assert_msg(strstr(reason, "scans"), "%s", reason);
    vec_free(&f.bytes);
}
END_TEST

static TCase *jpeg_case(void)
{
    TCase *c = tcase_create("jpeg");
    tcase_set_timeout(c, 120);
    tcase_add_loop_test(c, jpeg_kind_is_read, 0, COUNT(jpeg_kinds));
    tcase_add_loop_test(c, jpeg_damage_is_found, 0, COUNT(jpeg_kinds));
    tcase_add_loop_test(c, jpeg_cmyk_is_refused, 0, 2);
    tcase_add_test(c, jpeg_of_many_scans_is_refused);
    return c;
}

#else

START_TEST(jpeg_support_is_missed)
{
    char reason[IMAGE_REASON_BYTES];
    ck_assert_ptr_null(image_decode("\xff\xd8\xff\xe0", 4, reason));
    ck_assert_str_eq(reason, "this wrt was built without JPEG support");
}
END_TEST

static TCase *jpeg_case(void)
{
    TCase *c = tcase_create("jpeg");
    tcase_add_test(c, jpeg_support_is_missed);
    return c;
}

#endif

/* ---- other formats --------------------------------------------------------------------------- */

static const struct {
    const char *bytes;
    size_t n;
    const char *reason; /* how it begins */
} refused[] = {
    {"", 0, "the file is empty"},
    {"GIF89a....", 10, "GIF pictures are not read as textures; PNG and JPEG are"},
    {"GIF87a....", 10, "GIF pictures"},
    {"BM........", 10, "BMP pictures"},
    {"II*\0......", 10, "TIFF pictures"},
    {"MM\0*......", 10, "TIFF pictures"},
    {"RIFF1234WEBPVP8 ", 16, "WebP pictures"},
    {"P6\n1 1\n255\n...", 14, "PPM pictures"},
    {"P5\n1 1\n255\n.", 12, "PGM pictures"},
    {"PF\n1 1\n-1\n", 10, "PFM pictures"},
    {"hello", 5, "not a PNG or JPEG picture"},
    {"\0", 1, "not a PNG or JPEG picture"},
    {"\x89PNG\r\n\x1a\n", 8, "the picture ends early"},
    {"\x89PNG\n\x1a\n", 7, "not a PNG or JPEG picture"},
};

START_TEST(other_format_is_refused)
{
    char reason[IMAGE_REASON_BYTES];
    ck_assert_ptr_null(decode_exactly((const uint8_t *)refused[_i].bytes, refused[_i].n, reason));
    ck_assert_msg(strncmp(reason, refused[_i].reason, strlen(refused[_i].reason)) == 0, "%s",
                  reason);
}
END_TEST

/* ---- pictures -------------------------------------------------------------------------------- */

static const struct {
    double channel;
    uint8_t byte;
} roundings[] = {
    {0, 0},
    {-0.0, 0},
    {-1, 0},
    {NAN, 0},
    {INFINITY, 255},
    {-INFINITY, 0},
    {1, 255},
    {2, 255},
    {0.9 / 255, 1},
    {0.89 / 255, 0},
    {254.95 / 255, 255},
    {254.85 / 255, 254},
    {0.5, 127},
    {1e-320, 0},
    {1e300, 255},
};

START_TEST(colour_is_rounded)
{
    struct picture *p = picture_new(2, 2, PICTURE_BYTES);
    picture_set(p, 1, 0, vec3(roundings[_i].channel, 1, 0.5));
    ck_assert_uint_eq(p->bytes[3], roundings[_i].byte);
    ck_assert_uint_eq(p->bytes[4], 255);
    ck_assert_uint_eq(p->bytes[5], 127);
    ck_assert_uint_eq(p->bytes[2] + p->bytes[6], 0);
    picture_free(p);
}
END_TEST

/* What the table stands for. */
static uint8_t srgb_by_power(double light)
{
    return (uint8_t)(picture_channel(ENCODING_SRGB, light) * 255 + 0.5);
}

/* Around each byte's least light, in all slots of the table, and where there is no byte. */
START_TEST(srgb_bytes_are_the_nearest)
{
    static const double strange[] = {0, -0.0, -1, NAN, 1, 2, INFINITY, -INFINITY, 1e-320, 1e300};
    struct srgb_bytes table;
    srgb_bytes_init(&table);
    for (size_t i = 0; i < COUNT(strange); i++)
        ck_assert_uint_eq(srgb_byte(&table, strange[i]), srgb_by_power(strange[i]));
    for (int byte = 1; byte < 256; byte++) {
        double light = table.from[byte];
        for (int i = 0; i < 100; i++, light = nextafter(light, 0))
            ck_assert_uint_eq(srgb_byte(&table, light), i == 0 ? byte : srgb_by_power(light));
        light = table.from[byte];
        for (int i = 0; i < 100; i++, light = nextafter(light, 1))
            ck_assert_uint_eq(srgb_byte(&table, light), byte);
    }
    for (double light = 0x1p-14; light < 1; light *= 1 + 0x1p-12)
        ck_assert_uint_eq(srgb_byte(&table, light), srgb_by_power(light));
}
END_TEST

static const struct {
    uint64_t width, height;
    bool allowed;
} sizes[] = {
    {1, 1, true},
    {1 << 20, 1, true},
    {1 << 14, 1 << 14, true},
    {1 << 20, 1 << 8, true},
    {0, 1, false},
    {1, 0, false},
    {(1 << 20) + 1, 1, false},
    {(1 << 14) + 1, 1 << 14, false},
    {UINT64_MAX, UINT64_MAX, false},
    {UINT64_C(1) << 32, UINT64_C(1) << 32, false},
};

START_TEST(size_is_limited)
{
    ck_assert_int_eq(image_size_allowed(sizes[_i].width, sizes[_i].height), sizes[_i].allowed);
}
END_TEST

static const struct {
    const char *path;
    int format; /* -1: none */
} formats[] = {
    {"a.png", PICTURE_PNG},
    {"a.PPM", PICTURE_PPM},
    {"dir.x/a.Pfm", PICTURE_PFM},
    {"a", PICTURE_PNG},
    {"dir.ppm/a", PICTURE_PNG},
    {"-", PICTURE_PNG},
    {"a.jpg", -1},
    {"a.", -1},
    {"a.png.gz", -1},
    {"a.ppm.png", PICTURE_PNG},
};

START_TEST(suffix_names_format)
{
    enum picture_format format;
    bool found = picture_format_of(formats[_i].path, &format);
    ck_assert_int_eq(found ? (int)format : -1, formats[_i].format);
}
END_TEST

static struct picture *noise_picture(uint32_t width, uint32_t height, bool floats)
{
    struct picture *p = picture_new(width, height, floats ? PICTURE_FLOATS : PICTURE_BYTES);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            picture_set(p, x, y, vec3((x * 31 + y * 17) % 256 / 255.0, x % 7 / 7.0, y % 5 / 5.0));
    return p;
}

static const struct {
    uint32_t width, height;
    enum picture_format format;
} trips[] = {
    {1, 1, PICTURE_PNG},     {13, 7, PICTURE_PNG}, {1, 300, PICTURE_PNG}, {400, 1, PICTURE_PNG},
    {200, 100, PICTURE_PNG}, {1, 1, PICTURE_PPM},  {13, 7, PICTURE_PPM},
};

START_TEST(picture_survives_round_trip)
{
    struct picture *p = noise_picture(trips[_i].width, trips[_i].height, false);
    char reason[IMAGE_REASON_BYTES];
    size_t n, again;
    void *file = picture_encode(p, trips[_i].format, &n, reason);
    void *twin = picture_encode(p, trips[_i].format, &again, reason);
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(n, again);
    ck_assert_mem_eq(file, twin, n);
    struct picture *back = picture_decode(file, n, reason);
    ck_assert_msg(back, "%s", reason);
    ck_assert_uint_eq(back->width, p->width);
    ck_assert_uint_eq(back->height, p->height);
    ck_assert_mem_eq(back->bytes, p->bytes, (size_t)3 * p->width * p->height);
    for (size_t k = 0; k < (n < 400 ? n : 400); k++) {
        ck_assert_ptr_null(picture_decode(file, k, reason));
        ck_assert(reason[0]);
    }
    picture_free(back);
    picture_free(p);
    free(file);
    free(twin);
}
END_TEST

START_TEST(pfm_is_little_endian_bottom_up)
{
    static const char wanted[] = "PF\n1 2\n-1.0\n"
                                 "\0\0\x80\x3f\0\0\0\xc0\0\0\0\0"      /* bottom: 1 -2 0 */
                                 "\0\0\x80\x7f\0\0\0\x3f\0\0\x80\x3e"; /* top: inf 0.5 0.25 */
    struct picture *p = picture_new(1, 2, PICTURE_FLOATS);
    char reason[IMAGE_REASON_BYTES];
    size_t n;
    picture_set(p, 0, 0, vec3(INFINITY, 0.5, 0.25));
    picture_set(p, 0, 1, vec3(1, -2, 0));
    void *file = picture_encode(p, PICTURE_PFM, &n, reason);
    ck_assert_uint_eq(n, sizeof wanted - 1);
    ck_assert_mem_eq(file, wanted, n);
    ck_assert_ptr_null(picture_encode(p, PICTURE_PNG, &n, reason));
    ck_assert_ptr_null(picture_encode(p, PICTURE_PPM, &n, reason));
    free(file);
    picture_free(p);
    p = picture_new(1, 1, PICTURE_BYTES);
    ck_assert_ptr_null(picture_encode(p, PICTURE_PFM, &n, reason));
    ck_assert_str_eq(reason, "PFM wants a picture of floats");
    picture_free(p);
}
END_TEST

static const struct {
    const char *text;
    const char *reason; /* NULL: read */
} ppms[] = {
    {"P6\n1 1\n255\nabc", NULL},
    {"P6 1 1 255 abc", NULL},
    {"P6\n# made by hand\n1 # wide\n1\n255\nabc", NULL},
    {"P6\n1 1\n255\nab", "the picture ends early"},
    {"P6\n1 1\n255\nabcd", "more bytes follow the picture"},
    {"P6\n1 1\n65535\nabcdef", "a PPM with a largest value of 65535 is not read; one with 255 is"},
    {"P6\n0 1\n255\n", "the picture's size of 0 x 1 is nothing"},
    {"P6\n9999999 1\n255\n", "the picture's size of 9999999 x 1 is larger than the limit"},
    {"P6\n99999999999 1\n255\n", "the PPM header is damaged"},
    {"P6\n1 1\n255", "the PPM header is damaged"},
    {"P6\n1 -1\n255\n", "the PPM header is damaged"},
    {"P6", "the PPM header is damaged"},
    {"P6#", "the PPM header is damaged"},
    {"P3\n1 1\n255\n1 2 3",
     "text PPM pictures are not read here; PNG, binary PPM, PFM and OpenEXR are"},
    {"hello", "not a PNG, PPM, PFM or OpenEXR picture"},
    {"", "the file is empty"},
};

START_TEST(ppm_is_read_or_refused)
{
    char reason[IMAGE_REASON_BYTES] = "";
    struct picture *p = picture_decode(ppms[_i].text, strlen(ppms[_i].text), reason);
    if (ppms[_i].reason) {
        ck_assert_ptr_null(p);
        ck_assert_str_eq(reason, ppms[_i].reason);
    } else {
        ck_assert_msg(p, "%s", reason);
        ck_assert_mem_eq(p->bytes, "abc", 3);
    }
    picture_free(p);
}
END_TEST

#define ONE_PIXEL "\x3f\x80\0\0\xc0\0\0\0\0\0\0\0" /* 1 -2 0, the highest byte first */

static const struct {
    const char *text;
    size_t n;
    const char *reason; /* NULL: read */
} pfms[] = {
    {"PF\n1 1\n1.0\n" ONE_PIXEL, 23, NULL},
    {"PF 1 1 +1 " ONE_PIXEL, 22, NULL},
    {"PF\n1 1\n-1\n\0\0\x80\x3f\0\0\0\xc0\0\0\0\0", 22, NULL},
    {"PF\n1 1\n1.0\n" ONE_PIXEL, 22, "the picture ends early"},
    {"PF\n1 1\n1.0\n" ONE_PIXEL "\n", 24, "more bytes follow the picture"},
    {"PF\n1 1\n2.5\n" ONE_PIXEL, 23, "a PFM with a scale of 2.5 is not read; one with 1 or -1 is"},
    {"PF\n1 1\n0\n", 9, "a PFM with a scale of 0 is not read; one with 1 or -1 is"},
    {"PF\n1 1\n", 7, "the PFM header is damaged"},
    {"PF\n1 1\none\n", 11, "the PFM header is damaged"},
    {"PF\n1 1\n1", 8, "the PFM header is damaged"},
    {"PF", 2, "the PFM header is damaged"},
    {"PF\n0 1\n1\n", 9, "the picture's size of 0 x 1 is nothing"},
    {"PF\n999999 999999\n1\n", 19,
     "the picture's size of 999999 x 999999 is larger than the limit"},
    {"Pf\n1 1\n1\n", 9,
     "grey PFM pictures are not read here; PNG, binary PPM, PFM and OpenEXR are"},
};

START_TEST(pfm_is_read_or_refused)
{
    static const float wanted[] = {1, -2, 0};
    char reason[IMAGE_REASON_BYTES] = "";
    struct picture *p = picture_decode(pfms[_i].text, pfms[_i].n, reason);
    if (pfms[_i].reason) {
        ck_assert_ptr_null(p);
        ck_assert_str_eq(reason, pfms[_i].reason);
    } else {
        ck_assert_msg(p, "%s", reason);
        ck_assert_mem_eq(p->floats, wanted, sizeof wanted);
    }
    picture_free(p);
}
END_TEST

START_TEST(pfm_survives_round_trip)
{
    struct picture *p = picture_new(3, 2, PICTURE_FLOATS);
    char reason[IMAGE_REASON_BYTES];
    size_t n;
    for (size_t i = 0; i < 18; i++)
        p->floats[i] = (float)i - 7.25F;
    void *file = picture_encode(p, PICTURE_PFM, &n, reason);
    ck_assert(picture_recognised(file, n) && !picture_recognised("wrt 1\n", 6));
    struct picture *back = picture_decode(file, n, reason);
    ck_assert_msg(back && back->width == 3 && back->height == 2, "%s", reason);
    ck_assert_mem_eq(back->floats, p->floats, 18 * sizeof(float));
    free(file);
    picture_free(p);
    picture_free(back);
}
END_TEST

START_TEST(deep_png_keeps_its_words)
{
    struct file f = png_make(&png_kinds[4]);
    char reason[IMAGE_REASON_BYTES];
    struct picture *p = picture_decode(f.bytes.at, f.bytes.n, reason);
    struct image *i = image_decode(f.bytes.at, f.bytes.n, reason);
    ck_assert_msg(p && i && p->words && !p->bytes && i->data16, "%s", reason);
    ck_assert(p->width == i->width && p->height == i->height);
    ck_assert_mem_eq(p->words, i->data16, sizeof(uint16_t) * 3 * p->width * p->height);
    picture_free(p);
    image_free(i);
    vec_free(&f.bytes);
}
END_TEST

static TCase *picture_case(void)
{
    TCase *c = tcase_create("picture");
    tcase_add_loop_test(c, other_format_is_refused, 0, COUNT(refused));
    tcase_add_loop_test(c, colour_is_rounded, 0, COUNT(roundings));
    tcase_add_loop_test(c, size_is_limited, 0, COUNT(sizes));
    tcase_add_loop_test(c, suffix_names_format, 0, COUNT(formats));
    tcase_add_loop_test(c, picture_survives_round_trip, 0, COUNT(trips));
    tcase_add_loop_test(c, ppm_is_read_or_refused, 0, COUNT(ppms));
    tcase_add_test(c, pfm_is_little_endian_bottom_up);
    tcase_add_loop_test(c, pfm_is_read_or_refused, 0, COUNT(pfms));
    tcase_add_test(c, pfm_survives_round_trip);
    tcase_add_test(c, deep_png_keeps_its_words);
    tcase_add_test(c, srgb_bytes_are_the_nearest);
    return c;
}

Suite *image_suite(void)
{
    Suite *s = suite_create("image");
    TCase *png = tcase_create("png");
    tcase_set_timeout(png, 120);
    tcase_add_loop_test(png, png_kind_is_read, 0, COUNT(png_kinds));
    tcase_add_loop_test(png, png_damage_is_found, 0, COUNT(png_kinds));
    tcase_add_loop_test(png, png_of_claimed_size_is_refused, 0, COUNT(png_sizes));
    suite_add_tcase(s, png);
    suite_add_tcase(s, jpeg_case());
    suite_add_tcase(s, picture_case());
    return s;
}
