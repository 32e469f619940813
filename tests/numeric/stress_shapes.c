#include "config.h"

#include "stress.h"

struct affine random_map(struct dice *d, double size, double uneven, double far)
{
    struct affine first = affine_rotation(random_vector(d, 180));
    struct affine last = affine_rotation(random_vector(d, 180));
    struct affine scale =
        affine_scaling(vec3(below(d, 2) ? size : -size, size * pow(uneven, -uniform(d, 0, 1)),
                            size * pow(uneven, -uniform(d, 0, 1))));
    struct affine move = affine_translation(random_vector(d, size * far));
    struct affine m = affine_times(&scale, &first);
    m = affine_times(&last, &m);
    return affine_times(&move, &m);
}

bool shoot(const struct geometry *g, const struct ray *ray, struct hit *hit)
{
    struct ray_frame frame = ray_frame_of(ray);
    *hit = hit_none(ray->t_max);
    for (uint32_t i = 0; i < g->prims.n && ray_has_direction(ray); i++)
        geometry_intersect(g, i, ray, &frame, hit);
    return hit->prim != PRIM_NONE;
}

/* v0 v1 v2 and v2 v3 v0, as surfaces of kind quad are cut. */
static void add_quad(struct geometry *g, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    geometry_add_triangle(g, 0, a, b, c);
    geometry_add_triangle(g, 0, c, d, a);
}

void add_box(struct geometry *g, struct vec3 at, double half)
{
    static const uint8_t side[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    uint32_t first = (uint32_t)g->vertices.n;
    for (int k = 0; k < 8; k++)
        geometry_add_vertex(g, vec3(at.x + (k & 1 ? half : -half), at.y + (k & 2 ? half : -half),
                                    at.z + (k & 4 ? half : -half)));
    for (int k = 0; k < 6; k++)
        add_quad(g, first + side[k][0], first + side[k][1], first + side[k][2], first + side[k][3]);
}

void add_globe(struct geometry *g, struct vec3 at, double radius, uint32_t rings)
{
    uint32_t n = rings, first = (uint32_t)g->vertices.n;
    for (uint32_t i = 1; i < n; i++)
        for (uint32_t k = 0; k < n; k++) {
            double polar = PI * i / n, turn = 2 * PI * k / n;
            struct vec3 out = vec3(sin(polar) * cos(turn), cos(polar), sin(polar) * sin(turn));
            geometry_add_vertex(g, vec3_mad(at, radius, out));
        }
    uint32_t top = geometry_add_vertex(g, vec3_mad(at, radius, vec3(0, 1, 0)));
    uint32_t bottom = geometry_add_vertex(g, vec3_mad(at, radius, vec3(0, -1, 0)));
    for (uint32_t k = 0; k < n; k++) {
        uint32_t next = (k + 1) % n, last = first + (n - 2) * n;
        geometry_add_triangle(g, 0, top, first + next, first + k);
        geometry_add_triangle(g, 0, bottom, last + k, last + next);
        for (uint32_t i = 0; i + 2 < n; i++) {
            uint32_t row = first + i * n;
            add_quad(g, row + k, row + next, row + n + next, row + n + k);
        }
    }
}
