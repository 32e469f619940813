/* Binary OFF.
 *
 * Two layouts go by this name.  Geomview's, the format's own: big-endian, and each face ends with
 * the number of its colour components and these.  OpenMesh's: little-endian, without any of that.
 * Nothing in the header tells them apart, so the layout is the one whose every index is in range
 * and whose last face ends where the file does.
 *
 * OpenMesh is not asked to read either: given a stream, its reader never looks at the header and
 * takes the bytes for text, and given a damaged file it follows any count and index it finds. */
#include "config.h"

#include "scene/bytes.h"
#include "scene/mesh.h"

#include <math.h>

struct layout {
    bool big_endian, colours;
};

struct bytes {
    const uint8_t *at, *end;
    struct layout layout;
};

static size_t words_left(const struct bytes *b)
{
    return (size_t)(b->end - b->at) / 4;
}

/* The caller has checked words_left. */
static uint32_t take_word(struct bytes *b)
{
    b->at += 4;
    return (uint32_t)bytes_load(b->at - 4, 4, b->layout.big_endian);
}

static double take_float(struct bytes *b)
{
    b->at += 4;
    return bytes_load_float(b->at - 4, b->layout.big_endian);
}

static bool take_points(struct bytes *b, size_t n, struct mesh *m)
{
    vec_reserve(&m->points, n);
    for (size_t i = 0; i < n; i++) {
        double x = take_float(b), y = take_float(b), z = take_float(b);
        if (!isfinite(x) || !isfinite(y) || !isfinite(z))
            return false;
        vec_push(&m->points, vec3(x, y, z));
    }
    return true;
}

static bool take_face(struct bytes *b, struct mesh *m)
{
    size_t corners = words_left(b) ? take_word(b) : 0;
    if (corners < 3 || corners > words_left(b))
        return false;
    struct triangle_corners t;
    for (size_t i = 0; i < corners; i++) {
        uint32_t corner = t.at[i < 2 ? i : 2] = take_word(b);
        if (corner >= m->points.n)
            return false;
        if (i < 2)
            continue;
        vec_push(&m->faces, t);
        t.at[1] = corner;
    }
    if (!b->layout.colours)
        return true;
    size_t colours = words_left(b) ? take_word(b) : SIZE_MAX;
    if (colours > 4 || colours > words_left(b))
        return false;
    b->at += 4 * colours;
    return true;
}

static bool take_mesh(struct bytes b, struct mesh *m)
{
    enum { COUNTS = 3, FACE_WORDS = 4 };
    m->points.n = m->faces.n = 0;
    if (words_left(&b) < COUNTS)
        return false;
    size_t points = take_word(&b), faces = take_word(&b);
    take_word(&b); /* edges */
    size_t words = words_left(&b);
    if (points > words / 3 || faces > (words - 3 * points) / FACE_WORDS)
        return false;
    if (!take_points(&b, points, m))
        return false;
    for (size_t i = 0; i < faces; i++)
        if (!take_face(&b, m))
            return false;
    return b.at == b.end;
}

const char *off_parse_binary(const uint8_t *bytes, size_t n, struct mesh *m)
{
    static const struct layout layouts[] = {
        {.big_endian = true, .colours = true},
        {.big_endian = false, .colours = false},
        {.big_endian = false, .colours = true},
        {.big_endian = true, .colours = false},
    };
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        if (take_mesh((struct bytes){bytes, bytes + n, layouts[i]}, m))
            return NULL;
    return "this binary OFF file is damaged or ends early";
}
