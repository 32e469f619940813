/* The file formats behind picture.h: one pair of functions each, for picture.c alone.
 *
 * Decoders get the whole file, whose signature has been looked at, and return NULL with a reason
 * on failure.  Encoders cannot fail but for memory; the caller frees what they return. */
#ifndef WRT_IMAGE_CODEC_H
#define WRT_IMAGE_CODEC_H

#include "image/picture.h"

/* An image without pixels yet: 8 or 16 bits a channel.  The size must be allowed. */
struct image *image_new(uint32_t width, uint32_t height, int depth);

/* Fills the reason, cut to fit. */
void image_reason(char reason[IMAGE_REASON_BYTES], const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* As image_size_allowed, with a reason when it is not. */
bool image_size_check(uint64_t width, uint64_t height, char reason[IMAGE_REASON_BYTES]);

struct image *png_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES]);
void *png_file_encode(const struct picture *p, size_t *n, char reason[IMAGE_REASON_BYTES]);

struct image *jpeg_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES]);

struct image *ppm_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES]);
void *ppm_file_encode(const struct picture *p, size_t *n);
void *pfm_file_encode(const struct picture *p, size_t *n);
struct picture *pfm_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES]);

/* Where the program was built without OpenEXR they say so. */
void *exr_file_encode(const struct picture *p, size_t *n, char reason[IMAGE_REASON_BYTES]);
struct picture *exr_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES]);

#endif
