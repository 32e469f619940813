#include "config.h"

#include "scene/ply.h"

const uint8_t ply_sizes[PLY_TYPES] = {0, 1, 1, 2, 2, 4, 4, 4, 8};

static const char *const type_names[PLY_TYPES][2] = {
    [PLY_INT8] = {"char", "int8"},        [PLY_UINT8] = {"uchar", "uint8"},
    [PLY_INT16] = {"short", "int16"},     [PLY_UINT16] = {"ushort", "uint16"},
    [PLY_INT32] = {"int", "int32"},       [PLY_UINT32] = {"uint", "uint32"},
    [PLY_FLOAT32] = {"float", "float32"}, [PLY_FLOAT64] = {"double", "float64"},
};

static const struct {
    const char *name;
    enum ply_use use;
} uses[] = {{"vertex", PLY_VERTICES}, {"face", PLY_FACES}, {"tristrips", PLY_STRIPS}};

static const struct {
    const char *name;
    enum ply_use use;
    enum ply_role role;
} roles[] = {
    {"x", PLY_VERTICES, ROLE_X},
    {"y", PLY_VERTICES, ROLE_Y},
    {"z", PLY_VERTICES, ROLE_Z},
    {"nx", PLY_VERTICES, ROLE_NX},
    {"ny", PLY_VERTICES, ROLE_NY},
    {"nz", PLY_VERTICES, ROLE_NZ},
    {"s", PLY_VERTICES, ROLE_U},
    {"t", PLY_VERTICES, ROLE_V},
    {"u", PLY_VERTICES, ROLE_U},
    {"v", PLY_VERTICES, ROLE_V},
    {"texture_u", PLY_VERTICES, ROLE_U},
    {"texture_v", PLY_VERTICES, ROLE_V},
    {"texture_s", PLY_VERTICES, ROLE_U},
    {"texture_t", PLY_VERTICES, ROLE_V},
    {"vertex_indices", PLY_FACES, ROLE_CORNERS},
    {"vertex_index", PLY_FACES, ROLE_CORNERS},
    {"texcoord", PLY_FACES, ROLE_CORNER_UVS},
    {"vertex_indices", PLY_STRIPS, ROLE_CORNERS},
    {"vertex_index", PLY_STRIPS, ROLE_CORNERS},
};

static struct str take_word(struct scan *in)
{
    scan_skip_blanks(in);
    struct str word = scan_word(in);
    in->at += word.n;
    return word;
}

/* Puts the cursor before the word again, and says that something else was expected there. */
static bool unexpected(struct scan *in, struct str word, const char *what)
{
    in->at = word.at;
    scan_expected(in, "%s", what);
    return false;
}

static bool end_line(struct scan *in)
{
    if (scan_at_line_end(in)) {
        scan_skip_line(in);
        return true;
    }
    scan_expected(in, "the end of the line");
    return false;
}

static bool read_format(struct scan *in, struct ply_header *h)
{
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    struct str word = take_word(in), version = take_word(in);
    for (int i = 0; i < 3; i++) {
        if (!str_is(word, names[i]))
            continue;
        h->layout = (enum ply_layout)i;
        return str_is(version, "1.0") ? end_line(in) : unexpected(in, version, "version 1.0");
    }
    return unexpected(in, word, "'ascii', 'binary_little_endian' or 'binary_big_endian'");
}

enum { ELEMENT_LIMIT = 1000 }; /* far more than any program writes */

static bool is_new(const struct scan *in, const struct ply_header *h, const struct ply_element *e)
{
    bool twice = false;
    for (size_t i = 0; i < h->elements.n; i++)
        twice = twice || str_equal(h->elements.at[i].name, e->name);
    if (twice)
        diag_report(in->diag, DIAG_MESH_SYNTAX, e->span, "there are two elements '%.*s'",
                    STR_ARG(e->name));
    else if (h->elements.n == ELEMENT_LIMIT)
        diag_report(in->diag, DIAG_MESH_SYNTAX, e->span, "there are more than %d elements",
                    ELEMENT_LIMIT);
    return !twice && h->elements.n < ELEMENT_LIMIT;
}

static bool read_element(struct scan *in, struct ply_header *h)
{
    struct ply_element e = {.name = take_word(in)};
    scan_skip_blanks(in);
    if (!scan_count(in, &e.n)) {
        scan_expected(in, "the name and the number of an element");
        return false;
    }
    e.span = scan_span(in, e.name.at, in->at);
    for (size_t i = 0; i < sizeof uses / sizeof *uses; i++)
        if (str_is(e.name, uses[i].name))
            e.use = uses[i].use;
    if (!is_new(in, h, &e))
        return false;
    vec_push(&h->elements, e);
    if (e.use == PLY_VERTICES)
        h->vertices = e.n;
    return end_line(in);
}

static enum ply_type type_of(struct str word)
{
    for (int i = PLY_INT8; i < PLY_TYPES; i++)
        if (str_is(word, type_names[i][0]) || str_is(word, type_names[i][1]))
            return (enum ply_type)i;
    return PLY_NONE;
}

static bool read_type(struct scan *in, enum ply_type *out)
{
    struct str word = take_word(in);
    *out = type_of(word);
    return *out != PLY_NONE || unexpected(in, word, "a type, such as 'float' or 'uchar'");
}

static enum ply_role role_of(const struct ply_element *e, const struct ply_property *p)
{
    for (size_t i = 0; i < sizeof roles / sizeof *roles; i++) {
        bool list = roles[i].role >= ROLE_CORNERS;
        if (roles[i].use == e->use && list == (p->count != PLY_NONE) &&
            str_is(p->name, roles[i].name) && !ply_has(e, roles[i].role))
            return roles[i].role;
    }
    return ROLE_NONE;
}

static bool read_property(struct scan *in, struct ply_header *h)
{
    struct ply_property p = {.count = PLY_NONE};
    scan_skip_blanks(in);
    if (h->elements.n == 0)
        return unexpected(in, scan_word(in), "an element before its properties");
    struct ply_element *e = &h->elements.at[h->elements.n - 1];
    if (str_is(scan_word(in), "list")) {
        take_word(in);
        struct str word = (scan_skip_blanks(in), scan_word(in));
        if (!read_type(in, &p.count))
            return false;
        if (p.count >= PLY_FLOAT32)
            return unexpected(in, word, "a whole number's type for the length of a list");
    }
    if (!read_type(in, &p.type))
        return false;
    p.name = take_word(in);
    if (p.name.n == 0)
        return unexpected(in, p.name, "the name of the property");
    p.role = role_of(e, &p);
    e->roles |= UINT32_C(1) << p.role;
    vec_push(&e->properties, p);
    return end_line(in);
}

static bool read_lines(struct scan *in, struct ply_header *h)
{
    bool formatted = false;
    for (;;) {
        scan_skip_space(in);
        struct str word = take_word(in);
        bool ok = true;
        if (str_is(word, "end_header"))
            return formatted ? end_line(in) : unexpected(in, word, "'format' before the end");
        if (str_is(word, "comment") || str_is(word, "obj_info"))
            scan_skip_line(in);
        else if (str_is(word, "format"))
            ok = formatted = read_format(in, h);
        else if (str_is(word, "element"))
            ok = read_element(in, h);
        else if (str_is(word, "property"))
            ok = read_property(in, h);
        else
            ok = unexpected(in, word, "'element', 'property', 'comment' or 'end_header'");
        if (!ok)
            return false;
    }
}

/* What is read at all must have what makes it up. */
static bool check_element(const struct scan *in, const struct ply_element *e)
{
    static const struct {
        enum ply_use use;
        enum ply_role role;
        const char *what;
    } needs[] = {
        {PLY_VERTICES, ROLE_X, "x"},
        {PLY_VERTICES, ROLE_Y, "y"},
        {PLY_VERTICES, ROLE_Z, "z"},
        {PLY_FACES, ROLE_CORNERS, "vertex_indices"},
        {PLY_STRIPS, ROLE_CORNERS, "vertex_indices"},
    };
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++) {
        if (needs[i].use != e->use || ply_has(e, needs[i].role))
            continue;
        diag_report(in->diag, DIAG_MESH_SYNTAX, e->span, "the element '%.*s' has no %s '%s'",
                    STR_ARG(e->name), needs[i].role >= ROLE_CORNERS ? "list" : "property",
                    needs[i].what);
        return false;
    }
    return true;
}

bool ply_read_header(struct scan *in, struct ply_header *h)
{
    *h = (struct ply_header){0};
    struct str ply = take_word(in);
    if (!str_is(ply, "ply"))
        return unexpected(in, ply, "'ply'");
    if (!end_line(in) || !read_lines(in, h))
        return false;
    for (size_t i = 0; i < h->elements.n; i++)
        if (!check_element(in, &h->elements.at[i]))
            return false;
    return true;
}

void ply_free_header(struct ply_header *h)
{
    for (size_t i = 0; i < h->elements.n; i++)
        vec_free(&h->elements.at[i].properties);
    vec_free(&h->elements);
}
