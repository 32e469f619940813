#include "config.h"

#include "schema/index.h"

#include <assert.h>

static void add_names(struct schema_index *x, uint16_t *n, enum schema_prop_id id, bool xml)
{
    unsigned leaves = xml ? schema_leaf_count(id) : 1;
    for (unsigned leaf = 0; leaf < leaves; leaf++, ++*n) {
        assert(*n < SCHEMA_INDEX_NAMES);
        x->names[*n].name = xml ? schema_leaf(id, leaf) : schema_prop_name(id, false);
        x->names[*n].id = (uint8_t)id;
        x->names[*n].leaf = (uint8_t)leaf;
    }
}

void schema_index_build(struct schema_index *x, bool xml)
{
    uint16_t n = 0;
    for (int k = 0; k < SCHEMA_KINDS; k++) {
        x->first[k] = n;
        for (int p = 0; p < SCHEMA_PROPS; p++)
            if (schema_has((enum schema_kind)k, (enum schema_prop_id)p))
                add_names(x, &n, (enum schema_prop_id)p, xml);
    }
    x->first[SCHEMA_KINDS] = n;
}

enum schema_prop_id schema_index_find(const struct schema_index *x, enum schema_kind kind,
                                      struct str name, unsigned *leaf)
{
    for (uint16_t i = x->first[kind]; i < x->first[kind + 1]; i++) {
        if (!str_equal(x->names[i].name, name))
            continue;
        *leaf = x->names[i].leaf;
        return (enum schema_prop_id)x->names[i].id;
    }
    return SCHEMA_PROPS;
}
