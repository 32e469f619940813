/* The pairs of one IndexedFaceSet. */
#include "config.h"

#include "convert/wrl.h"

/* Up to the -1 or the end of the list. */
static size_t face_length(const struct wrl_indexes *x, size_t begin)
{
    size_t i = begin;
    while (i < x->list.n && x->list.at[i].value != WRL_FACE_END)
        i++;
    return i - begin;
}

/* The item's place; behind the last one for one that is missing. */
static struct span place_of(const struct wrl *w, const struct wrl_indexes *x, size_t i)
{
    uint32_t at = x->list.at[i < x->list.n ? i : x->list.n - 1].at, end = at;
    const char *text = w->source->text - w->source->base;
    while (text[end] == '-' || (text[end] >= '0' && text[end] <= '9'))
        end++;
    return i < x->list.n ? (struct span){at, end} : (struct span){end, end};
}

static bool check_corners(struct wrl *w, const struct wrl_indexes *x, size_t begin, size_t n,
                          const struct wrl_points *points)
{
    size_t pairs = points ? points->numbers.n / 2 : SIZE_MAX;
    bool right = true;
    if (n < 3) {
        diag_report(w->diag, DIAG_MESH_SYNTAX, place_of(w, x, begin),
                    "a face has at least 3 corners, not %zu", n);
        return false;
    }
    for (size_t i = begin; i < begin + n; i++) {
        int32_t value = x->list.at[i].value;
        right = right && value != WRL_WRONG_INDEX;
        if (value == WRL_WRONG_INDEX || (size_t)value < pairs)
            continue;
        struct diag_entry *e = diag_report(w->diag, DIAG_MESH_INDEX, place_of(w, x, i),
                                           "there is no texture coordinate %d", value);
        if (pairs)
            diag_note(e, "the texCoord has %zu, numbered from 0 to %zu", pairs, pairs - 1);
        else
            diag_note(e, "the texCoord has none");
        right = false;
    }
    return right;
}

/* The points are the set's, or NULL. */
static bool write_pair(struct wrl *w, const struct wrl_points *points, struct wrl_index corner)
{
    struct span place = {corner.at, corner.at + 1};
    if (!points)
        return wrl_write(w, place, str_of("0 0\n"));
    const struct span *pair = &points->numbers.at[2 * (size_t)corner.value];
    return wrl_write(w, place, srcmap_text(w->diag->sources, pair[0])) &&
           wrl_write(w, place, str_of(" ")) &&
           wrl_write(w, place, srcmap_text(w->diag->sources, pair[1])) &&
           wrl_write(w, place, str_of("\n"));
}

/* As the faces of mesh files are split: a fan around the first corner. */
static bool write_fan(struct wrl *w, const struct wrl_points *points,
                      const struct wrl_index *corners, size_t n)
{
    bool fits = true;
    for (size_t i = 2; fits && i < n; i++)
        fits = write_pair(w, points, corners[0]) && write_pair(w, points, corners[i - 1]) &&
               write_pair(w, points, corners[i]);
    return fits;
}

static bool check_length(struct wrl *w, const struct wrl_indexes *x, size_t begin, size_t n,
                         size_t wanted)
{
    if (n == wanted)
        return true;
    diag_report(w->diag, DIAG_MESH_SYNTAX, place_of(w, x, begin),
                "the face has %zu corners in coordIndex, but %zu in texCoordIndex", wanted, n);
    return false;
}

void wrl_add_faces(struct wrl *w, const struct wrl_node *set)
{
    const struct wrl_indexes *faces = &set->coord_index, *corners = &set->texcoord_index;
    if (!corners->list.n || !set->points) /* the standard's rule: coordIndex serves for both */
        corners = faces;
    if (!faces->list.n)
        faces = corners;
    for (size_t i = 0, j = 0; i < faces->list.n;) {
        size_t n = face_length(faces, i), m = face_length(corners, j);
        if (!check_length(w, corners, j, m, n))
            return;
        if (n && check_corners(w, corners, j, n, set->points) &&
            !write_fan(w, set->points, corners->list.at + j, n))
            return;
        i += n + 1;
        j += n + 1;
    }
}
