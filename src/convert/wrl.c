/* A VRML 2.0 file through its scanner and grammar: nodes, names and mistakes. */
#include "config.h"

#include "convert/wrl.h"

#include "base/num.h"
#include "convert/uv.h"

#include "grammar/wrl.tab.h"

#include "grammar/wrl.lex.h"

#include <math.h>

/* USE can double the list again and again. */
enum { LIST_LIMIT = 1 << 29 }; /* bytes */

static struct str text_of(const struct wrl *w, struct span span)
{
    return span_known(span) ? srcmap_text(w->diag->sources, span) : (struct str){0};
}

/* ---- tokens ---------------------------------------------------------------------------------- */

struct span wrl_token(struct wrl *w, size_t length)
{
    struct span span = {w->at, w->at + (uint32_t)length};
    w->at = span.end;
    return span;
}

int vrml_lex(VRML_STYPE *value, struct span *span, struct wrl *w)
{
    (void)value; /* tokens are known by their place */
    *span = (struct span){w->at, w->at};
    int token = w->stopped ? WRL_END : wrl_scan(span, w->scanner);
    memmove(&w->last[1], &w->last[0], sizeof w->last - sizeof w->last[0]);
    w->last[0].token = token;
    w->last[0].span = *span;
    return w->stopped ? WRL_END : token;
}

/* ---- mistakes -------------------------------------------------------------------------------- */

void wrl_stop(struct wrl *w, enum diag_code code, struct span span, const char *message)
{
    if (!w->stopped)
        diag_report(w->diag, code, span, "%s", message);
    w->stopped = true;
}

void wrl_stray(struct wrl *w, struct span span)
{
    wrl_stop(w, DIAG_MESH_SYNTAX, span, "this character cannot stand here");
}

void wrl_unterminated(struct wrl *w, struct span span)
{
    wrl_stop(w, DIAG_UNTERMINATED, (struct span){span.begin, span.begin + 1},
             "this string never ends");
}

/* A name among the numbers of a list was taken for a node, and is missed its `{` only now. */
static bool report_name_in_list(struct wrl *w)
{
    int now = w->last[0].token, before = w->last[2].token;
    bool among = before == WRL_NUMBER || before == WRL_LBRACKET;
    bool number = now == WRL_NUMBER || now == WRL_RBRACKET;
    struct span span = w->last[1].span;
    struct str name = text_of(w, span);
    int n = (int)(name.n < 40 ? name.n : 40);
    if (w->last[1].token != WRL_NAME || !among)
        return false;
    if (number)
        diag_report(w->diag, DIAG_MESH_SYNTAX, span, "'%.*s' is not a number", n, name.at);
    else
        diag_report(w->diag, DIAG_MESH_SYNTAX, span, "expected ']' before '%.*s'", n, name.at);
    return true;
}

void wrl_syntax_error(struct wrl *w, struct span span, bool at_end, const char *const *expected,
                      size_t n)
{
    struct str found = text_of(w, span);
    char words[128] = "", what[64] = "the end of the file";
    if (w->stopped)
        return;
    w->stopped = true;
    if (n == 1 && strcmp(expected[0], "'{'") == 0 && report_name_in_list(w))
        return;
    for (size_t i = 0; i < n; i++)
        snprintf(words + strlen(words), sizeof words - strlen(words), "%s%s",
                 i == 0      ? ""
                 : i + 1 < n ? ", "
                             : " or ",
                 expected[i]);
    if (!at_end)
        snprintf(what, sizeof what, "'%.*s'", (int)(found.n < 40 ? found.n : 40), found.at);
    if (n)
        diag_report(w->diag, DIAG_MESH_SYNTAX, span, "expected %s, but found %s", words, what);
    else if (at_end)
        diag_report(w->diag, DIAG_MESH_SYNTAX, span, "the file ends too early");
    else
        diag_report(w->diag, DIAG_MESH_SYNTAX, span, "%s cannot stand here", what);
}

/* ---- nodes ----------------------------------------------------------------------------------- */

static void node_free(struct wrl_node *n)
{
    vec_free(&n->coord_index.list);
    vec_free(&n->texcoord_index.list);
}

void wrl_open_node(struct wrl *w, struct span type)
{
    if (w->depth == WRL_NESTING_LIMIT) {
        wrl_stop(w, DIAG_TOO_DEEP, type, "nodes nested deeper than 256 levels");
        return;
    }
    struct wrl_node *n = &w->nodes[w->depth++];
    struct str name = text_of(w, type);
    *n = (struct wrl_node){.name = type,
                           .face_set = str_is(name, "IndexedFaceSet"),
                           .texture_coordinate = str_is(name, "TextureCoordinate")};
    if (n->texture_coordinate) {
        n->points = mem_zalloc(1, sizeof *n->points);
        vec_push(&w->points, n->points);
    }
}

/* The points that a node or USE stands for become its parent's where that asks for them. */
static void give_points(struct wrl *w, struct wrl_points *points)
{
    struct wrl_node *parent = w->depth ? &w->nodes[w->depth - 1] : NULL;
    if (parent && parent->field == WRL_TEXCOORD)
        parent->points = points;
    w->closed = points;
}

static void close_face_set(struct wrl *w, const struct wrl_node *n)
{
    if (!w->prototypes) {
        w->face_sets++;
        if (!n->points)
            vec_push(&w->bare, n->name);
        wrl_add_faces(w, n);
    } else if (!span_known(w->first_in_prototype)) {
        w->first_in_prototype = n->name;
    }
}

void wrl_close_node(struct wrl *w)
{
    struct wrl_node *n = &w->nodes[--w->depth];
    if (n->face_set)
        close_face_set(w, n);
    if (n->texture_coordinate && n->points->numbers.n % 2)
        diag_report(w->diag, DIAG_MESH_SYNTAX, n->points->numbers.at[n->points->numbers.n - 1],
                    "the second number of this pair is missing");
    give_points(w, n->texture_coordinate ? n->points : NULL);
    node_free(n);
}

/* ---- fields ---------------------------------------------------------------------------------- */

void wrl_begin_field(struct wrl *w, struct span name)
{
    static const struct {
        const char *name;
        enum wrl_field field;
    } of_face_set[] = {
        {"texCoord", WRL_TEXCOORD},
        {"texCoordIndex", WRL_TEXCOORD_INDEX},
        {"coordIndex", WRL_COORD_INDEX},
    };
    struct wrl_node *n = w->depth ? &w->nodes[w->depth - 1] : NULL;
    struct str text = text_of(w, name);
    if (!n)
        return;
    n->field = n->texture_coordinate && str_is(text, "point") ? WRL_POINT : WRL_NO_FIELD;
    for (size_t i = 0; n->face_set && i < sizeof of_face_set / sizeof *of_face_set; i++)
        if (str_is(text, of_face_set[i].name))
            n->field = of_face_set[i].field;
}

void wrl_declare(struct wrl *w, bool begin)
{
    w->declaring = begin;
    if (w->depth)
        w->nodes[w->depth - 1].field = WRL_NO_FIELD;
}

static void add_coordinate(struct wrl *w, struct wrl_points *points, struct span number)
{
    struct str text = text_of(w, number);
    double x;
    if (num_parse(text.at, text.at + text.n, &x) != text.at + text.n)
        diag_report(w->diag, DIAG_MESH_SYNTAX, number,
                    "a texture coordinate is a decimal number, not '%.*s'", STR_ARG(text));
    else if (!isfinite(x))
        diag_report(w->diag, DIAG_NOT_FINITE, number, "this texture coordinate is too large");
    vec_push(&points->numbers, number);
}

static void add_index(struct wrl *w, struct wrl_indexes *indexes, struct span number)
{
    struct str text = text_of(w, number);
    double x = 0;
    bool whole = num_parse(text.at, text.at + text.n, &x) == text.at + text.n && x == floor(x);
    bool right = whole && x >= WRL_FACE_END && x <= INT32_MAX;
    if (!right)
        diag_report(w->diag, whole ? DIAG_MESH_INDEX : DIAG_MESH_SYNTAX, number,
                    "an index is a whole number from 0 on, or -1 behind a face, not '%.*s'",
                    STR_ARG(text));
    int32_t value = right ? (int32_t)x : WRL_WRONG_INDEX;
    vec_push(&indexes->list, (struct wrl_index){value, number.begin});
}

void wrl_add_number(struct wrl *w, struct span number)
{
    struct wrl_node *n = w->depth && !w->prototypes ? &w->nodes[w->depth - 1] : NULL;
    if (n && n->field == WRL_POINT)
        add_coordinate(w, n->points, number);
    else if (n && n->field == WRL_TEXCOORD_INDEX)
        add_index(w, &n->texcoord_index, number);
    else if (n && n->field == WRL_COORD_INDEX)
        add_index(w, &n->coord_index, number);
}

/* ---- names ----------------------------------------------------------------------------------- */

size_t wrl_mark(const struct wrl *w)
{
    return w->out->n;
}

void wrl_define(struct wrl *w, struct span name, size_t begin)
{
    if (w->prototypes) /* a prototype's names are its own */
        return;
    struct wrl_definition *d = arena_zalloc(&w->arena, 1, sizeof *d);
    *d = (struct wrl_definition){begin, w->out->n, w->closed};
    map_set(&w->definitions, text_of(w, name), d);
}

static void report_undefined(struct wrl *w, struct span name)
{
    struct str text = text_of(w, name);
    struct str_nearest nearest = str_nearest_to(text);
    for (size_t i = 0; i < w->definitions.capacity; i++)
        if (w->definitions.slots[i].value)
            str_nearest_try(&nearest, w->definitions.slots[i].key);
    struct diag_entry *e = diag_report(w->diag, DIAG_UNKNOWN_NAME, name,
                                       "no DEF names '%.*s' before this", STR_ARG(text));
    diag_did_you_mean(e, name, str_nearest_found(&nearest));
}

void wrl_use(struct wrl *w, struct span name)
{
    if (w->prototypes)
        return;
    const struct wrl_definition *d = map_get(&w->definitions, text_of(w, name));
    if (!d) {
        report_undefined(w, name);
        return;
    }
    if (!w->declaring && d->end > d->begin)
        wrl_write(w, name, (struct str){w->out->at + d->begin, d->end - d->begin});
    give_points(w, d->points);
}

/* ---- prototypes: their faces are nowhere until they are used, which is not followed -----------
 */

void wrl_open_prototype(struct wrl *w)
{
    if (!w->prototypes++)
        w->first_in_prototype = (struct span){0};
}

void wrl_close_prototype(struct wrl *w, struct span name)
{
    if (--w->prototypes || !span_known(w->first_in_prototype))
        return;
    struct str text = text_of(w, name);
    struct diag_entry *e =
        diag_report(w->diag, DIAG_UV_LEFT_OUT, w->first_in_prototype,
                    "the faces of the prototype '%.*s' are left out, wherever it "
                    "is used",
                    STR_ARG(text));
    diag_label(e, name, "the prototype");
}

/* ---- the file -------------------------------------------------------------------------------- */

bool wrl_write(struct wrl *w, struct span span, struct str text)
{
    if (text.n > LIST_LIMIT - w->out->n)
        wrl_stop(w, DIAG_SCENE_TOO_LARGE, span, "the UV list becomes too large (limit 512 MiB)");
    else
        buffer_str(w->out, text);
    return !w->stopped;
}

static bool check_header(struct wrl *w)
{
    static const struct {
        const char *begin, *found;
    } others[] = {
        {"#VRML V1.0", "it is VRML 1.0"},
        {"#X3D", "it is X3D"},
        {"\x1f\x8b", "it is compressed with gzip"},
    };
    struct str text = {w->source->text, w->source->n};
    const char *found = "it does not begin with '#VRML V2.0 utf8'";
    if (str_begins(text, "#VRML V2.0"))
        return true;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (str_begins(text, others[i].begin))
            found = others[i].found;
    struct span start = {w->source->base, w->source->base};
    diag_report(w->diag, DIAG_MESH_FORMAT, start, "not a VRML 2.0 file: %s", found);
    return false;
}

/* The scanner works in the source's own buffer (its two NULs are flex's end marks). */
static void run(struct wrl *w)
{
    if (wrlex_lex_init_extra(w, &w->scanner) != 0 ||
        !wrlex__scan_buffer(w->source->text, (size_t)w->source->n + 2, w->scanner))
        mem_exhausted(w->source->n);
    if (vrml_parse(w) == 2 && !w->stopped)
        mem_exhausted(w->source->n);
    wrl_release(w->scanner);
    wrlex_lex_destroy(w->scanner);
}

static void wrl_free(struct wrl *w)
{
    while (w->depth)
        node_free(&w->nodes[--w->depth]);
    for (size_t i = 0; i < w->points.n; i++) {
        vec_free(&w->points.at[i]->numbers);
        free(w->points.at[i]);
    }
    vec_free(&w->points);
    vec_free(&w->bare);
    map_free(&w->definitions);
    arena_free(&w->arena);
}

/* Faces without texture coordinates only make sense beside others that have them. */
static void report_bare(struct wrl *w)
{
    struct span start = {w->source->base, w->source->base};
    if (!w->face_sets)
        diag_report(w->diag, DIAG_NO_TEXCOORD, start, "the file has no IndexedFaceSet");
    else if (w->bare.n == w->face_sets)
        diag_report(w->diag, DIAG_NO_TEXCOORD, w->bare.at[0],
                    "no IndexedFaceSet of the file has a texCoord");
    else
        for (size_t i = 0; i < w->bare.n; i++)
            diag_report(w->diag, DIAG_UV_LEFT_OUT, w->bare.at[i],
                        "this IndexedFaceSet has no texCoord; all its pairs are '0 0'");
}

bool uv_list_from_vrml(const struct source *source, struct buffer *out, struct diag *diag)
{
    size_t errors = diag->errors;
    struct wrl *w = mem_zalloc(1, sizeof *w);
    w->source = source;
    w->diag = diag;
    w->at = source->base;
    w->out = out;
    if (check_header(w)) {
        run(w);
        if (diag->errors == errors)
            report_bare(w);
    }
    wrl_free(w);
    free(w);
    return diag->errors == errors;
}
