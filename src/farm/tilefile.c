#include "config.h"

#include "farm/tilefile.h"

#include "base/hash.h"
#include "farm/parts.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define BYTE_ORDER_NAME "big"
#else
#define BYTE_ORDER_NAME "little"
#endif

static const char *const encodings[] = {
    [ENCODING_PLAIN] = "plain", [ENCODING_SRGB] = "srgb", [ENCODING_LINEAR] = "linear"};
static const int bits[] = {[PICTURE_BYTES] = 8, [PICTURE_FLOATS] = 32, [PICTURE_WORDS] = 16};
enum { ENCODINGS = 3, DEPTHS = 3 };

/* Before and behind the pixels of a record. */
enum { RECORD_HEAD = 16, RECORD_CHECK = 8 };

/* What the first line says, but for the version of the layout. */
static const char MARK[] = "wrt tiles ";

/* ---- heads ---- */

bool tilefile_recognised(const char *bytes, size_t n)
{
    return n >= strlen(MARK) && memcmp(bytes, MARK, strlen(MARK)) == 0;
}

int tilefile_bits(const struct tilefile_head *h)
{
    return bits[h->depth];
}

struct tiling tilefile_tiling(const struct tilefile_head *h)
{
    return tiling_of(0, 0, h->width, h->height);
}

const char *tilefile_other(const struct tilefile_head *a, const struct tilefile_head *b,
                           struct buffer *room)
{
    room->n = 0;
    if (strcmp(a->version, b->version) != 0)
        buffer_printf(room, "it was made by wrt %s, and this is %s", a->version, b->version);
    else if (a->scene != b->scene)
        buffer_puts(room, "it is of another scene");
    else if (strcmp(a->settings, b->settings) != 0)
        buffer_printf(room, "it was made with '%s', not '%s'", a->settings, b->settings);
    else if (a->width != b->width || a->height != b->height || a->depth != b->depth ||
             a->encoding != b->encoding)
        buffer_puts(room, "its pixels are kept in another way");
    else
        return NULL;
    buffer_add(room, "", 1);
    return room->at;
}

void tilefile_tell(const struct tilefile_head *h, struct tilefile_texts *out)
{
    snprintf(out->software, sizeof out->software, "wrt %s", h->version);
    snprintf(out->scene, sizeof out->scene, "%016" PRIx64, h->scene);
    out->at[0] = (struct picture_text){"Software", out->software};
    out->at[1] = (struct picture_text){"Scene", out->scene};
    out->at[2] = (struct picture_text){"Settings", h->settings};
}

uint64_t tilefile_put_head(struct buffer *out, const struct tilefile_head *h)
{
    size_t start = out->n;
    buffer_printf(out, "wrt tiles 1\nversion %s\nscene %016" PRIx64 "\nsettings %s\n", h->version,
                  h->scene, h->settings);
    buffer_printf(out, "stored %" PRIu32 "x%" PRIu32 " %d %s %s\npart %" PRIu32 " %" PRIu32 "\n",
                  h->width, h->height, bits[h->depth], encodings[h->encoding], BYTE_ORDER_NAME,
                  h->part, h->parts);
    uint64_t check = hash_of(out->at + start, out->n - start, 0);
    buffer_printf(out, "check %016" PRIx64 "\n", check);
    return check;
}

/* A line that starts with a word; what follows the word and a blank, without the line's end.  NULL
 * for another line. */
static char *read_line(FILE *f, struct hash *sum, const char *word, char *line, size_t room)
{
    size_t n = strlen(word);
    if (!fgets(line, (int)room, f))
        return NULL;
    size_t length = strlen(line);
    if (length == 0 || line[length - 1] != '\n' || strncmp(line, word, n) != 0 || line[n] != ' ')
        return NULL;
    hash_add(sum, line, length);
    line[length - 1] = 0;
    return line + n + 1;
}

static bool copy_text(char *to, size_t room, const char *from)
{
    size_t n = from ? strlen(from) : room;
    if (n >= room)
        return false;
    memcpy(to, from, n + 1);
    return true;
}

static bool read_stored(struct tilefile_head *h, const char *text)
{
    char encoding[16] = "", order[16] = "";
    int depth = 0;
    if (!text || sscanf(text, "%" SCNu32 "x%" SCNu32 " %d %15s %15s", &h->width, &h->height, &depth,
                        encoding, order) != 5)
        return false;
    int d = 0, e = 0;
    while (d < DEPTHS && bits[d] != depth)
        d++;
    while (e < ENCODINGS && strcmp(encodings[e], encoding) != 0)
        e++;
    h->depth = (enum picture_depth)d;
    h->encoding = (enum picture_encoding)e;
    return d < DEPTHS && e < ENCODINGS && strcmp(order, BYTE_ORDER_NAME) == 0 &&
           image_size_allowed(h->width, h->height);
}

static bool read_head(FILE *f, struct tilefile_head *h, uint64_t *check)
{
    char line[512];
    struct hash sum;
    hash_begin(&sum, 0);
    const char *text = read_line(f, &sum, "wrt", line, sizeof line);
    if (!text || strcmp(text, "tiles 1") != 0)
        return false;
    if (!copy_text(h->version, sizeof h->version, read_line(f, &sum, "version", line, sizeof line)))
        return false;
    text = read_line(f, &sum, "scene", line, sizeof line);
    if (!text || sscanf(text, "%" SCNx64, &h->scene) != 1)
        return false;
    if (!copy_text(h->settings, sizeof h->settings,
                   read_line(f, &sum, "settings", line, sizeof line)))
        return false;
    if (!read_stored(h, read_line(f, &sum, "stored", line, sizeof line)))
        return false;
    text = read_line(f, &sum, "part", line, sizeof line);
    if (!text || sscanf(text, "%" SCNu32 " %" SCNu32, &h->part, &h->parts) != 2)
        return false;
    *check = hash_end(&sum);
    uint64_t told;
    text = read_line(f, &sum, "check", line, sizeof line);
    return text && sscanf(text, "%" SCNx64, &told) == 1 && told == *check && h->part <= h->parts &&
           (h->part > 0 || h->parts == 0);
}

/* ---- records ---- */

static size_t tiles_bytes(const struct tiling *tiling, const struct picture *p, size_t first,
                          size_t n)
{
    size_t pixels = 0;
    for (size_t i = first; i < first + n; i++) {
        struct tile tile = tiling_at(tiling, i);
        pixels += tile_pixels(&tile);
    }
    return pixels * picture_pixel_bytes(picture_depth_of(p));
}

static void put_check(struct buffer *out, size_t start, uint64_t check)
{
    uint64_t sum = hash_of(out->at + start, out->n - start, check);
    buffer_add(out, (const char *)&sum, sizeof sum);
}

void tilefile_put_tiles(struct buffer *out, uint64_t check, const struct tiling *tiling,
                        const struct picture *p, size_t first, size_t n)
{
    size_t start = out->n, pixel = picture_pixel_bytes(picture_depth_of(p));
    uint64_t head[2] = {first, n};
    buffer_add(out, (const char *)head, sizeof head);
    for (size_t i = first; i < first + n; i++) {
        struct tile t = tiling_at(tiling, i);
        for (uint32_t y = t.y0; y < t.y1; y++)
            buffer_add(out, picture_pixel(p, t.x0, y), (t.x1 - t.x0) * pixel);
    }
    put_check(out, start, check);
}

void tilefile_put_end(struct buffer *out, uint64_t check, size_t tiles)
{
    size_t start = out->n;
    uint64_t head[2] = {TILEFILE_END, tiles};
    buffer_add(out, (const char *)head, sizeof head);
    put_check(out, start, check);
}

bool tilefile_take_tiles(const struct tiling *tiling, const char *record, size_t bytes,
                         struct picture *p, size_t *first, size_t *n)
{
    uint64_t head[2];
    if (bytes < sizeof head)
        return false;
    memcpy(head, record, sizeof head);
    if (head[0] >= tiling->n || head[1] == 0 || head[1] > tiling->n - head[0] ||
        bytes != sizeof head + tiles_bytes(tiling, p, (size_t)head[0], (size_t)head[1]))
        return false;
    *first = (size_t)head[0];
    *n = (size_t)head[1];
    size_t pixel = picture_pixel_bytes(picture_depth_of(p));
    record += sizeof head;
    for (size_t i = *first; i < *first + *n; i++) {
        struct tile t = tiling_at(tiling, i);
        for (uint32_t y = t.y0; y < t.y1; y++, record += (t.x1 - t.x0) * pixel)
            memcpy(picture_pixel(p, t.x0, y), record, (t.x1 - t.x0) * pixel);
    }
    return true;
}

/* ---- files ---- */

const char *tilefile_open(struct tilefile *t, const char *path, bool *torn)
{
    static const char start[] = "wrt tiles 1\n";
    *t = (struct tilefile){.file = fopen(path, "rbe")};
    *torn = false;
    t->failed = !t->file;
    if (t->failed)
        return strerror(errno);
    char first[sizeof start - 1];
    size_t have = fread(first, 1, sizeof first, t->file);
    rewind(t->file);
    if (read_head(t->file, &t->head, &t->check)) {
        t->tiling = tilefile_tiling(&t->head);
        t->good = (uint64_t)ftello(t->file);
        return NULL;
    }
    *torn = feof(t->file) && memcmp(first, start, have) == 0;
    t->failed = ferror(t->file);
    const char *reason = t->failed ? strerror(errno)
                         : *torn   ? "it ends within its head"
                         : have == sizeof first && memcmp(first, start, have) == 0
                             ? "its head is damaged"
                             : "it is no file of tiles";
    tilefile_close(t);
    return reason;
}

static bool read_bytes(struct tilefile *t, size_t n)
{
    size_t have = t->record.n;
    buffer_fill(&t->record, 0, n);
    return fread(t->record.at + have, 1, n, t->file) == n;
}

enum tilefile_found tilefile_next(struct tilefile *t, struct picture *p, size_t *first, size_t *n)
{
    uint64_t head[2], told;
    t->record.n = 0;
    if (!read_bytes(t, RECORD_HEAD))
        return TILEFILE_DAMAGED;
    memcpy(head, t->record.at, sizeof head);
    bool last = head[0] == TILEFILE_END;
    if (!last && (head[0] >= t->tiling.n || head[1] == 0 || head[1] > t->tiling.n - head[0]))
        return TILEFILE_DAMAGED;
    size_t bytes = last ? 0 : tiles_bytes(&t->tiling, p, (size_t)head[0], (size_t)head[1]);
    if (!read_bytes(t, bytes) || fread(&told, 1, sizeof told, t->file) != sizeof told ||
        told != hash_of(t->record.at, t->record.n, t->check))
        return TILEFILE_DAMAGED;
    t->good += t->record.n + sizeof told;
    *n = (size_t)head[1];
    if (last)
        return TILEFILE_LAST;
    return tilefile_take_tiles(&t->tiling, t->record.at, t->record.n, p, first, n)
               ? TILEFILE_TILES
               : TILEFILE_DAMAGED;
}

void tilefile_close(struct tilefile *t)
{
    t->failed |= t->file && ferror(t->file);
    if (t->file)
        fclose(t->file);
    t->file = NULL;
    buffer_free(&t->record);
}
