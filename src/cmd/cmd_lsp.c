#include "config.h"

#include "cmd/commands.h"

#include "lsp/lsp.h"

#include <signal.h>
#include <unistd.h>

int command_lsp(const struct options *o)
{
    struct diag_policy policy = o->policy;
    struct buffer problem = {0};
    if (o->scenes.n)
        return usage_error("lsp takes no scene: editors send them");
    policy.lint = true;
    struct lsp_options options = {
        .policy = &policy,
        .folders = o->folders.at,
        .folder_count = o->folders.n,
        .max_objects = o->max_objects,
        .fence = o->fence,
    };
    signal(SIGPIPE, SIG_IGN); /* writing says so as well */
    int status = lsp_serve(STDIN_FILENO, STDOUT_FILENO, &options, &problem);
    if (problem.n)
        fprintf(stderr, "wrt: error: %.*s\n", (int)problem.n, problem.at);
    buffer_free(&problem);
    return status;
}
