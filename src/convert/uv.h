/* UV lists from VRML 2.0 files. */
#ifndef WRT_CONVERT_UV_H
#define WRT_CONVERT_UV_H

#include "base/buffer.h"
#include "diag/diag.h"

/* Appends the UV list of the VRML 2.0 file to *out: for every IndexedFaceSet in the order of the
 * file (USE repeats what DEF names), for every face as the fan of triangles that a mesh file's face
 * is split into, a line `u v` for each corner, spelt as in the file.  Errors go to diag at their
 * place (the source is in its srcmap); true when there were none. */
bool uv_list_from_vrml(const struct source *source, struct buffer *out, struct diag *diag);

#endif
