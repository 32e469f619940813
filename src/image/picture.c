#include "config.h"

#include "image/picture.h"

#include "base/mem.h"
#include "base/str.h"
#include "image/codec.h"
#include "math/srgb.h"
#include "math/srgb_bytes.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a file is, by its first bytes. */
enum signature_kind { KIND_PNG, KIND_JPEG, KIND_PPM, KIND_PFM, KIND_EXR, KIND_OTHER };

struct signature {
    enum signature_kind kind;
    size_t at; /* offset in the file */
    const char *bytes;
    size_t n; /* of bytes */
    const char *name;
};

#define BYTES(z) (z), sizeof(z) - 1

static const struct signature signatures[] = {
    {KIND_PNG, 0, BYTES("\x89PNG\r\n\x1a\n"), "PNG"},
    {KIND_JPEG, 0, BYTES("\xff\xd8\xff"), "JPEG"},
    {KIND_PPM, 0, BYTES("P6"), "PPM"},
    {KIND_OTHER, 0, BYTES("GIF8"), "GIF"},
    {KIND_OTHER, 0, BYTES("BM"), "BMP"},
    {KIND_OTHER, 0, BYTES("II*\0"), "TIFF"},
    {KIND_OTHER, 0, BYTES("MM\0*"), "TIFF"},
    {KIND_OTHER, 0, BYTES("II+\0"), "TIFF"},
    {KIND_OTHER, 0, BYTES("MM\0+"), "TIFF"},
    {KIND_OTHER, 8, BYTES("WEBP"), "WebP"},
    {KIND_OTHER, 0, BYTES("P1"), "PBM"},
    {KIND_OTHER, 0, BYTES("P2"), "PGM"},
    {KIND_OTHER, 0, BYTES("P3"), "text PPM"},
    {KIND_OTHER, 0, BYTES("P4"), "PBM"},
    {KIND_OTHER, 0, BYTES("P5"), "PGM"},
    {KIND_OTHER, 0, BYTES("P7"), "PAM"},
    {KIND_PFM, 0, BYTES("PF"), "PFM"},
    {KIND_OTHER, 0, BYTES("Pf"), "grey PFM"},
    {KIND_EXR, 0, BYTES("\x76\x2f\x31\x01"), "OpenEXR"},
    {KIND_OTHER, 0, BYTES("#?RADIANCE"), "Radiance"},
    {KIND_OTHER, 0, BYTES("8BPS"), "Photoshop"},
    {KIND_OTHER, 0, BYTES("qoif"), "QOI"},
    {KIND_OTHER, 4, BYTES("ftypavif"), "AVIF"},
    {KIND_OTHER, 4, BYTES("ftyphei"), "HEIF"},
    {KIND_OTHER, 0, BYTES("<svg"), "SVG"},
};
enum { SIGNATURES = sizeof signatures / sizeof *signatures };

static const struct signature *signature_of(const uint8_t *bytes, size_t n)
{
    for (size_t i = 0; i < SIGNATURES; i++) {
        const struct signature *s = &signatures[i];
        if (n >= s->at + s->n && memcmp(bytes + s->at, s->bytes, s->n) == 0)
            return s;
    }
    return NULL;
}

bool picture_recognised(const void *bytes, size_t n)
{
    return signature_of(bytes, n) != NULL;
}

void image_reason(char reason[IMAGE_REASON_BYTES], const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(reason, IMAGE_REASON_BYTES, format, args);
    va_end(args);
}

bool image_size_allowed(uint64_t width, uint64_t height)
{
    return width > 0 && height > 0 && width <= IMAGE_SIDE_LIMIT && height <= IMAGE_SIDE_LIMIT &&
           width * height <= IMAGE_PIXEL_LIMIT;
}

bool image_size_check(uint64_t width, uint64_t height, char reason[IMAGE_REASON_BYTES])
{
    if (image_size_allowed(width, height))
        return true;
    image_reason(reason, "the picture's size of %llu x %llu is %s", (unsigned long long)width,
                 (unsigned long long)height, width && height ? "larger than the limit" : "nothing");
    return false;
}

/* Samples of an allowed size: fits, for IMAGE_PIXEL_LIMIT is 2^28. */
static size_t sample_count(uint32_t width, uint32_t height)
{
    return (size_t)3 * width * height;
}

struct picture *picture_new(uint32_t width, uint32_t height, enum picture_depth depth)
{
    struct picture *p = mem_zalloc(1, sizeof *p);
    void *channels = mem_zalloc(sample_count(width, height), picture_pixel_bytes(depth) / 3);
    p->width = width;
    p->height = height;
    p->gain = 1;
    if (depth == PICTURE_FLOATS)
        p->floats = channels;
    else if (depth == PICTURE_WORDS)
        p->words = channels;
    else
        p->bytes = channels;
    return p;
}

void picture_free(struct picture *p)
{
    if (!p)
        return;
    free(p->bytes);
    free(p->floats);
    free(p->srgb);
    free(p->words);
    free(p);
}

enum picture_depth picture_depth_of(const struct picture *p)
{
    return p->floats ? PICTURE_FLOATS : p->words ? PICTURE_WORDS : PICTURE_BYTES;
}

size_t picture_pixel_bytes(enum picture_depth depth)
{
    static const size_t bytes[] = {
        [PICTURE_BYTES] = 3, [PICTURE_FLOATS] = 3 * sizeof(float), [PICTURE_WORDS] = 6};
    return bytes[depth];
}

void *picture_pixel(const struct picture *p, uint32_t x, uint32_t y)
{
    size_t at = ((size_t)y * p->width + x) * 3;
    return p->floats  ? (void *)(p->floats + at)
           : p->words ? (void *)(p->words + at)
                      : (void *)(p->bytes + at);
}

struct image *image_new(uint32_t width, uint32_t height, int depth)
{
    struct image *i = mem_zalloc(1, sizeof *i);
    i->width = width;
    i->height = height;
    if (depth == 16)
        i->data16 = mem_alloc(sample_count(width, height), sizeof *i->data16);
    else
        i->data8 = mem_alloc(sample_count(width, height) + 5, sizeof *i->data8);
    return i;
}

void image_free(struct image *i)
{
    if (!i)
        return;
    free(i->data8);
    free(i->data16);
    free(i);
}

bool image_equal(const struct image *a, const struct image *b)
{
    size_t channels = 3 * (size_t)a->width * a->height;
    if (a == b)
        return true;
    if (a->width != b->width || a->height != b->height || !a->data8 != !b->data8)
        return false;
    return a->data8 ? memcmp(a->data8, b->data8, channels) == 0
                    : memcmp(a->data16, b->data16, channels * sizeof *a->data16) == 0;
}

void picture_encode_as(struct picture *p, enum picture_encoding encoding)
{
    p->encoding = encoding;
    if (encoding != ENCODING_SRGB || p->srgb || !p->bytes)
        return;
    p->srgb = mem_alloc(1, sizeof *p->srgb);
    srgb_bytes_init(p->srgb);
}

double picture_rounding(const struct picture *p)
{
    return p->encoding == ENCODING_PLAIN ? 0.1 : 0.5;
}

/* From 0 to `most`.  The comparisons are false for NaN. */
static uint16_t channel_whole(double c, double most, double rounding)
{
    double whole = c < 1 ? c * most + rounding : most;
    return (uint16_t)(c > 0 ? whole : 0);
}

double picture_channel(enum picture_encoding encoding, double c)
{
    c = c > 0 ? c < 1 ? c : 1 : 0;
    return encoding == ENCODING_SRGB ? srgb_encode(c) : c;
}

uint8_t picture_byte(const struct picture *p, double c)
{
    return p->srgb ? srgb_byte(p->srgb, c) : (uint8_t)channel_whole(c, 255, picture_rounding(p));
}

void picture_set(struct picture *p, uint32_t x, uint32_t y, struct vec3 colour)
{
    size_t at = ((size_t)y * p->width + x) * 3;
    double channel[3] = {colour.x * p->gain, colour.y * p->gain, colour.z * p->gain};
    for (int i = 0; i < 3; i++) {
        double c = channel[i];
        if (p->floats)
            p->floats[at + i] = (float)c;
        else if (p->words)
            p->words[at + i] = channel_whole(picture_channel(p->encoding, c), 65535, 0.5);
        else
            p->bytes[at + i] = picture_byte(p, c);
    }
}

struct image *image_decode(const void *bytes, size_t n, char reason[IMAGE_REASON_BYTES])
{
    const struct signature *s = signature_of(bytes, n);
    if (s && s->kind == KIND_PNG)
        return png_file_decode(bytes, n, reason);
    if (s && s->kind == KIND_JPEG) {
        struct image *image = jpeg_file_decode(bytes, n, reason);
        if (image)
            image->jpeg = true;
        return image;
    }
    if (s)
        image_reason(reason, "%s pictures are not read as textures; PNG and JPEG are", s->name);
    else
        image_reason(reason, n ? "not a PNG or JPEG picture" : "the file is empty");
    return NULL;
}

bool picture_format_of(const char *path, enum picture_format *format)
{
    static const struct {
        const char *suffix;
        enum picture_format format;
    } suffixes[] = {
        {".png", PICTURE_PNG},
        {".ppm", PICTURE_PPM},
        {".pfm", PICTURE_PFM},
        {".exr", PICTURE_EXR},
    };
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash ? slash : path, '.');
    *format = PICTURE_PNG;
    if (!dot)
        return true;
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
        if (str_equal_nocase(str_of(dot), str_of(suffixes[i].suffix))) {
            *format = suffixes[i].format;
            return true;
        }
    }
    return false;
}

bool picture_format_built(enum picture_format format)
{
#ifdef HAVE_OPENEXR
    (void)format;
    return true;
#else
    return format != PICTURE_EXR;
#endif
}

void *picture_encode(const struct picture *p, enum picture_format format, size_t *n,
                     char reason[IMAGE_REASON_BYTES])
{
    static const char *const wants[] = {[PICTURE_PNG] = "PNG wants a picture of bytes or words",
                                        [PICTURE_PPM] = "PPM wants a picture of bytes",
                                        [PICTURE_PFM] = "PFM wants a picture of floats",
                                        [PICTURE_EXR] = "OpenEXR wants a picture of floats"};
    bool fits = format == PICTURE_PNG   ? p->floats == NULL
                : format == PICTURE_PPM ? p->bytes != NULL
                                        : p->floats != NULL;
    if (!fits) {
        image_reason(reason, "%s", wants[format]);
        return NULL;
    }
    switch (format) {
    case PICTURE_PPM:
        return ppm_file_encode(p, n);
    case PICTURE_PFM:
        return pfm_file_encode(p, n);
    case PICTURE_EXR:
        return exr_file_encode(p, n, reason);
    case PICTURE_PNG:
    default:
        return png_file_encode(p, n, reason);
    }
}

/* Hands the samples over; frees the image. */
static struct picture *picture_of_image(struct image *i)
{
    struct picture *p = mem_zalloc(1, sizeof *p);
    *p = (struct picture){
        .width = i->width, .height = i->height, .gain = 1, .bytes = i->data8, .words = i->data16};
    i->data8 = NULL;
    i->data16 = NULL;
    image_free(i);
    return p;
}

struct picture *picture_decode(const void *bytes, size_t n, char reason[IMAGE_REASON_BYTES])
{
    const struct signature *s = signature_of(bytes, n);
    struct image *i = NULL;
    if (s && s->kind == KIND_PNG)
        i = png_file_decode(bytes, n, reason);
    else if (s && s->kind == KIND_PPM)
        i = ppm_file_decode(bytes, n, reason);
    else if (s && s->kind == KIND_PFM)
        return pfm_file_decode(bytes, n, reason);
    else if (s && s->kind == KIND_EXR)
        return exr_file_decode(bytes, n, reason);
    else if (s)
        image_reason(reason, "%s pictures are not read here; PNG, binary PPM, PFM and OpenEXR are",
                     s->name);
    else
        image_reason(reason, n ? "not a PNG, PPM, PFM or OpenEXR picture" : "the file is empty");
    return i ? picture_of_image(i) : NULL;
}
