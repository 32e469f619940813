/* Rendered pictures and decoded textures.  Row 0 is the top of a picture. */
#ifndef WRT_IMAGE_PICTURE_H
#define WRT_IMAGE_PICTURE_H

#include "math/vec3.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* How the bytes of a picture hold light; floats hold it as it is. */
enum picture_encoding {
    ENCODING_PLAIN,  /* classic: floor(clamp(c, 0, 1) 255 + 0.1), as the original program did; words
                        to the nearest */
    ENCODING_SRGB,   /* IEC 61966-2-1, to the nearest byte or word; PNG files say so */
    ENCODING_LINEAR, /* to the nearest byte or word; PNG files say so, by a gamma of 1 */
};

/* What a channel is kept as: 8 bits, a 32-bit float as it came from the renderer, 16 bits. */
enum picture_depth { PICTURE_BYTES, PICTURE_FLOATS, PICTURE_WORDS };

/* What a file says beside the pixels: Latin letters and digits, keys of one to 79 of them. */
struct picture_text {
    const char *key, *value;
};

/* A picture to write: RGB. */
struct picture {
    uint32_t width, height;
    enum picture_encoding encoding; /* plain, unless picture_encode_as says otherwise */
    struct srgb_bytes *srgb;        /* with bytes of ENCODING_SRGB */
    double gain;                    /* of light before it is stored; picture_new makes it 1 */
    /* 3 width height channels, two of the three being NULL: */
    uint8_t *bytes;
    float *floats;
    uint16_t *words;
    bool halves;                      /* where the format has them, floats are kept in 16 bits */
    const struct picture_text *texts; /* borrowed; written where the format has a place for them */
    uint32_t text_count;
};

/* Largest width, height, and pixel count of a picture or texture. */
enum { IMAGE_SIDE_LIMIT = 1 << 20, IMAGE_PIXEL_LIMIT = 1 << 28 };
bool image_size_allowed(uint64_t width, uint64_t height);

/* One with zeroed pixels; the size must be allowed. */
struct picture *picture_new(uint32_t width, uint32_t height, enum picture_depth depth);
void picture_free(struct picture *p);

enum picture_depth picture_depth_of(const struct picture *p);
/* Bytes of a pixel in memory, and where one lies. */
size_t picture_pixel_bytes(enum picture_depth depth);
void *picture_pixel(const struct picture *p, uint32_t x, uint32_t y);

/* What its bytes or words hold from now on. */
void picture_encode_as(struct picture *p, enum picture_encoding encoding);
/* What is added to 255 times a channel before the fraction is cut off; not for sRGB. */
double picture_rounding(const struct picture *p);

/* What bytes and words hold of a channel, before they are rounded: from 0 to 1. */
double picture_channel(enum picture_encoding encoding, double c);

/* Stores a colour times the gain; bytes and words by the encoding, not-a-number gives 0.  Threads
 * may set different pixels at once. */
void picture_set(struct picture *p, uint32_t x, uint32_t y, struct vec3 colour);

/* What a byte holds of a channel. */
uint8_t picture_byte(const struct picture *p, double c);

/* Stores n pixels of three bytes in a row, from (x, y) on; tiles have 8 of them. */
static inline void picture_set_row(struct picture *p, uint32_t x, uint32_t y, const uint8_t *pixels,
                                   uint32_t n)
{
    uint8_t *to = p->bytes + ((size_t)y * p->width + x) * 3;
    if (n == 8)
        memcpy(to, pixels, 3 * 8);
    else
        memcpy(to, pixels, 3 * (size_t)n);
}

/* A decoded texture: RGB, 8 or 16 bits a channel (native byte order), grey spread to three
 * channels, palettes looked up, alpha dropped, gamma and profiles ignored. */
struct image {
    uint32_t width, height;
    uint8_t *data8;   /* 3 width height, then room for image_texels8 to read on; or NULL */
    uint16_t *data16; /* 3 width height, or NULL */
    bool jpeg;        /* what the file was; PNG otherwise */
};

/* Texel number `at` of 8 bits a channel and the next one in one load, 24 bits each: red in the low
 * byte, then green and blue; the high bytes are anything. */
static inline int64_t image_texels8(const struct image *image, size_t at)
{
    uint64_t texels;
    memcpy(&texels, image->data8 + 3 * at, sizeof texels);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    texels = __builtin_bswap64(texels);
#endif
    return (int64_t)texels;
}

/* Room for the reason of a failure: lower case, no full stop, NUL-terminated. */
enum { IMAGE_REASON_BYTES = 256 };

/* Decodes a whole PNG or JPEG file, told apart by content.  NULL on failure; then `reason` says
 * why: "GIF pictures are not read; PNG and JPEG are", "the picture ends early", ...  A damaged or
 * shortened file never gives a picture. */
struct image *image_decode(const void *bytes, size_t n, char reason[IMAGE_REASON_BYTES]);
void image_free(struct image *i);
/* The same size and pixels. */
bool image_equal(const struct image *a, const struct image *b);

enum picture_format { PICTURE_PNG, PICTURE_PPM, PICTURE_PFM, PICTURE_EXR };
/* Those that this program was built with; how many bits a channel of OpenEXR has. */
#ifdef HAVE_OPENEXR
#define PICTURE_SUFFIXES ".png, .ppm, .pfm and .exr"
#define PICTURE_EXR_BITS ", 32 or 16 in .exr"
#else
#define PICTURE_SUFFIXES ".png, .ppm and .pfm"
#define PICTURE_EXR_BITS ""
#endif

/* By the suffix of path (any case; none means PNG); false when it names no format. */
bool picture_format_of(const char *path, enum picture_format *format);
/* Whether this program has the library for it. */
bool picture_format_built(enum picture_format format);

/* The whole encoded file, to be freed by the caller; NULL with a reason on failure.  PPM
 * (P6) wants a picture of bytes, PNG one of bytes or words, PFM and OpenEXR
 * one of floats (any other is
 * refused).  Equal pictures give equal bytes on one machine. */
void *picture_encode(const struct picture *p, enum picture_format format, size_t *n,
                     char reason[IMAGE_REASON_BYTES]);

/* True when the bytes start as files of pictures do, read or not. */
bool picture_recognised(const void *bytes, size_t n);

/* Reads a PNG, a binary PPM, a PFM or an OpenEXR file back. */
struct picture *picture_decode(const void *bytes, size_t n, char reason[IMAGE_REASON_BYTES]);

#endif
