#include "config.h"

#include "image/codec.h"
#include "math/angle.h"
#include "math/rng.h"
#include "math/srgb_bytes.h"
#include "render/tracer.h"
#include "unit.h"

#include <string.h>

/* Numbers from 0 to 1 by position in the run. */
static double random_at(uint64_t run, uint64_t i, uint64_t what)
{
    return rng_uniform(7, run, i, what);
}

static struct vec3 random_vec3(uint64_t run, uint64_t i, uint64_t what)
{
    return vec3(2 * random_at(run, i, what) - 1, 2 * random_at(run, i, what + 1) - 1,
                2 * random_at(run, i, what + 2) - 1);
}

static void check_same_numbers(const double *a, const double *b, uint32_t n)
{
    ck_assert_int_eq(memcmp(a, b, n * sizeof *a), 0);
}

static void check_same_vectors(const struct vec3_batch *a, const struct vec3_batch *b, uint32_t n)
{
    check_same_numbers(a->x, b->x, n);
    check_same_numbers(a->y, b->y, n);
    check_same_numbers(a->z, b->z, n);
}

/* ---- rays against lists ------------------------------------------------------------------------
 */

/* Spheres, cylinders, two triangles of one plane that share an edge, and a triangle without area.
 */
static void make_geometry(struct geometry *g, uint64_t run)
{
    geometry_add_sphere(g, 0, random_vec3(run, 0, 0), 0.5);
    geometry_add_sphere(g, 1, vec3(0, 0, 0), 0.25);
    geometry_add_sphere(g, 2, vec3(0, 0, 0), 0.25); /* ties go to the one before */
    geometry_add_cylinder(g, 3, vec3(0, -1, 0), vec3(0, 1, 0), 0.3);
    geometry_add_cylinder(g, 4, random_vec3(run, 1, 0), random_vec3(run, 2, 0), 0.2);
    uint32_t v[4];
    for (int i = 0; i < 4; i++)
        v[i] = geometry_add_vertex(g, vec3(i & 1 ? 1 : -1, -0.5, i & 2 ? 1 : -1));
    geometry_add_triangle(g, 5, v[0], v[1], v[3]);
    geometry_add_triangle(g, 5, v[3], v[2], v[0]);
    geometry_add_triangle(g, 6, v[0], v[1], v[1]);
    for (uint64_t i = 0; i < 3; i++)
        v[i] = geometry_add_vertex(g, random_vec3(run, 3 + i, 0));
    geometry_add_triangle(g, 7, v[0], v[1], v[2]);
}

/* Directions of every kind: anywhere, along axes, along diagonals, in the triangles' plane,
 * nowhere, and no numbers. */
static struct vec3 direction_at(uint64_t run, uint32_t i)
{
    struct vec3 d = random_vec3(run, i, 20);
    switch (i % 8) {
    case 1:
        return vec3(0, -1, 0);
    case 2:
        return vec3(1, 0, 0);
    case 3:
        return vec3(1, 0, 1);
    case 4:
        return vec3(d.x, 0, d.z);
    case 5:
        return vec3(-0.0, d.y, 1e-300);
    case 6:
        return i == 6 ? vec3_all(0) : i == 14 ? vec3_all(NAN) : d;
    default:
        return d;
    }
}

/* run & 1: rays spawned on primitives; run & 2: all from one point; run & 4: not whole vectors. */
static void make_rays(struct ray_batch *rays, uint64_t run)
{
    memset(rays, 0, sizeof *rays);
    rays->n = run & 4 ? 61 : BATCH;
    rays->spawned = run & 1;
    rays->common_origin = run & 2;
    for (uint32_t i = 0; i < rays->n; i++) {
        struct vec3 o = i % 3 == 0 ? vec3(0, 2, 0) : random_vec3(run, i, 30);
        if (rays->spawned && i % 3 == 1)
            o.y = -0.5;
        if (rays->spawned && i % 3 == 2)
            o = vec3_scale(vec3_normalize(o), 0.25);
        vec3_put(&rays->origin, i, rays->common_origin ? vec3(0.1, -0.5, 0.2) : o);
        vec3_put(&rays->direction, i, direction_at(run, i));
        rays->t_max[i] = i % 5 == 0 ? 0.75 : RAY_UNBOUNDED;
        rays->from[i] = rays->spawned && i % 3 == 1 ? 5 : PRIM_NONE;
    }
}

START_TEST(bundles_meet_what_single_rays_meet)
{
    struct geometry g = {0};
    struct ray_batch rays;
    struct hit_batch expected, hits;
    struct target_list list = {.usable = true};
    uint64_t run = (uint64_t)_i;
    make_geometry(&g, run);
    make_rays(&rays, run);
    list.n = (uint32_t)g.prims.n;
    for (uint32_t i = 0; i < list.n; i++)
        list.at[i] = target_of(&g, i);
    bundle_plain.closest(&g, &rays, &list, &expected);
    for (int isa = ISA_GENERIC; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        const struct bundle_kernels *kernels = bundle_kernels_of((enum isa)isa);
        kernels->closest(&g, &rays, &list, &hits);
        for (uint32_t i = 0; i < rays.n; i++) {
            ck_assert(hits.prim[i] == expected.prim[i]);
            if (hits.prim[i] == PRIM_NONE)
                continue;
            ck_assert(hits.t[i] == expected.t[i]);
            ck_assert(hits.part[i] == expected.part[i]);
        }
        uint64_t blocked = kernels->any(&g, &rays, &list);
        for (uint32_t i = 0; i < rays.n; i++)
            ck_assert((blocked >> i & 1) == (expected.prim[i] != PRIM_NONE));
    }
    geometry_free(&g);
}
END_TEST

/* ---- textures ----------------------------------------------------------------------------------
 */

static double coordinate_at(uint64_t run, uint32_t i, uint64_t what)
{
    static const double strange[] = {0,    1,        -1,        0.5, -0.0,           1e18, -1e18,
                                     -0.2, INFINITY, -INFINITY, NAN, 2.999999999999, -7,   0x1p50};
    enum { STRANGE = sizeof strange / sizeof *strange };
    double x = random_at(run, i, what);
    return i % 3 == 0 ? strange[(size_t)(x * STRANGE)] : 8 * (x - 0.5);
}

/* All over the turn, along axes and diagonals, and beside these. */
START_TEST(angles_are_those_of_the_c_library)
{
    for (int i = 0; i < 4096; i++) {
        double a = 2 * PI * i / 4096, r = ldexp(1, i % 7 - 3), x = r * cos(a), y = r * sin(a);
        if (i % 512 == 0) {
            x = (double)lround(x / r * 1.4);
            y = (double)lround(y / r * 1.4);
        } else if (i % 512 == 1) {
            x = nextafter(y, 9);
        }
        long double expected = atan2l(y, x), turn = 4 * acosl(0);
        expected = expected < 0 ? expected + turn : expected;
        ck_assert_msg(fabsl(angle_of(x, y) - expected) < 0x1p-49L, "(%a, %a)", x, y);
    }
    ck_assert(angle_of(1, 0) == 0 && angle_of(-1, 0) == PI && angle_of(0, 1) == PI / 2);
    ck_assert(angle_of(0, -1) == 3 * (PI / 2) && angle_of(1, -0x1p-60) == 2 * PI);
}
END_TEST

/* Bit 0: not whole vectors. */
START_TEST(coordinates_on_spheres_are_those_of_single_points)
{
    uint64_t run = (uint64_t)_i;
    struct sphere sphere = {.center = random_vec3(run, 0, 20), .radius = 0.7};
    struct vec3_batch points;
    uint32_t n = run & 1 ? 21 : BATCH, first = (uint32_t)run;
    for (uint32_t i = 0; i < BATCH_ROOM; i++) {
        struct vec3 d = vec3_normalize(random_vec3(run, i, 0));
        d = i % 5 == 1 ? vec3(0, i % 2 ? 1 : -1, 0) : i % 5 == 2 ? vec3(d.x, 0, 0) : d;
        vec3_put(&points, i, vec3_mad(sphere.center, sphere.radius, d));
    }
    double u[BATCH_ROOM], v[BATCH_ROOM], expected_u[BATCH_ROOM], expected_v[BATCH_ROOM];
    render_plain.sphere_uv(&sphere, &points, first, n, expected_u, expected_v);
    for (uint32_t i = first; i < n; i++) {
        struct vec2 uv = sphere_uv(&sphere, vec3_get(&points, i));
        ck_assert(uv.x == expected_u[i - first] && uv.y == expected_v[i - first]);
        ck_assert(uv.x >= 0 && uv.x <= 1 && uv.y >= -1 && uv.y <= 0);
    }
    for (int isa = ISA_GENERIC; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        render_kernels_of((enum isa)isa)->sphere_uv(&sphere, &points, first, n, u, v);
        check_same_numbers(u, expected_u, n - first);
        check_same_numbers(v, expected_v, n - first);
    }
}
END_TEST

/* Bit 0: 16 bits a channel; bit 1: nearest; bit 2: not whole vectors; bit 3: modern; bit 4:
 * decoded. */
START_TEST(texels_are_those_of_single_places)
{
    uint64_t run = (uint64_t)_i;
    struct image *image = image_new(7, 5, run & 1 ? 16 : 8);
    for (uint32_t i = 0; i < 3 * 7 * 5; i++) {
        if (image->data8)
            image->data8[i] = (uint8_t)(37 * i);
        else
            image->data16[i] = (uint16_t)(9973 * i);
    }
    double *decode = mem_alloc(65536, sizeof *decode);
    for (uint32_t i = 0; i < 65536; i++)
        decode[i] = sqrt(i);
    struct texture texture = {.image = image,
                              .linear = !(run & 2),
                              .centred = run & 8,
                              .decode = run & 16 ? decode : NULL};
    double u[BATCH_ROOM] = {0}, v[BATCH_ROOM] = {0};
    uint32_t first = run & 4 ? 5 : 0, end = run & 4 ? 18 : BATCH;
    struct vec3_batch expected = {{0}, {0}, {0}}, texels = expected;
    for (uint32_t i = 0; i < end; i++) {
        u[i] = coordinate_at(run, i, 0);
        v[i] = coordinate_at(run, i, 1);
    }
    render_plain.texels(&texture, u, v, first, end, &expected);
    for (int isa = ISA_GENERIC; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        render_kernels_of((enum isa)isa)->texels(&texture, u, v, first, end, &texels);
        check_same_vectors(&texels, &expected, end);
    }
    free(decode);
    image_free(image);
}
END_TEST

/* ---- the rest ----------------------------------------------------------------------------------
 */

START_TEST(bounds_hold_all_points)
{
    struct vec3_batch points;
    for (uint32_t i = 0; i < BATCH_ROOM; i++)
        vec3_put(&points, i, i % 9 == 4 ? vec3(NAN, i, NAN) : random_vec3(1, i, 0));
    for (uint32_t n = 1; n <= BATCH; n++) {
        struct box expected = render_plain.bounds(&points, n);
        for (int isa = ISA_GENERIC; isa < ISA_COUNT; isa++) {
            if (!isa_available((enum isa)isa))
                continue;
            struct box b = render_kernels_of((enum isa)isa)->bounds(&points, n);
            ck_assert_int_eq(memcmp(&b, &expected, sizeof b), 0);
        }
    }
}
END_TEST

/* ---- light of model modern ---------------------------------------------------------------------
 */

static struct vec3 unit_at(uint64_t run, uint32_t i, uint64_t what)
{
    return vec3_normalize(random_vec3(run, i, what));
}

/* Points with all kinds of normals; every third has a highlight that is no whole power. */
static void make_points(struct shade_batch *points, struct vec3_batch *incoming,
                        const struct finish finishes[3], uint64_t run)
{
    memset(points, 0, sizeof *points);
    memset(incoming, 0, sizeof *incoming);
    points->incoming = incoming;
    points->n = run % 2 ? 13 : BATCH;
    points->any_uneven = points->curved = true;
    for (uint32_t i = 0; i < points->n; i++) {
        struct vec3 normal = unit_at(run, i, 1);
        vec3_put(&points->p, i, random_vec3(run, i, 2));
        vec3_put(incoming, i, unit_at(run, i, 3));
        vec3_put(&points->normal, i, normal);
        vec3_put(&points->geometric, i, i % 4 ? normal : unit_at(run, i, 4));
        vec3_put(&points->smooth, i, i % 5 ? normal : unit_at(run, i, 5));
        vec3_put(&points->diffuse, i, random_vec3(run, i, 6));
        points->finish[i] = &finishes[i % 3];
        points->power[i] = finishes[i % 3].power;
        vec3_put(&points->specular, i, finishes[i % 3].specular);
    }
}

/* Bit 1: a sun; bits 2 and 3: a light on both sides, one that weakens. */
START_TEST(modern_light_is_that_of_single_points)
{
    static const struct material materials[3] = {
        {.kind = MATERIAL_PHONG, .specular = {0.5, 0.4, 0.3}, .exponent = 7},
        {.kind = MATERIAL_PHONG, .specular = {0.5, 0.4, 0.3}, .exponent = 2.5},
        {.kind = MATERIAL_EMISSIVE}};
    struct finish finishes[3];
    uint64_t run = (uint64_t)_i;
    for (int i = 0; i < 3; i++)
        finishes[i] = finish_of(&materials[i]);
    struct shade_batch *points = mem_alloc_aligned(1, sizeof *points);
    struct vec3_batch incoming;
    make_points(points, &incoming, finishes, run);
    points->any_glowing = true;
    struct light light = {.kind = run & 2 ? LIGHT_SUN : LIGHT_POINT,
                          .position = unit_at(run, 0, 7),
                          .intensity = {1, 2, 3},
                          .both_sides = run & 4,
                          .inverse_square = run & 8};
    struct lamp lamp = {.light = &light};
    struct sample_batch samples = {.n = 21};
    for (uint32_t i = 0; i < samples.n; i++)
        sample_batch_put(&samples, i,
                         &(struct light_sample){random_vec3(run, i, 8), unit_at(run, i, 9), 0.1});
    double shares[BATCH_ROOM] = {0};
    for (uint32_t i = 0; i < points->n; i++)
        shares[i] = i % 7 != 3;
    struct vec3_batch one_by_one = {0};
    struct light_batch expected = {.direct = &one_by_one};
    render_plain.add_modern(points, &light, shares, &expected);
    for (int isa = ISA_GENERIC; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        const struct render_kernels *kernels = render_kernels_of((enum isa)isa);
        struct vec3_batch direct = {0};
        struct light_batch sums = {.direct = &direct};
        kernels->add_modern(points, &light, shares, &sums);
        check_same_vectors(&direct, &one_by_one, points->n);
        uint64_t front = kernels->front(points, &lamp);
        for (uint32_t i = 0; i < points->n; i++) {
            struct vec3_batch gives, alone;
            bool lit = !vec3_is_zero(vec3_get(&direct, i));
            ck_assert(!lit || front >> i & 1);
            kernels->give(points, i, &light, &samples, &gives);
            render_plain.give(points, i, &light, &samples, &alone);
            check_same_vectors(&gives, &alone, samples.n);
        }
    }
    free(points);
}
END_TEST

/* No sample within a ball gives light to a point that does not face the ball. */
START_TEST(who_faces_away_gets_no_light)
{
    static const struct material matt = {.kind = MATERIAL_LAMBERT};
    struct finish finishes[3] = {finish_of(&matt), finish_of(&matt), finish_of(&matt)};
    uint64_t run = (uint64_t)_i, away = 0;
    struct shade_batch *points = mem_alloc_aligned(1, sizeof *points);
    struct vec3_batch incoming;
    make_points(points, &incoming, finishes, run);
    struct light light = {.kind = LIGHT_AREA, .intensity = {1, 1, 1}, .both_sides = true};
    struct lamp lamp = {.light = &light, .center = random_vec3(run, 0, 10), .radius = 0.3};
    struct sample_batch samples = {.n = BATCH};
    for (uint32_t i = 0; i < samples.n; i++)
        sample_batch_put(&samples, i,
                         &(struct light_sample){vec3_mad(lamp.center, 0.3, unit_at(run, i, 8)),
                                                unit_at(run, i, 9), 0.1});
    for (int isa = ISA_PLAIN; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        uint64_t front = render_kernels_of((enum isa)isa)->front(points, &lamp);
        for (uint32_t i = 0; i < points->n; i++) {
            struct vec3_batch gives;
            if (front >> i & 1)
                continue;
            away++;
            render_plain.give(points, i, &light, &samples, &gives);
            for (uint32_t k = 0; k < samples.n; k++)
                ck_assert(vec3_is_zero(vec3_get(&gives, k)));
        }
    }
    ck_assert_uint_gt(away, 0);
    free(points);
}
END_TEST

/* ---- points on primitives ----------------------------------------------------------------------
 */

/* Every second of a row of triangles is smooth, every third flipped; some corners have no normal.
 * They start at vertex 7, and those of one surface have normals by face. */
static void make_surfaces(struct scene *s, uint64_t run, struct vec3 *normals,
                          struct triangle_corners *corners)
{
    struct geometry *g = &s->geometry;
    make_geometry(g, run);
    for (uint32_t i = 0; i <= 8; i++)
        vec_push(&s->surfaces, (struct surface){.normal_map = TEXTURE_NONE});
    struct surface mesh = {
        .first_prim = (uint32_t)g->prims.n, .first_vertex = 7, .normal_map = TEXTURE_NONE};
    for (uint32_t i = 0; i < 30; i++) {
        geometry_add_vertex(g, random_vec3(run, 60 + i, 0));
        normals[i] = i % 7 ? vec3_normalize(random_vec3(run, 90 + i, 0)) : vec3_all(0);
        corners[i] = (struct triangle_corners){{i, 29 - i, 0}};
    }
    for (uint32_t i = 0; i < 3; i++) {
        mesh.normals = i ? normals : NULL;
        mesh.normal_corners = i == 2 ? corners : NULL;
        mesh.flip = i != 1;
        mesh.first_prim = (uint32_t)g->prims.n;
        for (uint32_t k = 0; k < 10; k++)
            geometry_add_triangle(g, (uint32_t)s->surfaces.n, 7 + 3 * i + k, 8 + k, 36 - k);
        vec_push(&s->surfaces, mesh);
    }
}

/* Rays that lead to places on primitives, some of them to corners, or to edges from afar. */
static void make_hits(const struct scene *s, uint64_t run, struct hit_shapes *shapes,
                      struct shade_batch *points, struct picked *picked)
{
    const struct geometry *g = &s->geometry;
    uint32_t n = 0;
    shapes->origin = &picked->origin;
    shapes->part = picked->part;
    points->incoming = &picked->incoming;
    points->t = picked->t;
    for (unsigned kind = 0; kind < PRIM_INSTANCE; kind++) {
        shapes->first[kind] = n;
        for (uint32_t i = 0; i < 20 && n < BATCH - run % 5; i++, n++) {
            uint32_t prim = (uint32_t)(random_at(run, n, 40) * (double)g->prims.n);
            while (g->prims.at[prim].kind != kind)
                prim = (prim + 1) % (uint32_t)g->prims.n;
            points->prim[n] = run % 3 && n > shapes->first[kind] ? points->prim[n - 1] : prim;
        }
    }
    points->n = shapes->first[PRIM_INSTANCE] = shapes->first[PRIM_KINDS] = n;
    for (uint32_t k = 0; k < n; k++) {
        struct prim prim = g->prims.at[points->prim[k]];
        struct vec3 from = random_vec3(run, k, 30), to = random_vec3(run, k, 33);
        if (prim.kind == PRIM_TRIANGLE) {
            const uint32_t *v = g->triangles.at[prim.index].vertex;
            double b = k % 4 ? random_at(run, k, 36) / 2 : 0,
                   c = k % 3 ? random_at(run, k, 37) / 2 : 0;
            to = vec3_scale(g->vertices.at[v[0]], 1 - b - c);
            to = vec3_mad(vec3_mad(to, b, g->vertices.at[v[1]]), c, g->vertices.at[v[2]]);
            from = k % 8 ? from : vec3_scale(from, 1e9);
        }
        points->surface[k] = prim.surface;
        shapes->index[k] = prim.index;
        picked->part[k] = k % 3;
        picked->t[k] = vec3_length(vec3_sub(to, from));
        vec3_put(&picked->origin, k, from);
        vec3_put(&picked->incoming, k, vec3_normalize(vec3_sub(to, from)));
    }
}

START_TEST(points_lie_where_single_ones_do)
{
    uint64_t run = (uint64_t)_i;
    struct scene s = {0};
    struct vec3 normals[30];
    struct triangle_corners corners[30];
    struct hit_shapes *shapes = mem_alloc_aligned(1, sizeof *shapes);
    struct picked *picked = mem_alloc_aligned(1, sizeof *picked);
    struct shade_batch *expected = mem_alloc_aligned(2, sizeof *expected), *points = expected + 1;
    memset(shapes, 0, sizeof *shapes);
    memset(picked, 0, sizeof *picked);
    memset(expected, 0, sizeof *expected);
    make_surfaces(&s, run, normals, corners);
    make_hits(&s, run, shapes, expected, picked);
    shapes->weighted = shapes->bent = true;
    expected->curved = run % 2;
    *points = *expected;
    render_plain.hit_points(&s, shapes, expected);
    for (int isa = ISA_GENERIC; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        uint32_t n = points->n, first = shapes->first[PRIM_TRIANGLE];
        render_kernels_of((enum isa)isa)->hit_points(&s, shapes, points);
        check_same_vectors(&points->p, &expected->p, n);
        check_same_vectors(&points->normal, &expected->normal, n);
        for (uint32_t k = first; k < n; k++)
            if (surface_interpolates(&s.surfaces.at[points->surface[k]]))
                ck_assert(points->b1[k] == expected->b1[k] && points->b2[k] == expected->b2[k]);
        if (!points->curved)
            continue;
        check_same_vectors(&points->geometric, &expected->geometric, n);
        check_same_vectors(&points->lifted, &expected->lifted, n);
    }
    free(expected);
    free(picked);
    free(shapes);
    vec_free(&s.surfaces);
    geometry_free(&s.geometry);
}
END_TEST

/* A channel from below black to beyond white, often on the very edge of a byte. */
static double channel_at(const struct picture *p, uint64_t run, uint32_t i)
{
    static const double special[] = {-1, -0.0, 0x1p-1074, 0x1p-13, 1, 2, INFINITY, -INFINITY, NAN};
    uint32_t byte = (uint32_t)(256 * random_at(run, i, 0));
    double light = p->srgb ? p->srgb->from[byte] : (byte + 1 - picture_rounding(p)) / 255;
    if (i % 8 == 0)
        return special[i / 8 % (sizeof special / sizeof *special)];
    return i % 4 == 1 ? light : i % 4 == 2 ? nextafter(light, 0) : random_at(run, i, 1);
}

/* As picture_set stores them, in the middle of a row; bit 2: brighter. */
START_TEST(packed_pixels_are_those_of_single_colours)
{
    struct vec3_batch colours;
    struct picture *p = picture_new(BATCH + 2, 1, PICTURE_BYTES);
    struct picture *q = picture_new(BATCH + 2, 1, PICTURE_BYTES);
    picture_encode_as(p, (enum picture_encoding)(_i % 3));
    picture_encode_as(q, p->encoding);
    p->gain = q->gain = _i / 3 % 2 ? 1.7 : 1;
    for (uint32_t i = 0; i < BATCH_ROOM; i++)
        vec3_put(&colours, i,
                 vec3(channel_at(p, (uint64_t)_i, i), channel_at(p, 100 + (uint64_t)_i, i + 1),
                      channel_at(p, 200 + (uint64_t)_i, i + 2)));
    for (uint32_t i = 0; i < BATCH; i++)
        picture_set(p, 1 + i, 0, vec3_get(&colours, i));
    for (int isa = ISA_PLAIN; isa < ISA_COUNT; isa++) {
        uint8_t pixels[PACKED_ROOM];
        if (!isa_available((enum isa)isa))
            continue;
        memset(q->bytes, 0, 3 * (BATCH + 2));
        render_kernels_of((enum isa)isa)->pack(q, &colours, BATCH, pixels);
        uint32_t part = 1 + (uint32_t)_i % 9;
        picture_set_row(q, 1, 0, pixels, part);
        ck_assert_int_eq(q->bytes[3 * (1 + part)], 0);
        picture_set_row(q, 1 + part, 0, pixels + 3 * part, BATCH - part);
        ck_assert_int_eq(memcmp(p->bytes, q->bytes, 3 * (BATCH + 2)), 0);
    }
    picture_free(p);
    picture_free(q);
}
END_TEST

START_TEST(weights_that_are_nothing_are_told)
{
    struct vec3_batch intensity, weight, expected;
    uint32_t n = 1 + 7 * (uint32_t)_i;
    for (uint32_t i = 0; i < BATCH_ROOM; i++)
        vec3_put(&intensity, i,
                 i % 5 == 2 ? vec3(0, 1, 0) : vec3_scale(random_vec3(4, i, 0), i % 3));
    uint64_t some = render_plain.weigh(&intensity, vec3(1, 0, 0.5), n, &expected);
    for (uint32_t i = 0; i < n; i++)
        ck_assert((some >> i & 1) == (i % 5 != 2 && i % 3 != 0));
    for (int isa = ISA_GENERIC; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        ck_assert(
            render_kernels_of((enum isa)isa)->weigh(&intensity, vec3(1, 0, 0.5), n, &weight) ==
            some);
        check_same_vectors(&weight, &expected, n);
    }
}
END_TEST

START_TEST(rays_through_a_grid_are_those_of_single_places)
{
    struct lens lens = {.ahead = random_vec3(1, 0, 0),
                        .across = random_vec3(1, 1, 0),
                        .upwards = random_vec3(1, 2, 0),
                        .mirrored = _i % 2};
    uint32_t width = 1 + (uint32_t)_i % 8, height = 1 + 3 * (uint32_t)_i % 8;
    double x[BATCH_ROOM], y[BATCH_ROOM], columns[BATCH_ROOM], rows[BATCH_ROOM];
    struct vec3_batch expected, directions;
    for (uint32_t i = 0; i < BATCH_ROOM; i++) {
        columns[i] = random_at(2, i, 0);
        rows[i] = random_at(3, i, 0);
        x[i] = random_at(2, i % width, 0);
        y[i] = random_at(3, i / width, 0);
    }
    render_plain.aim(&lens, x, y, width * height, &expected);
    for (int isa = ISA_PLAIN; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        const struct render_kernels *kernels = render_kernels_of((enum isa)isa);
        kernels->aim_grid(&lens, columns, width, rows, height, &directions);
        check_same_vectors(&directions, &expected, width * height);
        kernels->aim(&lens, x, y, width * height, &directions);
        check_same_vectors(&directions, &expected, width * height);
    }
}
END_TEST

START_TEST(rays_to_lights_are_those_of_single_points)
{
    struct light light = {.kind = _i ? LIGHT_SUN : LIGHT_POINT, .position = random_vec3(5, 0, 0)};
    struct vec3_batch points;
    uint32_t prims[BATCH_ROOM];
    struct ray_batch expected, rays;
    for (uint32_t i = 0; i < BATCH_ROOM; i++) {
        vec3_put(&points, i, random_vec3(6, i, 0));
        prims[i] = GEOMETRY_LIMIT - 1 - 17 * i;
    }
    render_plain.aim_at(&light, &points, prims, 0.75, BATCH, &expected);
    for (int isa = ISA_GENERIC; isa < ISA_COUNT; isa++) {
        if (!isa_available((enum isa)isa))
            continue;
        render_kernels_of((enum isa)isa)->aim_at(&light, &points, prims, 0.75, BATCH, &rays);
        check_same_vectors(&rays.origin, &expected.origin, BATCH);
        check_same_vectors(&rays.direction, &expected.direction, BATCH);
        for (uint32_t i = 0; i < BATCH; i++)
            ck_assert(rays.from[i] == prims[i] && rays.t_max[i] == 0.75);
    }
}
END_TEST

START_TEST(instruction_sets_have_names)
{
    for (int i = 0; i < ISA_COUNT; i++) {
        enum isa isa;
        ck_assert(isa_of_name(str_of(isa_name((enum isa)i)), &isa) && isa == (enum isa)i);
    }
    enum isa isa;
    ck_assert(!isa_of_name(str_of("mmx"), &isa));
    ck_assert(isa_available(ISA_PLAIN) && isa_available(ISA_GENERIC) && isa_available(isa_best()));
}
END_TEST

Suite *kernels_suite(void)
{
    Suite *s = suite_create("kernels");
    TCase *c = tcase_create("kernels");
    tcase_add_loop_test(c, bundles_meet_what_single_rays_meet, 0, 64);
    tcase_add_test(c, angles_are_those_of_the_c_library);
    tcase_add_loop_test(c, coordinates_on_spheres_are_those_of_single_points, 0, 8);
    tcase_add_loop_test(c, texels_are_those_of_single_places, 0, 32);
    tcase_add_test(c, bounds_hold_all_points);
    tcase_add_loop_test(c, modern_light_is_that_of_single_points, 0, 16);
    tcase_add_loop_test(c, who_faces_away_gets_no_light, 0, 16);
    tcase_add_loop_test(c, points_lie_where_single_ones_do, 0, 30);
    tcase_add_loop_test(c, packed_pixels_are_those_of_single_colours, 0, 18);
    tcase_add_loop_test(c, weights_that_are_nothing_are_told, 0, 10);
    tcase_add_loop_test(c, rays_through_a_grid_are_those_of_single_places, 0, 16);
    tcase_add_loop_test(c, rays_to_lights_are_those_of_single_points, 0, 2);
    tcase_add_test(c, instruction_sets_have_names);
    suite_add_tcase(s, c);
    return s;
}
