/* wrt merge: the parts of a picture, in any order. */
#include "config.h"

#include "cmd/commands.h"
#include "cmd/frontend.h"
#include "cmd/render_run.h"

#include "base/file.h"
#include "farm/parts.h"

#include <stdlib.h>
#include <string.h>

struct merge {
    const struct options *options;
    struct frontend frontend;  /* for its diagnostics */
    struct tilefile_head head; /* of the first part */
    struct tiling tiling;
    struct picture *picture;
    bool *have; /* by tile */
};

static void report(struct merge *m, const char *path, const char *reason)
{
    diag_report(&m->frontend.diag, DIAG_OTHER_TILES, (struct span){0}, "cannot use '%s': %s", path,
                reason);
}

/* The picture that the first part is of is that which all must be of. */
static void begin(struct merge *m, const struct tilefile_head *head)
{
    m->head = *head;
    m->tiling = tilefile_tiling(head);
    m->picture = picture_new(head->width, head->height, head->depth);
    m->picture->encoding = head->encoding;
    m->have = mem_zalloc(m->tiling.n, sizeof *m->have);
}

/* Takes the tiles of a file; false when it is not whole. */
static bool take_tiles(struct merge *m, struct tilefile *t)
{
    enum tilefile_found found;
    size_t first, n, tiles = 0;
    while ((found = tilefile_next(t, m->picture, &first, &n)) == TILEFILE_TILES) {
        for (size_t i = first; i < first + n; i++)
            m->have[i] = true;
        tiles += n;
    }
    bool journal = t->head.parts == 0; /* whose end may be torn */
    return journal || (found == TILEFILE_LAST && n == tiles);
}

static void take_part(struct merge *m, const char *path)
{
    struct tilefile t;
    struct buffer room = {0};
    bool torn;
    const char *reason;
    if (!file_readable(NULL, path, &reason)) {
        diag_report(&m->frontend.diag, DIAG_CANNOT_READ, (struct span){0},
                    "could not read '%s': %s", path, reason);
        return;
    }
    reason = tilefile_open(&t, path, &torn);
    if (reason) {
        diag_report(&m->frontend.diag, t.failed ? DIAG_CANNOT_READ : DIAG_OTHER_TILES,
                    (struct span){0}, "cannot use '%s': %s", path, reason);
        return;
    }
    if (!m->picture)
        begin(m, &t.head);
    reason = tilefile_other(&t.head, &m->head, &room);
    if (!reason && !take_tiles(m, &t)) {
        buffer_printf(&room, "it is damaged or ends early, behind byte %llu%c",
                      (unsigned long long)t.good, 0);
        reason = room.at;
    }
    if (reason)
        report(m, path, reason);
    tilefile_close(&t);
    buffer_free(&room);
}

/* Names the parts that are missing; those of a journal have no numbers. */
static void report_missing(struct merge *m)
{
    enum { NAMED = 10 };
    uint32_t parts = m->head.parts ? m->head.parts : 1;
    size_t missing = 0, missing_tiles = 0;
    struct buffer names = {0};
    bool *lacks = mem_zalloc(parts + 1, sizeof *lacks);
    for (size_t i = 0; i < m->tiling.n; i++) {
        lacks[part_of_tile(&m->tiling, parts, i)] |= !m->have[i];
        missing_tiles += !m->have[i];
    }
    for (uint32_t i = 1; i <= parts; i++)
        if (lacks[i] && ++missing <= NAMED)
            buffer_printf(&names, "%s%u", missing > 1 ? ", " : "", i);
    if (missing > NAMED)
        buffer_printf(&names, " and %zu more", missing - NAMED);
    if (missing > 0 && m->head.parts > 0)
        diag_report(&m->frontend.diag, DIAG_OTHER_TILES, (struct span){0},
                    "of %u parts, %.*s %s missing; no picture was written", parts, (int)names.n,
                    names.at, missing > 1 ? "are" : "is");
    else if (missing > 0)
        diag_report(&m->frontend.diag, DIAG_OTHER_TILES, (struct span){0},
                    "of %zu tiles, %zu are missing; no picture was written", m->tiling.n,
                    missing_tiles);
    buffer_free(&names);
    free(lacks);
}

/* Whether the format holds what the parts do; 0 or an exit status. */
static int check_bits(const struct merge *m, enum picture_format format)
{
    static const struct {
        const char *wanted;
        int bits[2];
    } formats[] = {
        [PICTURE_PNG] = {"8 or 16", {8, 16}},
        [PICTURE_PPM] = {"8", {8, 8}},
        [PICTURE_PFM] = {"32", {32, 32}},
        [PICTURE_EXR] = {"32", {32, 32}},
    };
    int bits = tilefile_bits(&m->head);
    if (bits == formats[format].bits[0] || bits == formats[format].bits[1])
        return 0;
    return usage_error("merge: '%s' takes %s bits a channel, and the parts have %d: 'wrt render "
                       "--part' makes them as --bits says",
                       m->options->output, formats[format].wanted, bits);
}

static void write_picture(struct merge *m, enum picture_format format)
{
    size_t n;
    char why[IMAGE_REASON_BYTES];
    struct tilefile_texts texts;
    tilefile_tell(&m->head, &texts);
    m->picture->texts = texts.at;
    m->picture->text_count = TILEFILE_TEXTS;
    m->picture->halves = m->options->bits == 16;
    void *bytes = picture_encode(m->picture, format, &n, why);
    const char *reason = bytes ? file_write(m->options->output, bytes, n) : why;
    free(bytes);
    if (reason)
        diag_report(&m->frontend.diag, DIAG_CANNOT_WRITE, (struct span){0},
                    "could not write '%s': %s", m->options->output, reason);
}

int command_merge(const struct options *o)
{
    enum picture_format format;
    if (o->scenes.n == 0)
        return usage_error("merge: no parts given");
    if (!o->output)
        return usage_error("merge: -o names the picture, and is not given");
    if (!picture_format_of(o->output, &format))
        return usage_error("'%s' names no picture format; " PICTURE_SUFFIXES " are written",
                           o->output);
    if (!picture_format_built(format))
        return usage_error("'%s': this wrt was built without OpenEXR", o->output);
    if (o->bits && !(format == PICTURE_EXR && o->bits != 8))
        return usage_error("merge: --bits is 16 or 32, for OpenEXR; else the parts have them");
    if (options_overwritten(o))
        return usage_error("merge: '%s' is a part; it would be lost under the picture",
                           options_overwritten(o));
    struct merge m = {.options = o};
    frontend_init(&m.frontend, o);
    for (size_t i = 0; i < o->scenes.n; i++)
        take_part(&m, o->scenes.at[i]);
    if (m.picture && m.frontend.diag.exit != DIAG_EXIT_RESOURCE) /* it would follow */
        report_missing(&m);
    int status = m.frontend.diag.errors == 0 ? check_bits(&m, format) : 0;
    if (m.frontend.diag.errors == 0 && status == 0)
        write_picture(&m, format);
    status = status_worse(status, frontend_report(&m.frontend, o, DIAG_WARNING));
    picture_free(m.picture);
    free(m.have);
    frontend_free(&m.frontend);
    return status;
}
