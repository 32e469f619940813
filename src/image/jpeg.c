/* JPEG through libjpeg.
 *
 * libjpeg reports errors through a callback that must not return.  What its longjmp passes over
 * lives in a struct owned by the caller of the function that calls setjmp, so no local variable can
 * be clobbered. */
#include "config.h"

#include "image/codec.h"

#ifndef HAVE_JPEG

struct image *jpeg_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES])
{
    (void)bytes;
    (void)n;
    image_reason(reason, "this wrt was built without JPEG support");
    return NULL;
}

#else

#include "base/mem.h"

#include <stdio.h>

#include <jpeglib.h>

#include <jerror.h>
#include <setjmp.h>

/* Programs write about ten scans; each costs a pass over the whole picture however few bytes it
 * has, so a small file could ask for days of work. */
enum { SCAN_LIMIT = 100 };

struct decoder {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf escape;
    const uint8_t *bytes;
    size_t n;
    struct image *image;
    char *reason;
};

static _Noreturn void give_up(j_common_ptr jpeg)
{
    struct decoder *d = jpeg->client_data;
    longjmp(d->escape, 1);
}

static _Noreturn void on_error(j_common_ptr jpeg)
{
    struct decoder *d = jpeg->client_data;
    char message[JMSG_LENGTH_MAX];
    if (d->errors.msg_code == JERR_OUT_OF_MEMORY)
        mem_exhausted((size_t)3 * d->jpeg.image_width * d->jpeg.image_height);
    d->errors.format_message(jpeg, message);
    image_reason(d->reason, "the JPEG is damaged (libjpeg: %s)", message);
    give_up(jpeg);
}

/* Called for warnings (level -1) and trace messages.  libjpeg goes on after a warning with grey or
 * torn pixels; here that is an error, but for oddities that change no pixel. */
static void on_message(j_common_ptr jpeg, int level)
{
    struct decoder *d = jpeg->client_data;
    int code = d->errors.msg_code;
    if (level >= 0 || code == JWRN_EXTRANEOUS_DATA || code == JWRN_JFIF_MAJOR ||
        code == JWRN_ADOBE_XFORM)
        return;
    if (code != JWRN_JPEG_EOF)
        on_error(jpeg);
    image_reason(d->reason, "the picture ends early");
    give_up(jpeg);
}

static void on_progress(j_common_ptr jpeg)
{
    struct decoder *d = jpeg->client_data;
    if (d->jpeg.input_scan_number <= SCAN_LIMIT)
        return;
    image_reason(d->reason, "the picture has more than %d scans", SCAN_LIMIT);
    give_up(jpeg);
}

/* Huffman's codes have a bit at least, and every block of 64 samples has a code, so a header that
 * claims more than the file can hold is found out before any memory is asked for. */
static void check_blocks(struct decoder *d)
{
    struct jpeg_decompress_struct *jpeg = &d->jpeg;
    uint64_t blocks = 0;
    for (int i = 0; i < jpeg->num_components; i++)
        blocks +=
            (uint64_t)jpeg->comp_info[i].width_in_blocks * jpeg->comp_info[i].height_in_blocks;
    if (jpeg->arith_code || blocks / 8 <= d->n)
        return;
    image_reason(d->reason, "the picture ends early");
    give_up((j_common_ptr)jpeg);
}

static void check_header(struct decoder *d)
{
    struct jpeg_decompress_struct *jpeg = &d->jpeg;
    if (!image_size_check(jpeg->image_width, jpeg->image_height, d->reason))
        give_up((j_common_ptr)jpeg);
    if (jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK) {
        image_reason(d->reason, "CMYK pictures are not read; RGB and grey ones are");
        give_up((j_common_ptr)jpeg);
    }
    check_blocks(d);
}

static void decode(struct decoder *d)
{
    struct jpeg_decompress_struct *jpeg = &d->jpeg;
    jpeg_create_decompress(jpeg);
    jpeg->progress = &d->progress;
    jpeg_mem_src(jpeg, d->bytes, (unsigned long)d->n);
    jpeg_read_header(jpeg, TRUE);
    check_header(d);
    jpeg->out_color_space = JCS_RGB;
    /* The defaults, said because the reference pictures depend on them. */
    jpeg->dct_method = JDCT_ISLOW;
    jpeg->do_fancy_upsampling = TRUE;
    jpeg_start_decompress(jpeg);
    d->image = image_new(jpeg->output_width, jpeg->output_height, 8);
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW row = d->image->data8 + (size_t)3 * d->image->width * jpeg->output_scanline;
        jpeg_read_scanlines(jpeg, &row, 1);
    }
    jpeg_finish_decompress(jpeg); /* checks that the file goes on to its end mark */
}

static bool decode_guarded(struct decoder *d)
{
    if (setjmp(d->escape))
        return false;
    decode(d);
    return true;
}

struct image *jpeg_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES])
{
    struct decoder d = {.bytes = bytes, .n = n, .reason = reason};
    d.jpeg.err = jpeg_std_error(&d.errors);
    d.jpeg.client_data = &d;
    d.errors.error_exit = on_error;
    d.errors.emit_message = on_message;
    d.progress.progress_monitor = on_progress;
    bool ok = decode_guarded(&d);
    jpeg_destroy_decompress(&d.jpeg);
    if (ok)
        return d.image;
    image_free(d.image);
    return NULL;
}

#endif
