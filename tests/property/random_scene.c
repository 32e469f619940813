/* Native scenes that are right and that XML can say, with comments between any two tokens. */
#include "config.h"

#include "random.h"

#include <stdio.h>

struct scene {
    struct writer w;
    unsigned materials, functions, templates, numbers; /* with names, so far */
    bool in_loop;                                      /* i is a number */
    bool textured;
};

static bool once(struct scene *s, unsigned n)
{
    return once_in(&s->w, n);
}

static void token(struct scene *s, const char *t)
{
    put(&s->w, t);
}

static void put_numbered(struct scene *s, const char *name, unsigned n)
{
    char text[32];
    snprintf(text, sizeof text, "%s%u", name, n);
    token(s, text);
}

static void separator(struct scene *s)
{
    if (once(s, 6))
        put_one_of(&s->w, ", ;");
}

/* ---- numbers ---- */

static void put_number(struct scene *s, unsigned depth);

static void put_call(struct scene *s, unsigned depth)
{
    put_numbered(s, "f", below(&s->w, s->functions));
    token(s, "(");
    put_number(s, depth);
    if (once(s, 2)) {
        token(s, ",");
        if (once(s, 2)) {
            token(s, "b");
            token(s, "=");
        }
        put_number(s, depth);
    }
    token(s, ")");
}

static void put_literal(struct scene *s)
{
    put_one_of(&s->w, "0 1 2.50 .5 1. 3e-1 0.1 7 -2 +4 -0.0 12.75");
}

static void put_number(struct scene *s, unsigned depth)
{
    switch (depth == 0 ? below(&s->w, 3) : below(&s->w, 8)) {
    case 0:
        put_literal(s);
        break;
    case 1:
        if (s->in_loop)
            token(s, "i");
        else
            put_literal(s);
        break;
    case 2:
        if (s->numbers)
            put_numbered(s, "n", below(&s->w, s->numbers));
        else
            put_literal(s);
        break;
    case 3:
        token(s, "(");
        put_number(s, depth - 1);
        token(s, ")");
        break;
    case 4:
        if (s->functions)
            put_call(s, depth - 1);
        else
            put_literal(s);
        break;
    case 5:
        token(s, "(");
        put_number(s, depth - 1);
        token(s, "<");
        put_number(s, depth - 1);
        token(s, "?");
        put_number(s, depth - 1);
        token(s, ":");
        put_number(s, depth - 1);
        token(s, ")");
        break;
    default:
        token(s, "(");
        put_number(s, depth - 1);
        put_one_of(&s->w, "+ - *");
        put_number(s, depth - 1);
        token(s, ")");
        break;
    }
}

/* One above 0. */
static void put_size(struct scene *s)
{
    if (once(s, 2)) {
        put_one_of(&s->w, "1 0.5 .25 2. 1e-1");
        return;
    }
    token(s, "0.5 + abs");
    token(s, "(");
    put_number(s, 1);
    token(s, ")");
}

static void put_vector(struct scene *s)
{
    if (once(s, 4)) {
        put_numbered(s, "v", 0);
        return;
    }
    token(s, "(");
    for (int i = 0; i < 3; i++) {
        if (i > 0)
            token(s, ",");
        put_number(s, 2);
    }
    token(s, ")");
}

/* A scalar for all three, a colour, or three numbers. */
static void put_colour(struct scene *s)
{
    if (once(s, 3))
        put_literal(s);
    else if (once(s, 3))
        token(s, "#c7b852");
    else
        put_vector(s);
}

static void property(struct scene *s, const char *name)
{
    separator(s);
    token(s, name);
    token(s, ":");
}

/* ---- materials ---- */

static void put_construct(struct scene *s)
{
    bool phong = once(s, 2);
    token(s, phong ? "phong" : "emissive");
    token(s, "{");
    property(s, "diffuse");
    put_colour(s);
    if (phong) {
        property(s, "specular");
        put_colour(s);
        property(s, "exponent");
        put_size(s);
    }
    if (once(s, 5)) {
        property(s, "uv_offset");
        put_vector(s);
    }
    if (s->textured && once(s, 3)) {
        property(s, "texture");
        put_one_of(&s->w, "wood t");
    }
    token(s, "}");
}

static void put_material_value(struct scene *s)
{
    if (!s->materials || once(s, 3)) {
        put_construct(s);
        return;
    }
    put_numbered(s, "m", below(&s->w, s->materials));
    if (once(s, 3)) {
        token(s, "{");
        property(s, "diffuse");
        put_colour(s);
        token(s, "}");
    }
}

static void put_material(struct scene *s)
{
    if (once(s, 6)) /* the default's */
        return;
    property(s, "material");
    put_material_value(s);
}

/* ---- objects ---- */

static void begin_object(struct scene *s, const char *kind)
{
    token(s, kind);
    if (once(s, 3))
        put_one_of(&s->w, "ball lamp _1");
    token(s, "{");
}

static void put_sphere(struct scene *s)
{
    begin_object(s, "sphere");
    property(s, "center");
    put_vector(s);
    property(s, "radius");
    put_size(s);
    put_material(s);
    token(s, "}");
}

static void put_cylinder(struct scene *s)
{
    begin_object(s, "cylinder");
    put_material(s);
    property(s, "radius");
    put_size(s);
    property(s, "base");
    put_vector(s);
    property(s, "height");
    put_size(s);
    token(s, "}");
}

static void put_points(struct scene *s, const char *name, unsigned n)
{
    property(s, name);
    token(s, "[");
    for (unsigned i = 0; i < n; i++) {
        if (i > 0)
            token(s, ",");
        token(s, "(");
        put_number(s, 1);
        token(s, ",");
        put_number(s, 1);
        if (once(s, 2) || name[0] == 'v') {
            token(s, ",");
            put_number(s, 1);
        }
        token(s, ")");
    }
    if (once(s, 4))
        token(s, ",");
    token(s, "]");
}

static void put_flat(struct scene *s)
{
    unsigned n = 3 + below(&s->w, 2);
    begin_object(s, n == 3 ? "triangle" : "quad");
    put_points(s, "vertices", n);
    put_points(s, "uvs", n);
    put_material(s);
    if (s->textured && once(s, 4)) {
        property(s, "normal_map");
        token(s, "t");
    }
    token(s, "}");
}

static void put_mesh(struct scene *s)
{
    begin_object(s, "mesh");
    property(s, "file");
    token(s, "\"m.\" + \"off\"");
    property(s, "uv_file");
    token(s, "\"m.txt\"");
    if (once(s, 2)) {
        property(s, "smooth");
        put_one_of(&s->w, "true false 0 1 -1");
    }
    if (once(s, 2)) {
        property(s, "scale");
        put_size(s);
    }
    put_material(s);
    token(s, "}");
}

static void put_light(struct scene *s)
{
    bool area = once(s, 2);
    token(s, "light");
    token(s, area ? "area" : "point");
    if (once(s, 3))
        put_one_of(&s->w, "key fill");
    token(s, "{");
    property(s, "position");
    put_vector(s);
    property(s, "intensity");
    put_colour(s);
    if (area) {
        property(s, "shape");
        put_one_of(&s->w, "sphere quad \"sphere\"");
        property(s, "size");
        put_size(s);
    }
    token(s, "}");
}

static void put_object(struct scene *s)
{
    switch (below(&s->w, 6)) {
    case 0:
        put_cylinder(s);
        break;
    case 1:
        put_flat(s);
        break;
    case 2:
        put_mesh(s);
        break;
    case 3:
        put_light(s);
        break;
    default:
        put_sphere(s);
        break;
    }
}

/* ---- statements ---- */

static void put_statements(struct scene *s, unsigned depth);

/* Moves and even scales, which XML can say of everything. */
static void put_place(struct scene *s)
{
    if (once(s, 2)) {
        property(s, "translate");
        put_vector(s);
    }
    if (once(s, 2)) {
        property(s, "scale");
        put_size(s);
    }
}

static void put_loop(struct scene *s, unsigned depth)
{
    bool outer = s->in_loop;
    token(s, "for i in range");
    token(s, "(");
    put_one_of(&s->w, "0 1 2 3");
    token(s, ")");
    token(s, "{");
    s->in_loop = true;
    put_statements(s, depth - 1);
    s->in_loop = outer;
    token(s, "}");
}

static void put_branch(struct scene *s, unsigned depth)
{
    token(s, "if");
    put_number(s, 1);
    put_one_of(&s->w, "< > == !=");
    put_number(s, 1);
    token(s, "{");
    put_statements(s, depth - 1);
    token(s, "}");
    if (once(s, 2))
        return;
    token(s, "else");
    token(s, "{");
    put_statements(s, depth - 1);
    token(s, "}");
}

static void put_statement(struct scene *s, unsigned depth)
{
    switch (depth == 0 ? 9 : below(&s->w, 10)) {
    case 0:
        put_loop(s, depth);
        break;
    case 1:
        put_branch(s, depth);
        break;
    case 2:
        token(s, "group");
        token(s, "{");
        put_place(s);
        put_statements(s, depth - 1);
        token(s, "}");
        break;
    case 3:
        if (!s->templates)
            break;
        put_numbered(s, "d", below(&s->w, s->templates));
        token(s, "(");
        put_material_value(s);
        token(s, ")");
        if (once(s, 2)) {
            token(s, "{");
            put_place(s);
            token(s, "}");
        }
        break;
    default:
        put_object(s);
        break;
    }
}

static void put_statements(struct scene *s, unsigned depth)
{
    for (unsigned n = below(&s->w, 4); n > 0; n--) {
        put_statement(s, depth);
        separator(s);
    }
}

static void put_function(struct scene *s)
{
    token(s, "fn");
    put_numbered(s, "f", s->functions);
    token(s, "(");
    token(s, "a");
    token(s, ",");
    token(s, "b");
    token(s, "=");
    put_literal(s);
    token(s, ")");
    token(s, "=");
    put_one_of(&s->w, "a b (a+b) (a-b*2) min(a,b)");
    s->functions++;
}

static void put_template(struct scene *s)
{
    token(s, "define");
    put_numbered(s, "d", s->templates);
    token(s, "(");
    token(s, "m");
    token(s, ")");
    token(s, "{");
    put_statements(s, 1);
    token(s, "sphere");
    token(s, "{");
    property(s, "center");
    put_vector(s);
    property(s, "radius");
    put_size(s);
    property(s, "material");
    token(s, "m");
    token(s, "}");
    token(s, "}");
    s->templates++;
}

static void put_definition(struct scene *s)
{
    switch (below(&s->w, 5)) {
    case 0:
        put_function(s);
        break;
    case 1:
        put_template(s);
        break;
    case 2:
        token(s, once(s, 2) ? "let" : "param");
        put_numbered(s, "n", s->numbers);
        token(s, "=");
        put_number(s, 2);
        s->numbers++;
        break;
    default:
        token(s, once(s, 4) ? "let" : "material");
        put_numbered(s, "m", s->materials);
        token(s, "=");
        put_material_value(s);
        s->materials++;
        break;
    }
}

static void put_camera(struct scene *s)
{
    token(s, "camera");
    token(s, "{");
    property(s, "eye");
    put_vector(s);
    property(s, "back");
    token(s, "(0, 0.25, -1)");
    property(s, "up");
    token(s, "(0, 1, 0)");
    property(s, "yfov");
    put_one_of(&s->w, "27 27deg 0.5rad 2e1deg");
    property(s, "resolution");
    put_one_of(&s->w, "(8,16) (8,2*4) ((8),(9))");
    token(s, "}");
}

static void put_textures(struct scene *s)
{
    static const char *const names[] = {"wood", "t"};
    s->textured = true;
    for (int i = 0; i < 2; i++) {
        token(s, "texture");
        token(s, names[i]);
        token(s, "=");
        token(s, "image");
        token(s, "{");
        property(s, "file");
        token(s, "\"t.png\"");
        if (once(s, 2)) {
            property(s, "filter");
            put_one_of(&s->w, "linear nearest");
        }
        token(s, "}");
    }
}

void random_scene(uint64_t seed, struct buffer *out)
{
    struct scene s = {.w = writer_begin(seed, false, out)};
    token(&s, "wrt 1");
    token(&s, "model classic");
    token(&s, "let v0 = (1, 2, 3)");
    for (int i = 0; i < 5; i++) {
        static const char *const kinds[] = {"sphere", "cylinder", "mesh", "quad", "triangle"};
        token(&s, "default");
        token(&s, kinds[i]);
        token(&s, "{ material: lambert { diffuse: 1 } }");
    }
    if (once(&s, 2))
        put_textures(&s);
    unsigned camera = below(&s.w, 8);
    for (unsigned i = 0; i < 8; i++) {
        if (i == camera)
            put_camera(&s);
        if (once(&s, 2))
            put_definition(&s);
        else
            put_statement(&s, 2);
        if (once(&s, 6))
            token(&s, ";");
    }
    put_gap(&s.w, false);
}
