/* The scene as a whole. */
#include "config.h"

#include "lint/checks.h"

/* Where what the whole scene lacks is told: its first statement, which a comment at the head of the
 * file speaks of. */
static struct span start_of(const struct lint *l)
{
    return l->ast->statements ? l->ast->statements->name_span : l->desc->start;
}

void lint_emptiness(const struct lint *l)
{
    const struct desc *d = l->desc;
    if (desc_is_part(d, l->ast))
        return;
    if (!d->surfaces.n)
        diag_report(l->diag, DIAG_NO_SURFACE, start_of(l),
                    "the scene has no surface, so there is nothing to see");
    else if (!d->lights.n)
        diag_report(l->diag, DIAG_NO_LIGHT, start_of(l),
                    "the scene has no light; only what is emissive or ambient shows");
}
