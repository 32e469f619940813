#include "config.h"

#include "cmd/commands.h"
#include "cmd/needed.h"
#include "cmd/stats.h"

#include <string.h>

static int check_scene(const char *path, const struct options *o)
{
    struct frontend f;
    if (frontend_load(&f, path, o))
        needed_check(&f);
    int status = frontend_report(&f, o, o->verbose ? DIAG_NOTE : DIAG_ERROR);
    struct check_stats stats = {
        .scene = path,
        .parse_s = f.seconds,
        .surfaces = f.desc.surfaces.n,
        .lights = f.desc.lights.n,
        .materials = f.desc.materials.n,
        .textures = f.desc.textures.n,
        .errors = f.diag.errors,
        .warnings = f.diag.warnings,
    };
    stats_print_check(&stats, o);
    frontend_free(&f);
    return status;
}

int command_check(const struct options *o)
{
    int status = o->scenes.n ? 0 : usage_error("check: no scene given");
    struct options checking = *o;
    for (size_t i = 0; i < o->scenes.n; i++) {
        checking.current = i;
        status = status_worse(status, check_scene(o->scenes.at[i], &checking));
    }
    return status;
}
