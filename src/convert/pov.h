/* A POV-Ray scene under construction (internal to src/convert). */
#ifndef WRT_CONVERT_POV_H
#define WRT_CONVERT_POV_H

#include "convert/exporting.h"

/* <1,2,3> */
void pov_add_vector(struct buffer *out, struct vec3 v);
/* The name and the number, with a blank before each. */
void pov_add_field(struct buffer *out, const char *name, double x);

/* Equal materials, of which XML makes many, are declared once. */
void pov_declare_materials(struct exporting *e);
/* The material of a shape of the surface: a declared one, or where the shape matters its own. */
void pov_add_material_use(struct exporting *e, const struct surface *s, uint32_t prim);

#endif
