/* Scene files as sources. */
#include "config.h"

#include "syntax/syntax.h"

#include "base/file.h"

const struct source *syntax_take(struct srcmap *sources, const char *path, char *text, size_t n,
                                 enum diag_code code, struct span span, struct diag *diag)
{
    const char *name = strcmp(path, "-") == 0 ? "<stdin>" : path;
    struct encoding_problem problem;
    bool marked, right = syntax_decode(&text, &n, &marked, &problem);
    struct source *s = srcmap_add(sources, name, text, n);
    if (!s) {
        diag_report(diag, code, span, "'%s' is too large", name);
        return NULL;
    }
    s->marked = marked;
    if (right)
        return s;
    uint32_t at = s->base + (uint32_t)problem.offset;
    diag_report(diag, problem.code, (struct span){at, at + 1}, "%s", problem.message);
    return NULL;
}

const struct source *syntax_load(struct srcmap *sources, const char *path, enum diag_code code,
                                 struct span span, struct diag *diag)
{
    char *text;
    size_t n;
    const char *reason = file_read_within(sources->fence, path, &text, &n);
    if (!reason)
        return syntax_take(sources, path, text, n, code, span, diag);
    diag_report(diag, code, span, "could not read '%s': %s",
                strcmp(path, "-") == 0 ? "<stdin>" : path, reason);
    return NULL;
}
