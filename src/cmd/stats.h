/* --stats, for people and as JSON. */
#ifndef WRT_CMD_STATS_H
#define WRT_CMD_STATS_H

#include "cmd/options.h"
#include "farm/cluster.h"
#include "lower/lower.h"
#include "render/render.h"

/* The most memory this process has had so far, in bytes. */
uint64_t stats_peak_rss(void);

struct run_stats {
    double parse_s, load_s, write_s, total_s;
    uint32_t width, height;
    uint32_t grid;   /* samples along each side of a pixel */
    uint64_t pixels; /* of the tiles that were rendered */
    struct render_stats render;
    bool late; /* --time ended the work */
    int ranks; /* 0: there is no cluster */
    struct cluster_stats cluster;
    const char *file; /* of the frame; NULL: the picture is none */
    uint32_t frame;
    bool kept;                  /* it was there, and nothing was done */
    bool resumed;               /* --resume */
    size_t tiles, from_journal; /* of the picture or part, and that the journal had */
};

void stats_print_render(const struct run_stats *s, const struct options *o,
                        const struct scene *scene);

struct check_stats {
    const char *scene;
    double parse_s;
    size_t surfaces, lights, materials, textures, errors, warnings;
};
void stats_print_check(const struct check_stats *s, const struct options *o);

#endif
