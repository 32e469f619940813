/* Surfaces that no ray can meet: the camera does not see them, and they are not between what it
 * sees and a light.  Where it sees what mirrors or refracts, rays may go anywhere. */
#include "config.h"

#include "render/tracer.h"

/* Where a surface is, and where shadow rays from it start, which smooth ones lift off the faces:
 * see surface_lift, which moves a point by no more than its triangle is long. */
struct extent {
    struct box box, starts;
    bool seen;
};

static struct extent extent_of(const struct tracer *t, const struct surface *s)
{
    const struct geometry *g = &t->scene->geometry;
    struct extent e = {box_empty(), box_empty(), false};
    double longest = 0;
    for (uint32_t i = s->first_prim; i < s->first_prim + s->prim_count; i++) {
        struct box b = geometry_prim_bounds(g, i);
        e.box = box_join(e.box, b);
        longest = fmax(longest, vec3_length(vec3_sub(b.hi, b.lo)));
    }
    struct vec3 lift = vec3_all(s->normals ? longest : 0);
    e.starts = (struct box){vec3_sub(e.box.lo, lift), vec3_add(e.box.hi, lift)};
    return e;
}

/* All rays of the picture, which its corners' enclose; larger by more than they are rounded. */
static struct shaft shaft_of_view(const struct tracer *t, const struct accel *outline)
{
    const struct lens *l = &t->lens;
    struct box origins = box_empty(), directions = box_empty();
    for (int corner = 0; corner < 4; corner++) {
        double x = corner & 1 ? 1 : -1, y = corner & 2 ? 1 : -1;
        struct vec3 d = vec3_mad(vec3_mad(l->ahead, x, l->across), y, l->upwards);
        if (l->mirrored)
            d.z = -d.z;
        origins = box_add(origins, lens_origin(l, x, y));
        directions = box_add(directions, l->parallel ? l->ahead : d);
    }
    double reach = fmax(vec3_largest(directions.lo), vec3_largest(directions.hi));
    struct vec3 slack = vec3_all(0x1p-30 * reach);
    directions = (struct box){vec3_sub(directions.lo, slack), vec3_add(directions.hi, slack)};
    return shaft_of_rays(outline, origins, directions);
}

/* Boxes in which shadow rays start, a few together where there are many. */
struct starts {
    uint32_t n;
    struct box box[16];
};

static void add_start(struct starts *starts, struct box box)
{
    enum { ROOM = sizeof starts->box / sizeof *starts->box };
    if (starts->n < ROOM)
        starts->box[starts->n++] = box;
    else
        starts->box[ROOM - 1] = box_join(starts->box[ROOM - 1], box);
}

/* What the camera sees; false when that sends rays on. */
static bool see_surfaces(const struct tracer *t, const struct accel *outline, struct extent *extent,
                         struct starts *starts)
{
    struct shaft view = shaft_of_view(t, outline);
    starts->n = 0;
    for (size_t i = 0; i < t->scene->surfaces.n; i++) {
        extent[i].seen = shaft_touches_box(&view, extent[i].box);
        if (!extent[i].seen)
            continue;
        if (t->finishes[t->scene->surfaces.at[i].material].bounces)
            return false;
        add_start(starts, extent[i].starts);
    }
    return true;
}

/* Takes what may stand before the lamp for seen; false when that may be anything. */
static bool shadow_surfaces(const struct tracer *t, const struct accel *outline,
                            const struct lamp *lamp, const struct starts *starts,
                            struct extent *extent)
{
    struct shaft shaft;
    for (uint32_t k = 0; k < starts->n; k++) {
        if (!shaft_to_lamp(outline, lamp, starts->box[k], &shaft))
            return false;
        for (size_t i = 0; i < t->scene->surfaces.n; i++)
            extent[i].seen = extent[i].seen || shaft_touches_box(&shaft, extent[i].box);
    }
    return true;
}

static uint32_t note_unseen(const struct scene *scene, const struct extent *extent, bool *unseen)
{
    uint32_t count = 0;
    for (size_t i = 0; i < scene->surfaces.n; i++) {
        const struct surface *s = &scene->surfaces.at[i];
        count += !extent[i].seen;
        for (uint32_t k = 0; k < s->prim_count && !extent[i].seen; k++)
            unseen[s->first_prim + k] = true;
    }
    return count;
}

uint32_t find_unseen(const struct tracer *t, bool *unseen)
{
    enum { TESTS_LIMIT = 200000 }; /* a few milliseconds */
    const struct scene *scene = t->scene;
    struct starts starts;
    double reach = 0;
    if (scene->surfaces.n < 2 || scene->lights.n > TESTS_LIMIT / scene->surfaces.n)
        return 0;
    struct extent *extent = mem_alloc(scene->surfaces.n, sizeof *extent);
    for (size_t i = 0; i < scene->surfaces.n; i++) {
        extent[i] = extent_of(t, &scene->surfaces.at[i]);
        reach = fmax(reach, fmax(vec3_largest(extent[i].box.lo), vec3_largest(extent[i].box.hi)));
    }
    struct accel outline = accel_outline(&scene->geometry, reach);
    bool told = see_surfaces(t, &outline, extent, &starts);
    for (size_t i = 0; i < scene->lights.n && told; i++)
        if (!t->lamps[i].dark)
            told = shadow_surfaces(t, &outline, &t->lamps[i], &starts, extent);
    uint32_t count = told ? note_unseen(scene, extent, unseen) : 0;
    free(extent);
    return count;
}
