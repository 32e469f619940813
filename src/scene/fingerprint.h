/* What a scene is made of, in one number. */
#ifndef WRT_SCENE_FINGERPRINT_H
#define WRT_SCENE_FINGERPRINT_H

#include "scene/scene.h"

/* Two scenes of one fingerprint make the same picture, whatever their texts and files are called;
 * two that differ in anything a picture can depend on have different ones. */
uint64_t scene_fingerprint(const struct scene *s);

/* The same of shapes alone. */
uint64_t geometry_fingerprint(const struct geometry *g);

#endif
