/* Which of the mesh formats a file is in. */
#include "config.h"

#include "scene/mesh.h"
#include "scene/scan.h"

enum format { FORMAT_OFF, FORMAT_OBJ, FORMAT_PLY, FORMAT_STL, FORMAT_VRML, FORMATS };

static const struct {
    const char *suffix;
    struct mesh *(*parse)(const struct source *source, struct diag *diag);
} formats[FORMAT_VRML] = {
    [FORMAT_OFF] = {".off", off_parse},
    [FORMAT_OBJ] = {".obj", obj_parse},
    [FORMAT_PLY] = {".ply", ply_parse},
    [FORMAT_STL] = {".stl", stl_parse},
};

static enum format format_by_suffix(const char *name)
{
    struct str s = str_of(name);
    for (int i = 0; i < FORMAT_VRML; i++) {
        struct str suffix = str_of(formats[i].suffix);
        if (s.n >= suffix.n &&
            str_equal_nocase((struct str){s.at + s.n - suffix.n, suffix.n}, suffix))
            return (enum format)i;
    }
    return FORMATS;
}

/* `word` is the first that is not in a comment. */
static enum format format_by_content(const struct source *source, const char *begin,
                                     struct str word)
{
    const char *meaning;
    size_t n = source->n - (size_t)(begin - source->text);
    if (stl_is_binary(source))
        return FORMAT_STL;
    if (n >= 5 && memcmp(begin, "#VRML", 5) == 0)
        return FORMAT_VRML;
    if (str_is(word, "ply"))
        return FORMAT_PLY;
    if (off_is_header(word, &meaning))
        return FORMAT_OFF;
    if (str_equal_nocase(word, str_of("solid")))
        return FORMAT_STL;
    return obj_is_statement(word) ? FORMAT_OBJ : FORMATS;
}

bool mesh_recognised(const char *name, char *bytes, size_t n)
{
    struct source source = {.text = bytes, .n = (uint32_t)n};
    struct scan in = scan_of(&source, NULL);
    const char *begin = in.at;
    in.comment = '#';
    scan_skip_space(&in);
    return format_by_suffix(name) != FORMATS &&
           format_by_content(&source, begin, scan_word(&in)) != FORMATS;
}

static struct mesh *refuse(const struct scan *in, struct span span, const char *what)
{
    struct diag_entry *e = diag_report(in->diag, DIAG_MESH_FORMAT, span, "%s", what);
    diag_note(e, "meshes are read from OFF, OBJ, PLY and STL files");
    return NULL;
}

struct mesh *mesh_parse(const struct source *source, struct diag *diag)
{
    struct scan in = scan_of(source, diag);
    const char *begin = in.at;
    in.comment = '#';
    scan_skip_space(&in);
    struct str word = scan_word(&in);
    struct span span = scan_span(&in, word.at, word.at + word.n);
    enum format format = format_by_content(source, begin, word);
    if (format == FORMAT_VRML)
        return refuse(&in, scan_span(&in, begin, begin + 5), "VRML files are not read");
    if (format == FORMATS && in.at >= in.end)
        return refuse(&in, span, "the mesh file is empty");
    if (format == FORMATS)
        format = format_by_suffix(source->name);
    if (format == FORMATS)
        return refuse(&in, span, "neither the content nor the name tells the format of this file");
    return formats[format].parse(source, diag);
}
