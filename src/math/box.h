/* Axis-aligned boxes. */
#ifndef WRT_MATH_BOX_H
#define WRT_MATH_BOX_H

#include "math/vec3.h"

struct box {
    struct vec3 lo, hi;
};

static inline struct box box_empty(void)
{
    return (struct box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

static inline struct vec3 vec3_min(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

static inline struct vec3 vec3_max(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

static inline struct box box_join(struct box a, struct box b)
{
    return (struct box){vec3_min(a.lo, b.lo), vec3_max(a.hi, b.hi)};
}

static inline struct box box_add(struct box b, struct vec3 p)
{
    return (struct box){vec3_min(b.lo, p), vec3_max(b.hi, p)};
}

static inline struct vec3 box_center(struct box b)
{
    return vec3_scale(vec3_add(b.lo, b.hi), 0.5);
}

/* Half the surface area, the measure of the surface area heuristic; 0 for an empty box. */
static inline double box_half_area(struct box b)
{
    struct vec3 d = vec3_sub(b.hi, b.lo);
    return d.x >= 0 ? d.x * d.y + d.y * d.z + d.z * d.x : 0;
}

#endif
