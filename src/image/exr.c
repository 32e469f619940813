/* OpenEXR through OpenEXRCore, the library's part in C: one part of scan lines, ZIP, channels R, G
 * and B as floats or halves. */
#include "config.h"

#include "image/codec.h"

#ifdef HAVE_OPENEXR

#include "base/buffer.h"

#include <OpenEXR/openexr.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 3 };
static const char *const channel_names[CHANNELS] = {"R", "G", "B"};

/* A file in memory: what is written, or what is read. */
struct stream {
    struct buffer out;
    const uint8_t *in;
    size_t n;
    char *reason;
};

static void on_error(exr_const_context_t c, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (exr_get_user_data(c, &user) != EXR_ERR_SUCCESS || !user)
        return;
    struct stream *s = user;
    if (!s->reason[0])
        image_reason(s->reason, "the OpenEXR library says: %s", message);
}

/* The library goes back to fill in tables. */
static int64_t write_at(exr_const_context_t c, void *user, const void *bytes, uint64_t n,
                        uint64_t offset, exr_stream_error_func_ptr_t error)
{
    struct stream *s = user;
    (void)c;
    (void)error;
    if (offset + n > s->out.n)
        buffer_fill(&s->out, 0, offset + n - s->out.n);
    memcpy(s->out.at + offset, bytes, n);
    return (int64_t)n;
}

static int64_t read_at(exr_const_context_t c, void *user, void *bytes, uint64_t n, uint64_t offset,
                       exr_stream_error_func_ptr_t error)
{
    const struct stream *s = user;
    (void)c;
    (void)error;
    uint64_t have = offset < s->n ? s->n - offset : 0;
    uint64_t take = n < have ? n : have;
    if (take > 0)
        memcpy(bytes, s->in + offset, take);
    return (int64_t)take;
}

static int64_t size_of(exr_const_context_t c, void *user)
{
    const struct stream *s = user;
    (void)c;
    return (int64_t)s->n;
}

static exr_context_initializer_t initializer(struct stream *s)
{
    exr_context_initializer_t i = EXR_DEFAULT_CONTEXT_INITIALIZER;
    i.user_data = s;
    i.error_handler_fn = on_error;
    i.read_fn = read_at;
    i.size_fn = size_of;
    i.write_fn = write_at;
    i.max_image_width = IMAGE_SIDE_LIMIT;
    i.max_image_height = IMAGE_SIDE_LIMIT;
    return i;
}

/* ---- writing ---- */

static bool write_head(exr_context_t c, const struct picture *p)
{
    exr_pixel_type_t type = p->halves ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    int part;
    if (exr_add_part(c, NULL, EXR_STORAGE_SCANLINE, &part) != EXR_ERR_SUCCESS ||
        exr_initialize_required_attr_simple(c, part, (int32_t)p->width, (int32_t)p->height,
                                            EXR_COMPRESSION_ZIP) != EXR_ERR_SUCCESS)
        return false;
    for (int i = 0; i < CHANNELS; i++)
        if (exr_add_channel(c, part, channel_names[i], type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1) !=
            EXR_ERR_SUCCESS)
            return false;
    for (uint32_t i = 0; i < p->text_count; i++)
        if (exr_attr_set_string(c, part, p->texts[i].key, p->texts[i].value) != EXR_ERR_SUCCESS)
            return false;
    return exr_write_header(c) == EXR_ERR_SUCCESS;
}

/* Channel 0 is red, 1 green, 2 blue. */
static int channel_number(const char *name)
{
    for (int i = 0; i < CHANNELS; i++)
        if (strcmp(name, channel_names[i]) == 0)
            return i;
    return -1;
}

static void place_channel(exr_coding_channel_info_t *c, uint32_t width)
{
    c->user_data_type = EXR_PIXEL_FLOAT;
    c->user_bytes_per_element = sizeof(float);
    c->user_pixel_stride = CHANNELS * sizeof(float);
    c->user_line_stride = (int32_t)(CHANNELS * sizeof(float) * width);
}

static bool write_chunk(exr_context_t c, const struct picture *p, uint32_t y,
                        const exr_chunk_info_t *chunk, exr_encode_pipeline_t *e, bool first)
{
    exr_result_t made =
        first ? exr_encoding_initialize(c, 0, chunk, e) : exr_encoding_update(c, 0, chunk, e);
    if (made != EXR_ERR_SUCCESS)
        return false;
    for (int i = 0; i < e->channel_count; i++) {
        place_channel(&e->channels[i], p->width);
        e->channels[i].encode_from_ptr =
            (const uint8_t *)(p->floats + (size_t)CHANNELS * p->width * y +
                              channel_number(e->channels[i].channel_name));
    }
    if (first && exr_encoding_choose_default_routines(c, 0, e) != EXR_ERR_SUCCESS)
        return false;
    return exr_encoding_run(c, 0, e) == EXR_ERR_SUCCESS;
}

static bool write_lines(exr_context_t c, const struct picture *p)
{
    exr_encode_pipeline_t e = {0};
    int32_t lines;
    bool right = exr_get_scanlines_per_chunk(c, 0, &lines) == EXR_ERR_SUCCESS;
    for (uint32_t y = 0; y < p->height && right; y += (uint32_t)lines) {
        exr_chunk_info_t chunk = {0};
        right = exr_write_scanline_chunk_info(c, 0, (int)y, &chunk) == EXR_ERR_SUCCESS &&
                write_chunk(c, p, y, &chunk, &e, y == 0);
    }
    exr_encoding_destroy(c, &e);
    return right;
}

void *exr_file_encode(const struct picture *p, size_t *n, char reason[IMAGE_REASON_BYTES])
{
    struct stream s = {.reason = reason};
    exr_context_initializer_t init = initializer(&s);
    exr_context_t c;
    reason[0] = 0;
    bool right = exr_start_write(&c, "picture", EXR_WRITE_FILE_DIRECTLY, &init) == EXR_ERR_SUCCESS;
    if (right) {
        right = write_head(c, p) && write_lines(c, p);
        right &= exr_finish(&c) == EXR_ERR_SUCCESS;
    }
    if (right) {
        *n = s.out.n;
        return s.out.at;
    }
    if (!reason[0])
        image_reason(reason, "could not start OpenEXR");
    buffer_free(&s.out);
    return NULL;
}

/* ---- reading ---- */

/* The size, when the file is of a kind that is read. */
static bool read_head(exr_context_t c, struct stream *s, exr_attr_box2i_t *box, bool *halves)
{
    exr_storage_t storage;
    const exr_attr_chlist_t *list;
    int parts, found = 0;
    if (exr_get_count(c, &parts) != EXR_ERR_SUCCESS ||
        exr_get_storage(c, 0, &storage) != EXR_ERR_SUCCESS ||
        exr_get_channels(c, 0, &list) != EXR_ERR_SUCCESS ||
        exr_get_data_window(c, 0, box) != EXR_ERR_SUCCESS)
        return false;
    for (int i = 0; i < list->num_channels; i++) {
        const exr_attr_chlist_entry_t *e = &list->entries[i];
        found += channel_number(e->name.str) >= 0 && e->x_sampling == 1 && e->y_sampling == 1 &&
                 e->pixel_type != EXR_PIXEL_UINT;
        *halves = e->pixel_type == EXR_PIXEL_HALF;
    }
    if (parts == 1 && storage == EXR_STORAGE_SCANLINE && found == CHANNELS)
        return image_size_check((uint64_t)((int64_t)box->max.x - box->min.x + 1),
                                (uint64_t)((int64_t)box->max.y - box->min.y + 1), s->reason);
    image_reason(s->reason, "of OpenEXR, one part of scan lines is read, with channels R, G and B");
    return false;
}

static bool read_chunk(exr_context_t c, const struct picture *p, uint32_t y,
                       const exr_chunk_info_t *chunk, exr_decode_pipeline_t *d, bool first)
{
    exr_result_t made =
        first ? exr_decoding_initialize(c, 0, chunk, d) : exr_decoding_update(c, 0, chunk, d);
    if (made != EXR_ERR_SUCCESS)
        return false;
    for (int i = 0; i < d->channel_count; i++) {
        int number = channel_number(d->channels[i].channel_name);
        place_channel(&d->channels[i], p->width);
        if (number >= 0)
            d->channels[i].decode_to_ptr =
                (uint8_t *)(p->floats + (size_t)CHANNELS * p->width * y + number);
    }
    if (first && exr_decoding_choose_default_routines(c, 0, d) != EXR_ERR_SUCCESS)
        return false;
    return exr_decoding_run(c, 0, d) == EXR_ERR_SUCCESS;
}

static bool read_lines(exr_context_t c, const struct picture *p, int32_t top)
{
    exr_decode_pipeline_t d = {0};
    int32_t lines;
    bool right = exr_get_scanlines_per_chunk(c, 0, &lines) == EXR_ERR_SUCCESS;
    for (uint32_t y = 0; y < p->height && right; y += (uint32_t)lines) {
        exr_chunk_info_t chunk = {0};
        right = exr_read_scanline_chunk_info(c, 0, top + (int)y, &chunk) == EXR_ERR_SUCCESS &&
                read_chunk(c, p, y, &chunk, &d, y == 0);
    }
    exr_decoding_destroy(c, &d);
    return right;
}

struct picture *exr_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES])
{
    struct stream s = {.in = bytes, .n = n, .reason = reason};
    exr_context_initializer_t init = initializer(&s);
    struct picture *p = NULL;
    exr_attr_box2i_t box;
    exr_context_t c;
    bool halves = false, right = false;
    reason[0] = 0;
    if (exr_start_read(&c, "picture", &init) == EXR_ERR_SUCCESS) {
        if (read_head(c, &s, &box, &halves)) {
            p = picture_new((uint32_t)(box.max.x - box.min.x + 1),
                            (uint32_t)(box.max.y - box.min.y + 1), PICTURE_FLOATS);
            p->halves = halves;
            right = read_lines(c, p, box.min.y);
        }
        exr_finish(&c);
    }
    if (right)
        return p;
    if (!reason[0])
        image_reason(reason, "the OpenEXR file is damaged");
    picture_free(p);
    return NULL;
}

#else

void *exr_file_encode(const struct picture *p, size_t *n, char reason[IMAGE_REASON_BYTES])
{
    (void)p;
    (void)n;
    image_reason(reason, "this wrt was built without OpenEXR");
    return NULL;
}

struct picture *exr_file_decode(const uint8_t *bytes, size_t n, char reason[IMAGE_REASON_BYTES])
{
    (void)bytes;
    (void)n;
    image_reason(reason, "this wrt was built without OpenEXR");
    return NULL;
}

#endif
