/* Files of finished tiles: journals of renders that may end early, and parts of pictures.
 *
 * A head of text says what picture the tiles are of, then records follow:
 *
 *     wrt tiles 1
 *     version 0.1.0
 *     scene 0123456789abcdef                the scene's fingerprint
 *     settings 640x480 samples 4 ...        all else that can change a byte
 *     stored 640x480 8 srgb little          pixels of the crop; bits, encoding, byte order
 *     part 1 7                              0 0 for a journal
 *     check 0123456789abcdef                of all lines before
 *
 * A record is two 64-bit numbers, the first tile and how many there are; the pixels of these tiles
 * as they lie in memory, row by row in each; and the XXH64 of all that, with the head's check as
 * seed. The last record of a part has no pixels: TILEFILE_END, and how many tiles the part has.
 * Numbers are in the machine's byte order, as the pixels are. */
#ifndef WRT_FARM_TILEFILE_H
#define WRT_FARM_TILEFILE_H

#include "base/buffer.h"
#include "image/picture.h"
#include "render/tiling.h"

#include <stdio.h>

#define TILEFILE_END UINT64_MAX

/* What a picture is of; two runs of equal heads make the same bytes. */
struct tilefile_head {
    char version[32];
    uint64_t scene;
    char settings[320];
    uint32_t width, height; /* of the crop */
    enum picture_depth depth;
    enum picture_encoding encoding;
    uint32_t part, parts; /* from 1; 0: a journal */
};

/* Whether the bytes start as such a file does. */
bool tilefile_recognised(const char *bytes, size_t n);

/* The bits a channel of its pixels. */
int tilefile_bits(const struct tilefile_head *h);

/* NULL when both are of one picture; else what differs, as in "it is of another scene". */
const char *tilefile_other(const struct tilefile_head *a, const struct tilefile_head *b,
                           struct buffer *room);

/* The same for the file of the picture: the program, the scene, the settings; nothing of the time
 * or the machine. */
enum { TILEFILE_TEXTS = 3 };
struct tilefile_texts {
    struct picture_text at[TILEFILE_TEXTS]; /* into this and the head */
    char software[40], scene[24];
};
void tilefile_tell(const struct tilefile_head *h, struct tilefile_texts *out);

struct tiling tilefile_tiling(const struct tilefile_head *h);

/* ---- writing ---- */

/* Returns the head's check. */
uint64_t tilefile_put_head(struct buffer *out, const struct tilefile_head *h);
void tilefile_put_tiles(struct buffer *out, uint64_t check, const struct tiling *tiling,
                        const struct picture *p, size_t first, size_t n);
void tilefile_put_end(struct buffer *out, uint64_t check, size_t tiles);

/* Takes the tiles of one record, without its check, into the picture; false when they are none. */
bool tilefile_take_tiles(const struct tiling *tiling, const char *record, size_t bytes,
                         struct picture *p, size_t *first, size_t *n);

/* ---- reading ---- */

enum tilefile_found { TILEFILE_TILES, TILEFILE_LAST, TILEFILE_DAMAGED };

struct tilefile {
    FILE *file;
    struct tilefile_head head;
    uint64_t check;
    struct tiling tiling;
    uint64_t good; /* bytes of the file that are whole */
    bool failed;   /* the system could not read it, whatever is in it */
    struct buffer record;
};

/* NULL, or a reason; *torn says that the file ends within its head, so that nothing is in it. */
const char *tilefile_open(struct tilefile *t, const char *path, bool *torn);
/* The next record; its tiles go into the picture, which is of the head's size and depth. */
enum tilefile_found tilefile_next(struct tilefile *t, struct picture *p, size_t *first, size_t *n);
void tilefile_close(struct tilefile *t);

#endif
