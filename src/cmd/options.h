/* The command line. */
#ifndef WRT_CMD_OPTIONS_H
#define WRT_CMD_OPTIONS_H

#include "base/fence.h"
#include "base/vec.h"
#include "diag/diag.h"
#include "image/measures.h"
#include "render/render.h"

#include <stdbool.h>
#include <stdint.h>

/* The commands, as bits of the options they take. */
enum {
    FOR_RENDER = 1,
    FOR_CHECK = 2,
    FOR_UV = 4,
    FOR_DOC = 8,
    FOR_FMT = 16,
    FOR_DIFF = 32,
    FOR_CONVERT = 64,
    FOR_INFO = 128,
    FOR_LINT = 256,
    FOR_EXPLAIN = 512,
    FOR_LSP = 1024,
    FOR_MERGE = 2048,
    FOR_ALL = 4095
};

/* Those that read a scene, and those that report on what they read. */
enum {
    FOR_SCENES = FOR_RENDER | FOR_CHECK | FOR_LINT | FOR_DIFF | FOR_CONVERT | FOR_INFO,
    FOR_INPUT = FOR_SCENES | FOR_UV | FOR_FMT
};

enum fix_mode { FIX_NOTHING, FIX_SAFE, FIX_ALL };
enum stats_format { STATS_NONE, STATS_TEXT, STATS_JSON };

struct options {
    VEC(const char *) scenes;  /* or whatever else the command takes */
    size_t current;            /* the one under way, for commands that take several */
    VEC(const char *) defines; /* NAME=VALUE */
    size_t optional_defines;   /* of these the last, which the scene need not have */
    VEC(const char *) folders; /* of includes */
    const char *output;        /* or NULL */
    const char *to;            /* the format of the output, or NULL */
    uint32_t width, height;    /* 0: the scene's */
    bool cropped;
    uint32_t crop[4];
    uint32_t grid;          /* 0: the scene's */
    double adaptive;        /* 0: off */
    double time;            /* seconds; 0: no limit */
    uint32_t bits;          /* a channel; 0: as the format usually has */
    double exposure;        /* stops */
    const char *checkpoint; /* or NULL */
    bool resume;
    uint32_t part, parts; /* from 1; 0: the whole picture */
    bool mpi;
    bool animated;
    uint32_t frames[2]; /* first and last */
    uint32_t fps;       /* 0: as usual */
    uint32_t depth;     /* or DEPTH_OF_SCENE */
    uint32_t threads;
    bool own_threads; /* not given: as many as there are processors */
    uint64_t seed;
    bool seeded; /* given */
    size_t max_objects;
    uint64_t max_memory; /* bytes; 0: no limit */
    uint32_t max_pixels, max_depth;
    uint64_t max_rays;              /* for a pixel */
    const char *restricted;         /* the folder that files are read from, or NULL */
    const struct file_fence *fence; /* around it, or NULL */
    enum render_show show;
    enum isa isa;
    enum stats_format stats;
    enum diag_format format;
    size_t *printed;           /* results of a SARIF log so far */
    struct diag_policy policy; /* of warnings */
    enum fix_mode fix;
    bool list;
    bool expand, rebase, no_verify;
    bool in_place, check, difference;
    bool jitter, brute_force, prune, quiet, verbose;
    uint32_t no_skip; /* bit k: skip k is off */
    bool manual, json, deps, behind;
    uint32_t pixel[2];
    bool limited;
    double limits[MEASURES]; /* not a number: none */
};

/* The exit status of wrong usage. */
enum { EXIT_USAGE = 2 };

#define DEPTH_OF_SCENE UINT32_MAX

/* What the command line asks for. */
enum options_result { OPTIONS_RUN, OPTIONS_HELP, OPTIONS_VERSION, OPTIONS_WRONG };

/* Reads the arguments for a command (FOR_...).  OPTIONS_WRONG after saying why on stderr. */
enum options_result options_read(int argc, char **argv, unsigned command, struct options *out);
void options_free(struct options *o);

/* The first argument that is no option or an option's argument; argc: none. */
int options_first_operand(int argc, char **argv);

/* The lines of help for the options that all of these commands take. */
void options_help(unsigned commands, FILE *out);

/* The first of the operands that the output is, so that it would be lost; or NULL. */
const char *options_overwritten(const struct options *o);

/* "wrt: error: ..." on stderr; returns EXIT_USAGE. */
int usage_error(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
