#include "config.h"

#include "cmd/commands.h"

#include "lint/explain.h"

#include <stdio.h>

/* A name that stands for one diagnostic; groups stand for many. */
static int explain(const char *name, struct buffer *out)
{
    struct diag_selection found;
    if (!diag_select(str_of(name), &found)) {
        struct str meant = diag_nearest_name(str_of(name));
        if (meant.n)
            return usage_error("no diagnostic is called '%s'; did you mean '%.*s'?", name,
                               STR_ARG(meant));
        return usage_error("no diagnostic is called '%s'; 'wrt lint --list' names them", name);
    }
    for (int i = 0; i < DIAG_CODES; i++) {
        if (!found.has[i])
            continue;
        buffer_puts(out, out->n ? "\n" : "");
        explain_code((enum diag_code)i, out);
    }
    return 0;
}

int command_explain(const struct options *o)
{
    struct buffer out = {0};
    int status = 0;
    if (o->manual)
        explain_manual(&out);
    else if (!o->scenes.n)
        return usage_error("explain: no code given; 'wrt lint --list' names them");
    for (size_t i = 0; i < o->scenes.n && !status; i++)
        status = explain(o->scenes.at[i], &out);
    if (out.n)
        fwrite(out.at, 1, out.n, stdout);
    buffer_free(&out);
    return status;
}
