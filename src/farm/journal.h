/* A file that tells the finished tiles of a picture under way, so that the work can go on after it
 * ended early, however it did (tilefile.h has the layout).
 *
 * Tiles are appended some at a time, by whichever thread finds that it is time: what is saved is
 * safe on the disk, and saving takes at most a fixed share of that thread's time. */
#ifndef WRT_FARM_JOURNAL_H
#define WRT_FARM_JOURNAL_H

#include "farm/tilefile.h"

struct journal;

enum journal_opened {
    JOURNAL_OPEN,
    JOURNAL_EXISTS,   /* there is one, and going on with it was not asked for */
    JOURNAL_TAKEN,    /* there is a file that is no journal */
    JOURNAL_UNUSABLE, /* it is another picture's, or no journal */
    JOURNAL_FAILED,   /* the system says no */
};

/* Creates the file; with `resume` goes on with one that is there: its tiles come into the picture.
 * A damaged or torn end is cut off.  Borrows the picture.  But for JOURNAL_OPEN, `why` tells the
 * reason. */
enum journal_opened journal_open(const char *path, bool resume, const struct tilefile_head *head,
                                 struct picture *p, struct journal **out, struct buffer *why);

/* Whether a tile is in the file, and how many are. */
bool journal_has(const struct journal *j, size_t tile);
size_t journal_tiles(const struct journal *j);

/* For struct render_watch: context is the journal. */
void journal_finished(void *journal, size_t tile);

/* Saves what is not saved yet and frees the journal; the file goes when it is of no use any more.
 * Returns NULL, or why something could not be saved. */
const char *journal_close(struct journal *j, bool remove_file);

#endif
