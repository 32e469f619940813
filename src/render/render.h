/* Scene to picture. */
#ifndef WRT_RENDER_RENDER_H
#define WRT_RENDER_RENDER_H

#include "accel/bvh.h"
#include "image/picture.h"
#include "scene/scene.h"

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>

enum render_show { SHOW_PICTURE, SHOW_NORMALS, SHOW_DEPTH, SHOW_IDS, SHOW_SAMPLES };

/* Called now and then from one thread with the share of the work done, in [0, 1]. */
struct render_progress {
    void (*report)(void *context, double done);
    void *context;
};

/* Who hears of tiles and may end the work; each pointer may be NULL. */
struct render_watch {
    /* The tile's pixels are in the picture: called from any thread, once for each. */
    void (*finished)(void *context, size_t tile);
    void *context;
    const volatile sig_atomic_t *stop; /* once it is not 0, only tiles under way are ended */
    size_t tiles;                      /* that will be asked for in all; 0: the whole crop's */
};

struct accel_store;

struct render_options {
    uint32_t width, height; /* of the whole picture */
    bool whole_view; /* it shows what the scene's own resolution does, whatever its proportions */
    struct {
        uint32_t x0, y0, x1, y1;
    } crop;          /* pixels, top left origin, x1 and y1 outside */
    uint32_t grid;   /* grid x grid samples a pixel, >= 1; adaptive: cells, a power of two */
    double adaptive; /* samples go on until the standard error is below it; 0: they do not */
    double deadline; /* adaptive: of thread_seconds(), by then the picture is there; 0: none */
    bool jitter;
    uint64_t seed;
    uint32_t depth;   /* rays deeper than this are black; the original's 3 */
    unsigned threads; /* >= 1 */
    enum render_show show;
    bool brute_force; /* no BVH: every primitive is tested against every ray */
    uint32_t no_skip; /* bit k: skip k is off; all bits: whatever can be done without: same bytes */
    enum isa isa;     /* an available one: same bytes */
    bool prune;       /* rays that can change no channel by 1/512 are left out: other bytes */
    struct render_progress progress; /* report may be NULL */
    struct render_watch watch;
    struct accel_store *store; /* keeps the tree for the next scene; or NULL */
};

/* What is left out; see skips.def. */
enum skip {
#define SKIP(id, name, what) SKIP_##id,
#include "render/skips.def"
#undef SKIP
    SKIPS,
    SHADOW_SKIPS = SKIP_BEHIND + 1 /* of them, the first */
};

struct skip_row {
    const char *name, *what;
};
extern const struct skip_row skip_rows[SKIPS];

#define NO_SKIP_ALL UINT32_MAX

struct adaptive_stats {
    double error, worst; /* estimated standard errors of the pixels: root mean square, largest */
    uint32_t most;       /* samples of one pixel */
    uint64_t unfinished; /* pixels whose error is not known, for lack of time */
};

struct render_stats {
    double build_s, render_s;
    uint64_t primary, shadow, reflection, refraction; /* rays traced */
    uint64_t skipped[SKIPS];
    uint64_t pruned; /* rays */
    struct accel_efforts tree;
    struct adaptive_stats adaptive;
};

static inline uint64_t shadow_rays_skipped(const struct render_stats *s)
{
    uint64_t sum = 0;
    for (int i = 0; i < SHADOW_SKIPS; i++)
        sum += s->skipped[i];
    return sum;
}

/* How bytes of the picture hold what is shown: light by the model, anything else as it is. */
enum picture_encoding render_encoding(const struct scene *scene, enum render_show show);

/* Renders the crop of the picture into `out` (made by picture_new with the crop's size).  The bytes
 * do not depend on threads, crop, brute_force or no_skip; with a deadline they do. */
void render_scene(const struct scene *scene, const struct render_options *options,
                  struct picture *out, struct render_stats *stats);

/* The same a part at a time.  Tiles are those of tiling_of() the crop; each may be asked for once,
 * in any order.  With a deadline only all of them can be, which is what `tiles` NULL means. */
struct rendering;
struct rendering *rendering_begin(const struct scene *scene, const struct render_options *options,
                                  struct picture *out);
void rendering_tiles(struct rendering *r, const size_t *tiles, size_t n);
/* Frees it. */
void rendering_end(struct rendering *r, struct render_stats *stats);

static inline bool render_stopped(const struct render_options *o)
{
    return o->watch.stop && *o->watch.stop;
}

static inline void render_tell_finished(const struct render_options *o, size_t tile)
{
    if (o->watch.finished)
        o->watch.finished(o->watch.context, tile);
}

#endif
