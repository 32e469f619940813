/* A pixel: the tree of its rays, what they meet, and what each adds to its colour. */
#include "config.h"

#include "cmd/info.h"

#include "schema/schema.h"

void info_pixel(const struct info *i, uint32_t width, uint32_t height, struct info_pixel *p)
{
    const struct scene *s = &i->lowered.scene;
    const struct render_options options = {.isa = i->options->isa,
                                           .width = width,
                                           .height = height,
                                           .crop = {.x1 = width, .y1 = height},
                                           .grid = 1,
                                           .depth = s->depth,
                                           .threads = 1};
    uint32_t x = i->options->pixel[0], y = i->options->pixel[1];
    *p = (struct info_pixel){.x = x, .y = y};
    p->ray = probe_pixel(s, &options, x, y, &p->arena);
    struct picture *picture = picture_new(1, 1, PICTURE_BYTES);
    picture_encode_as(picture, render_encoding(s, SHOW_PICTURE));
    picture_set(picture, 0, 0, p->ray->colour);
    for (int k = 0; k < 3; k++)
        p->bytes[k] = picture->bytes[k];
    picture_free(picture);
}

const struct desc_object *info_surface(const struct info *i, uint32_t surface)
{
    return i->frontend.desc.surfaces.at[i->lowered.scene.surfaces.at[surface].described];
}

/* A scene that is right has all the lights of its description. */
const struct desc_object *info_light(const struct info *i, size_t k)
{
    return i->frontend.desc.lights.at[k];
}

/* ---- text --------------------------------------------------------------------------------------
 */

/* Adding nothing takes the sign off zeros. */
static void print_plain(struct vec3 v)
{
    info_print_vec3(vec3_add(v, vec3_all(0)));
}

/* Light that no picture shows is told as none: highlights fade to 1e-100 and less. */
static struct vec3 visible(struct vec3 v)
{
    const double least = 1e-6;
    return vec3(fabs(v.x) < least ? 0 : v.x, fabs(v.y) < least ? 0 : v.y,
                fabs(v.z) < least ? 0 : v.z);
}

static void print_word(int indent, const char *word)
{
    printf("%*s%-10s", indent, "", word);
}

static void print_line(int indent, const char *word, struct vec3 v)
{
    print_word(indent, word);
    print_plain(v);
    putchar('\n');
}

static void print_origin(const struct info *i, const struct desc_object *o)
{
    info_print_object(o);
    info_print_place(i, o->span);
    putchar('\n');
}

static void print_frames(const struct info *i, int indent, const struct diag_frame *innermost)
{
    for (const struct diag_frame *f = innermost; f; f = f->parent) {
        print_word(indent, "in");
        info_print_frame(i, f);
        if (f->kind == DIAG_FRAME_ROUND)
            printf(" = %.6g", f->number);
        if (f->kind == DIAG_FRAME_ITEM)
            printf(", item %.0f", f->number);
        info_print_place(i, f->at);
        putchar('\n');
    }
}

/* "blocked by sphere ball  (scene.wrt:3:1)"; of several rays, how many. */
static void print_shadow(const struct info *i, int indent, const struct probe_light *light)
{
    for (const struct probe_blocker *b = light->blockers; b; b = b->next) {
        print_word(indent, "");
        if (light->rays > 1)
            printf("%llu of %llu ", (unsigned long long)b->rays, (unsigned long long)light->rays);
        fputs("blocked by ", stdout);
        print_origin(i, info_surface(i, b->surface));
    }
}

static void print_light(const struct info *i, int indent, size_t k, const struct probe_light *light)
{
    struct vec3 diffuse = visible(light->diffuse), highlight = visible(light->highlight);
    printf("%*s", indent, "");
    print_origin(i, info_light(i, k));
    print_shadow(i, indent, light);
    if (light->lit == 0 && light->rays > 0)
        return;
    print_word(indent, "");
    if (vec3_is_zero(diffuse) && vec3_is_zero(highlight))
        fputs("adds nothing", stdout);
    else
        fputs("diffuse ", stdout), print_plain(diffuse);
    if (!vec3_is_zero(highlight))
        fputs("  highlight ", stdout), print_plain(highlight);
    putchar('\n');
}

static void print_surface(const struct info *i, int indent, const struct probe_ray *r)
{
    const struct scene *s = &i->lowered.scene;
    const struct desc_object *o = info_surface(i, r->surface);
    const struct desc_object *material = desc_get(o, PROP_MATERIAL)->object;
    bool glows = s->materials.at[s->surfaces.at[r->surface].material].kind == MATERIAL_EMISSIVE;
    print_origin(i, o);
    print_word(indent, "distance");
    printf("%.6g\n", r->distance);
    print_line(indent, "point", r->point);
    print_line(indent, "normal", r->normal);
    print_word(indent, "material");
    print_origin(i, material);
    print_frames(i, indent, o->frame);
    print_line(indent, "diffuse", r->diffuse);
    if (!vec3_is_zero(r->without))
        print_line(indent, glows ? "glows" : "ambient", r->without);
    for (size_t k = 0; k < s->lights.n; k++)
        if (!glows || !vec3_is_zero(r->lights[k].diffuse))
            print_light(i, indent, k, &r->lights[k]);
}

/* `left` rays may still be told. */
static void print_ray(const struct info *i, int indent, const struct probe_ray *r, size_t *left);

static void print_bounced(const struct info *i, int indent, const char *way,
                          const struct probe_ray *r, size_t *left)
{
    if (!r)
        return;
    if (*left == 0) {
        printf("%*s%s rays of which -v tells more\n", indent, "", way);
        return;
    }
    printf("%*s%s, times ", indent, "", way);
    if (r->weight.x == r->weight.y && r->weight.y == r->weight.z)
        printf("%.6g", r->weight.x);
    else
        print_plain(r->weight);
    fputs(": ", stdout);
    print_ray(i, indent + 2, r, left);
}

static void print_ray(const struct info *i, int indent, const struct probe_ray *r, size_t *left)
{
    --*left;
    if (r->hit)
        print_surface(i, indent, r);
    else
        fputs("nothing\n", stdout);
    const struct camera *camera = &i->lowered.scene.camera;
    bool parallel = camera->modern && !(camera->yfov > 0);
    if (!r->hit && r->way == PROBE_CAMERA && parallel)
        print_line(indent, "from", r->origin);
    if (!r->hit)
        print_line(indent, "direction", r->direction);
    print_bounced(i, indent, "reflected", r->reflected, left);
    print_bounced(i, indent, "refracted", r->refracted, left);
    print_line(indent, "colour", r->colour);
}

void info_print_pixel(const struct info *i, const struct info_pixel *p)
{
    size_t left = i->options->verbose ? SIZE_MAX : INFO_LISTED;
    printf("pixel %u,%u: ", p->x, p->y);
    print_ray(i, 2, p->ray, &left);
    print_word(2, "picture");
    printf("#%02x%02x%02x\n", p->bytes[0], p->bytes[1], p->bytes[2]);
}
