/* XML scenes that are right, with comments wherever XML may have some. */
#include "config.h"

#include "random.h"

#include <stdio.h>

enum { MOST_IDS = 3 };

struct scene {
    struct writer w;
    unsigned textures;
    bool defined[MOST_IDS], owed[MOST_IDS]; /* materials with ids: in the text, used before */
};

static void put_text(struct scene *s, const char *text)
{
    buffer_puts(s->w.out, text);
}

static bool once(struct scene *s, unsigned n)
{
    return once_in(&s->w, n);
}

static void open_tag(struct scene *s, const char *name)
{
    put_gap(&s->w, false);
    buffer_printf(s->w.out, "<%s", name);
}

static void put_attribute(struct scene *s, const char *name, struct str value)
{
    char quote = once(s, 4) ? '\'' : '"';
    buffer_printf(s->w.out, once(s, 5) ? "\n  %s = %c%.*s%c" : " %s=%c%.*s%c", name, quote,
                  STR_ARG(value), quote);
}

static void close_tag(struct scene *s, const char *name)
{
    put_gap(&s->w, false);
    buffer_printf(s->w.out, "</%s%s>", name, once(s, 6) ? " " : "");
}

/* ---- leaves ---- */

/* Comments between words come before all of them, once there and back: they stay in the leaf. */
static void put_words(struct scene *s, const char *const *words, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        if (i > 0)
            put_text(s, once(s, 4) ? "\n\t" : " ");
        if (once(s, 3 * s->w.comment_rate))
            put_gap(&s->w, true);
        put_text(s, words[i]);
    }
    if (once(s, 8))
        put_text(s, " ");
}

static void put_leaf(struct scene *s, const char *name, const char *const *words, unsigned n)
{
    open_tag(s, name);
    put_text(s, ">");
    put_words(s, words, n);
    buffer_printf(s->w.out, "</%s>", name);
}

static void put_word(struct scene *s, const char *name, const char *words)
{
    struct str word = random_word(&s->w.random, words);
    open_tag(s, name);
    buffer_printf(s->w.out, ">%.*s</%s>", STR_ARG(word), name);
}

/* Numbers that may be anything, or are above 0. */
static const char *number(struct scene *s, bool positive)
{
    static const char *const any[] = {
        "0", "-1", "+.5", "1.", "-0.0", "2.50", "0.1", "1E-2", "3", "-4e0", "0.30000000000000004"};
    static const char *const above[] = {"1", "0.5", "+2.", "1e-1", ".25", "3.0"};
    return positive ? above[below(&s->w, 6)] : any[below(&s->w, 11)];
}

static void put_vector(struct scene *s, const char *name)
{
    const char *words[3] = {number(s, false), number(s, false), number(s, false)};
    if (once(s, 3))
        words[1] = words[2] = words[0];
    put_leaf(s, name, words, 3);
}

static void put_number(struct scene *s, const char *name, bool positive)
{
    const char *word = number(s, positive);
    put_leaf(s, name, &word, 1);
}

static void put_colour(struct scene *s, const char *name)
{
    put_vector(s, name);
}

/* A file that is there, in one of the ways XML has of spelling it. */
static void put_file(struct scene *s, const char *name, const char *file)
{
    open_tag(s, name);
    put_text(s, ">");
    if (once(s, 4))
        buffer_printf(s->w.out, " <![CDATA[./%s]]>\n", file);
    else if (once(s, 4))
        buffer_printf(s->w.out, "&#46;//%s", file);
    else
        put_text(s, file);
    buffer_printf(s->w.out, "</%s>", name);
}

/* Calls the parts in any order. */
typedef void put_part(struct scene *s);

static void put_parts(struct scene *s, put_part *const *parts, unsigned n)
{
    bool done[16] = {0};
    for (unsigned left = n; left > 0; left--) {
        unsigned skip = below(&s->w, left), i = 0;
        for (; done[i] || skip > 0; i++)
            skip -= !done[i];
        done[i] = true;
        parts[i](s);
    }
}

/* ---- materials ---- */

static void put_uv_map(struct scene *s)
{
    if (once(s, 4))
        put_vector(s, "toffset");
    if (once(s, 4))
        put_vector(s, "tscale");
}

static void put_texture_index(struct scene *s, const char *name)
{
    open_tag(s, name);
    buffer_printf(s->w.out, ">%u</%s>", below(&s->w, s->textures), name);
}

static void put_texture(struct scene *s)
{
    if (s->textures && once(s, 3))
        put_texture_index(s, "texture");
}

static void put_diffuse(struct scene *s)
{
    put_colour(s, "diffuse");
}

static void put_specular(struct scene *s)
{
    put_colour(s, "specular");
}

static void put_exponent(struct scene *s)
{
    put_number(s, "exponent", true);
}

static void put_reflection(struct scene *s)
{
    put_colour(s, "reflection");
}

static void put_refraction(struct scene *s)
{
    put_colour(s, "refraction");
}

static void put_ior(struct scene *s)
{
    put_number(s, "refractionCoef", true);
}

static const char *const ids[MOST_IDS] = {"gold", "late stone", "for"};

static void put_definition(struct scene *s, const char *id)
{
    static const char *const classes[] = {"Lambert",
                                          "Lambertian",
                                          "Emissive",
                                          "Phong",
                                          "ShinyPhong",
                                          "MetalPhong",
                                          "RefractionShinyPhong",
                                          "ShinyRefractionPhong"};
    static put_part *const parts[] = {put_texture,  put_uv_map,     put_diffuse,    put_specular,
                                      put_exponent, put_reflection, put_refraction, put_ior};
    static const unsigned counts[] = {3, 3, 3, 5, 6, 6, 8, 8};
    unsigned i = below(&s->w, 8);
    open_tag(s, "material");
    if (id && once(s, 2))
        put_attribute(s, "id", str_of(id));
    else if (id)
        buffer_printf(s->w.out, " id=\"%s\"", id);
    put_attribute(s, "class", str_of(classes[i]));
    put_text(s, ">");
    put_parts(s, parts, counts[i]);
    close_tag(s, "material");
}

static void put_reference(struct scene *s, unsigned i)
{
    open_tag(s, "material");
    put_attribute(s, "ref", str_of(ids[i]));
    if (once(s, 2)) {
        put_text(s, "/>");
        return;
    }
    put_text(s, ">");
    close_tag(s, "material");
}

/* A definition, perhaps with an id, or a reference to one that stands before or comes later. */
static void put_material(struct scene *s)
{
    unsigned i = below(&s->w, 2 * MOST_IDS);
    if (i >= MOST_IDS) {
        put_definition(s, NULL);
    } else if (s->defined[i] || once(s, 3)) {
        s->owed[i] = true;
        put_reference(s, i);
    } else {
        s->defined[i] = true;
        put_definition(s, ids[i]);
    }
}

/* ---- surfaces ---- */

static void put_normal_map(struct scene *s)
{
    if (s->textures && once(s, 4))
        put_texture_index(s, "bTexture");
}

static void put_corners(struct scene *s, unsigned n, const char *suffix)
{
    for (unsigned i = 0; i < n; i++) {
        char name[8];
        snprintf(name, sizeof name, "v%u%s", i, suffix);
        put_vector(s, name);
    }
}

static void put_center(struct scene *s)
{
    put_vector(s, "position");
}

static void put_radius(struct scene *s)
{
    put_number(s, "radius", true);
}

static void put_3_corners(struct scene *s)
{
    put_corners(s, 3, "");
}

static void put_3_uvs(struct scene *s)
{
    put_corners(s, 3, "t");
}

static void put_4_corners(struct scene *s)
{
    put_corners(s, 4, "");
}

static void put_4_uvs(struct scene *s)
{
    put_corners(s, 4, "t");
}

static void put_base(struct scene *s)
{
    put_vector(s, "center1");
}

static void put_height(struct scene *s)
{
    put_number(s, "height", true);
}

static void put_mesh_file(struct scene *s)
{
    put_file(s, "filename", "m.off");
}

static void put_uv_file(struct scene *s)
{
    put_file(s, "UVfile", "m.txt");
}

static void put_mesh_options(struct scene *s)
{
    if (once(s, 2)) {
        const char *size[3] = {number(s, true), number(s, true), number(s, true)};
        put_leaf(s, "size", size, 3);
    }
    if (once(s, 3))
        put_number(s, "breakang", false);
    if (once(s, 3))
        put_word(s, "invNormal", "0 1");
    if (once(s, 3))
        put_number(s, "showNormals", true);
}

/* An odd name is no label, and kept in a note. */
static void put_label(struct scene *s)
{
    static const char names[] = "ball a1 _x for 1st &quot;q&quot; a*/b b--c sphere &#x20;a";
    if (once(s, 4))
        put_attribute(s, "id", random_word(&s->w.random, names));
}

static void put_surface(struct scene *s, const char *tag, bool in_scene)
{
    static const struct {
        const char *class;
        put_part *parts[8];
        unsigned n, plain; /* plain: without material, texture coordinates and normal map */
    } kinds[] = {
        {"Sphere", {put_center, put_radius, put_material, put_uv_map, put_normal_map}, 5, 2},
        {"Cylinder", {put_base, put_height, put_radius, put_material, put_normal_map}, 5, 3},
        {"Triangle", {put_3_corners, put_material, put_3_uvs, put_normal_map}, 4, 1},
        {"Quad", {put_4_corners, put_material, put_uv_map, put_4_uvs, put_normal_map}, 5, 1},
        {"Mesh",
         {put_mesh_file, put_center, put_mesh_options, put_material, put_uv_file, put_uv_map,
          put_normal_map},
         7,
         2},
    };
    unsigned i = below(&s->w, 5);
    open_tag(s, tag);
    put_attribute(s, "class", str_of(kinds[i].class));
    if (in_scene)
        put_label(s);
    put_text(s, ">");
    put_parts(s, kinds[i].parts, in_scene ? kinds[i].n : kinds[i].plain);
    close_tag(s, tag);
}

/* ---- sections ---- */

static void put_resolution(struct scene *s)
{
    put_word(s, "xResolution", "8 16");
    put_word(s, "yResolution", "8 16.0 12");
}

static void put_origin(struct scene *s)
{
    put_vector(s, "origin");
}

static void put_back(struct scene *s)
{
    static const char *const words[] = {"0.0", "+0.25", "-1"};
    put_leaf(s, "z", words, 3);
}

static void put_up(struct scene *s)
{
    static const char *const words[] = {"0", "1e0", "0"};
    put_leaf(s, "y", words, 3);
}

static void put_yfov(struct scene *s)
{
    put_word(s, "yfov", "27 27.50 2E1");
}

static void put_compat(struct scene *s)
{
    if (once(s, 3))
        put_word(s, "compatMode", "0 1");
}

static void put_camera(struct scene *s)
{
    static put_part *const parts[] = {put_origin, put_back,       put_up,
                                      put_yfov,   put_resolution, put_compat};
    open_tag(s, "camera");
    put_text(s, ">");
    put_parts(s, parts, 6);
    close_tag(s, "camera");
}

static void put_textures(struct scene *s)
{
    open_tag(s, "textures");
    put_text(s, ">");
    for (unsigned i = 0; i < s->textures; i++) {
        static const char names[] = "wood t t_2 for a&amp;b";
        open_tag(s, "Texture");
        if (once(s, 3))
            put_attribute(s, "id", random_word(&s->w.random, names));
        put_text(s, ">");
        put_file(s, "file", "t.png");
        if (once(s, 2))
            put_word(s, "filter", "0 1");
        close_tag(s, "Texture");
    }
    close_tag(s, "textures");
}

static void put_intensity(struct scene *s)
{
    if (once(s, 2))
        put_colour(s, "intensity");
}

static void put_falloff(struct scene *s)
{
    if (once(s, 3))
        put_word(s, "attenuation", "none inverse-square None INVERSE-SQUARE");
}

static void put_shape(struct scene *s)
{
    if (once(s, 2)) {
        put_word(s, "shape", "Sphere Quad sphere QUAD");
        put_number(s, "size", true);
    } else {
        put_surface(s, "object", false);
    }
    if (once(s, 3))
        put_word(s, "nsamples", "2 3.0 4");
}

static void put_lights(struct scene *s)
{
    static put_part *const parts[] = {put_intensity, put_center, put_falloff, put_shape};
    open_tag(s, "lights");
    put_text(s, ">");
    for (unsigned n = below(&s->w, 3); n > 0; n--) {
        bool area = once(s, 3);
        open_tag(s, "light");
        put_attribute(s, "class", str_of(area ? "AreaLight" : "PointLight"));
        put_label(s);
        put_text(s, ">");
        put_parts(s, parts, area ? 4 : 3);
        close_tag(s, "light");
    }
    close_tag(s, "lights");
}

/* The definition of a material that was used before. */
static void put_owed(struct scene *s, const char *id)
{
    open_tag(s, "surface");
    put_attribute(s, "class", str_of("Sphere"));
    put_text(s, ">");
    put_radius(s);
    put_definition(s, id);
    put_center(s);
    close_tag(s, "surface");
}

static void put_surfaces(struct scene *s)
{
    open_tag(s, "surfaces");
    put_text(s, ">");
    for (unsigned n = below(&s->w, 6); n > 0; n--)
        put_surface(s, "surface", true);
    for (unsigned i = 0; i < MOST_IDS; i++)
        if (s->owed[i] && !s->defined[i])
            put_owed(s, ids[i]);
    close_tag(s, "surfaces");
}

void random_xml(uint64_t seed, struct buffer *out)
{
    static put_part *const sections[] = {put_camera, put_textures, put_lights, put_surfaces};
    struct scene s = {.w = writer_begin(seed, true, out)};
    s.textures = below(&s.w, 4);
    open_tag(&s, "scene");
    if (once(&s, 3))
        put_attribute(&s, "model", str_of("classic"));
    put_text(&s, ">");
    if (once(&s, 4))
        put_camera(&s);
    else
        put_parts(&s, sections, 4);
    close_tag(&s, "scene");
    put_gap(&s.w, false);
}
