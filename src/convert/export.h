/* The lowered scene in the formats of other programs. */
#ifndef WRT_CONVERT_EXPORT_H
#define WRT_CONVERT_EXPORT_H

#include "base/buffer.h"
#include "diag/diag.h"
#include "scene/scene.h"

/* Each appends the whole file to *out, for a file at `path`, from where textures are named.  What
 * the format cannot say becomes a note (DIAG_LEFT_OUT)
 * at the first place that asks for it. */

/* Everything, in the layout that wrt(1) documents. */
void export_json(const struct scene *scene, const char *path, struct buffer *out,
                 struct diag *diag);

/* A scene for POV-Ray 3.7. */
void export_pov(const struct scene *scene, const char *path, struct buffer *out, struct diag *diag);

/* A scene for Tachyon 0.99. */
void export_tachyon(const struct scene *scene, const char *path, struct buffer *out,
                    struct diag *diag);

#endif
