#include "config.h"

#include "cmd/info.h"

/* Nodes are known by where they stand in the tree and in the text. */
struct key {
    const struct info_node *parent;
    uint32_t begin, kind;
};

enum { KIND_OF_SURFACES = UINT8_MAX }; /* apart from all kinds of frames */

struct builder {
    struct arena *arena;
    struct map nodes;
};

static struct info_node *node_at(struct builder *b, struct info_node *parent, struct span span,
                                 uint32_t kind)
{
    struct key key = {parent, span.begin, kind};
    struct str name = {(const char *)&key, sizeof key};
    struct info_node *n = map_get(&b->nodes, name);
    if (n)
        return n;
    n = arena_zalloc(b->arena, 1, sizeof *n);
    n->span = span;
    *(parent->last ? &parent->last->next : &parent->children) = n;
    parent->last = n;
    map_set(&b->nodes, (struct str){arena_copy(b->arena, name.at, name.n), name.n}, n);
    return n;
}

enum { DEPTH_MOST = 1024 }; /* of frames: loops, uses and files nest less deeply */

/* The node of what made a surface. */
static struct info_node *maker_of(struct builder *b, struct info_node *root,
                                  const struct diag_frame *innermost)
{
    const struct diag_frame *frames[DEPTH_MOST];
    size_t n = 0;
    for (const struct diag_frame *f = innermost; f && n < DEPTH_MOST; f = f->parent)
        if (f->kind != DIAG_FRAME_CALL)
            frames[n++] = f;
    struct info_node *node = root;
    for (; n > 0; n--) {
        node = node_at(b, node, frames[n - 1]->at, frames[n - 1]->kind);
        node->frame = frames[n - 1];
        node->count++;
    }
    return node;
}

struct info_node *info_tree(const struct desc *d, struct arena *a)
{
    struct builder b = {.arena = a};
    struct info_node *root = arena_zalloc(a, 1, sizeof *root);
    for (size_t i = 0; i < d->surfaces.n; i++) {
        const struct desc_object *o = d->surfaces.at[i];
        struct info_node *n = node_at(&b, maker_of(&b, root, o->frame), o->span, KIND_OF_SURFACES);
        root->count++;
        if (!n->count++)
            n->object = o;
    }
    map_free(&b.nodes);
    return root;
}
