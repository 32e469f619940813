/* Names of properties by kind, for whoever looks up many. */
#ifndef WRT_SCHEMA_INDEX_H
#define WRT_SCHEMA_INDEX_H

#include "schema/schema.h"

enum { SCHEMA_INDEX_NAMES = 512 };

/* The names of one spelling, native or XML's, kind after kind. */
struct schema_index {
    struct {
        struct str name;
        uint8_t id, leaf;
    } names[SCHEMA_INDEX_NAMES];
    uint16_t first[SCHEMA_KINDS + 1]; /* of each kind, and the end */
};

void schema_index_build(struct schema_index *index, bool xml);

/* As schema_find_prop. */
enum schema_prop_id schema_index_find(const struct schema_index *index, enum schema_kind kind,
                                      struct str name, unsigned *leaf);

#endif
