/* PNG through libpng, compressed by libdeflate.
 *
 * libpng reports errors by longjmp.  What it may jump over lives in a struct owned by the caller
 * of the function that calls setjmp, so no local variable can be clobbered. */
#include "config.h"

#include "image/codec.h"

#include "base/mem.h"
#include "base/vec.h"

#include <libdeflate.h>
#include <png.h>
#include <setjmp.h>
#include <string.h>

/* ---- errors ---------------------------------------------------------------------------------- */

static _Noreturn void on_error(png_structp png, png_const_charp message)
{
    char *reason = png_get_error_ptr(png);
    if (!reason[0])
        image_reason(reason, "the PNG is damaged (libpng: %s)", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

/* Running out of memory ends the program, as it does elsewhere. */
static png_voidp allocate(png_structp png, png_alloc_size_t n)
{
    (void)png;
    return mem_alloc(n, 1);
}

static void release(png_structp png, png_voidp p)
{
    (void)png;
    free(p);
}

/* ---- reading --------------------------------------------------------------------------------- */

struct decoder {
    png_structp png;
    png_infop info;
    const uint8_t *at, *end;
    struct image *image;
    char *reason;
};

static void read_bytes(png_structp png, png_bytep out, size_t n)
{
    struct decoder *d = png_get_io_ptr(png);
    if (n > (size_t)(d->end - d->at)) {
        image_reason(d->reason, "the picture ends early");
        png_error(png, "end of file");
    }
    memcpy(out, d->at, n);
    d->at += n;
}

/* Chunks that do not change a pixel here are not even unpacked: a text or profile may be a
 * compressed bomb. */
static void skip_chunks(png_structp png)
{
    static const png_byte names[] = "iCCP\0zTXt\0iTXt\0tEXt\0sPLT\0eXIf\0hIST\0bKGD\0pCAL\0sCAL";
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, 0);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, names, (int)(sizeof names / 5));
}

/* Deflate packs 1032 bytes into one at most (zlib's technical details), so a header that claims
 * more than the file can hold is found out before any memory is asked for. */
static void check_size(struct decoder *d, size_t file_bytes)
{
    uint32_t height = png_get_image_height(d->png, d->info);
    if (!image_size_check(png_get_image_width(d->png, d->info), height, d->reason))
        png_error(d->png, "size");
    uint64_t raw = (uint64_t)png_get_rowbytes(d->png, d->info) * height;
    if (raw / 1032 > file_bytes) {
        image_reason(d->reason, "the picture ends early");
        png_error(d->png, "end of file");
    }
}

/* Any kind of PNG to RGB of 8 or 16 bits.  A tRNS chunk of grey or RGB pictures needs no
 * transformation: it is alpha, and alpha is dropped. */
static void set_transformations(png_structp png, png_infop info)
{
    int colour = png_get_color_type(png, info);
    if (colour == PNG_COLOR_TYPE_PALETTE)
        png_set_palette_to_rgb(png);
    else if (!(colour & PNG_COLOR_MASK_COLOR)) {
        if (png_get_bit_depth(png, info) < 8)
            png_set_expand_gray_1_2_4_to_8(png);
        png_set_gray_to_rgb(png);
    }
    png_set_strip_alpha(png);
#ifndef WORDS_BIGENDIAN
    if (png_get_bit_depth(png, info) == 16)
        png_set_swap(png);
#endif
}

static void read_rows(struct decoder *d, int passes)
{
    const struct image *i = d->image;
    size_t row_bytes = png_get_rowbytes(d->png, d->info);
    uint8_t *data = i->data16 ? (uint8_t *)i->data16 : i->data8;
    if (row_bytes != (size_t)3 * i->width * (i->data16 ? 2 : 1))
        png_error(d->png, "the picture is of an unknown kind");
    for (int pass = 0; pass < passes; pass++)
        for (uint32_t y = 0; y < i->height; y++)
            png_read_row(d->png, data + y * row_bytes, NULL);
}

static void decode(struct decoder *d)
{
    size_t file_bytes = (size_t)(d->end - d->at);
    png_set_read_fn(d->png, d, read_bytes);
    png_set_user_limits(d->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX); /* check_size has its own */
    skip_chunks(d->png);
    png_read_info(d->png, d->info);
    check_size(d, file_bytes);
    set_transformations(d->png, d->info);
    int passes = png_set_interlace_handling(d->png);
    png_read_update_info(d->png, d->info);
    d->image = image_new(png_get_image_width(d->png, d->info),
                         png_get_image_height(d->png, d->info), png_get_bit_depth(d->png, d->info));
    read_rows(d, passes);
    png_read_end(d->png, NULL); /* checks that the file goes on to its end mark */
}

static bool decode_guarded(struct decoder *d)
{
    if (setjmp(png_jmpbuf(d->png)))
        return false;
    decode(d);
    return true;
}

struct image *png_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES])
{
    struct decoder d = {.at = bytes, .end = bytes + n, .reason = reason};
    reason[0] = 0;
    d.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, reason, on_error, on_warning, NULL,
                                     allocate, release);
    if (d.png)
        d.info = png_create_info_struct(d.png);
    bool ok = d.info && decode_guarded(&d);
    png_destroy_read_struct(&d.png, &d.info, NULL);
    if (ok)
        return d.image;
    if (!reason[0])
        image_reason(reason, "could not start libpng");
    image_free(d.image);
    return NULL;
}

/* ---- writing --------------------------------------------------------------------------------- */

struct encoder {
    png_structp png;
    png_infop info;
    const struct picture *picture;
    uint8_t *data; /* compressed */
    size_t data_bytes;
    VEC(uint8_t) out;
};

static void write_bytes(png_structp png, png_bytep bytes, size_t n)
{
    struct encoder *e = png_get_io_ptr(png);
    vec_reserve(&e->out, n);
    memcpy(e->out.at + e->out.n, bytes, n);
    e->out.n += n;
}

static void flush(png_structp png)
{
    (void)png;
}

/* The bytes of a row: words become big-endian, in `room`. */
static const uint8_t *row_bytes(const struct picture *p, uint32_t y, uint8_t *room)
{
    size_t channels = (size_t)3 * p->width;
    if (p->bytes)
        return p->bytes + channels * y;
    for (size_t i = 0; i < channels; i++) {
        room[2 * i] = (uint8_t)(p->words[channels * y + i] >> 8);
        room[2 * i + 1] = (uint8_t)p->words[channels * y + i];
    }
    return room;
}

/* The rows with PNG's filter Sub: each byte less that of the pixel to its left. */
static void filter_rows(const struct picture *p, uint8_t *out)
{
    size_t pixel = picture_pixel_bytes(picture_depth_of(p)), row = pixel * p->width;
    uint8_t *room = p->words ? mem_alloc(row, 1) : NULL;
    for (uint32_t y = 0; y < p->height; y++) {
        const uint8_t *from = row_bytes(p, y, room);
        *out++ = PNG_FILTER_VALUE_SUB;
        memcpy(out, from, pixel);
        for (size_t i = pixel; i < row; i++)
            out[i] = (uint8_t)(from[i] - from[i - pixel]);
        out += row;
    }
    free(room);
}

/* libdeflate's level 1 takes half the time of zlib's level 1, which libpng would use, and leaves a
 * tenth less; higher levels cost more than rendering a plain scene (see bench/RESULTS.md). */
enum { LEVEL = 1 };

/* The picture's data as a zlib stream of *n bytes, to be freed. */
static uint8_t *compress(const struct picture *p, size_t *n)
{
    size_t pixel = picture_pixel_bytes(picture_depth_of(p));
    size_t filtered_bytes = (pixel * p->width + 1) * p->height;
    uint8_t *filtered = mem_alloc(filtered_bytes, 1);
    struct libdeflate_compressor *c = libdeflate_alloc_compressor(LEVEL);
    if (!c)
        mem_exhausted(filtered_bytes);
    filter_rows(p, filtered);
    size_t bound = libdeflate_zlib_compress_bound(c, filtered_bytes);
    uint8_t *out = mem_alloc(bound, 1);
    *n = libdeflate_zlib_compress(c, filtered, filtered_bytes, out, bound);
    libdeflate_free_compressor(c);
    free(filtered);
    return out;
}

/* libpng copies both. */
static void set_text(struct encoder *e, const struct picture_text *t)
{
    union {
        const char *borrowed;
        char *text;
    } key = {t->key}, value = {t->value};
    png_text text = {.compression = PNG_TEXT_COMPRESSION_NONE,
                     .key = key.text,
                     .text = value.text,
                     .text_length = strlen(t->value)};
    png_set_text(e->png, e->info, &text, 1);
}

static void encode(struct encoder *e)
{
    const struct picture *p = e->picture;
    png_set_write_fn(e->png, e, write_bytes, flush);
    png_set_user_limits(e->png, IMAGE_SIDE_LIMIT, IMAGE_SIDE_LIMIT);
    png_set_IHDR(e->png, e->info, p->width, p->height, p->words ? 16 : 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (p->encoding == ENCODING_SRGB)
        png_set_sRGB(e->png, e->info, PNG_sRGB_INTENT_PERCEPTUAL);
    else if (p->encoding == ENCODING_LINEAR)
        png_set_gAMA(e->png, e->info, 1);
    for (uint32_t i = 0; i < p->text_count; i++)
        set_text(e, &p->texts[i]);
    png_write_info(e->png, e->info);
    png_write_chunk(e->png, (png_const_bytep) "IDAT", e->data, e->data_bytes);
    png_write_chunk(e->png, (png_const_bytep) "IEND", NULL, 0);
}

static bool encode_guarded(struct encoder *e)
{
    if (setjmp(png_jmpbuf(e->png)))
        return false;
    encode(e);
    return true;
}

void *png_file_encode(const struct picture *p, size_t *n, char reason[IMAGE_REASON_BYTES])
{
    struct encoder e = {.picture = p};
    e.data = compress(p, &e.data_bytes);
    reason[0] = 0;
    e.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, reason, on_error, on_warning, NULL,
                                      allocate, release);
    if (e.png)
        e.info = png_create_info_struct(e.png);
    bool ok = e.info && encode_guarded(&e);
    png_destroy_write_struct(&e.png, &e.info);
    free(e.data);
    if (ok) {
        *n = e.out.n;
        return e.out.at;
    }
    if (!reason[0])
        image_reason(reason, "could not start libpng");
    vec_free(&e.out);
    return NULL;
}
