/* What the VRML grammar, its scanner and its helpers share while one file is read (internal to
 * src/convert and grammar/wrl.*).
 *
 * No tree is made: of each open node only the lists that make UV pairs are kept, until it closes.
 */
#ifndef WRT_CONVERT_WRL_H
#define WRT_CONVERT_WRL_H

#include "base/arena.h"
#include "base/buffer.h"
#include "base/map.h"
#include "diag/diag.h"

/* Nodes may nest this deep. */
enum { WRL_NESTING_LIMIT = 256 };

/* The fields that matter. */
enum wrl_field {
    WRL_NO_FIELD,
    WRL_POINT,    /* of TextureCoordinate */
    WRL_TEXCOORD, /* of IndexedFaceSet, as are the following */
    WRL_TEXCOORD_INDEX,
    WRL_COORD_INDEX,
};

/* A TextureCoordinate: the places of its numbers, u and v in turn. */
struct wrl_points {
    VEC(struct span) numbers;
};

/* An item of coordIndex or texCoordIndex. */
enum { WRL_FACE_END = -1, WRL_WRONG_INDEX = -2 };
struct wrl_index {
    int32_t value; /* WRL_WRONG_INDEX: reported already */
    uint32_t at;   /* offset of its spelling */
};
struct wrl_indexes {
    VEC(struct wrl_index) list;
};

struct wrl_node {
    struct span name; /* of its type */
    bool face_set, texture_coordinate;
    enum wrl_field field;      /* the one under way */
    struct wrl_points *points; /* its own, or its texCoord's; NULL: none */
    struct wrl_indexes coord_index, texcoord_index;
};

/* What a DEF names: a stretch of the output, and the points if it is a TextureCoordinate. */
struct wrl_definition {
    size_t begin, end;
    struct wrl_points *points;
};

struct wrl {
    const struct source *source;
    struct diag *diag;
    void *scanner; /* flex's yyscan_t */
    uint32_t at;   /* offset of the next unread byte */
    bool stopped;  /* a limit was hit: the end is feigned */
    struct {
        int token;
        struct span span;
    } last[3]; /* the tokens read last, the newest first */

    struct arena arena;              /* of definitions */
    struct map definitions;          /* by name */
    VEC(struct wrl_points *) points; /* all of the file; owned */
    struct wrl_node nodes[WRL_NESTING_LIMIT];
    size_t depth;                   /* nodes that are open */
    struct wrl_points *closed;      /* points of the node that closed last */
    bool declaring;                 /* the value of a Script's field */
    size_t prototypes;              /* PROTO that are open */
    struct span first_in_prototype; /* the first face set of the outermost */

    struct buffer *out;
    size_t face_sets;      /* found so far */
    VEC(struct span) bare; /* those without a texCoord */
};

/* ---- wrl.c: for the scanner and the grammar ---- */

struct span wrl_token(struct wrl *w, size_t length);
void wrl_stray(struct wrl *w, struct span span);
void wrl_unterminated(struct wrl *w, struct span span);
void wrl_stop(struct wrl *w, enum diag_code code, struct span span, const char *message);
void wrl_syntax_error(struct wrl *w, struct span span, bool at_end, const char *const *expected,
                      size_t n);

void wrl_open_node(struct wrl *w, struct span type);
void wrl_close_node(struct wrl *w);
void wrl_begin_field(struct wrl *w, struct span name);
/* Around the value of a field that a Script or PROTO declares: a USE there is no copy. */
void wrl_declare(struct wrl *w, bool begin);
void wrl_add_number(struct wrl *w, struct span number);

/* The length of the output, where what a DEF names begins. */
size_t wrl_mark(const struct wrl *w);
void wrl_define(struct wrl *w, struct span name, size_t begin);
void wrl_use(struct wrl *w, struct span name);

void wrl_open_prototype(struct wrl *w);
void wrl_close_prototype(struct wrl *w, struct span name);

/* Appends to the list; false when it becomes too large by what is said at `span`. */
bool wrl_write(struct wrl *w, struct span span, struct str text);

/* ---- faces.c ---- */

/* The pairs of a face set that closes. */
void wrl_add_faces(struct wrl *w, const struct wrl_node *set);

#endif
