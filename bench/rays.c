/* rays SCENE.wrt [ROUNDS]: the rays of a picture against a mesh, by Embree 3 and by us, one thread.
 *
 * Prints millions of rays a second for the camera's rays, for one shadow ray from each hit to the
 * first light and for one ray from each hit in a random direction, one by one and together; what
 * building takes; and our whole picture beside the time of Embree's packets.  Times are the least
 * of ROUNDS (5) rounds in turn; all rays are made beforehand.  The scene must be triangles alone.
 * `make bench/rays` builds this where libembree-dev is installed; bench/embree runs it. */
#include "config.h"

#include "accel/bundle.h"
#include "base/thread.h"
#include "eval/eval.h"
#include "lower/lower.h"
#include "math/rng.h"
#include "render/render.h"
#include "scene/camera.h"
#include "syntax/syntax.h"
#include "validate/validate.h"

#include "base/file.h"

#include <embree3/rtcore.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { TOGETHER = 16, TILE_SIDE = 8, QUARTER = 4 };

/* One kind of rays, in both programs' forms, in the same order. */
struct beams {
    bool any;
    size_t n, batches, packets;
    struct ray *rays;
    struct ray_batch *batch;
    struct RTCRayHit *single;
    struct RTCRayHit16 *packet;
};

/* What is timed. */
enum way { EMBREE_SINGLE, OURS_SINGLE, EMBREE_PACKETS, OURS_PACKETS, WAYS };

struct timing {
    double least[WAYS];
    size_t hits[WAYS];
};

struct bench {
    struct lowered lowered;
    struct accel accel;
    const struct bundle_kernels *kernels;
    RTCScene scene;
};

/* Of this thread's processor time: others may run beside it. */
static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void fail(const char *what)
{
    fprintf(stderr, "rays: %s\n", what);
    exit(1);
}

static void load(const char *path, struct lowered *out)
{
    static struct srcmap sources;
    static struct diag diag;
    static struct ast ast;
    static struct desc desc;
    struct eval_options options = {.max_objects = 1000, .sources = &sources};
    char *text;
    size_t n;
    if (file_read(path, &text, &n))
        fail("the scene cannot be read");
    text = mem_realloc(text, n + 2, 1);
    diag_init(&diag, &sources);
    if (!syntax_parse(srcmap_add(&sources, path, text, n), &ast, &diag) ||
        !eval_scene(&ast, &options, &desc, &diag) || !validate_scene(&desc, &diag) ||
        !lower_scene(&desc, &sources, out, &diag))
        fail("the scene is wrong");
}

/* ---- rays -------------------------------------------------------------------------------------
 */

/* The camera's rays, in tiles of four quarters of 16 rays. */
static void add_camera_rays(const struct scene *s, struct beams *b)
{
    uint32_t w = s->camera.width, h = s->camera.height;
    struct lens lens = lens_of(&s->camera, w, h);
    double middle = camera_sample(&s->camera);
    b->rays = mem_alloc((size_t)w * h, sizeof *b->rays);
    for (size_t i = 0; i < (size_t)w * h; i++) {
        size_t tile = i / BATCH, quarter = i % BATCH / TOGETHER, in = i % TOGETHER;
        size_t columns = w / TILE_SIDE;
        double x = (double)(tile % columns * TILE_SIDE + quarter % 2 * QUARTER + in % QUARTER);
        double y = (double)(tile / columns * TILE_SIDE + quarter / 2 * QUARTER + in / QUARTER);
        b->rays[i] =
            (struct ray){.origin = lens.origin,
                         .direction = lens_direction(&lens, camera_place(&s->camera, x + middle, w),
                                                     camera_place(&s->camera, y + middle, h)),
                         .t_max = RAY_UNBOUNDED,
                         .from = PRIM_NONE,
                         .surface = SURFACE_NONE};
    }
    b->n = (size_t)w * h;
}

static struct vec3 random_direction(size_t i, struct vec3 normal)
{
    for (uint64_t k = 0;; k++) {
        struct vec3 d = vec3(2 * rng_uniform(1, i, k, 0) - 1, 2 * rng_uniform(1, i, k, 1) - 1,
                             2 * rng_uniform(1, i, k, 2) - 1);
        double square = vec3_dot(d, d);
        if (square > 0.01 && square <= 1)
            return vec3_scale(d, (vec3_dot(d, normal) < 0 ? -1 : 1) / sqrt(square));
    }
}

/* Rays that start where the camera's end. */
static void add_spawned_rays(const struct bench *bench, const struct beams *camera,
                             struct beams *shadow, struct beams *bounce)
{
    struct vec3 light = bench->lowered.scene.lights.at[0].position;
    shadow->rays = mem_alloc(camera->n, sizeof *shadow->rays);
    bounce->rays = mem_alloc(camera->n, sizeof *bounce->rays);
    shadow->any = true;
    for (size_t i = 0; i < camera->n; i++) {
        const struct ray *ray = &camera->rays[i];
        struct hit hit;
        struct vec3 normal;
        if (!accel_closest(&bench->accel, ray, &hit))
            continue;
        struct vec3 p = geometry_hit_point(bench->accel.geometry, ray, &hit, &normal);
        if (vec3_dot(normal, ray->direction) > 0)
            normal = vec3_neg(normal);
        struct ray from = {.origin = p, .from = hit.prim, .surface = SURFACE_NONE, .spawned = true};
        from.direction = vec3_sub(light, p);
        from.t_max = 1 - 0x1p-32;
        shadow->rays[shadow->n++] = from;
        from.direction = random_direction(i, normal);
        from.t_max = RAY_UNBOUNDED;
        bounce->rays[bounce->n++] = from;
    }
}

static void make_batches(struct beams *b)
{
    b->batches = (b->n + BATCH - 1) / BATCH;
    b->batch = mem_alloc_aligned(b->batches, sizeof *b->batch);
    memset(b->batch, 0, b->batches * sizeof *b->batch);
    for (size_t i = 0; i < b->n; i++) {
        struct ray_batch *batch = &b->batch[i / BATCH];
        uint32_t k = batch->n++;
        const struct ray *ray = &b->rays[i];
        vec3_put(&batch->origin, k, ray->origin);
        vec3_put(&batch->direction, k, ray->direction);
        batch->t_max[k] = ray->t_max;
        batch->from[k] = ray->from;
        batch->spawned = ray->spawned;
        batch->common_origin = !ray->spawned;
    }
}

/* Embree's float rays need a start that is not on the surface. */
static struct RTCRayHit ray_for_embree(const struct ray *r)
{
    struct RTCRayHit e = {0};
    e.ray.org_x = (float)r->origin.x;
    e.ray.org_y = (float)r->origin.y;
    e.ray.org_z = (float)r->origin.z;
    e.ray.dir_x = (float)r->direction.x;
    e.ray.dir_y = (float)r->direction.y;
    e.ray.dir_z = (float)r->direction.z;
    e.ray.tnear = r->spawned ? 1e-4f : 0;
    e.ray.tfar = r->t_max < 2 ? 0.9999f : INFINITY;
    e.ray.mask = UINT32_MAX;
    e.hit.geomID = e.hit.primID = e.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return e;
}

static void make_packets(struct beams *b)
{
    b->packets = (b->n + TOGETHER - 1) / TOGETHER;
    b->single = mem_alloc(b->n, sizeof *b->single);
    b->packet = mem_alloc_aligned(b->packets, sizeof *b->packet);
    memset(b->packet, 0, b->packets * sizeof *b->packet);
    for (size_t i = 0; i < b->n; i++) {
        struct RTCRayHit e = b->single[i] = ray_for_embree(&b->rays[i]);
        struct RTCRayHit16 *p = &b->packet[i / TOGETHER];
        size_t k = i % TOGETHER;
        p->ray.org_x[k] = e.ray.org_x;
        p->ray.org_y[k] = e.ray.org_y;
        p->ray.org_z[k] = e.ray.org_z;
        p->ray.dir_x[k] = e.ray.dir_x;
        p->ray.dir_y[k] = e.ray.dir_y;
        p->ray.dir_z[k] = e.ray.dir_z;
        p->ray.tnear[k] = e.ray.tnear;
        p->ray.tfar[k] = e.ray.tfar;
        p->ray.mask[k] = e.ray.mask;
        p->hit.geomID[k] = p->hit.primID[k] = p->hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
}

/* ---- tracing ----------------------------------------------------------------------------------
 */

static size_t trace_embree(const struct bench *bench, const struct beams *b)
{
    struct RTCIntersectContext context;
    size_t hits = 0;
    rtcInitIntersectContext(&context);
    for (size_t i = 0; i < b->n; i++) {
        struct RTCRayHit r = b->single[i];
        if (b->any) {
            rtcOccluded1(bench->scene, &context, &r.ray);
            hits += r.ray.tfar < 0;
        } else {
            rtcIntersect1(bench->scene, &context, &r);
            hits += r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
    }
    return hits;
}

static size_t trace_ours(const struct bench *bench, const struct beams *b)
{
    size_t hits = 0;
    for (size_t i = 0; i < b->n; i++) {
        struct hit hit;
        hits += b->any ? accel_any(&bench->accel, &b->rays[i])
                       : accel_closest(&bench->accel, &b->rays[i], &hit);
    }
    return hits;
}

static size_t trace_embree_packets(const struct bench *bench, const struct beams *b)
{
    static const _Alignas(64) int valid[TOGETHER] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                     -1, -1, -1, -1, -1, -1, -1, -1};
    struct RTCIntersectContext context;
    size_t hits = 0;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (size_t i = 0; i < b->packets; i++) {
        struct RTCRayHit16 r = b->packet[i];
        if (b->any)
            rtcOccluded16(valid, bench->scene, &context, &r.ray);
        else
            rtcIntersect16(valid, bench->scene, &context, &r);
        for (size_t k = 0; k < TOGETHER; k++)
            hits += b->any ? r.ray.tfar[k] < 0 : r.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

static size_t trace_our_packets(const struct bench *bench, const struct beams *b)
{
    struct target_list no_list = {.usable = false};
    size_t hits = 0;
    for (size_t i = 0; i < b->batches; i++) {
        uint64_t blocked = 0;
        struct hit_batch found;
        const struct ray_batch *batch = &b->batch[i];
        if (b->any)
            blocked = bundle_any(&bench->accel, bench->kernels, batch, &no_list);
        else
            bundle_closest(&bench->accel, bench->kernels, batch, &no_list, &found);
        for (uint32_t k = 0; k < batch->n; k++)
            hits += b->any ? blocked >> k & 1 : found.prim[k] != PRIM_NONE;
    }
    return hits;
}

static void time_round(const struct bench *bench, const struct beams *b, struct timing *t)
{
    static size_t (*const ways[WAYS])(const struct bench *, const struct beams *) = {
        [EMBREE_SINGLE] = trace_embree,
        [OURS_SINGLE] = trace_ours,
        [EMBREE_PACKETS] = trace_embree_packets,
        [OURS_PACKETS] = trace_our_packets};
    for (int way = 0; way < WAYS; way++) {
        double start = seconds();
        t->hits[way] = ways[way](bench, b);
        double took = seconds() - start;
        t->least[way] = took < t->least[way] ? took : t->least[way];
    }
}

static void print_timing(const char *name, const struct beams *b, const struct timing *t)
{
    double rate[WAYS], ours = (double)t->hits[OURS_SINGLE];
    for (int way = 0; way < WAYS; way++)
        rate[way] = 1e-6 * (double)b->n / t->least[way];
    printf("%-14s %9zu %9.2f %9.2f %7.2f %9.2f %9.2f %7.2f\n", name, b->n, rate[EMBREE_SINGLE],
           rate[OURS_SINGLE], rate[OURS_SINGLE] / rate[EMBREE_SINGLE], rate[EMBREE_PACKETS],
           rate[OURS_PACKETS], rate[OURS_PACKETS] / rate[EMBREE_PACKETS]);
    if (t->hits[OURS_SINGLE] != t->hits[OURS_PACKETS])
        fail("our packets and single rays differ");
    for (int way = 0; way < WAYS; way++)
        if (fabs((double)t->hits[way] - ours) > 0.02 * (double)b->n)
            fail("the two programs' hits differ too much to be of the same rays");
}

/* ---- building ---------------------------------------------------------------------------------
 */

static RTCScene build_embree(RTCDevice device, const struct geometry *g)
{
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *v = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                       3 * sizeof *v, g->vertices.n);
    uint32_t *t = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof *t, g->triangles.n);
    for (size_t i = 0; i < g->vertices.n; i++)
        for (int axis = 0; axis < 3; axis++)
            v[3 * i + (size_t)axis] = (float)vec3_at(g->vertices.at[i], axis);
    for (size_t i = 0; i < g->triangles.n; i++)
        memcpy(t + 3 * i, g->triangles.at[i].vertex, 3 * sizeof *t);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcReleaseGeometry(mesh);
    return scene;
}

static size_t bytes_in_use(void)
{
    struct mallinfo2 m = mallinfo2();
    return m.uordblks + m.hblkhd;
}

static double compare_builds(struct bench *bench, RTCDevice device, int rounds)
{
    const struct geometry *g = &bench->lowered.scene.geometry;
    struct accel_options options = {.isa = isa_best(), .threads = 1};
    double theirs = INFINITY, ours = INFINITY;
    size_t before = bytes_in_use(), bytes = 0;
    for (int i = 0; i < rounds; i++) {
        if (i > 0) {
            rtcReleaseScene(bench->scene);
            accel_free(&bench->accel);
        }
        bench->scene = build_embree(device, g);
        double start = seconds();
        rtcCommitScene(bench->scene);
        theirs = fmin(theirs, seconds() - start);
        before = bytes_in_use();
        start = seconds();
        accel_build_with(&bench->accel, g, &options);
        ours = fmin(ours, seconds() - start);
        bytes = bytes_in_use() - before;
    }
    printf("build: Embree %.1f ms, wrt %.1f ms, %.2f times as long; %.0f bytes a triangle\n",
           1e3 * theirs, 1e3 * ours, ours / theirs, (double)bytes / (double)g->triangles.n);
    return ours;
}

/* ---- the whole picture ------------------------------------------------------------------------
 */

static double render_once(const struct scene *s)
{
    struct render_options options = {.width = s->camera.width,
                                     .height = s->camera.height,
                                     .crop = {0, 0, s->camera.width, s->camera.height},
                                     .grid = 1,
                                     .depth = s->depth,
                                     .threads = 1,
                                     .isa = isa_best()};
    struct picture *picture = picture_new(s->camera.width, s->camera.height, false);
    struct render_stats stats;
    picture->encoding = render_encoding(s, SHOW_PICTURE);
    double start = seconds();
    render_scene(s, &options, picture, &stats);
    double took = seconds() - start;
    picture_free(picture);
    return took;
}

int main(int argc, char **argv)
{
    enum { CAMERA, SHADOW, BOUNCE, KINDS };
    static const char *const names[KINDS] = {"camera", "shadow", "random bounce"};
    struct bench bench = {0};
    struct beams beams[KINDS] = {0};
    struct timing timings[KINDS];
    int rounds = argc > 2 ? atoi(argv[2]) : 5;
    double whole = INFINITY;
    if (argc < 2)
        fail("usage: rays SCENE.wrt [ROUNDS]");
    load(argv[1], &bench.lowered);
    const struct scene *s = &bench.lowered.scene;
    RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
    bench.kernels = bundle_kernels_of(isa_best());
    printf("%zu triangles, %ux%u, %s, one thread\n", s->geometry.triangles.n, s->camera.width,
           s->camera.height, isa_name(isa_best()));
    double building = compare_builds(&bench, device, rounds);
    add_camera_rays(s, &beams[CAMERA]);
    add_spawned_rays(&bench, &beams[CAMERA], &beams[SHADOW], &beams[BOUNCE]);
    for (int k = 0; k < KINDS; k++) {
        make_batches(&beams[k]);
        make_packets(&beams[k]);
        timings[k] = (struct timing){{INFINITY, INFINITY, INFINITY, INFINITY}, {0}};
    }
    for (int i = 0; i < rounds; i++) {
        for (int k = 0; k < KINDS; k++)
            time_round(&bench, &beams[k], &timings[k]);
        whole = fmin(whole, render_once(s) - building);
    }
    printf("%-14s %9s %9s %9s %7s %9s %9s %7s\n", "Mray/s", "rays", "Embree", "wrt", "ratio",
           "by 16", "by 64", "ratio");
    for (int k = 0; k < KINDS; k++)
        print_timing(names[k], &beams[k], &timings[k]);
    double packets = timings[CAMERA].least[EMBREE_PACKETS] + timings[SHADOW].least[EMBREE_PACKETS];
    printf("whole picture: wrt %.1f ms, rays alone by Embree's packets %.1f ms: %.2f times\n",
           1e3 * whole, 1e3 * packets, whole / packets);
    return 0;
}
